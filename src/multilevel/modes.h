// The ways to a map of a disk: each a function from the disk, or from its problem (map_problem.h),
// to a map, in a file of its own. mode_bytes.h has the memory that they take.
//
// All maps have one UV per vertex. A mode throws Error SOLVER where a system cannot be solved, and
// ends with what it has where the time of its work is up.
#pragma once

#include <functional>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "flatten/laplacian.h"
#include "mesh/disk_mesh.h"
#include "multilevel/chart_map.h"
#include "multilevel/inherited.h"
#include "multilevel/map_problem.h"
#include "multilevel/options.h"

namespace beltrami {

/// Composite majorization on the whole mesh, as the stage `name`; from `start` where that serves,
/// see Inherited.
ChartMap cm_mode(const DiskMesh& mesh, const char* name, const std::vector<Vec2>& start,
                 const ChartOptions& options, const Work& work);

/// In levels: the mesh simplified in steps, the coarsest flattened by a mode below, and from each
/// level to the next finer one its derivative carried, solved for by a V-cycle, mended and
/// polished. Without UVs where no level leads to an injective map.
ChartMap climb_mode(const DiskMesh& mesh, const Inherited& inherited, const ChartOptions& options,
                    const Work& work);

/// From the problem of a fine mesh, which knows the metric, to its map.
using FlattenFine = std::function<ChartMap(const MapProblem& problem, const Work& work)>;

/// With one coarse mesh: composite majorization on `coarse_faces` faces, prolongation of its
/// metric, and `flatten` on that (paper section 3). The mesh as its own coarse mesh where it is as
/// small as that, or cannot be simplified. `harmonic`: the problem is to have cotangents.
ChartMap prolonged_mode(const DiskMesh& mesh, Index coarse_faces, const Inherited& inherited,
                        bool harmonic, const FlattenFine& flatten, const ChartOptions& options,
                        const Work& work);

/// The metric solve by a factor, with a free boundary, its repair and its polish.
ChartMap metric_mode(const MapProblem& problem, const ChartOptions& options, const Work& work);

/// The harmonic map in the metric of the corner `cotangents`, its boundary from the coarse map.
ChartMap harmonic_mode(const MapProblem& problem, const std::vector<Cotangents>& cotangents,
                       const ChartOptions& options, const Work& work);

}  // namespace beltrami
