// Charts are positive as the input has wound them.
#include "atlas/keep_windings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "atlas/atlas.h"
#include "atlas/types.h"
#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "cut/seam_target.h"
#include "pack/types.h"
#include "support/atlases.h"
#include "support/meshes.h"

namespace beltrami {
namespace {

using meshes::TriangleList;

/// Two rectangles side by side, at x, the second one wound the other way, and of another label.
void add_pair(double x, TriangleList& mesh, std::vector<std::uint64_t>& labels) {
  const auto first = size_of(mesh.positions);
  for (const double u : {0., 1., 2.}) {
    mesh.positions.emplace_back(x + u, 0, 0);
    mesh.positions.emplace_back(x + u, 3, 0);
  }
  for (const Triangle& face : {Triangle{0, 2, 3}, {0, 3, 1}, {2, 5, 4}, {2, 3, 5}}) {
    mesh.faces.push_back({face[0] + first, face[1] + first, face[2] + first});
  }
  labels.insert(labels.end(), {0, 0, 1, 1});
}

double signed_area(const Atlas& atlas, std::size_t face) {
  const auto [a, b, c] = atlas.faces[face];
  const Vec2 p = atlas.uvs[b] - atlas.uvs[a], q = atlas.uvs[c] - atlas.uvs[a];
  return p.x() * q.y() - p.y() * q.x();
}

TEST(KeepWindings, NoChartLiesMirrored) {
  TriangleList mesh;
  std::vector<std::uint64_t> labels;
  add_pair(0, mesh, labels);
  AtlasInput input{mesh.positions, mesh.faces};
  input.cuts.labels = labels;
  const Atlas atlas = unwrap(input, {}, Work(1));
  atlases::expect_sound(mesh, atlas);
  EXPECT_EQ(atlas.charts.size(), 2);
  EXPECT_EQ(atlas.admitted.reversed_faces, 2);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    EXPECT_GT(signed_area(atlas, f), 0) << f;
    EXPECT_FALSE(atlas.reversed[f]) << f;
  }
}

TEST(KeepWindings, ADividedChartIsPositiveForMostOfItsFaces) {
  TriangleList mesh;
  std::vector<std::uint64_t> labels;
  add_pair(0, mesh, labels);
  add_pair(2, mesh, labels);  // whose places are welded to those of the first
  mesh.faces.resize(6);
  const Atlas atlas = atlases::unwrapped(mesh);
  atlases::expect_sound(mesh, atlas);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    EXPECT_EQ(signed_area(atlas, f) < 0, atlas.reversed[f]) << f;
  }
  EXPECT_EQ(std::count(atlas.reversed.begin(), atlas.reversed.end(), true), 2);
}

/// Three faces of six run against the others, and the chart of all is cut
/// in two for the page, so that of one part three of four do.
TriangleList part_of_a_truck() {
  return {{{-0.436663, 0.0683814, -0.336291},
           {-0.352486, 0.078884, -0.338688},
           {-0.436343, 0.0814418, -0.330103},
           {-0.306439, 0.0970166, -0.333612},
           {-0.309422, 0.0992604, -0.333773},
           {-0.436701, 0.0841442, -0.330267},
           {-0.584964, 0.0633651, -0.323906},
           {-0.585342, 0.0662325, -0.323998}},
          {{0, 1, 2}, {3, 1, 2}, {2, 4, 3}, {2, 5, 4}, {2, 5, 6}, {5, 7, 6}}};
}

TEST(KeepWindings, PartsForThePageDoAsWell) {
  const TriangleList mesh = part_of_a_truck();
  AtlasOptions options;
  options.target = SeamTarget{};
  options.pack = PackOptions{};
  options.fill_weight = 10;
  const Atlas atlas = atlases::unwrapped(mesh, options);
  ASSERT_EQ(atlas.charts.size(), 2);
  std::vector<Index> positive(2, 0);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    if (signed_area(atlas, f) > 0) ++positive[atlas.chart_of_face[f]];
  }
  for (std::size_t c = 0; c < 2; ++c) EXPECT_GE(2 * positive[c], atlas.charts[c].faces) << c;
}

TEST(KeepWindings, WhatIsStackedFollows) {
  TriangleList mesh;
  std::vector<std::uint64_t> labels;
  for (const double x : {0., 10., 20.}) add_pair(x, mesh, labels);
  AtlasInput input{mesh.positions, mesh.faces};
  input.cuts.labels = labels;
  for (const Stack stack : {Stack::kCopies, Stack::kMirrored}) {
    AtlasOptions options;
    options.stack = stack;
    const Atlas atlas = unwrap(input, options, Work(1));
    EXPECT_GT(atlas.stacked_parts, 0);
    EXPECT_TRUE(atlas.certificate.injective());
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
      EXPECT_EQ(signed_area(atlas, f) < 0, atlas.reversed[f]) << f;
    }
  }
}

}  // namespace
}  // namespace beltrami
