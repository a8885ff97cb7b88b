// How work grows with a surface: no more than its size times a logarithm, whatever the surface is
// like. Counted in looks at requests to end, which no machine changes.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <ostream>
#include <string>

#include "atlas/types.h"
#include "base/portable_math.h"
#include "base/types.h"
#include "pack/types.h"
#include "support/atlases.h"
#include "support/meshes.h"
#include "support/polls.h"
#include "support/surfaces.h"

namespace beltrami {
namespace {

using meshes::TriangleList;

void add_quad(TriangleList& mesh, Index a, Index b, Index c, Index d) {
  mesh.faces.insert(mesh.faces.end(), {{a, b, c}, {a, c, d}});
}

/// Triangles that have nothing to do with each other.
TriangleList crumbs(Index n) {
  TriangleList mesh;
  const Index side = static_cast<Index>(std::ceil(std::sqrt(n)));
  for (Index i = 0; i < n; ++i) {
    const Index row = i / side;
    const double x = i % side, y = row, tilt = 0.01 * (i % 7);
    const Index first = size_of(mesh.positions);
    mesh.positions.insert(mesh.positions.end(),
                          {{x, y, tilt}, {x + 0.1, y, 0}, {x, y + 0.1 + tilt, 0}});
    mesh.faces.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

/// A cone of many faces.
TriangleList hub(Index n) {
  TriangleList mesh;
  mesh.positions.emplace_back(0, 0, 0.5);
  for (Index i = 0; i < n; ++i) {
    const double turn = 2 * std::numbers::pi * i / n;
    mesh.positions.emplace_back(portable::cos(turn), portable::sin(turn), 0);
    mesh.faces.push_back({0, 1 + i, 1 + (i + 1) % n});
  }
  return mesh;
}

/// Faces that all share one edge.
TriangleList book(Index n) {
  TriangleList mesh = hub(n);
  mesh.positions.emplace_back(0, 0, -0.5);
  for (Index i = 0; i < n; ++i) mesh.faces[i] = {0, n + 1, 1 + i};
  return mesh;
}

/// A flat plate of about n cells, every other one in both directions a hole.
TriangleList plate(Index n) {
  const Index side = 2 * static_cast<Index>(std::sqrt(n) / 2) + 1;
  TriangleList mesh;
  for (Index j = 0; j <= side; ++j) {
    for (Index i = 0; i <= side; ++i) mesh.positions.emplace_back(i, j, 0);
  }
  for (Index j = 0; j < side; ++j) {
    for (Index i = 0; i < side; ++i) {
      const Index a = j * (side + 1) + i;
      if (i % 2 == 0 || j % 2 == 0) add_quad(mesh, a, a + 1, a + side + 2, a + side + 1);
    }
  }
  return mesh;
}

/// A strip of quads, a million times as long as it is wide.
TriangleList strip(Index n) {
  TriangleList mesh;
  for (Index i = 0; i <= n; ++i) {
    mesh.positions.insert(mesh.positions.end(), {{1e6 * i / n, 0, 0}, {1e6 * i / n, 1, 0}});
    if (i > 0) add_quad(mesh, 2 * i - 2, 2 * i, 2 * i + 1, 2 * i - 1);
  }
  return mesh;
}

/// Quads in one place, each with vertices of its own.
TriangleList coincident(Index n) {
  TriangleList mesh;
  for (Index i = 0; i < n; ++i) {
    mesh.positions.insert(mesh.positions.end(), {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    add_quad(mesh, 4 * i, 4 * i + 1, 4 * i + 2, 4 * i + 3);
  }
  return mesh;
}

/// A slab with n windows in a row: closed, of genus n.
TriangleList windows(Index n) {
  TriangleList mesh;
  const Index length = 2 * n + 1;
  const auto at = [&](Index i, Index j, Index k) { return 2 * (4 * i + j) + k; };
  for (Index i = 0; i <= length; ++i) {
    for (Index j = 0; j < 4; ++j) {
      for (Index k = 0; k < 2; ++k) mesh.positions.emplace_back(i, j, k);
    }
  }
  const auto is_full = [&](Index i, Index j) {
    return i >= 0 && i < length && j >= 0 && j < 3 && (j != 1 || i % 2 == 0);
  };
  for (Index i = 0; i < length; ++i) {
    for (Index j = 0; j < 3; ++j) {
      if (!is_full(i, j)) continue;
      const Index a = at(i, j, 0), b = at(i + 1, j, 0), c = at(i + 1, j + 1, 0),
                  d = at(i, j + 1, 0);
      add_quad(mesh, d, c, b, a);
      add_quad(mesh, a + 1, b + 1, c + 1, d + 1);
      if (!is_full(i, j - 1)) add_quad(mesh, a, b, b + 1, a + 1);
      if (!is_full(i + 1, j)) add_quad(mesh, b, c, c + 1, b + 1);
      if (!is_full(i, j + 1)) add_quad(mesh, c, d, d + 1, c + 1);
      if (!is_full(i - 1, j)) add_quad(mesh, d, a, a + 1, d + 1);
    }
  }
  return mesh;
}

struct Family {
  const char* name;
  TriangleList (*make)(Index n);
  Index size;                ///< of the smaller surface: one whose work is not all beginnings
  bool is_searched = false;  ///< for the shortest seams, not cut minimally

  friend void PrintTo(const Family& family, std::ostream* out) { *out << family.name; }
};

class Growth : public testing::TestWithParam<Family> {
 protected:
  static std::int64_t work_of(const TriangleList& mesh, bool is_searched) {
    AtlasOptions options;
    if (is_searched) options.target.emplace();
    options.pack = PackOptions{};
    options.pack->resolution = 256;
    return count_polls([&] {
      const Atlas atlas = atlases::unwrapped(mesh, options);
      EXPECT_TRUE(atlas.certificate.injective());
    });
  }
};

TEST_P(Growth, IsThatOfTheSizeTimesItsLogarithm) {
  constexpr Index kTimes = 4;
  // What one more logarithm, and steps that are taken in whole rounds, make of it.
  constexpr double kSlack = 1.5;
  const auto& [name, make, size, is_searched] = GetParam();
  const std::int64_t few = work_of(make(size), is_searched),
                     many = work_of(make(kTimes * size), is_searched);
  EXPECT_LE(static_cast<double>(many), kSlack * kTimes * static_cast<double>(few))
      << few << " looks, and " << many << " at " << kTimes << " times the size";
}

INSTANTIATE_TEST_SUITE_P(Surfaces, Growth,
                         testing::Values(Family{"crumbs", crumbs, 500}, Family{"hub", hub, 2000},
                                         Family{"book", book, 500}, Family{"plate", plate, 900},
                                         Family{"strip", strip, 2000},
                                         Family{"coincident", coincident, 500},
                                         Family{"windows", windows, 80, true}),
                         [](const auto& family) { return std::string(family.param.name); });

}  // namespace
}  // namespace beltrami
