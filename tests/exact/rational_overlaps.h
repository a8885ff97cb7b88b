// Atlases for tests, and which of their triangles overlap, by the areas that they have in common in
// rational numbers: pair by pair, and without the predicates of the library.
#pragma once

#include <CGAL/MP_Float.h>
#include <CGAL/Quotient.h>

#include <Eigen/Geometry>
#include <array>
#include <map>
#include <utility>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"

namespace beltrami {

struct UvFaces {
  std::vector<Vec2> uvs;
  std::vector<Triangle> faces;

  /// Triangles of their own vertices.
  UvFaces& add(const Vec2& a, const Vec2& b, const Vec2& c) {
    const Index first = size_of(uvs);
    uvs.insert(uvs.end(), {a, b, c});
    faces.push_back({first, first + 1, first + 2});
    return *this;
  }

  /// The cells of an nx by ny grid that `keeps(i, j)` keeps, from `corner` on, mapped by `place`.
  template <class Keeps, class Place>
  UvFaces& add_cells(Index nx, Index ny, const Keeps& keeps, const Place& place) {
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

  UvFaces& add_grid(Index nx, Index ny, const Vec2& corner, double cell = 1) {
    return add_cells(
        nx, ny, [](Index, Index) { return true; },
        [&](const Vec2& p) -> Vec2 { return corner + cell * p; });
  }
};

using Pair = std::array<Index, 2>;
using Rational = CGAL::Quotient<CGAL::MP_Float>;
using RationalPoint = std::array<Rational, 2>;

inline Rational twice_area(const RationalPoint& a, const RationalPoint& b, const RationalPoint& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

inline std::array<RationalPoint, 3> rational_corners(const UvFaces& atlas, Index f) {
  std::array<RationalPoint, 3> points;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec2& w = atlas.uvs[atlas.faces[f][k]];
    points[k] = {Rational(w.x()), Rational(w.y())};
  }
  return points;
}

inline int rational_sign(const UvFaces& atlas, Index f) {
  const auto [a, b, c] = rational_corners(atlas, f);
  return static_cast<int>(CGAL::sign(twice_area(a, b, c)));
}

/// Counter-clockwise; empty if it has no area.
inline std::vector<RationalPoint> rational_triangle(const UvFaces& atlas, Index f) {
  const int sign = rational_sign(atlas, f);
  const auto [a, b, c] = rational_corners(atlas, f);
  if (sign == 0) return {};
  return sign > 0 ? std::vector{a, b, c} : std::vector{a, c, b};
}

/// What of a convex polygon is on the left of a line (Sutherland & Hodgman 1974).
inline std::vector<RationalPoint> clip(const std::vector<RationalPoint>& polygon,
                                       const RationalPoint& a, const RationalPoint& b) {
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

inline bool overlap_in_rationals(const std::vector<RationalPoint>& f,
                                 const std::vector<RationalPoint>& g) {
  std::vector<RationalPoint> common = f;
  for (std::size_t k = 0; k < 3; ++k) common = clip(common, g[k], g[(k + 1) % 3]);
  Rational area(0);
  for (std::size_t i = 2; i < common.size(); ++i) {
    area += twice_area(common[0], common[i - 1], common[i]);
  }
  return area > Rational(0);
}

inline std::vector<Pair> overlaps_by_force(const UvFaces& atlas) {
  std::vector<std::vector<RationalPoint>> triangles;
  std::vector<Eigen::AlignedBox2d> boxes(atlas.faces.size());
  for (Index f = 0; f < size_of(atlas.faces); ++f) {
    triangles.push_back(rational_triangle(atlas, f));
    for (const Index v : atlas.faces[f]) boxes[f].extend(atlas.uvs[v]);
  }
  std::vector<Pair> pairs;
  for (Index f = 0; f < size_of(triangles); ++f) {
    for (Index g = f + 1; g < size_of(triangles); ++g) {
      if (triangles[f].empty() || triangles[g].empty() || !boxes[f].intersects(boxes[g])) continue;
      if (overlap_in_rationals(triangles[f], triangles[g])) pairs.push_back({f, g});
    }
  }
  return pairs;
}

/// Per face, whether an edge of it is used by other than one face on each side.
inline std::vector<bool> faces_at_boundary(const UvFaces& atlas) {
  std::map<Pair, int> uses;
  const auto directed = [&](Index f, int sign, std::size_t k) {
    const Triangle& t = atlas.faces[f];
    return sign > 0 ? Pair{t[k], t[(k + 1) % 3]} : Pair{t[(k + 1) % 3], t[k]};
  };
  std::vector<int> signs;
  for (Index f = 0; f < size_of(atlas.faces); ++f) {
    signs.push_back(rational_sign(atlas, f));
    for (std::size_t k = 0; k < 3 && signs[f] != 0; ++k) ++uses[directed(f, signs[f], k)];
  }
  std::vector<bool> at_boundary(signs.size(), false);
  for (Index f = 0; f < size_of(signs); ++f) {
    for (std::size_t k = 0; k < 3 && signs[f] != 0; ++k) {
      const auto [a, b] = directed(f, signs[f], k);
      if (uses[{a, b}] != 1 || uses[{b, a}] != 1) at_boundary[f] = true;
    }
  }
  return at_boundary;
}

}  // namespace beltrami
