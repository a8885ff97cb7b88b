#include "multilevel/chart_map.h"

namespace beltrami {

void ChartStatistics::append(const ChartStatistics& next) {
  stages.insert(stages.end(), next.stages.begin(), next.stages.end());
  coarse_faces += next.coarse_faces;
  coarse_energy += next.coarse_energy;
  flips_before_repair += next.flips_before_repair;
  kernel_fixes += next.kernel_fixes;
  patch_fixes += next.patch_fixes;
  global_fixes += next.global_fixes;
  cleaned_patches += next.cleaned_patches;
  delaunay_flips += next.delaunay_flips;
  delaunay_refused += next.delaunay_refused;
}

StageStatistics given_up(const std::vector<StageStatistics>& stages) {
  StageStatistics all{"given-up"};
  for (const StageStatistics& stage : stages) {
    all.seconds += stage.seconds;
    all.cpu_seconds += stage.cpu_seconds;
  }
  return all;
}

}  // namespace beltrami
