// A few hundred small shapes of all kinds in all ways; the program beltrami_shapes makes any
// number.
#include "shapes/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <string>
#include <vector>

#include "shapes/atlas_of_shape.h"
#include "shapes/exact_triangles.h"
#include "shapes/properties.h"
#include "shapes/random.h"
#include "shapes/region.h"

namespace beltrami::shapes {
namespace {

class Hash {
 public:
  void add(std::uint64_t x) { value_ = (value_ ^ x) * 0x100000001b3; }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325;
};

TEST(Shapes, AreTheSameOnEveryPlatform) {
  Hash hash;
  for (std::uint64_t seed = 0; seed < 10 * kinds().size(); ++seed) {
    const Shape shape = make_shape(seed);
    for (const Point3& p : shape.positions) {
      for (const double x : p) hash.add(std::bit_cast<std::uint64_t>(x));
    }
    for (const Vertex v : shape.corners) hash.add(v);
    for (const std::uint32_t size : shape.sizes) hash.add(size);
  }
  EXPECT_EQ(hash.value(), 0x170b472b2dfa7628u);
}

TEST(Shapes, EveryKindHasItsTurn) {
  for (std::uint64_t seed = 0; seed < kinds().size(); ++seed) {
    const Shape shape = make_shape(seed);
    EXPECT_EQ(shape.kind, kinds()[seed]);
    EXPECT_GT(shape.faces(), 0u) << shape.kind;
    EXPECT_EQ(shape.corners.size(),
              std::accumulate(shape.sizes.begin(), shape.sizes.end(), std::size_t{0}));
    for (const Vertex v : shape.corners) ASSERT_LT(v, shape.positions.size()) << shape.kind;
  }
}

std::int64_t twice_area(const Loop& loop) {
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const auto& [ax, ay] = loop[i];
    const auto& [bx, by] = loop[(i + 1) % loop.size()];
    sum += ax * by - ay * bx;
  }
  return sum;
}

TEST(Regions, AreCoveredByTheirTriangles) {
  Random random(1);
  for (int round = 0; round < 100; ++round) {
    Region region = {rectangle(0, 0, 3000, 1000), {}};
    for (int i = 0; i < 3; ++i) {
      const double radius = random.between(50, 490);
      const int corners = random.count(3, 30);
      region.holes.push_back(
          ellipse({1000 * i + 500, 500}, radius, radius, corners, random.unit()));
    }
    Loop points;
    std::int64_t area = 0;
    for (const Loop& loop : loops_of(region)) {
      points.insert(points.end(), loop.begin(), loop.end());
      area += twice_area(loop);
    }
    for (const auto& [a, b, c] : tessellate(region, random)) {
      const std::int64_t face = twice_area({points[a], points[b], points[c]});
      EXPECT_GT(face, 0);
      area -= face;
    }
    EXPECT_EQ(area, 0) << "round " << round;
  }
}

TEST(ExactTriangles, ALastBitDecides) {
  const double above = std::nextafter(0.3, 1);
  EXPECT_EQ(orientation({0, 0}, {1, 1}, {0.3, 0.3}), 0);
  EXPECT_EQ(orientation({0, 0}, {1, 1}, {0.3, above}), 1);
  EXPECT_EQ(orientation({0, 0}, {1, 1}, {above, 0.3}), -1);
  // Products that differ in bits below those of a double.
  EXPECT_EQ(orientation({0.1, 0.1}, {0.7, 0.7}, {0.5, std::nextafter(0.5, 0)}), -1);
}

TEST(ExactTriangles, WhatTouchesDoesNotOverlap) {
  const UvTriangle one = {Uv{0, 0}, {1, 0}, {0, 1}};
  EXPECT_FALSE(overlap(one, {Uv{1, 0}, {1, 1}, {0, 1}}));
  EXPECT_FALSE(overlap(one, {Uv{0.5, 0}, {0.2, -1}, {0.9, -1}}));
  const double inside = 0x1p-60;
  EXPECT_TRUE(overlap(one, {Uv{0.5, inside}, {0.2, -1}, {0.9, -1}}));
  EXPECT_TRUE(overlap(one, {Uv{0.1, 0.1}, {0.2, 0.1}, {0.1, 0.2}}));
  EXPECT_TRUE(overlap(one, one));
}

/// Two squares that share no vertex, the atlas of which is as it should be.
Shape two_squares() {
  Shape shape;
  shape.flat = true;
  for (const double x : {0.0, 2.0}) {
    const Vertex a = shape.add({x, 0, 0}), b = shape.add({x + 1, 0, 0});
    const Vertex c = shape.add({x + 1, 1, 0}), d = shape.add({x, 1, 0});
    shape.face({a, b, c});
    shape.face({a, c, d});
  }
  return shape;
}

bool finds(const Shape& shape, const ShapeAtlas& atlas, Fault fault) {
  const Report report = judge(shape, atlas);
  return std::any_of(report.findings.begin(), report.findings.end(),
                     [&](const Finding& finding) { return finding.fault == fault; });
}

class Judge : public testing::Test {
 protected:
  /// Moves the corners of one of the squares, in both precisions.
  void move_second(double du, double dv) {
    for (std::size_t corner = 6; corner < 12; ++corner) {
      for (std::vector<Uv>* uvs : {&atlas.uvs, &atlas.single_uvs}) {
        (*uvs)[corner][0] += du;
        (*uvs)[corner][1] += dv;
      }
    }
  }
  /// What leads from the first square to the second.
  Uv way() const { return {atlas.uvs[6][0] - atlas.uvs[0][0], atlas.uvs[6][1] - atlas.uvs[0][1]}; }

  const Shape squares = two_squares();
  ShapeAtlas atlas = unwrap(squares, Way::kMinimal);
};

TEST_F(Judge, HasNothingToSayOfTwoSquares) {
  EXPECT_TRUE(judge(squares, atlas).findings.empty());
}

TEST_F(Judge, SeesOverlaps) {
  move_second(-0.5 * way()[0], -0.5 * way()[1]);
  EXPECT_TRUE(finds(squares, atlas, Fault::kNotInjective));
  EXPECT_TRUE(finds(squares, atlas, Fault::kDisagreement)) << "the library said that all was well";
}

TEST_F(Judge, SeesFlips) {
  std::swap(atlas.uvs[0], atlas.uvs[1]);
  EXPECT_TRUE(finds(squares, atlas, Fault::kNotInjective));
}

TEST_F(Judge, SeesWhatRoundsToALine) {
  atlas.single_uvs[0] = atlas.single_uvs[1];
  EXPECT_TRUE(finds(squares, atlas, Fault::kSingle));
}

TEST_F(Judge, SeesTrianglesWithoutAPlace) {
  atlas.uvs[1] = atlas.uvs[2] = atlas.uvs[0];
  EXPECT_TRUE(finds(squares, atlas, Fault::kLost));
}

TEST_F(Judge, SeesWhatLeavesThePage) {
  move_second(1, 0);
  EXPECT_TRUE(finds(squares, atlas, Fault::kOffPage));
}

TEST_F(Judge, SeesChartsThatAreTooClose) {
  Shape shape = squares;
  shape.margin = 300;
  EXPECT_TRUE(finds(shape, atlas, Fault::kMargin));
}

TEST_F(Judge, SeesFlatChartsThatAreBent) {
  for (Uv& uv : atlas.uvs) uv[0] *= 0.8;
  EXPECT_TRUE(finds(squares, atlas, Fault::kBent));
}

TEST_F(Judge, SeesEnergiesAboveTheTargetAndTheMinimalCut) {
  Shape shape = squares;
  shape.flat = false;
  for (Uv& uv : atlas.uvs) uv[0] *= 0.5;
  EXPECT_FALSE(finds(shape, atlas, Fault::kEnergy)) << "nothing was asked for";
  atlas.target = 2.1;
  EXPECT_TRUE(finds(shape, atlas, Fault::kEnergy));
}

TEST_F(Judge, SeesRefusals) {
  atlas.status = BELTRAMI_E_ZERO_AREA;
  EXPECT_TRUE(finds(squares, atlas, Fault::kRefused));
}

TEST_F(Judge, TakesTheRefusalOfNothing) {
  Shape line;
  line.face({line.add({0, 0, 0}), line.add({1, 0, 0}), line.add({2, 0, 0})});
  EXPECT_TRUE(check(line, Way::kAuto).findings.empty());
}

/// Seeds, and faces of a shape, up to which it is tried here.
constexpr std::uint64_t kSeeds = 100;
constexpr std::size_t kMostFaces = 60;

class SmallShapes : public testing::TestWithParam<Way> {};

TEST_P(SmallShapes, HaveTheAtlasThatTheyAreOwed) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Shape shape = make_shape(seed);
    if (shape.faces() > kMostFaces) continue;
    for (const Finding& finding : check(shape, GetParam()).findings) {
      ADD_FAILURE() << shape.kind << ", seed " << seed << ": " << name_of(finding.fault) << ": "
                    << finding.what;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Ways, SmallShapes, testing::ValuesIn(kWays),
                         [](const auto& way) { return std::string(name_of(way.param)); });

}  // namespace
}  // namespace beltrami::shapes
