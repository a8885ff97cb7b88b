// Intrinsic flips against plane geometry, where everything can be checked.
#include "flatten/intrinsic_delaunay.h"
#include "base/portable_math.h"
#include "base/vectors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <vector>

#include "exact/certificate.h"
#include "flatten/dirichlet.h"
#include "mesh/disk_mesh.h"
#include "prolong/prolongation.h"
#include "support/disks.h"
#include "support/meshes.h"
#include "support/polls.h"

namespace beltrami {
namespace {

using disks::Random;

std::vector<Cotangents> cotangents_of(const DiskMesh& mesh, Complex mu = 0) {
  std::vector<FaceMetric> metric(mesh.faces.size());
  for (FaceMetric& m : metric) m.mu = mu;
  return modified_cotangents(disks::rest_of(mesh), metric, Work(1));
}

/// A flat grid, its inner vertices shaken hard, but without flips.
DiskMesh shaken(Index n, int seed) {
  Random random(seed);
  meshes::TriangleList list = meshes::grid(n, n);
  for (Vec3& p : list.positions) {
    if (std::min({p.x(), p.y(), 1 - p.x(), 1 - p.y()}) < 1e-9) continue;
    const Vec2 shift = 0.32 / n * random.vec2();
    p += Vec3(shift.x(), shift.y(), 0);
  }
  return disks::disk(std::move(list));
}

double opposite_sum(const DiskMesh& mesh, const std::vector<Cotangents>& cotangents, Index h) {
  const Index here = DiskMesh::previous(h), there = DiskMesh::previous(mesh.twin[h]);
  return cotangents[here / 3][here % 3] + cotangents[there / 3][there % 3];
}

TEST(IntrinsicDelaunay, FlipsTheLongDiagonalOfAQuad) {
  // Vertices 0 and 2 far apart: the diagonal 0-2 must go.
  const std::vector<Vec3> positions = {{-3, 0, 0}, {0, -1, 0}, {2, 0.5, 0}, {0.25, 1, 0}};
  const DiskMesh mesh = build_disk(positions, {{0, 1, 2}, {0, 2, 3}}, Work(1));
  const DelaunayTriangulation result = intrinsic_delaunay(mesh, cotangents_of(mesh), Work(1));
  EXPECT_EQ(result.flips, 1);
  EXPECT_EQ(result.refused, 0);
  const DiskMesh flipped = build_disk(positions, result.faces, Work(1));
  const auto expected = cotangents_of(flipped);
  for (Index f = 0; f < 2; ++f) {
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(result.cotangents[f][k], expected[f][k], 1e-12);
  }
}

TEST(IntrinsicDelaunay, IsDelaunayInThePlaneWithTheCotangentsOfItsFaces) {
  for (int seed = 0; seed < 10; ++seed) {
    const DiskMesh mesh = shaken(12, seed);
    const DelaunayTriangulation result = intrinsic_delaunay(mesh, cotangents_of(mesh), Work(1));
    EXPECT_GT(result.flips, 0);
    EXPECT_EQ(result.refused, 0);
    const DiskMesh flipped = build_disk(mesh.positions, result.faces, Work(1));
    EXPECT_EQ(flipped.boundary.size(), mesh.boundary.size());
    EXPECT_TRUE(
        certify(flipped.faces, flipped.boundary, disks::flat_uvs(flipped), Work(1)).injective());
    const auto expected = cotangents_of(flipped);
    for (Index f = 0; f < flipped.face_count(); ++f) {
      for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(result.cotangents[f][k], expected[f][k], 1e-8 * (1 + std::abs(expected[f][k])));
      }
    }
    for (Index h = 0; h < size_of(flipped.twin); ++h) {
      if (flipped.twin[h] == kNone) continue;
      EXPECT_GE(opposite_sum(flipped, result.cotangents, h), -1e-9);
    }
  }
}

TEST(IntrinsicDelaunay, SeesTheConformalClassAlone) {
  // An affine metric on the plane: the flips are those of the sheared plane.
  const Complex mu(0.3, -0.5);
  const DiskMesh mesh = shaken(10, 77);
  // The frames of the faces turn with their first edge, so that mu does with its double.
  std::vector<Cotangents> cotangents(mesh.faces.size());
  const auto rest = disks::rest_of(mesh);
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const Vec3 e = mesh.positions[mesh.faces[f][1]] - mesh.positions[mesh.faces[f][0]];
    const Complex turn = Complex(e.x(), e.y()) / std::hypot(e.x(), e.y());
    cotangents[f] = modified_cotangents(rest[f], mu * std::conj(turn * turn));
  }
  const auto sheared_uvs = disks::affine_uvs(mesh, mu);
  std::vector<Vec3> sheared;
  for (const Vec2& w : sheared_uvs) sheared.emplace_back(w.x(), w.y(), 0);
  const DiskMesh plane = build_disk(sheared, mesh.faces, Work(1));
  const auto sorted = [](std::vector<Triangle> faces) {
    for (Triangle& t : faces) std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    std::sort(faces.begin(), faces.end());
    return faces;
  };
  EXPECT_EQ(sorted(intrinsic_delaunay(mesh, cotangents, Work(1)).faces),
            sorted(intrinsic_delaunay(plane, cotangents_of(plane), Work(1)).faces));
}

TEST(IntrinsicDelaunay, RefusesToRepeatAnEdgeAndSaysSo) {
  // An inner vertex with three neighbours and flat angles: flipping 1-2 would join 0 and 3 again.
  const std::vector<Vec3> positions = {
      {0, 0.02, 0}, {-1, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -0.05, 0}};
  const DiskMesh mesh =
      build_disk(positions, {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {2, 1, 4}}, Work(1));
  const DelaunayTriangulation result = intrinsic_delaunay(mesh, cotangents_of(mesh), Work(1));
  std::set<std::pair<Index, Index>> directed;
  for (const Triangle& t : result.faces) {
    for (int k = 0; k < 3; ++k) EXPECT_TRUE(directed.insert({t[k], t[next_corner(k)]}).second);
  }
  EXPECT_NO_THROW(build_disk(positions, result.faces, Work(1)));
}

TEST(IntrinsicDelaunay, MakesHarmonicMapsIntoConvexPolygonsInjective) {
  const DiskMesh mesh = disks::disk(disks::slivers(20, 20));
  const DelaunayTriangulation result = intrinsic_delaunay(mesh, cotangents_of(mesh), Work(1));
  ASSERT_EQ(result.refused, 0);
  const DiskMesh flipped = build_disk(mesh.positions, result.faces, Work(1));
  std::vector<Vec2> uvs(mesh.positions.size(), Vec2::Zero());
  for (std::size_t i = 0; i < mesh.boundary.size(); ++i) {
    const double angle = 6.283185307179586 * static_cast<double>(i) / mesh.boundary.size();
    uvs[flipped.boundary[i]] = {portable::cos(angle), portable::sin(angle)};
  }
  solve_harmonic(flipped, result.cotangents, uvs, Work(1));
  EXPECT_TRUE(non_positive_faces(flipped.faces, uvs, Work(1)).empty());
}

/// A hub with flat ears on every edge of its rim: each of these edges must go.
DiskMesh eared_fan(Index n) {
  meshes::TriangleList list = meshes::fan(n);
  const double half = std::numbers::pi / n;
  for (Index i = 0; i < n; ++i) {
    const double angle = (2 * i + 1) * half, radius = 1 - half * half / 4;
    list.positions.push_back({radius * std::cos(angle), radius * std::sin(angle), 0});
    list.faces.push_back({1 + i, 1 + n + i, 1 + (i + 1) % n});
  }
  return disks::disk(std::move(list));
}

TEST(IntrinsicDelaunay, TakesLittleMoreThanTwiceTheWorkForAHubOfTwiceTheFaces) {
  const auto polls = [](Index n) {
    const DiskMesh mesh = eared_fan(n);
    const auto cotangents = cotangents_of(mesh);
    return count_polls([&] { EXPECT_GE(intrinsic_delaunay(mesh, cotangents, Work(1)).flips, n); });
  };
  EXPECT_LE(polls(16000), 3 * polls(8000) + 10);
}

}  // namespace
}  // namespace beltrami
