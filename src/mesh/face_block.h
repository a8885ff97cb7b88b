// Linear maps of faces side by side: what passes over all faces are written in where their
// arithmetic counts, and compilers make vector instructions of.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "mesh/rest_shape.h"

namespace beltrami {

/// Some faces one after the other in the list, with the numbers of each in its place of the arrays.
/// All operations are those of a single face, so that the bits are those of linear_map.
struct FaceBlock {
  static constexpr int kFaces = 16;
  using Numbers = double[kFaces];

  Numbers x1, x2, y2;  ///< of the rest triangles
  /// The second and third corner of the image, from the first one.
  Numbers second_x, second_y, third_x, third_y;

  /// The faces [first, first + kFaces); beyond `end` the last one before it again.
  void load(const std::vector<Triangle>& faces, const std::vector<RestTriangle>& rest,
            const std::vector<Vec2>& uvs, std::int64_t first, std::int64_t end) {
    for (int i = 0; i < kFaces; ++i) {
      const std::int64_t f = std::min(first + i, end - 1);
      const Triangle& t = faces[f];
      const RestTriangle& r = rest[f];
      const Vec2 &a = uvs[t[0]], &b = uvs[t[1]], &c = uvs[t[2]];
      x1[i] = r.x1;
      x2[i] = r.x2;
      y2[i] = r.y2;
      second_x[i] = b.x() - a.x();
      second_y[i] = b.y() - a.y();
      third_x[i] = c.x() - a.x();
      third_y[i] = c.y() - a.y();
    }
  }

  RestTriangle rest(int i) const { return {x1[i], x2[i], y2[i]}; }
  LinearMap map(int i) const {
    return linear_map(rest(i), Vec2(0, 0), Vec2(second_x[i], second_y[i]),
                      Vec2(third_x[i], third_y[i]));
  }
};

}  // namespace beltrami
