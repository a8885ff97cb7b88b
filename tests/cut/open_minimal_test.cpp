// Cuts that make disks of any surface, and the charts that they leave.
#include "cut/open_minimal.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

#include "admit/admit.h"
#include "base/interrupt.h"
#include "base/types.h"
#include "cut/cut_into_charts.h"
#include "mesh/chart.h"
#include "mesh/disk_mesh.h"
#include "support/meshes.h"
#include "support/polls.h"
#include "support/surfaces.h"

namespace beltrami {
namespace {

using meshes::TriangleList;

struct Opened {
  Surface surface;
  Topology topology;
  EdgeMarks marks;
  CutSurface cut;
};

Opened opened(const TriangleList& mesh, int threads = 1) {
  const Work work(threads);
  Opened result;
  result.surface = build_surface(mesh.positions, mesh.faces, work);
  result.topology = topology_of(result.surface, work);
  result.marks = open_minimal(result.surface, result.topology, {}, work);
  result.cut = cut_into_charts(result.surface, result.marks, work);
  return result;
}

double cut_length(const Surface& surface, const EdgeMarks& marks) {
  double length = 0;
  for (Index h = 0; h < size_of(surface.twin); ++h) {
    if (!marks[h] || surface.edge(h) != h) continue;
    length += (surface.positions[surface.target(h)] - surface.positions[surface.origin(h)]).norm();
  }
  return length;
}

Index marked_edges(const Surface& surface, const EdgeMarks& marks) {
  Index count = 0;
  for (Index h = 0; h < size_of(surface.twin); ++h) count += marks[h] && surface.edge(h) == h;
  return count;
}

/// Expects one chart for each component, whose faces and vertices are the surface's.
void expect_disks(const Opened& result) {
  EXPECT_TRUE(result.cut.non_disks.empty());
  EXPECT_EQ(result.cut.charts.size(), result.topology.components.size());
  std::size_t faces = 0;
  for (const Chart& chart : result.cut.charts) {
    faces += chart.input_face.size();
    // The disk is what would be built of its faces alone.
    const DiskMesh disk = build_disk(chart.mesh.positions, chart.mesh.faces, Work(1));
    EXPECT_EQ(disk.twin, chart.mesh.twin);
    EXPECT_EQ(disk.outgoing, chart.mesh.outgoing);
    EXPECT_EQ(disk.boundary, chart.mesh.boundary);
    for (Index f = 0; f < chart.mesh.face_count(); ++f) {
      for (int k = 0; k < 3; ++k) {
        EXPECT_EQ(chart.input_vertex[chart.mesh.faces[f][k]],
                  result.surface.faces[chart.input_face[f]][k]);
      }
    }
  }
  EXPECT_EQ(faces, result.surface.faces.size());
}

TEST(OpenMinimal, LeavesDisksAlone) {
  const Opened result = opened(meshes::together({meshes::grid(5, 5), meshes::fan(4)}));
  expect_disks(result);
  EXPECT_EQ(marked_edges(result.surface, result.marks), 0);
}

TEST(OpenMinimal, CutsASphereAlongAPath) {
  for (const TriangleList& mesh : {meshes::tetrahedron(), meshes::octahedron(), meshes::cube()}) {
    const Opened result = opened(mesh);
    expect_disks(result);
    EXPECT_EQ(marked_edges(result.surface, result.marks), 2);
    EXPECT_EQ(result.cut.charts[0].mesh.boundary.size(), 4u);
  }
}

TEST(OpenMinimal, OpensHandlesByShortLoops) {
  // Radii 2 and 1: around the tube and along the inside, 2 pi each.
  const Opened torus = opened(meshes::torus(24));
  expect_disks(torus);
  EXPECT_LT(cut_length(torus.surface, torus.marks), 1.2 * 4 * std::numbers::pi);
  expect_disks(opened(meshes::torus(3)));
  expect_disks(opened(meshes::torus_with_hole(5)));
  const Opened two = opened(meshes::double_torus(6));
  EXPECT_EQ(two.topology.components[0].genus(), 2);
  expect_disks(two);
}

TEST(OpenMinimal, JoinsLoopsByShortPaths) {
  const Opened annulus = opened(meshes::annulus(9));
  expect_disks(annulus);
  EXPECT_EQ(marked_edges(annulus.surface, annulus.marks), 1);

  // Three holes in a sheet: as many paths.
  TriangleList mesh = meshes::grid(20, 20);
  for (const Index f : {700, 410, 90}) mesh.faces.erase(mesh.faces.begin() + f);
  const Opened sheet = opened(mesh);
  ASSERT_EQ(sheet.topology.components[0].loops, 4);
  expect_disks(sheet);
  EXPECT_LT(cut_length(sheet.surface, sheet.marks), 1.2);
}

/// The diagonals of the quads that grids of quads were cut along.
EdgeMarks diagonals(const Surface& surface) {
  EdgeMarks locked(surface.twin.size(), false);
  for (Index h = 0; h < size_of(surface.twin); ++h) {
    const Index twin = surface.twin[h];
    if (twin != kNone && h / 6 == twin / 6) mark_edge(surface, h, locked);
  }
  return locked;
}

TEST(OpenMinimal, CutsNoLockedEdge) {
  const Work work(1);
  for (const TriangleList& mesh : {meshes::torus(8), meshes::annulus(9), meshes::cube()}) {
    const Surface surface = build_surface(mesh.positions, mesh.faces, work);
    const EdgeMarks locked = diagonals(surface);
    ASSERT_GT(marked_edges(surface, locked), 0);
    const EdgeMarks marks = open_minimal(surface, topology_of(surface, work), locked, work);
    for (std::size_t h = 0; h < marks.size(); ++h) EXPECT_FALSE(marks[h] && locked[h]);
    const CutSurface cut = cut_into_charts(surface, marks, work);
    EXPECT_TRUE(cut.non_disks.empty());
    EXPECT_EQ(cut.charts.size(), 1u);
  }
}

TEST(OpenMinimal, CutsLockedEdgesWhereThereIsNoOtherWay) {
  const Work work(1);
  for (const TriangleList& mesh :
       {meshes::tetrahedron(), meshes::torus(3), meshes::annulus(9), meshes::torus_with_hole(5)}) {
    const Surface surface = build_surface(mesh.positions, mesh.faces, work);
    for (const Index free : {kNone, 0}) {
      EdgeMarks locked(surface.twin.size(), true);
      if (free != kNone) locked[free] = false;
      if (free != kNone && surface.twin[free] != kNone) locked[surface.twin[free]] = false;
      const EdgeMarks marks = open_minimal(surface, topology_of(surface, work), locked, work);
      const CutSurface cut = cut_into_charts(surface, marks, work);
      EXPECT_TRUE(cut.non_disks.empty());
      EXPECT_EQ(cut.charts.size(), 1u);
    }
  }
}

TEST(OpenMinimal, OpensWhateverIsAdmitted) {
  const Work work(1);
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const TriangleList mesh = meshes::random_soup(4 + static_cast<Index>(seed % 12), 60, seed);
    Opened result;
    Admitted admitted = admit(mesh.positions, mesh.faces, {}, work);
    result.surface = std::move(admitted.surface);
    result.topology = std::move(admitted.topology);
    result.marks = open_minimal(result.surface, result.topology, {}, work);
    result.cut = cut_into_charts(result.surface, result.marks, work);
    expect_disks(result);
  }
}

TEST(OpenMinimal, IsTheSameAtAnyThreadCount) {
  std::vector<TriangleList> parts;
  for (Index n = 3; n < 60; ++n)
    parts.push_back(n % 3 == 0 ? meshes::torus(n) : meshes::annulus(n));
  const TriangleList mesh = meshes::together(parts);
  const Opened one = opened(mesh, 1), two = opened(mesh, 2);
  expect_disks(one);
  EXPECT_EQ(one.marks, two.marks);
  ASSERT_EQ(one.cut.charts.size(), two.cut.charts.size());
  for (std::size_t c = 0; c < one.cut.charts.size(); ++c) {
    EXPECT_EQ(one.cut.charts[c].mesh.faces, two.cut.charts[c].mesh.faces);
    EXPECT_EQ(one.cut.charts[c].input_vertex, two.cut.charts[c].input_vertex);
  }
}

TEST(OpenMinimal, CanBeCancelledAnywhere) {
  const TriangleList mesh = meshes::torus(100);
  const Surface surface = build_surface(mesh.positions, mesh.faces, Work(1));
  const Topology topology = topology_of(surface, Work(1));
  const auto open = [&] { open_minimal(surface, topology, {}, Work(1)); };
  const std::int64_t polls = count_polls(open);
  EXPECT_GT(polls, 50);
  for (const std::int64_t last : {polls / 3, polls / 2, polls}) {
    EXPECT_THROW(count_polls(open, last), Cancelled);
  }
}

TEST(CutIntoCharts, SaysWhatIsNoDisk) {
  const Work work(1);
  const TriangleList mesh =
      meshes::together({meshes::torus(3), meshes::triangle(), meshes::annulus(5)});
  const Surface surface = build_surface(mesh.positions, mesh.faces, work);
  const CutSurface cut = cut_into_charts(surface, EdgeMarks(surface.twin.size(), false), work);
  ASSERT_EQ(cut.charts.size(), 1u);
  ASSERT_EQ(cut.non_disks.size(), 2u);
  EXPECT_EQ(cut.non_disks[0].genus, 1);
  EXPECT_EQ(cut.non_disks[0].loops, 0);
  EXPECT_EQ(cut.non_disks[0].faces.size(), 18u);
  EXPECT_EQ(cut.non_disks[1].loops, 2);
  EXPECT_EQ(cut.chart_of_face[18], 0);
  EXPECT_EQ(cut.chart_of_face[0], kNone);
}

TEST(CutIntoCharts, AVertexOccursOnceOnEachSideOfASeam) {
  const Work work(1);
  const TriangleList mesh = meshes::fan(6);
  const Surface surface = build_surface(mesh.positions, mesh.faces, work);
  EdgeMarks marks(surface.twin.size(), false);
  mark_edge(surface, 0, marks);  // from the hub to the rim: the hub stays one vertex
  const CutSurface slit = cut_into_charts(surface, marks, work);
  ASSERT_EQ(slit.charts.size(), 1u);
  EXPECT_EQ(slit.charts[0].mesh.vertex_count(), 8);
  mark_edge(surface, 9, marks);
  const CutSurface halves = cut_into_charts(surface, marks, work);
  ASSERT_EQ(halves.charts.size(), 2u);
  for (const Chart& chart : halves.charts) {
    EXPECT_EQ(std::count(chart.input_vertex.begin(), chart.input_vertex.end(), 0), 1);
  }
}

}  // namespace
}  // namespace beltrami
