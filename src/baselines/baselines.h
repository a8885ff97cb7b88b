// The ways to a map that others have published, beside which the metric one is measured: each a
// function from a disk, or from its problem (map_problem.h), to a map, in a file of its own.
//
// All maps have one UV per vertex. A mode throws Error SOLVER where a system cannot be solved, and
// ends with what it has where the time of its work is up.
#pragma once

#include "base/types.h"
#include "base/work.h"
#include "mesh/disk_mesh.h"
#include "multilevel/chart_map.h"
#include "multilevel/map_problem.h"
#include "multilevel/memory.h"
#include "multilevel/options.h"

namespace beltrami {

/// Tutte's embedding, mended.
ChartMap tutte_mode(const DiskMesh& mesh, const ChartOptions& options, const Work& work);

/// Carries the UVs of the coarse map over. Promises nothing.
ChartMap uv_prolongation_mode(const DiskMesh& mesh, Index coarse_faces, const ChartOptions& options,
                              const Work& work);

/// GIF (with `scaffold`) or FLIM: a few boundary vertices lead, the inside is harmonic.
ChartMap reduced_mode(const MapProblem& problem, bool scaffold, const ChartOptions& options,
                      const Work& work);

/// Boundary first flattening: conformal in the metric. No guarantee, so nothing is mended: its
/// flips are what it is judged by.
ChartMap boundary_first_mode(const MapProblem& problem, const ChartOptions& options,
                             const Work& work);

// ---- Bytes at the peak, see multilevel/mode_bytes.h
// ----------------------------------------------

double tutte_bytes(const MeshCounts& n, int threads);
double reduced_bytes(const MeshCounts& n, int threads);
double boundary_first_bytes(const MeshCounts& n, int threads);

/// Meta vertices that reduced_mode takes; choosing them takes longer than counting.
double count_metas(const DiskMesh& mesh);

}  // namespace beltrami
