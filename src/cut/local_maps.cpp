#include "cut/local_maps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

#include "base/parallel.h"
#include "descend/newton.h"
#include "energy/measure.h"
#include "exact/certificate.h"
#include "exact/crossings.h"
#include "mesh/chart.h"
#include "mesh/disk_mesh.h"
#include "mesh/rest_shape.h"
#include "multilevel/composite_majorization.h"
#include "multilevel/descent.h"
#include "multilevel/options.h"
#include "repair/touching.h"

namespace beltrami {
namespace {

/// The excess of a face counts up to that in the sum around a vertex: a needle says nothing of what
/// is around it.
constexpr double kMostExcess = 10;

constexpr double kNoEnergy = std::numeric_limits<double>::quiet_NaN();

/// Per face of a surface, at its corners.
using Corners = std::vector<std::array<Vec2, 3>>;

Corners corners_of(const LocalMaps& maps) {
  Corners corners(maps.cut.chart_of_face.size());
  for (std::size_t c = 0; c < maps.uvs.size(); ++c) {
    const Chart& chart = maps.cut.charts[c];
    for (Index f = 0; f < chart.mesh.face_count(); ++f) {
      for (int k = 0; k < 3; ++k) {
        corners[chart.input_face[f]][k] = maps.uvs[c][chart.mesh.faces[f][k]];
      }
    }
  }
  return corners;
}

/// The map that the corners of a chart had before, or none where corners that are one now were not.
std::vector<Vec2> map_before(const Chart& chart, const Corners& corners) {
  std::vector<Vec2> uvs(chart.mesh.positions.size());
  std::vector<bool> is_set(uvs.size(), false);
  for (Index f = 0; f < chart.mesh.face_count(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const Index v = chart.mesh.faces[f][k];
      const Vec2& uv = corners[chart.input_face[f]][k];
      if (is_set[v] && uvs[v] != uv) return {};
      uvs[v] = uv;
      is_set[v] = true;
    }
  }
  return uvs;
}

/// Whether a chart that has a map before was a chart of its own there: vertices that are two now
/// would be more, those that are one now would have none.
bool was_chart(const Chart& chart, const LocalMaps& before) {
  const Index other = before.cut.chart_of_face[chart.input_face.front()];
  if (other == kNone) return false;
  const Chart& old = before.cut.charts[other];
  return old.input_vertex.size() == chart.input_vertex.size() && old.input_face == chart.input_face;
}

/// From `start`, where that serves.
std::vector<Vec2> map_chart(const Chart& chart, std::vector<Vec2> start, const MapSetting& setting,
                            KnownMaps& known, const Work& work) {
  DiskMesh mesh = chart.mesh;
  const Normalisation frame = normalise(mesh.positions, mesh.faces, work);
  ChartOptions options;
  options.injectivity = setting.injectivity;
  options.tolerance = setting.tolerance;
  options.is_trial = true;
  for (Vec2& w : start) w *= std::ldexp(1.0, frame.exponent);
  Descent done;
  bool is_new = false;
  if (!start.empty() && non_positive_faces(mesh.faces, start, work).empty()) {
    const auto rest = rest_triangles(mesh.positions, mesh.faces, work);
    NewtonOptions newton = newton_options(options);
    newton.proxy_steps = 0;
    const bool simple = keeps_boundary_simple(options);
    done = descend(mesh, rest, std::move(start), newton, simple, options, work);
  } else {
    if (std::optional<std::vector<Vec2>> same = known.find(chart, setting)) return *same;
    done = minimise_from_scratch(mesh, setting.tolerance, options, work);
    is_new = !work.out_of_time();
  }
  for (Vec2& w : done.uvs) w *= std::ldexp(1.0, -frame.exponent);
  if (is_new) known.keep(chart, setting, done.uvs);
  return std::move(done.uvs);
}

/// Takes energies, their mean and the percentile from the maps.
void measure(Index real_faces, LocalMaps& maps) {
  maps.energies.assign(maps.cut.chart_of_face.size(), kNoEnergy);
  std::vector<WeighedEnergy> measured;
  for (std::size_t c = 0; c < maps.uvs.size(); ++c) {
    const Chart& chart = maps.cut.charts[c];
    for (Index f = 0; f < chart.mesh.face_count(); ++f) {
      if (chart.input_face[f] >= real_faces) continue;
      const auto [i, j, k] = chart.mesh.faces[f];
      const std::vector<Vec3>& p = chart.mesh.positions;
      const std::vector<Vec2>& w = maps.uvs[c];
      const FaceDistortion face = measure_face({p[i], p[j], p[k]}, {w[i], w[j], w[k]});
      if (!std::isfinite(face.symmetric_dirichlet)) continue;
      maps.energies[chart.input_face[f]] = face.symmetric_dirichlet;
      measured.push_back({face.symmetric_dirichlet, face.area});
    }
  }
  const EnergySummary summary = summarise(measured);
  maps.energy = std::isnan(summary.mean) ? 2 : summary.mean;
  maps.p99 = std::isnan(summary.p99) ? 2 : summary.p99;
}

/// Calls `map(c, work)` for each of these charts: for one that has most of the faces first, on all
/// threads, then for the others side by side.
template <class Map>
void for_each_chart(const std::vector<std::size_t>& which, const std::vector<Chart>& charts,
                    const Work& work, const Map& map) {
  Index faces = 0;
  for (const std::size_t c : which) faces += charts[c].mesh.face_count();
  const auto large = std::find_if(which.begin(), which.end(), [&](std::size_t c) {
    return 2 * charts[c].mesh.face_count() > faces;
  });
  if (large != which.end()) map(*large, work);
  parallel_for(work, size_of(which), 1, [&](std::int64_t i, std::int64_t) {
    if (which.begin() + i != large) map(which[i], work.aside());
  });
}

}  // namespace

LocalMaps map_locally(const Surface& surface, Index real_faces, const EdgeMarks& seams,
                      double tolerance, const LocalMaps* before, KnownMaps& known,
                      const Work& work) {
  LocalMaps maps;
  maps.cut = cut_into_charts(surface, seams, work);
  Corners corners;
  if (before != nullptr) corners = corners_of(*before);
  maps.uvs.resize(maps.cut.charts.size());
  std::vector<std::size_t> all(maps.uvs.size());
  std::iota(all.begin(), all.end(), 0);
  for_each_chart(all, maps.cut.charts, work, [&](std::size_t c, const Work& part) {
    const Chart& chart = maps.cut.charts[c];
    std::vector<Vec2> start;
    if (before != nullptr) start = map_before(chart, corners);
    const bool was_there = !start.empty() && was_chart(chart, *before);
    const MapSetting setting{Injectivity::kLocal, tolerance};
    maps.uvs[c] =
        was_there ? std::move(start) : map_chart(chart, std::move(start), setting, known, part);
  });
  measure(real_faces, maps);
  return maps;
}

LocalMaps with_contact(LocalMaps maps, Index real_faces, double tolerance, const LocalMaps* before,
                       KnownMaps& known, const Work& work) {
  std::vector<std::size_t> crossing;
  for (std::size_t c = 0; c < maps.uvs.size(); ++c) {
    if (!is_simple(maps.cut.charts[c].mesh.boundary, maps.uvs[c])) crossing.push_back(c);
  }
  if (crossing.empty()) return maps;
  Corners corners;
  if (before != nullptr) corners = corners_of(*before);
  for_each_chart(crossing, maps.cut.charts, work, [&](std::size_t c, const Work& part) {
    const Chart& chart = maps.cut.charts[c];
    std::vector<Vec2> start;
    if (before != nullptr) start = map_before(chart, corners);
    if (!start.empty() && was_chart(chart, *before)) {
      maps.uvs[c] = std::move(start);  // it crossed itself then, too, and was mended or left so
      return;
    }
    if (open_touching_sides(chart.mesh, part, maps.uvs[c])) return;
    const bool serves = !start.empty() && (is_simple(chart.mesh.boundary, start) ||
                                           open_touching_sides(chart.mesh, part, start));
    if (!serves) start.clear();
    const MapSetting setting{Injectivity::kGlobal, tolerance};
    std::vector<Vec2> uvs = map_chart(chart, std::move(start), setting, known, part);
    if (is_simple(chart.mesh.boundary, uvs)) maps.uvs[c] = std::move(uvs);
  });
  measure(real_faces, maps);
  return maps;
}

std::vector<double> excess_around(const Surface& surface, Index real_faces, const LocalMaps& maps) {
  std::vector<double> excess(surface.positions.size());
  double whole = 0;
  for (Index f = 0; f < real_faces; ++f) {
    const auto [i, j, k] = surface.faces[f];
    const std::vector<Vec3>& p = surface.positions;
    const double area = triangle_area(p[i], p[j], p[k]);
    whole += area;
    if (!std::isfinite(maps.energies[f])) continue;
    const double over = std::clamp(maps.energies[f] - 2, 0.0, kMostExcess);
    for (const Index v : surface.faces[f]) excess[v] += over * area / 3;
  }
  if (!(whole > 0)) return {};
  for (double& e : excess) e /= whole;
  return excess;
}

}  // namespace beltrami
