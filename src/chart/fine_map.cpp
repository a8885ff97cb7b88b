// From the coarse map to the fine one: prolongation and the ways to flatten.
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <utility>

#include "base/checkpoint.h"
#include "base/types.h"
#include "chart/anchors.h"
#include "chart/memory_estimate.h"
#include "chart/pipeline.h"
#include "chart/run.h"
#include "descend/contact.h"
#include "descend/grid_drawing.h"
#include "descend/newton.h"
#include "descend/polish.h"
#include "descend/tutte.h"
#include "energy/energy.h"
#include "exact/certificate.h"
#include "flatten/boundary_first.h"
#include "flatten/dirichlet.h"
#include "flatten/intrinsic_delaunay.h"
#include "flatten/laplacian.h"
#include "flatten/metric.h"
#include "flatten/reduced/reduced.h"
#include "flatten/uv_prolongation.h"
#include "linear/spd_solver.h"
#include "mesh/boundary.h"
#include "mesh/disk_mesh.h"
#include "mesh/rest_shape.h"
#include "prolong/prolongation.h"
#include "repair/outliers.h"
#include "repair/repair.h"
#include "simplify/simplify.h"

namespace beltrami {
namespace {

constexpr int kNewtonSteps = 10;
constexpr double kNewtonTolerance = 1e-3;  // relative decrease, of the steps after a blocked polish
constexpr std::int64_t kLeastCoarseFaces = 10000;
constexpr double kCoarseShare = 0.01;
constexpr double kRoughly = 1e-5;          // residual of a map that is polished afterwards
constexpr std::size_t kManyFlips = 20;     // beyond which targets are rotated
constexpr int kRotations = 2;              // ARAP rounds, then
constexpr double kFlippedShare = 0.001;    // beyond which the harmonic map is looked at too
constexpr double kPolishTolerance = 3e-4;  // relative decrease: leaves the energy 0.1% too high
constexpr double kStationary = 1e-4;       // predicted relative decrease that is none
constexpr int kPolishIterations = 30;
constexpr double kLittleGain = 1e-3;  // of a round of steps that ends blocked: it is the last one
constexpr double kMuchLeft = 1e-2;    // predicted relative decrease that is then worth Newton steps

}  // namespace

Index coarse_faces(Index faces, const Options& options) {
  const double share = kCoarseShare * faces;
  const auto target = options.coarse_faces > 0
                          ? options.coarse_faces
                          : std::max(kLeastCoarseFaces, static_cast<std::int64_t>(share));
  return static_cast<Index>(std::min<std::int64_t>(target, faces));
}

Index Run::coarse_target() const {
  return coarse_target_ == kNone ? coarse_faces(input_.face_count(), options_) : coarse_target_;
}

void Run::simplify_fine(FineProblem& fine) {
  stage("simplify", 0.12, [&](StageStatistics&, const Checkpoint& checkpoint) {
    fine.coarse = simplify(*disk_, coarse_target(), options_.threads, checkpoint);
  });
}

void Run::solve_coarse(FineProblem& fine) {
  result_.coarse_faces = fine.coarse.mesh.face_count();
  fine.coarse_uvs = run_cm(fine.coarse.mesh, "coarse", 0.22, &fine.in_contact);
  fine.coarse_energy = result_.coarse_energy;
}

/// The metric of the fine faces: the coarse map's, or that of the surface where there is no coarse
/// mesh. With the option delaunay the faces are those of the intrinsic Delaunay triangulation.
void Run::measure_fine(FineProblem& fine, const Checkpoint& checkpoint) {
  const DiskMesh& coarse = fine.coarse.mesh;
  const auto coarse_rest = rest_triangles(coarse.positions, coarse.faces, options_.threads);
  const auto coarse_metric = face_metrics(coarse.faces, coarse_rest, fine.coarse_uvs);
  const auto measure = [&] {
    fine.rest = rest_triangles(disk_->positions, disk_->faces, options_.threads);
    if (coarse_metric.empty()) {
      fine.metric.assign(disk_->faces.size(), FaceMetric{});
      return;
    }
    fine.metric = prolong_metric(coarse, coarse_metric, *disk_, fine.coarse.nearby,
                                 options_.threads, checkpoint);
  };
  measure();
  // The metric solve brings its own weights.
  const bool harmonic =
      options_.method != BELTRAMI_METHOD_BELTRAMI || options_.flatten != BELTRAMI_FLATTEN_METRIC;
  if (!harmonic && !options_.delaunay) return;
  fine.cotangents = modified_cotangents(fine.rest, fine.metric, options_.threads);
  if (!options_.delaunay) return;
  DelaunayTriangulation delaunay =
      intrinsic_delaunay(*disk_, std::move(fine.cotangents), checkpoint);
  result_.delaunay_flips = delaunay.flips;
  result_.delaunay_refused = delaunay.refused;
  retriangulated_ = build_disk(input_.positions, std::move(delaunay.faces));
  disk_ = &retriangulated_;
  fine.cotangents = std::move(delaunay.cotangents);
  measure();
}

/// The mesh as its own coarse mesh.
std::vector<Vec2> Run::run_whole() {
  result_.coarse_faces = input_.face_count();
  return run_cm(input_, "coarse", 0.9);
}

std::vector<Vec2> Run::run_beltrami() {
  if (coarse_target() >= input_.face_count()) return run_whole();
  FineProblem fine;
  simplify_fine(fine);
  if (fine.coarse.mesh.face_count() > kLeastReduction * input_.face_count()) {
    return run_whole();
  }
  solve_coarse(fine);
  stage("prolong", 0.37,
        [&](StageStatistics&, const Checkpoint& checkpoint) { measure_fine(fine, checkpoint); });
  switch (options_.flatten) {
    case BELTRAMI_FLATTEN_DIRICHLET:
      return flatten_dirichlet(fine);
    case BELTRAMI_FLATTEN_GIF:
      return flatten_reduced(fine, true);
    case BELTRAMI_FLATTEN_FLIM:
      return flatten_reduced(fine, false);
    case BELTRAMI_FLATTEN_BFF:
      return flatten_boundary_first(fine);
    default:
      return flatten_metric(fine);
  }
}

/// GIF and BFF on the metric of the surface itself: the baselines.
std::vector<Vec2> Run::run_plain() {
  FineProblem fine;
  stage("measure", 0.1,
        [&](StageStatistics&, const Checkpoint& checkpoint) { measure_fine(fine, checkpoint); });
  return options_.method == BELTRAMI_METHOD_GIF ? flatten_reduced(fine, true)
                                                : flatten_boundary_first(fine);
}

std::vector<Vec2> Run::run_uv_prolongation() {
  FineProblem fine;
  simplify_fine(fine);
  solve_coarse(fine);
  std::vector<Vec2> uvs;
  stage("prolong", 0.9, [&](StageStatistics&, const Checkpoint& checkpoint) {
    uvs = prolong_uvs(fine.coarse.mesh, fine.coarse_uvs, *disk_, options_.threads, checkpoint);
  });
  count_flips(uvs);
  return uvs;
}

void Run::count_flips(const std::vector<Vec2>& uvs) {
  result_.flips_before_repair = size_of(non_positive_faces(disk_->faces, uvs, options_.threads));
}

std::vector<Vec2> Run::flatten_dirichlet(const FineProblem& fine) {
  std::vector<Vec2> uvs;
  stage("flatten", 0.85, [&](StageStatistics&, const Checkpoint&) {
    uvs = carry_boundary(*disk_, fine.coarse, fine.coarse_uvs);
    solve_harmonic(*disk_, fine.cotangents, uvs, options_.threads);
  });
  mend(fine, keeps_boundary_simple(), 0.95, uvs);
  return uvs;
}

/// Composite majorization of the fine mesh, from its boundary on a circle; with `simple` the
/// boundary stays so.
std::vector<Vec2> Run::descend_from_circle(const std::vector<RestTriangle>& rest, bool simple,
                                           StageStatistics& statistics,
                                           const Checkpoint& checkpoint) {
  std::vector<Vec2> uvs = tutte_embedding(*disk_);
  const RepairOptions mend{.simple_boundary = true,
                           .threads = options_.threads,
                           .global_fix = affords(*disk_, options_, Extra::kGlobalFix)};
  repair(*disk_, rest, uvs, mend, checkpoint);
  if (!certify(disk_->faces, disk_->boundary, uvs, options_.threads).injective()) {
    uvs = grid_drawing(*disk_);
  }
  scale_best(*disk_, rest, uvs);
  start_flat(*disk_, rest, uvs);
  const NewtonResult done =
      descend(*disk_, rest, newton_options(), simple, uvs, statistics, checkpoint);
  if (!done.converged) result_.status = BELTRAMI_NOT_CONVERGED;
  return uvs;
}

/// Without inner vertices nothing is harmonic, and the subspace that of all maps: the same problem,
/// for which sparse steps take a fraction of the time of dense ones.
std::vector<Vec2> Run::flatten_reduced(const FineProblem& fine, bool scaffold) {
  std::vector<Vec2> uvs;
  stage("flatten", 0.85, [&](StageStatistics& statistics, const Checkpoint& checkpoint) {
    if (size_of(disk_->boundary) == disk_->vertex_count()) {
      uvs = descend_from_circle(fine.rest, scaffold, statistics, checkpoint);
      return;
    }
    ReducedOptions reduced;
    reduced.scaffold = scaffold;
    reduced.threads = options_.threads;
    reduced.energy = options_.energy;
    ReducedResult map =
        beltrami::flatten_reduced(*disk_, fine.rest, fine.cotangents, reduced, checkpoint);
    statistics.iterations = static_cast<int>(map.energies.size()) - 1;
    if (!map.converged) result_.status = BELTRAMI_NOT_CONVERGED;
    uvs = std::move(map.uvs);
  });
  mend(fine, scaffold, 0.95, uvs);
  return uvs;
}

/// No guarantee, so nothing is mended: its flips are what it is judged by.
std::vector<Vec2> Run::flatten_boundary_first(const FineProblem& fine) {
  std::vector<Vec2> uvs;
  stage("flatten", 0.9, [&](StageStatistics&, const Checkpoint& checkpoint) {
    const auto lengths = metric_boundary_lengths(*disk_, fine.rest, fine.metric);
    uvs = beltrami::flatten_boundary_first(*disk_, fine.rest, fine.metric, lengths, checkpoint).uvs;
    // A conformal map is as good at any scale; the energies are not.
    const double scale = best_scale(options_.energy, disk_->faces, fine.rest, uvs);
    for (Vec2& w : uvs) w *= scale;
  });
  count_flips(uvs);
  return uvs;
}

/// The metric solve and its polish. Where boundary parts press on each other in the coarse map, and
/// where the solve would have the boundary cross itself, springs draw it to its place in the coarse
/// map, further around in each round; the polish then works with contact instead. (The coarse
/// boundary is simple, or there is nothing to be drawn to.)
std::vector<Vec2> Run::flatten_metric(const FineProblem& fine) {
  const std::vector<Vec2> carried = carry_boundary(*disk_, fine.coarse, fine.coarse_uvs);
  const BoundaryContact contact(disk_->boundary, boundary_lengths(*disk_),
                                coarse_boundary_lengths(*disk_, fine.coarse));
  const bool global = keeps_boundary_simple() && contact.is_simple(carried);
  std::vector<bool> anchored;
  if (global && fine.in_contact) {
    anchored = vertices_in_contact(fine.coarse, fine.coarse_uvs, disk_->vertex_count());
  }
  std::unique_ptr<MetricLaplacian> laplacian;
  std::vector<Vec2> uvs;
  bool positive = false;
  const auto solve = [&] {
    positive = solve_flat(fine, carried, anchored, laplacian, uvs);
    return true;
  };
  if (!global) {
    solve();
  } else if (!solve_until_simple(*disk_, uvs, anchored, solve)) {
    FineProblem harmonic = fine;
    harmonic.cotangents = modified_cotangents(fine.rest, fine.metric, options_.threads);
    return flatten_dirichlet(harmonic);
  }
  if (!positive) return uvs;
  const bool pressed = !anchored.empty();
  const std::vector<Vec2> before = uvs;
  bool converged =
      polish_map(fine, pressed ? std::optional(contact) : std::nullopt, *laplacian, uvs);
  if (global && !pressed && !contact.is_simple(uvs)) {
    uvs = before;
    converged = polish_map(fine, contact, *laplacian, uvs);
  }
  if (!converged) result_.status = BELTRAMI_NOT_CONVERGED;
  return uvs;
}

/// The solve, with the boundary vertices `anchored` drawn to their `carried` places, and its
/// repair. Sets `laplacian` up where there is none yet. Returns whether all faces are positive.
bool Run::solve_flat(const FineProblem& fine, const std::vector<Vec2>& carried,
                     const std::vector<bool>& anchored, std::unique_ptr<MetricLaplacian>& laplacian,
                     std::vector<Vec2>& uvs) {
  uvs = carried;
  stage("flatten", 0.63, [&](StageStatistics&, const Checkpoint& checkpoint) {
    const auto stiffness =
        energy_stiffness(options_.energy, fine.rest, fine.metric, options_.threads);
    const Anchors anchors{stiff_springs(*disk_, stiffness, anchored), carried};
    if (laplacian) {
      laplacian->refit(*disk_, stiffness, anchors.springs);
    } else {
      laplacian = std::make_unique<MetricLaplacian>(
          *disk_, stiffness, only_first_of_boundary(*disk_),
          SolverOptions{
              .precision = Precision::kSingle, .threads = options_.threads, .residual = kRoughly},
          anchors.springs);
    }
    checkpoint(0.75);
    const auto solve = [&](bool rotate) {
      solve_metric(*disk_, fine.rest, fine.metric, stiffness, *laplacian, anchors, rotate,
                   options_.threads, uvs);
      put_in_place(anchored, carried, uvs);
      return non_positive_faces(disk_->faces, uvs, options_.threads).size();
    };
    std::size_t flips = solve(false);
    for (int round = 0; round < kRotations && flips > kManyFlips; ++round) flips = solve(true);
    const double share = static_cast<double>(flips) / disk_->face_count();
    if (flips <= kManyFlips || share <= kFlippedShare) return;
    if (!affords(*disk_, options_, Extra::kHarmonicMap)) return;
    // On extreme models the free map flips far more than the harmonic one.
    std::vector<Vec2> harmonic = carried;
    solve_harmonic(*disk_, modified_cotangents(fine.rest, fine.metric, options_.threads), harmonic,
                   options_.threads);
    if (non_positive_faces(disk_->faces, harmonic, options_.threads).size() < flips) {
      uvs.swap(harmonic);
    }
  });
  return mend(fine, false, 0.66, uvs);
}

/// A few steps of composite majorization: they cost most, and are not held up by nearly singular
/// faces.
NewtonResult Run::take_newton_steps(const FineProblem& fine, const BoundaryContact* contact,
                                    std::vector<Vec2>& uvs, const Checkpoint& checkpoint) {
  NewtonOptions newton = newton_options();
  newton.proxy_steps = 0;
  newton.contact = contact;
  newton.max_iterations = kNewtonSteps;
  newton.tolerance = std::max(newton.tolerance, kNewtonTolerance);
  const std::vector<bool> fixed = only_first_of_boundary(*disk_);
  return minimise_energy(disk_->faces, fine.rest, fixed, uvs, newton,
                         [&](double) { checkpoint(0.9); });
}

/// L-BFGS: one step with the factor of the flattening, which is that of the prolonged metric, if
/// that one gets through; the others with one that is fitted to the map by then. Where nearly
/// singular faces block the steps, patches around these are optimised and the factor is fitted
/// anew; where that does not help either, and much is left to gain, Newton steps end it. Returns
/// whether the map ends stationary.
bool Run::polish_map(const FineProblem& fine, std::optional<BoundaryContact> contact,
                     MetricLaplacian& laplacian, std::vector<Vec2>& uvs) {
  bool converged = false;
  stage("polish", 0.97, [&](StageStatistics& statistics, const Checkpoint& checkpoint) {
    const auto comparable = [&](double energy) {
      return comparable_energy(options_.energy, energy);
    };
    if (contact) contact->fit(uvs, comparable(fine.coarse_energy));
    // The objective is a mean, the stiffness that of a sum.
    const double area = surface_area(*disk_, options_.threads);
    const Precondition precondition = [&](const std::vector<Vec2>& in, std::vector<Vec2>& out) {
      laplacian.precondition(in, out);
      for (Vec2& w : out) w *= area;
    };
    const auto run = [&](int steps, bool force_first) {
      PolishOptions options;
      options.energy = options_.energy;
      options.threads = options_.threads;
      options.tolerance = kPolishTolerance;
      options.max_iterations = steps;
      options.force_first = force_first;
      options.contact = contact ? &*contact : nullptr;
      const int before = statistics.iterations;
      PolishResult polished =
          polish(disk_->faces, fine.rest, precondition, uvs, options,
                 [&](double done) { checkpoint((before + done * steps) / kPolishIterations); });
      statistics.iterations += polished.iterations();
      return polished;
    };
    const auto clean = [&](const std::vector<Index>& also) {
      result_.cleaned_patches +=
          clean_outliers(options_.energy, *disk_, fine.rest, uvs, options_.threads, also);
    };
    PolishResult polished = run(1, false);
    if (polished.blocked) clean(polished.blocking);
    double before_last_round = std::numeric_limits<double>::infinity();
    // Rounds of cleaning alone, without a step, are bounded too.
    for (int round = 0; round < kPolishIterations; ++round) {
      if (polished.converged || statistics.iterations >= kPolishIterations) break;
      std::vector<double> springs;
      if (contact) {
        springs = contact->stiffness(uvs);
        for (double& spring : springs) spring *= contact->strength();
      }
      laplacian.refit(
          *disk_, energy_stiffness(options_.energy, disk_->faces, fine.rest, uvs, options_.threads),
          springs);
      polished = run(kPolishIterations - statistics.iterations, true);
      if (!polished.blocked) break;
      clean(polished.blocking);
      // Cleaning counts too: what a round gains includes what it did after the one before.
      const double energy = polished.energies.back();
      const double gained = before_last_round - energy;
      before_last_round = polished.energies.front();
      if (gained <= kLittleGain * comparable(energy)) break;
    }
    const double energy = comparable(polished.energies.back());
    converged = polished.converged || 0.5 * polished.predicted <= kStationary * energy;
    if (!polished.converged && polished.predicted > kMuchLeft * energy &&
        affords(*disk_, options_, Extra::kNewtonSteps)) {
      const NewtonResult ended =
          take_newton_steps(fine, contact ? &*contact : nullptr, uvs, checkpoint);
      statistics.iterations += ended.iterations();
      converged = ended.converged;
    }
    clean({});
    if (contact) scale_best(*disk_, fine.rest, uvs);
  });
  return converged;
}

/// Mends flips and, on demand, crossings of the boundary; where that succeeds, cleans outliers.
/// Returns whether all faces are positive.
bool Run::mend(const FineProblem& fine, bool simple_boundary, double until,
               std::vector<Vec2>& uvs) {
  bool positive = false;
  stage("repair", until, [&](StageStatistics& statistics, const Checkpoint& checkpoint) {
    const RepairOptions options{.simple_boundary = simple_boundary,
                                .threads = options_.threads,
                                .global_fix = affords(*disk_, options_, Extra::kGlobalFix)};
    const RepairResult repaired = repair(*disk_, fine.rest, uvs, options, checkpoint);
    result_.flips_before_repair = repaired.flips_before;
    result_.kernel_fixes += repaired.kernel_fixes;
    result_.patch_fixes += repaired.patch_fixes;
    result_.global_fixes += repaired.global_fixes;
    statistics.iterations =
        static_cast<int>(repaired.kernel_fixes + repaired.patch_fixes + repaired.global_fixes);
    positive = repaired.flips_after == 0;
    if (positive) {
      result_.cleaned_patches +=
          clean_outliers(options_.energy, *disk_, fine.rest, uvs, options_.threads);
    }
  });
  return positive;
}

}  // namespace beltrami
