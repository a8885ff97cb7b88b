// What depends on the size of a disk, or on how hard it is: every switch by a number of faces is
// here, and each decision on the way up is a function of a report on the level.
#pragma once

#include <cstdint>

#include "base/types.h"
#include "multilevel/options.h"

namespace beltrami {

// ---- Sizes
// ---------------------------------------------------------------------------------------

/// From so many faces on, few steps on the finest level are worth their time; and beside coarse
/// faces that are asked for levels are worth it.
inline constexpr Index kManyFaces = 100'000;

/// Up to so many faces composite majorization of a level costs little beside the run.
inline constexpr Index kFewFaces = 25'000;

/// Up to so many faces a factor of a level costs little beside the run.
inline constexpr Index kMostFactored = 150'000;

/// With more faces a step takes a tenth of a second: a round may gain less, and steps are not
/// remembered, for memory; but where a map is polished to the end without contact, which is done
/// beside a factor of the whole mesh.
inline constexpr Index kLargeMesh = 400'000;

/// Of fewer faces a region is half of the mesh: patches are relaxed instead.
inline constexpr Index kLeastForRegions = 20'000;

/// From so many faces on steps with contact are many and dear enough for a start from a coarser
/// mesh.
inline constexpr Index kContactFaces = 3000;

/// Coarse faces with which a run that broke its promise is tried again (paper section 3.2).
inline constexpr Index kFallbacks[] = {1000, 100};

/// Simplification may get stuck far above its target: a coarse mesh that keeps more of the faces
/// than this saves nothing.
inline constexpr double kLeastReduction = 0.7;

/// Faces that a mesh of so many is simplified to: the number `asked` for, or (0) max(1%, 10,000),
/// and no more than it has.
Index coarse_faces(Index faces, std::int64_t asked);

/// Faces of the coarsest of several levels of a disk of so many.
Index coarsest_faces(Index faces);

/// Whether a disk of so many faces is flattened in levels (climb.cpp): a large one, in the metric
/// way, with the `coarse` faces that the options ask for. What is tried where a map broke its
/// promise is not.
bool has_levels(Index faces, Index coarse, const ChartOptions& options);

/// Steps on the way of a map of so many faces to its pins: fewer of a large one, where each takes
/// longer.
Index most_pin_steps(Index faces);

// ---- Levels
// --------------------------------------------------------------------------------------

/// How long a polish may get.
enum class PolishLength {
  kWhole,  ///< to a stationary point
  kLong,   ///< of a map that a finer mesh starts from, of a small mesh, or where coarser ones were
           ///< hard
  kShort,  ///< of a map that came from a polished one of a coarser mesh: ends where a step promises
           ///< little
};

/// What makes a level hard to polish.
enum class Difficulty {
  kNone,
  kHard,     ///< a polish below did not end at rest, a level below needed its own factor, or the
             ///< solve left many faces flipped though it had a Hessian
  kPressed,  ///< parts of its boundary press on each other: it comes to rest slowly
};

PolishLength polish_length(Index faces, bool is_finest, Difficulty difficulty);

/// Shares of the faces of a level: more flipped ones, or more that are left to patches, and it is
/// hard for the V-cycle.
struct Bearable {
  double flips, patches;
};

Bearable bearable_at(Index faces, bool is_finest);

/// A level as the V-cycle leaves it.
struct LevelReport {
  Index faces;
  bool is_finest;
  bool injective;   ///< there is a map
  bool at_rest;     ///< its polish ended stationary
  bool in_contact;  ///< parts of its boundary press on each other
};

/// What follows the V-cycle.
enum class Remedy {
  kNone,          ///< the next level
  kMajorization,  ///< of the whole level
  kFactor,        ///< of the level's own stiffness: the metric way, from the map of the level below
};

Remedy remedy_for(const LevelReport& level);

/// Whether composite majorization starts from the map of the level; else from scratch.
bool starts_from_map(const LevelReport& level);

}  // namespace beltrami
