#include "atlas/pack_maps.h"

#include <algorithm>

#include "atlas/margin.h"
#include "atlas/round_chart.h"
#include "atlas/snap.h"
#include "base/parallel.h"
#include "base/types.h"
#include "mesh/disk_mesh.h"

namespace beltrami {
namespace {

/// All charts in one list of faces, for their margin.
double margin_of(const std::vector<AtlasChart>& charts, const std::vector<MappedChart>& maps,
                 const std::vector<Index>& page_of_chart, int resolution, const Work& work) {
  std::vector<Triangle> faces;
  std::vector<Vec2> uvs;
  std::vector<Index> chart_of_face;
  for (std::size_t c = 0; c < charts.size(); ++c) {
    if (maps[c].error) continue;
    const Index first = size_of(uvs);
    uvs.insert(uvs.end(), maps[c].uvs.begin(), maps[c].uvs.end());
    for (Index f = 0; f < charts[c].real_faces; ++f) {
      const auto [i, j, k] = charts[c].chart.mesh.faces[f];
      faces.push_back({first + i, first + j, first + k});
      chart_of_face.push_back(static_cast<Index>(c));
    }
  }
  return least_margin({faces, uvs, chart_of_face, page_of_chart, resolution}, work);
}

}  // namespace

PackChart real_part(const AtlasChart& part, const std::vector<Vec2>& uvs) {
  PackChart chart;
  const std::vector<Triangle>& faces = part.chart.mesh.faces;
  chart.faces.assign(faces.begin(), faces.begin() + part.real_faces);
  std::vector<Index> number(uvs.size(), kNone);
  for (Triangle& face : chart.faces) {
    for (Index& v : face) {
      if (number[v] == kNone) {
        number[v] = size_of(chart.points);
        chart.points.push_back(uvs[v]);
      }
      v = number[v];
    }
  }
  return chart;
}

Outline outline_of(const AtlasChart& part, const std::vector<Vec2>& uvs) {
  const DiskMesh& mesh = part.chart.mesh;
  double area = 0;
  std::vector<bool> is_folded(part.real_faces);
  std::vector<Index> number(uvs.size(), kNone);  // as in its real part
  std::vector<Vec2> points;
  for (Index f = 0; f < part.real_faces; ++f) {
    const auto& [i, j, k] = mesh.faces[f];
    const Vec2 p = uvs[j] - uvs[i], q = uvs[k] - uvs[i];
    const double twice = p.x() * q.y() - p.y() * q.x();
    area += 0.5 * std::abs(twice);
    is_folded[f] = twice < 0;
    for (const Index v : mesh.faces[f]) {
      if (number[v] != kNone) continue;
      number[v] = size_of(points);
      points.push_back(uvs[v]);
    }
  }
  std::vector<std::array<Index, 2>> edges;
  for (Index h = 0; h < 3 * part.real_faces; ++h) {
    const Index twin = mesh.twin[h];
    const bool is_inside = twin != kNone && twin < 3 * part.real_faces;
    if (is_inside && is_folded[h / 3] == is_folded[twin / 3]) continue;
    std::array<Index, 2> edge = {number[mesh.origin(h)], number[mesh.target(h)]};
    if (is_folded[h / 3]) std::swap(edge[0], edge[1]);
    edges.push_back(edge);
  }
  return outline_of(points, edges, area);
}

Pages pack_maps(const std::vector<AtlasChart>& charts, const PackOptions& options, bool float32,
                std::vector<MappedChart>& maps, const Work& work) {
  std::vector<PackChart> parts;
  std::vector<Index> chart_of_part;
  for (std::size_t c = 0; c < charts.size(); ++c) {
    if (maps[c].error) continue;
    parts.push_back(real_part(charts[c], maps[c].uvs));
    parts.back().own_turns = maps[c].own_turns;
    parts.back().group = maps[c].page_group;
    chart_of_part.push_back(static_cast<Index>(c));
  }
  Pages pages;
  pages.resolution = options.resolution;
  pages.asked_margin = options.margin;
  pages.page_of_chart.assign(charts.size(), 0);
  const std::vector<MappedChart> before = maps;
  const auto deliver = [&](const Packing& packing, const Work& own) {
    maps = before;
    const Work of_chart = parts.size() == 1 ? own : own.aside();
    parallel_for(own, size_of(chart_of_part), 1, [&](std::int64_t i, std::int64_t) {
      const Index c = chart_of_part[i];
      const Placement& placement = packing.placements[i];
      pages.page_of_chart[c] = placement.page;
      std::vector<Vec2> placed = maps[c].uvs;
      for (Vec2& w : placed) {
        w = place_on_page(packing, parts[i], placement, options.resolution, w);
      }
      if (options.snap) {
        snap_to_texels(charts[c].chart.mesh, options.resolution, placed, of_chart);
      }
      round_on_page(charts[c].chart.mesh, placed, placement.page, float32, of_chart, maps[c]);
    });
    pages.margin = margin_of(charts, maps, pages.page_of_chart, options.resolution, own);
    return pages.margin;
  };
  if (!parts.empty()) {
    const Packing packing = pack_and_deliver(parts, options, deliver, work);
    pages.count = packing.pages;
    pages.texels_per_unit = packing.texels_per_unit;
  }
  pages.count = std::max(pages.count, 1);
  for (MappedChart& map : maps) {
    if (!map.error) continue;
    const double corner = options.margin / 2 / options.resolution;
    map.uvs.assign(map.uvs.size(), Vec2::Constant(corner));
  }
  return pages;
}

}  // namespace beltrami
