// The method beltrami in levels: no factorization of the finest, but where all else fails.
#include <algorithm>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "chart/anchors.h"
#include "chart/chart_map.h"
#include "chart/composite_majorization.h"
#include "chart/fine_problem.h"
#include "chart/inherited.h"
#include "chart/memory.h"
#include "chart/memory_estimate.h"
#include "chart/mode_bytes.h"
#include "chart/modes.h"
#include "chart/options.h"
#include "chart/policy.h"
#include "chart/polish_schedule.h"
#include "descend/contact.h"
#include "descend/tutte.h"
#include "energy/energy.h"
#include "exact/certificate.h"
#include "exact/crossings.h"
#include "flatten/carried_target.h"
#include "flatten/dirichlet.h"
#include "flatten/metric.h"
#include "flatten/v_cycle.h"
#include "linear/smoother.h"
#include "linear/spd_solver.h"
#include "mesh/boundary.h"
#include "mesh/disk_mesh.h"
#include "mesh/rest_shape.h"
#include "prolong/derivative.h"
#include "prolong/interpolation.h"
#include "repair/regions.h"
#include "repair/repair.h"
#include "repair/touching.h"
#include "simplify/coarse.h"
#include "simplify/levels.h"

namespace beltrami {
namespace {

/// On levels of up to so many composite majorization costs little beside the run.
constexpr Index kFewFaces = 25000;
/// Up to so many a factor of a level costs little beside the run.
constexpr Index kMostFactored = 150000;
constexpr int kLeastSteps = 2;      // of conjugate gradients from an interpolated map
constexpr int kManySteps = 6;       // while more than
constexpr double kFewFlips = 1e-4;  // of the faces are flipped
constexpr int kMostSteps = 14;      // while with each
constexpr double kFalling = 0.9;    // times as many flips are left, or less
/// Shares of the faces of a level: more flipped ones, or more that are left to patches, and it is
/// hard for the V-cycle. Where a factor is cheap, and on any level. For patches no more than 2%, up
/// to which a repair has regions before them.
struct Bearable {
  double flips, patches;
};
constexpr Bearable kWhereCheap{5e-2, 2e-2}, kOnAnyLevel{1e-2, 1e-2};
constexpr std::size_t kFewPatches = 30;  // are mended all the same
// Shares of the progress.
constexpr double kSimplified = 0.25, kStarted = 0.4;

/// L-BFGS, as metric_mode has it, with the map; on a large mesh without the steps and one gradient.
constexpr double kPolishFields = 2 * 5 + 4 + 1, kLargeFields = 4;
/// Neighbours of a vertex.
constexpr double kNeighbours = 6;
/// Bytes of a vertex of a coarser level with all that is kept of it.
constexpr double kLevel = 250;
/// What all coarser levels have of the fine vertices: sweeps end below an eighth.
constexpr double kLevels = 1.0 / 7;

/// A map on the way up, with what it took.
struct Climb {
  ChartMap map;                ///< of the level reached
  double energy = 0;           ///< mean, of that level
  bool hard = false;           ///< a polish did not end stationary, or a level needed its factor
  Index most_for_hessian = 0;  ///< faces of a level
  Index most_factored = 0;     ///< the same, for a factor of its own
  std::unique_ptr<VCycle> cycle = nullptr;  ///< of the levels up to that one
};

/// What a mesh of so many faces has of these counts.
MeshCounts part_of(const MeshCounts& n, double faces) {
  const double share = std::min(1.0, faces / n.faces);
  return {share * n.vertices, share * n.faces, share * n.boundary, n.regular, n.metas};
}

std::size_t share_of(const DiskMesh& mesh, double share) {
  return static_cast<std::size_t>(share * mesh.face_count());
}

bool is_injective(const DiskMesh& mesh, const std::vector<Vec2>& uvs, bool simple,
                  const Work& work) {
  return non_positive_faces(mesh.faces, uvs, work).empty() &&
         (!simple || find_crossings(mesh.boundary, uvs).empty());
}

/// A level as its solve sees it. Fields of the finest are made when they are needed, for memory.
struct Level {
  FineProblem problem;
  const CoarseDisk& coarse;
  std::vector<Vec2> from;  ///< the map of the coarse level
  SingleField residual;  ///< what pulls the carried one to the target; the cycle has its stiffness
  BoundaryContact contact;
};

/// The map of the coarse level at the footpoints.
std::vector<Vec2> carried_map(const Level& level, const std::vector<Footpoint>& points,
                              const Work& work) {
  return carried(level.from, level.coarse.mesh.faces, points, work);
}

std::vector<VertexDerivative> carried_derivatives(const DiskMesh& coarse,
                                                  const std::vector<Vec2>& uvs,
                                                  const std::vector<Footpoint>& points,
                                                  const Work& work) {
  const auto rest = rest_triangles(coarse.positions, coarse.faces, work);
  return carried(vertex_derivatives(coarse, rest, uvs, work), coarse.faces, points, work);
}

/// What the carried map is to become.
TargetEquations target_of(const Level& level, const std::vector<Footpoint>& points, Energy energy,
                          const Work& work) {
  std::vector<Vec2> start = carried_map(level, points, work);
  std::vector<VertexDerivative> derivatives =
      carried_derivatives(level.coarse.mesh, level.from, points, work);
  TargetEquations equations =
      target_equations(energy, *level.problem.mesh, level.problem.rest, derivatives, start, work);
  parallel_free(work, derivatives);
  parallel_free(work, start);
  return equations;
}

void take_aim(TargetEquations equations, const Work& work, VCycle& cycle, Level& level) {
  level.residual = std::move(equations.residual);
  cycle.set(equations.weights, {});
  parallel_free(work, equations.weights);
}

Level prepare_level(const DiskMesh& mesh, const CoarseDisk& coarse, const ChartOptions& options,
                    const Work& work, VCycle& cycle, Climb& climb) {
  cycle.settle();
  Level level{
      .problem = {.mesh = &mesh},
      .coarse = coarse,
      .from = climb.map.uvs,
      .residual = {},
      .contact = {mesh.boundary, boundary_lengths(mesh), coarse_boundary_lengths(mesh, coarse)}};
  run_stage("prolong", work, climb.map.statistics.stages, [&](StageStatistics&, const Work& inner) {
    level.problem.rest = rest_triangles(mesh.positions, mesh.faces, inner);
    level.problem.statistics.coarse_energy = climb.energy;
    std::vector<Footpoint> points =
        footpoints(coarse.mesh, coarse.fine_vertex, coarse.nearby, mesh, inner);
    inner.report(0.5);
    TargetEquations equations = target_of(level, points, options.energy, inner);
    cycle.add(mesh, std::move(points));
    take_aim(std::move(equations), inner, cycle, level);
  });
  return level;
}

/// The stage "flatten": a few steps from the carried map, whose anchored vertices stay; that map
/// itself where it has fewer flips. Returns these.
std::size_t solve_level(const Level& level, const std::vector<bool>& anchored, const Work& work,
                        VCycle& cycle, ChartMap& map) {
  std::size_t flips = 0;
  const DiskMesh& mesh = *level.problem.mesh;
  run_stage("flatten", work, map.statistics.stages, [&](StageStatistics&, const Work& inner) {
    if (!anchored.empty()) cycle.anchor(anchored);
    map.uvs = carried_map(level, cycle.points(), inner);
    SingleField residual;
    parallel_copy(inner, level.residual, residual);
    const auto flips_of = [&](const std::vector<Vec2>& uvs) {
      return non_positive_faces(mesh.faces, uvs, inner).size();
    };
    bool counted = false;
    const auto at_most = [&](double share) {
      return static_cast<double>(flips) <= share * mesh.face_count();
    };
    cycle.improve(
        kMostSteps,
        [&](int step) {
          if (step < kLeastSteps) return false;
          const auto before = static_cast<double>(std::exchange(flips, flips_of(map.uvs)));
          counted = true;
          if (at_most(kFewFlips)) return true;
          return step >= kManySteps && static_cast<double>(flips) > kFalling * before;
        },
        residual, map.uvs);
    if (!anchored.empty()) {
      put_in_place(anchored, carried_map(level, cycle.points(), inner), map.uvs);
      counted = false;
    }
    if (!counted) flips = flips_of(map.uvs);  // it may end before it asks
    if (at_most(kFewFlips)) return;
    std::vector<Vec2> start = carried_map(level, cycle.points(), inner);
    const std::size_t of_carried = flips_of(start);
    if (of_carried >= flips) return;
    flips = of_carried;
    map.uvs = std::move(start);
  });
  return flips;
}

/// The stage "repair". What was flipped is relaxed with what is around it: it is positive now, but
/// little more. Returns whether all faces are positive.
bool mend_level(const Level& level, const RepairOptions& how, const ChartOptions& options,
                const Work& work, ChartMap& map) {
  const DiskMesh& mesh = *level.problem.mesh;
  const std::vector<Index> flipped = non_positive_faces(mesh.faces, map.uvs, work);
  if (!mend(level.problem, how, options, work, map)) return false;
  if (flipped.empty()) return true;
  run_stage("repair", work, map.statistics.stages, [&](StageStatistics&, const Work& inner) {
    const RelaxedRegions relaxed = relax_regions(options.energy, mesh, level.problem.rest, map.uvs,
                                                 flipped, kRegionRings, inner);
    map.statistics.cleaned_patches += relaxed.changed;
  });
  return true;
}

/// Polishes where it is worth it; with contact where the boundary is `pressed`, or would cross
/// itself: then from a new start, which `begin_again` makes. Returns whether there was one.
bool polish_level(const Level& level, bool simple, PolishLength length, bool pressed,
                  const ChartOptions& options, const Work& work,
                  const std::function<bool()>& begin_again, Climb& climb) {
  const auto polished_from = [&](std::vector<Vec2> start, const BoundaryContact* contact) {
    return polish_map(level.problem, contact, contact ? PolishLength::kWhole : length, options,
                      work, *climb.cycle, std::move(start));
  };
  ChartMap polished = polished_from(std::move(climb.map.uvs), pressed ? &level.contact : nullptr);
  if (simple && !pressed && !level.contact.is_simple(polished.uvs) &&
      !open_touching_sides(*level.problem.mesh, work, polished.uvs)) {
    climb.map.statistics.stages.push_back(given_up(polished.statistics.stages));
    parallel_free(work, polished.uvs);
    if (!begin_again()) return false;
    polished = polished_from(std::move(climb.map.uvs), &level.contact);
    polished.in_contact = true;
  }
  climb.map.in_contact = climb.map.in_contact || polished.in_contact;
  climb.map.uvs = std::move(polished.uvs);
  climb.map.converged = polished.converged;
  climb.map.statistics.append(polished.statistics);
  return true;
}

/// From the map of a coarse level to that of the next finer one, by the V-cycle. Returns whether
/// that led to an injective map, not far from the energy of the level below.
bool climb_by_cycle(const DiskMesh& mesh, const CoarseDisk& coarse, const Bearable& bearable,
                    bool is_finest, const ChartOptions& options, const Work& work, Climb& climb) {
  const bool simple = keeps_boundary_simple(options);
  VCycle& cycle = *climb.cycle;
  Level level = prepare_level(mesh, coarse, options, work.part(0, 0.3), cycle, climb);
  const bool pressed = climb.map.in_contact && simple;
  std::vector<bool> anchored;
  if (pressed) anchored = vertices_in_contact(coarse, level.from, mesh.vertex_count());
  const RepairOptions how{.most_patches = std::max(kFewPatches, share_of(mesh, bearable.patches)),
                          .global_fix = false};
  bool positive = false, rough = false;
  const auto solve = [&] {
    const std::size_t flips = solve_level(level, anchored, work.part(0.3, 0.5), cycle, climb.map);
    rough = cycle.has_hessian_of_finer() && flips > share_of(mesh, kFewFlips);
    positive = flips <= share_of(mesh, bearable.flips) &&
               mend_level(level, how, options, work.part(0.5, 0.6), climb.map);
    return positive;
  };
  const auto reach_start = [&] {
    const bool solved = simple ? solve_until_simple(mesh, climb.map.uvs, anchored, solve) : solve();
    parallel_free(work, level.residual);
    return solved && positive;
  };
  if (!reach_start()) return false;
  const bool touches = !anchored.empty();
  climb.map.in_contact = climb.map.in_contact || touches;
  // What presses on itself comes to rest slowly, and on coarse levels at little cost.
  const bool is_small = mesh.face_count() < kManyFaces;
  const PolishLength length = touches                  ? PolishLength::kWhole
                              : !is_finest || is_small ? PolishLength::kMiddling
                              : climb.hard || rough    ? PolishLength::kLong
                                                       : PolishLength::kShort;
  const auto begin_again = [&] {
    take_aim(target_of(level, cycle.points(), options.energy, work), work, cycle, level);
    return reach_start();
  };
  if (!polish_level(level, simple, length, touches, options, work.part(0.6, 1), begin_again,
                    climb)) {
    return false;
  }
  const bool converged = climb.map.converged;
  if (!converged || !is_finest) {
    climb.energy = mean_energy(options.energy, mesh.faces, level.problem.rest, climb.map.uvs, work);
  }
  parallel_free(work, level.problem.rest);
  if (converged) return true;
  climb.hard = true;
  return true;
}

/// The same by a factor of the finer level: the metric way (metric_mode), from the map reached.
bool climb_by_factor(const DiskMesh& mesh, const CoarseDisk& coarse, const ChartOptions& options,
                     const Work& work, Climb& climb) {
  FineProblem problem{.mesh = &mesh,
                      .coarse = coarse,
                      .coarse_uvs = std::move(climb.map.uvs),
                      .in_contact = climb.map.in_contact};
  problem.statistics.coarse_energy = climb.energy;
  measure_fine("prolong", false, options, work.part(0, 0.2), problem);
  ChartMap map = metric_mode(problem, options, work.part(0.2, 1));
  problem.statistics.coarse_energy = 0;  // of the coarsest level, that of the climb
  const bool in_contact = climb.map.in_contact || map.in_contact;
  map = joined(std::move(problem), std::move(map));
  climb.map.uvs = std::move(map.uvs);
  climb.map.converged = map.converged;
  climb.map.in_contact = in_contact;
  climb.map.statistics.append(map.statistics);
  climb.hard = true;
  return is_injective(mesh, climb.map.uvs, keeps_boundary_simple(options), work);
}

/// From now on with a cycle that begins with the level reached, with a stiffness and a Hessian at
/// the map of it.
void begin_cycle(const DiskMesh& mesh, const ChartOptions& options, const Work& work,
                 Climb& climb) {
  const auto rest = rest_triangles(mesh.positions, mesh.faces, work);
  climb.energy = mean_energy(options.energy, mesh.faces, rest, climb.map.uvs, work);
  climb.cycle = std::make_unique<VCycle>(
      mesh, energy_stiffness(options.energy, mesh.faces, rest, climb.map.uvs, work),
      climb.most_for_hessian, work);
  climb.cycle->take_hessian(options.energy, rest, climb.map.uvs);
}

/// Composite majorization: from the map reached where that is `injective`, which is kept unless a
/// better one comes of it, or else from scratch. Returns whether there is an injective map.
bool finish_few(const DiskMesh& mesh, bool injective, const ChartOptions& options, const Work& work,
                Climb& climb) {
  ChartMap map =
      cm_mode(mesh, "coarse", injective ? climb.map.uvs : std::vector<Vec2>(), options, work);
  const double energy = map.statistics.coarse_energy;
  map.statistics.coarse_faces = 0;  // that is the coarsest level
  map.statistics.coarse_energy = 0;
  climb.map.statistics.append(map.statistics);
  if (injective && !(energy < climb.energy)) {
    climb.map.converged = climb.map.converged || map.converged;
    return true;
  }
  if (!is_injective(mesh, map.uvs, keeps_boundary_simple(options), work)) return injective;
  climb.hard = !map.converged;
  climb.map.uvs = std::move(map.uvs);
  climb.map.converged = map.converged;
  climb.map.in_contact = map.in_contact;
  return true;
}

/// From the map of a coarse level to that of the next finer one; returns whether it is injective.
/// A level that is hard for the V-cycle is solved by a factor of its own, with which a new cycle
/// begins.
bool climb_to(const DiskMesh& mesh, const CoarseDisk& coarse, bool is_finest,
              const ChartOptions& options, const Work& work, Climb& climb) {
  const ChartMap& reached = climb.map;
  const std::vector<Vec2> from = reached.uvs;
  const ChartStatistics before = reached.statistics;
  const bool in_contact = reached.in_contact, was_hard = climb.hard;
  const double energy = climb.energy;
  const bool few = is_finest ? mesh.face_count() < kManyFaces : mesh.face_count() <= kFewFaces;
  const bool cheap = mesh.face_count() <= kMostFactored && !is_finest;
  const bool done = climb_by_cycle(mesh, coarse, cheap ? kWhereCheap : kOnAnyLevel, is_finest,
                                   options, work.part(0, 0.5), climb);
  const bool pressed = reached.in_contact;
  const bool by_cm = few && (is_finest || !pressed);
  const bool must_rest = by_cm || (pressed && cheap);  // elsewhere finer levels go on with it
  if (done && (reached.converged || !must_rest || work.out_of_time())) return true;
  const Work rest = work.part(0.5, 1);
  climb.cycle.reset();
  const bool goes_on = done && (is_finest || !pressed);
  if (!goes_on) {
    ChartStatistics statistics = before;
    const auto& stages = reached.statistics.stages;
    const auto tried = static_cast<std::ptrdiff_t>(before.stages.size());
    statistics.stages.push_back(given_up({stages.begin() + tried, stages.end()}));
    climb.map = {};
    climb.map.uvs = from;
    climb.map.in_contact = in_contact;
    climb.map.statistics = std::move(statistics);
    climb.hard = was_hard;
    climb.energy = energy;
  }
  if (mesh.face_count() > climb.most_factored) return false;
  ChartOptions own = options;
  own.parts_touching = options.parts_touching && is_finest;
  const bool injective = by_cm ? finish_few(mesh, goes_on, own, rest, climb)
                               : climb_by_factor(mesh, coarse, options, rest, climb);
  if (!injective) return false;
  if (!is_finest) begin_cycle(mesh, options, rest, climb);
  return true;
}

/// Moves the mean of the vertices to the origin, where numbers are finest: a map that has shrunk
/// around its held vertex may be thousands of times its size away from there. It stays where that
/// would cost a face.
void to_origin(const DiskMesh& mesh, const Work& work, std::vector<Vec2>& uvs) {
  Vec2 sum(0, 0);
  for (const Vec2& uv : uvs) sum += uv;
  const Vec2 mean = sum / static_cast<double>(uvs.size());
  std::vector<Vec2> moved = uvs;
  for (Vec2& uv : moved) uv -= mean;
  if (non_positive_faces(mesh.faces, moved, work).empty()) uvs.swap(moved);
}

/// From the coarsest level to the finest. Without UVs where a level has no injective map.
ChartMap climb(const DiskMesh& mesh, const std::vector<CoarseDisk>& levels,
               const ChartOptions& options, const Work& work) {
  const DiskMesh& coarsest = levels.back().mesh;
  const Work begin = work.part(0, kStarted), rest = work.part(kStarted, 1);
  Climb climb;
  const bool affords_it = affords(mesh, options, Extra::kLevelHessian, work);
  climb.most_factored =
      affords(mesh, options, Extra::kWholeFactor, work) ? mesh.face_count() : kMostFactored;
  climb.most_for_hessian = std::min(affords_it ? kMostFactored : kFewFaces, mesh.face_count() - 1);
  const Index faces = coarse_faces(coarsest.face_count(), options.coarse_faces);
  climb.map = faces >= coarsest.face_count() ? cm_mode(coarsest, "coarse", {}, options, begin)
                                             : beltrami_mode(coarsest, faces, {}, options, begin);
  bool injective = is_injective(coarsest, climb.map.uvs, keeps_boundary_simple(options), begin);
  if (injective) {
    to_origin(coarsest, begin, climb.map.uvs);
    climb.hard = !climb.map.converged;
    begin_cycle(coarsest, options, begin, climb);
  }
  for (std::size_t l = levels.size(); injective && l-- > 0;) {
    const DiskMesh& finer = l > 0 ? levels[l - 1].mesh : mesh;
    const double from = 1 - static_cast<double>(l + 1) / static_cast<double>(levels.size());
    injective = climb_to(finer, levels[l], l == 0, options, rest.part(from, 1), climb);
  }
  if (!injective) climb.map.uvs.clear();
  return std::move(climb.map);
}

}  // namespace

double nested_hessian_bytes(const MeshCounts& n, int threads) {
  const MeshCounts level = part_of(n, std::min<double>(kMostFactored, kCoarseEnough * n.faces));
  const System system = system_bytes(level, 2, Precision::kSingle, threads);
  return std::max(nested_bytes(n, threads) + system.preconditioner,
                  nested_bytes(level, threads) + system.peak);
}

double nested_bytes(const MeshCounts& n, int threads) {
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

ChartMap nested_mode(const DiskMesh& mesh, const Inherited& inherited, const ChartOptions& options,
                     const Work& work) {
  const Index coarsest =
      std::max(coarsest_faces(mesh.face_count()), static_cast<Index>(options.coarse_faces));
  ChartMap map;
  std::vector<CoarseDisk> levels;
  run_stage("simplify", work.part(0, kSimplified), map.statistics.stages,
            [&](StageStatistics&, const Work& inner) {
              levels = coarser_levels(mesh, inherited.level, coarsest, inner);
            });
  if (levels.empty()) return map;
  ChartMap climbed = climb(mesh, levels, options, work.part(kSimplified, 1));
  map.statistics.append(climbed.statistics);
  climbed.statistics = std::move(map.statistics);
  return climbed;
}

}  // namespace beltrami
