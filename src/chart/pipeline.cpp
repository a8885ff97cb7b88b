#include "chart/pipeline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>

#include "base/checkpoint.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "base/resources.h"
#include "chart/anchors.h"
#include "chart/memory_estimate.h"
#include "chart/run.h"
#include "descend/contact.h"
#include "descend/flat_start.h"
#include "descend/grid_drawing.h"
#include "descend/newton.h"
#include "descend/tutte.h"
#include "energy/energy.h"
#include "exact/crossings.h"
#include "flatten/dirichlet.h"
#include "flatten/laplacian.h"
#include "flatten/metric.h"
#include "linear/spd_solver.h"
#include "mesh/boundary.h"
#include "mesh/rest_shape.h"
#include "prolong/prolongation.h"
#include "repair/outliers.h"
#include "repair/repair.h"
#include "simplify/simplify.h"

namespace beltrami {
namespace {

/// Times the tolerance, for the coarse mesh: steps are cheap there, and how a map spreads its
/// distortion over the whole is what polishing the fine one hardly changes.
constexpr double kCoarseTolerance = 0.1;
constexpr double kLeadTolerance = 1e-3;  // of the energy that leads to the one asked for
/// Coarse faces with which a run that broke its promise is tried again (paper section 3.2).
constexpr std::array<Index, 2> kFallbacks = {1000, 100};
constexpr Index kFewestFaces = 20;
/// Of a mesh with contact: from so many on, and where the last map without crossings has so much
/// more energy than the free minimum, it starts from a mesh of a quarter of the faces. With a tenth
/// the boundary crosses itself too often when it is carried over.
constexpr Index kContactFaces = 3000;
constexpr Index kContactReduction = 4;
constexpr double kFarStart = 1.1;
/// Scales nearer to each other than that differ by 1e-11 of the energy: not worth a rounding.
constexpr double kSameScale = 1e-6;
/// Mean energy beyond which composite majorization has not got anywhere: it is 2 to 100 at minima.
constexpr double kHopelessEnergy = 1e3;

}  // namespace

void Run::report(double fraction, const char* name) {
  fraction_ = std::max(fraction_, fraction);
  const bool stop = progress_ && progress_(fraction_, name);
  if (stop || cancelled_.load(std::memory_order_relaxed)) throw Cancelled();
  poll_interrupt();
}

bool Run::keeps_boundary_simple() const {
  const bool reference = options_.method == BELTRAMI_METHOD_CM && !options_.refine;
  return options_.injectivity == BELTRAMI_INJECTIVITY_GLOBAL ||
         (options_.injectivity == BELTRAMI_INJECTIVITY_AUTO && !reference);
}

NewtonOptions Run::newton_options() const {
  NewtonOptions newton;
  newton.energy = options_.energy;
  newton.tolerance = options_.tolerance;
  newton.max_iterations = options_.max_iterations;
  newton.threads = options_.threads;
  return newton;
}

/// Composite majorization. Far from the minimum the symmetric Dirichlet energy leads the way: it is
/// smooth, and its minimum is near that of the others (symmetric ARAP alone takes 1.5 times the
/// steps).
NewtonResult Run::descend_to(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                             NewtonOptions newton, std::vector<Vec2>& uvs,
                             StageStatistics& statistics, const Checkpoint& checkpoint) {
  const std::vector<bool> fixed = only_first_of_boundary(mesh);
  int lead_steps = 0;
  NewtonResult led;
  if (newton.proxy_steps > 0 && newton.energy != BELTRAMI_ENERGY_SYMMETRIC_DIRICHLET) {
    NewtonOptions lead = newton;
    lead.energy = BELTRAMI_ENERGY_SYMMETRIC_DIRICHLET;
    lead.tolerance = std::max(lead.tolerance, kLeadTolerance);
    led = minimise_energy(mesh.faces, rest, fixed, uvs, lead, checkpoint);
    lead_steps = led.iterations();
    newton.max_iterations -= lead_steps;
    newton.proxy_steps = 0;
  }
  NewtonResult done = minimise_energy(mesh.faces, rest, fixed, uvs, newton, checkpoint);
  if (done.refused && done.admitted.empty()) done.admitted.swap(led.admitted);
  statistics.iterations += lead_steps + done.iterations();
  return done;
}

/// The free minimum first; where its boundary crosses itself, and that is not wanted, the minimum
/// with contact, from the last map on the way whose boundary was simple. A map whose boundary parts
/// press on each other already needs no try without contact.
NewtonResult Run::descend(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                          NewtonOptions newton, bool simple, std::vector<Vec2>& uvs,
                          StageStatistics& statistics, const Checkpoint& checkpoint) {
  if (!simple) {
    return descend_to(mesh, rest, newton, uvs, statistics, checkpoint);
  }
  const std::vector<double> lengths = boundary_lengths(mesh);
  const BoundaryContact contact(mesh.boundary, lengths, lengths);
  if (!contact.is_pressed(uvs) || !contact.is_simple(uvs)) {
    newton.admissible = [&](const std::vector<Vec2>& map) { return contact.is_simple(map); };
    NewtonResult free = descend_to(mesh, rest, newton, uvs, statistics, checkpoint);
    if (!free.refused || free.admitted.empty()) return free;
    newton.admissible = nullptr;
    newton.max_iterations -= free.iterations();
    uvs.swap(free.admitted);
    const auto energy = [&](const std::vector<Vec2>& map) {
      return comparable_energy(newton.energy, mean_energy(newton.energy, mesh.faces, rest, map));
    };
    if (mesh.face_count() >= kContactFaces &&
        energy(uvs) > kFarStart * comparable_energy(newton.energy, free.energies.back())) {
      std::vector<Vec2> start = contact_from_coarser(mesh, rest, uvs, checkpoint);
      if (!start.empty() && energy(start) < energy(uvs)) uvs.swap(start);
    }
  }
  newton.contact = &contact;
  newton.tolerance = std::max(newton.tolerance, options_.tolerance);
  NewtonResult pressed = descend_to(mesh, rest, newton, uvs, statistics, checkpoint);
  scale_best(mesh, rest, uvs);  // without the barrier, which presses outwards
  pressed.in_contact = contact.is_pressed(uvs);
  return pressed;
}

/// Tutte's embedding, mended. Where it is folded beyond repair in floating point, a start from a
/// coarser mesh; where that fails too, a drawing that cannot fold.
std::vector<Vec2> Run::start_map(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                                 const Checkpoint& checkpoint) {
  std::vector<Vec2> uvs = tutte_embedding(mesh);
  const RepairOptions mend{.threads = options_.threads,
                           .global_fix = affords(mesh, options_, Extra::kGlobalFix)};
  if (repair(mesh, rest, uvs, mend).flips_after == 0) return uvs;
  std::vector<Vec2> other = start_from_coarser(mesh, rest, checkpoint);
  return other.empty() ? grid_drawing(mesh) : other;
}

void Run::scale_best(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                     std::vector<Vec2>& uvs) const {
  const double scale = best_scale(options_.energy, mesh.faces, rest, uvs);
  if (std::abs(scale - 1) < kSameScale) return;
  for (Vec2& w : uvs) w *= scale;
}

/// Takes a flat start instead where it is injective and has less energy, with that of its contact:
/// where parts are a rounding error apart, nothing moves.
void Run::start_flat(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                     std::vector<Vec2>& uvs) const {
  double least = mean_energy(options_.energy, mesh.faces, rest, uvs);
  const std::vector<double> lengths = boundary_lengths(mesh);
  BoundaryContact contact(mesh.boundary, lengths, lengths);
  for (std::vector<Vec2> start : {projection(mesh), unfolding(mesh, rest)}) {
    scale_best(mesh, rest, start);
    double energy = mean_energy(options_.energy, mesh.faces, rest, start);
    if (!(energy < least) || !certify(mesh.faces, mesh.boundary, start, 1).injective()) continue;
    if (keeps_boundary_simple()) {
      contact.fit(start, 2);
      energy += contact.strength() / surface_area(mesh) * contact.energy(start);
    }
    if (!(energy < least)) continue;
    uvs.swap(start);
    least = energy;
  }
}

/// A map of the finer mesh at the vertices of the coarse one, mended. Returns whether all faces are
/// positive.
bool Run::restrict_map(const std::vector<Vec2>& fine_uvs, const CoarseDisk& coarse,
                       const std::vector<RestTriangle>& rest, std::vector<Vec2>& uvs) const {
  uvs.clear();
  for (const Index v : coarse.fine_vertex) uvs.push_back(fine_uvs[v]);
  const RepairOptions mend{.threads = options_.threads, .global_fix = false};
  return repair(coarse.mesh, rest, uvs, mend).flips_after == 0;
}

/// The minimum on a mesh of `target` faces, and its metric on the finer one; with contact from
/// `start`, a map of the finer one, where that serves, else from a start of its own. Nothing where
/// there is no coarser mesh, or no start on it.
std::optional<CoarserMinimum> Run::minimise_coarser(const DiskMesh& mesh, Index target, bool simple,
                                                    double tolerance, const Checkpoint& checkpoint,
                                                    const std::vector<Vec2>* start) {
  CoarserMinimum minimum{simplify(mesh, target, options_.threads), {}, {}};
  const DiskMesh& coarse = minimum.coarse.mesh;
  // Simplification may get stuck far above its target.
  if (coarse.face_count() > kLeastReduction * mesh.face_count()) return std::nullopt;
  const auto rest = rest_triangles(coarse.positions, coarse.faces, options_.threads);
  NewtonOptions newton = newton_options();
  newton.tolerance = std::max(newton.tolerance, tolerance);
  StageStatistics unused{"coarse"};
  const std::vector<double> lengths = boundary_lengths(coarse);
  const BoundaryContact contact(coarse.boundary, lengths, lengths);
  if (start && restrict_map(*start, minimum.coarse, rest, minimum.uvs) &&
      contact.is_simple(minimum.uvs)) {
    newton.contact = &contact;
    descend_to(coarse, rest, newton, minimum.uvs, unused, checkpoint);
  } else {
    minimum.uvs = start_map(coarse, rest, checkpoint);
    if (!non_positive_faces(coarse.faces, minimum.uvs, 1).empty()) return std::nullopt;
    scale_best(coarse, rest, minimum.uvs);
    descend(coarse, rest, newton, simple, minimum.uvs, unused, checkpoint);
  }
  minimum.metric = prolong_metric(coarse, face_metrics(coarse.faces, rest, minimum.uvs), mesh,
                                  minimum.coarse.nearby, options_.threads);
  return minimum;
}

/// The pipeline in small: a mesh of a tenth of the faces, or 1,000, or 100, is flattened and its
/// metric prolonged. Empty if every size leaves faces flipped.
std::vector<Vec2> Run::start_from_coarser(const DiskMesh& mesh,
                                          const std::vector<RestTriangle>& rest,
                                          const Checkpoint& checkpoint) {
  const bool simple = keeps_boundary_simple();
  Index last = mesh.face_count();
  for (const Index target : {mesh.face_count() / 10, kFallbacks[0], kFallbacks[1]}) {
    if (target >= last || target < kFewestFaces) continue;
    last = target;
    checkpoint(0.05);
    const auto minimum =
        minimise_coarser(mesh, target, simple, 0, [&](double) { checkpoint(0.05); });
    if (!minimum) continue;
    std::vector<Vec2> uvs = carry_boundary(mesh, minimum->coarse, minimum->uvs);
    solve_harmonic(mesh, modified_cotangents(rest, minimum->metric, options_.threads), uvs,
                   options_.threads);
    const RepairOptions mend{.simple_boundary = simple,
                             .threads = options_.threads,
                             .global_fix = affords(mesh, options_, Extra::kGlobalFix)};
    if (repair(mesh, rest, uvs, mend).flips_after > 0) continue;
    if (simple && count_crossings(mesh.boundary, uvs).count > 0) continue;
    clean_outliers(options_.energy, mesh, rest, uvs, options_.threads);
    return uvs;
  }
  return {};
}

/// The minimum with contact of a mesh of a quarter of the faces, from the map `start` of this one,
/// carried over: steps with contact are many, and cheap there. Empty where it is not injective
/// here.
std::vector<Vec2> Run::contact_from_coarser(const DiskMesh& mesh,
                                            const std::vector<RestTriangle>& rest,
                                            const std::vector<Vec2>& start,
                                            const Checkpoint& checkpoint) {
  const auto minimum = minimise_coarser(
      mesh, mesh.face_count() / kContactReduction, true, kLeadTolerance,
      [&](double) { checkpoint(0.5); }, &start);
  if (!minimum) return {};
  const std::vector<Vec2> carried = carry_boundary(mesh, minimum->coarse, minimum->uvs);
  const auto stiffness = energy_stiffness(options_.energy, rest, minimum->metric, options_.threads);
  std::vector<bool> anchored =
      vertices_in_contact(minimum->coarse, minimum->uvs, mesh.vertex_count());
  std::unique_ptr<MetricLaplacian> laplacian;
  std::vector<Vec2> uvs;
  const auto solve = [&] {
    checkpoint(0.5);
    const Anchors anchors{stiff_springs(mesh, stiffness, anchored), carried};
    if (laplacian) {
      laplacian->refit(mesh, stiffness, anchors.springs);
    } else {
      laplacian = std::make_unique<MetricLaplacian>(
          mesh, stiffness, only_first_of_boundary(mesh),
          SolverOptions{.precision = Precision::kSingle, .threads = options_.threads},
          anchors.springs);
    }
    uvs = carried;
    solve_metric(mesh, rest, minimum->metric, stiffness, *laplacian, anchors, false,
                 options_.threads, uvs);
    put_in_place(anchored, carried, uvs);
    const RepairOptions mend{.threads = options_.threads, .global_fix = false};
    return repair(mesh, rest, uvs, mend).flips_after == 0;
  };
  try {
    if (!solve_until_simple(mesh, uvs, anchored, solve)) return {};
  } catch (const Error&) {  // the solver's: there is another start
    return {};
  }
  clean_outliers(options_.energy, mesh, rest, uvs, options_.threads);
  return uvs;
}

/// A start, then composite majorization. Where it crawls at an enormous energy, again from a
/// coarser mesh.
std::vector<Vec2> Run::run_cm(const DiskMesh& mesh, const char* name, double until,
                              bool* in_contact) {
  std::vector<Vec2> uvs;
  stage(name, until, [&](StageStatistics& statistics, const Checkpoint& checkpoint) {
    const auto rest = rest_triangles(mesh.positions, mesh.faces, options_.threads);
    uvs = start_map(mesh, rest, checkpoint);
    checkpoint(0.02);
    if (!non_positive_faces(mesh.faces, uvs, options_.threads).empty()) return;
    scale_best(mesh, rest, uvs);
    start_flat(mesh, rest, uvs);
    NewtonOptions newton = newton_options();
    if (&mesh != &input_) newton.tolerance *= kCoarseTolerance;
    const bool simple = keeps_boundary_simple();
    NewtonResult done = descend(mesh, rest, newton, simple, uvs, statistics, checkpoint);
    if (done.energies.back() > kHopelessEnergy) {
      std::vector<Vec2> other = start_from_coarser(mesh, rest, checkpoint);
      if (!other.empty()) {
        StageStatistics second{name};
        const NewtonResult again = descend(mesh, rest, newton, simple, other, second, checkpoint);
        statistics.iterations += second.iterations;
        if (again.energies.back() < done.energies.back()) {
          uvs.swap(other);
          done = again;
        }
      }
    }
    result_.coarse_energy = done.energies.back();
    if (in_contact) *in_contact = done.in_contact;
    if (!done.converged) result_.status = BELTRAMI_NOT_CONVERGED;
  });
  return uvs;
}

/// Goes on with composite majorization on the fine mesh (the paper's hybrid). What it starts from
/// is kept if it cannot be improved; a map that is not injective is left alone.
void Run::refine(std::vector<Vec2>& uvs) {
  const Certificate certificate = certify(disk_->faces, disk_->boundary, uvs, options_.threads);
  if (certificate.orientations.first_bad_face != kNone) return;
  if (keeps_boundary_simple() && certificate.crossings.count > 0) return;
  stage("refine", 0.97, [&](StageStatistics& statistics, const Checkpoint& checkpoint) {
    const auto rest = rest_triangles(disk_->positions, disk_->faces, options_.threads);
    const auto scaled_energy = [&] {
      scale_best(*disk_, rest, uvs);
      return mean_energy(options_.energy, disk_->faces, rest, uvs);
    };
    const double before = scaled_energy();
    const std::vector<Vec2> start = uvs;
    NewtonOptions newton = newton_options();
    newton.proxy_steps = 0;  // they pay far from the minimum
    if (options_.refine_iterations > 0) newton.max_iterations = options_.refine_iterations;
    if (options_.time_limit > 0) {
      newton.out_of_time = [&] { return wall_seconds() - started_ > options_.time_limit; };
    }
    const NewtonResult done =
        descend(*disk_, rest, newton, keeps_boundary_simple(), uvs, statistics, checkpoint);
    // The barrier of the contact may have fallen instead.
    if (!(scaled_energy() <= before)) uvs = start;
    const bool limited = options_.refine_iterations > 0 || options_.time_limit > 0;
    if (!done.converged && !limited) result_.status = BELTRAMI_NOT_CONVERGED;
  });
}

std::vector<Vec2> Run::run_tutte() {
  std::vector<Vec2> uvs;
  stage("tutte", 0.9, [&](StageStatistics&, const Checkpoint& checkpoint) {
    uvs = tutte_embedding(input_);
    const auto rest = rest_triangles(input_.positions, input_.faces, options_.threads);
    const RepairOptions mend{.simple_boundary = true,
                             .threads = options_.threads,
                             .global_fix = affords(input_, options_, Extra::kGlobalFix)};
    result_.flips_before_repair = repair(input_, rest, uvs, mend, checkpoint).flips_before;
  });
  return uvs;
}

/// Whether the method's map must be injective; the others are judged as they are.
bool Run::promises() const {
  return options_.method == BELTRAMI_METHOD_BELTRAMI && options_.flatten != BELTRAMI_FLATTEN_BFF &&
         options_.flatten != BELTRAMI_FLATTEN_FLIM;
}

/// The method, and where its map, as it would be delivered, breaks its promise, or there is none,
/// again with coarser meshes (paper section 3.2), with the usual one if a coarser one was asked
/// for, and at last with embeddings of the fine mesh: Tutte's, then one that cannot fold. The best
/// map is kept.
Delivery Run::run_with_fallback() {
  std::optional<Delivery> best;
  std::int64_t fewest = std::numeric_limits<std::int64_t>::max();
  const auto attempt = [&](auto&& run) {
    disk_ = &input_;
    result_.status = BELTRAMI_OK;
    std::vector<Vec2> uvs;
    try {
      uvs = run();
      if (options_.refine) refine(uvs);
      const auto rest = rest_triangles(disk_->positions, disk_->faces, options_.threads);
      scale_best(*disk_, rest, uvs);
    } catch (const Error& error) {
      // GIF's only one asks for another method, with the reason.
      if (error.status() != BELTRAMI_E_SOLVER || options_.method == BELTRAMI_METHOD_GIF) throw;
      return false;
    }
    Delivery made = prepare(uvs);
    const std::int64_t broken = promises() ? broken_promises(made) : 0;
    if (broken >= fewest) return false;
    fewest = broken;
    best = std::move(made);
    return broken == 0;
  };
  bool kept = attempt([&] { return run_method(); });
  const Index asked_for = coarse_target(), usual = coarse_faces(input_.face_count(), {});
  for (const Index target : {kFallbacks[0], kFallbacks[1], usual}) {
    const bool coarser = target < asked_for, finer = target == usual && usual > asked_for;
    if (kept || !(coarser || finer) || options_.method != BELTRAMI_METHOD_BELTRAMI) continue;
    ++result_.restarts;
    coarse_target_ = target;
    kept = attempt([&] { return run_method(); });
  }
  for (const bool drawn : {false, true}) {
    if (kept) break;
    ++result_.restarts;
    kept = attempt([&] {
      result_.status = BELTRAMI_NOT_CONVERGED;
      return drawn ? grid_drawing(input_) : run_tutte();
    });
  }
  if (best->faces.empty()) {
    disk_ = &input_;
  } else if (disk_ == &input_ || best->faces != disk_->faces) {
    retriangulated_ = build_disk(input_.positions, best->faces);
    disk_ = &retriangulated_;
  }
  return *std::move(best);
}

std::vector<Vec2> Run::run_method() {
  switch (options_.method) {
    case BELTRAMI_METHOD_CM:
      result_.coarse_faces = input_.face_count();
      return run_cm(input_, "cm", 0.9);
    case BELTRAMI_METHOD_TUTTE:
      return run_tutte();
    case BELTRAMI_METHOD_GIF:
    case BELTRAMI_METHOD_BFF:
      return run_plain();
    case BELTRAMI_METHOD_UV_PROLONGATION:
      return run_uv_prolongation();
    default:
      return run_beltrami();
  }
}

Flattening Run::flatten() {
  const double cpu = cpu_seconds();
  deliver(run_with_fallback());
  result_.seconds = wall_seconds() - started_;
  result_.cpu_seconds = cpu_seconds() - cpu;
  result_.peak_memory_bytes = peak_memory_bytes();
  return std::move(result_);
}

Flattening flatten(const DiskMesh& disk, const Normalisation& frame, const Options& options,
                   const Progress& progress, const std::atomic<bool>& cancelled) {
  return Run(disk, frame, options, progress, cancelled).flatten();
}

}  // namespace beltrami
