// The solve for the whole prolonged metric, with a free boundary: an ascent of one level, whose
// preconditioner is a factor.
#include <algorithm>
#include <memory>
#include <utility>

#include "base/vectors.h"
#include "base/work.h"
#include "descend/contact.h"
#include "exact/certificate.h"
#include "flatten/dirichlet.h"
#include "flatten/laplacian.h"
#include "flatten/metric.h"
#include "linear/spd_solver.h"
#include "mesh/boundary.h"
#include "mesh/disk_mesh.h"
#include "multilevel/anchors.h"
#include "multilevel/chart_map.h"
#include "multilevel/extras.h"
#include "multilevel/map_problem.h"
#include "multilevel/memory.h"
#include "multilevel/mode_bytes.h"
#include "multilevel/modes.h"
#include "multilevel/options.h"
#include "multilevel/policy.h"
#include "multilevel/polish_level.h"

namespace beltrami {
namespace {

constexpr double kRoughly = 1e-5;        // residual of a map that is polished afterwards
constexpr std::size_t kManyFlips = 20;   // beyond which targets are rotated
constexpr int kRotations = 2;            // ARAP rounds, then
constexpr double kFlippedShare = 0.001;  // beyond which the harmonic map is looked at too
/// L-BFGS: a step and a change of the gradient for each of 5 pairs, 4 buffers, and the three arrays
/// of a preconditioning.
constexpr double kPolishFields = 2 * 5 + 4 + 3;
// Shares of the progress.
constexpr double kSolved = 0.42, kMended = 0.47;

/// The harmonic map where it flips fewer faces: on extreme models the free map flips far more.
void take_harmonic_if_better(const MapProblem& fine, const std::vector<Vec2>& carried,
                             std::size_t flips, const Work& work, std::vector<Vec2>& uvs) {
  std::vector<Vec2> harmonic = carried;
  solve_harmonic(*fine.mesh, modified_cotangents(fine.rest, fine.metric, work), harmonic, work);
  if (non_positive_faces(fine.mesh->faces, harmonic, work).size() < flips) {
    uvs.swap(harmonic);
  }
}

/// Sets `laplacian` up for the stiffness and the springs, where there is none yet.
void fit(const DiskMesh& mesh, const std::vector<EdgeWeights>& stiffness,
         const std::vector<double>& springs, const Work& work,
         std::unique_ptr<MetricLaplacian>& laplacian) {
  if (laplacian) {
    laplacian->refit(stiffness, springs);
    return;
  }
  const SolverOptions options{.precision = Precision::kSingle, .residual = kRoughly};
  laplacian = std::make_unique<MetricLaplacian>(mesh, stiffness, only_first_of_boundary(mesh),
                                                options, springs, work);
}

/// The stage "flatten": the solve, with the boundary vertices `anchored` drawn to their `carried`
/// places.
void solve_flat(const MapProblem& fine, const std::vector<Vec2>& carried,
                const std::vector<bool>& anchored, const ChartOptions& options, const Work& work,
                std::unique_ptr<MetricLaplacian>& laplacian, ChartMap& map) {
  const DiskMesh& mesh = *fine.mesh;
  map.uvs = carried;
  run_stage("flatten", work, map.statistics.stages, [&](StageStatistics&, const Work& inner) {
    const auto stiffness = energy_stiffness(options.energy, fine.rest, fine.metric, inner);
    const Anchors anchors{stiff_springs(mesh, stiffness, anchored), carried};
    fit(mesh, stiffness, anchors.springs, inner, laplacian);
    inner.report(0.75);
    const auto solve = [&](bool rotate) {
      solve_metric(mesh, fine.rest, fine.metric, stiffness, *laplacian, anchors, rotate, map.uvs,
                   inner);
      put_in_place(anchored, carried, map.uvs);
      return non_positive_faces(mesh.faces, map.uvs, inner).size();
    };
    std::size_t flips = solve(false);
    for (int round = 0; round < kRotations && flips > kManyFlips; ++round) flips = solve(true);
    const double share = static_cast<double>(flips) / mesh.face_count();
    if (flips <= kManyFlips || share <= kFlippedShare) return;
    if (!affords(mesh, options, Extra::kHarmonicMap, inner)) return;
    take_harmonic_if_better(fine, carried, flips, inner, map.uvs);
  });
}

/// What is alive beside the work of the mode: the problem, and where the coarse map has the
/// boundary.
double problem_bytes(const MeshCounts& n) {
  return fine_bytes(n) + n.vertices * sizeof(Vec2);
}

}  // namespace

double metric_bytes(const MeshCounts& n, int threads) {
  const System system = system_bytes(n, 1, Precision::kSingle, threads);
  const double solve = n.faces * sizeof(EdgeWeights) + system.peak;
  const double polish = system.kept + kPolishFields * n.vertices * sizeof(Vec2);
  return problem_bytes(n) + std::max(solve, polish);
}

double metric_factor_bytes(const MeshCounts& n, int threads) {
  return problem_bytes(n) + system_bytes(n, 1, Precision::kSingle, threads).kept;
}

/// Where boundary parts press on each other in the coarse map, and where the solve would have the
/// boundary cross itself, springs draw it to its place in the coarse map, further around in each
/// round; the polish then works with contact instead. (The coarse boundary is simple, or there is
/// nothing to be drawn to.) Where no round ends simple, the harmonic map.
ChartMap metric_mode(const MapProblem& fine, const ChartOptions& options, const Work& work) {
  const DiskMesh& mesh = *fine.mesh;
  const std::vector<Vec2> carried = carry_boundary(mesh, fine.coarse, fine.coarse_uvs);
  const BoundaryContact contact(mesh.boundary, boundary_lengths(mesh),
                                coarse_boundary_lengths(mesh, fine.coarse));
  const bool global = keeps_boundary_simple(options) && contact.is_simple(carried);
  std::vector<bool> anchored;
  if (global && fine.in_contact) {
    anchored = vertices_in_contact(fine.coarse, fine.coarse_uvs, mesh.vertex_count());
  }
  std::unique_ptr<MetricLaplacian> laplacian;
  ChartMap solved;
  bool positive = false;
  const auto solve = [&] {
    solve_flat(fine, carried, anchored, options, work.part(0, kSolved), laplacian, solved);
    positive = mend(fine, whole_repair(fine, false, options, work), options,
                    work.part(kSolved, kMended), solved);
    return true;
  };
  if (!global) {
    solve();
  } else if (!solve_until_simple(mesh, solved.uvs, anchored, solve)) {
    const auto cotangents = modified_cotangents(fine.rest, fine.metric, work);
    ChartMap harmonic = harmonic_mode(fine, cotangents, options, work.part(kMended, 1));
    auto& stages = harmonic.statistics.stages;
    stages.insert(stages.begin(), given_up(solved.statistics.stages));
    return harmonic;
  }
  if (!positive) return solved;
  solved.in_contact = !anchored.empty();
  std::vector<Vec2> start;
  if (global && !solved.in_contact) start = solved.uvs;
  const auto begin_again = [&](ChartMap& map) {
    map.uvs = std::move(start);
    return true;
  };
  polish_level(fine, contact, global, PolishLength::kWhole, options, work.part(kMended, 1),
               begin_again, *laplacian, solved);
  return solved;
}

}  // namespace beltrami
