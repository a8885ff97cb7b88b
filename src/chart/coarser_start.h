// Starts of a descent from the minimum of a coarser mesh: the pipeline in small.
#pragma once

#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "chart/options.h"
#include "mesh/disk_mesh.h"
#include "mesh/rest_shape.h"

namespace beltrami {

/// Simplification may get stuck far above its target: a coarse mesh that keeps more of the faces
/// than this saves nothing.
inline constexpr double kLeastReduction = 0.7;

/// Coarse faces with which a run that broke its promise is tried again (paper section 3.2).
inline constexpr Index kFallbacks[] = {1000, 100};

/// A mesh of a tenth of the faces, or 1,000, or 100, is flattened and its metric prolonged. One UV
/// per vertex, every face positive; empty if every size leaves faces flipped. Throws Error SOLVER.
std::vector<Vec2> start_from_coarser(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                                     const ChartOptions& options, const Work& work);

/// The minimum with contact of a mesh of a quarter of the faces, from the map `start` of this one,
/// carried over: steps with contact are many, and cheap there. Empty where it is not injective
/// here.
std::vector<Vec2> contact_from_coarser(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                                       const std::vector<Vec2>& start, const ChartOptions& options,
                                       const Work& work);

}  // namespace beltrami
