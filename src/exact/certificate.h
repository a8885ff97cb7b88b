// The exact verdict on a map: orientation of every face and simplicity of the boundary loop.
//
// A piecewise linear map of a disk is injective if every face is positively oriented and the image
// of the boundary is a simple polygon (Lipman 2014, "Bijective mappings of meshes with boundary",
// theorem 1). Both are decided by CGAL's exact predicates on the floats given.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/types.h"

namespace beltrami {

struct Orientations {
  std::int64_t positive = 0, negative = 0, degenerate = 0;
  Index first_bad_face = kNone;  ///< first face that is not positive
};

struct Crossings {
  std::int64_t count = 0;                            ///< pairs of edges that meet illegally
  std::array<Index, 2> first_pair = {kNone, kNone};  ///< start vertices of the first such pair
};

struct Certificate {
  Orientations orientations;
  Crossings crossings;
  bool injective() const {
    return orientations.negative == 0 && orientations.degenerate == 0 && crossings.count == 0;
  }
};

/// Exact sign of the area of (a, b, c): 1 counter-clockwise, 0 collinear, -1 clockwise.
int orientation(const Vec2& a, const Vec2& b, const Vec2& c);

/// Counts the exact orientations of `faces` under `uvs` (one per vertex, finite).
Orientations count_orientations(const std::vector<Triangle>& faces, const std::vector<Vec2>& uvs,
                                int threads);

/// Faces that are not positively oriented, in order.
std::vector<Index> non_positive_faces(const std::vector<Triangle>& faces,
                                      const std::vector<Vec2>& uvs, int threads);

/// Exact test of a closed polygon through uvs[loop[0]], uvs[loop[1]], ...: counts the pairs of
/// edges that share any point other than the end that neighbours have in common. O(n log n) for
/// polygons that are not pathologically nested.
Crossings count_crossings(const std::vector<Index>& loop, const std::vector<Vec2>& uvs);

/// The pairs that count_crossings counts, as positions in the loop: edge i runs from loop[i] to
/// loop[i + 1].
std::vector<std::array<Index, 2>> find_crossings(const std::vector<Index>& loop,
                                                 const std::vector<Vec2>& uvs);

/// Both tests. Precondition: `faces` form one oriented manifold disk with boundary `loop`.
Certificate certify(const std::vector<Triangle>& faces, const std::vector<Index>& loop,
                    const std::vector<Vec2>& uvs, int threads);

}  // namespace beltrami
