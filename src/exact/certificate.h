// The exact verdict on a map: orientation of every face and simplicity of the boundary loop.
//
// A piecewise linear map of a disk is injective if every face is positively oriented and the image
// of the boundary is a simple polygon (Lipman 2014, "Bijective mappings of meshes with boundary",
// theorem 1). Both are decided by exact predicates on the floats given.
#pragma once

#include <cstdint>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "exact/crossings.h"

namespace beltrami {

struct Orientations {
  std::int64_t positive = 0, negative = 0, degenerate = 0;
  Index first_bad_face = kNone;  ///< first face that is not positive
};

struct Certificate {
  Orientations orientations;
  Crossings crossings;
  bool injective() const {
    return orientations.negative == 0 && orientations.degenerate == 0 && crossings.count == 0;
  }
};

/// Counts the exact orientations of `faces` under `uvs` (one per vertex, finite).
Orientations count_orientations(const std::vector<Triangle>& faces, const std::vector<Vec2>& uvs,
                                const Work& work);

/// Faces that are not positively oriented, in order.
std::vector<Index> non_positive_faces(const std::vector<Triangle>& faces,
                                      const std::vector<Vec2>& uvs, const Work& work);

/// Both tests. Precondition: `faces` form one oriented manifold disk with boundary `loop`.
Certificate certify(const std::vector<Triangle>& faces, const std::vector<Index>& loop,
                    const std::vector<Vec2>& uvs, const Work& work);

}  // namespace beltrami
