// What a mode leaves behind: a map and how it came about, as one value.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "base/resources.h"
#include "base/vectors.h"
#include "base/work.h"
#include "mesh/disk_mesh.h"

namespace beltrami {

struct StageStatistics {
  const char* name;
  int iterations = 0;  ///< 0 where a stage does not iterate
  double seconds = 0, cpu_seconds = 0;
};

/// How a map came about; of tries that were given up for it nothing but their time.
struct ChartStatistics {
  std::vector<StageStatistics> stages;  ///< in the order in which they ran
  std::int64_t coarse_faces = 0;        ///< of the mesh that composite majorization ran on
  double coarse_energy = 0;             ///< its mean energy there, 0 where it did not run
  std::int64_t flips_before_repair = 0;
  std::int64_t kernel_fixes = 0, patch_fixes = 0, global_fixes = 0;  ///< see repair.h
  std::int64_t cleaned_patches = 0;                                  ///< see outliers.h
  std::int64_t delaunay_flips = 0, delaunay_refused = 0;             ///< see intrinsic_delaunay.h

  /// Adds what ran next.
  void append(const ChartStatistics& next);
};

struct ChartMap {
  std::vector<Vec2> uvs;    ///< one per vertex
  bool converged = true;    ///< no optimisation was cut short
  bool in_contact = false;  ///< parts of the boundary press on each other
  ChartStatistics statistics;
  /// The disk whose faces the map has, where they are not those of the disk that it is of.
  std::unique_ptr<DiskMesh> retriangulated;
};

/// The time of stages whose results are not kept, as the one stage "given-up".
StageStatistics given_up(const std::vector<StageStatistics>& stages);

/// Runs `body(statistics, work)` as the stage `name`, timed, and adds it to `stages`.
template <class Body>
void run_stage(const char* name, const Work& work, std::vector<StageStatistics>& stages,
               Body&& body) {
  const Work inner = work.named(name);
  const double wall = wall_seconds(), cpu = cpu_seconds();
  StageStatistics statistics{name};
  const char* before = work.trace() ? work.trace()->enter(name) : "";
  inner.report(0);
  std::forward<Body>(body)(statistics, inner);
  inner.report(1);
  if (work.trace()) work.trace()->enter(before);
  statistics.seconds = wall_seconds() - wall;
  statistics.cpu_seconds = cpu_seconds() - cpu;
  stages.push_back(statistics);
}

}  // namespace beltrami
