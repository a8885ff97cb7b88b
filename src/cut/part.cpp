#include "cut/part.h"

#include <utility>

#include "base/interrupt.h"
#include "cut/cut_into_charts.h"
#include "exact/crossings.h"
#include "mesh/chart.h"
#include "mesh/split_fans.h"
#include "mesh/surface.h"

namespace beltrami {
namespace {

/// The part of `whole` that its faces `face` make.
Part with_fields(DiskMesh mesh, std::vector<Index> face, const std::vector<Index>& vertex,
                 const std::vector<Vec2>& uvs, const std::vector<double>& cost,
                 const Layers& layers, Index whole_faces) {
  Part part;
  part.mesh = std::move(mesh);
  part.face = std::move(face);
  PollSometimes poll;
  part.uvs.reserve(vertex.size());
  for (const Index v : vertex) {
    poll();
    part.uvs.push_back(uvs[v]);
  }
  part.cost.reserve(3 * part.face.size());
  std::vector<Index> new_face(static_cast<std::size_t>(whole_faces), kNone);
  for (Index f = 0; f < size_of(part.face); ++f) {
    poll();
    new_face[part.face[f]] = f;
    for (int k = 0; k < 3; ++k) part.cost.push_back(cost[3 * part.face[f] + k]);
  }
  part.layers = layers_among(layers, new_face);
  return part;
}

}  // namespace

std::vector<Part> parts_of(const Part& part, const EdgeMarks& marks, const Work& work) {
  CutSurface cut = cut_into_charts(part.mesh, marks, work);
  if (!cut.non_disks.empty()) return {};
  std::vector<Part> parts;
  for (Chart& chart : cut.charts) {
    Part& child = parts.emplace_back(with_fields(std::move(chart.mesh), std::move(chart.input_face),
                                                 chart.input_vertex, part.uvs, part.cost,
                                                 part.layers, part.mesh.face_count()));
    for (Index& f : child.face) f = part.face[f];
  }
  return parts;
}

std::optional<Part> part_from(const DiskMesh& disk, const std::vector<Vec2>& uvs,
                              const std::vector<double>& cost, const Layers& layers,
                              std::vector<Index> faces, const EdgeMarks& seams, const Work& work) {
  std::vector<Index> place(disk.faces.size(), kNone);
  for (Index f = 0; f < size_of(faces); ++f) place[faces[f]] = f;
  std::vector<Triangle> triangles;
  std::vector<Index> twin;
  triangles.reserve(faces.size());
  twin.reserve(3 * faces.size());
  PollSometimes poll;
  for (const Index f : faces) {
    poll();
    triangles.push_back(disk.faces[f]);
    for (Index h = 3 * f; h < 3 * f + 3; ++h) {
      const Index other = seams[h] ? kNone : disk.twin[h];
      const bool is_in = other != kNone && place[other / 3] != kNone;
      twin.push_back(is_in ? 3 * place[other / 3] + other % 3 : kNone);
    }
  }
  const std::vector<Index> used = drop_unreferenced(disk.vertex_count(), triangles, work);
  std::vector<Vec3> positions;
  positions.reserve(used.size());
  for (const Index v : used) positions.push_back(disk.positions[v]);
  SplitSurface open = split_fans(positions, triangles, twin, work);
  const Topology topology = topology_of(open.surface, work);
  if (topology.components.size() != 1 || !topology.components.front().is_disk()) return {};
  for (Index& v : open.vertex) v = used[v];
  return with_fields(prove_disk(std::move(open.surface), work), std::move(faces), open.vertex, uvs,
                     cost, layers, disk.face_count());
}

double uv_area(const Triangle& face, const std::vector<Vec2>& uvs) {
  const Vec2 a = uvs[face[1]] - uvs[face[0]], b = uvs[face[2]] - uvs[face[0]];
  return (a.x() * b.y() - a.y() * b.x()) / 2;
}

double uv_area(const std::vector<Triangle>& faces, const std::vector<Vec2>& uvs) {
  double sum = 0;
  for (const Triangle& face : faces) sum += uv_area(face, uvs);
  return sum;
}

bool lies_on_itself(const Part& part, double tolerance) {
  const double area = uv_area(part.mesh.faces, part.uvs);
  if (tolerance > 0 && overlapped_area(part.layers) <= tolerance * area) return false;
  return !is_simple(part.mesh.boundary, part.uvs);
}

}  // namespace beltrami
