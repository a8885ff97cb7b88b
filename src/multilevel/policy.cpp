#include "multilevel/policy.h"

#include <algorithm>

namespace beltrami {
namespace {

// Of the one coarse mesh of a disk (paper section 3.2).
constexpr std::int64_t kLeastCoarseFaces = 10000;
constexpr double kCoarseShare = 0.01;
/// From so many faces on a disk has levels: fewer cost less than a level.
constexpr Index kLeastFaces = 4000;
/// Where coarse faces are asked for, levels are worth it if there are so many times as many.
constexpr Index kLeastRatio = 8;
/// The coarsest level has a quarter of the faces, within bounds: with fewer it is another shape.
/// From twenty times the second on it has a twentieth, up to the third.
constexpr Index kQuarter = 4, kTwentieth = 20;
constexpr Index kLeastCoarsest = 1000, kFairCoarsest = 2500, kMostCoarsest = 5000;

/// On the way to pins: faces that may be moved in all steps together, and the bounds of these.
constexpr Index kMostPinFaceSteps = 6'000'000, kLeastPinSteps = 15, kMostPinSteps = 60;

/// Where a factor is cheap, and on any level. For patches no more than 2%, up to which a repair has
/// regions before them.
constexpr Bearable kWhereCheap{5e-2, 2e-2}, kOnAnyLevel{1e-2, 1e-2};

/// Whether a factor of this level is cheap beside what is above it.
bool is_cheap(Index faces, bool is_finest) {
  return faces <= kMostFactored && !is_finest;
}

/// Whether composite majorization is what a level that is hard ends with.
bool is_for_majorization(const LevelReport& level) {
  if (level.is_finest) return level.faces < kManyFaces;
  return level.faces <= kFewFaces && !level.in_contact;
}

}  // namespace

Index coarse_faces(Index faces, std::int64_t asked) {
  const double share = kCoarseShare * faces;
  const auto target =
      asked > 0 ? asked : std::max(kLeastCoarseFaces, static_cast<std::int64_t>(share));
  return static_cast<Index>(std::min<std::int64_t>(target, faces));
}

Index coarsest_faces(Index faces) {
  const Index most = std::clamp(faces / kTwentieth, kFairCoarsest, kMostCoarsest);
  return std::clamp(faces / kQuarter, kLeastCoarsest, most);
}

Index most_pin_steps(Index faces) {
  return std::clamp(kMostPinFaceSteps / faces, kLeastPinSteps, kMostPinSteps);
}

bool has_levels(Index faces, Index coarse, const ChartOptions& options) {
  if (options.flatten != Flatten::kMetric || options.delaunay) return false;
  if (coarse != coarse_faces(faces, options.coarse_faces)) return false;
  if (options.coarse_faces == 0) return faces >= kLeastFaces;
  return faces >= kManyFaces && coarse <= faces / kLeastRatio;
}

PolishLength polish_length(Index faces, bool is_finest, Difficulty difficulty) {
  if (difficulty == Difficulty::kPressed) return PolishLength::kWhole;
  if (!is_finest || faces < kManyFaces) return PolishLength::kLong;
  return difficulty == Difficulty::kHard ? PolishLength::kLong : PolishLength::kShort;
}

Bearable bearable_at(Index faces, bool is_finest) {
  return is_cheap(faces, is_finest) ? kWhereCheap : kOnAnyLevel;
}

Remedy remedy_for(const LevelReport& level) {
  const bool by_majorization = is_for_majorization(level);
  // Elsewhere finer levels go on with what is not at rest.
  const bool must_rest =
      by_majorization || (level.in_contact && is_cheap(level.faces, level.is_finest));
  if (level.injective && (level.at_rest || !must_rest)) return Remedy::kNone;
  return by_majorization ? Remedy::kMajorization : Remedy::kFactor;
}

bool starts_from_map(const LevelReport& level) {
  return level.injective && (level.is_finest || !level.in_contact);
}

}  // namespace beltrami
