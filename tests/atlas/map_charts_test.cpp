// Charts side by side: what one of them does not take from the others.
#include "atlas/map_charts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "base/error.h"
#include "exact/certificate.h"
#include "mesh/chart.h"
#include "mesh/disk_mesh.h"
#include "support/disks.h"
#include "support/meshes.h"

namespace beltrami {
namespace {

using meshes::TriangleList;

AtlasChart chart_of(TriangleList mesh) {
  const Index faces = size_of(mesh.faces);
  return {{disks::disk(std::move(mesh)), {}, {}}, faces};
}

/// A chart that no map can be measured against: all its vertices are at one place.
AtlasChart hopeless() {
  TriangleList mesh = meshes::grid(4, 4);
  for (Vec3& p : mesh.positions) p = Vec3::Ones();
  return chart_of(std::move(mesh));
}

void expect_injective(const AtlasChart& part, const MappedChart& map) {
  const Chart& chart = part.chart;
  EXPECT_EQ(map.outcome, Outcome::kOk);
  EXPECT_TRUE(certify(chart.mesh.faces, chart.mesh.boundary, map.uvs, Work()).injective());
}

TEST(MapCharts, KeepsAFailureToItsChart) {
  const std::vector<AtlasChart> charts = {chart_of(meshes::bumps(6, 6)), hopeless(),
                                          chart_of(meshes::triangle())};
  for (const int threads : {1, 2}) {
    const std::vector<MappedChart> maps = map_charts(charts, {}, {}, Work(threads));
    ASSERT_EQ(maps.size(), 3);
    expect_injective(charts[0], maps[0]);
    expect_injective(charts[2], maps[2]);
    EXPECT_EQ(maps[1].error, Fault::kZeroArea);
    EXPECT_EQ(maps[1].outcome, Outcome::kNotInjective);
    EXPECT_EQ(maps[1].uvs, std::vector<Vec2>(charts[1].chart.mesh.positions.size(), Vec2::Zero()));
  }
}

TEST(MapCharts, LaysUpToTwoFacesFlatInTheirShape) {
  const std::vector<AtlasChart> charts = {
      chart_of({{{1, 2, 3}, {4, 1, 0}, {0, 0, 7}}, {{0, 1, 2}}}),
      chart_of({{{0, 0, 0}, {3, 0, 1}, {2, 2, 5}, {-1, 4, 0}}, {{0, 1, 2}, {0, 2, 3}}})};
  const std::vector<MappedChart> maps = map_charts(charts, {}, {}, Work(1));
  for (std::size_t c = 0; c < charts.size(); ++c) {
    const DiskMesh& mesh = charts[c].chart.mesh;
    const std::vector<Vec2>& uvs = maps[c].uvs;
    expect_injective(charts[c], maps[c]);
    double longest = 0;
    for (Index h = 0; h < size_of(mesh.twin); ++h) {
      const Index a = mesh.origin(h), b = mesh.target(h);
      EXPECT_NEAR((uvs[b] - uvs[a]).norm(), (mesh.positions[b] - mesh.positions[a]).norm(), 1e-14);
      longest = std::max(longest, (uvs[b] - uvs[a]).norm());
    }
    double along = 0;
    for (const Vec2& a : uvs) {
      for (const Vec2& b : uvs) along = std::max(along, b.x() - a.x());
    }
    EXPECT_GE(along, longest - 1e-14);
  }
}

TEST(MapCharts, GivesALargeChartTheSameBitsOnAllThreads) {
  // More faces than a thread's share: it runs before the others.
  std::vector<AtlasChart> charts;
  charts.push_back(chart_of(meshes::bumps(110, 100)));
  charts.push_back(chart_of(meshes::bumps(5, 5)));
  const std::vector<MappedChart> one = map_charts(charts, {}, {}, Work(1)),
                                 two = map_charts(charts, {}, {}, Work(2));
  for (std::size_t c = 0; c < charts.size(); ++c) {
    expect_injective(charts[c], one[c]);
    EXPECT_EQ(one[c].uvs, two[c].uvs);
  }
}

}  // namespace
}  // namespace beltrami
