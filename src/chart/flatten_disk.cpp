#include "chart/flatten_disk.h"

#include <utility>

#include "base/resources.h"
#include "chart/attempts.h"
#include "chart/delivery.h"
#include "multilevel/chart_map.h"

namespace beltrami {
namespace {

constexpr double kTried = 0.99;  // share of the progress

}  // namespace

Flattening flatten(const DiskMesh& disk, const Normalisation& frame, const Inherited& inherited,
                   const ChartOptions& options, const Work& work) {
  const double wall = wall_seconds(), cpu = cpu_seconds();
  Attempts tried = try_all(disk, frame, inherited, options, work.part(0, kTried));
  ChartMap& map = tried.best.map;
  Flattening result =
      deliver(map.retriangulated ? *map.retriangulated : disk, frame,
              std::move(tried.best.delivery), map.converged, options, work.part(kTried, 1));
  map.statistics.append(result.statistics);
  result.statistics = std::move(map.statistics);
  if (map.retriangulated) result.faces = std::move(map.retriangulated->faces);
  result.restarts = tried.restarts;
  result.seconds = wall_seconds() - wall;
  result.cpu_seconds = cpu_seconds() - cpu;
  result.peak_memory_bytes = peak_memory_bytes();
  return result;
}

Flattening flatten(const DiskMesh& disk, const Normalisation& frame, const ChartOptions& options,
                   const Work& work) {
  return flatten(disk, frame, {}, options, work);
}

}  // namespace beltrami
