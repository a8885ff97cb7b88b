// Rays that meet faces.
#include "mesh/rays.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "mesh/closest_point.h"
#include "mesh/face_tree.h"

namespace beltrami {
namespace {

/// Numbers from -1 to 1.
class Numbers {
 public:
  double next() {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return double(state_ >> 33) / double(std::uint64_t{1} << 30) - 1;
  }
  Vec3 vector() {
    const double x = next(), y = next();
    return {x, y, next()};
  }

 private:
  std::uint64_t state_ = 1;
};

struct Faces {
  std::vector<Vec3> positions;
  std::vector<Triangle> faces;

  void add(const Vec3& a, const Vec3& b, const Vec3& c) {
    const Index first = size_of(positions);
    positions.insert(positions.end(), {a, b, c});
    faces.push_back({first, first + 1, first + 2});
  }
};

TEST(Rays, MeetWhatTheFirstOfAllFacesIs) {
  Numbers numbers;
  Faces mesh;
  for (int i = 0; i < 300; ++i) {
    const Vec3 a = numbers.vector();
    mesh.add(a, a + 0.3 * numbers.vector(), a + 0.3 * numbers.vector());
  }
  const FaceTree tree(mesh.positions, mesh.faces);
  const Rays rays(mesh.positions, mesh.faces, tree);
  int met = 0;
  for (int i = 0; i < 2000; ++i) {
    const Ray ray{2 * numbers.vector(), numbers.vector().normalized(), 3};
    double first = ray.reach;
    bool stopped = false;
    Index face = kNone;
    for (Index f = 0; f < size_of(mesh.faces); ++f) {
      Eigen::Matrix3d sides;
      const auto& [a, b, c] = mesh.faces[f];
      sides << mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a],
          -ray.direction;
      const Vec3 at = sides.partialPivLu().solve(ray.origin - mesh.positions[a]);
      if (at.x() < 0 || at.y() < 0 || at.x() + at.y() > 1 || at.z() < 0 || at.z() > 3) continue;
      stopped = true;
      if (sides.col(0).cross(sides.col(1)).dot(ray.direction) >= 0 || at.z() >= first) continue;
      first = at.z();
      face = f;
    }
    const SurfacePoint found = rays.first_from_outside(ray);
    EXPECT_EQ(found.face, face);
    EXPECT_EQ(rays.is_stopped(ray), stopped);
    if (face == kNone) continue;
    ++met;
    EXPECT_NEAR(std::sqrt(found.distance_sq), first, 1e-9);
  }
  EXPECT_GT(met, 50);
}

TEST(Rays, DoNotSlipThroughBetweenFaces) {
  // A fan in a slanted plane: the rays go through its edges and its middle.
  Faces mesh;
  const auto rim = [](int i) {
    const double angle = i * 0.7853981633974483;
    return Vec3(std::cos(angle), std::sin(angle), 0.3 * std::cos(angle));
  };
  for (int i = 0; i < 8; ++i) mesh.add({0, 0, 0}, rim(i), rim(i + 1));
  const FaceTree tree(mesh.positions, mesh.faces);
  const Rays rays(mesh.positions, mesh.faces, tree);
  for (int i = 0; i < 8; ++i) {
    for (int k = 0; k < 100; ++k) {
      const Vec3 place = k / 101.0 * rim(i);
      EXPECT_NE(rays.first_from_outside({place + Vec3(0, 0, 1), {0, 0, -1}, 2}).face, kNone);
      EXPECT_EQ(rays.first_from_outside({place - Vec3(0, 0, 1), {0, 0, 1}, 2}).face, kNone);
    }
  }
}

TEST(Rays, WithinTheSideOfABoxMeetIt) {
  Faces mesh;
  mesh.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  mesh.add({0, 0, 1}, {1, 0, 1}, {0, 1, 1});
  const FaceTree tree(mesh.positions, mesh.faces);
  const Rays rays(mesh.positions, mesh.faces, tree);
  for (const double zero : {0.0, -0.0}) {
    EXPECT_EQ(rays.first_from_outside({{0, 0, 2}, {zero, zero, -1}, 4}).face, 1);
    EXPECT_TRUE(rays.is_stopped({{0, 0, -2}, {zero, zero, 1}, 4}));
    EXPECT_FALSE(rays.is_stopped({{0, 0, -2}, {zero, zero, 1}, 1.5}));
  }
}

}  // namespace
}  // namespace beltrami
