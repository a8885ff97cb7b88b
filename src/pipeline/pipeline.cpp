#include "pipeline/pipeline.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/resources.h"
#include "beltrami/prolongation.h"
#include "flatten/dirichlet.h"
#include "fullspace/newton.h"
#include "fullspace/tutte.h"
#include "mesh/rest_shape.h"
#include "repair/repair.h"
#include "simplify/simplify.h"

namespace beltrami {
namespace {

constexpr Index kLeastCoarseFaces = 10000;
constexpr double kCoarseShare = 0.01;

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

/// Tutte's embedding, then composite majorization. A start that is folded in floating point is
/// mended first; if it cannot be, it is returned as it is, and the certificate will say so.
std::vector<Vec2> Run::run_cm(const DiskMesh& mesh, const char* name, double until) {
  std::vector<Vec2> uvs;
  stage(name, until, [&](StageStatistics& statistics, const Checkpoint& checkpoint) {
    const auto rest = rest_triangles(mesh.positions, mesh.faces, options_.threads);
    uvs = tutte_embedding(mesh);
    checkpoint(0.02);
    if (repair(mesh, rest, uvs, options_.threads, checkpoint).flips_after > 0) return;
    const double scale = best_scale(mesh.faces, rest, uvs);
    for (Vec2& w : uvs) w *= scale;
    std::vector<bool> fixed(mesh.vertex_count(), false);
    fixed[mesh.boundary.front()] = true;
    const NewtonOptions newton{options_.tolerance, options_.max_iterations, options_.threads};
    const NewtonResult done =
        minimise_energy(mesh.faces, rest, fixed, uvs, newton, checkpoint);
    statistics.iterations = done.iterations();
    if (!done.converged) result_.status = BELTRAMI_NOT_CONVERGED;
  });
  return uvs;
}

std::vector<Vec2> Run::run_beltrami() {
  const Index target = options_.coarse_faces > 0
                           ? static_cast<Index>(std::min<std::int64_t>(options_.coarse_faces,
                                                                       disk_.face_count()))
                           : std::max(kLeastCoarseFaces, static_cast<Index>(std::lround(
                                                             kCoarseShare * disk_.face_count())));
  if (target >= disk_.face_count()) {
    result_.coarse_faces = disk_.face_count();
    return run_cm(disk_, "coarse", 0.9);
  }
  CoarseDisk coarse;
  stage("simplify", 0.15, [&](StageStatistics&, const Checkpoint& checkpoint) {
    coarse = simplify(disk_, target, checkpoint);
  });
  result_.coarse_faces = coarse.mesh.face_count();
  const std::vector<Vec2> coarse_uvs = run_cm(coarse.mesh, "coarse", 0.35);

  std::vector<FaceMetric> metric;
  stage("prolong", 0.5, [&](StageStatistics&, const Checkpoint& checkpoint) {
    const auto rest = rest_triangles(coarse.mesh.positions, coarse.mesh.faces, options_.threads);
    metric = prolong_metric(coarse.mesh, face_metrics(coarse.mesh.faces, rest, coarse_uvs), disk_,
                            options_.threads, checkpoint);
  });

  std::vector<Vec2> uvs;
  std::vector<RestTriangle> rest;
  stage("flatten", 0.85, [&](StageStatistics&, const Checkpoint&) {
    rest = rest_triangles(disk_.positions, disk_.faces, options_.threads);
    uvs = carry_boundary(disk_, coarse, coarse_uvs);
    solve_harmonic(disk_, rest, metric, uvs);
  });
  stage("repair", 0.95, [&](StageStatistics& statistics, const Checkpoint& checkpoint) {
    const RepairResult repaired = repair(disk_, rest, uvs, options_.threads, checkpoint);
    result_.flips_before_repair = repaired.flips_before;
    statistics.iterations = static_cast<int>(repaired.kernel_fixes + repaired.patch_fixes);
  });
  return uvs;
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
      stage("tutte", 0.9, [&](StageStatistics&, const Checkpoint&) {
        uvs = tutte_embedding(disk_);
      });
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
