// Every component is held to the target, and nothing comes out worse than a short cut leaves it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "atlas/types.h"
#include "base/types.h"
#include "base/vectors.h"
#include "chart/flattening.h"
#include "cut/seam_target.h"
#include "energy/measure.h"
#include "pack/types.h"
#include "support/atlases.h"
#include "support/meshes.h"
#include "support/solids.h"

namespace beltrami {
namespace {

using atlases::expect_sound;
using atlases::unwrapped;
using meshes::TriangleList;

AtlasOptions searched(double energy = 2.05) {
  AtlasOptions options;
  options.target = SeamTarget{.energy = energy};
  options.pack = PackOptions{};
  return options;
}

/// A flat ring of `corners`, with a hole half as wide.
TriangleList ring(Index corners) {
  TriangleList mesh;
  for (const double radius : {1.0, 0.5}) {
    for (Index i = 0; i < corners; ++i) {
      const double angle = 6.283185307179586 * i / corners;
      mesh.positions.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
    }
  }
  for (Index i = 0; i < corners; ++i) {
    const Index next = (i + 1) % corners;
    mesh.faces.push_back({i, next, corners + next});
    mesh.faces.push_back({i, corners + next, corners + i});
  }
  return mesh;
}

TEST(Components, FlatRingsComeOutAsThemselves) {
  for (const Index corners : {4, 5, 8, 16, 33}) {
    const TriangleList mesh = ring(corners);
    const Atlas atlas = unwrapped(mesh, searched());
    expect_sound(mesh, atlas);
    EXPECT_LT(atlas.energy.max, 2.0001) << corners;
    EXPECT_GE(atlas.pages->margin, PackOptions().margin);
    for (const Vec2& w : atlas.uvs) {
      EXPECT_TRUE(w.minCoeff() >= 0 && w.maxCoeff() <= 1);
    }
  }
}

TEST(Components, ASmallOneBesideALargeFlatOneHasTheTargetAsWell) {
  TriangleList mesh = meshes::sphere(3);
  const auto ball = size_of(mesh.faces);
  const Index first = size_of(mesh.positions);
  for (const Vec3& p :
       {Vec3(-100, -100, -2), Vec3(100, -100, -2), Vec3(100, 100, -2), Vec3(-100, 100, -2)}) {
    mesh.positions.push_back(p);
  }
  mesh.faces.push_back({first, first + 1, first + 2});
  mesh.faces.push_back({first, first + 2, first + 3});
  const Atlas atlas = unwrapped(mesh, searched());
  EXPECT_TRUE(atlas.missed.empty());
  double area = 0, sum = 0;
  for (const ChartInfo& chart : atlas.charts) {
    if (chart.first_face >= ball) continue;
    area += chart.area;
    sum += chart.area * chart.symmetric_dirichlet;
  }
  EXPECT_LE(sum / area, 2.0502);
}

TEST(Components, AFaceOfHardlyAnyHeightHasNoSayAndEndsNothing) {
  for (const double height : {1e-9, 1e-11, 1e-13}) {
    const TriangleList mesh = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.5, height, 0}, {0, -1, 0}},
                               {{0, 3, 2}, {3, 1, 2}, {0, 1, 3}, {0, 4, 1}}};
    const Atlas atlas = unwrapped(mesh, searched());
    EXPECT_EQ(atlas.outcome, Outcome::kOk) << height;
    EXPECT_TRUE(atlas.single_certificate.injective()) << height;
    EXPECT_LT(atlas.energy.symmetric_dirichlet, 2.01) << height;
    EXPECT_TRUE(atlas.missed.empty()) << height;
  }
}

TEST(Energies, TheWorstFacesOfNoAreaHaveNoSay) {
  const EnergySummary all = summarise({{2, 1}, {4, 1}});
  EXPECT_EQ(all.slivers, 0);
  EXPECT_DOUBLE_EQ(all.mean, 3);
  const EnergySummary with_sliver = summarise({{2, 1}, {1e30, 1e-7}, {4, 1}});
  EXPECT_EQ(with_sliver.slivers, 1);
  EXPECT_DOUBLE_EQ(with_sliver.mean, 3);
  EXPECT_DOUBLE_EQ(with_sliver.max, 4);
  EXPECT_GT(with_sliver.mean_of_all, 1e20);
  EXPECT_EQ(with_sliver.max_of_all, 1e30);
  EXPECT_TRUE(std::isnan(summarise({}).mean));
  EXPECT_EQ(summarise({{1e30, 1e-20}}).slivers, 0) << "a face alone has a say";
}

}  // namespace
}  // namespace beltrami
