// Polygons into triangles: their corners, every one, whatever they name.
#include "admit/triangulate.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <array>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "base/work.h"

namespace beltrami {
namespace {

/// n - 2 triangles for n corners, of that face alone, and every corner in one.
void expect_complete(const Polygons& polygons, const Triangulation& result) {
  std::size_t t = 0;
  for (Index f = 0; f < polygons.count(); ++f) {
    std::set<Index> seen;
    for (Index i = 2; i < polygons.end(f) - polygons.begin(f); ++i, ++t) {
      ASSERT_LT(t, result.triangles.size());
      for (const Index corner : result.triangles[t]) {
        EXPECT_TRUE(corner >= polygons.begin(f) && corner < polygons.end(f));
        seen.insert(corner);
      }
    }
    EXPECT_EQ(size_of(std::vector(seen.begin(), seen.end())), polygons.end(f) - polygons.begin(f));
  }
  EXPECT_EQ(t, result.triangles.size());
}

const std::vector<Vec3> kSquare = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 1}};

TEST(TriangulatePolygons, NumbersTrianglesByTheirCorners) {
  const Polygons polygons{{0, 1, 2, 0, 2, 3}, {}};
  const Triangulation result = triangulate(kSquare, polygons, Work(1));
  EXPECT_EQ(result.triangles, (std::vector<Triangle>{{0, 1, 2}, {3, 4, 5}}));
  EXPECT_EQ(result.first_repeating, kNone);
}

TEST(TriangulatePolygons, CutsMixedFaces) {
  const Polygons polygons{{0, 1, 2, 3, 0, 4, 1, 1, 4, 2, 3, 0}, {4, 7, 12}};
  const Triangulation result = triangulate(kSquare, polygons, Work(1));
  expect_complete(polygons, result);
  EXPECT_EQ(result.first_repeating, kNone);
}

TEST(TriangulatePolygons, SaysWhereAVertexIsNamedTwice) {
  const Polygons polygons{{0, 1, 2, 3, 0, 1, 0, 2, 3, 2}, {4, 10}};
  const Triangulation result = triangulate(kSquare, polygons, Work(1));
  expect_complete(polygons, result);
  EXPECT_EQ(result.first_repeating, 1);
}

// The letter A with a bridge to its hole, turned and rounded: the tip of the hole lies on the line
// from a foot to the top, and the side of the hole on that of another cut.
TEST(TriangulatePolygons, NoCutRunsThroughACorner) {
  const std::vector<Vec3> letter = {
      {0, 0, 0},
      {-0.048392667098124426, -0.050464058788021432, -0.18738070482781635},
      {0.19951637198994507, 0.0095485221376828966, -0.37430207457741405},
      {0.15112370489182064, -0.040915536650338535, -0.56168277940523048},
      {-0.14517800129437325, -0.15139217636406427, -0.56214211448344897},
      {-0.1935706683924977, -0.20185623515208573, -0.74952281931126541},
      {0.78603624104512793, 0.1579885540956632, -0.7792218198551728},
      {0.83442890814325232, 0.20845261288368463, -0.59184111502735637},
      {0.62882899283610239, 0.12639084327653055, -0.62337745588413829},
      {0.24182549577086454, -0.012500666543766858, -0.59275978518379369},
      {0.29021816286898894, 0.037963392244254573, -0.40537908035597725}};
  const Polygons polygons{{5, 6, 7, 0, 1, 2, 3, 9, 10, 8, 9, 3, 4}, {13}};
  const Triangulation result = triangulate(letter, polygons, Work(1));
  expect_complete(polygons, result);
  for (const Triangle& t : result.triangles) {
    const auto at = [&](int k) { return letter[polygons.corners[t[k]]]; };
    EXPECT_GT((at(1) - at(0)).cross(at(2) - at(0)).norm(), 1e-3);
  }
}

// Corner 4 is on the line from 2 to 0, and seen along the normal a rounding error outside it, where
// the box of the triangle on that cut ends: without area between two faces it would part them.
TEST(TriangulatePolygons, NoCutRunsThroughACornerThatIsOutsideByRounding) {
  const std::vector<Vec3> hexagon = {
      {-0.116989, 0.019132, 0.261250}, {-0.116169, 0.017294, 0.272250},
      {-0.116169, 0.017294, 0.261250}, {-0.116374, 0.017753, 0.261250},
      {-0.116579, 0.018213, 0.261250}, {-0.116784, 0.018672, 0.261250}};
  const Polygons polygons{{0, 1, 2, 3, 4, 5}, {6}};
  const Triangulation result = triangulate(hexagon, polygons, Work(1));
  expect_complete(polygons, result);
  for (const Triangle& t : result.triangles) {
    const Vec3& a = hexagon[t[0]];
    EXPECT_GT((hexagon[t[1]] - a).cross(hexagon[t[2]] - a).norm(), 1e-10);
  }
}

TEST(TriangulatePolygons, RepeatsAnEdgeOnlyWhereThereIsNoOtherWay) {
  // Both diagonals of the square are edges of triangles.
  const Polygons crossed{{0, 1, 2, 3, 0, 2, 4, 1, 3, 4}, {4, 7, 10}};
  const Triangulation result = triangulate(kSquare, crossed, Work(1));
  expect_complete(crossed, result);
  EXPECT_EQ(result.first_repeating, 0);
  const Polygons one{{0, 1, 2, 3, 0, 2, 4}, {4, 7}};
  const Triangulation free = triangulate(kSquare, one, Work(1));
  EXPECT_EQ(free.first_repeating, kNone);
  std::map<std::pair<Index, Index>, int> edges;
  for (const Triangle& triangle : free.triangles) {
    for (int k = 0; k < 3; ++k) {
      const Index a = one.corners[triangle[k]], b = one.corners[triangle[next_corner(k)]];
      EXPECT_EQ(++edges[std::minmax(a, b)] <= 2, true);
    }
  }
  EXPECT_EQ((edges[{0, 2}]), 1);
}

}  // namespace
}  // namespace beltrami
