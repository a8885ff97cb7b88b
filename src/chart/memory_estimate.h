// What a run will take of memory, from counts alone, before anything is allocated.
#pragma once

#include <cstdint>

#include "base/work.h"
#include "chart/options.h"
#include "mesh/disk_mesh.h"

namespace beltrami {

/// What a run does on hard meshes only, beyond its estimate, and does without where its memory
/// limit is too low for it; or ends, where there is no map without (require_whole_factor).
enum class Extra {
  kHarmonicMap,   ///< beside the metric one, where that flips many faces
  kLevelHessian,  ///< of a level of several that is hard
  kWholeFactor,   ///< of the disk or a large level, where the way in levels leads nowhere
  kNewtonSteps,   ///< after a polish that nearly singular faces block: several times the memory
  kGlobalFix,     ///< of the repair
};

/// Bytes at the peak of a run with these options on so many threads, the context's mesh and results
/// included, extras not: the least memory limit that the run can do with. It is meant to be enough:
/// memory_estimate.cpp says what it leaves out. Takes milliseconds for a million faces.
std::uint64_t estimate_memory(const DiskMesh& mesh, const ChartOptions& options, int threads);

/// Whether the run stays within the memory limit of its work with this extra.
bool affords(const DiskMesh& mesh, const ChartOptions& options, Extra extra, const Work& work);

/// For a disk that cannot be had in levels. Error OUT_OF_MEMORY where the run does not afford
/// Extra::kWholeFactor.
void require_whole_factor(const DiskMesh& mesh, const ChartOptions& options, const Work& work);

}  // namespace beltrami
