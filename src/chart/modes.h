// The modes: each a function from a disk, or from what is known of it (fine_problem.h), to a map,
// in a file of its own, with the memory that it takes at its peak. Bytes are without the context
// and, of the modes that take a FineProblem, with it; memory_estimate.h puts them together.
//
// All maps have one UV per vertex. A mode throws Error SOLVER where a system cannot be solved, and
// ends with what it has where the time of its work is up.
#pragma once

#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "chart/chart_map.h"
#include "chart/descent.h"
#include "chart/fine_problem.h"
#include "chart/inherited.h"
#include "chart/memory.h"
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

/// Whether a disk of so many faces is flattened in levels (nested_mode): a large one, in the metric
/// way, with the `coarse` faces that the options ask for. What is tried where a map broke its
/// promise is not.
bool is_nested(Index faces, Index coarse, const ChartOptions& options);

/// The method beltrami in levels: the mesh simplified in steps, the coarsest flattened by the
/// method itself, and from each level to the next finer one its derivative carried, solved for by a
/// V-cycle, mended and polished. Without UVs where no level leads to an injective map.
ChartMap nested_mode(const DiskMesh& mesh, const Inherited& inherited, const ChartOptions& options,
                     const Work& work);

/// Composite majorization on the whole mesh, as the stage `name`; from `start` where that serves,
/// see Inherited.
ChartMap cm_mode(const DiskMesh& mesh, const char* name, const std::vector<Vec2>& start,
                 const ChartOptions& options, const Work& work);

/// Tutte's embedding, mended.
ChartMap tutte_mode(const DiskMesh& mesh, const ChartOptions& options, const Work& work);

/// GIF or BFF, as the method says, on the metric of the surface itself: the baselines.
ChartMap plain_mode(const DiskMesh& mesh, const ChartOptions& options, const Work& work);

/// The baseline that carries the UVs of the coarse map over. Promises nothing.
ChartMap uv_prolongation_mode(const DiskMesh& mesh, Index coarse_faces, const ChartOptions& options,
                              const Work& work);

/// A start, then composite majorization to `tolerance`. Where it crawls at an enormous energy,
/// again from a coarser mesh; the better map is kept. A start with flips is returned as it is, its
/// energy 0.
Descent minimise_from_scratch(const DiskMesh& mesh, double tolerance, const ChartOptions& options,
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

// ---- What they take of memory -------------------------------------------------------------------

/// Newton's method on all faces, without the map itself.
double newton_bytes(const MeshCounts& n, int threads);
/// From Tutte's embedding on; in a scaffold, the mesh is copied into it.
double cm_bytes(const MeshCounts& n, bool scaffold, int threads);
double tutte_bytes(const MeshCounts& n, int threads);
double metric_bytes(const MeshCounts& n, int threads);
/// The metric mode's problem, and the factor of its solve: what is alive beside its extras.
double metric_factor_bytes(const MeshCounts& n, int threads);
/// The harmonic map beside another.
double harmonic_bytes(const MeshCounts& n, int threads);
/// In levels, where the finest needs no factor.
double nested_bytes(const MeshCounts& n, int threads);
/// The same with a Hessian of the level below the finest.
double nested_hessian_bytes(const MeshCounts& n, int threads);
double dirichlet_bytes(const MeshCounts& n, int threads);
double reduced_bytes(const MeshCounts& n, int threads);
double boundary_first_bytes(const MeshCounts& n, int threads);

}  // namespace beltrami
