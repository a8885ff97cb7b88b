// Seams without which what they join falls apart.
#include "cut/bridges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "base/types.h"
#include "base/work.h"
#include "cut/edge_marks.h"
#include "mesh/surface.h"
#include "support/meshes.h"
#include "support/surfaces.h"

namespace beltrami {
namespace {

using meshes::random_below;
using meshes::TriangleList;

bool is_one(const Surface& surface, const EdgeMarks& seams, Index h) {
  return seams[h] || surface.twin[h] == kNone;
}

/// Whether seams and borders lead from one end of a half-edge to the other without it.
bool joined_without(const Surface& surface, const EdgeMarks& seams, Index without) {
  std::vector<bool> reached(surface.outgoing.size(), false);
  reached[surface.origin(without)] = true;
  for (bool more = true; more;) {
    more = false;
    for (Index h = 0; h < size_of(seams); ++h) {
      if (!is_one(surface, seams, h) || h == without || h == surface.twin[without]) continue;
      const Index a = surface.origin(h), b = surface.target(h);
      if (reached[a] == reached[b]) continue;
      reached[a] = reached[b] = more = true;
    }
  }
  return reached[surface.target(without)];
}

void expect_those_of_trying_each(const Surface& surface, const EdgeMarks& seams) {
  const std::vector<bool> found = bridges(surface, seams);
  for (Index h = 0; h < size_of(seams); ++h) {
    const bool is_bridge = seams[h] && !joined_without(surface, seams, h);
    EXPECT_EQ(found[h], is_bridge) << "half-edge " << h;
  }
}

TEST(Bridges, AreThoseOfTryingEachSeamOnClosedAndOpenSurfaces) {
  std::mt19937_64 random(56);
  for (const TriangleList& mesh : {meshes::torus(5), meshes::grid(4, 4), meshes::annulus(9)}) {
    const Surface surface = build_surface(mesh.positions, mesh.faces, Work(1));
    for (const int one_of : {2, 3, 5}) {
      EdgeMarks seams(surface.twin.size(), false);
      for (Index h = 0; h < size_of(seams); ++h) {
        const bool is_inner = surface.twin[h] != kNone;
        if (is_inner && random_below(random, one_of) == 0) mark_edge(surface, h, seams);
      }
      expect_those_of_trying_each(surface, seams);
    }
  }
}

TEST(Bridges, AreAllSeamsOfATreeAndNoneOfALoop) {
  const TriangleList mesh = meshes::torus(6);
  const Surface surface = build_surface(mesh.positions, mesh.faces, Work(1));
  // The edges of one row of vertices go round the torus.
  EdgeMarks loop(surface.twin.size(), false);
  for (Index h = 0; h < size_of(loop); ++h) {
    const Index a = surface.origin(h), b = surface.target(h);
    if (a < 6 && b < 6) mark_edge(surface, h, loop);
  }
  const std::vector<bool> none = bridges(surface, loop);
  EXPECT_EQ(std::count(none.begin(), none.end(), true), 0);
  EdgeMarks tree = loop;
  const auto first = static_cast<Index>(std::find(loop.begin(), loop.end(), true) - loop.begin());
  tree[first] = tree[surface.twin[first]] = false;
  EXPECT_EQ(bridges(surface, tree), tree);
}

}  // namespace
}  // namespace beltrami
