// Surfaces of any topology made coarse, and cuts of the coarse ones carried to the fine.
#include "simplify/history.h"
#include "simplify/coarse.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "base/types.h"
#include "base/work.h"
#include "cut/cut_into_charts.h"
#include "cut/edge_marks.h"
#include "cut/open_minimal.h"
#include "mesh/surface.h"
#include "simplify/simplify.h"
#include "support/cuts.h"
#include "support/meshes.h"
#include "support/surfaces.h"

namespace beltrami {
namespace {

using meshes::TriangleList;
using Edges = std::vector<std::array<Index, 2>>;

struct Simplified {
  Surface fine;
  Topology topology;
  CoarseSurface coarse;
};

Simplified simplified(const TriangleList& mesh, Index faces, int threads = 1) {
  const Work work(threads);
  Simplified result;
  result.fine = build_surface(mesh.positions, mesh.faces, work);
  result.topology = topology_of(result.fine, work);
  result.coarse = simplify_surface(result.fine, result.topology.loops, faces, work);
  return result;
}

/// A sphere without some faces here and there.
TriangleList perforated() {
  TriangleList mesh = disks::blob(4);
  for (const Index f : {1500, 900, 300}) mesh.faces.erase(mesh.faces.begin() + f);
  return mesh;
}

std::vector<TriangleList> surfaces() {
  return {disks::blob(4),
          meshes::torus(24),
          meshes::double_torus(20),
          perforated(),
          meshes::grid(30, 20),
          meshes::together({meshes::torus(16), disks::blob(3), meshes::grid(12, 12)})};
}

void expect_same_topology(const Topology& one, const Topology& other) {
  ASSERT_EQ(one.components.size(), other.components.size());
  for (std::size_t c = 0; c < one.components.size(); ++c) {
    EXPECT_EQ(one.components[c].loops, other.components[c].loops);
    EXPECT_EQ(one.components[c].genus(), other.components[c].genus());
    EXPECT_EQ(one.components[c].euler(), other.components[c].euler());
  }
}

/// The edges that are marked, by fine vertices.
Edges marked(const Simplified& mesh, const EdgeMarks& marks) {
  Edges edges;
  const Surface& surface = mesh.coarse.mesh;
  for (Index h = 0; h < size_of(surface.twin); ++h) {
    if (!marks[h] || surface.edge(h) != h) continue;
    edges.push_back(
        {mesh.coarse.fine_vertex[surface.origin(h)], mesh.coarse.fine_vertex[surface.target(h)]});
  }
  return edges;
}

EdgeMarks marks_of(const Surface& surface, const Edges& edges) {
  EdgeMarks marks(surface.twin.size(), false);
  for (Index h = 0; h < size_of(surface.twin); ++h) {
    const Index a = surface.origin(h), b = surface.target(h);
    const bool found =
        std::binary_search(edges.begin(), edges.end(), std::array{std::min(a, b), std::max(a, b)});
    if (found) mark_edge(surface, h, marks);
  }
  return marks;
}

TEST(SimplifySurface, KeepsHandlesLoopsAndComponents) {
  for (const TriangleList& mesh : surfaces()) {
    const Simplified result = simplified(mesh, size_of(mesh.faces) / 6);
    EXPECT_LT(result.coarse.mesh.face_count(), result.fine.face_count() / 2);
    expect_same_topology(topology_of(result.coarse.mesh, Work(1)), result.topology);
    for (Index v = 0; v < result.coarse.mesh.vertex_count(); ++v) {
      EXPECT_EQ(result.coarse.mesh.positions[v],
                result.fine.positions[result.coarse.fine_vertex[v]]);
    }
    EXPECT_EQ(result.coarse.history.steps.size() + result.coarse.fine_vertex.size(),
              result.fine.positions.size());
  }
}

TEST(SimplifySurface, GivesTheSameBitsOnAnyNumberOfThreads) {
  const Simplified one = simplified(meshes::torus(200), 5000),
                   two = simplified(meshes::torus(200), 5000, 2);
  EXPECT_EQ(one.coarse.mesh.faces, two.coarse.mesh.faces);
  EXPECT_EQ(one.coarse.fine_vertex, two.coarse.fine_vertex);
  EXPECT_EQ(one.coarse.history.renamed, two.coarse.history.renamed);
}

TEST(CarryEdges, ACutHasTheSameTopologyOnTheFineSurface) {
  const Work work(1);
  for (const TriangleList& mesh : surfaces()) {
    for (const Index part : {3, 12, 40}) {
      const Simplified result = simplified(mesh, size_of(mesh.faces) / part);
      const Surface& coarse = result.coarse.mesh;
      const Topology topology = topology_of(coarse, work);
      const EdgeMarks cut = open_minimal(coarse, topology, {}, work);
      const Edges carried =
          carry_edges(result.coarse.history, marked(result, cut), result.fine.on_boundary, {});
      EXPECT_TRUE(std::is_sorted(carried.begin(), carried.end()));
      const CutSurface opened = cut_into_charts(result.fine, marks_of(result.fine, carried), work);
      EXPECT_TRUE(opened.non_disks.empty());
      EXPECT_EQ(opened.charts.size(), topology.components.size());
    }
  }
}

TEST(CarryEdges, PiecesStayApart) {
  // Cut along all edges between two halves of the coarse faces: as many pieces, loops and handles.
  const Work work(1);
  for (const TriangleList& mesh : surfaces()) {
    const Simplified result = simplified(mesh, size_of(mesh.faces) / 6);
    const Surface& coarse = result.coarse.mesh;
    EdgeMarks cut(coarse.twin.size(), false);
    const auto side = [&](Index f) {
      return coarse.positions[coarse.faces[f][0]].x() > 0.1 ? 1 : 0;
    };
    for (Index h = 0; h < size_of(coarse.twin); ++h) {
      if (coarse.twin[h] != kNone && side(h / 3) != side(coarse.twin[h] / 3)) {
        mark_edge(coarse, h, cut);
      }
    }
    const Edges carried =
        carry_edges(result.coarse.history, marked(result, cut), result.fine.on_boundary, {});
    const CutSurface before = cut_into_charts(coarse, cut, work),
                     after = cut_into_charts(result.fine, marks_of(result.fine, carried), work);
    EXPECT_EQ(before.charts.size(), after.charts.size());
    ASSERT_EQ(before.non_disks.size(), after.non_disks.size());
    std::vector<std::array<Index, 2>> shapes, carried_shapes;
    for (const NonDisk& piece : before.non_disks) shapes.push_back({piece.loops, piece.genus});
    for (const NonDisk& piece : after.non_disks) {
      carried_shapes.push_back({piece.loops, piece.genus});
    }
    std::sort(shapes.begin(), shapes.end());
    std::sort(carried_shapes.begin(), carried_shapes.end());
    EXPECT_EQ(shapes, carried_shapes);
  }
}

}  // namespace
}  // namespace beltrami
