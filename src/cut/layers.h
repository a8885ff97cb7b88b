// Where a map lies on itself, by pixels.
#pragma once

#include <span>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "mesh/surface.h"

namespace beltrami {

/// The pixels whose centres lie in two faces or more, and these. A pixel centre on an edge is in
/// one of its faces.
struct Layers {
  Vec2 origin = Vec2::Zero();  ///< the centre of pixel 0
  double pixel = 0;            ///< the length of its sides
  Index width = 0;             ///< pixels in a row
  std::vector<Index> pixels;   ///< row by row, increasing
  std::vector<Index> start;    ///< per pixel of `pixels` its first entry in `faces`, and one more
  std::vector<Index> faces;    ///< increasing in each pixel

  Index count() const { return size_of(pixels); }
  Vec2 centre(Index i) const { return origin + pixel * Vec2(pixels[i] % width, pixels[i] / width); }
  std::span<const Index> operator[](Index i) const {
    return std::span(faces).subspan(start[i], start[i + 1] - start[i]);
  }
};

/// Faces that do not lie the right way round count for nothing. Pixels are as fine as the faces,
/// within bounds. Precondition: finite UVs.
Layers layers_of(const Surface& mesh, const std::vector<Vec2>& uvs);

/// The layers of some of the faces: `new_face` has their new numbers, in the same order, or kNone.
Layers layers_among(const Layers& layers, const std::vector<Index>& new_face);

/// The area that lies on other faces, each time that it does.
double overlapped_area(const Layers& layers);

}  // namespace beltrami
