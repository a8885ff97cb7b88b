#include "multilevel/map_problem.h"
#include "multilevel/composite_majorization.h"

#include <algorithm>
#include <utility>

#include "flatten/intrinsic_delaunay.h"
#include "multilevel/descent.h"
#include "multilevel/extras.h"
#include "multilevel/memory.h"
#include "multilevel/mode_bytes.h"
#include "multilevel/policy.h"
#include "repair/outliers.h"
#include "simplify/coarse.h"
#include "simplify/replay.h"
#include "simplify/simplify.h"

namespace beltrami {
namespace {

/// Times the tolerance, for the coarse mesh: steps are cheap there, and how a map spreads its
/// distortion over the whole is what polishing the fine one hardly changes.
constexpr double kCoarseTolerance = 0.1;
/// What a level has of the faces of the coarse mesh at least: a part of it is as coarse as that.
constexpr Index kLeastLevel = 2;
/// Bytes per fine vertex of the simplifier's surface and its candidates, measured.
constexpr double kSimplify = 225;

/// Flips the mesh to the intrinsic Delaunay triangulation of the metric.
void retriangulate(const Work& work, MapProblem& fine) {
  DelaunayTriangulation delaunay = intrinsic_delaunay(*fine.mesh, std::move(fine.cotangents), work);
  fine.statistics.delaunay_flips = delaunay.flips;
  fine.statistics.delaunay_refused = delaunay.refused;
  fine.retriangulated =
      std::make_unique<DiskMesh>(build_disk(fine.mesh->positions, std::move(delaunay.faces), work));
  fine.mesh = fine.retriangulated.get();
  fine.cotangents = std::move(delaunay.cotangents);
}

/// As if the simplifier kept the shares of vertices and boundary edges.
MeshCounts coarse_counts(const MeshCounts& n, std::int64_t asked) {
  const auto faces = static_cast<double>(coarse_faces(static_cast<Index>(n.faces), asked));
  const double share = faces / n.faces;
  return {share * n.vertices, share * n.faces, share * n.boundary, n.regular, n.metas};
}

}  // namespace

void simplify_fine(Index target, const std::optional<CoarseDisk>& level, const Work& work,
                   MapProblem& fine) {
  run_stage("simplify", work, fine.statistics.stages, [&](StageStatistics&, const Work& inner) {
    const bool goes_on = level && level->mesh.face_count() >= kLeastLevel * target;
    fine.coarse =
        goes_on ? simplify_further(*level, target, inner) : simplify(*fine.mesh, target, inner);
  });
}

void solve_coarse(const ChartOptions& options, const Work& work, MapProblem& fine) {
  const double tolerance = kCoarseTolerance * options.tolerance;
  run_stage("coarse", work, fine.statistics.stages, [&](StageStatistics& stage, const Work& inner) {
    ChartOptions coarse = options;
    coarse.parts_touching = false;
    Descent done = minimise_from_scratch(fine.coarse.mesh, tolerance, coarse, inner);
    stage.iterations = done.iterations;
    fine.coarse_uvs = std::move(done.uvs);
    fine.in_contact = done.in_contact;
    fine.converged = done.converged;
    fine.statistics.coarse_energy = done.energy;
  });
  fine.statistics.coarse_faces = fine.coarse.mesh.face_count();
}

void measure_fine(const char* name, bool harmonic, const ChartOptions& options, const Work& work,
                  MapProblem& fine) {
  run_stage(name, work, fine.statistics.stages, [&](StageStatistics&, const Work& inner) {
    const DiskMesh& coarse = fine.coarse.mesh;
    const auto coarse_rest = rest_triangles(coarse.positions, coarse.faces, inner);
    const auto coarse_metric = face_metrics(coarse.faces, coarse_rest, fine.coarse_uvs);
    const auto measure = [&] {
      fine.rest = rest_triangles(fine.mesh->positions, fine.mesh->faces, inner);
      if (coarse_metric.empty()) {
        fine.metric.assign(fine.mesh->faces.size(), FaceMetric{});
        return;
      }
      fine.metric = prolong_metric(coarse, coarse_metric, *fine.mesh, fine.coarse.nearby, inner);
    };
    measure();
    if (!harmonic && !options.delaunay) return;
    fine.cotangents = modified_cotangents(fine.rest, fine.metric, inner);
    if (!options.delaunay) return;
    retriangulate(inner, fine);
    measure();
  });
}

RepairOptions whole_repair(const MapProblem& fine, bool simple_boundary,
                           const ChartOptions& options, const Work& work) {
  return {.simple_boundary = simple_boundary,
          .global_fix = affords(*fine.mesh, options, Extra::kGlobalFix, work)};
}

bool mend(const MapProblem& fine, const RepairOptions& how, const ChartOptions& options,
          const Work& work, ChartMap& map) {
  ChartStatistics& all = map.statistics;
  bool positive = false;
  run_stage("repair", work, all.stages, [&](StageStatistics& stage, const Work& inner) {
    const RepairResult repaired = repair(*fine.mesh, fine.rest, map.uvs, how, inner);
    all.flips_before_repair = repaired.flips_before;
    all.kernel_fixes += repaired.kernel_fixes;
    all.patch_fixes += repaired.patch_fixes;
    all.global_fixes += repaired.global_fixes;
    stage.iterations =
        static_cast<int>(repaired.kernel_fixes + repaired.patch_fixes + repaired.global_fixes);
    positive = repaired.flips_after == 0;
    if (positive) {
      all.cleaned_patches +=
          clean_outliers(options.energy, *fine.mesh, fine.rest, map.uvs, {}, inner.part(1, 1));
    }
  });
  return positive;
}

ChartMap joined(MapProblem fine, ChartMap map) {
  fine.statistics.append(map.statistics);
  map.statistics = std::move(fine.statistics);
  map.converged = map.converged && fine.converged;
  map.retriangulated = std::move(fine.retriangulated);
  return map;
}

double fine_bytes(const MeshCounts& n) {
  return n.faces * (sizeof(RestTriangle) + sizeof(FaceMetric)) +
         n.vertices * (sizeof(Index) + sizeof(Vec2));
}

double coarse_bytes(const MeshCounts& n, std::int64_t asked, int threads) {
  const MeshCounts coarse = coarse_counts(n, asked);
  const double nearby = n.vertices * sizeof(Index);
  return std::max(n.vertices * kSimplify,
                  nearby + disk_bytes(coarse) + cm_bytes(coarse, true, threads));
}

}  // namespace beltrami
