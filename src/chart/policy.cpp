#include "chart/policy.h"

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

bool is_nested(Index faces, Index coarse, const ChartOptions& options) {
  if (options.flatten != Flatten::kMetric || options.delaunay) return false;
  if (coarse != coarse_faces(faces, options.coarse_faces)) return false;
  if (options.coarse_faces == 0) return faces >= kLeastFaces;
  return faces >= kManyFaces && coarse <= faces / kLeastRatio;
}

}  // namespace beltrami
