#include "multilevel/level.h"

#include <utility>

#include "base/parallel.h"
#include "base/types.h"
#include "exact/certificate.h"
#include "flatten/carried_target.h"
#include "flatten/dirichlet.h"
#include "local/regions.h"
#include "mesh/boundary.h"
#include "mesh/rest_shape.h"
#include "multilevel/anchors.h"
#include "prolong/derivative.h"
#include "prolong/interpolation.h"

namespace beltrami {
namespace {

constexpr int kLeastSteps = 2;    // of conjugate gradients from an interpolated map
constexpr int kManySteps = 6;     // while more than few of the faces are flipped
constexpr int kMostSteps = 14;    // while with each
constexpr double kFalling = 0.9;  // times as many flips are left, or less

/// The map of the coarse level at the footpoints.
std::vector<Vec2> carried_map(const Level& level, const std::vector<Footpoint>& points,
                              const Work& work) {
  return carried(level.from, level.coarse.mesh.faces, points, work);
}

std::vector<VertexDerivative> carried_derivatives(const DiskMesh& coarse,
                                                  const std::vector<Vec2>& uvs,
                                                  const std::vector<Footpoint>& points,
                                                  const Work& work) {
  const auto rest = rest_triangles(coarse.positions, coarse.faces, work);
  return carried(vertex_derivatives(coarse, rest, uvs, work), coarse.faces, points, work);
}

/// What the carried map is to become.
TargetEquations target_of(const Level& level, const std::vector<Footpoint>& points, Energy energy,
                          const Work& work) {
  std::vector<Vec2> start = carried_map(level, points, work);
  std::vector<VertexDerivative> derivatives =
      carried_derivatives(level.coarse.mesh, level.from, points, work);
  TargetEquations equations =
      target_equations(energy, *level.problem.mesh, level.problem.rest, derivatives, start, work);
  parallel_free(work, derivatives);
  parallel_free(work, start);
  return equations;
}

}  // namespace

void take_aim(Energy energy, const Work& work, VCycle& cycle, Level& level) {
  TargetEquations equations = target_of(level, cycle.points(), energy, work);
  level.residual = std::move(equations.residual);
  cycle.set(equations.weights, {});
  parallel_free(work, equations.weights);
}

Level prepare_level(const DiskMesh& mesh, const CoarseDisk& coarse, const std::vector<Vec2>& from,
                    double energy_below, Energy energy, const Work& work, VCycle& cycle,
                    ChartStatistics& statistics) {
  cycle.settle();
  Level level{
      .problem = {.mesh = &mesh},
      .coarse = coarse,
      .from = from,
      .residual = {},
      .contact = {mesh.boundary, boundary_lengths(mesh), coarse_boundary_lengths(mesh, coarse)}};
  run_stage("prolong", work, statistics.stages, [&](StageStatistics&, const Work& inner) {
    level.problem.rest = rest_triangles(mesh.positions, mesh.faces, inner);
    level.problem.statistics.coarse_energy = energy_below;
    std::vector<Footpoint> points =
        footpoints(coarse.mesh, coarse.fine_vertex, coarse.nearby, mesh, inner);
    inner.report(0.5);
    cycle.add(mesh, std::move(points));
    take_aim(energy, inner, cycle, level);
  });
  return level;
}

std::size_t solve_level(const Level& level, const std::vector<bool>& anchored, const Work& work,
                        VCycle& cycle, ChartMap& map) {
  std::size_t flips = 0;
  const DiskMesh& mesh = *level.problem.mesh;
  run_stage("flatten", work, map.statistics.stages, [&](StageStatistics&, const Work& inner) {
    if (!anchored.empty()) cycle.anchor(anchored);
    map.uvs = carried_map(level, cycle.points(), inner);
    SingleField residual;
    parallel_copy(inner, level.residual, residual);
    const auto flips_of = [&](const std::vector<Vec2>& uvs) {
      return non_positive_faces(mesh.faces, uvs, inner).size();
    };
    bool counted = false;
    const auto at_most = [&](double share) {
      return static_cast<double>(flips) <= share * mesh.face_count();
    };
    cycle.improve(
        kMostSteps,
        [&](int step) {
          if (step < kLeastSteps) return false;
          const auto before = static_cast<double>(std::exchange(flips, flips_of(map.uvs)));
          counted = true;
          if (at_most(kFewFlips)) return true;
          return step >= kManySteps && static_cast<double>(flips) > kFalling * before;
        },
        residual, map.uvs);
    if (!anchored.empty()) {
      put_in_place(anchored, carried_map(level, cycle.points(), inner), map.uvs);
      counted = false;
    }
    if (!counted) flips = flips_of(map.uvs);  // it may end before it asks
    if (at_most(kFewFlips)) return;
    std::vector<Vec2> start = carried_map(level, cycle.points(), inner);
    const std::size_t of_carried = flips_of(start);
    if (of_carried >= flips) return;
    flips = of_carried;
    map.uvs = std::move(start);
  });
  return flips;
}

bool mend_level(const Level& level, const RepairOptions& how, const ChartOptions& options,
                const Work& work, ChartMap& map) {
  const DiskMesh& mesh = *level.problem.mesh;
  const std::vector<Index> flipped = non_positive_faces(mesh.faces, map.uvs, work);
  if (!mend(level.problem, how, options, work, map)) return false;
  if (flipped.empty()) return true;
  run_stage("repair", work, map.statistics.stages, [&](StageStatistics&, const Work& inner) {
    map.statistics.cleaned_patches += relax_regions(options.energy, mesh, level.problem.rest,
                                                    map.uvs, flipped, kRegionRings, inner);
  });
  return true;
}

}  // namespace beltrami
