// The certificate: signs that doubles get wrong, and every way in which a polygon meets itself.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

#include "base/interrupt.h"
#include "base/portable_math.h"
#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "exact/certificate.h"
#include "exact/crossings.h"
#include "exact/orientation.h"
#include "mesh/disk_mesh.h"
#include "support/disks.h"
#include "support/meshes.h"
#include "support/polls.h"

namespace beltrami {
namespace {

using disks::Random;

std::vector<Index> loop_of(const std::vector<Vec2>& polygon) {
  std::vector<Index> loop(polygon.size());
  std::iota(loop.begin(), loop.end(), 0);
  return loop;
}

std::int64_t crossings(const std::vector<Vec2>& polygon) {
  return count_crossings(loop_of(polygon), polygon).count;
}

int sign(double x) {
  return (x > 0) - (x < 0);
}

// ---- Orientation ----------------------------------------------------------------------------

// Kettner et al. 2008, "Classroom examples of robustness problems", section 3.
TEST(Orientation, IsExactNextToADiagonalWhereDoublesFail) {
  const Vec2 q(12, 12), r(24, 24);
  int wrong_in_doubles = 0;
  for (int i = 0; i < 64; ++i) {
    for (int j = 0; j < 64; ++j) {
      const Vec2 p(0.5 + i * 0x1p-53, 0.5 + j * 0x1p-53);
      ASSERT_EQ(orientation(p, q, r), sign(j - i)) << i << ' ' << j;
      const Vec2 a = q - p, b = r - p;
      wrong_in_doubles += sign(a.x() * b.y() - a.y() * b.x()) != sign(j - i);
    }
  }
  EXPECT_GT(wrong_in_doubles, 0);
}

TEST(Orientation, IsExactForSubnormalCoordinates) {
  constexpr double kTiny = std::numeric_limits<double>::denorm_min();
  EXPECT_EQ(orientation({0, 0}, {kTiny, 0}, {0, kTiny}), 1);
  EXPECT_EQ(orientation({0, 0}, {0, kTiny}, {kTiny, 0}), -1);
  EXPECT_EQ(orientation({0, 0}, {kTiny, kTiny}, {2 * kTiny, 2 * kTiny}), 0);
  EXPECT_EQ(orientation({0, 0}, {1, kTiny}, {2, 2 * kTiny}), 0);
  EXPECT_EQ(orientation({0, 0}, {1, kTiny}, {2, 3 * kTiny}), 1);
  EXPECT_EQ(orientation({0, 0}, {1, kTiny}, {2, kTiny}), -1);
}

TEST(Orientation, IsExactForHugeCoordinates) {
  EXPECT_EQ(orientation({0, 0}, {1e300, 1e300}, {2e300, 2e300}), 0);
  EXPECT_EQ(orientation({0, 0}, {1e300, 1e300}, {1e300, std::nextafter(1e300, 2e300)}), 1);
}

/// Of whole numbers below 2^52.
int orientation_of_integers(const std::array<std::array<std::int64_t, 2>, 3>& p) {
  __extension__ using Long = __int128;
  const auto edge = [&](int i, int k) -> Long { return p[i][k] - p[2][k]; };
  const auto left = edge(0, 0) * edge(1, 1), right = edge(0, 1) * edge(1, 0);
  return left > right ? 1 : left < right ? -1 : 0;
}

TEST(Orientation, AgreesWithWholeNumbersAtAnyScale) {
  // Next to a line, on grids of all kinds: near, far from the origin, and where products underflow.
  Random random(3);
  std::array<int, 3> seen{};
  for (int i = 0; i < 20000; ++i) {
    const std::int64_t size = std::int64_t{1} << (2 + random.below(49));
    const std::int64_t offset = std::int64_t{1} << random.below(51);
    const auto any = [&] { return static_cast<std::int64_t>(random.between(-1, 1) * size); };
    const std::int64_t ux = any() / 4, uy = any() / 4;
    const std::array<std::array<std::int64_t, 2>, 3> p = {
        {{offset, offset},
         {offset + ux, offset + uy},
         {offset + 2 * ux + random.below(3) - 1, offset + 2 * uy + random.below(3) - 1}}};
    const double scale = std::ldexp(1.0, random.below(2) == 0 ? 0 : random.below(1900) - 1000);
    const auto at = [&](int k) -> Vec2 {
      return scale * Vec2(static_cast<double>(p[k][0]), static_cast<double>(p[k][1]));
    };
    const int expected = orientation_of_integers(p);
    ASSERT_EQ(orientation(at(0), at(1), at(2)), expected) << i;
    ++seen[expected + 1];
  }
  for (const int count : seen) EXPECT_GT(count, 1000);
}

TEST(Orientation, IsZeroWhereACoordinateIsNoNumber) {
  for (const double bad :
       {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
        std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_EQ(orientation({0, 0}, {bad, 0}, {0, 1}), 0);
    EXPECT_EQ(orientation({0, bad}, {bad, 1}, {0, 1}), 0);
  }
}

TEST(Orientation, IsAntisymmetricAndCyclic) {
  Random random(1);
  for (int i = 0; i < 200; ++i) {
    const Vec2 a = random.vec2(), b = random.vec2();
    const Vec2 c = a + random.between(-1, 1) * (b - a);  // collinear but for the rounding
    EXPECT_EQ(orientation(a, b, c), orientation(b, c, a));
    EXPECT_EQ(orientation(a, b, c), -orientation(b, a, c));
  }
}

TEST(CountOrientations, CountsEachSignAndFindsTheFirstBadFace) {
  const std::vector<Vec2> uvs = {{0, 0}, {1, 0}, {0, 1}, {2, 0}};
  const std::vector<Triangle> faces = {{0, 1, 2}, {0, 1, 3}, {0, 2, 1}, {1, 2, 0}};
  const Orientations counts = count_orientations(faces, uvs, Work(1));
  EXPECT_EQ(counts.positive, 2);
  EXPECT_EQ(counts.degenerate, 1);
  EXPECT_EQ(counts.negative, 1);
  EXPECT_EQ(counts.first_bad_face, 1);
  EXPECT_EQ(non_positive_faces(faces, uvs, Work(1)), (std::vector<Index>{1, 2}));
}

TEST(CountOrientations, HasNoBadFaceWhereAllArePositive) {
  const DiskMesh mesh = disks::disk(meshes::grid(3, 3));
  const Orientations counts = count_orientations(mesh.faces, disks::flat_uvs(mesh), Work(1));
  EXPECT_EQ(counts.positive, 18);
  EXPECT_EQ(counts.first_bad_face, kNone);
}

TEST(CountOrientations, IsTheSameOnTwoThreads) {
  Random random(2);
  std::vector<Vec2> uvs(1000);
  for (Vec2& w : uvs) w = random.vec2();
  std::vector<Triangle> faces(20000);
  for (Triangle& t : faces) t = {random.below(1000), random.below(1000), random.below(1000)};
  const Orientations one = count_orientations(faces, uvs, Work(1));
  const Orientations two = count_orientations(faces, uvs, Work(2));
  EXPECT_EQ(one.positive, two.positive);
  EXPECT_EQ(one.negative, two.negative);
  EXPECT_EQ(one.degenerate, two.degenerate);
  EXPECT_EQ(one.first_bad_face, two.first_bad_face);
  EXPECT_EQ(one.positive + one.negative + one.degenerate, 20000);
  EXPECT_EQ(non_positive_faces(faces, uvs, Work(1)), non_positive_faces(faces, uvs, Work(2)));
}

// ---- Crossings ------------------------------------------------------------------------------

TEST(Crossings, AreNoneOnConvexLoops) {
  EXPECT_EQ(crossings({{0, 0}, {1, 0}, {0, 1}}), 0);
  EXPECT_EQ(crossings({{0, 0}, {1, 0}, {1, 1}, {0, 1}}), 0);
  std::vector<Vec2> circle;
  for (int i = 0; i < 100; ++i) {
    const double angle = 2 * std::numbers::pi * i / 100;
    circle.push_back({portable::cos(angle), portable::sin(angle)});
  }
  EXPECT_EQ(crossings(circle), 0);
}

TEST(Crossings, AreNoneWhereNeighboursGoStraightOn) {
  EXPECT_EQ(crossings({{0, 0}, {1, 0}, {2, 0}, {2, 1}, {2, 2}, {1, 1}}), 0);
}

TEST(Crossings, FindTheOneOfAFigureEight) {
  const std::vector<Vec2> eight = {{0, 0}, {1, 1}, {1, 0}, {0, 1}};
  const Crossings found = count_crossings(loop_of(eight), eight);
  EXPECT_EQ(found.count, 1);
  EXPECT_EQ(std::minmax(found.first_pair[0], found.first_pair[1]), std::minmax<Index>(0, 2));
}

TEST(Crossings, ReportVerticesAndNotPositionsInTheLoop) {
  const std::vector<Vec2> uvs = {{9, 9}, {0, 1}, {1, 0}, {1, 1}, {0, 0}};
  const Crossings found = count_crossings({4, 3, 2, 1}, uvs);
  EXPECT_EQ(found.count, 1);
  EXPECT_EQ(std::minmax(found.first_pair[0], found.first_pair[1]), std::minmax<Index>(2, 4));
}

TEST(Crossings, CountAVertexThatTouchesAnEdge) {
  // The apex (1, 0) lies within the bottom edge and on two edges of its own.
  EXPECT_EQ(crossings({{0, 0}, {2, 0}, {2, 2}, {1, 0}, {0, 2}}), 2);
}

TEST(Crossings, CountVerticesThatCoincide) {
  // Two triangles that meet in a point: each edge there meets both of the other triangle's.
  EXPECT_EQ(crossings({{0, 0}, {1, -1}, {1, 1}, {0, 0}, {-1, 1}, {-1, -1}}), 4);
}

TEST(Crossings, CountCollinearOverlap) {
  EXPECT_EQ(crossings({{0, 0}, {3, 0}, {3, 1}, {2, 0}, {1, 0}, {1, 2}}), 3);
}

TEST(Crossings, CountASpikeThatFoldsBackOntoItsNeighbour) {
  EXPECT_EQ(crossings({{0, 0}, {2, 0}, {1, 0}, {1, 1}}), 2);
  EXPECT_GE(crossings({{0, 0}, {2, 0}, {0, 0}}), 1);
}

TEST(Crossings, CountAnEdgeOfNoLength) {
  // It meets both neighbours in more than the shared end, and they meet each other.
  EXPECT_EQ(crossings({{0, 0}, {1, 0}, {1, 0}, {1, 1}, {0, 1}}), 3);
}

TEST(Crossings, CountACollapsedTriangle) {
  EXPECT_EQ(crossings({{1, 1}, {1, 1}, {1, 1}}), 3);
  EXPECT_GE(crossings({{0, 0}, {1, 1}, {2, 2}}), 1);
}

TEST(Crossings, AreDecidedExactly) {
  // The fourth vertex lies off the diagonal by two units in the last place, or on it.
  EXPECT_EQ(crossings({{0.5, 0.5}, {24, 24}, {12, 24}, {12, 12 + 0x1p-48}, {0, 24}}), 0);
  EXPECT_EQ(crossings({{0.5, 0.5}, {24, 24}, {12, 24}, {12, 12}, {0, 24}}), 2);
}

TEST(FindCrossings, GivesThePairsThatAreCountedByPositionInTheLoop) {
  const std::vector<Vec2> uvs = {{9, 9}, {0, 1}, {1, 0}, {1, 1}, {0, 0}};
  const auto pairs = find_crossings({4, 3, 2, 1}, uvs);
  ASSERT_EQ(pairs.size(), 1u);
  EXPECT_EQ(std::min(pairs[0][0], pairs[0][1]), 0);
  EXPECT_EQ(std::max(pairs[0][0], pairs[0][1]), 2);
  EXPECT_TRUE(find_crossings({0, 1, 2}, {{0, 0}, {1, 0}, {0, 1}}).empty());
}

std::vector<Vec2> spiral(int half) {
  std::vector<Vec2> polygon;
  const auto at = [&](int i, double inset) {
    const double angle = 40 * std::numbers::pi * i / half;
    const double radius = 1 + angle - inset;
    polygon.push_back({radius * portable::cos(angle), radius * portable::sin(angle)});
  };
  for (int i = 0; i < half; ++i) at(i, 0);
  for (int i = half - 1; i >= 0; --i) at(i, 0.9);
  return polygon;
}

TEST(Crossings, AreNoneOnALongSpiral) {
  EXPECT_EQ(crossings(spiral(3000)), 0);
}

TEST(Crossings, SeeASpiralWhoseArmIsPushedThroughTheNext) {
  std::vector<Vec2> polygon = spiral(3000);
  polygon[1500] *= 1.2;
  EXPECT_GE(crossings(polygon), 2);
}

// An independent answer for small whole coordinates, in integers.
struct Point {
  std::int64_t x, y;
};

std::int64_t turn(Point a, Point b, Point c) {
  const std::int64_t area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  return (area > 0) - (area < 0);
}

bool in_box(Point p, Point a, Point b) {
  return std::min(a.x, b.x) <= p.x && p.x <= std::max(a.x, b.x) && std::min(a.y, b.y) <= p.y &&
         p.y <= std::max(a.y, b.y);
}

bool segments_share_a_point(Point a, Point b, Point c, Point d) {
  const auto abc = turn(a, b, c), abd = turn(a, b, d), cda = turn(c, d, a), cdb = turn(c, d, b);
  if (abc * abd < 0 && cda * cdb < 0) return true;
  return (abc == 0 && in_box(c, a, b)) || (abd == 0 && in_box(d, a, b)) ||
         (cda == 0 && in_box(a, c, d)) || (cdb == 0 && in_box(b, c, d));
}

/// Whether a-b and b-c share more than b.
bool overlap_behind(Point a, Point b, Point c) {
  if ((a.x == b.x && a.y == b.y) || (b.x == c.x && b.y == c.y)) return true;
  return turn(a, b, c) == 0 && (a.x - b.x) * (c.x - b.x) + (a.y - b.y) * (c.y - b.y) > 0;
}

std::int64_t crossings_by_force(const std::vector<Point>& p) {
  const int n = static_cast<int>(p.size());
  std::int64_t count = 0;
  for (int i = 0; i < n; ++i) {
    for (int j = i + 1; j < n; ++j) {
      const Point a = p[i], b = p[i + 1], c = p[j], d = p[(j + 1) % n];
      bool illegal = false;
      if (j == i + 1) illegal = overlap_behind(a, b, d);
      if (i == (j + 1) % n) illegal = illegal || overlap_behind(c, a, b);
      if (j != i + 1 && i != (j + 1) % n) illegal = segments_share_a_point(a, b, c, d);
      count += illegal;
    }
  }
  return count;
}

void expect_as_by_force(Random& random, int vertices, int range) {
  std::vector<Point> points;
  std::vector<Vec2> uvs;
  for (int i = 0; i < vertices; ++i) {
    points.push_back({random.below(range), random.below(range)});
    uvs.push_back({static_cast<double>(points.back().x), static_cast<double>(points.back().y)});
  }
  ASSERT_EQ(crossings(uvs), crossings_by_force(points)) << vertices << " in " << range;
}

TEST(Crossings, AreAsManyAsByForceOnDegenerateRandomPolygons) {
  Random random(3);
  for (int i = 0; i < 3000; ++i) expect_as_by_force(random, 3 + random.below(12), 4);
}

TEST(Crossings, AreAsManyAsByForceOnLargeRandomPolygons) {
  Random random(4);
  for (int i = 0; i < 10; ++i) expect_as_by_force(random, 200 + random.below(100), 1000);
}

// ---- What crossings cost ------------------------------------------------------------------

/// Radial teeth: the boxes of most pairs of edges overlap, and no edges meet.
std::vector<Vec2> star(int vertices) {
  std::vector<Vec2> polygon;
  for (int i = 0; i < vertices; ++i) {
    const double angle = 2 * std::numbers::pi * i / vertices, radius = i % 2 == 0 ? 1 : 0.1;
    polygon.push_back(radius * Vec2(std::cos(angle), std::sin(angle)));
  }
  return polygon;
}

/// Down diagonals side by side: every box holds the next one, and no edges meet.
std::vector<Vec2> nested(int vertices) {
  std::vector<Vec2> polygon;
  for (int i = 0; i < vertices; ++i) {
    const int pair = i / 2;
    const double x = pair;
    polygon.push_back((i % 4 == 0 || i % 4 == 3) ? Vec2(x, 0) : Vec2(1e6 + x, 1e6));
  }
  polygon.push_back({2e6, -1});
  polygon.push_back({0, -1});
  return polygon;
}

std::vector<Vec2> all_in_one_place(int vertices) {
  return std::vector<Vec2>(vertices, Vec2(0, 0));
}

/// All edges share one line.
std::vector<Vec2> collinear(int vertices) {
  Random random(5);
  std::vector<Vec2> polygon;
  for (int i = 0; i < vertices; ++i) polygon.push_back(random.between(0, 1) * Vec2(3, 1));
  return polygon;
}

TEST(Crossings, TakeLittleMoreThanTwiceTheWorkForTwiceTheEdges) {
  for (const auto& make : {star, nested, all_in_one_place, collinear}) {
    const auto polls = [&](int vertices) {
      const std::vector<Vec2> polygon = make(vertices);
      return count_polls([&] { count_crossings(loop_of(polygon), polygon); });
    };
    EXPECT_LE(polls(40000), 2.5 * static_cast<double>(polls(20000)) + 10);
  }
}

TEST(IsSimple, TakesLittleMoreThanTwiceTheWorkForTwiceTheEdges) {
  for (const auto& make : {star, nested, all_in_one_place, collinear}) {
    const auto polls = [&](int vertices) {
      const std::vector<Vec2> polygon = make(vertices);
      return count_polls([&] { is_simple(loop_of(polygon), polygon); });
    };
    EXPECT_LE(polls(80000), 2.5 * static_cast<double>(polls(40000)) + 10);
  }
}

TEST(Crossings, AreNoneBetweenLongEdgesSideBySide) {
  EXPECT_EQ(crossings(star(3000)), 0);
  EXPECT_EQ(crossings(nested(3000)), 0);
}

TEST(IsSimple, TellsWhereVeryManyBoxesMeet) {
  std::vector<Vec2> polygon = nested(6000);
  EXPECT_TRUE(is_simple(loop_of(polygon), polygon));
  polygon[5900].x() -= 2;
  EXPECT_FALSE(is_simple(loop_of(polygon), polygon));
}

TEST(Crossings, ListsABoundedNumberWhereAllVerticesCoincide) {
  const std::vector<Vec2> polygon = all_in_one_place(50000);
  const auto pairs = find_crossings(loop_of(polygon), polygon);
  EXPECT_GE(pairs.size(), polygon.size() - 1);
  EXPECT_LE(pairs.size(), 6 * polygon.size());
}

TEST(IsSimple, AgreesWithForceOnDegenerateRandomPolygons) {
  Random random(6);
  int simple = 0;
  for (int i = 0; i < 3000; ++i) {
    const int vertices = 3 + random.below(6);
    std::vector<Point> points;
    std::vector<Vec2> uvs;
    for (int k = 0; k < vertices; ++k) {
      points.push_back({random.below(5), random.below(5)});
      uvs.push_back({static_cast<double>(points.back().x), static_cast<double>(points.back().y)});
    }
    const bool expected = crossings_by_force(points) == 0;
    ASSERT_EQ(is_simple(loop_of(uvs), uvs), expected) << i;
    simple += expected;
  }
  EXPECT_GT(simple, 100);
}

TEST(Crossings, AreCancelledAtEveryPoll) {
  const std::vector<Vec2> polygon = star(8000);
  const auto run = [&] { count_crossings(loop_of(polygon), polygon); };
  const std::int64_t polls = count_polls(run);
  ASSERT_GT(polls, 10);
  for (std::int64_t k = 1; k <= polls; ++k) EXPECT_THROW(count_polls(run, k), Cancelled) << k;
}

// ---- The certificate ------------------------------------------------------------------------

TEST(Certificate, ProvesAFlatGridInjective) {
  const DiskMesh mesh = disks::disk(meshes::grid(4, 3));
  EXPECT_TRUE(certify(mesh.faces, mesh.boundary, disks::flat_uvs(mesh), Work(1)).injective());
}

TEST(Certificate, SeesAFoldWhoseBoundaryIsSimple) {
  const DiskMesh mesh = disks::disk(meshes::grid(4, 4));
  std::vector<Vec2> uvs = disks::flat_uvs(mesh);
  uvs[12] = {0.9, 0.5};
  const Certificate found = certify(mesh.faces, mesh.boundary, uvs, Work(1));
  EXPECT_FALSE(found.injective());
  EXPECT_GT(found.orientations.negative + found.orientations.degenerate, 0);
  EXPECT_EQ(found.crossings.count, 0);
}

TEST(Certificate, SeesAnOverlapWhoseFacesAreAllPositive) {
  // A strip wound around a centre by more than a whole turn.
  const DiskMesh mesh = disks::disk(meshes::strip(30));
  std::vector<Vec2> uvs;
  for (const Vec3& p : mesh.positions) {
    const double angle = -2.5 * std::numbers::pi * p.x(), radius = 1 + p.y();
    uvs.push_back({radius * portable::cos(angle), radius * portable::sin(angle)});
  }
  const Certificate found = certify(mesh.faces, mesh.boundary, uvs, Work(1));
  EXPECT_EQ(found.orientations.positive, 60);
  EXPECT_GT(found.crossings.count, 0);
  EXPECT_FALSE(found.injective());
}

}  // namespace
}  // namespace beltrami
