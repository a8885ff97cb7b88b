#include "pipeline/pipeline.h"

#include <algorithm>
#include <memory>

#include "base/error.h"
#include "base/resources.h"
#include "beltrami/prolongation.h"
#include "flatten/dirichlet.h"
#include "flatten/metric.h"
#include "flatten/polish.h"
#include "fullspace/newton.h"
#include "fullspace/scaffold.h"
#include "fullspace/tutte.h"
#include "mesh/rest_shape.h"
#include "repair/outliers.h"
#include "repair/repair.h"
#include "simplify/simplify.h"

namespace beltrami {
namespace {

constexpr std::int64_t kLeastCoarseFaces = 10000;
constexpr double kCoarseShare = 0.01;
constexpr int kRotations = 2;           // ARAP rounds after the Poisson solve
constexpr std::size_t kManyFlips = 20;  // beyond which the harmonic map is looked at too
constexpr int kPolishIterations = 20;
constexpr int kPolishRounds = 6;      // each ended by faces that block the steps
constexpr double kFirstReach = 0.01;  // of the boundary length, held on both sides of a crossing
constexpr double kReachGrowth = 3;

/// What is known about the fine mesh when the coarse one is done.
struct FineProblem {
  CoarseDisk coarse;
  std::vector<Vec2> coarse_uvs;
  std::vector<RestTriangle> rest;
  std::vector<FaceMetric> metric;
};

/// One run: times its stages, maps their progress into the whole, and cancels them.
class Run {
 public:
  Run(const DiskMesh& disk, const Options& options, const Progress& progress,
      const std::atomic<bool>& cancelled)
      : disk_(disk), options_(options), progress_(progress), cancelled_(cancelled) {}

  Flattening flatten(const Normalisation& frame);

 private:
  /// Runs `body(statistics, checkpoint)` as the stage `name`, which takes the progress bar up to
  /// `until`.
  template <class Body>
  void stage(const char* name, double until, Body&& body);
  void report(double fraction, const char* name);

  std::vector<Vec2> run_beltrami();
  Index coarse_target() const;
  std::vector<Vec2> flatten_metric(const FineProblem& fine);
  std::vector<Vec2> flatten_dirichlet(const FineProblem& fine);
  void hold_near(const std::vector<std::array<Index, 2>>& edges, double reach,
                 std::vector<bool>& held) const;
  std::vector<Vec2> solve_and_polish(const FineProblem& fine, const std::vector<Vec2>& carried,
                                     const std::vector<bool>& held, bool global);
  bool mend(const FineProblem& fine, double until, std::vector<Vec2>& uvs);
  std::vector<Vec2> run_cm(const DiskMesh& mesh, const char* name, double until);
  void deliver(const Normalisation& frame, std::vector<Vec2>& uvs);

  const DiskMesh& disk_;
  const Options& options_;
  const Progress& progress_;
  const std::atomic<bool>& cancelled_;
  double fraction_ = 0;
  Flattening result_;
};

template <class Body>
void Run::stage(const char* name, double until, Body&& body) {
  const double from = fraction_;
  const double wall = wall_seconds(), cpu = cpu_seconds();
  StageStatistics statistics{name};
  const Checkpoint checkpoint = [&](double fraction) {
    report(from + (until - from) * std::clamp(fraction, 0.0, 1.0), name);
  };
  checkpoint(0);
  body(statistics, checkpoint);
  checkpoint(1);
  statistics.seconds = wall_seconds() - wall;
  statistics.cpu_seconds = cpu_seconds() - cpu;
  result_.stages.push_back(statistics);
}

void Run::report(double fraction, const char* name) {
  fraction_ = std::max(fraction_, fraction);
  const bool stop = progress_ && progress_(fraction_, name);
  if (stop || cancelled_.load(std::memory_order_relaxed)) {
    throw Error(BELTRAMI_E_CANCELLED, "the run was cancelled");
  }
}

/// Tutte's embedding, then composite majorization; with a scaffold from the first step on that
/// would make the boundary cross itself. A start that is folded in floating point is mended first;
/// if it cannot be, it is returned as it is, and the certificate will say so.
std::vector<Vec2> Run::run_cm(const DiskMesh& mesh, const char* name, double until) {
  std::vector<Vec2> uvs;
  stage(name, until, [&](StageStatistics& statistics, const Checkpoint& checkpoint) {
    const auto rest = rest_triangles(mesh.positions, mesh.faces, options_.threads);
    uvs = tutte_embedding(mesh);
    checkpoint(0.02);
    if (repair(mesh, rest, uvs, options_.threads, checkpoint).flips_after > 0) return;
    const double scale = best_scale(options_.energy, mesh.faces, rest, uvs);
    for (Vec2& w : uvs) w *= scale;
    std::vector<bool> fixed(mesh.vertex_count(), false);
    fixed[mesh.boundary.front()] = true;
    NewtonOptions newton;
    newton.energy = options_.energy;
    newton.tolerance = options_.tolerance;
    newton.max_iterations = options_.max_iterations;
    newton.threads = options_.threads;
    if (options_.injectivity == BELTRAMI_INJECTIVITY_GLOBAL) {
      newton.admissible = [&](const std::vector<Vec2>& map) {
        return count_crossings(mesh.boundary, map).count == 0;
      };
    }
    NewtonResult done = minimise_energy(mesh.faces, rest, fixed, uvs, newton, checkpoint);
    statistics.iterations = done.iterations();
    if (done.refused) {
      newton.max_iterations -= done.iterations();
      done = minimise_with_scaffold(mesh, rest, uvs, newton, checkpoint);
      statistics.iterations += done.iterations();
    }
    if (!done.converged) result_.status = BELTRAMI_NOT_CONVERGED;
  });
  return uvs;
}

std::vector<Vec2> Run::run_beltrami() {
  const Index target = coarse_target();
  if (target >= disk_.face_count()) {
    result_.coarse_faces = disk_.face_count();
    return run_cm(disk_, "coarse", 0.9);
  }
  FineProblem fine;
  stage("simplify", 0.12, [&](StageStatistics&, const Checkpoint& checkpoint) {
    fine.coarse = simplify(disk_, target, checkpoint);
  });
  result_.coarse_faces = fine.coarse.mesh.face_count();
  fine.coarse_uvs = run_cm(fine.coarse.mesh, "coarse", 0.22);

  stage("prolong", 0.37, [&](StageStatistics&, const Checkpoint& checkpoint) {
    const DiskMesh& mesh = fine.coarse.mesh;
    const auto rest = rest_triangles(mesh.positions, mesh.faces, options_.threads);
    fine.metric = prolong_metric(mesh, face_metrics(mesh.faces, rest, fine.coarse_uvs), disk_,
                                 options_.threads, checkpoint);
    fine.rest = rest_triangles(disk_.positions, disk_.faces, options_.threads);
  });
  if (options_.flatten == BELTRAMI_FLATTEN_METRIC) return flatten_metric(fine);
  return flatten_dirichlet(fine);
}

Index Run::coarse_target() const {
  const double share = kCoarseShare * disk_.face_count();
  const auto target = options_.coarse_faces > 0
                          ? options_.coarse_faces
                          : std::max(kLeastCoarseFaces, static_cast<std::int64_t>(share));
  return static_cast<Index>(std::min<std::int64_t>(target, disk_.face_count()));
}

std::vector<Vec2> Run::flatten_dirichlet(const FineProblem& fine) {
  std::vector<Vec2> uvs;
  stage("flatten", 0.85, [&](StageStatistics&, const Checkpoint&) {
    uvs = carry_boundary(disk_, fine.coarse, fine.coarse_uvs);
    solve_harmonic(disk_, fine.rest, fine.metric, uvs);
  });
  mend(fine, 0.95, uvs);
  return uvs;
}

/// The metric solve and its polish. A free boundary may cross itself: then the boundary near the
/// crossings is held where the coarse map has it, further around in each round, up to the whole of
/// it. (The coarse boundary is simple, or there is nothing to hold on to.)
std::vector<Vec2> Run::flatten_metric(const FineProblem& fine) {
  const std::vector<Vec2> carried = carry_boundary(disk_, fine.coarse, fine.coarse_uvs);
  const bool global = options_.injectivity == BELTRAMI_INJECTIVITY_GLOBAL &&
                      count_crossings(disk_.boundary, carried).count == 0;
  std::vector<bool> held(disk_.vertex_count(), false);
  held[disk_.boundary.front()] = true;
  std::vector<Vec2> uvs;
  for (double reach = kFirstReach;; reach *= kReachGrowth) {
    uvs = solve_and_polish(fine, carried, held, global);
    if (!global) return uvs;
    const auto crossings = find_crossings(disk_.boundary, uvs);
    if (crossings.empty()) return uvs;
    if (reach > 1) break;
    hold_near(crossings, reach * kReachGrowth > 1 ? 1.0 : reach, held);
  }
  return flatten_dirichlet(fine);
}

/// Holds the boundary vertices within `reach` times the boundary length of the given edges.
void Run::hold_near(const std::vector<std::array<Index, 2>>& edges, double reach,
                    std::vector<bool>& held) const {
  const Index count = size_of(disk_.boundary);
  std::vector<double> along(count + 1, 0);
  for (Index i = 0; i < count; ++i) {
    const Index a = disk_.boundary[i], b = disk_.boundary[i + 1 == count ? 0 : i + 1];
    along[i + 1] = along[i] + (disk_.positions[b] - disk_.positions[a]).norm();
  }
  const double length = along[count];
  for (const auto& pair : edges) {
    for (const Index edge : pair) {
      for (Index i = 0; i < count; ++i) {
        const double apart = std::abs(along[i] - along[edge]);
        if (std::min(apart, length - apart) <= reach * length) held[disk_.boundary[i]] = true;
      }
      held[disk_.boundary[edge]] = held[disk_.boundary[edge + 1 == count ? 0 : edge + 1]] = true;
    }
  }
}

std::vector<Vec2> Run::solve_and_polish(const FineProblem& fine, const std::vector<Vec2>& carried,
                                        const std::vector<bool>& held, bool global) {
  std::vector<Vec2> uvs = carried;
  std::unique_ptr<MetricLaplacian> laplacian;
  stage("flatten", 0.63, [&](StageStatistics&, const Checkpoint& checkpoint) {
    laplacian = std::make_unique<MetricLaplacian>(disk_, fine.rest, fine.metric, held);
    checkpoint(0.75);
    solve_metric(disk_, fine.rest, fine.metric, *laplacian, kRotations, options_.threads, uvs);
    const auto flips = non_positive_faces(disk_.faces, uvs, options_.threads).size();
    if (flips <= kManyFlips) return;
    // On extreme models the free map flips far more than the harmonic one.
    std::vector<Vec2> harmonic = carried;
    solve_harmonic(disk_, fine.rest, fine.metric, harmonic);
    if (non_positive_faces(disk_.faces, harmonic, options_.threads).size() < flips) {
      uvs.swap(harmonic);
    }
  });
  if (!mend(fine, 0.66, uvs)) return uvs;
  // Polishing a map that crosses itself already would be in vain.
  if (global && count_crossings(disk_.boundary, uvs).count > 0) return uvs;

  stage("polish", 0.97, [&](StageStatistics& statistics, const Checkpoint& checkpoint) {
    const double curvature =
        with_density(options_.energy, [](auto density) { return density.kCurvature; });
    const double step = surface_area(disk_) / curvature;
    const auto precondition = [&](const DenseMatrix& gradient) -> DenseMatrix {
      return step * laplacian->solve(gradient);
    };
    PolishOptions polish_options;
    polish_options.energy = options_.energy;
    polish_options.threads = options_.threads;
    for (int round = 0; round < kPolishRounds; ++round) {
      polish_options.max_iterations = kPolishIterations - statistics.iterations;
      if (polish_options.max_iterations <= 0) break;
      const PolishResult polished =
          polish(disk_.faces, fine.rest, precondition, uvs, polish_options, [&](double) {
            checkpoint(static_cast<double>(statistics.iterations) / kPolishIterations);
          });
      statistics.iterations += polished.iterations();
      clean_outliers(options_.energy, disk_, fine.rest, uvs, options_.threads);
      if (!polished.blocked) break;
    }
  });
  return uvs;
}

/// Mends flips and, where that succeeds, cleans outliers. Returns whether all faces are positive.
bool Run::mend(const FineProblem& fine, double until, std::vector<Vec2>& uvs) {
  bool positive = false;
  stage("repair", until, [&](StageStatistics& statistics, const Checkpoint& checkpoint) {
    const RepairResult repaired = repair(disk_, fine.rest, uvs, options_.threads, checkpoint);
    result_.flips_before_repair = repaired.flips_before;
    statistics.iterations = static_cast<int>(repaired.kernel_fixes + repaired.patch_fixes);
    positive = repaired.flips_after == 0;
    if (positive) clean_outliers(options_.energy, disk_, fine.rest, uvs, options_.threads);
  });
  return positive;
}

/// Brings the map into the caller's unit (exactly: the scale is a power of two) or into the unit
/// square, and judges the very numbers that are returned.
void Run::deliver(const Normalisation& frame, std::vector<Vec2>& uvs) {
  stage("certify", 1.0, [&](StageStatistics&, const Checkpoint&) {
    double scale = 1 / frame.scale;
    if (options_.unit_square) {
      Vec2 low = uvs.front(), high = uvs.front();
      for (const Vec2& w : uvs) {
        low = low.cwiseMin(w);
        high = high.cwiseMax(w);
      }
      // One ulp short, so that no rounding leaves the square.
      scale = (1 - 0x1p-52) / (high - low).maxCoeff();
      for (Vec2& w : uvs) w -= low;
    }
    for (Vec2& w : uvs) w *= scale;
    result_.certificate = certify(disk_.faces, disk_.boundary, uvs, options_.threads);

    result_.face_energies.resize(disk_.faces.size());
    // Undone for the measure, which takes UVs in the unit of the normalised positions.
    std::vector<Vec2> in_mesh_unit(uvs.size());
    for (std::size_t v = 0; v < uvs.size(); ++v) in_mesh_unit[v] = uvs[v] * frame.scale;
    result_.distortion = measure_distortion(disk_.positions, disk_.faces, in_mesh_unit,
                                            options_.threads, result_.face_energies.data());
  });
  if (!result_.certificate.injective()) result_.status = BELTRAMI_NOT_INJECTIVE;
}

Flattening Run::flatten(const Normalisation& frame) {
  const double wall = wall_seconds(), cpu = cpu_seconds();
  std::vector<Vec2> uvs;
  switch (options_.method) {
    case BELTRAMI_METHOD_CM:
      result_.coarse_faces = disk_.face_count();
      uvs = run_cm(disk_, "cm", 0.9);
      break;
    case BELTRAMI_METHOD_TUTTE:
      stage("tutte", 0.9,
            [&](StageStatistics&, const Checkpoint&) { uvs = tutte_embedding(disk_); });
      break;
    default:
      uvs = run_beltrami();
  }
  deliver(frame, uvs);
  result_.uvs = std::move(uvs);
  result_.seconds = wall_seconds() - wall;
  result_.cpu_seconds = cpu_seconds() - cpu;
  result_.peak_memory_bytes = peak_memory_bytes();
  return std::move(result_);
}

}  // namespace

Flattening flatten(const DiskMesh& disk, const Normalisation& frame, const Options& options,
                   const Progress& progress, const std::atomic<bool>& cancelled) {
  return Run(disk, options, progress, cancelled).flatten(frame);
}

}  // namespace beltrami
