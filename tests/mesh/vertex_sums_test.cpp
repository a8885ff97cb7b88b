#include "mesh/vertex_sums.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "base/lanes.h"
#include "mesh/disk_mesh.h"
#include "mesh/face_block.h"
#include "mesh/rest_shape.h"
#include "support/disks.h"
#include "support/meshes.h"

namespace beltrami {
namespace {

/// What corner k of a face gives: small whole numbers, whose sums are exact.
Vec2 term(Index f, int k) {
  return {static_cast<double>(f % 13 - 6), static_cast<double>((f + k) % 7)};
}

std::vector<Vec2> one_by_one(const DiskMesh& mesh, int threads) {
  std::vector<Vec2> sums;
  VertexSums(mesh.vertex_count(), mesh.faces, Work(threads))
      .add_up(
          [](Index f, VertexSums::Terms& terms) {
            for (int k = 0; k < 3; ++k) terms[k] = term(f, k);
            return 0.0;
          },
          sums);
  return sums;
}

std::vector<Vec2> in_lanes(const DiskMesh& mesh, int threads) {
  std::vector<Vec2> sums;
  VertexSums(mesh.vertex_count(), mesh.faces, Work(threads))
      .add_up_lanes(
          [](const std::array<Index, kLanes>& faces, VertexSums::LaneTerms& terms) {
            for (int k = 0; k < 3; ++k) {
              for (int i = 0; i < kLanes; ++i) {
                terms[k].real[i] = static_cast<float>(term(faces[i], k).x());
                terms[k].imag[i] = static_cast<float>(term(faces[i], k).y());
              }
            }
          },
          sums);
  return sums;
}

std::vector<Vec2> in_blocks(const DiskMesh& mesh, int threads) {
  std::vector<Vec2> sums;
  const double counted =
      VertexSums(mesh.vertex_count(), mesh.faces, Work(threads))
          .add_up_blocks(
              [](std::int64_t first, std::int64_t, VertexSums::BlockTerms& terms) {
                for (int i = 0; i < FaceBlock::kFaces; ++i) {
                  terms.value[i] = 1;
                  for (int k = 0; k < 3; ++k) {
                    terms.x[k][i] = term(static_cast<Index>(first + i), k).x();
                    terms.y[k][i] = term(static_cast<Index>(first + i), k).y();
                  }
                }
              },
              sums);
  EXPECT_EQ(counted, mesh.face_count());
  return sums;
}

// Face counts that lanes and chunks divide, and that they do not.
TEST(VertexSums, InLanesAndBlocksAreThoseOneByOne) {
  for (const int n : {1, 2, 5, 64, 67}) {
    const DiskMesh mesh = disks::disk(meshes::grid(n, 3 * n));
    const std::vector<Vec2> expected = one_by_one(mesh, 1);
    EXPECT_EQ(in_lanes(mesh, 1), expected) << n;
    EXPECT_EQ(in_lanes(mesh, 2), expected) << n;
    EXPECT_EQ(in_blocks(mesh, 1), expected) << n;
    EXPECT_EQ(in_blocks(mesh, 2), expected) << n;
    EXPECT_EQ(one_by_one(mesh, 2), expected) << n;
  }
}

TEST(FaceBlock, HasTheBitsOfSingleFaces) {
  const DiskMesh mesh = disks::disk(meshes::bumps(5, 7));
  const std::vector<RestTriangle> rest = rest_triangles(mesh.positions, mesh.faces, Work(1));
  std::vector<Vec2> uvs;
  for (const Vec3& p : mesh.positions) uvs.emplace_back(p.x() / 3 - p.z(), p.y() + p.x() * p.y());
  FaceBlock block;
  for (std::int64_t first = 0; first < mesh.face_count(); first += FaceBlock::kFaces) {
    block.load(mesh.faces, rest, uvs, first, mesh.face_count());
    for (int i = 0; i < FaceBlock::kFaces; ++i) {
      const std::int64_t f = std::min<std::int64_t>(first + i, mesh.face_count() - 1);
      const Triangle& t = mesh.faces[f];
      const LinearMap expected = linear_map(rest[f], uvs[t[0]], uvs[t[1]], uvs[t[2]]);
      EXPECT_EQ(block.map(i).fz, expected.fz);
      EXPECT_EQ(block.map(i).fzbar, expected.fzbar);
      EXPECT_EQ(block.rest(i).area(), rest[f].area());
    }
  }
}

}  // namespace
}  // namespace beltrami
