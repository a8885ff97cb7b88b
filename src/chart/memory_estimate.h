// What a run will take of memory, from counts alone, before anything is allocated.
#pragma once

#include <cstdint>

#include "mesh/disk_mesh.h"
#include "multilevel/options.h"

namespace beltrami {

/// Bytes at the peak of a run with these options on so many threads, the context's mesh and results
/// included, extras not: the least memory limit that the run can do with. It is meant to be enough:
/// memory_estimate.cpp says what it leaves out. Takes milliseconds for a million faces.
std::uint64_t estimate_memory(const DiskMesh& mesh, const ChartOptions& options, int threads);

}  // namespace beltrami
