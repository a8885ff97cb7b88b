// The method beltrami in levels: no factorization but that of the coarsest.
#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "base/types.h"
#include "base/work.h"
#include "chart/anchors.h"
#include "chart/chart_map.h"
#include "chart/fine_problem.h"
#include "chart/inherited.h"
#include "chart/memory.h"
#include "chart/modes.h"
#include "chart/options.h"
#include "chart/polish_schedule.h"
#include "descend/contact.h"
#include "descend/tutte.h"
#include "energy/energy.h"
#include "exact/certificate.h"
#include "exact/crossings.h"
#include "flatten/carried_target.h"
#include "flatten/dirichlet.h"
#include "flatten/laplacian.h"
#include "flatten/metric.h"
#include "flatten/v_cycle.h"
#include "linear/smoother.h"
#include "mesh/boundary.h"
#include "mesh/disk_mesh.h"
#include "mesh/rest_shape.h"
#include "prolong/derivative.h"
#include "prolong/interpolation.h"
#include "simplify/levels.h"
#include "simplify/simplify.h"

namespace beltrami {
namespace {

/// From so many faces on.
constexpr Index kLeastFaces = 100000;
/// Times the coarse faces, at least.
constexpr Index kLeastRatio = 8;
/// Faces of the coarsest level: usually, and where that turned out to be a hard one.
constexpr std::array<Index, 2> kCoarsestFaces = {10000, 70000};
constexpr int kSteps = 2;                 // of conjugate gradients from an interpolated map
constexpr int kRounds = 3;                // of so many steps, while more than
constexpr double kFewFlips = 5e-5;        // of the faces are flipped
constexpr double kManyFlips = 1e-3;       // are those of a hard level, of which
constexpr double kTooManyFlips = 2e-3;    // are more than is worth mending
constexpr std::size_t kMostPatches = 30;  // beyond, a finer coarsest level is cheaper
/// Times the energy of the level below, beyond which a map that is not stationary is useless.
constexpr double kHopelessly = 1.2;
// Shares of the progress.
constexpr double kSimplified = 0.25, kStarted = 0.4;

/// L-BFGS, as metric_mode has it, with the map and the one that it started from.
constexpr double kPolishFields = 2 * 5 + 5 + 2;
/// Neighbours of a vertex.
constexpr double kNeighbours = 6;
/// Bytes of a vertex of a coarser level with all that is kept of it.
constexpr double kLevel = 300;
/// What all coarser levels have of the fine vertices: sweeps end below an eighth.
constexpr double kLevels = 1.0 / 7;

/// A map on the way up, with what it took.
struct Climb {
  ChartMap map;        ///< of the level reached
  double energy = 0;   ///< mean, of that level; at the end, of the one below the finest
  bool hard = false;   ///< the polish of a level did not end stationary
  bool failed = true;  ///< without an injective map, or far from the energy of the level below
};

bool is_injective(const DiskMesh& mesh, const std::vector<Vec2>& uvs, bool simple,
                  const Work& work) {
  return non_positive_faces(mesh.faces, uvs, work).empty() &&
         (!simple || find_crossings(mesh.boundary, uvs).empty());
}

/// A level as its solve sees it.
struct Level {
  FineProblem problem;
  const CoarseDisk& coarse;
  std::vector<Vec2> carried;  ///< the map of the coarse level at the footpoints
  TargetEquations equations;
  BoundaryContact contact;
};

Level prepare_level(const DiskMesh& mesh, const CoarseDisk& coarse, const ChartOptions& options,
                    const Work& work, VCycle& cycle, Climb& climb) {
  Level level{
      .problem = {.mesh = &mesh},
      .coarse = coarse,
      .carried = {},
      .equations = {},
      .contact = {mesh.boundary, boundary_lengths(mesh), coarse_boundary_lengths(mesh, coarse)}};
  run_stage("prolong", work, climb.map.statistics.stages, [&](StageStatistics&, const Work& inner) {
    level.problem.rest = rest_triangles(mesh.positions, mesh.faces, inner);
    level.problem.statistics.coarse_energy = climb.energy;
    std::vector<Footpoint> points =
        footpoints(coarse.mesh, coarse.fine_vertex, coarse.nearby, mesh, inner);
    inner.report(0.5);
    const auto coarse_rest = rest_triangles(coarse.mesh.positions, coarse.mesh.faces, inner);
    const auto derivatives =
        carried(vertex_derivatives(coarse.mesh, coarse_rest, climb.map.uvs, inner), points, inner);
    level.carried = carried(climb.map.uvs, points, inner);
    level.equations = target_equations(options.energy, mesh, level.problem.rest, derivatives,
                                       level.carried, inner);
    cycle.add(mesh, std::move(points));
  });
  return level;
}

/// Springs for the anchored vertices, as stiff_springs.
std::vector<double> springs_of(const DiskMesh& mesh, const TargetEquations& equations,
                               const std::vector<bool>& anchored) {
  if (anchored.empty()) return {};
  std::vector<EdgeWeights> stiffness(mesh.faces.size());
  for (std::size_t f = 0; f < stiffness.size(); ++f) {
    for (int k = 0; k < 3; ++k) stiffness[f][k] = double{equations.weights[f][k]};
  }
  return stiff_springs(mesh, stiffness, anchored);
}

/// The stage "flatten": a few steps from the carried map, whose anchored vertices stay. Returns
/// whether no more than a share of `most_flips` of the faces is flipped.
bool solve_level(const Level& level, const std::vector<bool>& anchored, double most_flips,
                 const Work& work, VCycle& cycle, ChartMap& map) {
  std::size_t flips = 0;
  const DiskMesh& mesh = *level.problem.mesh;
  run_stage("flatten", work, map.statistics.stages, [&](StageStatistics&, const Work& inner) {
    cycle.set(level.equations.weights, springs_of(mesh, level.equations, anchored));
    copy_field(inner, level.carried, map.uvs);
    SingleField residual;
    copy_field(inner, level.equations.residual, residual);
    for (int round = 0; round < kRounds; ++round) {
      cycle.improve(kSteps, residual, map.uvs);
      flips = non_positive_faces(mesh.faces, map.uvs, inner).size();
      if (static_cast<double>(flips) <= kFewFlips * mesh.face_count()) break;
    }
    put_in_place(anchored, level.carried, map.uvs);
    if (static_cast<double>(flips) <= kFewFlips * mesh.face_count()) return;
    const std::size_t of_carried = non_positive_faces(mesh.faces, level.carried, inner).size();

    if (of_carried >= flips) return;
    flips = of_carried;
    map.uvs = level.carried;
  });
  return static_cast<double>(flips) <= most_flips * mesh.face_count();
}

/// Polishes where it is worth it; with contact where the boundary would cross itself.
void polish_level(const Level& level, bool simple, PolishLength length, bool pressed,
                  const ChartOptions& options, const Work& work, VCycle& cycle, Climb& climb) {
  const bool may_return = simple && !pressed;
  std::vector<Vec2> start;
  if (may_return) copy_field(work, climb.map.uvs, start);
  ChartMap polished = polish_map(level.problem, pressed ? &level.contact : nullptr, length, options,
                                 work, cycle, std::move(climb.map.uvs));
  if (may_return && !level.contact.is_simple(polished.uvs)) {
    const StageStatistics lost = given_up(polished.statistics.stages);
    polished = polish_map(level.problem, &level.contact, PolishLength::kWhole, options, work, cycle,
                          std::move(start));
    polished.in_contact = true;
    climb.map.statistics.stages.push_back(lost);
  }
  climb.map.in_contact = climb.map.in_contact || polished.in_contact;
  climb.map.uvs = std::move(polished.uvs);
  climb.map.converged = polished.converged;
  climb.map.statistics.append(polished.statistics);
}

/// From the map of a coarse level to that of the next finer one.
void climb_to(const DiskMesh& mesh, const CoarseDisk& coarse, bool is_finest, bool last,
              const ChartOptions& options, const Work& work, VCycle& cycle, Climb& climb) {
  const bool simple = keeps_boundary_simple(options);
  Level level = prepare_level(mesh, coarse, options, work.part(0, 0.3), cycle, climb);
  const bool pressed = climb.map.in_contact && simple;
  std::vector<bool> anchored;
  if (pressed) anchored = vertices_in_contact(coarse, climb.map.uvs, mesh.vertex_count());
  bool positive = false;
  const auto solve = [&] {
    positive = solve_level(level, anchored, last ? kTooManyFlips : kManyFlips, work.part(0.3, 0.5),
                           cycle, climb.map) &&
               mend(level.problem, {.most_patches = kMostPatches, .global_fix = false}, options,
                    work.part(0.5, 0.6), climb.map);
    return positive;
  };
  const bool solved = simple ? solve_until_simple(mesh, climb.map.uvs, anchored, solve) : solve();
  climb.failed = !solved || !positive;
  if (climb.failed) return;
  level.equations = {};
  std::vector<Vec2>().swap(level.carried);
  const bool touches = !anchored.empty();
  climb.map.in_contact = climb.map.in_contact || touches;
  // What presses on itself comes to rest slowly, and on coarse levels at little cost.
  const PolishLength length = touches              ? PolishLength::kWhole
                              : is_finest && !last ? PolishLength::kShort
                                                   : PolishLength::kMiddling;
  polish_level(level, simple, length, touches, options, work.part(0.6, 1), cycle, climb);
  const bool converged = climb.map.converged;
  if (converged && is_finest) return;
  const double below = climb.energy;
  climb.energy = mean_energy(options.energy, mesh.faces, level.problem.rest, climb.map.uvs, work);
  if (converged) return;
  climb.hard = true;
  climb.failed = to_dirichlet(options.energy, climb.energy) >
                 kHopelessly * to_dirichlet(options.energy, below);
}

/// From the coarsest level to the finest. Ends early where a level is hard, but for the `last` try,
/// which takes its time.
Climb climb(const DiskMesh& mesh, const std::vector<CoarseDisk>& levels, bool last,
            const ChartOptions& options, const Work& work) {
  const DiskMesh& coarsest = levels.back().mesh;
  const Work begin = work.part(0, kStarted), rest = work.part(kStarted, 1);
  Climb climb;
  const Index faces = coarse_faces(coarsest.face_count(), options.coarse_faces);
  climb.map = beltrami_mode(coarsest, faces, {}, options, begin);
  const bool simple = keeps_boundary_simple(options);
  climb.failed = !is_injective(coarsest, climb.map.uvs, simple, begin);
  climb.hard = climb.failed || !climb.map.converged;
  if (climb.failed || (climb.hard && !last)) return climb;
  const auto flat = rest_triangles(coarsest.positions, coarsest.faces, begin);
  climb.energy = mean_energy(options.energy, coarsest.faces, flat, climb.map.uvs, begin);
  VCycle cycle(coarsest,
               energy_stiffness(options.energy, coarsest.faces, flat, climb.map.uvs, begin), begin);
  for (std::size_t l = levels.size(); l-- > 0;) {
    const DiskMesh& finer = l > 0 ? levels[l - 1].mesh : mesh;
    const double from = 1 - static_cast<double>(l + 1) / static_cast<double>(levels.size());
    climb_to(finer, levels[l], l == 0, last, options, rest.part(from, 1), cycle, climb);
    if (climb.failed || (climb.hard && !last)) return climb;
  }
  return climb;
}

}  // namespace

double nested_bytes(const MeshCounts& n, int threads) {
  const double row = sizeof(Footpoint) + 3 * sizeof(Index) + sizeof(float) +
                     kNeighbours * (sizeof(Index) + sizeof(float));
  const double single = 3 * sizeof(Eigen::Vector2f);
  const double climb = n.faces * sizeof(RestTriangle) +
                       n.vertices * (kPolishFields * sizeof(Vec2) + row + single + sizeof(Index)) +
                       kLevels * n.vertices * kLevel;
  // The coarsest level, with room for a larger one; so it never takes less than a disk that has no
  // levels yet.
  const double share = std::min(1.0, kLeastFaces / n.faces);
  const MeshCounts coarsest{share * n.vertices, share * n.faces, share * n.boundary, n.regular,
                            n.metas};
  return std::max({climb, coarse_bytes(coarsest, 0, threads), metric_bytes(coarsest, threads)});
}

bool is_nested(Index faces, Index coarse, const ChartOptions& options) {
  return options.flatten == Flatten::kMetric && !options.delaunay && faces >= kLeastFaces &&
         coarse <= faces / kLeastRatio && coarse == coarse_faces(faces, options.coarse_faces);
}

ChartMap nested_mode(const DiskMesh& mesh, const Inherited& inherited, const ChartOptions& options,
                     const Work& work) {
  ChartStatistics statistics;
  Climb best;
  for (const Index usual : kCoarsestFaces) {
    const Index coarsest = std::max(usual, static_cast<Index>(options.coarse_faces));
    std::vector<CoarseDisk> levels;
    run_stage("simplify", work.part(0, kSimplified), statistics.stages,
              [&](StageStatistics&, const Work& inner) {
                levels = coarser_levels(mesh, inherited.level, coarsest, inner);
              });
    if (levels.empty()) continue;
    const bool is_last = usual == kCoarsestFaces.back();
    best = climb(mesh, levels, is_last, options, work.part(kSimplified, 1));
    if (!best.failed && (is_last || !best.hard)) break;
    statistics.stages.push_back(given_up(best.map.statistics.stages));
    best = {};
  }
  if (best.failed) best.map.uvs.clear();
  statistics.append(best.map.statistics);
  best.map.statistics = std::move(statistics);
  return std::move(best.map);
}

}  // namespace beltrami
