#include "chart/coarser_start.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "base/error.h"
#include "chart/anchors.h"
#include "chart/descent.h"
#include "chart/memory_estimate.h"
#include "chart/starts.h"
#include "descend/contact.h"
#include "descend/newton.h"
#include "exact/certificate.h"
#include "exact/crossings.h"
#include "flatten/dirichlet.h"
#include "flatten/laplacian.h"
#include "flatten/metric.h"
#include "linear/spd_solver.h"
#include "mesh/boundary.h"
#include "prolong/prolongation.h"
#include "repair/outliers.h"
#include "repair/repair.h"
#include "simplify/simplify.h"

namespace beltrami {
namespace {

constexpr double kLeadTolerance = 1e-3;  // of a minimum that another one starts from
constexpr Index kFewestFaces = 20;
/// With a tenth of the faces the boundary crosses itself too often when it is carried over.
constexpr Index kContactReduction = 4;
/// Of a trial's patches: what these do not mend takes seconds with wider ones.
constexpr int kTrialRings = 2;

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

}  // namespace

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
                             .global_fix = affords(mesh, options, Extra::kGlobalFix, work)};
    if (repair(mesh, rest, uvs, mend, still).flips_after > 0) continue;
    if (simple && count_crossings(mesh.boundary, uvs).count > 0) continue;
    clean_outliers(options.energy, mesh, rest, uvs, {}, still);
    return uvs;
  }
  return {};
}

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
    if (options.is_trial) mend.most_rings = kTrialRings;
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

}  // namespace beltrami
