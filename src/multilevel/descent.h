// Composite majorization as the modes use it: with a lead, with contact where the boundary would
// cross itself, and from a start that may come from the minimum of a coarser mesh.
#pragma once

#include <vector>

#include "base/vectors.h"
#include "base/work.h"
#include "descend/newton.h"
#include "mesh/disk_mesh.h"
#include "mesh/rest_shape.h"
#include "multilevel/options.h"

namespace beltrami {

/// A map that a descent ended with.
struct Descent {
  std::vector<Vec2> uvs;    ///< one per vertex
  double energy = 0;        ///< mean
  int iterations = 0;       ///< on the way to it
  bool converged = false;   ///< it was not cut short by a limit
  bool in_contact = false;  ///< boundary parts press on each other
};

/// Those of the options, ending when the time of `work` is up.
NewtonOptions newton_options(const ChartOptions& options);

/// Scales a map so that its mean energy is least.
void scale_best(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                const ChartOptions& options, const Work& work, std::vector<Vec2>& uvs);

/// From `start` with the contact of `newton`, if any; another energy than the symmetric Dirichlet
/// one is led to by that. Precondition: every face is positive in `start`. Throws Error SOLVER.
Descent descend_led(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                    std::vector<Vec2> start, const NewtonOptions& newton, const Work& work);

/// The free minimum from `start`; where its boundary crosses itself, and is to stay `simple`, the
/// minimum with contact, from the last map on the way whose boundary was simple. A map whose
/// boundary parts press on each other already needs no try without contact. Precondition: every
/// face is positive in `start`. Throws Error SOLVER.
Descent descend(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                std::vector<Vec2> start, NewtonOptions newton, bool simple,
                const ChartOptions& options, const Work& work);

/// Tutte's embedding, mended. Where it is folded beyond repair in floating point, a start from a
/// coarser mesh; where that fails too, a drawing that cannot fold but for the rounding of its
/// numbers. One UV per vertex. Throws Error SOLVER.
std::vector<Vec2> start_map(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                            const ChartOptions& options, const Work& work);

/// A mesh of a tenth of the faces, or 1,000, or 100, is flattened and its metric prolonged. One UV
/// per vertex, every face positive; empty if every size leaves faces flipped. Throws Error SOLVER.
std::vector<Vec2> start_from_coarser(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                                     const ChartOptions& options, const Work& work);

}  // namespace beltrami
