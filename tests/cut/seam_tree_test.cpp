// Seams that grow, shrink and are joined anew, and leave the same disks.
#include "cut/seam_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "base/vectors.h"
#include "cut/cut_into_charts.h"
#include "cut/open_minimal.h"
#include "cut/seam_costs.h"
#include "cut/seam_paths.h"
#include "cut/straighten.h"
#include "support/cuts.h"
#include "support/meshes.h"
#include "support/solids.h"
#include "support/surfaces.h"

namespace beltrami {
namespace {

using meshes::random_below;
using meshes::TriangleList;

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr double kAnyLength = 0;
constexpr double kLeastCost = 0.02;

Surface built(const TriangleList& mesh) {
  return build_surface(mesh.positions, mesh.faces, Work(1));
}

void set_cost(const Surface& surface, Index h, double value, std::vector<double>& cost) {
  cost[h] = value;
  if (surface.twin[h] != kNone) cost[surface.twin[h]] = value;
}

/// Lengths, made so many times longer at most.
std::vector<double> random_cost(const Surface& surface, double spread, std::mt19937_64& generator) {
  std::vector<double> cost = edge_lengths(surface, Work(1));
  for (Index h = 0; h < size_of(cost); ++h) {
    const double factor = 1 + (spread - 1) * random_below(generator, 100) / 100;
    if (surface.edge(h) == h) set_cost(surface, h, cost[h] * factor, cost);
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

// ---- Paths ----------------------------------------------------------------------------------

std::vector<double> bellman_ford(const Surface& surface, const std::vector<bool>& is_root,
                                 const std::vector<double>& cost) {
  std::vector<double> reached(is_root.size(), kNever);
  for (std::size_t v = 0; v < is_root.size(); ++v) {
    if (is_root[v]) reached[v] = 0;
  }
  for (bool changed = true; changed;) {
    changed = false;
    for (Index h = 0; h < size_of(cost); ++h) {
      for (const auto& [a, b] : {std::pair(surface.origin(h), surface.target(h)),
                                 std::pair(surface.target(h), surface.origin(h))}) {
        if (!(reached[a] + cost[h] < reached[b])) continue;
        reached[b] = reached[a] + cost[h];
        changed = true;
      }
    }
  }
  return reached;
}

void expect_paths(const Surface& surface, const std::vector<bool>& root,
                  const std::vector<double>& cost) {
  const SeamPaths paths(surface, root, cost, kNever);
  EXPECT_EQ(paths.costs(), bellman_ford(surface, root, cost));
  for (Index v = 0; v < surface.vertex_count(); ++v) {
    const SeamPath path = paths.from(v);
    EXPECT_EQ(path.cost, paths.costs()[v]);
    ASSERT_EQ(path.halfedges.size(), path.vertices.size());
    EXPECT_EQ(path.halfedges.empty(), root[v] || path.cost == kNever);
    double sum = 0;
    Index at = v;
    for (std::size_t i = 0; i < path.halfedges.size(); ++i) {
      const Index h = path.halfedges[i];
      EXPECT_EQ(path.vertices[i], at);
      EXPECT_FALSE(root[at]);
      ASSERT_TRUE(surface.origin(h) == at || surface.target(h) == at);
      at = surface.origin(h) == at ? surface.target(h) : surface.origin(h);
      sum += cost[h];
    }
    if (path.cost == kNever) continue;
    EXPECT_TRUE(root[at]);
    EXPECT_NEAR(sum, path.cost, 1e-12 * sum);
  }
}

TEST(SeamPaths, AreTheCheapest) {
  std::mt19937_64 generator(1);
  for (const TriangleList& mesh :
       {meshes::octahedron(), meshes::torus(5), meshes::grid(6, 5), meshes::annulus(7),
        meshes::together({meshes::torus(4), meshes::bumps(5, 4), meshes::cube()})}) {
    const Surface surface = built(mesh);
    for (int trial = 0; trial < 5; ++trial) {
      std::vector<double> cost = random_cost(surface, 5, generator);
      for (Index h = 0; h < size_of(cost); ++h) {
        if (random_below(generator, 4) < trial - 1) set_cost(surface, h, kNever, cost);
      }
      std::vector<bool> root(surface.positions.size(), false);
      for (int i = 0; i < 3; ++i) root[random_below(generator, size_of(root))] = true;
      expect_paths(surface, root, cost);
      SeamPaths paths(surface, root, cost, kNever);
      const Index more = random_below(generator, size_of(root));
      if (root[more]) continue;
      paths.add_roots({&more, 1});
      root[more] = true;
      EXPECT_EQ(paths.costs(), bellman_ford(surface, root, cost));
    }
  }
}

TEST(SeamPaths, EndAtTheNearestGoal) {
  std::mt19937_64 generator(2);
  for (const TriangleList& mesh : {meshes::torus(5), meshes::grid(6, 5)}) {
    const Surface surface = built(mesh);
    const std::vector<double> cost = random_cost(surface, 5, generator);
    std::vector<bool> root(surface.positions.size(), false), goal = root;
    root[0] = true;
    const std::vector<double> reached = bellman_ford(surface, root, cost);
    for (int i = 0; i < 4; ++i) goal[1 + random_below(generator, size_of(root) - 1)] = true;
    double least = kNever;
    for (Index v = 0; v < surface.vertex_count(); ++v) {
      if (goal[v]) least = std::min(least, reached[v]);
    }
    const SeamPaths paths(surface, root, cost, kNever, &goal);
    ASSERT_TRUE(goal[paths.reached()]);
    EXPECT_EQ(paths.from(paths.reached()).cost, least);
    EXPECT_EQ(SeamPaths(surface, root, cost, 0.5 * least, &goal).reached(), kNone);
  }
}

TEST(SeamPaths, AlongTheBorderAsWell) {
  // All but the border of a strip is closed.
  const Surface surface = built(meshes::strip(5));
  std::vector<double> cost(surface.twin.size(), kNever);
  for (Index h = 0; h < size_of(cost); ++h) {
    if (surface.twin[h] == kNone) cost[h] = 1;
  }
  std::vector<bool> root(surface.positions.size(), false);
  root[0] = true;
  expect_paths(surface, root, cost);
  const std::vector<double> costs = SeamPaths(surface, root, cost, kNever).costs();
  EXPECT_EQ(*std::max_element(costs.begin(), costs.end()), 6);
}

// ---- Search ---------------------------------------------------------------------------------

TriangleList without_faces(TriangleList mesh, Index every) {
  for (Index f = size_of(mesh.faces) - every; f > 0; f -= every) {
    mesh.faces.erase(mesh.faces.begin() + f);
  }
  return mesh;
}

/// A torus joined to a double torus by a face of each: genus 3.
TriangleList triple_torus() {
  const TriangleList left = meshes::double_torus(6), right = meshes::torus(6);
  constexpr Index kFace = 20;
  TriangleList mesh = left;
  const Index first = size_of(left.positions);
  mesh.positions.insert(mesh.positions.end(), right.positions.begin(), right.positions.end());
  for (Index f = 0; f < size_of(right.faces); ++f) {
    if (f == kFace) continue;
    // Inside out, so that its hole runs as the other one.
    Triangle face = {right.faces[f][0], right.faces[f][2], right.faces[f][1]};
    for (Index& v : face) {
      const auto rim = std::find(right.faces[kFace].begin(), right.faces[kFace].end(), v);
      const auto k = rim - right.faces[kFace].begin();
      v = k < 3 ? left.faces[kFace][k] : first + v;
    }
    mesh.faces.push_back(face);
  }
  mesh.faces.erase(mesh.faces.begin() + kFace);
  return mesh;
}

/// Closed ones of genus 0 to 3, with borders, in pieces, the smallest that there are.
std::vector<TriangleList> surfaces() {
  const TriangleList tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                 {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
  return {tetrahedron,
          meshes::octahedron(),
          meshes::cube(),
          disks::refined(meshes::octahedron(), 1),
          meshes::torus(3),
          meshes::torus(6),
          meshes::shaken(meshes::double_torus(5), 0.1, 1),
          meshes::shaken(triple_torus(), 0.1, 2),
          meshes::annulus(6),
          meshes::grid(4, 3),
          meshes::bumps(9, 8),
          meshes::torus_with_hole(5),
          without_faces(disks::blob(3), 130),
          disks::blob(3),
          meshes::together({meshes::torus(5), disks::blob(2), meshes::bumps(5, 5), tetrahedron})};
}

/// What a search starts from, and what is to be true of it all the time.
struct Trial {
  Trial(const TriangleList& mesh, double spread, std::mt19937_64& generator)
      : surface(built(mesh)), cost(random_cost(surface, spread, generator)) {}

  EdgeMarks opened(const EdgeMarks& locked = {}) const {
    return open_minimal(surface, topology_of(surface, Work(1)), locked, Work(1));
  }

  std::size_t charts(const EdgeMarks& seams) const {
    const CutSurface cut = cut_into_charts(surface, seams, Work(1));
    EXPECT_TRUE(cut.non_disks.empty());
    return cut.charts.size();
  }

  void expect_sound(const SeamTree& search, std::size_t pieces) const {
    EXPECT_EQ(charts(search.seams()), pieces);
    const double sum = total(surface, search.seams(), cost);
    EXPECT_NEAR(search.cost(), sum, 1e-9 * (1 + sum));
    for (Index h = 0; h < size_of(cost); ++h) {
      if (surface.twin[h] == kNone) continue;
      EXPECT_EQ(search.seams()[h], search.seams()[surface.twin[h]]);
    }
  }

  Surface surface;
  std::vector<double> cost;
};

/// A step that is chosen at random, and what it promises.
void step(const Trial& trial, SeamTree& search, std::mt19937_64& generator) {
  constexpr double kTargets[] = {2.001, 2.01, 2.05, 2.2, 2.6, 4, 20};
  const double target = kTargets[random_below(generator, 7)];
  const double energy = search.energy(), cost = search.cost();
  switch (random_below(generator, 7)) {
    case 0: {
      const bool reached = search.extend(target, random_below(generator, 2) == 0);
      EXPECT_EQ(reached, search.energy() <= target);
      EXPECT_LE(search.energy(), energy);
      break;
    }
    case 1:
      search.shrink(target);
      EXPECT_LE(search.energy(), std::max(target, energy) + 1e-6);
      EXPECT_LE(search.cost(), cost + 1e-9);
      break;
    case 2:
      search.reconnect();
      EXPECT_LE(search.cost(), cost + 1e-9);
      break;
    case 3:
      search.reopen();
      EXPECT_LE(search.cost(), cost + 1e-9);
      break;
    case 4:
      search.exchange(std::max(target, energy), 6);
      EXPECT_LE(search.energy(), std::max(target, energy) + 1e-6);
      EXPECT_LE(search.cost(), cost + 1e-9);
      break;
    case 5: {
      const bool went = search.ruin(static_cast<int>(random_below(generator, 50)), 3);
      EXPECT_GE(search.energy(), energy - 1e-6);
      EXPECT_EQ(search.cost() < cost, went);
      break;
    }
    default:
      search.take(
          straighten(trial.surface, search.seams(), trial.cost, search.anchors(), {}, 0, Work(1)));
      EXPECT_LE(search.cost(), cost + 1e-9);
  }
}

TEST(SeamTree, KeepsThePiecesWhateverItDoes) {
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    std::mt19937_64 generator(seed);
    for (const TriangleList& mesh : surfaces()) {
      const Trial trial(mesh, seed % 2 == 0 ? 1.5 : 6, generator);
      const EdgeMarks seams = trial.opened();
      const std::size_t pieces = trial.charts(seams);
      SeamTree search(trial.surface, trial.surface.face_count(), trial.cost, seams, kAnyLength,
                      kLeastCost, Work(1));
      for (int i = 0; i < 16; ++i) {
        step(trial, search, generator);
        trial.expect_sound(search, pieces);
        if (testing::Test::HasFailure()) return;
      }
    }
  }
}

TEST(SeamTree, RuinsSoManyBranchesAndOthersInOtherRounds) {
  std::mt19937_64 generator(13);
  const Trial trial(disks::blob(3), 1, generator);
  SeamTree search(trial.surface, trial.surface.face_count(), trial.cost, trial.opened(), kAnyLength,
                  kLeastCost, Work(1));
  ASSERT_TRUE(search.extend(2.01));
  const EdgeMarks whole = search.seams();
  std::set<EdgeMarks> left;
  for (int round = 1; round <= 8; ++round) {
    double cost = search.cost();
    for (const int count : {1, 2, 4}) {
      search.take(whole);
      EXPECT_TRUE(search.ruin(round, count));
      EXPECT_LT(search.cost(), cost);
      cost = search.cost();
      for (std::size_t h = 0; h < whole.size(); ++h) EXPECT_LE(search.seams()[h], whole[h]);
    }
    left.insert(search.seams());
    search.take(whole);
  }
  EXPECT_GE(left.size(), 4);
}

TEST(SeamTree, ExtendsToAnyEnergyAskedForAndFallsOnTheWay) {
  std::mt19937_64 generator(5);
  for (const TriangleList& mesh : {disks::blob(3), meshes::torus(12), meshes::bumps(12, 12)}) {
    const Trial trial(mesh, 1, generator);
    SeamTree search(trial.surface, trial.surface.face_count(), trial.cost, trial.opened(),
                    kAnyLength, kLeastCost, Work(1));
    const EdgeMarks before = search.seams();
    double excess = search.energy() - 2;
    for (int i = 0; i < 4; ++i) {
      const double cost = search.cost();
      excess *= 0.5;
      EXPECT_TRUE(search.extend(2 + excess));
      EXPECT_LE(search.energy(), 2 + excess);
      EXPECT_GT(search.cost(), cost);
      excess = search.energy() - 2;
    }
    for (std::size_t h = 0; h < before.size(); ++h) EXPECT_TRUE(!before[h] || search.seams()[h]);
    // No more is to be had than every vertex on a seam.
    EXPECT_FALSE(search.extend(1.9));
    EXPECT_NEAR(search.energy(), 2, 1e-3);
  }
}

TEST(SeamTree, AnExactExtensionCostsNoMore) {
  std::mt19937_64 generator(12);
  for (const TriangleList& mesh : {disks::blob(3), meshes::torus(12), meshes::bumps(12, 12)}) {
    const Trial trial(mesh, 1, generator);
    SeamTree search(trial.surface, trial.surface.face_count(), trial.cost, trial.opened(),
                    kAnyLength, kLeastCost, Work(1));
    for (int i = 0; i < 6; ++i) {
      const EdgeMarks before = search.seams();
      const double cost = search.cost(), target = 2 + 0.9 * (search.energy() - 2);
      ASSERT_TRUE(search.extend(target));
      const double most = search.cost();
      search.take(before);
      ASSERT_TRUE(search.extend(target, true));
      EXPECT_LE(search.energy(), target);
      EXPECT_GT(search.cost(), cost);
      EXPECT_LE(search.cost(), most + 1e-9);
    }
  }
}

TEST(SeamTree, AnExtensionReachedDoesNothing) {
  std::mt19937_64 generator(6);
  const Trial trial(disks::blob(3), 1, generator);
  SeamTree search(trial.surface, trial.surface.face_count(), trial.cost, trial.opened(), kAnyLength,
                  kLeastCost, Work(1));
  ASSERT_TRUE(search.extend(2.1));
  const EdgeMarks seams = search.seams();
  EXPECT_TRUE(search.extend(search.energy()));
  EXPECT_EQ(search.seams(), seams);
}

TEST(SeamTree, ShrinksUpToTheEnergyAskedForAndNotBeyond) {
  std::mt19937_64 generator(7);
  for (const TriangleList& mesh : {disks::blob(3), meshes::torus(12), meshes::bumps(12, 12)}) {
    const Trial trial(mesh, 1, generator);
    SeamTree search(trial.surface, trial.surface.face_count(), trial.cost, trial.opened(),
                    kAnyLength, kLeastCost, Work(1));
    const double most = search.energy();
    search.extend(2 + 0.1 * (most - 2));
    const double least = search.energy(), cost = search.cost();
    const EdgeMarks before = search.seams();
    const double target = 2 + 0.4 * (most - 2);
    search.shrink(target);
    EXPECT_GE(search.energy(), least - 1e-9);
    EXPECT_LE(search.energy(), target + 1e-6);
    EXPECT_LT(search.cost(), cost);
    for (std::size_t h = 0; h < before.size(); ++h) EXPECT_TRUE(before[h] || !search.seams()[h]);
  }
}

TEST(SeamTree, JoinsPartsAnewWhereThatIsCheaper) {
  // Beside the seams it is cheaper.
  std::mt19937_64 generator(8);
  const Trial trial(disks::blob(3), 1, generator);
  const EdgeMarks seams = trial.opened();
  std::vector<double> cost = trial.cost;
  for (Index h = 0; h < size_of(cost); ++h) cost[h] *= seams[h] ? 10 : 1;
  SeamTree search(trial.surface, trial.surface.face_count(), cost, seams, kAnyLength, kLeastCost,
                  Work(1));
  const double before = search.cost();
  search.reconnect();
  EXPECT_LT(search.cost(), 0.5 * before);
  EXPECT_EQ(trial.charts(search.seams()), 1);
  EXPECT_NEAR(search.cost(), total(trial.surface, search.seams(), cost), 1e-9);
}

TEST(SeamTree, NeverLeavesAnEdgeAlone) {
  // Seams of two edges, the ends of which are neighbours.
  const Surface surface = built(surfaces().front());
  const std::vector<double> cost(surface.twin.size(), 1);
  std::vector<double> cheap = cost;
  EdgeMarks seams(surface.twin.size(), false);
  for (Index h = 0; h < size_of(seams); ++h) {
    const Index a = surface.origin(h), b = surface.target(h);
    seams[h] = a * b == 0 && a + b != 2;  // 1 - 0 - 3
    if (a * b == 3) cheap[h] = 0.1;
  }
  for (const std::vector<double>& costs : {cost, cheap}) {
    SeamTree search(surface, surface.face_count(), costs, seams, kAnyLength, kLeastCost, Work(1));
    ASSERT_EQ(search.cost(), 2);
    search.reconnect();
    search.shrink(1000);
    EXPECT_EQ(cut_into_charts(surface, search.seams(), Work(1)).charts.size(), 1);
    search.extend(2);
    search.shrink(1000);
    EXPECT_EQ(cut_into_charts(surface, search.seams(), Work(1)).charts.size(), 1);
  }
}

TEST(SeamTree, JoinsChartsAndKnowsWhatThatCosts) {
  std::mt19937_64 generator(11);
  int joined = 0;
  for (const TriangleList& mesh : {meshes::sphere(3), meshes::torus(9), meshes::bumps(12, 12)}) {
    const Trial trial(mesh, 0.5, generator);
    const Surface& surface = trial.surface;
    for (int round = 0; round < 20; ++round) {
      SeamTree search(surface, surface.face_count(), trial.cost, trial.opened(), 0, 0.02, Work(1));
      search.extend(2.02);
      EdgeMarks seams = search.seams();
      // A part of the surface is cut out: faces nearer to one place than to another.
      const Vec3 here = surface.positions[random_below(generator, surface.vertex_count())];
      const Vec3 there = surface.positions[random_below(generator, surface.vertex_count())];
      const auto is_in = [&](Index face) {
        const Vec3 p = surface.positions[surface.faces[face][0]];
        return (p - here).norm() < (p - there).norm();
      };
      for (Index h = 0; h < size_of(seams); ++h) {
        const Index twin = surface.twin[h];
        if (twin != kNone && is_in(h / 3) != is_in(twin / 3)) mark_edge(surface, h, seams);
      }
      const CutSurface cut = cut_into_charts(surface, seams, Work(1));
      if (!cut.non_disks.empty()) continue;
      search.take(seams);
      for (const SeamTree::Joint& joint : search.joints(cut.chart_of_face, 2.05)) {
        search.take(seams);
        const double cost = search.cost();
        search.join(joint);
        trial.expect_sound(search, cut.charts.size() - 1);
        EXPECT_NEAR(search.cost(), cost - joint.cost, 1e-9);
        EXPECT_NEAR(search.energy(), joint.energy, 1e-6);
        ++joined;
      }
    }
  }
  EXPECT_GT(joined, 100);
}

TEST(SeamTree, LockedEdgesStayUncut) {
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    std::mt19937_64 generator(seed);
    for (const TriangleList& mesh : {meshes::torus(9), disks::blob(3), meshes::bumps(10, 10)}) {
      Trial trial(mesh, 2, generator);
      // The diagonals of the grid's cells, or an edge of every other face.
      EdgeMarks locked(trial.surface.twin.size(), false);
      for (Index f = 0; f < trial.surface.face_count(); f += 2) {
        mark_edge(trial.surface, 3 * f + 2, locked);
      }
      const EdgeMarks seams = trial.opened(locked);
      for (Index h = 0; h < size_of(locked); ++h) {
        ASSERT_FALSE(locked[h] && seams[h]);
        if (locked[h]) trial.cost[h] = kNever;
      }
      SeamTree search(trial.surface, trial.surface.face_count(), trial.cost, seams, kAnyLength,
                      kLeastCost, Work(1));
      search.extend(2 + 0.1 * (search.energy() - 2));
      search.reconnect();
      search.shrink(2 + 2 * (search.energy() - 2));
      search.reconnect();
      EXPECT_TRUE(std::isfinite(search.cost()));
      trial.expect_sound(search, trial.charts(seams));
      for (std::size_t h = 0; h < locked.size(); ++h) EXPECT_FALSE(locked[h] && search.seams()[h]);
    }
  }
}

}  // namespace
}  // namespace beltrami
