// Charts of one shape, of which one may lie on the other.
#pragma once

#include <optional>
#include <vector>

#include "atlas/open.h"
#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"

namespace beltrami {

/// A chart as it is compared with others.
struct ChartShape {
  const AtlasChart* chart;
  SurfacePiece piece;  ///< its real faces
};

ChartShape shape_of(const AtlasChart& chart, const Work& work);

/// A chart laid on another by a rigid motion of the surface: per vertex that of the other, kNone
/// for vertices of filled holes; none where their shapes differ.
std::optional<std::vector<Index>> vertices_on(const ChartShape& shape, const ChartShape& other);

/// The map of the chart that lies on the other one, from the map of that.
std::vector<Vec2> map_on(const AtlasChart& chart, const std::vector<Index>& vertices,
                         const std::vector<Vec2>& uvs_of_other);

}  // namespace beltrami
