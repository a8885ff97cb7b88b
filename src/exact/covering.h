// Whether triangles cover the plane once at most, by a sweep over their boundary alone.
#pragma once

#include "base/types.h"
#include "base/work.h"
#include "exact/uv_boundary.h"

namespace beltrami {

struct Covering {
  /// Corner (see UvEdge) of an edge whose triangle has an open set in common with another one;
  /// kNone if there is no such pair.
  Index doubled = kNone;
  /// Places where boundaries touch, that is a vertex on an edge or vertices upon each other, and
  /// the first vertex in such a place. Those to the left of the first overlap, if there is one.
  std::int64_t touching_places = 0;
  Index first_touching = kNone;
};

/// The number of triangles over a point is the winding number of their boundary, which a sweep
/// follows through all cells of its arrangement: edges may touch, end on each other, and lie on
/// each other in opposite directions. It stops where edges cross or the number exceeds one. Exact,
/// in O(n log n) for n edges whatever they are.
/// Precondition: `boundary` is that of `triangles` (uv_boundary), and no edge of it is doubled.
Covering sweep_covering(const SignedTriangles& triangles, const std::vector<UvEdge>& boundary,
                        const Work& work);

}  // namespace beltrami
