// The certificate of an atlas against areas in rational numbers, where everything is degenerate.
#include "exact/atlas_certificate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "base/interrupt.h"
#include "exact/rational_overlaps.h"
#include "support/disks.h"
#include "support/polls.h"

namespace beltrami {
namespace {

using disks::Random;
AtlasCertificate certify(const UvFaces& atlas, const AtlasRules& rules = {}, int threads = 1) {
  return certify_atlas(atlas.faces, atlas.uvs, rules, Work(threads));
}

/// The verdict is that of force; so are the pairs of faces, and boundary edges cross in theirs.
void expect_as_by_force(const UvFaces& atlas, int& injective) {
  const AtlasCertificate found = certify(atlas, {{}, false, 1000});
  const std::vector<Pair> all = overlaps_by_force(atlas);
  ASSERT_EQ(found.overlaps.faces == 0, all.empty());
  injective += all.empty();
  if (all.empty()) return;
  const std::vector<bool> at_boundary = faces_at_boundary(atlas);
  std::vector<Pair> expected;
  std::copy_if(all.begin(), all.end(), std::back_inserter(expected),
               [&](const Pair& p) { return at_boundary[p[0]] || at_boundary[p[1]]; });
  ASSERT_TRUE(found.overlaps.complete);
  ASSERT_EQ(found.overlaps.first_faces, expected);
  ASSERT_EQ(found.overlaps.faces, static_cast<std::int64_t>(expected.size()));
  for (const auto& [e, f] : found.overlaps.first_edges) {
    ASSERT_TRUE(std::binary_search(expected.begin(), expected.end(), Pair{e / 3, f / 3}));
  }
}

/// Triangles on a grid of `range` places a side; every other one takes over an edge of an earlier.
UvFaces random_soup(Random& random, int faces, int range) {
  UvFaces atlas;
  const auto any = [&]() -> Vec2 {
    return {static_cast<double>(random.below(range)), static_cast<double>(random.below(range))};
  };
  for (int i = 0; i < faces; ++i) {
    if (i == 0 || random.below(2) == 0) {
      atlas.add(any(), any(), any());
    } else {
      const Triangle& face = atlas.faces[random.below(i)];
      const int k = random.below(3);
      atlas.faces.push_back({face[(k + 1) % 3], face[k], size_of(atlas.uvs)});
      atlas.uvs.push_back(any());
    }
  }
  return atlas;
}

TEST(AtlasCertificate, AgreesWithAreasOfRandomTrianglesOnATinyGrid) {
  Random random(1);
  int injective = 0;
  for (int i = 0; i < 6000; ++i) {
    const UvFaces atlas = random_soup(random, 2 + random.below(5), 3 + random.below(3));
    ASSERT_NO_FATAL_FAILURE(expect_as_by_force(atlas, injective)) << i;
  }
  EXPECT_GT(injective, 500);
  EXPECT_LT(injective, 5500);
}

/// Cells of a grid in random charts: each of its own vertices or of those of its neighbours, whole
/// or in four, cut along either diagonal, some missing; all of them mapped to skew integers.
UvFaces random_mosaic(Random& random) {
  const Index n = 2 + random.below(2);
  std::vector<std::vector<Index>> shared(2 * n + 1, std::vector<Index>(2 * n + 1, kNone));
  const std::array<std::array<double, 4>, 4> maps = {
      {{1, 0, 0, 1}, {2, -1, 1, 3}, {3, 2, -2, 1}, {5, 3, 3, 2}}};
  const auto& m = maps[random.below(4)];
  const int welding = random.below(4);
  UvFaces atlas;
  const auto vertex = [&](Index i, Index j) {
    if (shared[i][j] == kNone || random.below(3) >= welding) {
      shared[i][j] = size_of(atlas.uvs);
      atlas.uvs.push_back({m[0] * i + m[1] * j, m[2] * i + m[3] * j});
    }
    return shared[i][j];
  };
  const auto cell = [&](Index i, Index j, Index size) {
    const Index a = vertex(i, j), b = vertex(i + size, j), c = vertex(i + size, j + size),
                d = vertex(i, j + size);
    if (random.below(2) == 0) {
      atlas.faces.insert(atlas.faces.end(), {{a, b, c}, {a, c, d}});
    } else {
      atlas.faces.insert(atlas.faces.end(), {{a, b, d}, {b, c, d}});
    }
  };
  for (Index i = 0; i < n; ++i) {
    for (Index j = 0; j < n; ++j) {
      const int kind = random.below(4);
      if (kind == 0) continue;
      if (kind == 1) cell(2 * i, 2 * j, 2);
      for (Index k = 0; k < 4 && kind > 1; ++k) cell(2 * i + k % 2, 2 * j + k / 2, 1);
    }
  }
  return atlas;
}

/// Places of boundary vertices on which there is another one, or an edge; of whole numbers.
std::int64_t touching_by_force(const UvFaces& atlas) {
  std::set<Pair> edges;
  for (const Triangle& t : atlas.faces) {
    for (std::size_t k = 0; k < 3; ++k) edges.insert({t[k], t[(k + 1) % 3]});
  }
  std::erase_if(edges, [all = edges](const Pair& e) { return all.contains({e[1], e[0]}); });
  std::map<std::array<double, 2>, std::set<Index>> places;
  for (const Pair& e : edges) {
    for (const Index v : e) places[{atlas.uvs[v].x(), atlas.uvs[v].y()}].insert(v);
  }
  return std::count_if(places.begin(), places.end(), [&](const auto& place) {
    const Vec2 p(place.first[0], place.first[1]);
    return place.second.size() > 1 || std::any_of(edges.begin(), edges.end(), [&](const Pair& e) {
             const Vec2 u = atlas.uvs[e[0]] - p, v = atlas.uvs[e[1]] - p;
             return u.x() * v.y() == u.y() * v.x() && u.dot(v) < 0;
           });
  });
}

TEST(AtlasCertificate, LetsTheChartsOfAMosaicTouchInAnyWay) {
  Random random(2);
  for (int i = 0; i < 2000; ++i) {
    const UvFaces atlas = random_mosaic(random);
    const AtlasCertificate found = certify(atlas);
    ASSERT_TRUE(found.injective()) << i;
    ASSERT_EQ(found.overlaps.edges, 0) << i;
    ASSERT_EQ(found.touching_places, touching_by_force(atlas)) << i;
  }
}

TEST(AtlasCertificate, CountsThePlacesWhereBoundariesTouch) {
  const auto touching = [](const UvFaces& atlas) {
    const AtlasCertificate found = certify(atlas);
    EXPECT_TRUE(found.injective());
    return std::pair(found.touching_places, found.first_touching);
  };
  UvFaces atlas;
  atlas.add({0, 0}, {4, 0}, {0, 4});
  EXPECT_EQ(touching(UvFaces(atlas).add({5, 0}, {9, 0}, {9, 4})),
            std::pair(std::int64_t{0}, kNone));
  // A vertex on a vertex, on an edge; edges on each other, which end there.
  EXPECT_EQ(touching(UvFaces(atlas).add({4, 0}, {9, 0}, {9, 4})),
            std::pair(std::int64_t{1}, Index{1}));
  EXPECT_EQ(touching(UvFaces(atlas).add({2, 2}, {9, 3}, {9, 4})),
            std::pair(std::int64_t{1}, Index{3}));
  EXPECT_EQ(touching(UvFaces(atlas).add({3, 0}, {1, 0}, {2, -1})),
            std::pair(std::int64_t{2}, Index{3}));
  EXPECT_EQ(touching(UvFaces(atlas).add({4, 0}, {0, 0}, {2, -1})),
            std::pair(std::int64_t{2}, Index{0}));
  // A vertex that is shared.
  const UvFaces bow{{{0, 0}, {2, 1}, {1, 2}, {-2, -1}, {-1, -2}}, {{0, 1, 2}, {0, 3, 4}}};
  EXPECT_EQ(touching(bow), std::pair(std::int64_t{0}, kNone));
}

TEST(AtlasCertificate, AgreesWithAreasWhereAVertexOrAFaceOfAMosaicIsMisplaced) {
  Random random(3);
  int injective = 0;
  for (int i = 0; i < 200; ++i) {
    UvFaces atlas = random_mosaic(random);
    if (atlas.faces.empty()) continue;
    const auto any_place = [&] { return atlas.uvs[random.below(size_of(atlas.uvs))]; };
    if (random.below(2) == 0) {
      atlas.uvs[random.below(size_of(atlas.uvs))] = any_place();
    } else {
      const Vec2 a = any_place(), b = any_place(), c = any_place();
      atlas.add(a, b, c);
    }
    ASSERT_NO_FATAL_FAILURE(expect_as_by_force(atlas, injective)) << i;
  }
  EXPECT_GT(injective, 15);
  EXPECT_LT(injective, 185);
}

TEST(AtlasCertificate, AgreesWithAreasWhereRoundingMovesVerticesOffTheEdgesThatTheyTouched) {
  Random random(5);
  int injective = 0;
  for (int i = 0; i < 200; ++i) {
    UvFaces atlas = random_mosaic(random);
    const double x = random.unit(), y = random.unit();
    for (Vec2& w : atlas.uvs) w = {x * w.x() - y * w.y(), y * w.x() + x * w.y()};
    ASSERT_NO_FATAL_FAILURE(expect_as_by_force(atlas, injective)) << i;
  }
  EXPECT_GT(injective, 15);
  EXPECT_LT(injective, 185);
}

// ---- Charts within and beside each other ------------------------------------------------------

TEST(AtlasCertificate, HoldsForAnEmptyAtlas) {
  EXPECT_TRUE(certify(UvFaces()).injective());
  EXPECT_TRUE(certify(UvFaces{{{1, 2}}, {}}).injective());
}

UvFaces ring_of_cells() {
  return UvFaces().add_cells(
      5, 5, [](Index i, Index j) { return i == 0 || i == 4 || j == 0 || j == 4; },
      [](Vec2 p) -> Vec2 { return p; });
}

TEST(AtlasCertificate, LetsAChartLieInAHoleOfAnotherOrInABay) {
  EXPECT_TRUE(certify(ring_of_cells().add_grid(2, 2, {1.5, 1.5})).injective());
  // It fills the hole, and touches all of its border from within.
  EXPECT_TRUE(certify(ring_of_cells().add_grid(3, 3, {1, 1})).injective());
  const auto horseshoe = [] {
    return UvFaces().add_cells(
        3, 3, [](Index i, Index j) { return i != 1 || j == 0; }, [](Vec2 p) -> Vec2 { return p; });
  };
  EXPECT_TRUE(certify(horseshoe().add({1.25, 1.5}, {1.75, 1.5}, {1.5, 9})).injective());
  EXPECT_TRUE(certify(horseshoe().add({1, 1}, {2, 1}, {1.5, 3})).injective());
}

TEST(AtlasCertificate, LetsChartsBeNestedThroughHolesManyTimes) {
  UvFaces atlas;
  for (int i = 0; i < 6; ++i) {
    atlas.add_cells(
        3, 3, [](Index x, Index y) { return x != 1 || y != 1; },
        [&](const Vec2& p) -> Vec2 { return std::ldexp(1.0, -2 * i) * (p - Vec2(1.5, 1.5)); });
  }
  EXPECT_TRUE(certify(atlas).injective());
  // In the inside of the smallest cell, whose border it does not cross.
  const std::int64_t faces = size_of(atlas.faces);
  atlas.add({-1.375, -1.4375}, {-1.25, -1.4375}, {-1.25, -1.375});
  const AtlasCertificate found = certify(atlas);
  EXPECT_EQ(found.overlaps.edges, 0);
  EXPECT_EQ(found.overlaps.first_faces, (std::vector<Pair>{{0, static_cast<Index>(faces)}}));
}

TEST(AtlasCertificate, NamesTheFaceAndTheChartThatLiesWithinIt) {
  UvFaces atlas;
  atlas.add_grid(1, 1, {10, 10}).add({0, 0}, {9, 0}, {0, 9}).add({1, 1}, {2, 1}, {1, 2});
  const AtlasCertificate found = certify(atlas);
  EXPECT_FALSE(found.injective());
  EXPECT_EQ(found.orientations.positive, 4);
  EXPECT_EQ(found.overlaps.edges, 0);
  EXPECT_EQ(found.overlaps.first_faces, (std::vector<Pair>{{2, 3}}));
}

TEST(AtlasCertificate, NamesTheEdgesThatCrossByTheirFacesAndCorners) {
  UvFaces atlas;
  atlas.add({0, 0}, {4, 0}, {0, 4}).add({1, -1}, {2, -1}, {1, 1});
  const AtlasCertificate found = certify(atlas);
  EXPECT_EQ(found.overlaps.faces, 1);
  EXPECT_EQ(found.overlaps.first_edges, (std::vector<Pair>{{0, 4}, {0, 5}}));
}

TEST(AtlasCertificate, LetsTwoChartsShareAWholeEdgeButNotOneSideOfIt) {
  UvFaces atlas;
  atlas.add({0, 0}, {4, 0}, {0, 4});
  EXPECT_TRUE(certify(UvFaces(atlas).add({4, 0}, {0, 0}, {0, -4})).injective());
  EXPECT_TRUE(certify(UvFaces(atlas).add({3, 0}, {1, 0}, {2, -4})).injective());
  const AtlasCertificate found = certify(UvFaces(atlas).add({1, 0}, {3, 0}, {1, 1}));
  EXPECT_EQ(found.overlaps.first_faces, (std::vector<Pair>{{0, 1}}));
  EXPECT_EQ(found.overlaps.first_edges, (std::vector<Pair>{{0, 3}}));
}

TEST(AtlasCertificate, SeesAChartThatIsThereTwice) {
  const UvFaces twice = UvFaces().add_grid(4, 4, {0, 0}).add_grid(4, 4, {0, 0});
  const AtlasCertificate found = certify(twice);
  EXPECT_EQ(found.orientations.positive, 64);
  EXPECT_EQ(found.overlaps.faces, 14);  // those along the border
  EXPECT_EQ(found.overlaps.edges, 16);
  EXPECT_EQ(found.overlaps.first_faces.front(), (Pair{0, 32}));
}

TEST(AtlasCertificate, SeesFacesOnOneSideOfAnEdgeOfTheirOwnVertices) {
  // Three at one edge; and a face that is there twice.
  const UvFaces three{{{0, 0}, {4, 0}, {0, 4}, {0, -4}, {4, 4}}, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}};
  EXPECT_EQ(certify(three).overlaps.first_faces, (std::vector<Pair>{{0, 2}}));
  const UvFaces copies{{{0, 0}, {4, 0}, {0, 4}}, {{0, 1, 2}, {1, 2, 0}}};
  EXPECT_EQ(certify(copies).overlaps.first_faces, (std::vector<Pair>{{0, 1}}));
}

TEST(AtlasCertificate, SeesAChartThatWindsAroundAVertexTwice) {
  // All triangles positive, and the boundary is one closed polygon.
  UvFaces atlas{{{0, 0}}, {}};
  const std::vector<Vec2> around = {{4, 0}, {0, 4}, {-4, 0}, {0, -4}};
  for (Index k = 0; k < 8; ++k) {
    atlas.uvs.push_back((1 + k) * around[k % 4]);
    atlas.faces.push_back({0, 1 + k, 1 + (k + 1) % 8});
  }
  const AtlasCertificate found = certify(atlas);
  EXPECT_EQ(found.orientations.positive, 8);
  EXPECT_FALSE(found.injective());
}

/// A strip of cells along a spiral of squares, whose turns are `pitch` apart; it is 1 wide.
UvFaces square_spiral(int turns, double pitch) {
  UvFaces atlas;
  for (int side = 0; side < 4 * turns; ++side) {
    // Each side from its inner corner to the next; they share the cells at the corners by halves.
    const double inner = pitch * (side / 4.0 + 1), next = pitch * ((side + 1) / 4.0 + 1);
    const std::array<Vec2, 4> axis = {Vec2(1, 0), Vec2(0, 1), Vec2(-1, 0), Vec2(0, -1)};
    const Vec2 &u = axis[side % 4], &v = axis[(side + 1) % 4];
    const double before = pitch * ((side - 1) / 4.0 + 1);
    // The side lies at distance `inner` along u, and runs along v.
    const Vec2 a = inner * u - before * v, b = (inner + 1) * u - (before + 1) * v;
    const Vec2 c = (inner + 1) * u + (next + 1) * v, d = inner * u + next * v;
    const Index first = size_of(atlas.uvs);
    atlas.uvs.insert(atlas.uvs.end(), {a, b, c, d});
    atlas.faces.insert(atlas.faces.end(),
                       {{first, first + 1, first + 2}, {first, first + 2, first + 3}});
  }
  return atlas;
}

TEST(AtlasCertificate, TellsASpiralThatTouchesItselfFromOneThatOverlaps) {
  EXPECT_TRUE(certify(square_spiral(50, 1.25)).injective());
  EXPECT_TRUE(certify(square_spiral(50, 1)).injective());
  const AtlasCertificate found = certify(square_spiral(50, 0.9375));
  EXPECT_EQ(found.orientations.negative + found.orientations.degenerate, 0);
  EXPECT_FALSE(found.injective());
}

TEST(AtlasCertificate, IsDecidedExactly) {
  // The tip is one unit in the last place below the edge, or on it.
  const auto with_tip = [](double y) {
    return UvFaces().add({0, 0}, {3, 3}, {0, 3}).add({1, y}, {2, 0}, {3, 0});
  };
  EXPECT_EQ(
      certify(UvFaces().add({0, 0}, {3, 3}, {0, 3}).add({2, 0}, {3, 0}, {1, 1})).overlaps.faces, 0);
  EXPECT_EQ(certify(with_tip(std::nextafter(1, 2))).overlaps.faces, 1);
}

// ---- Signs ------------------------------------------------------------------------------------

UvFaces with_a_mirrored_chart() {
  UvFaces atlas;
  return atlas.add_grid(2, 2, {0, 0})
      .add_cells(
          2, 2, [](Index, Index) { return true; },
          [](Vec2 p) -> Vec2 {
            return {-1 - p.x(), p.y()};
          });
}

TEST(AtlasCertificate, TakesWholeChartsThatAreMirroredWhereItIsAllowed) {
  UvFaces atlas = with_a_mirrored_chart();
  const AtlasCertificate refused = certify(atlas);
  EXPECT_EQ(refused.orientations.negative, 8);
  EXPECT_EQ(refused.orientations.first_bad_face, 8);
  EXPECT_EQ(refused.overlaps.faces, 0);
  EXPECT_FALSE(refused.injective());
  AtlasRules rules;
  rules.allow_mirrored = true;
  const AtlasCertificate allowed = certify(atlas, rules);
  EXPECT_TRUE(allowed.injective());
  EXPECT_EQ(allowed.mirrored_charts, 1);
  EXPECT_EQ(allowed.mirrored_faces, 8);
  EXPECT_EQ(allowed.orientations.positive, 16);
  // A fold within a chart is none of its mirror images.
  atlas.uvs[4] = {3, 1};
  const AtlasCertificate folded = certify(atlas, rules);
  EXPECT_GT(folded.orientations.negative, 0);
  EXPECT_GT(folded.overlaps.faces, 0);
  EXPECT_EQ(folded.mirrored_charts, 1);
}

TEST(AtlasCertificate, ExceptsFacesWithoutAreaWhereverTheyLie) {
  UvFaces atlas;
  atlas.add_grid(2, 2, {0, 0}).add({1, 1}, {1, 1}, {1, 1}).add({0, 0}, {0, 1}, {1, 0});
  AtlasRules rules;
  EXPECT_EQ(certify(atlas).orientations.degenerate, 1);
  EXPECT_FALSE(certify(atlas).injective());
  rules.excepted.assign(10, false);
  rules.excepted[8] = rules.excepted[9] = true;
  const AtlasCertificate found = certify(atlas, rules);
  EXPECT_TRUE(found.injective());
  EXPECT_EQ(found.excepted_faces, 2);
  EXPECT_EQ(found.orientations.positive, 8);
}

TEST(AtlasCertificate, SeesFacesThatAFoldedSliverBetweenThemLetsOverlap) {
  // The middle of the edge has been rounded to the wrong side of it.
  const double wrong = 0x1p-52;
  const UvFaces atlas{{{0, 0}, {2, 0}, {1, 2}, {1, wrong}, {1, -2}},
                      {{0, 1, 2}, {0, 3, 1}, {0, 4, 3}, {4, 1, 3}}};
  AtlasRules rules;
  rules.excepted = {false, true, false, false};
  const AtlasCertificate found = certify(atlas, rules);
  EXPECT_EQ(found.overlaps.first_faces, (std::vector<Pair>{{0, 2}, {0, 3}}));
}

TEST(AtlasCertificate, NamesTheFirstVertexThatIsNoNumber) {
  for (const double bad :
       {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
    UvFaces atlas = UvFaces().add_grid(2, 2, {0, 0});
    atlas.uvs.push_back({bad, 0});  // no face uses it
    EXPECT_TRUE(certify(atlas).injective());
    atlas.uvs[7].y() = bad;
    const AtlasCertificate found = certify(atlas);
    EXPECT_FALSE(found.injective());
    EXPECT_EQ(found.not_finite, 1);
    EXPECT_EQ(found.first_not_finite, 7);
    EXPECT_EQ(found.orientations.degenerate, 3);
  }
}

TEST(AtlasCertificate, HoldsForTheLargestAndTheSmallestNumbers) {
  for (const double unit : {std::numeric_limits<double>::max(), 0x1p-1073}) {
    const auto scaled = [&](const Vec2& corner, double cell) {
      return UvFaces().add_cells(
          1, 1, [](Index, Index) { return true; },
          [&](const Vec2& p) -> Vec2 { return unit * (corner + cell * p); });
    };
    EXPECT_TRUE(certify(scaled({-1, -1}, 2)).injective());
    UvFaces two = scaled({-1, -1}, 2);
    two.add({0, 0}, {unit, 0}, {0, unit});
    EXPECT_GT(certify(two).overlaps.faces, 0);
  }
}

// ---- Cost -------------------------------------------------------------------------------------

/// Charts in rows, a little apart.
UvFaces many_charts(Index rows, Index columns, Index cells) {
  UvFaces atlas;
  for (Index i = 0; i < rows; ++i) {
    for (Index j = 0; j < columns; ++j) {
      atlas.add_grid(cells, cells, Vec2(i, j) * (cells + 0.25));
    }
  }
  return atlas;
}

/// Long thin triangles side by side: the box of each meets those of most others.
UvFaces many_slivers(Index count) {
  UvFaces atlas;
  for (Index i = 0; i < count; ++i) {
    const double x = i;
    atlas.add({x, 0}, {x + 1, 0}, {x + count, static_cast<double>(count)});
  }
  return atlas;
}

UvFaces all_in_one_place(Index count) {
  UvFaces atlas;
  for (Index i = 0; i < count; ++i) atlas.add({0, 0}, {1, 0}, {0, 1});
  return atlas;
}

UvFaces fan_of_charts(Index count) {
  UvFaces atlas;
  for (Index i = 0; i < count; ++i) {
    const double x = i;
    atlas.add({0, 0}, {1e6, x}, {1e6, x + 1});
  }
  return atlas;
}

TEST(AtlasCertificate, TakesLittleMoreThanTwiceTheWorkForTwiceTheCharts) {
  const auto crossed_slivers = [](Index count) {
    return many_slivers(count).add({0, 0}, {1.0 * count, 0}, {0, 0.5});
  };
  const auto rows = [](Index count) { return many_charts(count / 100, 100, 1); };
  for (const auto& make : std::vector<std::function<UvFaces(Index)>>{
           rows, many_slivers, crossed_slivers, all_in_one_place, fan_of_charts}) {
    const auto polls = [&](Index count) {
      const UvFaces atlas = make(count);
      return count_polls([&] { certify(atlas); });
    };
    EXPECT_LE(polls(20000), 2.5 * static_cast<double>(polls(10000)) + 10);
  }
}

TEST(AtlasCertificate, IsTheSameOnTwoAndThreeThreads) {
  UvFaces atlas = many_charts(60, 60, 3);
  Random random(4);
  for (int i = 0; i < 200; ++i) atlas.uvs[random.below(size_of(atlas.uvs))] += random.vec2();
  AtlasRules rules;
  rules.allow_mirrored = true;
  rules.most_listed = 1000;
  const AtlasCertificate one = certify(atlas, rules);
  EXPECT_GT(one.overlaps.faces, 10);
  for (const int threads : {2, 3}) {
    const AtlasCertificate other = certify(atlas, rules, threads);
    EXPECT_EQ(other.orientations.negative, one.orientations.negative);
    EXPECT_EQ(other.orientations.first_bad_face, one.orientations.first_bad_face);
    EXPECT_EQ(other.mirrored_charts, one.mirrored_charts);
    EXPECT_EQ(other.overlaps.faces, one.overlaps.faces);
    EXPECT_EQ(other.overlaps.edges, one.overlaps.edges);
    EXPECT_EQ(other.overlaps.first_faces, one.overlaps.first_faces);
    EXPECT_EQ(other.overlaps.first_edges, one.overlaps.first_edges);
  }
}

TEST(AtlasCertificate, IsCancelledAtEveryPoll) {
  const UvFaces atlas = many_charts(15, 15, 2).add({0.5, 0.5}, {9.5, 0.5}, {0.5, 9.5});
  const auto run = [&] { certify(atlas); };
  const std::int64_t polls = count_polls(run);
  ASSERT_GT(polls, 10);
  for (std::int64_t k = 1; k <= polls; ++k) EXPECT_THROW(count_polls(run, k), Cancelled) << k;
}

}  // namespace
}  // namespace beltrami
