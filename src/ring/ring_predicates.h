// What every triangulation of a ring needs to decide, exactly.
#pragma once

#include <string>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"

namespace beltrami {

/// Throws Error INTERNAL: the scaffold cannot be triangulated, and `sentence` says why.
[[noreturn]] void fail_ring(const std::string& sentence);

/// The vertices of both polygons, the inner ones first. Fails where a polygon has fewer than three
/// or one is not finite.
std::vector<Vec2> ring_points(const std::vector<Vec2>& inner, const std::vector<Vec2>& outer);

/// By x, then by y.
bool lexicographically_less(const Vec2& a, const Vec2& b);

/// Whether d lies inside the circle of the counter-clockwise triangle (a, b, c), d being across the
/// edge a-b. Four points on a circle are decided as if each point's lift to the paraboloid were
/// lowered infinitesimally, the lexicographically smallest point's by far the most (after
/// Devillers, Teillaud 2011, "Perturbations for Delaunay and weighted Delaunay 3D triangulations").
/// No three of them are collinear, so that only the smallest point matters: the diagonal through it
/// is taken. As a perturbed Delaunay triangulation is unique, the result depends on no order of
/// insertion.
bool is_in_circle(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d);

/// The vertices of `polygon` where it turns; throws if it is not convex and counter-clockwise.
std::vector<Index> corners_of_convex(const std::vector<Vec2>& polygon);

}  // namespace beltrami
