// An admitted surface -> what is to be opened -> charts: parted where the input asks for it, holes
// filled, and cut along the seams that are found for each piece.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "admit/admit.h"
#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "cut/edge_marks.h"
#include "cut/given.h"
#include "cut/seam_costs.h"
#include "cut/seam_target.h"
#include "cut/search_effort.h"
#include "cut/search_seams.h"
#include "mesh/chart.h"
#include "mesh/surface.h"

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
  bool is_turned = false;  ///< its faces run against those of the surface

  /// The half-edge of the surface that a half-edge of a real face is.
  Index on_surface(Index h) const {
    return 3 * chart.input_face[h / 3] + (is_turned ? 2 - h % 3 : h % 3);
  }
  /// The corner of a face of the input that corner k of a real face is.
  int input_corner(const Admitted& admitted, Index face, int k) const {
    return admitted.input_corner(chart.input_face[face], is_turned ? (3 - k) % 3 : k);
  }
  /// Whether a real face runs against that of the input.
  bool is_reversed(const Admitted& admitted, Index face) const {
    return admitted.reversed[chart.input_face[face]] != is_turned;
  }
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

/// Scales the surface by the power of two that brings it to about unit area, and returns its
/// exponent.
int bring_to_unit(Surface& surface, const Work& work);

/// Multiplies by 2^exponent.
template <class Vector>
void scale_by_power(int exponent, std::vector<Vector>& places) {
  if (exponent == 0) return;
  for (Vector& place : places) {
    for (double& x : place) x = std::ldexp(x, exponent);
  }
}

/// A surface whose seams are to be found, with what is known of it; of vertices and faces of the
/// admitted one, or a piece of such.
struct SurfacePiece {
  Surface surface;       ///< its last vertices and faces are virtual
  Index real_faces = 0;  ///< the first ones
  Topology topology;
  EdgeMarks locked;           ///< edges that are not to be cut, if there is a way; or none
  SeamHints hints;            ///< of its vertices and faces
  std::vector<Index> vertex;  ///< per vertex that of the admitted surface, kNone: a virtual one
  std::vector<Index> face;    ///< per face that of the admitted surface, then virtual ones,
                              ///< increasing
  int exponent = 0;           ///< it was scaled by that power of two
};

/// The whole of the admitted surface.
struct ReadySurface {
  SurfacePiece whole;
  Index filled_holes = 0;
};

/// Cuts along what is given, and fills the holes whose boundary is no longer than `fill_limit`
/// times the root of their component's area.
ReadySurface make_ready(const Admitted& admitted, const GivenCuts& cuts, double fill_limit,
                        const PolygonParts& polygons, const InputHints& hints, const Work& work);

/// The components of a piece, by their least face, each scaled to about unit area. Its vertices and
/// faces are in the order in which the whole has them.
std::vector<SurfacePiece> components_of(SurfacePiece whole, const Work& work);

struct OpenedSurface {
  std::vector<AtlasChart> charts;  ///< of the admitted surface, in the unit of the piece, by their
                                   ///< least face of it
  double predicted_energy = 2;     ///< of seams that were searched
  BegunSearch search;              ///< of these
  EdgeMarks seams;                 ///< of the piece
  bool is_parted = false;          ///< its real faces alone were cut, see parted_along
};

/// Cuts a piece along the seams that are searched for `target`. `begun`: as search_seams has it, of
/// the same piece. No cut divides a polygon, if there is a way.
OpenedSurface open_searched(const SurfacePiece& piece, const SeamTarget& target,
                            const SearchEffort& effort, const SeamWeights& weights,
                            const BegunSearch& begun, const Work& work);

/// Cuts a piece along `seams`. Precondition: these make disks of it.
OpenedSurface open_along(const SurfacePiece& piece, EdgeMarks seams, const Work& work);

/// The real faces of a piece parted along the marked edges, or none, and what holes they have then
/// filled as make_ready does: a piece of any number of components, its real faces numbered alike.
SurfacePiece parted_along(const SurfacePiece& piece, const EdgeMarks& marks, double fill_limit,
                          const Work& work);

/// Cuts what is no disk of a piece along a short cut graph.
OpenedSurface open_short(const SurfacePiece& piece, const Work& work);

}  // namespace beltrami
