// The memory of the way in levels.
#include <algorithm>

#include "base/types.h"
#include "base/vectors.h"
#include "linear/spd_solver.h"
#include "mesh/rest_shape.h"
#include "multilevel/memory.h"
#include "multilevel/mode_bytes.h"
#include "multilevel/policy.h"
#include "prolong/interpolation.h"
#include "simplify/levels.h"

namespace beltrami {
namespace {

/// L-BFGS, as metric_mode has it, with the map; on a large mesh without the steps and one gradient.
constexpr double kPolishFields = 2 * 5 + 4 + 1, kLargeFields = 4;
/// Neighbours of a vertex.
constexpr double kNeighbours = 6;
/// Bytes of a vertex of a coarser level with all that is kept of it.
constexpr double kLevel = 250;
/// What all coarser levels have of the fine vertices: sweeps end below an eighth.
constexpr double kLevels = 1.0 / 7;

/// What a mesh of so many faces has of these counts.
MeshCounts part_of(const MeshCounts& n, double faces) {
  const double share = std::min(1.0, faces / n.faces);
  return {share * n.vertices, share * n.faces, share * n.boundary, n.regular, n.metas};
}

}  // namespace

double climb_hessian_bytes(const MeshCounts& n, int threads) {
  const MeshCounts level = part_of(n, std::min<double>(kMostFactored, kCoarseEnough * n.faces));
  const System system = system_bytes(level, 2, Precision::kSingle, threads);
  return std::max(climb_bytes(n, threads) + system.preconditioner,
                  climb_bytes(level, threads) + system.peak);
}

double climb_bytes(const MeshCounts& n, int threads) {
  const double row = sizeof(Footpoint) + 3 * sizeof(Index) + sizeof(float) +
                     kNeighbours * (sizeof(Index) + sizeof(float));
  const double single = 2 * sizeof(Eigen::Vector2f);
  const double fields =
      std::max(kPolishFields * part_of(n, kLargeMesh).vertices, kLargeFields * n.vertices);
  const double climb = n.faces * sizeof(RestTriangle) + fields * sizeof(Vec2) +
                       n.vertices * (row + single + sizeof(Index)) + kLevels * n.vertices * kLevel;
  // The coarsest level, or a hard one with its factor; so it never takes less than a disk that has
  // no levels yet.
  const MeshCounts coarsest = part_of(n, kMostFactored);
  return std::max({climb, coarse_bytes(coarsest, 0, threads), metric_bytes(coarsest, threads)});
}

}  // namespace beltrami
