#include "chart/attempts.h"

#include <optional>
#include <utility>

#include "base/error.h"
#include "base/resources.h"
#include "base/types.h"
#include "baselines/baselines.h"
#include "chart/beltrami_mode.h"
#include "chart/refine.h"
#include "descend/grid_drawing.h"
#include "mesh/rest_shape.h"
#include "multilevel/descent.h"
#include "multilevel/extras.h"
#include "multilevel/modes.h"
#include "multilevel/policy.h"

namespace beltrami {
namespace {

// Shares of the progress: of the method, and where it is refined, which takes most of the time.
constexpr double kMethod = 0.98, kMethodToRefine = 0.3;

ChartMap run_method(const DiskMesh& mesh, Index coarse, const Inherited& inherited,
                    const ChartOptions& options, const Work& work) {
  switch (options.method) {
    case Method::kCm:
      return cm_mode(mesh, "cm", {}, options, work);
    case Method::kTutte:
      return tutte_mode(mesh, options, work);
    case Method::kGif:
    case Method::kBff:
      return plain_mode(mesh, options, work);
    case Method::kUvProlongation:
      return uv_prolongation_mode(mesh, coarse, options, work);
    default:
      return beltrami_mode(mesh, coarse, inherited, options, work);
  }
}

/// Coarse faces to try the method with again where `asked_for` broke its promise.
std::vector<Index> other_coarse_faces(const DiskMesh& mesh, Index asked_for) {
  const Index usual = coarse_faces(mesh.face_count(), 0);
  std::vector<Index> others;
  for (const Index target : {kFallbacks[0], kFallbacks[1], usual}) {
    const bool coarser = target < asked_for, finer = target == usual && usual > asked_for;
    if (coarser || finer) others.push_back(target);
  }
  return others;
}

/// The embeddings, which are far from any minimum.
std::vector<Way> embeddings(const DiskMesh& mesh, const ChartOptions& options) {
  const auto tutte = [&](const Work& work) {
    ChartMap map = tutte_mode(mesh, options, work);
    map.converged = false;
    return map;
  };
  const auto drawing = [&](const Work&) {
    ChartMap map;
    map.uvs = grid_drawing(mesh);
    map.converged = false;
    return map;
  };
  return {{tutte}, {drawing}};
}

}  // namespace

JudgedMap attempt(const DiskMesh& mesh, const Normalisation& frame, const Way& way,
                  const ChartOptions& options, const Work& work) {
  const double method_done = options.refine ? kMethodToRefine : kMethod;
  JudgedMap made;
  made.map = way.run(work.part(0, method_done));
  const DiskMesh& disk = made.map.retriangulated ? *made.map.retriangulated : mesh;
  if (options.refine) refine(disk, options, work.part(method_done, kMethod), made.map);
  {
    const auto rest = rest_triangles(disk.positions, disk.faces, work);
    scale_best(disk, rest, options, work, made.map.uvs);
  }
  made.delivery = prepare(disk, frame, made.map.uvs, options, work.part(kMethod, 1),
                          made.map.statistics.stages);
  made.map.uvs = {};
  made.broken = promises(options) ? broken_promises(made.delivery, frame, options, work) : 0;
  return made;
}

Attempts try_in_turn(const DiskMesh& mesh, const Normalisation& frame, const std::vector<Way>& ways,
                     const ChartOptions& options, const Work& work) {
  std::optional<JudgedMap> best;
  std::optional<Error> failure;
  StageStatistics of_best{"given-up"}, lost = of_best;
  const auto add = [](StageStatistics& sum, const StageStatistics& spent) {
    sum.seconds += spent.seconds;
    sum.cpu_seconds += spent.cpu_seconds;
  };
  int tried = 0;
  for (const Way& way : ways) {
    if (best && best->broken == 0) break;
    if (tried > 0 && way.needs_time && work.out_of_time()) continue;
    ++tried;
    StageStatistics spent{"given-up", 0, wall_seconds(), cpu_seconds()};
    std::optional<JudgedMap> made;
    try {
      made = attempt(mesh, frame, way, options, work);
    } catch (const Error& error) {
      if (error.fault() != Fault::kSolver) throw;
      failure = error;
    }
    spent.seconds = wall_seconds() - spent.seconds;
    spent.cpu_seconds = cpu_seconds() - spent.cpu_seconds;
    const bool better = made && (!best || made->broken < best->broken);
    if (better) {
      best = std::move(made);
      std::swap(spent, of_best);
    }
    add(lost, spent);
  }
  if (!best) throw Error(*failure);
  if (tried > 1) {
    auto& stages = best->map.statistics.stages;
    stages.insert(stages.begin(), lost);
  }
  return {*std::move(best), tried - 1};
}

Attempts try_all(const DiskMesh& mesh, const Normalisation& frame, const Inherited& inherited,
                 const ChartOptions& options, const Work& work) {
  const auto method = [&](Index coarse) {
    return [&, coarse](const Work& share) {
      return run_method(mesh, coarse, inherited, options, share);
    };
  };
  const Index asked_for = coarse_faces(mesh.face_count(), options.coarse_faces);
  std::vector<Way> ways = {{method(asked_for)}};
  if (options.method == Method::kGif) return try_in_turn(mesh, frame, ways, options, work);
  const bool in_levels =
      options.method == Method::kBeltrami && has_levels(mesh.face_count(), asked_for, options);
  const bool can_climb_anew =
      !options.may_be_split && affords(mesh, options, Extra::kWholeFactor, work);
  if (in_levels && !can_climb_anew) return try_in_turn(mesh, frame, ways, options, work);
  if (options.method == Method::kBeltrami) {
    for (const Index other : other_coarse_faces(mesh, asked_for)) {
      ways.push_back({method(other), true});
    }
  }
  for (Way& way : embeddings(mesh, options)) ways.push_back(std::move(way));
  return try_in_turn(mesh, frame, ways, options, work);
}

}  // namespace beltrami
