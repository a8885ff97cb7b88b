// What charts inherit of the collapses of the surface that they were cut out of.
#include "simplify/replay.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "base/types.h"
#include "base/work.h"
#include "cut/cut_into_charts.h"
#include "cut/open_minimal.h"
#include "mesh/chart.h"
#include "mesh/disk_mesh.h"
#include "mesh/surface.h"
#include "simplify/simplify.h"
#include "support/cuts.h"
#include "support/meshes.h"
#include "support/surfaces.h"

namespace beltrami {
namespace {

using meshes::TriangleList;

/// A surface, what collapses made of it, and the charts of a cut that these know nothing of.
struct Simplified {
  Surface surface;
  CoarseSurface coarse;
  std::vector<Chart> charts;
  std::vector<Index> step_of;

  explicit Simplified(const TriangleList& mesh, Index part) {
    const Work work(1);
    surface = build_surface(mesh.positions, mesh.faces, work);
    const Topology topology = topology_of(surface, work);
    coarse = simplify_surface(surface, topology.loops, surface.face_count() / part, work);
    charts = cut_into_charts(surface, open_minimal(surface, topology, {}, work), work).charts;
    std::vector<bool> kept(surface.positions.size(), false);
    for (const Chart& chart : charts) {
      for (const Index v : chart.mesh.boundary) kept[chart.input_vertex[v]] = true;
    }
    step_of = repeatable_steps(coarse.history, kept);
  }

  /// What the first `steps` leave of a chart.
  CoarseDisk level(const Chart& chart, Index steps) const {
    std::vector<Index> vertex(surface.positions.size(), kNone), into;
    for (Index v = 0; v < size_of(chart.input_vertex); ++v) vertex[chart.input_vertex[v]] = v;
    for (Index v = 0; v < size_of(chart.input_vertex); ++v) {
      const Index step = step_of[chart.input_vertex[v]];
      const bool goes = step != kNone && step < steps;
      into.push_back(goes ? vertex[coarse.history.steps[step].target] : v);
    }
    return collapsed_disk(chart.mesh, into, Work(1));
  }
};

std::vector<TriangleList> surfaces() {
  TriangleList perforated = disks::blob(4);
  for (const Index f : {1500, 900, 300}) perforated.faces.erase(perforated.faces.begin() + f);
  return {disks::blob(4),
          disks::blob(5),
          meshes::torus(40),
          meshes::double_torus(30),
          perforated,
          meshes::grid(50, 40),
          meshes::bumps(40, 40),
          meshes::together({meshes::torus(24), disks::blob(4)})};
}

void expect_level_of(const DiskMesh& fine, const CoarseDisk& level, bool whole_boundary) {
  std::vector<Index> boundary;
  for (const Index v : level.mesh.boundary) boundary.push_back(level.fine_vertex[v]);
  if (whole_boundary) {
    const auto first = std::find(fine.boundary.begin(), fine.boundary.end(), boundary.front());
    std::vector<Index> expected = fine.boundary;
    std::rotate(expected.begin(), expected.begin() + (first - fine.boundary.begin()),
                expected.end());
    EXPECT_EQ(boundary, expected);
  }
  EXPECT_TRUE(std::is_sorted(level.fine_vertex.begin(), level.fine_vertex.end()));
  ASSERT_EQ(level.nearby.size(), fine.positions.size());
  for (Index v = 0; v < level.mesh.vertex_count(); ++v) {
    EXPECT_EQ(level.mesh.positions[v], fine.positions[level.fine_vertex[v]]);
    EXPECT_EQ(level.nearby[level.fine_vertex[v]], v);
    EXPECT_TRUE(!level.mesh.on_boundary[v] || fine.on_boundary[level.fine_vertex[v]]);
  }
}

TEST(Replay, LeavesDisksWithTheirWholeBoundaryHoweverFarItGoes) {
  for (const TriangleList& mesh : surfaces()) {
    for (const Index part : {6, 40}) {
      const Simplified simplified(mesh, part);
      const Index all = size_of(simplified.coarse.history.steps);
      for (const Chart& chart : simplified.charts) {
        Index faces = chart.mesh.face_count();
        for (const Index steps : {0, all / 3, 2 * all / 3, all}) {
          const CoarseDisk level = simplified.level(chart, steps);
          expect_level_of(chart.mesh, level, true);
          EXPECT_LE(level.mesh.face_count(), faces);
          faces = level.mesh.face_count();
        }
      }
    }
  }
}

TEST(Replay, LeavesFewFacesAwayFromSeams) {
  const Simplified simplified(disks::blob(6), 40);
  ASSERT_EQ(simplified.charts.size(), 1);
  const CoarseDisk level =
      simplified.level(simplified.charts[0], size_of(simplified.coarse.history.steps));
  EXPECT_LT(level.mesh.face_count(), simplified.surface.face_count() / 3);
}

TEST(Replay, RepeatsAllWhereNothingIsKept) {
  const Simplified simplified(disks::blob(4), 20);
  const auto& steps = simplified.coarse.history.steps;
  const std::vector<bool> none(simplified.surface.positions.size(), false);
  const std::vector<Index> step_of = repeatable_steps(simplified.coarse.history, none);
  for (Index s = 0; s < size_of(steps); ++s) EXPECT_EQ(step_of[steps[s].vertex], s);
}

TEST(Replay, SimplifyingGoesOnFromALevel) {
  const Simplified simplified(disks::blob(5), 20);
  const DiskMesh& fine = simplified.charts[0].mesh;
  const CoarseDisk level = simplified.level(simplified.charts[0], 8000);
  const CoarseDisk coarse = simplify_further(level, 1000, Work(1));
  EXPECT_LE(coarse.mesh.face_count(), 1000);
  expect_level_of(fine, coarse, false);
}

}  // namespace
}  // namespace beltrami
