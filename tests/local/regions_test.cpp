// Regions: apart from each other, relaxed and untangled as wholes.
#include "local/regions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

#include "energy/energy.h"
#include "energy/measure.h"
#include "exact/certificate.h"
#include "repair/repair.h"
#include "support/disks.h"
#include "support/meshes.h"
#include "support/polls.h"

namespace beltrami {
namespace {

using disks::Random;

constexpr Energy kEnergy = Energy::kSymmetricDirichlet;

double energy_of(const DiskMesh& mesh, const std::vector<Vec2>& uvs) {
  return measure_distortion(mesh.positions, mesh.faces, uvs, nullptr, Work(1)).symmetric_dirichlet;
}

bool injective(const DiskMesh& mesh, const std::vector<Vec2>& uvs) {
  return certify(mesh.faces, mesh.boundary, uvs, Work(1)).injective();
}

/// A flat grid of n by n with the vertices of a block squeezed towards one of its corners.
std::vector<Vec2> squeezed_block(const DiskMesh& mesh, Index n, Index from, Index to) {
  std::vector<Vec2> uvs = disks::flat_uvs(mesh);
  const Vec2 corner = uvs[from * (n + 1) + from];
  for (Index j = from + 1; j < to; ++j) {
    for (Index i = from + 1; i < to; ++i) {
      Vec2& uv = uvs[j * (n + 1) + i];
      uv = corner + 0.2 * (uv - corner);
    }
  }
  return uvs;
}

/// The same with a block mirrored.
std::vector<Vec2> mirrored_block(const DiskMesh& mesh, Index n, Index from, Index to) {
  std::vector<Vec2> uvs = disks::flat_uvs(mesh);
  const std::vector<Vec2> before = uvs;
  for (Index j = from; j <= to; ++j) {
    for (Index i = from; i <= to; ++i) {
      uvs[j * (n + 1) + i] = before[j * (n + 1) + from + to - i];
    }
  }
  return uvs;
}

std::vector<Patch> cut_regions(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                               const std::vector<Vec2>& uvs, const std::vector<Index>& faces,
                               const RegionSize& size, int threads = 1) {
  const Regions regions(mesh, faces, size, Work(threads));
  std::vector<Patch> patches;
  for (Index i = 0; i < regions.count(); ++i) patches.push_back(regions.patch(i, rest, uvs));
  return patches;
}

TEST(Regions, MoveNoVertexOfEachOtherAndAllThatIsNear) {
  const Index n = 40;
  const DiskMesh mesh = disks::disk(meshes::grid(n, n));
  const std::vector<Vec2> uvs = disks::flat_uvs(mesh);
  const std::vector<Index> faces = {0, 3, 2 * n * n - 1, n * n};
  const std::vector<Patch> regions = cut_regions(mesh, disks::rest_of(mesh), uvs, faces, {2});
  EXPECT_EQ(regions.size(), 3u);  // the first two are one
  std::set<Index> moving, present;
  for (const Patch& region : regions) {
    EXPECT_EQ(region.rest.size(), region.faces.size());
    for (std::size_t v = 0; v < region.mesh_vertices.size(); ++v) {
      const Index of_mesh = region.mesh_vertices[v];
      EXPECT_EQ(region.uvs[v], uvs[of_mesh]);
      EXPECT_FALSE((region.fixed[v] ? moving : present).contains(of_mesh));
      if (region.fixed[v]) continue;
      mesh.for_each_outgoing(of_mesh, [&](Index h) {
        EXPECT_TRUE(std::binary_search(region.mesh_faces.begin(), region.mesh_faces.end(), h / 3));
      });
    }
    for (std::size_t v = 0; v < region.mesh_vertices.size(); ++v) {
      present.insert(region.mesh_vertices[v]);
      if (!region.fixed[v]) moving.insert(region.mesh_vertices[v]);
    }
  }
  for (const Index face : faces) {
    for (const Index v : mesh.faces[face]) EXPECT_TRUE(moving.contains(v));
  }
}

TEST(Regions, ArePartedWhereTheyAreLargeAlongVerticesThatStay) {
  constexpr Index kMost = 60;
  const DiskMesh mesh = disks::disk(meshes::grid(40, 40));
  const std::vector<Vec2> uvs = disks::flat_uvs(mesh);
  const std::vector<Index> faces = {1600, 20};
  const std::vector<Patch> whole = cut_regions(mesh, {}, uvs, faces, {8});
  EXPECT_EQ(whole.size(), 2u);
  std::set<Index> moving_in_whole, moving, staying;
  for (const Patch& region : whole) {
    for (std::size_t v = 0; v < region.fixed.size(); ++v) {
      if (!region.fixed[v]) moving_in_whole.insert(region.mesh_vertices[v]);
    }
  }
  const std::vector<Patch> parts = cut_regions(mesh, {}, uvs, faces, {8, kMost});
  EXPECT_GE(parts.size(), 4u);
  for (const Patch& region : parts) {
    EXPECT_LE(std::count(region.fixed.begin(), region.fixed.end(), false), kMost);
    for (std::size_t v = 0; v < region.fixed.size(); ++v) {
      (region.fixed[v] ? staying : moving).insert(region.mesh_vertices[v]);
    }
  }
  for (const Index v : moving) {
    EXPECT_TRUE(moving_in_whole.contains(v));
    EXPECT_FALSE(staying.contains(v));
  }
  EXPECT_GT(moving.size(), moving_in_whole.size() / 2);
}

TEST(Regions, ArePartedIntoSharesOfWhatMoves) {
  const DiskMesh mesh = disks::disk(meshes::grid(100, 100));
  const RegionSize size{.rings = 14, .few_vertices = 20};
  const auto largest = [&](const std::vector<Patch>& regions) {
    std::ptrdiff_t most = 0, all = 0;
    for (const Patch& region : regions) {
      const auto moving = std::count(region.fixed.begin(), region.fixed.end(), false);
      most = std::max(most, moving);
      all += moving;
    }
    return static_cast<double>(most) / static_cast<double>(all);
  };
  const std::vector<Vec2> uvs = disks::flat_uvs(mesh);
  EXPECT_EQ(cut_regions(mesh, {}, uvs, {10100}, {14}).size(), 1u);
  // What parts them counts among what would have moved.
  EXPECT_LE(largest(cut_regions(mesh, {}, uvs, {10100}, size)), 1.0 / 8);
  EXPECT_EQ(cut_regions(mesh, {}, uvs, {10100}, {14, 20000, 20000}).size(), 1u);
}

TEST(Regions, AreTheSameOnAnyNumberOfThreads) {
  Random random(11);
  const DiskMesh mesh = disks::disk(meshes::grid(200, 200));
  const std::vector<Vec2> uvs = disks::flat_uvs(mesh);
  std::vector<Index> faces;
  for (int i = 0; i < 600; ++i) faces.push_back(random.below(mesh.face_count()));
  const std::vector<Patch> one = cut_regions(mesh, {}, uvs, faces, {3, 500});
  EXPECT_GT(one.size(), 10u);
  for (const int threads : {2, 5}) {
    const std::vector<Patch> more = cut_regions(mesh, {}, uvs, faces, {3, 500}, threads);
    ASSERT_EQ(more.size(), one.size());
    for (std::size_t i = 0; i < one.size(); ++i) {
      EXPECT_EQ(more[i].mesh_vertices, one[i].mesh_vertices);
      EXPECT_EQ(more[i].faces, one[i].faces);
      EXPECT_EQ(more[i].fixed, one[i].fixed);
    }
  }
}

// With a face each, none of which takes long enough to look by itself.
TEST(Regions, LookForARequestToCancelWhereThereAreMany) {
  const DiskMesh mesh = disks::disk(meshes::grid(400, 400));
  const std::vector<Vec2> uvs = disks::flat_uvs(mesh);
  const auto polls = [&](Index step) {
    std::vector<Index> faces;
    for (Index f = 0; f < mesh.face_count(); f += step) faces.push_back(f);
    return count_polls([&] { Regions(mesh, faces, {0}, Work(1)); });
  };
  EXPECT_GE(polls(8), polls(8000) + 20000 * 3 * 6 / 4096 / 2);
}

TEST(Regions, OfTheWholeMeshHoldOneVertex) {
  const DiskMesh mesh = disks::disk(meshes::grid(2, 2));
  const std::vector<Patch> regions =
      cut_regions(mesh, {}, disks::flat_uvs(mesh), {0, 2, 5, 7}, {3});
  ASSERT_EQ(regions.size(), 1u);
  EXPECT_EQ(std::count(regions[0].fixed.begin(), regions[0].fixed.end(), true), 1);
}

TEST(Regions, StayAPartOfTheMesh) {
  const DiskMesh mesh = disks::disk(meshes::grid(60, 60));
  std::vector<Index> faces;
  for (Index f = 0; f < mesh.face_count(); f += 97) faces.push_back(f);
  std::size_t moving = 0;
  for (const Patch& region : cut_regions(mesh, {}, disks::flat_uvs(mesh), faces, {20})) {
    moving += std::count(region.fixed.begin(), region.fixed.end(), false);
  }
  EXPECT_LT(moving, mesh.positions.size() / 2);
}

TEST(Regions, LeaveAHubWhereItIs) {
  const auto polls = [](Index faces) {
    const DiskMesh mesh = disks::disk(meshes::fan(faces));
    const std::vector<Vec2> uvs = disks::flat_uvs(mesh);
    return count_polls([&] {
      for (const Patch& region : cut_regions(mesh, {}, uvs, {7}, {1})) {
        for (std::size_t v = 0; v < region.fixed.size(); ++v) {
          EXPECT_TRUE(region.mesh_vertices[v] != 0 || region.fixed[v]);
        }
      }
    });
  };
  EXPECT_LE(polls(100000), 2 * polls(3000) + 2);
}

TEST(RelaxRegions, FindTheMinimumNearbyAndTouchNothingElse) {
  const Index n = 40;
  const DiskMesh mesh = disks::disk(meshes::grid(n, n));
  const std::vector<Vec2> flat = disks::flat_uvs(mesh);
  std::vector<Vec2> uvs = squeezed_block(mesh, n, 10, 13);
  ASSERT_TRUE(injective(mesh, uvs));
  const double before = energy_of(mesh, uvs);
  std::vector<Index> faces;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const Triangle& t = mesh.faces[f];
    if (std::any_of(t.begin(), t.end(), [&](Index v) { return uvs[v] != flat[v]; })) {
      faces.push_back(f);
    }
  }
  EXPECT_EQ(relax_regions(kEnergy, mesh, disks::rest_of(mesh), uvs, faces, 4, Work(1)), 1);
  EXPECT_GT(before - 2, 0.01);
  EXPECT_LT(energy_of(mesh, uvs) - 2, 0.01 * (before - 2));
  EXPECT_TRUE(injective(mesh, uvs));
  EXPECT_EQ(uvs[30 * (n + 1) + 30], flat[30 * (n + 1) + 30]);
}

TEST(RelaxRegions, HaveTheSameBitsOnTwoThreads) {
  Random random(3);
  const DiskMesh mesh = disks::disk(meshes::grid(60, 60));
  std::vector<Vec2> one = disks::flat_uvs(mesh);
  for (Vec2& uv : one) uv += 2e-3 * random.vec2();
  std::vector<Vec2> two = one;
  std::vector<Index> faces;
  for (int i = 0; i < 12; ++i) faces.push_back(random.below(mesh.face_count()));
  const auto rest = disks::rest_of(mesh);
  const double before = energy_of(mesh, one);
  EXPECT_GT(relax_regions(kEnergy, mesh, rest, one, faces, 4, Work(1)), 1);
  relax_regions(kEnergy, mesh, rest, two, faces, 4, Work(2));
  EXPECT_EQ(one, two);
  EXPECT_LT(energy_of(mesh, one), before);
  EXPECT_TRUE(injective(mesh, one));
}

TEST(RelaxRegions, HaveTheSameBitsWhereAllThreadsWorkOnOne) {
  Random random(4);
  const DiskMesh mesh = disks::disk(meshes::grid(120, 120));
  std::vector<Vec2> start = disks::flat_uvs(mesh);
  for (Vec2& uv : start) uv += 1e-3 * random.vec2();
  std::vector<Index> faces;
  for (Index i = 0; i < 20; ++i) faces.push_back(2 * (120 * 80 + 50) + i);
  const auto rest = disks::rest_of(mesh);
  const auto relaxed_on = [&](int threads) {
    std::vector<Vec2> uvs = start;
    EXPECT_EQ(relax_regions(kEnergy, mesh, rest, uvs, faces, 8, Work(threads)), 1);
    return uvs;
  };
  const std::vector<Vec2> one = relaxed_on(1);
  EXPECT_NE(one, start);
  for (const int threads : {2, 4, 16}) EXPECT_EQ(relaxed_on(threads), one);
}

TEST(Repair, UntanglesALargeRegionToTheSameBitsOnSeveralThreads) {
  const Index n = 150;
  const DiskMesh mesh = disks::disk(meshes::grid(n, n));
  const std::vector<Vec2> start = mirrored_block(mesh, n, 66, 84);
  const auto repaired_on = [&](int threads) {
    std::vector<Vec2> uvs = start;
    const RepairOptions options{.global_fix = false};
    const RepairResult result = repair(mesh, disks::rest_of(mesh), uvs, options, Work(threads));
    EXPECT_EQ(result.patch_fixes, 1);
    EXPECT_EQ(result.flips_after, 0);
    return uvs;
  };
  const std::vector<Vec2> one = repaired_on(1);
  for (const int threads : {2, 8}) EXPECT_EQ(repaired_on(threads), one);
}

// Every patch within the block has others on its edges that hold it.
TEST(Repair, UntanglesABlockOfManyFacesAsAWhole) {
  const Index n = 70;
  const DiskMesh mesh = disks::disk(meshes::grid(n, n));
  std::vector<Vec2> uvs = mirrored_block(mesh, n, 32, 38);
  const RepairResult result =
      repair(mesh, disks::rest_of(mesh), uvs, {.global_fix = false}, Work(1));
  EXPECT_GT(result.flips_before, 30);
  EXPECT_EQ(result.patch_fixes, 1);
  EXPECT_EQ(result.flips_after, 0);
  EXPECT_TRUE(injective(mesh, uvs));
}

}  // namespace
}  // namespace beltrami
