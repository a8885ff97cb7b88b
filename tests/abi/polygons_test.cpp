// Polygons that share edges and diagonals, cross themselves, or close on themselves when welded.
#include <beltrami/beltrami.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

#include "abi/host.h"
#include "base/vectors.h"
#include "support/disks.h"

namespace beltrami::host {
namespace {

struct Polygons {
  std::vector<Vec3> positions;
  std::vector<std::uint32_t> corners, sizes;

  void add(const std::vector<std::uint32_t>& polygon) {
    corners.insert(corners.end(), polygon.begin(), polygon.end());
    sizes.push_back(static_cast<std::uint32_t>(polygon.size()));
  }
  beltrami_surface view() const { return polygon_view(positions, corners, sizes); }
};

beltrami_atlas unwrapped(const Polygons& polygons, std::int64_t weld) {
  const Context context = create();
  const beltrami_surface surface = polygons.view();
  auto atlas = sized<beltrami_atlas>();
  EXPECT_EQ(beltrami_set_int(context.get(), BELTRAMI_OPTION_WELD, weld), BELTRAMI_OK);
  EXPECT_EQ(beltrami_unwrap(context.get(), &surface, nullptr, nullptr), BELTRAMI_OK)
      << message(context);
  EXPECT_EQ(beltrami_get_atlas(context.get(), &atlas), BELTRAMI_OK) << message(context);
  auto certificate = sized<beltrami_atlas_certificate>();
  EXPECT_EQ(beltrami_get_atlas_certificate(context.get(), BELTRAMI_F64, &certificate), BELTRAMI_OK);
  EXPECT_EQ(certificate.injective, 1);
  return atlas;
}

// Three crooked polygons, whose diagonals are edges of each other.
TEST(AbiPolygons, OnOneEdgeMayHaveItAsADiagonal) {
  Polygons polygons;
  polygons.positions = {{0.05, 0.66, -0.06},  {0.93, -0.48, -1.65}, {0.25, 1.34, 0.09},
                        {-0.07, -0.21, 0.48}, {0.35, 0.6, -1.67},   {-0.81, -1.04, -1.31},
                        {-1.45, -0.86, 1.14}};
  polygons.add({4, 2, 6, 0, 3, 1});
  polygons.add({3, 4, 0, 1});
  polygons.add({3, 4, 1, 0, 6, 2});
  unwrapped(polygons, BELTRAMI_WELD_OFF);
}

// Of a lamp: the pentagon and the octagon share a side and a diagonal, so their corners would be
// joined by two edges.
TEST(AbiPolygons, WithADiagonalInCommonStayWhole) {
  Polygons polygons;
  polygons.positions = {{0.253033, 2.850066, -0.146089},  {0.253033, 9.986625, -0.146089},
                        {0, 9.986625, -0.292177},         {0.253033, 9.986625, 0.146089},
                        {0, 9.986625, 0.292177},          {-0.253033, 9.986625, 0.146089},
                        {-0.253033, 9.986625, -0.146089}, {0.618538, 10.238888, -0.619588},
                        {0.618538, 10.238888, 0.619588},  {-0.618538, 10.238888, 0.619588},
                        {-0.618538, 10.238888, -0.619588}};
  polygons.add({0, 1, 3});
  polygons.add({1, 7, 10, 6, 2});
  polygons.add({6, 5, 9});
  polygons.add({1, 6, 10, 5, 4, 3, 8, 7});
  unwrapped(polygons, BELTRAMI_WELD_OFF);
}

// The triangle without area between two others would part them.
TEST(AbiPolygons, ThatCrossThemselvesAreCoveredOnce) {
  Polygons polygons;
  polygons.positions = {{2, 2, 0}, {0, 2, 0.7}, {0, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  polygons.add({0, 2, 4, 3, 1});
  const beltrami_atlas atlas = unwrapped(polygons, BELTRAMI_WELD_OFF);
  EXPECT_EQ(atlas.charts, 1u);
  EXPECT_EQ(atlas.triangles, 3u);
}

// Welded, the hexagon is folded up to a tetrahedron: its sides are sewn to each other.
TEST(AbiPolygons, SewnToThemselvesAreCutAlongTheirSides) {
  Polygons polygons;
  polygons.positions = {{2, 1, 2}, {0, 3, 0}, {2, 1, 2}, {2, 0, 2}, {2, 1, 2}, {0, 0, 3}};
  polygons.add({0, 1, 2, 3, 4, 5});
  const beltrami_atlas atlas = unwrapped(polygons, BELTRAMI_WELD_ON);
  EXPECT_EQ(atlas.closed_components, 1u);
  EXPECT_EQ(atlas.charts, 1u);
}

// On a coarse grid, where corners meet, lie on lines and on each other.
TEST(AbiPolygons, OfAnyShapeAreCoveredOnce) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    disks::Random random(seed);
    Polygons polygons;
    for (int i = 0; i < 12; ++i) {
      polygons.positions.push_back(
          {double(random.below(3)), double(random.below(3)), 0.7 * random.below(2)});
    }
    const int faces = 2 + random.below(10);
    for (int f = 0; f < faces; ++f) {
      std::vector<std::uint32_t> order(12);
      std::iota(order.begin(), order.end(), 0);
      const int size = 3 + random.below(6);
      for (int i = 0; i < size; ++i) std::swap(order[i], order[i + random.below(12 - i)]);
      order.resize(size);
      polygons.add(order);
    }
    SCOPED_TRACE(seed);
    unwrapped(polygons, BELTRAMI_WELD_ON);
  }
}

}  // namespace
}  // namespace beltrami::host
