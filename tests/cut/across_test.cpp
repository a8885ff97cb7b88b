// Paths across an annulus: they make a disk of it, and none is cheaper.
#include "cut/across.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

#include "base/work.h"
#include "cut/cut_into_charts.h"
#include "cut/open_minimal.h"
#include "cut/seam_costs.h"
#include "support/cuts.h"
#include "support/meshes.h"
#include "support/solids.h"
#include "support/surfaces.h"

namespace beltrami {
namespace {

using meshes::TriangleList;

constexpr double kAny = std::numeric_limits<double>::infinity();

Surface built(const TriangleList& mesh) {
  return build_surface(mesh.positions, mesh.faces, Work(1));
}

std::vector<bool> on_seams(const Surface& surface, const EdgeMarks& seams) {
  std::vector<bool> is_on = surface.on_boundary;
  for (Index h = 0; h < size_of(seams); ++h) {
    if (seams[h]) is_on[surface.origin(h)] = is_on[surface.target(h)] = true;
  }
  return is_on;
}

PathsAcross across(const Surface& surface, const EdgeMarks& seams,
                   const std::vector<double>& cost) {
  return {surface, seams, [is_on = on_seams(surface, seams)](Index v) { return is_on[v]; }, cost};
}

bool is_disk(const Surface& surface, const EdgeMarks& seams) {
  const CutSurface cut = cut_into_charts(surface, seams, Work(1));
  return cut.non_disks.empty() && cut.charts.size() == 1;
}

/// The seams of a disk without an arc between two vertices of other than two of them, by which an
/// annulus is left: the arc's half-edges in `arc`.
EdgeMarks without_an_arc(const Surface& surface, const EdgeMarks& seams, std::size_t which,
                         std::vector<Index>& arc) {
  std::vector<Index> degree(surface.positions.size(), 0);
  std::vector<Index> first;
  for (Index h = 0; h < size_of(seams); ++h) {
    if (seams[h]) ++degree[surface.origin(h)];
  }
  for (Index h = 0; h < size_of(seams); ++h) {
    if (seams[h] && degree[surface.origin(h)] != 2) first.push_back(h);
  }
  if (first.empty()) return {};
  EdgeMarks left = seams;
  for (Index h = first[which % first.size()]; h != kNone;) {
    arc.push_back(h);
    left[h] = left[surface.twin[h]] = false;
    const Index end = surface.target(h);
    Index on = kNone;
    if (degree[end] == 2) {
      surface.for_each_outgoing(end, [&](Index out) {
        if (left[out]) on = out;
      });
    }
    h = on;
  }
  return left;
}

TEST(PathAcross, OpensAHandleAgainAndAtNoMoreCost) {
  for (const TriangleList& mesh :
       {meshes::torus(10), meshes::shaken(meshes::double_torus(8), 0.05, 1)}) {
    const Surface surface = built(mesh);
    const std::vector<double> cost = edge_lengths(surface, Work(1));
    const EdgeMarks seams = open_minimal(surface, topology_of(surface, Work(1)), {}, Work(1));
    ASSERT_TRUE(is_disk(surface, seams));
    int opened = 0;
    for (std::size_t which = 0; which < 6; ++which) {
      std::vector<Index> arc;
      EdgeMarks left = without_an_arc(surface, seams, which, arc);
      ASSERT_FALSE(left.empty());
      double before = 0, after = 0;
      for (const Index h : arc) before += cost[h];
      const std::vector<Index> path =
          across(surface, left, cost).between_ends(arc.front(), surface.twin[arc.back()], kAny);
      ASSERT_FALSE(path.empty());
      for (const Index h : path) {
        after += cost[h];
        mark_edge(surface, h, left);
      }
      EXPECT_TRUE(is_disk(surface, left));
      EXPECT_LE(after, before * (1 + 1e-12));
      ++opened;
    }
    EXPECT_EQ(opened, 6);
  }
}

TEST(PathAcross, ThereIsNoneWhereAnArcPartedTwoCharts) {
  // A sphere in two halves: without the edge that parts them there it is one disk.
  const Surface surface = built(meshes::sphere(3));
  EdgeMarks seams(surface.twin.size(), false);
  for (Index h = 0; h < size_of(seams); ++h) {
    const auto upper = [&](Index face) {
      double z = 0;
      for (const Index v : surface.faces[face]) z += surface.positions[v].z();
      return z > 0.01;
    };
    seams[h] = upper(h / 3) != upper(surface.twin[h] / 3);
  }
  const Index arc = static_cast<Index>(std::find(seams.begin(), seams.end(), true) - seams.begin());
  ASSERT_LT(arc, size_of(seams));
  seams[arc] = seams[surface.twin[arc]] = false;
  const std::vector<double> cost = edge_lengths(surface, Work(1));
  EXPECT_TRUE(across(surface, seams, cost).between_ends(arc, surface.twin[arc], kAny).empty());
}

TEST(PathAcross, FindsTheWidthOfARing) {
  // Two borders: the shortest way is straight.
  const Surface surface = built(disks::refined(meshes::annulus(12), 2));
  const EdgeMarks none(surface.twin.size(), false);
  const Index side = static_cast<Index>(std::find(surface.twin.begin(), surface.twin.end(), kNone) -
                                        surface.twin.begin());
  const std::vector<double> cost = edge_lengths(surface, Work(1));
  const std::vector<Index> path = across(surface, none, cost).from_loop(side, kAny);
  EXPECT_EQ(path.size(), 4U);
  double length = 0;
  for (const Index h : path) length += cost[h];
  EXPECT_TRUE(across(surface, none, cost).from_loop(side, length).empty());
}

}  // namespace
}  // namespace beltrami
