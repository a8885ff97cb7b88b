#include "multilevel/descent.h"
#include "multilevel/policy.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "base/error.h"
#include "base/parallel.h"
#include "base/types.h"
#include "descend/contact.h"
#include "descend/grid_drawing.h"
#include "descend/newton.h"
#include "descend/tutte.h"
#include "energy/energy.h"
#include "exact/certificate.h"
#include "exact/crossings.h"
#include "flatten/dirichlet.h"
#include "flatten/laplacian.h"
#include "flatten/metric.h"
#include "linear/spd_solver.h"
#include "mesh/boundary.h"
#include "multilevel/anchors.h"
#include "multilevel/extras.h"
#include "prolong/prolongation.h"
#include "repair/outliers.h"
#include "repair/repair.h"
#include "repair/touching.h"
#include "simplify/coarse.h"
#include "simplify/simplify.h"

namespace beltrami {
namespace {

constexpr double kLeadTolerance = 1e-3;  // of a minimum that only leads to another one
/// Of a mesh with contact: where the last map without crossings has so much more energy than the
/// free minimum, it starts from a coarser mesh.
constexpr double kFarStart = 1.1;
/// Scales nearer to each other than that differ by 1e-11 of the energy: not worth a rounding.
constexpr double kSameScale = 1e-6;
constexpr std::int64_t kGrain = 16384;
constexpr Index kFewestFaces = 20;
/// With a tenth of the faces the boundary crosses itself too often when it is carried over.
constexpr Index kContactReduction = 4;
/// Of the patches of a trial and of a start that there are others for: what these do not mend takes
/// seconds with wider ones, half a minute where a hundred faces are folded.
constexpr int kNarrowRings = 2;

struct Led {
  NewtonResult newton;  ///< of the energy asked for
  int iterations = 0;   ///< those that led to it included
};

/// Far from the minimum the symmetric Dirichlet energy leads the way: it is smooth, grows slowly,
/// and its minimum is near that of the others (symmetric ARAP alone takes 1.5 times the steps).
Led descend_with_lead(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                      NewtonOptions newton, const Work& work, std::vector<Vec2>& uvs) {
  const std::vector<bool> fixed = only_first_of_boundary(mesh);
  int lead_steps = 0;
  NewtonResult led;
  if (newton.proxy_steps > 0 && newton.energy != Energy::kSymmetricDirichlet) {
    NewtonOptions lead = newton;
    lead.energy = Energy::kSymmetricDirichlet;
    lead.tolerance = std::max(lead.tolerance, kLeadTolerance);
    led = minimise_energy(mesh.faces, rest, fixed, uvs, lead, work);
    lead_steps = led.iterations();
    newton.max_iterations -= lead_steps;
    newton.proxy_steps = 0;
  }
  NewtonResult done = minimise_energy(mesh.faces, rest, fixed, uvs, newton, work);
  if (done.refused && done.admitted.empty()) done.admitted.swap(led.admitted);
  const int iterations = lead_steps + done.iterations();
  return {std::move(done), iterations};
}

Descent ended(const Led& led, int iterations_before, std::vector<Vec2> uvs) {
  return {std::move(uvs), led.newton.energies.back(), iterations_before + led.iterations,
          !led.newton.is_cut_short, false};
}

/// The minimum on a coarser mesh, as the start of that on a finer one.
struct CoarserMinimum {
  CoarseDisk coarse;
  std::vector<Vec2> uvs;           ///< of the coarse mesh
  std::vector<FaceMetric> metric;  ///< of the finer one
};

/// A map of the finer mesh at the vertices of the coarse one, mended. Returns whether all faces are
/// positive.
bool restrict_map(const std::vector<Vec2>& fine_uvs, const CoarseDisk& coarse,
                  const std::vector<RestTriangle>& rest, const Work& work, std::vector<Vec2>& uvs) {
  uvs.clear();
  for (const Index v : coarse.fine_vertex) uvs.push_back(fine_uvs[v]);
  const RepairOptions mend{.global_fix = false};
  return repair(coarse.mesh, rest, uvs, mend, work).flips_after == 0;
}

/// The minimum on a mesh of `target` faces, and its metric on the finer one; with contact from
/// `start`, a map of the finer one, where that serves, else from a start of its own. Nothing where
/// there is no coarser mesh, or no start on it.
std::optional<CoarserMinimum> minimise_coarser(const DiskMesh& mesh, Index target, bool simple,
                                               double tolerance, const std::vector<Vec2>* start,
                                               const ChartOptions& options, const Work& work) {
  CoarserMinimum minimum{simplify(mesh, target, work), {}, {}};
  const DiskMesh& coarse = minimum.coarse.mesh;
  if (coarse.face_count() > kLeastReduction * mesh.face_count()) return std::nullopt;
  const auto rest = rest_triangles(coarse.positions, coarse.faces, work);
  NewtonOptions newton = newton_options(options);
  newton.tolerance = std::max(newton.tolerance, tolerance);
  const std::vector<double> lengths = boundary_lengths(coarse);
  const BoundaryContact contact(coarse.boundary, lengths, lengths);
  std::vector<Vec2> uvs;
  if (start && restrict_map(*start, minimum.coarse, rest, work, uvs) && contact.is_simple(uvs)) {
    newton.contact = &contact;
    minimum.uvs = descend_led(coarse, rest, std::move(uvs), newton, work).uvs;
  } else {
    uvs = start_map(coarse, rest, options, work);
    if (!non_positive_faces(coarse.faces, uvs, work).empty()) return std::nullopt;
    scale_best(coarse, rest, options, work, uvs);
    minimum.uvs = descend(coarse, rest, std::move(uvs), newton, simple, options, work).uvs;
  }
  minimum.metric = prolong_metric(coarse, face_metrics(coarse.faces, rest, minimum.uvs), mesh,
                                  minimum.coarse.nearby, work);
  return minimum;
}

/// The minimum with contact of a mesh of a quarter of the faces, from the map `start` of this one,
/// carried over: steps with contact are many, and cheap there. Empty where it is not injective
/// here.
std::vector<Vec2> contact_from_coarser(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                                       const std::vector<Vec2>& start, const ChartOptions& options,
                                       const Work& work) {
  const Work still = work.part(0.5, 0.5);
  const auto minimum = minimise_coarser(mesh, mesh.face_count() / kContactReduction, true,
                                        kLeadTolerance, &start, options, still);
  if (!minimum) return {};
  const std::vector<Vec2> carried = carry_boundary(mesh, minimum->coarse, minimum->uvs);
  const auto stiffness = energy_stiffness(options.energy, rest, minimum->metric, work);
  std::vector<bool> anchored =
      vertices_in_contact(minimum->coarse, minimum->uvs, mesh.vertex_count());
  std::unique_ptr<MetricLaplacian> laplacian;
  std::vector<Vec2> uvs;
  const auto solve = [&] {
    still.report(0);
    const Anchors anchors{stiff_springs(mesh, stiffness, anchored), carried};
    if (laplacian) {
      laplacian->refit(stiffness, anchors.springs);
    } else {
      laplacian = std::make_unique<MetricLaplacian>(mesh, stiffness, only_first_of_boundary(mesh),
                                                    SolverOptions{.precision = Precision::kSingle},
                                                    anchors.springs, still);
    }
    uvs = carried;
    solve_metric(mesh, rest, minimum->metric, stiffness, *laplacian, anchors, false, uvs, work);
    put_in_place(anchored, carried, uvs);
    RepairOptions mend{.global_fix = false};
    if (options.is_trial) mend.most_rings = kNarrowRings;
    return repair(mesh, rest, uvs, mend, still).flips_after == 0;
  };
  try {
    if (!solve_until_simple(mesh, uvs, anchored, solve)) return {};
  } catch (const Error&) {  // the solver's: there is another start
    return {};
  }
  clean_outliers(options.energy, mesh, rest, uvs, {}, still);
  return uvs;
}

/// Takes the minimum with contact of a coarser mesh instead of `uvs` where that has less energy.
void start_nearer(const DiskMesh& mesh, const std::vector<RestTriangle>& rest, double free_energy,
                  const ChartOptions& options, const Work& work, std::vector<Vec2>& uvs) {
  if (mesh.face_count() < kContactFaces || work.out_of_time()) return;
  const auto energy = [&](const std::vector<Vec2>& map) {
    return to_dirichlet(options.energy, mean_energy(options.energy, mesh.faces, rest, map, work));
  };
  if (!(energy(uvs) > kFarStart * to_dirichlet(options.energy, free_energy))) return;
  std::vector<Vec2> start = contact_from_coarser(mesh, rest, uvs, options, work);
  if (!start.empty() && energy(start) < energy(uvs)) uvs.swap(start);
}

}  // namespace

NewtonOptions newton_options(const ChartOptions& options) {
  NewtonOptions newton;
  newton.energy = options.energy;
  newton.tolerance = options.tolerance;
  newton.max_iterations = options.max_iterations;
  return newton;
}

void scale_best(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                const ChartOptions& options, const Work& work, std::vector<Vec2>& uvs) {
  const double scale = best_scale(options.energy, mesh.faces, rest, uvs, work);
  if (std::abs(scale - 1) < kSameScale) return;
  parallel_for(work, size_of(uvs), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t v = begin; v < end; ++v) uvs[v] *= scale;
  });
}

Descent descend_led(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                    std::vector<Vec2> start, const NewtonOptions& newton, const Work& work) {
  const Led done = descend_with_lead(mesh, rest, newton, work, start);
  return ended(done, 0, std::move(start));
}

Descent descend(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                std::vector<Vec2> start, NewtonOptions newton, bool simple,
                const ChartOptions& options, const Work& work) {
  std::vector<Vec2> uvs = std::move(start);
  if (!simple) return descend_led(mesh, rest, std::move(uvs), newton, work);
  int iterations = 0;
  const std::vector<double> lengths = boundary_lengths(mesh);
  const BoundaryContact contact(mesh.boundary, lengths, lengths);
  if (!contact.is_pressed(uvs) || !contact.is_simple(uvs)) {
    newton.admissible = [&](const std::vector<Vec2>& map) { return contact.is_simple(map); };
    Led free = descend_with_lead(mesh, rest, newton, work, uvs);
    const bool is_refused = free.newton.refused && !free.newton.admitted.empty();
    if (!is_refused || (options.parts_touching && open_touching_sides(mesh, work, uvs))) {
      return ended(free, 0, std::move(uvs));
    }
    iterations = free.iterations;
    newton.admissible = nullptr;
    newton.max_iterations -= free.newton.iterations();
    uvs.swap(free.newton.admitted);
    if (free.newton.is_hopeless) return ended(free, 0, std::move(uvs));
    start_nearer(mesh, rest, free.newton.energies.back(), options, work, uvs);
  }
  newton.contact = &contact;
  newton.tolerance = std::max(newton.tolerance, options.tolerance);
  const Led pressed = descend_with_lead(mesh, rest, newton, work, uvs);
  scale_best(mesh, rest, options, work, uvs);  // without the barrier, which presses outwards
  Descent done = ended(pressed, iterations, std::move(uvs));
  done.in_contact = contact.is_pressed(done.uvs);
  return done;
}

std::vector<Vec2> start_from_coarser(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                                     const ChartOptions& options, const Work& work) {
  const bool simple = keeps_boundary_simple(options);
  const Work still = work.part(0.05, 0.05);
  Index last = mesh.face_count();
  for (const Index target : {mesh.face_count() / 10, kFallbacks[0], kFallbacks[1]}) {
    if (target >= last || target < kFewestFaces) continue;
    last = target;
    still.report(0);
    const auto minimum = minimise_coarser(mesh, target, simple, 0, nullptr, options, still);
    if (!minimum) continue;
    std::vector<Vec2> uvs = carry_boundary(mesh, minimum->coarse, minimum->uvs);
    solve_harmonic(mesh, modified_cotangents(rest, minimum->metric, work), uvs, work);
    const RepairOptions mend{.simple_boundary = simple,
                             .most_rings = kNarrowRings,
                             .global_fix = affords(mesh, options, Extra::kGlobalFix, work)};
    if (repair(mesh, rest, uvs, mend, still).flips_after > 0) continue;
    if (simple && count_crossings(mesh.boundary, uvs).count > 0) continue;
    clean_outliers(options.energy, mesh, rest, uvs, {}, still);
    return uvs;
  }
  return {};
}

std::vector<Vec2> start_map(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                            const ChartOptions& options, const Work& work) {
  std::vector<Vec2> uvs = tutte_embedding(mesh, work);
  RepairOptions mend{.global_fix = affords(mesh, options, Extra::kGlobalFix, work)};
  if (options.is_trial) mend.most_rings = kNarrowRings;
  if (repair(mesh, rest, uvs, mend, work.part(0, 0)).flips_after == 0) return uvs;
  std::vector<Vec2> other = start_from_coarser(mesh, rest, options, work);
  return other.empty() ? grid_drawing(mesh) : other;
}

}  // namespace beltrami
