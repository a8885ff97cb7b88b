#include "cut/cut_into_charts.h"

#include <numeric>
#include <utility>

#include "base/grouping.h"
#include "base/interrupt.h"
#include "base/parallel.h"
#include "mesh/disk_mesh.h"
#include "mesh/split_fans.h"

namespace beltrami {
namespace {

/// The vertices of a boundary loop.
std::vector<Index> vertices_of(const Surface& surface, const BoundaryLoops& loops, Index loop) {
  std::vector<Index> vertices;
  vertices.reserve(loops.start[loop + 1] - loops.start[loop]);
  for (Index i = loops.start[loop]; i < loops.start[loop + 1]; ++i) {
    vertices.push_back(surface.origin(loops.halfedge[i]));
  }
  return vertices;
}

/// Component `c` of the surface on its own, a disk with this boundary. Its order is that of the
/// surface.
Chart extract(const SplitSurface& cut, const Grouping& vertices, const Grouping& faces, Index c,
              std::vector<Index> boundary) {
  const Surface& whole = cut.surface;
  const auto in_part = [&](Index h) { return h == kNone ? h : 3 * faces.place(h / 3) + h % 3; };
  Chart chart;
  DiskMesh& part = chart.mesh;
  part.positions.reserve(vertices[c].size());
  part.outgoing.reserve(vertices[c].size());
  part.on_boundary.reserve(vertices[c].size());
  chart.input_vertex.reserve(vertices[c].size());
  PollSometimes poll;
  for (const Index v : vertices[c]) {
    poll();
    part.positions.push_back(whole.positions[v]);
    part.outgoing.push_back(in_part(whole.outgoing[v]));
    part.on_boundary.push_back(whole.on_boundary[v]);
    chart.input_vertex.push_back(cut.vertex[v]);
  }
  part.faces.reserve(faces[c].size());
  part.twin.reserve(3 * faces[c].size());
  for (const Index f : faces[c]) {
    poll();
    const auto [a, b, d] = whole.faces[f];
    part.faces.push_back({vertices.place(a), vertices.place(b), vertices.place(d)});
    for (int k = 0; k < 3; ++k) part.twin.push_back(in_part(whole.twin[3 * f + k]));
  }
  chart.input_face.assign(faces[c].begin(), faces[c].end());
  for (Index& v : boundary) v = vertices.place(v);
  part.boundary = std::move(boundary);
  return chart;
}

/// A surface that is one disk.
CutSurface only_chart(SplitSurface cut, const Topology& topology) {
  CutSurface result;
  Chart& chart = result.charts.emplace_back();
  chart.input_face.resize(cut.surface.faces.size());
  std::iota(chart.input_face.begin(), chart.input_face.end(), 0);
  chart.input_vertex = std::move(cut.vertex);
  std::vector<Index> boundary = vertices_of(cut.surface, topology.loops, 0);
  chart.mesh = {std::move(cut.surface), std::move(boundary)};
  result.chart_of_face.assign(chart.input_face.size(), 0);
  return result;
}

}  // namespace

CutSurface cut_into_charts(const Surface& surface, const EdgeMarks& marks, const Work& work) {
  SplitSurface cut = split_along(surface, marks, work);
  const Topology topology = topology_of(cut.surface, work);
  const Index components = size_of(topology.components);
  if (components == 1 && topology.components[0].is_disk()) {
    return only_chart(std::move(cut), topology);
  }
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
  std::vector<Index> loop_of(components, kNone);  // the only one of a disk
  for (Index loop = 0; loop < topology.loops.count(); ++loop) {
    loop_of[topology.component_of_loop[loop]] = loop;
  }
  result.charts.resize(disks.size());
  parallel_for(work, size_of(disks), 1, [&](std::int64_t chart, std::int64_t) {
    const Index c = disks[chart];
    result.charts[chart] =
        extract(cut, vertices, faces, c, vertices_of(cut.surface, topology.loops, loop_of[c]));
  });
  result.chart_of_face.resize(component_of.size());
  for (std::size_t f = 0; f < component_of.size(); ++f) {
    result.chart_of_face[f] = chart_of_component[component_of[f]];
  }
  return result;
}

}  // namespace beltrami
