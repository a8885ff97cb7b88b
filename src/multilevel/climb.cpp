// The way up (Briggs, Henson & McCormick 2000, "A multigrid tutorial", "full multigrid"): from the
// coarsest level to the finest, each map the start of the next. No factorization of the finest, but
// where all else fails.
#include <algorithm>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "descend/tutte.h"
#include "exact/certificate.h"
#include "exact/crossings.h"
#include "flatten/metric.h"
#include "flatten/v_cycle.h"
#include "mesh/disk_mesh.h"
#include "mesh/rest_shape.h"
#include "multilevel/anchors.h"
#include "multilevel/chart_map.h"
#include "multilevel/extras.h"
#include "multilevel/inherited.h"
#include "multilevel/level.h"
#include "multilevel/map_problem.h"
#include "multilevel/modes.h"
#include "multilevel/options.h"
#include "multilevel/policy.h"
#include "multilevel/polish_level.h"
#include "repair/repair.h"
#include "simplify/coarse.h"
#include "simplify/levels.h"

namespace beltrami {
namespace {

constexpr std::size_t kFewPatches = 30;  // are mended, whatever the policy bears
// Shares of the progress: of the run, and of a level.
constexpr double kSimplified = 0.25, kStarted = 0.4;
constexpr double kPrepared = 0.3, kSolved = 0.5, kMended = 0.6;

/// The map of a level, and what is known of it.
struct Reached {
  ChartMap map = {};  ///< its statistics: of the level alone, or of all up to it
  double energy = 0;  ///< mean, of that level
  bool hard = false;  ///< see Difficulty, of the next level
  bool injective = false;
};

/// What the whole ascent has in common.
struct Ascent {
  const ChartOptions& options;
  Index most_for_hessian;                   ///< faces of a level that gets a Hessian
  Index most_factored;                      ///< the same, for a factor of its own
  std::unique_ptr<VCycle> cycle = nullptr;  ///< of the levels up to the one that is reached
};

/// A level and the one below it.
struct Rung {
  const DiskMesh& mesh;
  const CoarseDisk& coarse;
  bool is_finest;
  const Reached& below;
};

std::size_t share_of(const DiskMesh& mesh, double share) {
  return static_cast<std::size_t>(share * mesh.face_count());
}

bool is_injective(const DiskMesh& mesh, const std::vector<Vec2>& uvs, bool simple,
                  const Work& work) {
  return non_positive_faces(mesh.faces, uvs, work).empty() &&
         (!simple || find_crossings(mesh.boundary, uvs).empty());
}

/// By the V-cycle. Not injective where that leads nowhere; hard is what it was below, unless the
/// polish did not end at rest.
Reached climb_by_cycle(const Rung& rung, const Work& work, Ascent& ascent) {
  const DiskMesh& mesh = rung.mesh;
  const ChartOptions& options = ascent.options;
  const bool simple = keeps_boundary_simple(options);
  VCycle& cycle = *ascent.cycle;
  Reached reached{.hard = rung.below.hard};
  ChartMap& map = reached.map;
  map.in_contact = rung.below.map.in_contact;
  Level level = prepare_level(mesh, rung.coarse, rung.below.map.uvs, rung.below.energy,
                              options.energy, work.part(0, kPrepared), cycle, map.statistics);
  std::vector<bool> anchored;
  if (map.in_contact && simple) {
    anchored = vertices_in_contact(rung.coarse, level.from, mesh.vertex_count());
  }
  const Bearable bearable = bearable_at(mesh.face_count(), rung.is_finest);
  const RepairOptions how{.most_patches = std::max(kFewPatches, share_of(mesh, bearable.patches)),
                          .global_fix = false};
  bool positive = false, rough = false;
  const auto solve = [&] {
    const std::size_t flips =
        solve_level(level, anchored, work.part(kPrepared, kSolved), cycle, map);
    rough = cycle.has_hessian_of_finer() && flips > share_of(mesh, kFewFlips);
    positive = flips <= share_of(mesh, bearable.flips) &&
               mend_level(level, how, options, work.part(kSolved, kMended), map);
    return positive;
  };
  const auto reach_start = [&] {
    const bool solved = simple ? solve_until_simple(mesh, map.uvs, anchored, solve) : solve();
    parallel_free(work, level.residual);
    return solved && positive;
  };
  if (!reach_start()) return reached;
  map.in_contact = map.in_contact || !anchored.empty();
  const Difficulty difficulty = !anchored.empty()       ? Difficulty::kPressed
                                : rough || reached.hard ? Difficulty::kHard
                                                        : Difficulty::kNone;
  const auto begin_again = [&](ChartMap&) {
    take_aim(options.energy, work, cycle, level);
    return reach_start();
  };
  const PolishLength length = polish_length(mesh.face_count(), rung.is_finest, difficulty);
  reached.injective = polish_level(level.problem, level.contact, simple, length, options,
                                   work.part(kMended, 1), begin_again, cycle, map);
  if (!reached.injective) return reached;
  if (!map.converged || !rung.is_finest) {
    reached.energy = mean_energy(options.energy, mesh.faces, level.problem.rest, map.uvs, work);
  }
  parallel_free(work, level.problem.rest);
  reached.hard = reached.hard || !map.converged;
  return reached;
}

/// By a factor of the level: the metric way (metric_mode), from the map below.
Reached climb_by_factor(const Rung& rung, const ChartOptions& options, const Work& work) {
  MapProblem problem{.mesh = &rung.mesh,
                     .coarse = rung.coarse,
                     .coarse_uvs = rung.below.map.uvs,
                     .in_contact = rung.below.map.in_contact};
  problem.statistics.coarse_energy = rung.below.energy;
  measure_fine("prolong", false, options, work.part(0, 0.2), problem);
  Reached reached{.map = metric_mode(problem, options, work.part(0.2, 1)), .hard = true};
  problem.statistics.coarse_energy = 0;  // of the coarsest level, that of the whole way
  const bool in_contact = rung.below.map.in_contact || reached.map.in_contact;
  reached.map = joined(std::move(problem), std::move(reached.map));
  reached.map.in_contact = in_contact;
  reached.injective =
      is_injective(rung.mesh, reached.map.uvs, keeps_boundary_simple(options), work);
  return reached;
}

/// By composite majorization: from the `start` that the V-cycle has led to, which is kept unless a
/// better map comes of it, or, without one, from scratch.
Reached climb_by_majorization(const Rung& rung, std::optional<Reached> start,
                              const ChartOptions& options, const Work& work) {
  Reached reached;
  reached.map =
      cm_mode(rung.mesh, "coarse", start ? start->map.uvs : std::vector<Vec2>(), options, work);
  ChartStatistics& statistics = reached.map.statistics;
  reached.energy = std::exchange(statistics.coarse_energy, 0);  // that is the coarsest level's
  statistics.coarse_faces = 0;
  reached.hard = !reached.map.converged;
  reached.injective =
      (!start || reached.energy < start->energy) &&
      is_injective(rung.mesh, reached.map.uvs, keeps_boundary_simple(options), work);
  if (!start) return reached;
  start->map.statistics.append(statistics);
  if (reached.injective) {
    statistics = std::move(start->map.statistics);
    return reached;
  }
  if (!(reached.energy < start->energy)) {
    start->map.converged = start->map.converged || reached.map.converged;
  }
  return *std::move(start);
}

/// From now on with a cycle that begins with the level reached, with a stiffness and a Hessian at
/// the map of it.
void begin_cycle(const DiskMesh& mesh, const Work& work, Ascent& ascent, Reached& reached) {
  const ChartOptions& options = ascent.options;
  const auto rest = rest_triangles(mesh.positions, mesh.faces, work);
  const std::vector<Vec2>& uvs = reached.map.uvs;
  reached.energy = mean_energy(options.energy, mesh.faces, rest, uvs, work);
  ascent.cycle =
      std::make_unique<VCycle>(mesh, energy_stiffness(options.energy, mesh.faces, rest, uvs, work),
                               ascent.most_for_hessian, work);
  ascent.cycle->take_hessian(options.energy, rest, uvs);
}

/// From the level below a rung to it. A level that is hard for the V-cycle gets the remedy that the
/// policy has for it, with which a new cycle begins.
Reached climb(const Rung& rung, const Work& work, Ascent& ascent) {
  Reached reached = climb_by_cycle(rung, work.part(0, 0.5), ascent);
  const LevelReport report{.faces = rung.mesh.face_count(),
                           .is_finest = rung.is_finest,
                           .injective = reached.injective,
                           .at_rest = reached.map.converged || work.out_of_time(),
                           .in_contact = reached.map.in_contact};
  const Remedy remedy = remedy_for(report);
  if (remedy == Remedy::kNone) return reached;
  const Work rest = work.part(0.5, 1);
  ascent.cycle.reset();
  std::optional<Reached> start;
  ChartStatistics lost;
  if (starts_from_map(report)) {
    start = std::move(reached);
  } else {
    lost.stages.push_back(given_up(reached.map.statistics.stages));
  }
  if (rung.mesh.face_count() > ascent.most_factored) {
    Reached nothing;
    nothing.map.statistics = std::move(lost);
    return nothing;
  }
  if (remedy == Remedy::kMajorization) {
    ChartOptions own = ascent.options;
    own.parts_touching = own.parts_touching && rung.is_finest;
    reached = climb_by_majorization(rung, std::move(start), own, rest);
  } else {
    reached = climb_by_factor(rung, ascent.options, rest);
  }
  lost.append(reached.map.statistics);
  reached.map.statistics = std::move(lost);
  if (reached.injective && !rung.is_finest) begin_cycle(rung.mesh, rest, ascent, reached);
  return reached;
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

/// The map of the coarsest level.
Reached begin(const DiskMesh& mesh, const Work& work, Ascent& ascent) {
  const ChartOptions& options = ascent.options;
  const auto flatten = [&](const MapProblem& problem, const Work& share) {
    return metric_mode(problem, options, share);
  };
  const Index faces = coarse_faces(mesh.face_count(), options.coarse_faces);
  Reached reached{.map = prolonged_mode(mesh, faces, {}, false, flatten, options, work)};
  reached.injective = is_injective(mesh, reached.map.uvs, keeps_boundary_simple(options), work);
  if (!reached.injective) return reached;
  to_origin(mesh, work, reached.map.uvs);
  reached.hard = !reached.map.converged;
  begin_cycle(mesh, work, ascent, reached);
  return reached;
}

/// From the coarsest level to the finest. Without UVs where a level has no injective map.
ChartMap climb_all(const DiskMesh& mesh, const std::vector<CoarseDisk>& levels,
                   const ChartOptions& options, const Work& work) {
  const bool hessian = affords(mesh, options, Extra::kLevelHessian, work);
  const bool factor = affords(mesh, options, Extra::kWholeFactor, work);
  Ascent ascent{
      .options = options,
      .most_for_hessian = std::min(hessian ? kMostFactored : kFewFaces, mesh.face_count() - 1),
      .most_factored = factor ? mesh.face_count() : kMostFactored};
  Reached reached = begin(levels.back().mesh, work.part(0, kStarted), ascent);
  const Work rest = work.part(kStarted, 1);
  for (std::size_t l = levels.size(); reached.injective && l-- > 0;) {
    const DiskMesh& finer = l > 0 ? levels[l - 1].mesh : mesh;
    const double from = 1 - static_cast<double>(l + 1) / static_cast<double>(levels.size());
    Reached next = climb({finer, levels[l], l == 0, reached}, rest.part(from, 1), ascent);
    ChartStatistics& all = reached.map.statistics;
    all.flips_before_repair = 0;  // those of the finest level count
    all.append(next.map.statistics);
    next.map.statistics = std::move(all);
    reached = std::move(next);
  }
  if (!reached.injective) reached.map.uvs.clear();
  return std::move(reached.map);
}

}  // namespace

ChartMap climb_mode(const DiskMesh& mesh, const Inherited& inherited, const ChartOptions& options,
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
  ChartMap climbed = climb_all(mesh, levels, options, work.part(kSimplified, 1));
  map.statistics.append(climbed.statistics);
  climbed.statistics = std::move(map.statistics);
  return climbed;
}

}  // namespace beltrami
