// The modes: each a function from a disk, or from what is known of it (fine_problem.h), to a map,
// in a file of its own. mode_bytes.h has the memory that they take.
//
// All maps have one UV per vertex. A mode throws Error SOLVER where a system cannot be solved, and
// ends with what it has where the time of its work is up.
#pragma once

#include <vector>

#include "base/types.h"
#include "base/work.h"
#include "chart/chart_map.h"
#include "chart/fine_problem.h"
#include "chart/inherited.h"
#include "chart/options.h"
#include "flatten/laplacian.h"
#include "mesh/disk_mesh.h"

namespace beltrami {

// ---- Methods: from the disk ---------------------------------------------------------------------

/// Coarse composite majorization on `coarse_faces` faces, prolongation of its metric, and the way
/// to flatten that the options name. The mesh as its own coarse mesh where it is as small as that,
/// or cannot be simplified.
ChartMap beltrami_mode(const DiskMesh& mesh, Index coarse_faces, const Inherited& inherited,
                       const ChartOptions& options, const Work& work);

/// The method beltrami in levels: the mesh simplified in steps, the coarsest flattened by the
/// method itself, and from each level to the next finer one its derivative carried, solved for by a
/// V-cycle, mended and polished. Without UVs where no level leads to an injective map.
ChartMap nested_mode(const DiskMesh& mesh, const Inherited& inherited, const ChartOptions& options,
                     const Work& work);

/// Tutte's embedding, mended.
ChartMap tutte_mode(const DiskMesh& mesh, const ChartOptions& options, const Work& work);

/// GIF or BFF, as the method says, on the metric of the surface itself: the baselines.
ChartMap plain_mode(const DiskMesh& mesh, const ChartOptions& options, const Work& work);

/// The baseline that carries the UVs of the coarse map over. Promises nothing.
ChartMap uv_prolongation_mode(const DiskMesh& mesh, Index coarse_faces, const ChartOptions& options,
                              const Work& work);

// ---- Ways to flatten: from the metric -----------------------------------------------------------

/// The metric solve with a free boundary, its repair and its polish.
ChartMap metric_mode(const FineProblem& fine, const ChartOptions& options, const Work& work);

/// The harmonic map in the metric of the corner `cotangents`, its boundary from the coarse map.
ChartMap dirichlet_mode(const FineProblem& fine, const std::vector<Cotangents>& cotangents,
                        const ChartOptions& options, const Work& work);

/// GIF (with `scaffold`) or FLIM: a few boundary vertices lead, the inside is harmonic.
ChartMap reduced_mode(const FineProblem& fine, bool scaffold, const ChartOptions& options,
                      const Work& work);

/// Conformal in the metric. No guarantee, so nothing is mended: its flips are what it is judged by.
ChartMap boundary_first_mode(const FineProblem& fine, const ChartOptions& options,
                             const Work& work);

}  // namespace beltrami
