#include "pipeline/pipeline.h"

#include <algorithm>
#include <memory>

#include "base/error.h"
#include "fullspace/newton.h"
#include "fullspace/scaffold.h"
#include "fullspace/tutte.h"
#include "pipeline/run.h"
#include "repair/repair.h"
#include "repair/single_precision.h"

namespace beltrami {
namespace {

constexpr double kLeadTolerance = 1e-3;  // of the energy that leads to the one asked for

}  // namespace

void Run::report(double fraction, const char* name) {
  fraction_ = std::max(fraction_, fraction);
  const bool stop = progress_ && progress_(fraction_, name);
  if (stop || cancelled_.load(std::memory_order_relaxed)) {
    throw Error(BELTRAMI_E_CANCELLED, "the run was cancelled");
  }
}

bool Run::keeps_boundary_simple() const {
  const bool reference = options_.method == BELTRAMI_METHOD_CM && !options_.refine;
  return options_.injectivity == BELTRAMI_INJECTIVITY_GLOBAL ||
         (options_.injectivity == BELTRAMI_INJECTIVITY_AUTO && !reference);
}

NewtonOptions Run::newton_options(const DiskMesh& mesh) const {
  NewtonOptions newton;
  newton.energy = options_.energy;
  newton.tolerance = options_.tolerance;
  newton.max_iterations = options_.max_iterations;
  newton.threads = options_.threads;
  if (keeps_boundary_simple()) {
    newton.admissible = [&mesh](const std::vector<Vec2>& map) {
      return count_crossings(mesh.boundary, map).count == 0;
    };
  }
  return newton;
}

/// Composite majorization; with a scaffold from the first step on that would make the boundary
/// cross itself. Far from the minimum the symmetric Dirichlet energy leads the way: it is smooth,
/// and its minimum is near that of the others (symmetric ARAP alone takes 1.5 times the steps).
NewtonResult Run::descend(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                          NewtonOptions newton, std::vector<Vec2>& uvs, StageStatistics& statistics,
                          const Checkpoint& checkpoint) {
  std::vector<bool> fixed(mesh.vertex_count(), false);
  fixed[mesh.boundary.front()] = true;
  if (newton.proxy_steps > 0 && newton.energy != BELTRAMI_ENERGY_SYMMETRIC_DIRICHLET) {
    NewtonOptions lead = newton;
    lead.energy = BELTRAMI_ENERGY_SYMMETRIC_DIRICHLET;
    lead.tolerance = std::max(lead.tolerance, kLeadTolerance);
    statistics.iterations =
        minimise_energy(mesh.faces, rest, fixed, uvs, lead, checkpoint).iterations();
    newton.max_iterations -= statistics.iterations;
    newton.proxy_steps = 0;
  }
  NewtonResult done = minimise_energy(mesh.faces, rest, fixed, uvs, newton, checkpoint);
  statistics.iterations += done.iterations();
  if (done.refused) {
    newton.max_iterations -= done.iterations();
    done = minimise_with_scaffold(mesh, rest, uvs, newton, checkpoint);
    statistics.iterations += done.iterations();
  }
  return done;
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
    if (repair(mesh, rest, uvs, {.threads = options_.threads}, checkpoint).flips_after > 0) return;
    const double scale = best_scale(options_.energy, mesh.faces, rest, uvs);
    for (Vec2& w : uvs) w *= scale;
    const NewtonResult done =
        descend(mesh, rest, newton_options(mesh), uvs, statistics, checkpoint);
    if (!done.converged) result_.status = BELTRAMI_NOT_CONVERGED;
  });
  return uvs;
}

/// Goes on with composite majorization on the fine mesh (the paper's hybrid). What it starts from
/// is kept if it cannot be improved; a map that is not injective is left alone.
void Run::refine(std::vector<Vec2>& uvs) {
  const Certificate certificate = certify(disk_.faces, disk_.boundary, uvs, options_.threads);
  if (certificate.orientations.first_bad_face != kNone) return;
  if (keeps_boundary_simple() && certificate.crossings.count > 0) return;
  stage("refine", 0.97, [&](StageStatistics& statistics, const Checkpoint& checkpoint) {
    const auto rest = rest_triangles(disk_.positions, disk_.faces, options_.threads);
    NewtonOptions newton = newton_options(disk_);
    newton.proxy_steps = 0;  // they pay far from the minimum
    if (options_.refine_iterations > 0) newton.max_iterations = options_.refine_iterations;
    if (options_.time_limit > 0) {
      newton.out_of_time = [&] { return wall_seconds() - started_ > options_.time_limit; };
    }
    const NewtonResult done = descend(disk_, rest, newton, uvs, statistics, checkpoint);
    const bool limited = options_.refine_iterations > 0 || options_.time_limit > 0;
    if (!done.converged && !limited) result_.status = BELTRAMI_NOT_CONVERGED;
  });
}

/// Brings the map into the caller's unit (exactly: the scale is a power of two), its bounding box
/// around the origin, or into the unit square.
void Run::place(const Normalisation& frame, std::vector<Vec2>& uvs) const {
  Vec2 low = uvs.front(), high = uvs.front();
  for (const Vec2& w : uvs) {
    low = low.cwiseMin(w);
    high = high.cwiseMax(w);
  }
  if (options_.unit_square) {
    // One ulp short, so that no rounding leaves the square.
    const double scale = (1 - 0x1p-52) / (high - low).maxCoeff();
    for (Vec2& w : uvs) w = scale * (w - low);
  } else {
    // Where floats are densest, above all in single precision.
    const Vec2 centre = 0.5 * (low + high);
    for (Vec2& w : uvs) w = (w - centre) / frame.scale;
  }
}

/// Places the map and judges the very numbers that are returned, in double and in single precision.
void Run::deliver(const Normalisation& frame, std::vector<Vec2>& uvs) {
  stage("certify", 1.0, [&](StageStatistics&, const Checkpoint& checkpoint) {
    place(frame, uvs);
    result_.certificate = certify(disk_.faces, disk_.boundary, uvs, options_.threads);
    checkpoint(0.3);
    SinglePrecision single =
        round_to_single(disk_, uvs, result_.certificate, options_.threads, checkpoint);
    result_.single_certificate = single.certificate;
    if (options_.float32) {
      if (!single.certificate.injective() && result_.certificate.injective()) {
        result_.status = BELTRAMI_NOT_INJECTIVE_FLOAT32;
      }
      result_.certificate = single.certificate;
      uvs.swap(single.uvs);
    } else if (single.moved > 0) {
      for (Index v = 0; v < size_of(uvs); ++v) {
        if (single.uvs[v] != nearest_single(uvs[v])) {
          result_.single_moves.emplace_back(v, single.uvs[v]);
        }
      }
    }
    checkpoint(0.8);

    result_.face_energies.resize(disk_.faces.size());
    // Undone for the measure, which takes UVs in the unit of the normalised positions.
    std::vector<Vec2> in_mesh_unit(uvs.size());
    for (std::size_t v = 0; v < uvs.size(); ++v) in_mesh_unit[v] = uvs[v] * frame.scale;
    result_.distortion = measure_distortion(disk_.positions, disk_.faces, in_mesh_unit,
                                            options_.threads, result_.face_energies.data());
  });
  if (!result_.certificate.injective() && result_.status != BELTRAMI_NOT_INJECTIVE_FLOAT32) {
    result_.status = BELTRAMI_NOT_INJECTIVE;
  }
}

std::vector<Vec2> Run::run_method() {
  std::vector<Vec2> uvs;
  switch (options_.method) {
    case BELTRAMI_METHOD_CM:
      result_.coarse_faces = disk_.face_count();
      return run_cm(disk_, "cm", 0.9);
    case BELTRAMI_METHOD_TUTTE:
      stage("tutte", 0.9,
            [&](StageStatistics&, const Checkpoint&) { uvs = tutte_embedding(disk_); });
      return uvs;
    case BELTRAMI_METHOD_GIF:
    case BELTRAMI_METHOD_BFF:
      return run_plain();
    case BELTRAMI_METHOD_UV_PROLONGATION:
      return run_uv_prolongation();
    default:
      return run_beltrami();
  }
}

Flattening Run::flatten(const Normalisation& frame) {
  const double cpu = cpu_seconds();
  std::vector<Vec2> uvs = run_method();
  if (options_.refine) refine(uvs);
  deliver(frame, uvs);
  result_.uvs = std::move(uvs);
  result_.seconds = wall_seconds() - started_;
  result_.cpu_seconds = cpu_seconds() - cpu;
  result_.peak_memory_bytes = peak_memory_bytes();
  return std::move(result_);
}

Flattening flatten(const DiskMesh& disk, const Normalisation& frame, const Options& options,
                   const Progress& progress, const std::atomic<bool>& cancelled) {
  return Run(disk, options, progress, cancelled).flatten(frame);
}

}  // namespace beltrami
