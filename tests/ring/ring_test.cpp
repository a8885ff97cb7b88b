// The ring of a scaffold: exact, complete, constrained Delaunay, and an error for bad polygons.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/portable_math.h"
#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "exact/certificate.h"
#include "exact/crossings.h"
#include "exact/orientation.h"
#include "ring/ring_faces.h"
#include "ring/triangulate_ring.h"

namespace beltrami {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Polygon = std::vector<Vec2>;
using DirectedEdges = std::vector<std::pair<Index, Index>>;

constexpr double kPi = std::numbers::pi;

/// Uniform in [0, 1), the same on every system.
class Random {
 public:
  explicit Random(std::uint32_t seed) : engine_(seed) {}
  double operator()() { return engine_() * 0x1p-32; }
  int below(int count) { return static_cast<int>((*this)() * count); }

 private:
  std::mt19937 engine_;
};

// --- Polygons, all counter-clockwise ------------------------------------------------------------

Polygon polar(int count, std::uint32_t seed) {
  Random random(seed);
  Polygon polygon;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * kPi * (i + 0.9 * random()) / count;
    const double radius = 0.05 + random();
    polygon.emplace_back(radius * portable::cos(angle), radius * portable::sin(angle));
  }
  return polygon;
}

Polygon star(int spikes) {
  Polygon polygon;
  for (int i = 0; i < 2 * spikes; ++i) {
    const double angle = kPi * i / spikes;
    const double radius = i % 2 == 0 ? 1 : 1e-3;
    polygon.emplace_back(radius * portable::cos(angle), radius * portable::sin(angle));
  }
  return polygon;
}

/// An arm that winds `turns` times around, with channels of about its own width.
Polygon spiral(int turns, int per_turn) {
  const int count = turns * per_turn;
  const auto at = [&](int i, double shift) {
    const double angle = 2 * kPi * i / per_turn;
    const double radius = 1 + angle / (2 * kPi) + shift;
    return Vec2(radius * portable::cos(angle), radius * portable::sin(angle));
  };
  Polygon polygon;
  for (int i = 0; i <= count; ++i) polygon.push_back(at(i, 0.5));
  for (int i = count; i >= 0; --i) polygon.push_back(at(i, 0));
  return polygon;
}

/// Teeth that lean by `slant`, with channels of width `channel` between teeth of width 1 below.
Polygon comb(int teeth, double channel, double slant, double height) {
  Polygon polygon = {{0, -1}};
  polygon.emplace_back(teeth * (1 + channel), -1);
  for (int i = teeth - 1; i >= 0; --i) {
    const double left = i * (1 + channel);
    if (i < teeth - 1) polygon.emplace_back(left + 1, 0);
    polygon.emplace_back(left + 1 + slant, height);
    polygon.emplace_back(left + slant, height);
    polygon.emplace_back(left, 0);
  }
  return polygon;
}

/// The outline of random unit columns: many straight corners and many points on common circles.
Polygon skyline(int columns, std::uint32_t seed) {
  Random random(seed);
  Polygon polygon;
  for (int x = 0; x < columns; ++x) polygon.emplace_back(x, -1);
  int height = 0;
  for (int x = columns; x > 0; --x) {
    const int target = 1 + random.below(6);
    polygon.emplace_back(x, x == columns ? -1 : height);
    if (x == columns) height = -1;
    while (height != target) {
      height += height < target ? 1 : -1;
      polygon.emplace_back(x, height);
    }
  }
  for (; height >= 0; --height) polygon.emplace_back(0, height);
  return polygon;
}

/// Random points joined at random, then uncrossed by reversing the part between two crossing edges.
Polygon two_opt(int count, std::uint32_t seed) {
  Random random(seed);
  Polygon polygon;
  for (int i = 0; i < count; ++i) {
    const double x = random();
    polygon.emplace_back(x, random());
  }
  const auto cross = [&](int i, int j) {
    const Vec2 &a = polygon[i], &b = polygon[i + 1], &c = polygon[j], &d = polygon[(j + 1) % count];
    return orientation(a, b, c) != orientation(a, b, d) &&
           orientation(c, d, a) != orientation(c, d, b);
  };
  for (bool changed = true; changed;) {
    changed = false;
    for (int i = 0; i + 2 < count; ++i) {
      for (int j = i + 2; j < count - (i == 0 ? 1 : 0); ++j) {
        if (!cross(i, j)) continue;
        std::reverse(polygon.begin() + i + 1, polygon.begin() + j + 1);
        changed = true;
      }
    }
  }
  return polygon;
}

/// Corners with `per_edge` points on each edge, exactly collinear as all numbers are dyadic.
Polygon subdivide(const Polygon& corners, int per_edge) {
  Polygon polygon;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec2 step = (corners[(i + 1) % corners.size()] - corners[i]) / per_edge;
    for (int k = 0; k < per_edge; ++k) polygon.push_back(corners[i] + k * step);
  }
  return polygon;
}

double area(const Polygon& polygon) {
  long double sum = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 a = polygon[i] - polygon[0];
    const Vec2 b = polygon[(i + 1) % polygon.size()] - polygon[0];
    sum += static_cast<long double>(a.x()) * b.y() - static_cast<long double>(a.y()) * b.x();
  }
  return static_cast<double>(sum / 2);
}

Polygon with_direction(Polygon polygon) {
  if (area(polygon) < 0) std::reverse(polygon.begin(), polygon.end());
  return polygon;
}

bool is_simple(const Polygon& polygon) {
  std::vector<Index> loop(polygon.size());
  std::iota(loop.begin(), loop.end(), 0);
  return count_crossings(loop, polygon).count == 0;
}

// --- Checks -------------------------------------------------------------------------------------

bool is_strictly_in_circle(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const auto point = [](const Vec2& p) { return Kernel::Point_2(p.x(), p.y()); };
  return CGAL::side_of_oriented_circle(point(a), point(b), point(c), point(d)) ==
         CGAL::ON_POSITIVE_SIDE;
}

DirectedEdges sorted_edges(const std::vector<Triangle>& faces) {
  DirectedEdges edges;
  for (const Triangle& face : faces) {
    for (int k = 0; k < 3; ++k) edges.emplace_back(face[k], face[next_corner(k)]);
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

/// Positive faces, of which no two share a directed edge, and whose border is exactly the polygons'
/// edges with the ring on the right side: such faces fill the ring and do not overlap.
void expect_ring(const RingTriangulation& ring, const Polygon& inner, const Polygon& outer) {
  const Index n = size_of(inner), m = size_of(outer);
  ASSERT_EQ(size_of(ring.points), n + m);
  EXPECT_TRUE(std::equal(inner.begin(), inner.end(), ring.points.begin()));
  EXPECT_TRUE(std::equal(outer.begin(), outer.end(), ring.points.begin() + n));
  EXPECT_EQ(count_orientations(ring.faces, ring.points, Work(1)).positive, size_of(ring.faces));

  const DirectedEdges edges = sorted_edges(ring.faces);
  EXPECT_EQ(std::adjacent_find(edges.begin(), edges.end()), edges.end());
  DirectedEdges border;
  for (const auto& [a, b] : edges) {
    if (!std::binary_search(edges.begin(), edges.end(), std::pair(b, a))) border.emplace_back(a, b);
  }
  DirectedEdges expected;
  for (Index i = 0; i < n; ++i) expected.emplace_back((i + 1) % n, i);
  for (Index i = 0; i < m; ++i) expected.emplace_back(n + i, n + (i + 1) % m);
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(border, expected);

  const auto edge_count = static_cast<Index>((edges.size() + border.size()) / 2);
  EXPECT_EQ(n + m - edge_count + size_of(ring.faces), 0);  // Euler characteristic of a ring

  double sum = 0;
  for (const Triangle& f : ring.faces) {
    sum += area({ring.points[f[0]], ring.points[f[1]], ring.points[f[2]]});
  }
  const double expected_area = area(outer) - area(inner);
  EXPECT_NEAR(sum, expected_area, 1e-9 * expected_area);
}

/// No vertex across an edge of two faces is in the circle of either, which implies that the whole
/// is constrained Delaunay (Lee, Lin 1986, "Generalized Delaunay triangulation for planar graphs").
void expect_locally_delaunay(const RingTriangulation& ring) {
  std::vector<std::array<Index, 3>> apexes;  // tail, head, apex
  for (const Triangle& face : ring.faces) {
    for (int k = 0; k < 3; ++k) {
      apexes.push_back({face[k], face[next_corner(k)], face[previous_corner(k)]});
    }
  }
  std::sort(apexes.begin(), apexes.end());
  int bad = 0;
  for (const auto& [a, b, c] : apexes) {
    const auto twin = std::lower_bound(apexes.begin(), apexes.end(), std::array<Index, 3>{b, a, 0});
    if (twin == apexes.end() || (*twin)[0] != b || (*twin)[1] != a) continue;
    const auto& p = ring.points;
    bad += is_strictly_in_circle(p[a], p[b], p[c], p[(*twin)[2]]) ? 1 : 0;
  }
  EXPECT_EQ(bad, 0);
}

bool is_blocked(const Vec2& from, Index to, const RingTriangulation& ring, Index n) {
  for (Index i = 0; i < n; ++i) {
    const Index j = (i + 1) % n;
    if (i == to || j == to) continue;
    const Vec2 &a = ring.points[i], &b = ring.points[j], &p = ring.points[to];
    if (orientation(a, b, from) * orientation(a, b, p) <= 0 &&
        orientation(from, p, a) * orientation(from, p, b) <= 0) {
      return true;
    }
  }
  return false;
}

/// The definition: a vertex in a face's circle is hidden from the face by the inner polygon.
void expect_constrained_delaunay(const RingTriangulation& ring, Index n) {
  for (const Triangle& face : ring.faces) {
    const Vec2 &a = ring.points[face[0]], &b = ring.points[face[1]], &c = ring.points[face[2]];
    for (Index p = 0; p < size_of(ring.points); ++p) {
      if (!is_strictly_in_circle(a, b, c, ring.points[p])) continue;
      // At a corner of the polygon the sight line may leave through the polygon itself: then the
      // point just before the corner is what is seen from.
      for (const Vec2& w : {Vec2(0.4, 0.3), Vec2(0.1, 0.1), Vec2(0.8, 0.1), Vec2(0.1, 0.8)}) {
        const Vec2 from = w.x() * a + w.y() * b + (1 - w.sum()) * c;
        if (is_blocked(from, p, ring, n)) continue;
        const Vec2& before = ring.points[p < n ? (p + n - 1) % n : p];
        const Vec2& after = ring.points[p < n ? (p + 1) % n : p];
        const Vec2& at = ring.points[p];
        const bool left_of_in = orientation(before, at, from) > 0;
        const bool left_of_out = orientation(at, after, from) > 0;
        const bool is_convex = orientation(before, at, after) >= 0;
        const bool through_inside =
            p < n && (is_convex ? left_of_in && left_of_out : left_of_in || left_of_out);
        EXPECT_TRUE(through_inside)
            << "face " << face[0] << ' ' << face[1] << ' ' << face[2] << " sees vertex " << p;
      }
    }
  }
}

RingTriangulation expect_all(const Polygon& inner, const Polygon& outer) {
  RingTriangulation ring = triangulate_ring(inner, outer);
  expect_ring(ring, inner, outer);
  expect_locally_delaunay(ring);
  return ring;
}

/// Faces from their smallest vertex on, in order, after renaming inner vertex i to i + shift mod n.
std::vector<Triangle> canonical(std::vector<Triangle> faces, Index n, Index shift = 0) {
  for (Triangle& face : faces) {
    for (Index& v : face) v = v < n ? (v + shift) % n : v;
    std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
  }
  std::sort(faces.begin(), faces.end());
  return faces;
}

void expect_error(const Polygon& inner, const Polygon& outer) {
  try {
    triangulate_ring(inner, outer);
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::kInternal);
    EXPECT_EQ(std::string(error.what()).back(), '.');
  }
}

const Polygon kSquare = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
const Polygon kFrame = {{-4, -4}, {4, -4}, {4, 4}, {-4, 4}};

// --- Valid polygons -----------------------------------------------------------------------------

TEST(Ring, of_two_triangles_has_six_faces) {
  const Polygon inner = {{0, 0}, {1, 0}, {0, 1}};
  const Polygon outer = {{-5, -5}, {10, -5}, {-5, 10}};
  const RingTriangulation ring = expect_all(inner, outer);
  EXPECT_EQ(ring.faces.size(), 6u);
  expect_constrained_delaunay(ring, 3);
}

TEST(Ring, is_filled_around_every_shape) {
  for (const Polygon& inner :
       {star(5), star(200), spiral(5, 60), comb(40, 0.3, 0, 20), comb(40, 0.3, 15, 20),
        comb(100, 1e-3, 300, 1), skyline(60, 1), subdivide(kSquare, 64),
        subdivide({{0, 0}, {4, 1}, {8, 0}, {4, 8}}, 32)}) {
    ASSERT_TRUE(is_simple(inner));
    ASSERT_GT(area(inner), 0);
    for (const int count : {8, 100}) expect_all(inner, circle_around(inner, 1.5, count));
  }
}

TEST(Ring, is_constrained_delaunay_by_definition) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    for (const Polygon& inner : {polar(15, seed), with_direction(two_opt(18, seed)),
                                 skyline(4, seed), comb(4, 0.2, seed, 3)}) {
      const RingTriangulation ring = expect_all(inner, circle_around(inner, 1.4, 9));
      expect_constrained_delaunay(ring, size_of(inner));
    }
  }
}

TEST(Ring, is_filled_around_random_polygons) {
  for (std::uint32_t seed = 0; seed < 60; ++seed) {
    const Polygon radial = polar(3 + 11 * static_cast<int>(seed), seed);
    expect_all(radial, circle_around(radial, 2, 24));
    const Polygon tangled = with_direction(two_opt(3 + 2 * static_cast<int>(seed), seed));
    expect_all(tangled, circle_around(tangled, 1.2, 30));
  }
}

TEST(Ring, fits_channels_down_to_a_rounding_error) {
  for (const double width : {1e-3, 1e-6, 1e-9, 1e-12, 1e-15}) {
    // A slit from the left edge of a square with 16 points on each of its sides.
    Polygon inner = {{0, 0}, {2, 0}, {2, 2}, {0, 2}, {0, 1 + width}};
    for (int i = 1; i <= 16; ++i) inner.emplace_back(i / 16.0, 1 + width);
    for (int i = 16; i >= 0; --i) inner.emplace_back(i / 16.0, 1);
    expect_all(inner, circle_around(inner, 1.5, 20));
    const Polygon teeth = comb(50, std::max(width, 1e-13), 0, 3);
    expect_all(teeth, circle_around(teeth, 1.5, 20));
  }
}

TEST(Ring, may_be_as_thin_as_a_rounding_error) {
  const double e = std::numeric_limits<double>::epsilon();
  expect_all(kSquare, {{-e, -e}, {1 + e, -e}, {1 + e, 1 + e}, {-e, 1 + e}});
}

TEST(Ring, takes_an_outer_polygon_with_straight_corners) {
  for (const int per_edge : {2, 16, 256}) {
    expect_all(kSquare, subdivide(kFrame, per_edge));
    expect_all(subdivide(kSquare, per_edge), subdivide(kFrame, per_edge));
  }
}

TEST(Ring, takes_a_dense_circle) {
  expect_all(kSquare, circle_around(kSquare, 3, 3000));
}

TEST(Ring, takes_numbers_of_any_size) {
  const Polygon inner = skyline(12, 3);
  const Polygon outer = circle_around(inner, 1.5, 20);
  const auto scaled = [](Polygon polygon, double factor) {
    for (Vec2& p : polygon) p *= factor;
    return polygon;
  };
  const RingTriangulation ring = expect_all(inner, outer);
  for (const int power : {-1000, -300, -40, -1, 1, 40, 300, 1000}) {
    const double factor = std::ldexp(1.0, power);
    EXPECT_EQ(triangulate_ring(scaled(inner, factor), scaled(outer, factor)).faces, ring.faces)
        << power;
  }
}

TEST(Ring, does_not_depend_on_the_first_vertex) {
  // The skyline has many sets of four points on a circle: the choice between their diagonals too
  // must depend on the points alone.
  for (const Polygon& inner : {polar(80, 5), skyline(20, 7), subdivide(kSquare, 32)}) {
    const Index n = size_of(inner);
    const Polygon outer = circle_around(inner, 1.5, 16);
    const auto expected = canonical(triangulate_ring(inner, outer).faces, n);
    for (const Index shift : {1, 7, n / 2, n - 1}) {
      Polygon rotated = inner;
      std::rotate(rotated.begin(), rotated.begin() + shift, rotated.end());
      EXPECT_EQ(canonical(triangulate_ring(rotated, outer).faces, n, shift), expected);
    }
  }
}

TEST(Ring, is_the_same_each_time) {
  const Polygon inner = polar(500, 9);
  const Polygon outer = circle_around(inner, 1.5, 50);
  EXPECT_EQ(triangulate_ring(inner, outer).faces, triangulate_ring(inner, outer).faces);
}

TEST(Ring, of_large_polygons_is_complete) {
  for (const Polygon& inner :
       {polar(50'000, 1), spiral(50, 500), comb(12'500, 0.5, 4000, 4000), skyline(12'000, 2)}) {
    expect_all(inner, circle_around(inner, 1.5, 100));
  }
}

// --- Invalid polygons ---------------------------------------------------------------------------

TEST(Ring, exists_exactly_if_the_inner_polygon_is_simple_and_counter_clockwise) {
  int valid = 0;
  for (std::uint32_t seed = 0; seed < 20'000; ++seed) {
    Random random(seed);
    Polygon inner;
    for (int i = 3 + random.below(6); i > 0; --i) {
      const int x = random.below(6);
      inner.emplace_back(x, random.below(6));
    }
    const Polygon outer = {{-1, -2}, {8, -1}, {6, 7}, {-2, 6}};
    if (is_simple(inner) && area(inner) > 0) {
      ++valid;
      expect_all(inner, outer);
    } else {
      expect_error(inner, outer);
    }
  }
  EXPECT_GT(valid, 1000);
}

TEST(Ring, needs_a_simple_inner_polygon) {
  expect_error({{0, 0}, {1, 1}, {1, 0}, {0, 1}}, kFrame);          // crosses itself
  expect_error({{0, 0}, {1, 0}, {1, 0}, {0, 1}}, kFrame);          // repeats a vertex
  expect_error({{0, 0}, {2, 0}, {1, 0}, {1, 1}}, kFrame);          // folds back
  expect_error({{0, 0}, {2, 0}, {2, 2}, {1, 0}, {0, 2}}, kFrame);  // touches itself
  expect_error({{0, 0}, {0, 1}, {1, 1}, {1, 0}}, kFrame);          // clockwise
  expect_error({{0, 0}, {1, 0}}, kFrame);
  expect_error({{0, 0}, {0, 0}, {0, 0}}, kFrame);
  expect_error({{0, 0}, {1, 0}, {2, 0}}, kFrame);
  expect_error({}, kFrame);
}

TEST(Ring, needs_a_convex_outer_polygon_strictly_around) {
  expect_error(kSquare, {{-1, -1}, {1, 0}, {3, -1}, {3, 3}, {-1, 3}});   // passes through a vertex
  expect_error(kSquare, {{-4, -4}, {4, -4}, {2, 2}, {4, 4}, {-4, 4}});   // not convex
  expect_error(kSquare, {{-4, -4}, {-4, 4}, {4, 4}, {4, -4}});           // clockwise
  expect_error(kSquare, {{-4, -4}, {4, -4}, {4, -4}, {4, 4}, {-4, 4}});  // repeats a vertex
  expect_error(kSquare, {{-4, -4}, {4, -4}, {0, -4}, {4, 4}, {-4, 4}});  // folds back
  expect_error(kSquare, {{-4, -4}, {4, -4}});
  expect_error(kSquare, {{-4, 0}, {4, 0}, {0, 0}});
  expect_error(kSquare, kSquare);
  expect_error(kSquare, {{0, -4}, {4, -4}, {4, 4}, {0, 4}});        // touches
  expect_error(kSquare, {{0.5, -4}, {4, -4}, {4, 4}, {0.5, 4}});    // crosses
  expect_error(kSquare, {{10, 10}, {11, 10}, {11, 11}, {10, 11}});  // is elsewhere
  Polygon pentagram = circle_around(kSquare, 9, 5);
  pentagram = {pentagram[0], pentagram[2], pentagram[4], pentagram[1], pentagram[3]};
  expect_error(kSquare, pentagram);
}

TEST(Ring, needs_finite_numbers) {
  for (const double bad : {std::numeric_limits<double>::infinity(), std::nan("")}) {
    expect_error({{0, 0}, {1, 0}, {bad, 1}}, kFrame);
    expect_error(kSquare, {{-4, -4}, {4, bad}, {4, 4}, {-4, 4}});
  }
}

TEST(CircleAround, is_centred_on_the_box) {
  const Polygon circle = circle_around({{1, 1}, {7, 1}, {7, 9}}, 2, 12);
  ASSERT_EQ(circle.size(), 12u);
  for (const Vec2& p : circle) EXPECT_NEAR((p - Vec2(4, 5)).norm(), 10, 1e-12);
  EXPECT_NEAR(area(circle), 6 * 100 * std::sin(kPi / 6), 1e-9);
}

TEST(GlueRing, numbers_the_boundary_as_the_mesh_does_and_the_circle_from_where_it_is_told) {
  // Vertices 3, 1, 4 of a mesh of six, whose circle is to start at 6.
  const std::vector<Vec2> triangle = {{0, 0}, {1, 0}, {0, 1}};
  const RingTriangulation ring = triangulate_ring(triangle, scaffold_circle(triangle));
  std::vector<Triangle> faces = {{3, 1, 4}};
  glue_ring(ring.faces, {3, 1, 4}, 6, faces);
  ASSERT_EQ(faces.size(), 1 + ring.faces.size());
  std::map<std::pair<Index, Index>, int> uses;  // of directed edges
  for (const Triangle& t : faces) {
    for (int k = 0; k < 3; ++k) ++uses[{t[k], t[next_corner(k)]}];
  }
  for (const auto& [edge, count] : uses) {
    EXPECT_EQ(count, 1);
    const bool on_circle = edge.first >= 6 && edge.second >= 6;
    EXPECT_TRUE(on_circle || uses.contains({edge.second, edge.first}));
  }
  EXPECT_TRUE(uses.contains({1, 3}));  // the mesh's edge from 3 to 1 has a neighbour
}

}  // namespace
}  // namespace beltrami
