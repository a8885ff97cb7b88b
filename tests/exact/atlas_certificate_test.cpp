// The certificate of an atlas against areas in rational numbers, where everything is degenerate.
#include "exact/atlas_certificate.h"

#include <gtest/gtest.h>

#include <CGAL/Quotient.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/resources.h"
#include "exact/exact_number.h"
#include "support/disks.h"
#include "support/polls.h"

namespace beltrami {
namespace {

using disks::Random;
using Pair = std::array<Index, 2>;

struct Atlas {
  std::vector<Vec2> uvs;
  std::vector<Triangle> faces;

  /// Triangles of their own vertices.
  Atlas& add(const Vec2& a, const Vec2& b, const Vec2& c) {
    const Index first = size_of(uvs);
    uvs.insert(uvs.end(), {a, b, c});
    faces.push_back({first, first + 1, first + 2});
    return *this;
  }

  /// The cells of an nx by ny grid that `keeps(i, j)` keeps, from `corner` on, mapped by `place`.
  template <class Keeps, class Place>
  Atlas& add_cells(Index nx, Index ny, const Keeps& keeps, const Place& place) {
    const Index first = size_of(uvs);
    for (Index j = 0; j <= ny; ++j) {
      for (Index i = 0; i <= nx; ++i) uvs.push_back(place(Vec2(i, j)));
    }
    for (Index j = 0; j < ny; ++j) {
      for (Index i = 0; i < nx; ++i) {
        if (!keeps(i, j)) continue;
        const Index a = first + j * (nx + 1) + i, b = a + 1, c = a + nx + 1, d = c + 1;
        faces.push_back({a, b, d});
        faces.push_back({a, d, c});
      }
    }
    return *this;
  }

  Atlas& add_grid(Index nx, Index ny, const Vec2& corner, double cell = 1) {
    return add_cells(
        nx, ny, [](Index, Index) { return true; }, [&](Vec2 p) -> Vec2 { return corner + cell * p; });
  }
};

AtlasCertificate certify(const Atlas& atlas, const AtlasRules& rules = {}, int threads = 1) {
  return certify_atlas(atlas.faces, atlas.uvs, rules, Work(threads));
}

// ---- An independent answer: pairs of triangles by the area that they have in common -----------

using Rational = CGAL::Quotient<ExactNumber>;
using RationalPoint = std::array<Rational, 2>;

Rational twice_area(const RationalPoint& a, const RationalPoint& b, const RationalPoint& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/// Counter-clockwise; empty if it has no area.
std::vector<RationalPoint> rational_triangle(const Atlas& atlas, Index f) {
  std::vector<RationalPoint> points;
  for (const Index v : atlas.faces[f]) {
    points.push_back({Rational(atlas.uvs[v].x()), Rational(atlas.uvs[v].y())});
  }
  const auto sign = CGAL::sign(twice_area(points[0], points[1], points[2]));
  if (sign == CGAL::ZERO) return {};
  if (sign == CGAL::NEGATIVE) std::swap(points[1], points[2]);
  return points;
}

/// What of a convex polygon is on the left of a line (Sutherland & Hodgman 1974).
std::vector<RationalPoint> clip(const std::vector<RationalPoint>& polygon, const RationalPoint& a,
                                const RationalPoint& b) {
  std::vector<RationalPoint> clipped;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const RationalPoint &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const Rational at_p = twice_area(a, b, p), at_q = twice_area(a, b, q);
    const Rational zero(0);
    if (at_p >= zero) clipped.push_back(p);
    if ((at_p > zero && at_q < zero) || (at_p < zero && at_q > zero)) {
      const Rational t = at_p / (at_p - at_q);
      clipped.push_back({p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])});
    }
  }
  return clipped;
}

bool overlap_in_rationals(const std::vector<RationalPoint>& f,
                          const std::vector<RationalPoint>& g) {
  if (f.empty() || g.empty()) return false;
  std::vector<RationalPoint> common = f;
  for (int k = 0; k < 3; ++k) common = clip(common, g[k], g[(k + 1) % 3]);
  Rational area(0);
  for (std::size_t i = 2; i < common.size(); ++i) {
    area += twice_area(common[0], common[i - 1], common[i]);
  }
  return area > Rational(0);
}

std::vector<Pair> overlaps_by_force(const Atlas& atlas) {
  std::vector<std::vector<RationalPoint>> triangles;
  for (Index f = 0; f < size_of(atlas.faces); ++f) {
    triangles.push_back(rational_triangle(atlas, f));
  }
  std::vector<Pair> pairs;
  for (Index f = 0; f < size_of(triangles); ++f) {
    for (Index g = f + 1; g < size_of(triangles); ++g) {
      if (overlap_in_rationals(triangles[f], triangles[g])) pairs.push_back({f, g});
    }
  }
  return pairs;
}

/// The verdict is that of force, and what is listed overlaps.
void expect_as_by_force(const Atlas& atlas, int& injective) {
  const AtlasCertificate found = certify(atlas, {{}, false, 1000});
  const std::vector<Pair> expected = overlaps_by_force(atlas);
  ASSERT_EQ(found.overlaps.faces == 0, expected.empty());
  ASSERT_EQ(found.overlaps.first_faces.size(), static_cast<std::size_t>(found.overlaps.faces));
  ASSERT_TRUE(std::includes(expected.begin(), expected.end(), found.overlaps.first_faces.begin(),
                            found.overlaps.first_faces.end()));
  for (const auto& [e, f] : found.overlaps.first_edges) {
    const Pair faces = {e / 3, f / 3};
    ASSERT_TRUE(std::binary_search(expected.begin(), expected.end(), faces));
  }
  injective += expected.empty();
}

/// Triangles on a grid of `range` places a side; every other one takes over an edge of an earlier.
Atlas random_soup(Random& random, int faces, int range) {
  Atlas atlas;
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
    const Atlas atlas = random_soup(random, 2 + random.below(5), 3 + random.below(3));
    ASSERT_NO_FATAL_FAILURE(expect_as_by_force(atlas, injective)) << i;
  }
  EXPECT_GT(injective, 500);
  EXPECT_LT(injective, 5500);
}

}  // namespace
}  // namespace beltrami
