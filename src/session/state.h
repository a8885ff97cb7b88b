// What an editing session knows at one time: a value, so that a copy of it is an undo.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "atlas/open.h"
#include "atlas/pins.h"
#include "base/types.h"
#include "base/vectors.h"
#include "chart/flattening.h"
#include "cut/edge_marks.h"
#include "mesh/disk_mesh.h"
#include "pins/hold.h"

namespace beltrami {

/// What a chart waits for.
enum class Due {
  kNothing,
  kWarm,  ///< to be mapped anew from the map that it has
  kCold   ///< likewise from nothing: it has no map of use
};

/// A pin that a chart was mapped with.
struct MetPin {
  Index corner;  ///< of the input, 3 * face + corner
  Vec2 place;
  PinKind kind = PinKind::kPoint;
  Vec2 along = Vec2::Zero();  ///< of kLine: its direction

  /// Whether it holds the same of the same vertex, wherever that is to be.
  bool is_like(const MetPin& other) const {
    return corner == other.corner && kind == other.kind && along == other.along;
  }
  bool operator==(const MetPin& other) const = default;
};

/// What a chart keeps, beside its lock: a sum of these.
enum ChartFlags : std::uint8_t {
  kKeepFrame = 1,  ///< packing does not turn it
  kKeepScale = 2,  ///< neither its pins nor packing change its size
  kAlign = 4,      ///< its straight borders lie along the axes, as far as they can without pins
  kStack = 8       ///< packing lays it on the first chart of its shape that is to be stacked, too
};

struct SessionChart {
  Index id = 0;
  Index first = 0;                               ///< the least of its faces, of the input
  std::shared_ptr<const AtlasChart> part;        ///< of the ground, in its unit
  std::shared_ptr<const std::vector<Vec2>> uvs;  ///< one per vertex, as delivered
  /// Per vertex its rank in an order of elimination, from its first map on. Charts that are cut
  /// from it go on with the order.
  std::shared_ptr<const std::vector<Index>> ranks = nullptr;
  bool placed = false;  ///< `uvs` say where it lies
  double scale = 1;     ///< lengths in the plane per length on the ground that it is to have
  Due due = Due::kCold;
  bool presses = false;  ///< the boundary of its map on itself
  Outcome outcome = Outcome::kNotConverged;
  double energy = 0;  ///< mean symmetric Dirichlet, of its real faces, at its scale
  std::vector<MetPin> pins;
  /// Where packing has laid it on another chart, the UVs of that one.
  std::shared_ptr<const std::vector<Vec2>> lies_on = nullptr;

  Index faces() const { return part->real_faces; }
  const DiskMesh& mesh() const { return part->chart.mesh; }
};

struct SessionState {
  EdgeMarks seams;             ///< asked for, per half-edge of the ground
  EdgeMarks opened;            ///< further edges that had to be cut to make disks
  std::vector<Index> toggled;  ///< half-edges whose seams have changed since the charts were cut
  std::vector<Pin> pins;
  std::vector<bool> locked;           ///< per face of the ground
  std::vector<std::uint8_t> flags;    ///< likewise, of ChartFlags
  std::vector<bool> selected;         ///< likewise; none: all are
  std::vector<SessionChart> charts;   ///< by their least face of the input
  std::vector<Index> chart_of_face;   ///< per face of the ground
  std::vector<Index> place_in_chart;  ///< likewise, among the faces of its chart
  Index next_id = 0;

  /// Notes of the faces of chart `c` that they are its own.
  void own_faces(Index c);
  /// The vertices in its chart of a face of the ground.
  const Triangle& vertices_in_chart(Index face) const {
    return charts[chart_of_face[face]].mesh().faces[place_in_chart[face]];
  }

  /// Those that all of its faces have.
  std::uint8_t flags_of(const SessionChart& chart) const;
  /// The chart that a chart was laid on, where both have stayed as they were; else kNone.
  Index stacked_on(const SessionChart& chart) const;

  bool may_move(Index face) const { return !locked[face] && (selected.empty() || selected[face]); }
};

/// Per corner of the ground, the UVs of some charts.
class CornerUvs {
 public:
  explicit CornerUvs(Index faces) : uvs_(3 * static_cast<std::size_t>(faces), Vec2::Zero()) {}
  void read(const SessionChart& chart);
  const Vec2& operator[](Index corner) const { return uvs_[corner]; }

 private:
  std::vector<Vec2> uvs_;
};

}  // namespace beltrami
