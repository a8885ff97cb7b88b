#include "atlas/chart_parts.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "base/disjoint_sets.h"
#include "base/interrupt.h"
#include "cut/cut_into_charts.h"
#include "mesh/chart.h"
#include "mesh/disk_mesh.h"

namespace beltrami {
namespace {

/// Marks what parts the pieces of a chart; the largest one keeps the virtual faces that it reaches,
/// then the next one.
EdgeMarks marks_between(const AtlasChart& chart, const std::vector<Index>& piece) {
  const DiskMesh& mesh = chart.chart.mesh;
  std::vector<Index> size(piece.size(), 0), order;
  for (const Index p : piece) ++size[p];
  for (Index p = 0; p < size_of(size); ++p) {
    if (size[p] > 0) order.push_back(p);
  }
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return size[a] > size[b]; });
  std::vector<Index> rank(piece.size());
  for (Index r = 0; r < size_of(order); ++r) rank[order[r]] = r;
  std::vector<Index> front(piece.size()), owner = piece;
  for (Index f = 0; f < size_of(front); ++f) front[f] = f;
  // From the back: all that the largest piece reaches is done before the next one has its turn.
  std::stable_sort(front.begin(), front.end(),
                   [&](Index a, Index b) { return rank[piece[a]] > rank[piece[b]]; });
  owner.resize(mesh.faces.size(), kNone);
  PollSometimes poll;
  while (!front.empty()) {
    poll();
    const Index f = front.back();
    front.pop_back();
    for (int k = 0; k < 3; ++k) {
      const Index twin = mesh.twin[3 * f + k];
      if (twin == kNone || owner[twin / 3] != kNone) continue;
      owner[twin / 3] = owner[f];
      front.push_back(twin / 3);
    }
  }
  EdgeMarks marks(mesh.twin.size(), false);
  for (Index h = 0; h < size_of(mesh.twin); ++h) {
    const Index twin = mesh.twin[h];
    if (twin != kNone && owner[h / 3] != owner[twin / 3]) mark_edge(mesh, h, marks);
  }
  return marks;
}

}  // namespace

std::vector<Index> real_pieces(const AtlasChart& chart) {
  const DiskMesh& mesh = chart.chart.mesh;
  DisjointSets sets(chart.real_faces);
  for (Index f = 0; f < chart.real_faces; ++f) sets.make(f);
  PollSometimes poll;
  for (Index h = 0; h < 3 * chart.real_faces; ++h) {
    poll();
    const Index twin = mesh.twin[h];
    if (twin != kNone && twin / 3 < chart.real_faces) sets.unite(h / 3, twin / 3);
  }
  return std::move(sets).roots();
}

std::vector<ChartPart> parts_along(const AtlasChart& chart, const MappedChart& map,
                                   const EdgeMarks& marks, const Work& work) {
  CutSurface cut = cut_into_charts(chart.chart.mesh, marks, work);
  if (!cut.non_disks.empty()) return {};
  std::vector<ChartPart> parts;
  for (Chart& own : cut.charts) {
    const auto first_virtual =
        std::lower_bound(own.input_face.begin(), own.input_face.end(), chart.real_faces);
    if (first_virtual == own.input_face.begin()) continue;
    ChartPart& part = parts.emplace_back();
    part.chart.real_faces = static_cast<Index>(first_virtual - own.input_face.begin());
    part.chart.is_turned = chart.is_turned;
    part.map.outcome = map.outcome;
    part.map.scale = map.scale;
    part.map.own_turns = map.own_turns;
    part.map.page_group = map.page_group;
    for (Index& v : own.input_vertex) {
      part.map.uvs.push_back(map.uvs[v]);
      v = chart.chart.input_vertex[v];
    }
    for (Index& f : own.input_face) f = chart.chart.input_face[f];
    part.chart.chart = std::move(own);
  }
  return parts;
}

void separate_pieces(const Admitted& admitted, Index most_charts, std::vector<AtlasChart>& charts,
                     std::vector<MappedChart>& maps, const Work& work) {
  const Index before = size_of(charts);
  Index count = before;
  for (Index c = 0; c < before; ++c) {
    AtlasChart& chart = charts[c];
    if (maps[c].error || maps[c].pinned()) continue;
    if (size_of(chart.chart.mesh.faces) == chart.real_faces) continue;
    const std::vector<Index> piece = real_pieces(chart);
    if (std::all_of(piece.begin(), piece.end(), [](Index p) { return p == 0; })) continue;
    std::vector<ChartPart> parts = parts_along(chart, maps[c], marks_between(chart, piece), work);
    if (parts.size() < 2) continue;
    const Index more = size_of(parts) - 1;
    if (most_charts > 0 && count + more > most_charts) continue;
    count += more;
    charts[c] = std::move(parts.front().chart);
    maps[c] = std::move(parts.front().map);
    for (auto part = parts.begin() + 1; part != parts.end(); ++part) {
      charts.push_back(std::move(part->chart));
      maps.push_back(std::move(part->map));
    }
  }
  if (count == before) return;
  std::vector<std::pair<Index, Index>> order;
  for (Index c = 0; c < count; ++c) order.emplace_back(first_input_face(charts[c], admitted), c);
  std::sort(order.begin(), order.end());
  std::vector<AtlasChart> sorted_charts;
  std::vector<MappedChart> sorted_maps;
  for (const auto& [face, c] : order) {
    sorted_charts.push_back(std::move(charts[c]));
    sorted_maps.push_back(std::move(maps[c]));
  }
  charts = std::move(sorted_charts);
  maps = std::move(sorted_maps);
}

}  // namespace beltrami
