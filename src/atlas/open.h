// An admitted surface -> charts: parted where the input asks for it, holes filled, opened where it
// must be.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "admit/admit.h"
#include "base/types.h"
#include "base/work.h"
#include "cut/given.h"
#include "cut/seam_costs.h"
#include "cut/search.h"
#include "mesh/chart.h"

namespace beltrami {

/// A disk of the surface, and which of it is virtual.
struct AtlasChart {
  Chart chart;           ///< of vertices and faces of the surface, the virtual ones at the end
  Index real_faces = 0;  ///< the first ones
  /// Where the surface was simplified to find its seams, what of it the chart inherits: per vertex
  /// the next one on its way (see collapsed_disk), or itself; else empty.
  std::vector<Index> collapsed_into = {};
  /// Where seams were found on the surface itself, the map that they were judged by: one UV per
  /// vertex, in the unit of the surface; else empty.
  std::vector<Vec2> local_map = {};
};

/// What draws seams that are searched for, as SeamHints has it: of the input's vertices and faces,
/// each list empty where nothing is given.
struct InputHints {
  std::vector<double> vertex_paint;     ///< per vertex
  std::vector<PaintedEdge> edge_paint;  ///< pairs that are no edge do nothing
  std::vector<Index> materials;         ///< per face
};

/// The least of its faces, of the input.
Index first_input_face(const AtlasChart& chart, const Admitted& admitted);

struct OpenedSurface {
  std::vector<AtlasChart> charts;  ///< by their least face of the input
  Index filled_holes = 0;
  double predicted_energy = 2;  ///< of seams that were searched
  BegunSearch search;           ///< of these
};

/// Which faces of the input are parts of polygons, and where.
struct PolygonParts {
  std::span<const Index> polygon;           ///< per face, or none
  std::span<const std::uint8_t> diagonals;  ///< per face, bit k: its edge from corner k is inside;
                                            ///< none: all are that lie between two of its faces
};

/// Whether an edge of the surface, by its half-edges, lies inside a polygon: not where a side of it
/// meets another side of the same. Precondition: polygons are given.
bool is_inside_polygon(const Admitted& admitted, const PolygonParts& polygons, Index h, Index twin);

/// Cuts along what is given, fills the holes whose boundary is no longer than `fill_limit` times
/// the root of their component's area, and cuts what there is then along the seams that are
/// searched for `target`, or without one what is no disk along a short cut graph. `begun`: as
/// search_seams has it, of the same. No cut divides a polygon, if there is a way.
OpenedSurface open_surface(const Admitted& admitted, const GivenCuts& cuts, double fill_limit,
                           const PolygonParts& polygons, const std::optional<SeamTarget>& target,
                           const SeamWeights& weights, const InputHints& hints,
                           const BegunSearch& begun, const Work& work);

}  // namespace beltrami
