// A map with some of its vertices held at given places.
#pragma once

#include <span>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "mesh/disk_mesh.h"
#include "multilevel/options.h"
#include "pins/similarity.h"

namespace beltrami {

/// What of a pinned vertex is held: both coordinates, one, or that it lies on a line.
enum class PinKind { kPoint, kU, kV, kLine };

/// A vertex and where it is to be.
struct HeldVertex {
  Index vertex;
  Vec2 place;  ///< of kU and kV one coordinate counts; of kLine a point of the line
  PinKind kind = PinKind::kPoint;
  Vec2 along = Vec2::Zero();  ///< of kLine: its direction, of any length but 0

  /// The unit normal of the line that the vertex may slide along; zero for a point.
  Vec2 normal() const;
};

struct HeldMap {
  std::vector<Vec2> uvs;  ///< one per vertex, what is held exactly in its place, but lines, which
                          ///< are met within rounding; else none
  double scale = 1;       ///< of the map against the surface: lengths per length
  bool converged = true;  ///< the optimisation was not cut short
  bool presses = false;   ///< of drag_pins: the boundary presses on itself
  /// Where not all could be met: the first that could not be together with those before it, or
  /// where the time was up a later one.
  Index failed = kNone;
};

/// The similarity after which a map meets its pins best: two points say all of it; fewer leave its
/// turn or its scale to the lines, and what these leave open as it is. Keeps the orientation.
/// Precondition: one pin at least.
Similarity fit_to_pins(const std::vector<Vec2>& uvs, std::span<const HeldVertex> pins);

/// Puts a map in place by the similarity that fits the pins best, which keeps its orientation, and
/// by its own scale where they do not say how large it is, and
/// bends it from there in steps that fold no face until every pin is met; then minimises the energy
/// against the surface at that scale with the pins held. Where the steps get stuck, all pins are
/// put in place at once and the folds are untangled; where that fails as well, pins are taken in
/// their order as far as it goes, which `failed` tells. Every face of the result is positive but
/// for roundoff; its boundary stays simple where that was asked for and the steps got there so. A
/// limit of time ends the minimising, not the way to the pins. Preconditions: a mesh of about unit
/// area; pins of different vertices, finite, one at least; not all faces without area. Throws Error
/// SOLVER, Cancelled or std::bad_alloc.
HeldMap hold_pins(const DiskMesh& mesh, const std::vector<Vec2>& uvs,
                  const std::vector<HeldVertex>& pins, const ChartOptions& options,
                  const Work& work);

/// What is known of a map that is dragged, which saves work.
struct Known {
  bool presses = false;               ///< drag_pins has left it so
  std::span<const Index> ranks = {};  ///< as NewtonOptions has them
};

/// Whether the boundary may touch itself where pins ask for it.
enum class Touching { kAllowed, kRefused };

/// The same from a map of positive faces that lies where it is to be: it is neither turned nor
/// scaled, which leaves its scale at 1, and its energy is minimised even where the pins are met
/// already. The work is that of a few steps where the map is near its minimum.
/// Touching::kAllowed: where sides of the boundary lie on each other they are let go first, and
/// parted by hardly anything where they come to lie over each other; where that does not do they
/// press, and a map that steps too few have left with more energy than before is not taken.
/// Touching::kRefused: from an injective map by steps that keep it so; `failed` is 0 where they get
/// stuck.
HeldMap drag_pins(const DiskMesh& mesh, const std::vector<Vec2>& uvs,
                  const std::vector<HeldVertex>& pins, Touching touching,
                  const ChartOptions& options, const Work& work, const Known& known = {});

}  // namespace beltrami
