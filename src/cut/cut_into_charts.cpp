#include "cut/cut_into_charts.h"

#include <utility>

#include "base/grouping.h"
#include "base/interrupt.h"
#include "base/parallel.h"
#include "mesh/disk_mesh.h"
#include "mesh/split_fans.h"

namespace beltrami {
namespace {

/// Component `c` of the surface on its own: a disk. Its order is that of the surface.
Chart extract(const SplitSurface& cut, const Grouping& vertices, const Grouping& faces, Index c,
              const Work& work) {
  const Surface& whole = cut.surface;
  const auto in_part = [&](Index h) { return h == kNone ? h : 3 * faces.place(h / 3) + h % 3; };
  Chart chart;
  Surface part;
  PollSometimes poll;
  for (const Index v : vertices[c]) {
    poll();
    part.positions.push_back(whole.positions[v]);
    part.outgoing.push_back(in_part(whole.outgoing[v]));
    part.on_boundary.push_back(whole.on_boundary[v]);
    chart.input_vertex.push_back(cut.vertex[v]);
  }
  for (const Index f : faces[c]) {
    poll();
    const auto [a, b, d] = whole.faces[f];
    part.faces.push_back({vertices.place(a), vertices.place(b), vertices.place(d)});
    for (int k = 0; k < 3; ++k) part.twin.push_back(in_part(whole.twin[3 * f + k]));
    chart.input_face.push_back(f);
  }
  chart.mesh = prove_disk(std::move(part), work);
  return chart;
}

}  // namespace

CutSurface cut_into_charts(const Surface& surface, const EdgeMarks& marks, const Work& work) {
  const SplitSurface cut = split_along(surface, marks, work);
  const Topology topology = topology_of(cut.surface, work);
  const Index components = size_of(topology.components);
  const std::vector<Index>& component_of = topology.component_of_face;
  const Grouping faces(
      surface.face_count(), components, [&](Index f) { return component_of[f]; }, work);
  const Grouping vertices(
      cut.surface.vertex_count(), components,
      [&](Index v) { return component_of[cut.surface.outgoing[v] / 3]; }, work);

  CutSurface result;
  std::vector<Index> disks, chart_of_component(components, kNone);
  for (Index c = 0; c < components; ++c) {
    const Component& component = topology.components[c];
    if (component.is_disk()) {
      chart_of_component[c] = size_of(disks);
      disks.push_back(c);
    } else {
      result.non_disks.push_back(
          {{faces[c].begin(), faces[c].end()}, component.loops, component.genus()});
    }
  }
  result.charts.resize(disks.size());
  parallel_for(work, size_of(disks), 1, [&](std::int64_t chart, std::int64_t) {
    result.charts[chart] = extract(cut, vertices, faces, disks[chart], work.aside());
  });
  result.chart_of_face.resize(component_of.size());
  for (std::size_t f = 0; f < component_of.size(); ++f) {
    result.chart_of_face[f] = chart_of_component[component_of[f]];
  }
  return result;
}

}  // namespace beltrami
