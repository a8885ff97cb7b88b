#include "multilevel/composite_majorization.h"

#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "descend/newton.h"
#include "descend/tutte.h"
#include "energy/energy.h"
#include "exact/certificate.h"
#include "exact/crossings.h"
#include "linear/spd_solver.h"
#include "mesh/disk_mesh.h"
#include "mesh/rest_shape.h"
#include "multilevel/chart_map.h"
#include "multilevel/flat_map.h"
#include "multilevel/memory.h"
#include "multilevel/mode_bytes.h"
#include "multilevel/options.h"
#include "repair/touching.h"

namespace beltrami {
namespace {

/// Mean energy beyond which composite majorization has not got anywhere: it is 2 to 100 at minima.
/// Long slivers begin at 1e6 to 1e15, and hardly lose any in hundreds of steps.
constexpr double kHopelessEnergy = 1e3;

bool is_hopeless(const Descent& descent, const ChartOptions& options) {
  return !(to_dirichlet(options.energy, descent.energy) <= kHopelessEnergy);
}

/// From a map that is near its minimum; nothing where it cannot serve.
std::optional<Descent> minimise_from(const DiskMesh& mesh, const std::vector<Vec2>& start,
                                     const ChartOptions& options, const Work& work) {
  if (start.empty() || !non_positive_faces(mesh.faces, start, work).empty()) return std::nullopt;
  const auto rest = rest_triangles(mesh.positions, mesh.faces, work);
  NewtonOptions newton = newton_options(options);
  newton.proxy_steps = 0;
  Descent done = descend_led(mesh, rest, start, newton, work);
  const bool is_simple = !keeps_boundary_simple(options) ||
                         find_crossings(mesh.boundary, done.uvs).empty() ||
                         (options.parts_touching && open_touching_sides(mesh, work, done.uvs));
  if (!is_simple && find_crossings(mesh.boundary, start).empty()) {
    // Pressed on by itself it is no minimum without contact.
    done = descend(mesh, rest, start, newton, true, options, work);
  } else if (!is_simple) {
    return std::nullopt;
  }
  if (is_hopeless(done, options)) return std::nullopt;
  return done;
}

}  // namespace

double newton_bytes(const MeshCounts& n, int threads) {
  const double fields =
      5 * n.vertices * sizeof(Vec2) + n.faces * sizeof(double);  // and the weights of the faces
  return fields + system_bytes(n, 2, Precision::kDouble, threads).peak;
}

double cm_bytes(const MeshCounts& n, bool scaffold, int threads) {
  const double copies =
      scaffold ? n.faces * (sizeof(Triangle) + sizeof(RestTriangle)) + n.vertices * sizeof(Vec2)
               : 0;
  return n.faces * sizeof(RestTriangle) + n.vertices * sizeof(Vec2) + copies +
         newton_bytes(n, threads);
}

Descent minimise_from_scratch(const DiskMesh& mesh, double tolerance, const ChartOptions& options,
                              const Work& work) {
  const auto rest = rest_triangles(mesh.positions, mesh.faces, work);
  std::vector<Vec2> uvs = start_map(mesh, rest, options, work);
  work.report(0.02);
  scale_best(mesh, rest, options, work, uvs);
  if (start_flat(mesh, rest, options, uvs, work)) {
    const double energy = mean_energy(options.energy, mesh.faces, rest, uvs, work);
    return {.uvs = std::move(uvs), .energy = energy, .converged = true, .in_contact = true};
  }
  if (!non_positive_faces(mesh.faces, uvs, work).empty()) {
    return {.uvs = std::move(uvs), .converged = true};
  }
  NewtonOptions newton = newton_options(options);
  newton.tolerance = tolerance;
  newton.hopeless = kHopelessEnergy;
  const bool simple = keeps_boundary_simple(options);
  Descent first = descend(mesh, rest, std::move(uvs), newton, simple, options, work);
  if (!is_hopeless(first, options) || work.out_of_time()) return first;
  std::vector<Vec2> other = start_from_coarser(mesh, rest, options, work);
  std::optional<Descent> again;
  if (!other.empty()) {
    again = descend(mesh, rest, std::move(other), newton, simple, options, work);
    if (!is_hopeless(*again, options)) return *std::move(again);
  }
  // What comes from a coarser mesh presses on itself more often, where steps are shorter still.
  if (!first.converged && !work.out_of_time()) {
    newton.hopeless = std::numeric_limits<double>::infinity();
    newton.max_iterations -= first.iterations;
    const int before = first.iterations;
    first = descend(mesh, rest, std::move(first.uvs), newton, simple, options, work);
    first.iterations += before;
  }
  return again && again->energy < first.energy ? *std::move(again) : first;
}

ChartMap cm_mode(const DiskMesh& mesh, const char* name, const std::vector<Vec2>& start,
                 const ChartOptions& options, const Work& work) {
  ChartMap map;
  run_stage(name, work, map.statistics.stages, [&](StageStatistics& stage, const Work& inner) {
    std::optional<Descent> from_start = minimise_from(mesh, start, options, inner);
    Descent done = from_start ? *std::move(from_start)
                              : minimise_from_scratch(mesh, options.tolerance, options, inner);
    stage.iterations = done.iterations;
    map.uvs = std::move(done.uvs);
    map.converged = done.converged;
    map.in_contact = done.in_contact;
    map.statistics.coarse_energy = done.energy;
  });
  map.statistics.coarse_faces = mesh.face_count();
  return map;
}

}  // namespace beltrami
