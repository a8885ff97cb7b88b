// Exact statements on triangles in the plane, by other means than the library's.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace beltrami::shapes {

using Uv = std::array<double, 2>;
using UvTriangle = std::array<Uv, 3>;

/// 1 where a, b, c turn counter-clockwise, -1 where clockwise, 0 on a line. Exact, unless products
/// of coordinates underflow.
int orientation(const Uv& a, const Uv& b, const Uv& c);

/// Whether triangles that turn counter-clockwise have an inner point in common. Exact.
bool overlap(const UvTriangle& a, const UvTriangle& b);

/// Two of these that overlap, all of which turn counter-clockwise, or nothing.
std::optional<std::pair<std::size_t, std::size_t>> find_overlap(
    const std::vector<UvTriangle>& triangles);

/// The distance of two segments, to rounding.
double distance(const Uv& a, const Uv& b, const Uv& c, const Uv& d);

}  // namespace beltrami::shapes
