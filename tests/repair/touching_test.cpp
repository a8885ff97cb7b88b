// Boundaries that touch themselves are parted by no more than is needed.
#include "repair/touching.h"

#include <gtest/gtest.h>

#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "exact/certificate.h"
#include "exact/crossings.h"
#include "mesh/disk_mesh.h"

namespace beltrami {
namespace {

/// A square ring of eight triangles that is cut open along one edge: vertices 0 and 8 are the ends
/// of the slit outside, 4 and 9 those inside.
DiskMesh slit_ring() {
  std::vector<Vec3> positions = {{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0}, {1, 1, 0},
                                 {2, 1, 0}, {2, 2, 0}, {1, 2, 0}, {0, 0, 0}, {1, 1, 0}};
  std::vector<Triangle> faces = {{0, 1, 5}, {0, 5, 4}, {1, 2, 6}, {1, 6, 5},
                                 {2, 3, 7}, {2, 7, 6}, {3, 8, 9}, {3, 9, 7}};
  return build_disk(std::move(positions), std::move(faces), Work(1));
}

std::vector<Vec2> as_it_lies(const DiskMesh& mesh) {
  std::vector<Vec2> uvs;
  for (const Vec3& p : mesh.positions) uvs.emplace_back(p.x(), p.y());
  return uvs;
}

TEST(Touching, ASlitIsOpenedByHardlyAnything) {
  const DiskMesh mesh = slit_ring();
  const std::vector<Vec2> closed = as_it_lies(mesh);
  ASSERT_FALSE(is_simple(mesh.boundary, closed));
  std::vector<Vec2> opened = closed;
  ASSERT_TRUE(open_touching_sides(mesh, Work(1), opened));
  EXPECT_TRUE(certify(mesh.faces, mesh.boundary, opened, Work(1)).injective());
  for (std::size_t v = 0; v < opened.size(); ++v) {
    EXPECT_LT((opened[v] - closed[v]).norm(), 1e-7);
  }
  for (const Index v : {2, 6}) EXPECT_EQ(opened[v], closed[v]) << "where nothing touches";
}

TEST(Touching, WhatReallyOverlapsIsLeftAsItIs) {
  const DiskMesh mesh = slit_ring();
  std::vector<Vec2> uvs = as_it_lies(mesh);
  for (const Index v : {8, 9}) uvs[v] += Vec2(0.2, -0.2);
  const std::vector<Vec2> before = uvs;
  EXPECT_FALSE(open_touching_sides(mesh, Work(1), uvs));
  EXPECT_EQ(uvs, before);
}

TEST(Touching, ASimpleBoundaryStaysWhereItIs) {
  const DiskMesh mesh = slit_ring();
  std::vector<Vec2> uvs = as_it_lies(mesh);
  for (const Index v : {8, 9}) uvs[v] += Vec2(-0.1, 0.1);
  const std::vector<Vec2> before = uvs;
  EXPECT_TRUE(open_touching_sides(mesh, Work(1), uvs));
  EXPECT_EQ(uvs, before);
}

}  // namespace
}  // namespace beltrami
