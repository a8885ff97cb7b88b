// Maps that lie on themselves, and the seams that part them.
#include "cut/split_overlaps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "base/portable_math.h"
#include "base/types.h"
#include "base/work.h"
#include "cut/cut_into_charts.h"
#include "cut/edge_marks.h"
#include "cut/join_loops.h"
#include "cut/layers.h"
#include "exact/certificate.h"
#include "mesh/chart.h"
#include "mesh/disk_mesh.h"
#include "multilevel/composite_majorization.h"
#include "multilevel/descent.h"
#include "multilevel/options.h"
#include "support/cuts.h"
#include "support/disks.h"
#include "support/meshes.h"
#include "support/polls.h"
#include "support/shared_data.h"

namespace beltrami {
namespace {

constexpr double kLocked = std::numeric_limits<double>::infinity();

struct Mapped {
  DiskMesh disk;
  std::vector<Vec2> uvs;
  std::vector<double> cost;  // lengths
};

Mapped mapped(DiskMesh disk, std::vector<Vec2> uvs) {
  Mapped map{std::move(disk), std::move(uvs), {}};
  for (Index h = 0; h < size_of(map.disk.twin); ++h) {
    const std::vector<Vec3>& p = map.disk.positions;
    map.cost.push_back((p[map.disk.target(h)] - p[map.disk.origin(h)]).norm());
  }
  return map;
}

/// A mesh by its x and y.
Mapped flat(meshes::TriangleList mesh) {
  DiskMesh disk = disks::disk(std::move(mesh));
  std::vector<Vec2> uvs = disks::flat_uvs(disk);
  return mapped(std::move(disk), std::move(uvs));
}

/// A strip of width 0.4 along a line of the curvatures given, each for a step of length 0.1.
Mapped strip_along(const std::vector<double>& curvatures) {
  constexpr Index kAcross = 4, kMiddle = kAcross / 2;
  const Index along = size_of(curvatures);
  meshes::TriangleList mesh = meshes::grid(along, kAcross);
  Vec3 p = Vec3::Zero();
  double angle = 0;
  for (Index i = 0; i <= along; ++i) {
    const Vec3 left(-portable::sin(angle), portable::cos(angle), 0);
    for (Index j = 0; j <= kAcross; ++j) {
      mesh.positions[j * (along + 1) + i] = p + 0.1 * (j - kMiddle) * left;
    }
    if (i == along) break;
    const double middle = angle + 0.05 * curvatures[i];
    p += 0.1 * Vec3(portable::cos(middle), portable::sin(middle), 0);
    angle += 0.1 * curvatures[i];
  }
  return flat(std::move(mesh));
}

/// A strip that crosses itself once.
Mapped noose() {
  std::vector<double> curvatures(30, 0.0);
  curvatures.insert(curvatures.end(), 47, 1.0);
  curvatures.insert(curvatures.end(), 30, 0.0);
  return strip_along(curvatures);
}

/// A strip that wanders about, and its map all the same.
Mapped wandering(std::uint64_t seed) {
  disks::Random random(seed);
  std::vector<double> curvatures;
  double curvature = 0;
  for (int i = 0; i < 200; ++i) {
    if (random.unit() < 0.1) curvature = random.between(-3, 3);
    curvatures.push_back(curvature);
  }
  return strip_along(curvatures);
}

/// `angle` of a disk of radius 1 around vertex 0, beyond 2 pi on itself.
Mapped sector(double angle) {
  constexpr Index kRays = 90, kRings = 15;
  meshes::TriangleList mesh;
  mesh.positions.emplace_back(0, 0, 0);
  for (Index r = 1; r <= kRings; ++r) {
    for (Index i = 0; i <= kRays; ++i) {
      const double at = angle * i / kRays, radius = static_cast<double>(r) / kRings;
      mesh.positions.emplace_back(radius * portable::cos(at), radius * portable::sin(at), 0);
    }
  }
  for (Index i = 0; i < kRays; ++i) mesh.faces.push_back({0, 1 + i, 2 + i});
  for (Index r = 1; r < kRings; ++r) {
    for (Index i = 0; i < kRays; ++i) {
      const Index c = 1 + r * (kRays + 1) + i, a = c - kRays - 1;
      mesh.faces.push_back({a, c, c + 1});
      mesh.faces.push_back({a, c + 1, a + 1});
    }
  }
  return flat(std::move(mesh));
}

/// Locks the diagonals of a grid.
void lock_quads(Mapped& map) {
  for (Index h = 0; h < size_of(map.cost); ++h) {
    if (map.disk.twin[h] != kNone && h / 6 == map.disk.twin[h] / 6) map.cost[h] = kLocked;
  }
}

OverlapSplit split(const Mapped& map, double tolerance, int threads = 1) {
  return split_overlaps(map.disk, map.uvs, map.cost, tolerance, Work(threads));
}

/// What is promised of every split.
OverlapSplit expect_parted(const Mapped& map, double tolerance) {
  OverlapSplit result = split(map, tolerance);
  const Work work(1);
  double cost = 0;
  for (Index h = 0; h < size_of(map.cost); ++h) {
    if (!result.seams[h]) continue;
    EXPECT_NE(map.cost[h], kLocked);
    EXPECT_TRUE(map.disk.twin[h] != kNone && result.seams[map.disk.twin[h]]);
    if (map.disk.edge(h) == h) cost += map.cost[h];
  }
  EXPECT_EQ(result.cost, cost);
  EXPECT_EQ(result.overlapping, 0);
  const CutSurface cut = cut_into_charts(map.disk, result.seams, work);
  EXPECT_TRUE(cut.non_disks.empty());
  EXPECT_EQ(size_of(cut.charts), result.parts);
  for (const Chart& chart : cut.charts) {
    std::vector<Vec2> uvs;
    for (const Index v : chart.input_vertex) uvs.push_back(map.uvs[v]);
    if (tolerance == 0) {
      EXPECT_TRUE(certify(chart.mesh.faces, chart.mesh.boundary, uvs, work).injective());
      continue;
    }
    double area = 0;
    for (const auto& [a, b, c] : chart.mesh.faces) {
      const Vec2 u = uvs[b] - uvs[a], v = uvs[c] - uvs[a];
      area += (u.x() * v.y() - u.y() * v.x()) / 2;
    }
    // By other pixels than it was judged by.
    EXPECT_LE(overlapped_area(layers_of(chart.mesh, uvs)), (1.5 * tolerance + 2e-5) * area);
  }
  const OverlapSplit again = split(map, tolerance, 2);
  EXPECT_EQ(again.seams, result.seams);
  EXPECT_EQ(again.cost, result.cost);
  return result;
}

TEST(SplitOverlaps, LeavesInjectiveMapsAlone) {
  for (const Mapped& map :
       {flat(meshes::grid(9, 7)), sector(6.2), strip_along(std::vector(40, 1.0))}) {
    const OverlapSplit result = expect_parted(map, 0);
    EXPECT_EQ(result.parts, 1);
    EXPECT_EQ(result.cost, 0);
  }
}

TEST(SplitOverlaps, LeavesWhatIsWithinTheTolerance) {
  const Mapped map = noose();  // 0.16 of 4.28
  EXPECT_EQ(split(map, 0.05).parts, 1);
  EXPECT_EQ(split(map, 0.02).parts, 2);
}

TEST(SplitOverlaps, CutsAStripOnceForEachTimeItCrossesItself) {
  for (const double tolerance : {0.0, 0.002}) {
    const OverlapSplit result = expect_parted(noose(), tolerance);
    EXPECT_EQ(result.parts, 2);
    EXPECT_NEAR(result.cost, 0.4, 1e-9);
  }
}

TEST(SplitOverlaps, CutsASectorFromItsCentre) {
  for (const double turns : {1.1, 1.5, 1.9}) {
    const OverlapSplit result = expect_parted(sector(2 * std::numbers::pi * turns), 0.002);
    EXPECT_EQ(result.parts, 2);
    EXPECT_NEAR(result.cost, 1, 0.05);
  }
}

TEST(SplitOverlaps, CutsASpiralAboutOnceATurn) {
  for (const double turns : {1.5, 3.5, 9.5}) {
    const Mapped map = flat(disks::winding(static_cast<Index>(60 * turns), 3, 0.3, turns));
    const OverlapSplit result = expect_parted(map, 0);
    EXPECT_LE(result.cost, 0.3 * 1.5 * turns + 0.1) << turns;
  }
}

TEST(SplitOverlaps, PartsWhateverWandersAbout) {
  Index parts = 0;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    Mapped map = wandering(seed);
    if (seed % 2 == 1) lock_quads(map);
    parts += expect_parted(map, seed % 3 == 0 ? 0.002 : 0.0).parts;
  }
  EXPECT_GT(parts, 24);
}

TEST(SplitOverlaps, CutsWhereItIsCheap) {
  Mapped map = noose();
  // All across the loop but for one row of edges.
  for (Index h = 0; h < size_of(map.cost); ++h) {
    const double length = map.cost[h];
    const auto column = [&](Index v) { return v % 108; };
    const bool is_cheap = column(map.disk.origin(h)) == 45 && column(map.disk.target(h)) == 45;
    if (!is_cheap) map.cost[h] = 3 * length;
  }
  EXPECT_NEAR(expect_parted(map, 0.002).cost, 0.4, 1e-9);
}

TEST(SplitOverlaps, SaysWhereLocksLeaveNoWay) {
  Mapped map = noose();
  std::fill(map.cost.begin(), map.cost.end(), kLocked);
  const OverlapSplit result = split(map, 0);
  EXPECT_EQ(result.parts, 1);
  EXPECT_EQ(result.overlapping, 1);
  EXPECT_EQ(result.cost, 0);
}

TEST(SplitOverlaps, CutsLargeMapsByPatches) {
  // 80,000 faces: patches first, then face by face.
  const OverlapSplit result = expect_parted(flat(disks::winding(2000, 20, 0.3, 1.3)), 0.0001);
  EXPECT_EQ(result.parts, 2);
  EXPECT_NEAR(result.cost, 0.3, 0.03);
}

TEST(SplitOverlaps, CanBeCancelled) {
  const Mapped map = flat(disks::winding(600, 20, 0.3, 3.5));
  EXPECT_GT(count_polls([&] { split(map, 0.002); }), 20);
}

TEST(SplitOverlaps, PartsLocallyInjectiveMapsOfAnimals) {
  for (const std::string name : {"horse_f10000.obj", "octopus_mainComp_f6000.obj"}) {
    const auto path = shared_data::folder() / "closed" / name;
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not at hand";
    const meshes::TriangleList closed = shared_data::read_obj(path);
    DiskMesh disk = disks::disk(disks::opened(closed, disks::seams_through(closed, 12)));
    normalise(disk.positions, disk.faces, Work(1));
    ChartOptions options;
    options.injectivity = Injectivity::kLocal;
    std::vector<Vec2> uvs = minimise_from_scratch(disk, 1e-4, options, Work(1)).uvs;
    const Mapped map = mapped(std::move(disk), std::move(uvs));
    const double size = std::sqrt(surface_area(map.disk, Work(1)));
    const OverlapSplit result = expect_parted(map, 0.002);
    EXPECT_GT(result.parts, 1) << name;
    EXPECT_LE(result.parts, 5) << name;
    EXPECT_LT(result.cost, 0.7 * size) << name;
    expect_parted(map, 0);
  }
}

/// The marks of the edges around the middle cells of a grid of 9 by 9.
EdgeMarks ring(const DiskMesh& grid) {
  const auto is_inside = [&](Index f) {
    const Index x = f / 2 % 9, y = f / 2 / 9;
    return x > 2 && x < 6 && y > 2 && y < 6;
  };
  EdgeMarks marks(grid.twin.size(), false);
  for (Index h = 0; h < size_of(grid.twin); ++h) {
    const Index twin = grid.twin[h];
    if (twin != kNone && is_inside(h / 3) != is_inside(twin / 3)) marks[h] = true;
  }
  return marks;
}

TEST(JoinLoops, JoinsClosedCurvesToTheBoundary) {
  Mapped map = flat(meshes::grid(9, 9));
  lock_quads(map);
  EdgeMarks marks = ring(map.disk);
  const std::ptrdiff_t before = std::count(marks.begin(), marks.end(), true);
  ASSERT_EQ(cut_into_charts(map.disk, marks, Work(1)).non_disks.size(), 1u);
  EXPECT_TRUE(join_loops(map.disk, map.cost, marks, Work(1)));
  EXPECT_TRUE(cut_into_charts(map.disk, marks, Work(1)).non_disks.empty());
  EXPECT_EQ(std::count(marks.begin(), marks.end(), true), before + 2 * 3);
  EdgeMarks again = marks;
  EXPECT_TRUE(join_loops(map.disk, map.cost, again, Work(1)));
  EXPECT_EQ(again, marks);
}

TEST(JoinLoops, SaysWhereThereIsNoWay) {
  Mapped map = flat(meshes::grid(9, 9));
  std::fill(map.cost.begin(), map.cost.end(), kLocked);
  EdgeMarks marks = ring(map.disk);
  EXPECT_FALSE(join_loops(map.disk, map.cost, marks, Work(1)));
}

}  // namespace
}  // namespace beltrami
