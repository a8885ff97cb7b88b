// An editing session: seams, pins and charts of one surface that change a little at a time, and
// maps that follow from those that are there.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "atlas/pins.h"
#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "chart/flattening.h"
#include "exact/atlas_certificate.h"
#include "multilevel/options.h"
#include "pack/types.h"
#include "session/ground.h"
#include "session/state.h"

namespace beltrami {

/// Where a session begins. Lists are empty where nothing is given.
struct SessionInput {
  std::vector<Vec3> positions;
  std::vector<Triangle> faces;
  std::vector<std::array<Index, 2>> seams;  ///< vertices; pairs that are no edge mark nothing
  std::vector<Vec2> corner_uvs;             ///< three per face: the maps to begin with, and seams
                                            ///< where they differ
  std::vector<Pin> pins;
};

/// What an update did.
struct Updated {
  Outcome outcome = Outcome::kOk;  ///< the greatest reservation of all charts; NOT_CONVERGED also
                                   ///< where some are still to be mapped
  Index mapped = 0;                ///< charts that got a map
  Index due = 0;                   ///< charts that are to be mapped further
};

/// Edits are noted at once and cost next to nothing; update() makes the maps that they ask for. A
/// call that throws leaves everything as it was. The same calls give the same bits, at any number
/// of threads, unless a limit of time ends one of them.
class Session {
 public:
  /// Throws what admit does. Charts with UVs for all corners keep them until they are edited.
  Session(SessionInput input, const GroundOptions& options, const ChartOptions& chart, bool float32,
          const Work& work);

  /// Opens or closes the seams at edges, given by their vertices of the input. Edges that had to be
  /// cut beside the seams to make disks stay so until they are closed likewise. Throws Error
  /// INVALID_ARGUMENT where there is no such edge, or where it is inside a polygon and cannot be
  /// opened.
  void set_seams(std::span<const std::array<Index, 2>> edges, bool open);
  /// These and no other pins.
  void set_pins(std::vector<Pin> pins) { state_.pins = std::move(pins); }
  /// The faces of the input, by numbers, that may move, which are to be mapped anew; none: all may.
  /// The others stay where they are.
  void select(std::span<const Index> faces);
  /// Charts that stay where they are whatever happens, or no longer. Throws Error INVALID_ARGUMENT
  /// where there is no such chart; so do the next three.
  void lock(std::span<const Index> ids, bool locked);
  /// Gives charts these flags, a sum of ChartFlags, in place of those that they have. What is to be
  /// aligned from now on is mapped anew by the next update.
  void set_flags(std::span<const Index> ids, std::uint8_t flags);
  /// Has charts mapped anew by the next update, where they are; `cold`: from nothing.
  void renew(std::span<const Index> ids, bool cold);

  /// Cuts and maps what is due. A chart that has a map takes at most `steps` Newton steps from it,
  /// where that is not 0, and where the time of the work is up no more: it stays due, and its map
  /// is what it has come to. Charts that have no map are mapped whatever the time. Throws Error
  /// PINS with the corner, INVALID_STATE with the face of parts that cannot be joined, Cancelled,
  /// or what the stages do with the first face of the chart.
  Updated update(int steps, const Work& work);

  /// Packs charts, by ids, or all, among the others, which stay; so do charts with locked faces and
  /// those with pins. The sizes of charts to each other are kept; where all are packed they are
  /// scaled as one to what fits, or to what is asked for. Where there is no room for them elsewhere
  /// they stay where they are, if that is on the pages and injective. By their flags charts keep
  /// their turn or size, or are stacked. Throws Error NO_ROOM or what pack_uvs does.
  Outcome pack(std::span<const Index> ids, const PackOptions& options, const Work& work);

  /// The exact verdict on all charts together but for those that are stacked on others, in the
  /// numbers delivered.
  AtlasCertificate check(const Work& work) const;

  /// Notes the state under a number, and goes back to it. Throws Error INVALID_ARGUMENT where there
  /// is none of that number.
  std::uint64_t save();
  void restore(std::uint64_t mark);
  void forget(std::uint64_t mark);

  const Ground& ground() const { return ground_; }
  const SessionState& state() const { return state_; }
  /// Corners of the ground, 3 * face + k, whose UVs the last update, pack or restore changed.
  const std::vector<Index>& changes() const { return changes_; }
  const Vec2& uv(Index corner) const;
  /// The mean energy over the area of the ground; NaN before the first update.
  double energy() const;

 private:
  friend class Updater;
  friend class Repacker;
  std::vector<Index> indices_of(std::span<const Index> ids) const;
  /// Takes a state over, and finds what it changes.
  void commit(SessionState next);

  Ground ground_;
  ChartOptions chart_;
  bool float32_ = false;
  SessionState state_;
  std::map<std::uint64_t, SessionState> saved_;
  std::uint64_t next_mark_ = 1;
  std::vector<Index> changes_;
  mutable CornerUvs scratch_;  ///< of the charts that a call has read
};

}  // namespace beltrami
