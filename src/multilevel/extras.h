// What a run does on hard meshes only, where its memory allows it.
#pragma once

#include <cstdint>

#include "base/work.h"
#include "mesh/disk_mesh.h"
#include "multilevel/memory.h"
#include "multilevel/options.h"

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

/// Bytes of a whole run whose greatest stage takes `stage`.
std::uint64_t run_bytes(const MeshCounts& n, const ChartOptions& options, double stage);

/// Whether the run stays within the memory limit of its work with this extra.
bool affords(const DiskMesh& mesh, const ChartOptions& options, Extra extra, const Work& work);

/// For a disk that cannot be had in levels. Error OUT_OF_MEMORY where the run does not afford
/// Extra::kWholeFactor.
void require_whole_factor(const DiskMesh& mesh, const ChartOptions& options, const Work& work);

}  // namespace beltrami
