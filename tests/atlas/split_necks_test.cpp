// Charts split at necks for the sake of the pages: connected disks as before, for no more than the
// price of what they gain.
#include "atlas/split_necks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "atlas/atlas.h"
#include "atlas/seams.h"
#include "atlas/types.h"
#include "base/disjoint_sets.h"
#include "base/vectors.h"
#include "support/atlases.h"
#include "support/meshes.h"
#include "support/shared_data.h"
#include "support/surfaces.h"

namespace beltrami {
namespace {

using atlases::expect_same_bits;
using atlases::expect_sound;
using atlases::unwrapped;
using meshes::TriangleList;

AtlasOptions priced(double price, int resolution = 256) {
  AtlasOptions options;
  options.pack.emplace().resolution = resolution;
  options.fill_weight = price;
  return options;
}

/// A plane of squares with two triangles each, where `is_there` holds for their lower left corner.
template <class IsThere>
TriangleList squares(Index columns, Index rows, const IsThere& is_there) {
  TriangleList mesh;
  std::map<std::pair<Index, Index>, Index> number;
  const auto at = [&](Index x, Index y) {
    const auto [found, is_new] = number.try_emplace({x, y}, size_of(mesh.positions));
    if (is_new) mesh.positions.emplace_back(x, y, 0);
    return found->second;
  };
  for (Index y = 0; y < rows; ++y) {
    for (Index x = 0; x < columns; ++x) {
      if (!is_there(x, y)) continue;
      const Index a = at(x, y), b = at(x + 1, y), c = at(x + 1, y + 1), d = at(x, y + 1);
      mesh.faces.push_back({a, b, c});
      mesh.faces.push_back({a, c, d});
    }
  }
  return mesh;
}

/// Two squares that a narrow bridge joins.
TriangleList dumbbell() {
  return squares(24, 8, [](Index x, Index y) { return x < 8 || x >= 16 || y == 4; });
}

TriangleList strip() {
  return squares(32, 2, [](Index, Index) { return true; });
}

/// A strip with a hole whose longer sides are near the border.
TriangleList strip_with_hole() {
  return squares(30, 6, [](Index x, Index y) { return x < 12 || x >= 18 || y == 0 || y == 5; });
}

/// Faces of one chart reach each other across edges that they share in the plane.
void expect_connected(const Atlas& atlas) {
  DisjointSets sets(size_of(atlas.uvs));
  std::map<std::array<Index, 2>, std::size_t> first;
  DisjointSets faces(size_of(atlas.faces));
  for (std::size_t f = 0; f < atlas.faces.size(); ++f) faces.make(static_cast<Index>(f));
  for (std::size_t f = 0; f < atlas.faces.size(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(atlas.faces[f][k], atlas.faces[f][(k + 1) % 3]);
      const auto [found, is_new] = first.try_emplace({low, high}, f);
      if (!is_new) faces.unite(static_cast<Index>(found->second), static_cast<Index>(f));
    }
  }
  std::set<Index> roots;
  for (std::size_t f = 0; f < atlas.faces.size(); ++f) {
    if (!atlas.excepted[f]) roots.insert(faces.root(static_cast<Index>(f)));
  }
  EXPECT_EQ(roots.size(), atlas.charts.size());
}

/// What was gained pays for the seams, measured against the atlas that is not split.
void expect_worth(const Atlas& atlas, const Atlas& whole, double price) {
  ASSERT_TRUE(atlas.pages && atlas.pages->split);
  const SplitFigures& split = *atlas.pages->split;
  const double gained = atlas.utilisation - whole.utilisation;
  EXPECT_NEAR(split.before, whole.utilisation, 1e-9);
  EXPECT_EQ(atlas.charts.size(), whole.charts.size() + split.count);
  EXPECT_NEAR(split.length, atlas.seam_over_root_area - whole.seam_over_root_area, 1e-9);
  EXPECT_GE(price * gained + 1e-9, split.length);
  EXPECT_NEAR(atlas.energy.symmetric_dirichlet, whole.energy.symmetric_dirichlet, 1e-6);
  EXPECT_GE(atlas.pages->margin, atlas.pages->asked_margin);
}

TEST(SplitNecks, CutsWhereItIsNarrow) {
  const TriangleList mesh = dumbbell();
  const Atlas whole = unwrapped(mesh, priced(0)), atlas = unwrapped(mesh, priced(4));
  expect_sound(mesh, atlas);
  expect_connected(atlas);
  expect_worth(atlas, whole, 4);
  EXPECT_FALSE(whole.pages->split);
  EXPECT_EQ(atlas.pages->split->count, 1);
  // An edge of the bridge, or its diagonal.
  EXPECT_LE(atlas.seam_length, std::sqrt(2.0) + 1e-12);
  EXPECT_GT(atlas.utilisation, 1.5 * whole.utilisation);
}

/// A strip of three fans: edges lie across it between these alone.
TriangleList strip_of_fans() {
  constexpr Index kWidth = 10, kLength = 3 * kWidth;
  TriangleList mesh;
  for (Index x = 0; x <= kLength; ++x) {
    mesh.positions.emplace_back(x, 0, 0);
    mesh.positions.emplace_back(x, 1, 0);
  }
  for (Index x = 0; x < kLength; ++x) {
    const Index left = x / kWidth * kWidth, right = left + kWidth;
    mesh.faces.push_back({2 * left, 2 * (x + 1) + 1, 2 * x + 1});
    mesh.faces.push_back({2 * x, 2 * (x + 1), 2 * right + 1});
  }
  return mesh;
}

TEST(SplitNecks, CutsWhereEdgesAre) {
  const TriangleList mesh = strip_of_fans();
  const Atlas whole = unwrapped(mesh, priced(0)), atlas = unwrapped(mesh, priced(20));
  expect_sound(mesh, atlas);
  expect_worth(atlas, whole, 20);
  expect_connected(atlas);
  EXPECT_GE(atlas.pages->split->count, 2);
  EXPECT_GT(atlas.utilisation, 4 * whole.utilisation);
}

TEST(SplitNecks, CutsWhatIsTooLongForThePage) {
  const TriangleList mesh = strip();
  const Atlas whole = unwrapped(mesh, priced(0)), atlas = unwrapped(mesh, priced(20));
  expect_sound(mesh, atlas);
  expect_connected(atlas);
  expect_worth(atlas, whole, 20);
  EXPECT_GE(atlas.charts.size(), 4u);
  EXPECT_GT(atlas.utilisation, 0.5);
}

TEST(SplitNecks, CutsNothingThatIsNotWorthIt) {
  const TriangleList mesh = strip();
  const Atlas whole = unwrapped(mesh, priced(0)), atlas = unwrapped(mesh, priced(0.01));
  EXPECT_EQ(atlas.pages->split->count, 0);
  expect_same_bits(atlas, whole);
  const TriangleList square = meshes::grid(8, 8);
  EXPECT_EQ(unwrapped(square, priced(100)).charts.size(), 1u);
}

TEST(SplitNecks, CutsThroughHolesForTheEdgesBeside) {
  const TriangleList mesh = strip_with_hole();
  AtlasOptions options = priced(0);
  options.fill_limit = 4;
  const Atlas whole = unwrapped(mesh, options);
  ASSERT_EQ(whole.filled_holes, 1);
  options.fill_weight = 8;
  const Atlas atlas = unwrapped(mesh, options);
  expect_sound(mesh, atlas);
  expect_connected(atlas);
  expect_worth(atlas, whole, 8);
  EXPECT_EQ(atlas.pages->split->count, 1);
  EXPECT_LE(atlas.seam_length, 2 * std::sqrt(2.0) + 1e-12);
}

TEST(SplitNecks, NoSeamRunsInsideAPolygon) {
  const TriangleList mesh = strip();
  std::vector<Index> polygon;
  for (Index f = 0; f < size_of(mesh.faces); ++f) polygon.push_back(f / 2);
  AtlasOptions options = priced(20);
  options.admit.polygons.polygon = polygon;
  const Atlas atlas = unwrapped(mesh, options);
  EXPECT_GT(atlas.pages->split->count, 0);
  for (std::size_t f = 0; f < atlas.faces.size(); f += 2) {
    EXPECT_EQ(atlas.chart_of_face[f], atlas.chart_of_face[f + 1]);
  }
}

TEST(SplitNecks, StaysWithinWhatWasAskedOfSeams) {
  const TriangleList mesh = strip();
  AtlasOptions options = priced(20);
  options.target.emplace().max_charts = 2;
  EXPECT_EQ(unwrapped(mesh, options).charts.size(), 2u);
  options.target->max_charts = 0;
  options.target->seam_budget = 0.6;
  const Atlas atlas = unwrapped(mesh, options);
  EXPECT_GT(atlas.charts.size(), 1u);
  EXPECT_LE(atlas.seam_over_root_area, 0.6);
}

TEST(SplitNecks, BoxesStayCrosses) {
  const Atlas atlas = unwrapped(meshes::cube(), priced(50));
  EXPECT_EQ(atlas.charts.size(), 1u);
}

TEST(SplitNecks, WhatLiesFlatWithoutASeamStaysWhole) {
  const TriangleList mesh = squares(12, 12, [](Index x, Index y) { return x < 4 || y < 4; });
  EXPECT_EQ(unwrapped(mesh, priced(100)).charts.size(), 1u);
}

TEST(SplitNecks, SeamsGivenMakeTheSameCharts) {
  const TriangleList mesh = dumbbell();
  const Atlas atlas = unwrapped(mesh, priced(20));
  EXPECT_GT(atlas.pages->split->count, 0);
  AtlasInput input{mesh.positions, mesh.faces};
  input.cuts.edges = seams_of(atlas);
  AtlasOptions options = priced(0);
  options.keep_disk = false;
  const Atlas given = unwrap(input, options, Work(1));
  EXPECT_EQ(given.chart_of_face, atlas.chart_of_face);
  EXPECT_EQ(seams_of(given), input.cuts.edges);
}

TEST(SplitNecks, GivesTheSameBitsOnAnyNumberOfThreadsAndInAnyUnit) {
  const TriangleList mesh = atlases::zoo();
  const Atlas atlas = unwrapped(mesh, priced(20));
  expect_sound(mesh, atlas);
  expect_connected(atlas);
  expect_worth(atlas, unwrapped(mesh, priced(0)), 20);
  expect_same_bits(atlas, unwrapped(mesh, priced(20), 2));
  TriangleList scaled = mesh;
  for (Vec3& p : scaled.positions) {
    for (double& x : p) x = std::ldexp(x, -7);
  }
  expect_same_bits(atlas, unwrapped(scaled, priced(20)));
}

TEST(SplitNecks, PartsOfOneDensityHaveThatOfTheWhole) {
  const TriangleList mesh = dumbbell();
  AtlasInput input{mesh.positions, mesh.faces};
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) input.densities.push_back(f < 60 ? 1 : 2);
  const Atlas atlas = unwrap(input, priced(8), Work(1));
  ASSERT_EQ(atlas.charts.size(), 2u);
  EXPECT_EQ(atlas.charts[0].density, atlas.charts[1].density);
}

/// A closed slab of height 1: squares above and below, and walls between them.
template <class IsThere>
TriangleList slab(Index columns, Index rows, const IsThere& is_there) {
  TriangleList mesh = squares(columns, rows, is_there);
  const Index vertices = size_of(mesh.positions);
  for (Index v = 0; v < vertices; ++v)
    mesh.positions.emplace_back(mesh.positions[v] + Vec3(0, 0, 1));
  std::set<std::pair<Index, Index>> edges;
  for (const Triangle& face : mesh.faces) {
    for (int k = 0; k < 3; ++k) edges.emplace(face[k], face[(k + 1) % 3]);
  }
  for (std::size_t f = 0, below = mesh.faces.size(); f < below; ++f) {
    const auto [a, b, c] = mesh.faces[f];
    mesh.faces.push_back({a + vertices, b + vertices, c + vertices});
    mesh.faces[f] = {a, c, b};
  }
  for (const auto& [a, b] : edges) {
    if (edges.count({b, a}) != 0) continue;
    mesh.faces.push_back({a, b, b + vertices});
    mesh.faces.push_back({a, b + vertices, a + vertices});
  }
  return mesh;
}

TEST(SplitNecks, LooksAtWhatNecksDoNotPromise) {
  const TriangleList mesh =
      slab(24, 24, [](Index x, Index y) { return x == 11 || x == 12 || y == 11 || y == 12; });
  AtlasOptions options = priced(0);
  options.target.emplace();
  const Atlas whole = unwrapped(mesh, options);
  options.fill_weight = 10;
  const Atlas atlas = unwrapped(mesh, options);
  expect_connected(atlas);
  expect_worth(atlas, whole, 10);
  EXPECT_GT(atlas.utilisation, 1.2 * whole.utilisation);
}

TEST(SplitNecks, PaysOnModelsOfPeople) {
  for (const char* name : {"closed/horse_f10000.obj", "closed/octopus_mainComp_f6000.obj"}) {
    const auto path = shared_data::folder() / name;
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not at hand";
    const TriangleList mesh = shared_data::read_obj(path);
    AtlasOptions options = priced(0, 1024);
    options.target.emplace();
    const Atlas whole = unwrapped(mesh, options, 2);
    options.fill_weight = 10;
    const Atlas atlas = unwrapped(mesh, options, 2);
    expect_connected(atlas);
    expect_worth(atlas, whole, 10);
    EXPECT_TRUE(atlas.certificate.injective());
    EXPECT_GT(atlas.utilisation, whole.utilisation + 0.05);
  }
}

}  // namespace
}  // namespace beltrami
