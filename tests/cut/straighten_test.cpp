// Seams that come to lie at cheaper places and part the same.
#include "cut/straighten.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "base/interrupt.h"
#include "base/portable_math.h"
#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "cut/cut_into_charts.h"
#include "cut/edge_marks.h"
#include "cut/open_minimal.h"
#include "cut/turning.h"
#include "mesh/surface.h"
#include "simplify/coarse.h"
#include "simplify/history.h"
#include "simplify/simplify.h"
#include "support/cuts.h"
#include "support/meshes.h"
#include "support/polls.h"
#include "support/solids.h"
#include "support/surfaces.h"

namespace beltrami {
namespace {

using meshes::random_below;
using meshes::TriangleList;

Surface built(const TriangleList& mesh) {
  return build_surface(mesh.positions, mesh.faces, Work(1));
}

double length(const Surface& surface, Index h) {
  return (surface.positions[surface.target(h)] - surface.positions[surface.origin(h)]).norm();
}

std::vector<double> lengths(const Surface& surface) {
  std::vector<double> cost(surface.twin.size());
  for (Index h = 0; h < size_of(cost); ++h) cost[h] = length(surface, h);
  return cost;
}

/// From a hundredth to one, so that detours pay.
std::vector<double> random_cost(const Surface& surface, std::mt19937_64& generator) {
  std::vector<double> cost(surface.twin.size());
  for (Index h = 0; h < size_of(cost); ++h) {
    const double value = (1 + random_below(generator, 100)) / 100.0;
    if (surface.edge(h) != h) continue;
    cost[h] = value;
    if (surface.twin[h] != kNone) cost[surface.twin[h]] = value;
  }
  return cost;
}

double total(const Surface& surface, const EdgeMarks& marks, const std::vector<double>& cost) {
  double sum = 0;
  for (Index h = 0; h < size_of(cost); ++h) {
    if (marks[h] && surface.edge(h) == h) sum += cost[h];
  }
  return sum;
}

std::vector<Index> degrees(const Surface& surface, const EdgeMarks& marks) {
  std::vector<Index> degree(surface.positions.size(), 0);
  for (Index h = 0; h < size_of(surface.twin); ++h) {
    if (!marks[h] || surface.edge(h) != h) continue;
    ++degree[surface.origin(h)];
    ++degree[surface.target(h)];
  }
  return degree;
}

/// What a cut leaves: per piece its loops and handles, in an order of their own.
std::vector<std::array<Index, 2>> pieces(const Surface& surface, const EdgeMarks& marks) {
  const CutSurface cut = cut_into_charts(surface, marks, Work(1));
  std::vector<std::array<Index, 2>> shapes(cut.charts.size(), {1, 0});
  for (const NonDisk& piece : cut.non_disks) shapes.push_back({piece.loops, piece.genus});
  std::sort(shapes.begin(), shapes.end());
  return shapes;
}

/// How many corners pieces have at vertices that are not held and that three seams or more meet at.
/// A vertex of four seams is worth two of three.
Index corners(const std::vector<Index>& degree, const std::vector<bool>& is_held) {
  Index count = 0;
  for (std::size_t v = 0; v < degree.size(); ++v) {
    if (degree[v] > 2 && !is_held[v]) count += degree[v] - 2;
  }
  return count;
}

TriangleList without_faces(TriangleList mesh, Index every) {
  for (Index f = size_of(mesh.faces) - every; f > 0; f -= every) {
    mesh.faces.erase(mesh.faces.begin() + f);
  }
  return mesh;
}

std::vector<TriangleList> small_surfaces() {
  return {meshes::tetrahedron(),
          meshes::octahedron(),
          meshes::cube(),
          disks::refined(meshes::octahedron(), 1),
          disks::blob(3),
          meshes::torus(3),
          meshes::torus(5),
          meshes::torus(12),
          meshes::double_torus(5),
          meshes::double_torus(10),
          meshes::torus_with_hole(6),
          meshes::annulus(6),
          disks::refined(meshes::annulus(5), 2),
          meshes::fan(7),
          meshes::grid(4, 4),
          meshes::grid(12, 9),
          without_faces(meshes::grid(12, 10), 70),
          without_faces(disks::blob(3), 150),
          meshes::together({meshes::torus(5), disks::blob(2), meshes::grid(5, 5)})};
}

/// Walks that wander about, and now and then a tree that opens the surface: crossing each other,
/// closed, loose, between borders.
EdgeMarks random_seams(const Surface& surface, std::mt19937_64& generator) {
  const Work work(1);
  EdgeMarks marks(surface.twin.size(), false);
  if (random_below(generator, 2) == 0) {
    marks = open_minimal(surface, topology_of(surface, work), {}, work);
  }
  std::vector<Index> degree = degrees(surface, marks);
  const Index walks = random_below(generator, 4);
  for (Index walk = 0; walk < walks; ++walk) {
    Index v = surface.origin(random_below(generator, size_of(surface.twin)));
    for (Index step = 2 + random_below(generator, surface.vertex_count()); step > 0; --step) {
      std::vector<Index> ways;
      surface.for_each_outgoing(v, [&](Index h) {
        if (surface.twin[h] != kNone) ways.push_back(h);
      });
      if (ways.empty()) break;
      const Index h = ways[random_below(generator, size_of(ways))];
      if (!marks[h]) {
        mark_edge(surface, h, marks);
        ++degree[v];
        ++degree[surface.target(h)];
      }
      v = surface.target(h);
      if (random_below(generator, 3) == 0 && degree[v] > 1) break;
    }
  }
  // The sides of an edge on its own are one again: none to begin with.
  for (Index h = 0; h < size_of(marks); ++h) {
    const Index a = surface.origin(h), b = surface.target(h);
    const auto is_loose = [&](Index w) { return degree[w] == 1 && !surface.on_boundary[w]; };
    if (marks[h] && is_loose(a) && is_loose(b)) marks[h] = false;
  }
  return marks;
}

/// Marks each with a chance of one in `chance`; the two half-edges of an edge alike.
EdgeMarks random_marks(const Surface& surface, Index chance, std::mt19937_64& generator) {
  EdgeMarks marks(surface.twin.size(), false);
  for (Index h = 0; h < size_of(marks); ++h) {
    if (random_below(generator, chance) == 0) mark_edge(surface, h, marks);
  }
  return marks;
}

void expect_straightened(const Surface& surface, const EdgeMarks& seams,
                         const std::vector<double>& cost, const std::vector<bool>& anchored,
                         const EdgeMarks& locked, double straightness = 0) {
  const EdgeMarks moved = straighten(surface, seams, cost, anchored, locked, straightness, Work(1));
  EXPECT_EQ(pieces(surface, moved), pieces(surface, seams));
  if (straightness == 0) {
    EXPECT_LE(total(surface, moved, cost), total(surface, seams, cost) * (1 + 1e-12));
  }
  const std::vector<Index> before = degrees(surface, seams), after = degrees(surface, moved);
  std::vector<bool> held(before.size());
  for (Index v = 0; v < surface.vertex_count(); ++v) {
    const bool is_anchored = !anchored.empty() && anchored[v] && before[v] > 0;
    held[v] = surface.on_boundary[v] || is_anchored;
    if (before[v] == 1 || held[v]) {
      EXPECT_EQ(after[v], before[v]);
    } else {
      EXPECT_NE(after[v], 1);
    }
  }
  EXPECT_EQ(corners(after, held), corners(before, held));
  for (Index h = 0; h < size_of(moved); ++h) {
    if (moved[h] && !seams[h]) {
      EXPECT_TRUE(locked.empty() || !locked[h]);
      EXPECT_NE(surface.twin[h], kNone);
    }
    if (surface.twin[h] != kNone) {
      EXPECT_EQ(moved[h], moved[surface.twin[h]]);
    }
  }
}

TEST(Straighten, KeepsWhatSeamsPart) {
  constexpr Index kRounds = 40;
  const std::vector<TriangleList> all = small_surfaces();
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Surface surface = built(all[i]);
    for (Index seed = 0; seed < kRounds; ++seed) {
      SCOPED_TRACE("surface " + std::to_string(i) + ", seed " + std::to_string(seed));
      std::mt19937_64 generator(static_cast<std::uint64_t>(seed));
      const EdgeMarks seams = random_seams(surface, generator);
      const std::vector<double> cost =
          seed % 2 == 0 ? random_cost(surface, generator) : lengths(surface);
      std::vector<bool> anchored;
      EdgeMarks locked;
      if (seed % 3 == 1) locked = random_marks(surface, 5, generator);
      if (seed % 3 == 2) {
        anchored.resize(surface.positions.size());
        for (Index v = 0; v < size_of(anchored); ++v) anchored[v] = random_below(generator, 8) == 0;
      }
      expect_straightened(surface, seams, cost, anchored, locked);
      expect_straightened(surface, seams, cost, anchored, locked, 1);
      if (testing::Test::HasFailure()) return;
    }
  }
}

/// The edge from `a` to `b`.
Index halfedge_between(const Surface& surface, Index a, Index b) {
  Index found = kNone;
  surface.for_each_outgoing(a, [&](Index h) {
    if (surface.target(h) == b) found = h;
  });
  return found;
}

EdgeMarks marked_path(const Surface& surface, const std::vector<Index>& vertices) {
  EdgeMarks marks(surface.twin.size(), false);
  for (std::size_t i = 0; i + 1 < vertices.size(); ++i) {
    mark_edge(surface, halfedge_between(surface, vertices[i], vertices[i + 1]), marks);
  }
  return marks;
}

/// Across a sheet of 100 by 20 cells, up and down by 8 cells at every other step.
std::vector<Index> zigzag() {
  std::vector<Index> path;
  const auto walk_to = [&](Index i, Index j) {
    const Index end = j * 101 + i;
    while (path.back() != end) {
      const Index row = path.back() / 101, column = path.back() % 101;
      path.push_back(path.back() + (row < j ? 101 : row > j ? -101 : column < i ? 1 : -1));
    }
  };
  path.push_back(10 * 101 + 2);
  for (Index i = 2; i < 98; i += 4) {
    walk_to(i, 14);
    walk_to(i + 2, 14);
    walk_to(i + 2, 6);
    walk_to(i + 4, 6);
  }
  walk_to(98, 10);
  return path;
}

/// Across the same sheet, up by a cell at every eighth step.
std::vector<Index> stairs() {
  std::vector<Index> path = {4 * 101 + 2};
  for (Index i = 3; i <= 98; ++i) {
    path.push_back(path.back() + 1);
    if (i % 8 == 0) path.push_back(path.back() + 101);
  }
  return path;
}

TEST(Straighten, AZigzagBecomesStraight) {
  const Surface surface = built(meshes::grid(100, 20));
  const EdgeMarks seams = marked_path(surface, zigzag());
  const std::vector<double> cost = lengths(surface);
  const EdgeMarks moved = straighten(surface, seams, cost, {}, {}, 0, Work(1));
  EXPECT_GT(total(surface, seams, cost), 3);
  EXPECT_NEAR(total(surface, moved, cost), 0.96, 1e-9);
}

TEST(Straighten, AnAnchoredVertexStaysOnItsSeam) {
  const Surface surface = built(meshes::grid(100, 20));
  const std::vector<Index> path = zigzag();
  std::vector<bool> anchored(surface.positions.size(), false);
  const Index corner = path[path.size() / 2];
  anchored[corner] = true;
  const EdgeMarks moved =
      straighten(surface, marked_path(surface, path), lengths(surface), anchored, {}, 0, Work(1));
  EXPECT_EQ(degrees(surface, moved)[corner], 2);
}

TEST(Straighten, ASlitKeepsTwoEdges) {
  // Its ends are neighbours: as one edge it would part nothing.
  const Surface surface = built(meshes::octahedron());
  const EdgeMarks slit = marked_path(surface, {0, 1, 2, 4});
  const EdgeMarks moved = straighten(surface, slit, lengths(surface), {}, {}, 0, Work(1));
  EXPECT_NEAR(total(surface, moved, lengths(surface)), 2 * std::sqrt(2), 1e-12);
  EXPECT_EQ(pieces(surface, moved), pieces(surface, slit));
}

TEST(Straighten, ALoopAroundATubeBecomesShortWhereverItBegan) {
  // Around the tube, on the outside of a torus of radii 2 and 1, and along it for a part.
  const Surface surface = built(meshes::torus(40));
  std::vector<Index> loop;
  for (Index j = 0; j < 40; ++j) {
    const Index i = j < 20 ? j : 40 - j;
    const Index before = j <= 20 ? i - 1 : i + 1;
    if (j > 0) loop.push_back(j * 40 + before);
    loop.push_back(j * 40 + i);
  }
  loop.push_back(1);
  loop.push_back(0);
  const EdgeMarks seams = marked_path(surface, loop);
  const std::vector<double> cost = lengths(surface);
  const EdgeMarks moved = straighten(surface, seams, cost, {}, {}, 0, Work(1));
  EXPECT_GT(total(surface, seams, cost), 12);
  EXPECT_LT(total(surface, moved, cost), 2 * std::numbers::pi);
  EXPECT_EQ(pieces(surface, moved), pieces(surface, seams));
}

/// `n` by `n` vertices of equilateral triangles with sides of length one: rows run along x, each by
/// a half further than the one before.
TriangleList triangular(Index n) {
  TriangleList mesh;
  for (Index j = 0; j < n; ++j) {
    for (Index i = 0; i < n; ++i) mesh.positions.push_back({i + j / 2.0, j * std::sqrt(0.75), 0});
  }
  for (Index j = 0; j + 1 < n; ++j) {
    for (Index i = 0; i + 1 < n; ++i) {
      const Index a = j * n + i;
      mesh.faces.push_back({a, a + 1, a + n});
      mesh.faces.push_back({a + 1, a + n + 1, a + n});
    }
  }
  return mesh;
}

/// Paths from `centre`, each by steps of one distance between numbers of vertices after another.
EdgeMarks marked_star(const Surface& surface, Index centre,
                      const std::vector<std::vector<std::array<Index, 2>>>& branches) {
  EdgeMarks marks(surface.twin.size(), false);
  for (const std::vector<std::array<Index, 2>>& branch : branches) {
    std::vector<Index> path{centre};
    for (const auto& [by, times] : branch) {
      for (Index i = 0; i < times; ++i) path.push_back(path.back() + by);
    }
    const EdgeMarks more = marked_path(surface, path);
    for (Index h = 0; h < size_of(marks); ++h) marks[h] = marks[h] || more[h];
  }
  return marks;
}

TEST(Straighten, TheNodeOfATMoves) {
  // The arms are a shortest path between their ends, and the stem is one to them. But others are as
  // short, and come nearer to the end of the stem.
  const Index n = 61;
  const Surface surface = built(triangular(n));
  const std::vector<double> cost = lengths(surface);
  const Index left = 20 * n + 10, centre = left + 5;
  const EdgeMarks seams = marked_star(surface, centre, {{{-1, 5}}, {{1, 15}, {n, 10}}, {{n, 15}}});
  const EdgeMarks moved = straighten(surface, seams, cost, {}, {}, 0, Work(1));
  expect_straightened(surface, seams, cost, {}, {});
  EXPECT_NEAR(total(surface, seams, cost), 45, 1e-9);
  EXPECT_NEAR(total(surface, moved, cost), 35, 1e-9);
  EXPECT_EQ(degrees(surface, moved)[centre], 0);
}

TEST(Straighten, ThreeEndsMeetWhereTheirWaysAreLeast) {
  const Index n = 61;
  const Surface surface = built(triangular(n));
  const std::vector<double> cost = lengths(surface);
  // Ends at equal distances in directions 120 degrees apart, which lead along edges; their node is
  // far away.
  const Index centre = 30 * n + 30, off = centre + 9;
  const std::vector<Index> ends{centre + 20, centre + 20 * (n - 1), centre - 20 * n};
  const EdgeMarks seams =
      marked_star(surface, off, {{{1, 11}}, {{n - 1, 20}, {-1, 9}}, {{-1, 9}, {-n, 20}}});
  for (const Index v : ends) EXPECT_EQ(degrees(surface, seams)[v], 1);
  const EdgeMarks moved = straighten(surface, seams, cost, {}, {}, 0, Work(1));
  expect_straightened(surface, seams, cost, {}, {});
  EXPECT_NEAR(total(surface, moved, cost), 60, 1e-9);
  EXPECT_EQ(degrees(surface, moved)[centre], 3);
}

TEST(Straighten, AnAnchoredNodeStays) {
  const Index n = 61;
  const Surface surface = built(triangular(n));
  const Index off = 30 * n + 39;
  const EdgeMarks seams =
      marked_star(surface, off, {{{1, 11}}, {{n - 1, 20}, {-1, 9}}, {{-1, 9}, {-n, 20}}});
  std::vector<bool> anchored(surface.positions.size(), false);
  anchored[off] = true;
  const EdgeMarks moved = straighten(surface, seams, lengths(surface), anchored, {}, 0, Work(1));
  EXPECT_EQ(degrees(surface, moved)[off], 3);
}

TEST(Straighten, ANodeOfFourBecomesTwo) {
  // The diagonals of a long rectangle: its least tree has two nodes.
  const Index n = 61;
  const Surface surface = built(triangular(n));
  const std::vector<double> cost = lengths(surface);
  const Index centre = 30 * n + 30;
  const EdgeMarks seams = marked_star(
      surface, centre,
      {{{n, 6}, {1, 15}}, {{n - 1, 6}, {-1, 9}}, {{-n, 6}, {-1, 15}}, {{1 - n, 6}, {1, 9}}});
  const EdgeMarks moved = straighten(surface, seams, cost, {}, {}, 0, Work(1));
  expect_straightened(surface, seams, cost, {}, {});
  const std::vector<Index> degree = degrees(surface, moved);
  EXPECT_EQ(std::count(degree.begin(), degree.end(), 3), 2);
  EXPECT_EQ(std::count(degree.begin(), degree.end(), 4), 0);
  EXPECT_NEAR(total(surface, seams, cost), 72, 1e-9);
  EXPECT_NEAR(total(surface, moved, cost), 54, 1e-9);
}

TEST(Straighten, WhatIsCarriedFromACoarseSurfacePartsTheSameAndCostsLess) {
  const Work work(1);
  for (const TriangleList& mesh : {disks::blob(5), meshes::torus(40), meshes::double_torus(30)}) {
    const Surface fine = built(mesh);
    const CoarseSurface coarse =
        simplify_surface(fine, boundary_loops(fine, work), fine.face_count() / 12, work);
    const EdgeMarks cut = open_minimal(coarse.mesh, topology_of(coarse.mesh, work), {}, work);
    std::vector<std::array<Index, 2>> edges;
    for (Index h = 0; h < size_of(cut); ++h) {
      if (!cut[h] || coarse.mesh.edge(h) != h) continue;
      edges.push_back(
          {coarse.fine_vertex[coarse.mesh.origin(h)], coarse.fine_vertex[coarse.mesh.target(h)]});
    }
    EdgeMarks carried(fine.twin.size(), false);
    for (const auto& [a, b] : carry_edges(coarse.history, edges, fine.on_boundary, {})) {
      mark_edge(fine, halfedge_between(fine, a, b), carried);
    }
    expect_straightened(fine, carried, lengths(fine), {}, {});
    const EdgeMarks one = straighten(fine, carried, lengths(fine), {}, {}, 0, work);
    EXPECT_EQ(one, straighten(fine, carried, lengths(fine), {}, {}, 0, Work(2)));
    EXPECT_LT(total(fine, one, lengths(fine)), 0.99 * total(fine, carried, lengths(fine)));
  }
}

/// Of all turns of seams, `weight` as Turning has it: where two meet off the border and `anchored`.
double cost_of_turns(const Surface& surface, const EdgeMarks& seams,
                     const std::vector<double>& cost, const std::vector<bool>& anchored,
                     double weight) {
  const Turning turning(surface, cost, weight);
  double sum = 0;
  for (Index v = 0; v < surface.vertex_count(); ++v) {
    if (surface.outgoing[v] == kNone || surface.on_boundary[v] || anchored[v]) continue;
    std::array<Index, 2> two = {kNone, kNone};
    Index count = 0;
    surface.for_each_outgoing(v, [&](Index h) {
      if (seams[h] && count++ < 2) two[count - 1] = h;
    });
    if (count == 2) sum += turning.cost(surface.twin[two[0]], two[1]);
  }
  return sum;
}

/// Turns of seams, by the length of the edges there over that of all.
double turning(const Surface& surface, const EdgeMarks& seams) {
  const std::vector<bool> anchored(surface.positions.size(), false);
  const std::vector<double> cost = lengths(surface);
  return cost_of_turns(surface, seams, cost, anchored, 1) / total(surface, seams, cost);
}

TEST(Straighten, ATurnCostsWhatItTurns) {
  const Surface surface = built(meshes::grid(4, 4));
  const std::vector<double> cost = lengths(surface);
  const std::vector<bool> anchored(surface.positions.size(), false);
  const auto turns = [&](const std::vector<Index>& path) {
    return cost_of_turns(surface, marked_path(surface, path), cost, anchored, 2);
  };
  EXPECT_NEAR(turns({6, 7, 8}), 0, 1e-12);
  EXPECT_NEAR(turns({6, 7, 12}), 2 * cost[halfedge_between(surface, 6, 7)], 1e-12);
}

TEST(Straighten, SeamsTurnLessWhereTurnsCost) {
  // A sheet of irregular faces: flat, and rolled up to most of a cylinder, which changes no turn.
  const TriangleList grid = meshes::grid(100, 20);
  const double cell = (grid.positions[1] - grid.positions[0]).norm();
  const TriangleList shaken = meshes::moved(meshes::shaken(grid, 0.3 * cell, 7),
                                            [](const Vec3& p) { return Vec3(p.x(), p.y(), 0); });
  const TriangleList rolled = meshes::moved(shaken, [](const Vec3& p) {
    return Vec3(portable::sin(5 * p.x()) / 5, p.y(), portable::cos(5 * p.x()) / 5);
  });
  for (const TriangleList& mesh : {shaken, rolled}) {
    const Surface surface = built(mesh);
    const EdgeMarks seams = marked_path(surface, stairs());
    const std::vector<double> cost = lengths(surface);
    const EdgeMarks shortest = straighten(surface, seams, cost, {}, {}, 0, Work(1));
    const EdgeMarks straight = straighten(surface, seams, cost, {}, {}, 1, Work(1));
    EXPECT_EQ(pieces(surface, straight), pieces(surface, seams));
    EXPECT_LT(turning(surface, straight), 0.8 * turning(surface, shortest));
    EXPECT_LT(total(surface, straight, cost), 1.05 * total(surface, shortest, cost));
  }
}

TEST(Straighten, CanBeCancelledAnywhere) {
  const Surface surface = built(meshes::grid(100, 20));
  const EdgeMarks seams = marked_path(surface, zigzag());
  const std::vector<double> cost = lengths(surface);
  const auto run = [&] { straighten(surface, seams, cost, {}, {}, 0, Work(1)); };
  const std::int64_t polls = count_polls(run);
  EXPECT_GT(polls, 0);
  EXPECT_THROW(count_polls(run, polls), Cancelled);
}

}  // namespace
}  // namespace beltrami
