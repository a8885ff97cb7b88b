#include "chart/descent.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "base/parallel.h"
#include "base/types.h"
#include "chart/coarser_start.h"
#include "descend/contact.h"
#include "descend/tutte.h"
#include "energy/energy.h"
#include "mesh/boundary.h"
#include "repair/touching.h"

namespace beltrami {
namespace {

constexpr double kLeadTolerance = 1e-3;  // of the energy that leads to the one asked for
/// Of a mesh with contact: from so many faces on, and where the last map without crossings has so
/// much more energy than the free minimum, it starts from a coarser mesh.
constexpr Index kContactFaces = 3000;
constexpr double kFarStart = 1.1;
/// Scales nearer to each other than that differ by 1e-11 of the energy: not worth a rounding.
constexpr double kSameScale = 1e-6;
constexpr std::int64_t kGrain = 16384;

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
          led.newton.converged, false};
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

}  // namespace beltrami
