// Charts that are grids of quads, laid out as such.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "admit/admit.h"
#include "atlas/open.h"
#include "base/types.h"
#include "base/vectors.h"

namespace beltrami {

/// The map of a chart that is rows and columns of quads: each column has one width and each row one
/// height, the mean length of the edges across it, and all edges run along the axes to the bit. It
/// is injective but for rounding. Nothing where the chart is no such grid, or a row or column has
/// no extent. `polygons`: per face of the input.
std::optional<std::vector<Vec2>> grid_map(const AtlasChart& part, const Admitted& admitted,
                                          std::span<const Index> polygons);

}  // namespace beltrami
