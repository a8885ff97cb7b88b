#include "simplify/levels.h"

#include <algorithm>
#include <utility>

#include "simplify/replay.h"
#include "simplify/simplify.h"
#include "simplify/sweep.h"

namespace beltrami {
namespace {

constexpr Index kRatio = 8;
constexpr std::size_t kMostLevels = 16;  // of no more faces than an Index counts
constexpr double kNearEnough = 1.5;
/// A level with more of the faces of the one before than this is none.
constexpr double kLeastReduction = 0.8;
/// Sweeps that leave so many times the faces asked for are followed by passes: the boundary is
/// long.
constexpr double kFallenShort = 1.3;
/// The sweeps' share of the progress: that of their time.
constexpr double kSwept = 0.8;

/// By sweeps, and by passes what these leave.
CoarseDisk swept_disk(const DiskMesh& fine, Index target, const Work& work) {
  CoarseDisk level = sweep_disk(fine, target, work.part(0, kSwept));
  if (level.mesh.face_count() <= kFallenShort * target) return level;
  return simplify_further(level, target, work.part(kSwept, 1));
}

}  // namespace

std::vector<CoarseDisk> coarser_levels(const DiskMesh& fine, const std::optional<CoarseDisk>& known,
                                       Index coarsest_faces, const Work& work) {
  std::vector<CoarseDisk> levels;
  levels.reserve(kMostLevels);  // the meshes stay where they are
  const DiskMesh* last = &fine;
  if (known && known->mesh.face_count() <= kCoarseEnough * fine.face_count()) {
    levels.push_back(*known);
    last = &levels.back().mesh;
  }
  while (last->face_count() > kNearEnough * coarsest_faces) {
    const Index target = std::max(last->face_count() / kRatio, coarsest_faces);
    levels.push_back(levels.empty() ? swept_disk(*last, target, work.part(0, kSwept))
                                    : simplify(*last, target, work.part(kSwept, 1)));
    const DiskMesh& next = levels.back().mesh;
    if (next.face_count() > kLeastReduction * last->face_count()) return {};
    last = &next;
  }
  return levels;
}

}  // namespace beltrami
