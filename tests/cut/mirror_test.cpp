// The plane that a surface is symmetric to.
#include "cut/mirror.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <vector>

#include "admit/admit.h"
#include "base/portable_math.h"
#include "base/types.h"
#include "base/work.h"
#include "mesh/surface.h"
#include "simplify/simplify.h"
#include "support/meshes.h"
#include "support/shared_data.h"
#include "support/solids.h"
#include "support/surfaces.h"

namespace beltrami {
namespace {

using meshes::TriangleList;

constexpr double kTolerance = 0.01;

Surface surface_of(const TriangleList& mesh) {
  return build_surface(mesh.positions, mesh.faces, Work(1));
}

std::optional<Mirror> mirror_of(const TriangleList& mesh, int threads = 1) {
  return find_mirror(surface_of(mesh), kTolerance, Work(threads));
}

/// Symmetric to x = 0 and to no other plane; `skew` breaks that.
TriangleList creature(int times, double skew = 0) {
  return meshes::moved(meshes::sphere(times), [&](const Vec3& p) {
    return Vec3(p.x() * (1 + 0.4 * p.z()) + skew * portable::sin(3 * p.z()),
                1.5 * p.y() + 0.5 * p.z() * p.z() + 0.3 * p.x() * p.x(),
                2 * p.z() + 0.4 * p.y() * p.y() * p.y());
  });
}

double across_x(const Mirror& mirror) {
  return std::abs(mirror.normal.x());
}

TEST(Mirror, OfASymmetricMeshIsExact) {
  const TriangleList mesh = creature(4);
  const std::optional<Mirror> mirror = mirror_of(mesh);
  ASSERT_TRUE(mirror);
  EXPECT_NEAR(across_x(*mirror), 1, 1e-12);
  EXPECT_NEAR(mirror->point.x(), 0, 1e-9);
  EXPECT_EQ(mirror->share, 1);
  for (Index v = 0; v < size_of(mesh.positions); ++v) {
    const Vec3& p = mesh.positions[v];
    const Index image = mirror->image[v];
    EXPECT_LT((mesh.positions[image] - Vec3(-p.x(), p.y(), p.z())).norm(), 1e-9);
    EXPECT_EQ(mirror->image[image], v);
    EXPECT_EQ(mirror->side[v], p.x() == 0 ? 0 : (p.x() * mirror->normal.x() > 0 ? 1 : -1));
    EXPECT_EQ(mirror->side[image], -mirror->side[v]);
  }
}

TEST(Mirror, GoesWithTheMeshWhereItIsMoved) {
  const TriangleList mesh = creature(3);
  const Eigen::Matrix3d turn = meshes::some_turn();
  const TriangleList moved = meshes::moved(
      mesh, [&](const Vec3& p) { return Vec3(turn * (1000 * p) + Vec3(3e4, -2e3, 5)); });
  const std::optional<Mirror> mirror = mirror_of(mesh), after = mirror_of(moved);
  ASSERT_TRUE(mirror && after);
  EXPECT_NEAR(std::abs(after->normal.dot(turn.col(0))), 1, 1e-9);
  EXPECT_EQ(mirror->image, after->image);
}

TEST(Mirror, IsTheSameBitsAtTwoThreads) {
  for (const TriangleList& mesh : {creature(3), meshes::sphere(3)}) {
    const std::optional<Mirror> one = mirror_of(mesh, 1), two = mirror_of(mesh, 2);
    ASSERT_TRUE(one && two);
    EXPECT_EQ(one->normal, two->normal);
    EXPECT_EQ(one->point, two->point);
    EXPECT_EQ(one->image, two->image);
    EXPECT_EQ(one->side, two->side);
  }
}

TEST(Mirror, IsFoundWhereAxesAreNotDistinct) {
  for (const TriangleList& mesh :
       {meshes::cube(), meshes::split_in_four(meshes::cube(), 3), meshes::torus(24),
        meshes::octahedron(), meshes::sphere(4),
        meshes::moved(meshes::split_in_four(meshes::cube(), 3),
                      [](const Vec3& p) { return Vec3(meshes::some_turn() * p); })}) {
    const std::optional<Mirror> mirror = mirror_of(mesh);
    ASSERT_TRUE(mirror);
    EXPECT_GT(mirror->share, 0.99);
  }
  // One plane alone, and all moments alike: planes between the axes have to be tried.
  TriangleList balls;
  for (const Vec3& at : {Vec3(1, 0, 0), Vec3(-0.5, 0.9, 0), Vec3(-0.5, -0.9, 0)}) {
    const double size = at.y() == 0 ? 0.5 : 0.4;
    balls = meshes::together({balls, meshes::moved(meshes::sphere(2), [&](const Vec3& p) {
                                return Vec3(at + size * p + Vec3(0, 0, 0.3 * p.y() * p.y()));
                              })});
  }
  const std::optional<Mirror> mirror = mirror_of(balls);
  ASSERT_TRUE(mirror);
  EXPECT_NEAR(std::abs(mirror->normal.y()), 1, 0.01);
}

TEST(Mirror, IsFoundThroughNoise) {
  const TriangleList mesh = meshes::shaken(creature(4), 0.008, 3);  // 0.2% of the root of the area
  const std::optional<Mirror> mirror = mirror_of(mesh);
  ASSERT_TRUE(mirror);
  EXPECT_GT(across_x(*mirror), 0.9998);
  EXPECT_GT(mirror->share, 0.99);
}

TEST(Mirror, IsFoundOnSimplifiedMeshes) {
  const Surface fine = surface_of(creature(5));
  const Surface coarse = simplify_surface(fine, boundary_loops(fine, Work(1)), 1000, Work(1)).mesh;
  const std::optional<Mirror> mirror = find_mirror(coarse, kTolerance, Work(1));
  ASSERT_TRUE(mirror);
  EXPECT_GT(across_x(*mirror), 0.9998);
  // Images are near, by the lengths of edges.
  for (Index v = 0; v < coarse.vertex_count(); ++v) {
    const Vec3& p = coarse.positions[v];
    double reach = 0;
    const Index image = mirror->image[v];
    coarse.for_each_outgoing(image, [&](Index h) {
      const Vec3 along = coarse.positions[coarse.target(h)] - coarse.positions[coarse.origin(h)];
      reach = std::max(reach, along.norm());
    });
    EXPECT_LT((coarse.positions[image] - Vec3(-p.x(), p.y(), p.z())).norm(), reach);
  }
  std::vector<double> factors(coarse.twin.size(), 1);
  weigh_mirror(coarse, *mirror, 0.5, factors, Work(1));
  EXPECT_GT(std::count(factors.begin(), factors.end(), 0.5), 10);
}

TEST(Mirror, IsRefusedWhereThereIsNone) {
  EXPECT_FALSE(mirror_of(creature(4, 0.3)));
  EXPECT_FALSE(mirror_of(meshes::bumps(20, 20)));
  // Two parts of different size.
  EXPECT_FALSE(mirror_of(
      meshes::together({creature(3, 0.2), meshes::moved(creature(3, 0.2), [](const Vec3& p) {
                          return Vec3(5 - 0.8 * p.x(), p.y(), p.z());
                        })})));
  EXPECT_FALSE(
      mirror_of(meshes::moved(meshes::torus(5), [](const Vec3&) { return Vec3(1, 2, 3); })));
}

TEST(Mirror, MayTakeAComponentToAnother) {
  TriangleList left = creature(3, 0.3), right = left;
  for (Vec3& p : left.positions) p.x() -= 3;
  for (Vec3& p : right.positions) p.x() = -p.x() + 3;
  for (Triangle& face : right.faces) std::swap(face[1], face[2]);
  const std::optional<Mirror> mirror = mirror_of(meshes::together({left, right}));
  ASSERT_TRUE(mirror);
  const Index half = size_of(left.positions);
  for (Index v = 0; v < half; ++v) {
    EXPECT_EQ(mirror->image[v], v + half);
    EXPECT_EQ(mirror->image[v + half], v);
    EXPECT_EQ(mirror->side[v], -mirror->side[v + half]);
    EXPECT_NE(mirror->side[v], 0);
  }
}

TEST(Mirror, IsNotThePlaneOfASheet) {
  const std::optional<Mirror> mirror = mirror_of(meshes::grid(12, 7));
  ASSERT_TRUE(mirror);
  EXPECT_LT(std::abs(mirror->normal.z()), 1e-6);
}

TEST(Mirror, FavoursEdgesInThePlane) {
  const Surface surface = surface_of(creature(4));
  const std::optional<Mirror> mirror = find_mirror(surface, kTolerance, Work(1));
  ASSERT_TRUE(mirror);
  std::vector<double> factors(surface.twin.size(), 1);
  weigh_mirror(surface, *mirror, 0.5, factors, Work(1));
  for (Index h = 0; h < size_of(factors); ++h) {
    const Vec3 &a = surface.positions[surface.origin(h)], &b = surface.positions[surface.target(h)];
    if (a.x() == 0 && b.x() == 0) {
      EXPECT_EQ(factors[h], 0.5);
    } else if (std::max(std::abs(a.x()), std::abs(b.x())) > 0.5 * (a - b).norm() + 0.05) {
      EXPECT_EQ(factors[h], 1);
    }
  }
}

TEST(Mirror, OfModelsAsPeopleHaveThem) {
  const auto mirror_in = [](const char* name) {
    const std::filesystem::path path = shared_data::folder() / name;
    const TriangleList mesh = shared_data::read_obj(path);
    return find_mirror(admit(mesh.positions, mesh.faces, {}, Work(1)).surface, kTolerance, Work(1));
  };
  if (!std::filesystem::exists(shared_data::folder() / "free" / "spot.obj")) {
    GTEST_SKIP() << "the shared meshes are not at hand";
  }
  EXPECT_TRUE(mirror_in("free/spot.obj"));
  EXPECT_FALSE(mirror_in("closed/bunny.obj"));
  EXPECT_FALSE(mirror_in("closed/horse_f10000.obj"));
}

}  // namespace
}  // namespace beltrami
