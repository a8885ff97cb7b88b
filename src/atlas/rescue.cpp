#include "atlas/rescue.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

#include "atlas/chart_parts.h"
#include "atlas/measure.h"
#include "atlas/types.h"
#include "base/interrupt.h"
#include "base/types.h"
#include "base/vectors.h"
#include "chart/flattening.h"
#include "cut/edge_marks.h"
#include "cut/open_minimal.h"
#include "mesh/chart.h"
#include "mesh/disk_mesh.h"

namespace beltrami {
namespace {

/// A mean energy above that is of no use to anybody: lengths are off by more than four times in the
/// mean. What a few cuts leave of ordinary surfaces is below 3.
constexpr double kBeyondReason = 10;
/// The same where the search had a target, which it missed by far then: it finds no cut in a few
/// triangles that wind around a vertex, whose map presses them together. Of 540 files none has such
/// a chart; of three that do, all reach their target once it is split.
constexpr double kMissedByFar = 3;

constexpr double kFar = std::numeric_limits<double>::infinity();

/// Per face its distance from one, over the centres of the edges; what may not be parted is one.
std::vector<double> distances_from(const DiskMesh& mesh, const EdgeMarks& locked, Index from) {
  const auto centre = [&](Index f) -> Vec3 {
    const auto [i, j, k] = mesh.faces[f];
    return (mesh.positions[i] + mesh.positions[j] + mesh.positions[k]) / 3;
  };
  std::vector<double> distance(mesh.faces.size(), kFar);
  using Entry = std::pair<double, Index>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
  distance[from] = 0;
  front.emplace(0, from);
  PollSometimes poll;
  while (!front.empty()) {
    poll();
    const auto [at, face] = front.top();
    front.pop();
    if (at > distance[face]) continue;
    for (Index h = 3 * face; h < 3 * face + 3; ++h) {
      if (mesh.twin[h] == kNone) continue;
      const Index other = mesh.twin[h] / 3;
      const double way =
          at + (!locked.empty() && locked[h] ? 0 : (centre(other) - centre(face)).norm());
      if (!(way < distance[other])) continue;
      distance[other] = way;
      front.emplace(way, other);
    }
  }
  return distance;
}

Index farthest(const std::vector<double>& distance) {
  return static_cast<Index>(std::max_element(distance.begin(), distance.end()) - distance.begin());
}

/// The edges of a chart inside polygons.
EdgeMarks locked_in(const Admitted& admitted, const PolygonParts& polygons,
                    const AtlasChart& chart) {
  if (polygons.polygon.empty()) return {};
  const DiskMesh& mesh = chart.chart.mesh;
  EdgeMarks locked(mesh.twin.size(), false);
  for (Index h = 0; h < 3 * chart.real_faces; ++h) {
    const Index twin = mesh.twin[h];
    if (twin == kNone || twin / 3 >= chart.real_faces) continue;
    locked[h] = is_inside_polygon(admitted, polygons, chart.on_surface(h), chart.on_surface(twin));
  }
  return locked;
}

/// Marks that part the faces which are nearer to one end of the chart from those nearer to the
/// other. Without regard to polygons where that parts nothing.
EdgeMarks marks_between_halves(const DiskMesh& mesh, const EdgeMarks& locked, const Work& work) {
  const std::vector<double> somewhere = distances_from(mesh, locked, 0);
  const Index one = farthest(somewhere);
  const std::vector<double> from_one = distances_from(mesh, locked, one);
  const Index other = farthest(from_one);
  const std::vector<double> from_other = distances_from(mesh, locked, other);
  const auto is_near_one = [&](Index f) { return from_one[f] < from_other[f]; };
  EdgeMarks marks(mesh.twin.size(), false);
  bool is_any = false;
  for (Index h = 0; h < size_of(mesh.twin); ++h) {
    const Index twin = mesh.twin[h];
    if (twin == kNone || is_near_one(h / 3) == is_near_one(twin / 3)) continue;
    marks[h] = is_any = true;
  }
  if (is_any) return opened_further(mesh, std::move(marks), locked, work);
  if (!locked.empty()) return marks_between_halves(mesh, {}, work);
  for (Index h = 0; h < size_of(mesh.twin); ++h) marks[h] = mesh.twin[h] != kNone;
  return marks;
}

/// What some charts are split into, with the maps that they had.
struct Halves {
  std::vector<bool> goes;  // per chart
  std::vector<AtlasChart> charts = {};
  std::vector<MappedChart> maps = {};
};

/// Whether a marked edge is locked, as it is where there was no other way.
bool divide_locked(const EdgeMarks& marks, const EdgeMarks& locked) {
  for (std::size_t h = 0; h < locked.size(); ++h) {
    if (marks[h] && locked[h]) return true;
  }
  return false;
}

/// Splits the charts `which`. `whole`: charts that only a seam inside a polygon would split are
/// left out.
Halves halves_of(const Admitted& admitted, const PolygonParts& polygons,
                 const std::vector<Index>& which, const std::vector<AtlasChart>& charts,
                 const std::vector<MappedChart>& maps, const Work& work, bool whole = false) {
  Halves halves{std::vector<bool>(charts.size(), false)};
  for (const Index c : which) {
    if (charts[c].real_faces < 2) continue;
    const EdgeMarks locked = locked_in(admitted, polygons, charts[c]);
    const EdgeMarks marks = marks_between_halves(charts[c].chart.mesh, locked, work);
    if (whole && divide_locked(marks, locked)) continue;
    std::vector<ChartPart> own = parts_along(charts[c], maps[c], marks, work);
    halves.goes[c] = !own.empty();
    for (ChartPart& part : own) {
      halves.charts.push_back(std::move(part.chart));
      halves.maps.push_back(std::move(part.map));
    }
  }
  return halves;
}

/// Puts halves in the place of the charts that they are of.
void replace(const Admitted& admitted, Halves halves, std::vector<AtlasChart>& charts,
             std::vector<MappedChart>& maps) {
  for (std::size_t c = 0; c < charts.size(); ++c) {
    if (halves.goes[c]) continue;
    halves.charts.push_back(std::move(charts[c]));
    halves.maps.push_back(std::move(maps[c]));
  }
  charts = std::move(halves.charts);
  maps = std::move(halves.maps);
  sort_by_first_face(admitted, charts, maps);
}

bool is_sound(const MappedChart& map) {
  return !map.error && map.outcome <= Outcome::kNotConverged;
}

/// Of each chart its area and its energies.
std::vector<ChartInfo> measured(const std::vector<AtlasChart>& charts,
                                const std::vector<MappedChart>& maps, const Work& work) {
  std::vector<ChartInfo> info(charts.size());
  measure_charts(charts, maps, 1, info, work);
  return info;
}

/// The chart of several faces that brings most energy beyond that which is given for all, or kNone.
Index farthest_beyond(double energy, const std::vector<AtlasChart>& charts,
                      const std::vector<MappedChart>& maps, const Work& work) {
  const std::vector<ChartInfo> info = measured(charts, maps, work);
  Index worst = kNone;
  double most = 0;
  for (Index c = 0; c < size_of(charts); ++c) {
    const double excess = info[c].area * (info[c].symmetric_dirichlet - energy);
    if (charts[c].real_faces < 2 || !(excess > most)) continue;
    most = excess;
    worst = c;
  }
  return worst;
}

}  // namespace

double beyond_reason(const std::optional<SeamTarget>& target) {
  return target ? std::max(kMissedByFar, target->energy) : kBeyondReason;
}

void sort_by_first_face(const Admitted& admitted, std::vector<AtlasChart>& charts,
                        std::vector<MappedChart>& maps) {
  std::vector<std::pair<Index, Index>> order;
  for (Index c = 0; c < size_of(charts); ++c) {
    order.emplace_back(first_input_face(charts[c], admitted), c);
  }
  if (std::is_sorted(order.begin(), order.end())) return;
  std::sort(order.begin(), order.end());
  std::vector<AtlasChart> sorted;
  std::vector<MappedChart> sorted_maps;
  for (const auto& [face, c] : order) {
    sorted.push_back(std::move(charts[c]));
    sorted_maps.push_back(std::move(maps[c]));
  }
  charts.swap(sorted);
  maps.swap(sorted_maps);
}

bool split_charts(const Admitted& admitted, const PolygonParts& polygons,
                  const std::vector<Index>& which, const ChartOptions& options, const Work& work,
                  std::vector<AtlasChart>& charts, std::vector<MappedChart>& maps) {
  Halves halves = halves_of(admitted, polygons, which, charts, maps, work);
  if (halves.charts.empty()) return false;
  halves.maps = map_charts(halves.charts, {}, options, work);
  replace(admitted, std::move(halves), charts, maps);
  return true;
}

bool split_in_place(const Admitted& admitted, const PolygonParts& polygons,
                    const std::vector<Index>& which, const Work& work,
                    std::vector<AtlasChart>& charts, std::vector<MappedChart>& maps) {
  Halves halves = halves_of(admitted, polygons, which, charts, maps, work);
  if (halves.charts.empty()) return false;
  replace(admitted, std::move(halves), charts, maps);
  return true;
}

bool split_worst(const Admitted& admitted, const PolygonParts& polygons, double energy,
                 const ChartOptions& options, const Work& work, std::vector<AtlasChart>& charts,
                 std::vector<MappedChart>& maps) {
  const Index worst = farthest_beyond(energy, charts, maps, work);
  if (worst == kNone) return false;
  Halves halves = halves_of(admitted, polygons, {worst}, charts, maps, work, true);
  if (halves.charts.empty()) return false;
  std::vector<MappedChart> anew = map_charts(halves.charts, {}, options, work);
  const std::vector<ChartInfo> before = measured(halves.charts, halves.maps, work);
  const std::vector<ChartInfo> after = measured(halves.charts, anew, work);
  for (std::size_t c = 0; c < anew.size(); ++c) {
    const bool is_kept =
        is_sound(maps[worst]) &&
        (!is_sound(anew[c]) || before[c].symmetric_dirichlet < after[c].symmetric_dirichlet);
    if (!is_kept) halves.maps[c] = std::move(anew[c]);
  }
  replace(admitted, std::move(halves), charts, maps);
  return true;
}

bool split_hopeless(const Admitted& admitted, const PolygonParts& polygons, double most,
                    const ChartOptions& options, const Work& work, std::vector<AtlasChart>& charts,
                    std::vector<MappedChart>& maps) {
  std::vector<Index> which;
  const std::vector<ChartInfo> info = measured(charts, maps, work);
  for (Index c = 0; c < size_of(charts); ++c) {
    if (!is_sound(maps[c]) || info[c].symmetric_dirichlet > most) which.push_back(c);
  }
  return split_charts(admitted, polygons, which, options, work, charts, maps);
}

}  // namespace beltrami
