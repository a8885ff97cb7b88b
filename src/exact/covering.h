// Whether triangles cover the plane once at most, by a sweep over their boundary alone.
#pragma once

#include "exact/uv_boundary.h"

namespace beltrami {

/// The corner (see UvEdge) of an edge whose triangle has an open set in common with another one;
/// kNone if there is no such pair. The number of triangles over a point is the winding number of
/// their boundary, which the sweep follows through all cells of its arrangement: edges may touch,
/// end on each other, and lie on each other in opposite directions. It stops where edges cross or
/// the number exceeds one. Exact, in O(n log n) for n edges whatever they are.
/// Precondition: `boundary` is that of `triangles` (uv_boundary), and no edge of it is doubled.
Index find_double_cover(const SignedTriangles& triangles, const std::vector<UvEdge>& boundary,
                        const Work& work);

}  // namespace beltrami
