#include "cut/local_maps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "base/parallel.h"
#include "chart/descent.h"
#include "chart/modes.h"
#include "chart/options.h"
#include "energy/measure.h"
#include "exact/certificate.h"
#include "mesh/disk_mesh.h"
#include "mesh/rest_shape.h"

namespace beltrami {
namespace {

constexpr double kNoEnergy = std::numeric_limits<double>::quiet_NaN();

/// The map that the corners of a chart had before, or none where corners that are one now were not,
/// or a face is folded.
std::vector<Vec2> map_before(const Chart& chart, const std::vector<std::array<Vec2, 3>>& corners) {
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

std::vector<Vec2> map_chart(const Chart& chart, std::vector<Vec2> start, double tolerance,
                            const Work& work) {
  DiskMesh mesh = chart.mesh;
  const Normalisation frame = normalise(mesh.positions, mesh.faces, work);
  ChartOptions options;
  options.injectivity = Injectivity::kLocal;
  options.tolerance = tolerance;
  for (Vec2& w : start) w *= std::ldexp(1.0, frame.exponent);
  Descent done;
  if (!start.empty() && non_positive_faces(mesh.faces, start, work).empty()) {
    const auto rest = rest_triangles(mesh.positions, mesh.faces, work);
    NewtonOptions newton = newton_options(options);
    newton.proxy_steps = 0;
    done = descend(mesh, rest, std::move(start), newton, false, options, work);
  } else {
    done = minimise_from_scratch(mesh, tolerance, options, work);
  }
  for (Vec2& w : done.uvs) w *= std::ldexp(1.0, -frame.exponent);
  return std::move(done.uvs);
}

/// The energy that is exceeded on 1% of the area.
double percentile_of(std::vector<Vec2> energies_and_areas) {
  std::sort(energies_and_areas.begin(), energies_and_areas.end(), [](const Vec2& a, const Vec2& b) {
    return std::tie(a.x(), a.y()) > std::tie(b.x(), b.y());
  });
  double area = 0, beyond = 0;
  for (const Vec2& face : energies_and_areas) area += face.y();
  for (const Vec2& face : energies_and_areas) {
    beyond += face.y();
    if (beyond > 0.01 * area) return face.x();
  }
  return 2;
}

}  // namespace

LocalMaps map_locally(const Surface& surface, Index real_faces, const EdgeMarks& seams,
                      double tolerance, const LocalMaps* before, const Work& work) {
  LocalMaps maps;
  maps.cut = cut_into_charts(surface, seams, work);
  std::vector<std::array<Vec2, 3>> corners;
  if (before != nullptr) {
    corners.resize(surface.faces.size());
    for (std::size_t c = 0; c < before->uvs.size(); ++c) {
      const Chart& chart = before->cut.charts[c];
      for (Index f = 0; f < chart.mesh.face_count(); ++f) {
        for (int k = 0; k < 3; ++k) {
          corners[chart.input_face[f]][k] = before->uvs[c][chart.mesh.faces[f][k]];
        }
      }
    }
  }
  maps.uvs.resize(maps.cut.charts.size());
  maps.energies.assign(surface.faces.size(), kNoEnergy);
  std::vector<Vec2> sums(maps.uvs.size(), Vec2::Zero());     // of energy times area, and of area
  std::vector<std::vector<Vec2>> measured(maps.uvs.size());  // energies and areas
  parallel_for(work, size_of(maps.uvs), 1, [&](std::int64_t c, std::int64_t) {
    const Chart& chart = maps.cut.charts[c];
    maps.uvs[c] =
        map_chart(chart, corners.empty() ? std::vector<Vec2>() : map_before(chart, corners),
                  tolerance, work.aside());
    for (Index f = 0; f < chart.mesh.face_count(); ++f) {
      if (chart.input_face[f] >= real_faces) continue;
      const auto [i, j, k] = chart.mesh.faces[f];
      const std::vector<Vec3>& p = chart.mesh.positions;
      const std::vector<Vec2>& w = maps.uvs[c];
      const FaceDistortion face = measure_face({p[i], p[j], p[k]}, {w[i], w[j], w[k]});
      if (!std::isfinite(face.symmetric_dirichlet)) continue;
      maps.energies[chart.input_face[f]] = face.symmetric_dirichlet;
      sums[c] += Vec2(face.symmetric_dirichlet * face.area, face.area);
      measured[c].emplace_back(face.symmetric_dirichlet, face.area);
    }
  });
  Vec2 sum = Vec2::Zero();
  for (const Vec2& own : sums) sum += own;
  maps.energy = sum.y() > 0 ? sum.x() / sum.y() : 2;
  std::vector<Vec2> all;
  for (const std::vector<Vec2>& own : measured) all.insert(all.end(), own.begin(), own.end());
  maps.p99 = percentile_of(std::move(all));
  return maps;
}

}  // namespace beltrami
