// Footpoints of a fine disk on a coarse one, and derivatives carried between them.
#include "prolong/interpolation.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "base/lanes.h"
#include "base/vectors.h"
#include "mesh/rest_shape.h"
#include "prolong/derivative.h"
#include "simplify/coarse.h"
#include "simplify/simplify.h"
#include "support/disks.h"
#include "support/meshes.h"

namespace beltrami {
namespace {

struct Levels {
  DiskMesh fine;
  CoarseDisk coarse;
  std::vector<Footpoint> points;
};

Levels levels(meshes::TriangleList mesh, Index target) {
  Levels made{.fine = disks::disk(std::move(mesh)), .coarse = {}, .points = {}};
  made.coarse = simplify(made.fine, target, Work(1));
  made.points =
      footpoints(made.coarse.mesh, made.coarse.fine_vertex, made.coarse.nearby, made.fine, Work(1));
  return made;
}

/// z + k conj(z), turned.
LinearMap turned_map(double angle, double k) {
  const Complex turn(std::cos(angle), std::sin(angle));
  return {turn, k * turn};
}

std::vector<Vec2> mapped(const DiskMesh& mesh, const LinearMap& map) {
  std::vector<Vec2> uvs;
  for (const Vec3& p : mesh.positions) {
    const Complex z(p.x(), p.y()), w = map.fz * z + map.fzbar * std::conj(z);
    uvs.emplace_back(w.real(), w.imag());
  }
  return uvs;
}

TEST(Footpoints, AreConvexAndCoarseVerticesAreTheirOwn) {
  const Levels made = levels(meshes::bumps(24, 24), 150);
  for (const Footpoint& at : made.points) {
    EXPECT_GE(at.shares[0], 0);
    EXPECT_GE(at.shares[1], 0);
    EXPECT_GE(at.first_share(), -1e-6);
  }
  for (Index c = 0; c < made.coarse.mesh.vertex_count(); ++c) {
    EXPECT_EQ(made.points[made.coarse.fine_vertex[c]].corners(made.coarse.mesh.faces)[0], c);
    EXPECT_EQ(made.points[made.coarse.fine_vertex[c]].shares, (std::array<float, 2>{}));
  }
}

TEST(Footpoints, OnAFlatDiskReproduceWhatIsLinear) {
  const Levels made = levels(meshes::grid(20, 20), 120);
  const LinearMap map = turned_map(0.7, 0.3);
  const std::vector<Vec2> coarse = mapped(made.coarse.mesh, map), fine = mapped(made.fine, map);
  for (Index v = 0; v < made.fine.vertex_count(); ++v) {
    EXPECT_LE((interpolated(made.points[v], made.coarse.mesh.faces, coarse) - fine[v]).norm(), 1e-5)
        << v;
  }
}

TEST(Footpoints, OfTheBoundaryLieOnTheCoarseBoundary) {
  const Levels made = levels(meshes::bumps(24, 24), 150);
  for (const Index v : made.fine.boundary) {
    for (int k = 0; k < 2; ++k) {
      const Index corner = made.points[v].corners(made.coarse.mesh.faces)[k];
      EXPECT_TRUE(made.coarse.mesh.on_boundary[corner]) << v;
    }
    EXPECT_EQ(made.points[v].shares[1], 0);
  }
}

/// Of one face, in the last lane.
LinearMap carried_map(const DiskMesh& mesh, Index f, const std::vector<RestTriangle>& rest,
                      const std::vector<VertexDerivative>& derivatives) {
  std::array<Index, kLanes> faces{};
  faces.back() = f;
  const CarriedMaps maps = carried_maps(mesh, faces, rest, derivatives);
  const int lane = kLanes - 1;
  return {{maps.fz.real[lane], maps.fz.imag[lane]}, {maps.fzbar.real[lane], maps.fzbar.imag[lane]}};
}

TEST(Derivative, OfALinearMapOfThePlaneIsItselfOnEveryFineFace) {
  const Levels made = levels(meshes::grid(20, 20), 120);
  const LinearMap map = turned_map(1.1, 0.4);
  const std::vector<Vec2> uvs = mapped(made.coarse.mesh, map);
  const auto derivatives =
      carried(vertex_derivatives(made.coarse.mesh, disks::rest_of(made.coarse.mesh), uvs, Work(1)),
              made.coarse.mesh.faces, made.points, Work(1));
  const std::vector<RestTriangle> rest = disks::rest_of(made.fine);
  const std::vector<Vec2> fine = mapped(made.fine, map);
  for (Index f = 0; f < made.fine.face_count(); ++f) {
    const Triangle& t = made.fine.faces[f];
    const LinearMap expected = linear_map(rest[f], fine[t[0]], fine[t[1]], fine[t[2]]);
    const LinearMap actual = carried_map(made.fine, f, rest, derivatives);
    EXPECT_LE(std::abs(actual.fz - expected.fz), 1e-5) << f;
    EXPECT_LE(std::abs(actual.fzbar - expected.fzbar), 1e-5) << f;
  }
}

TEST(Derivative, OfAFaceKeepsItsOrientationAndTheMeanAreaFactor) {
  // Gradients that cancel: the map turns by half a turn from one corner to the next.
  const DiskMesh mesh = disks::disk(meshes::fan(3));
  const std::vector<RestTriangle> rest = disks::rest_of(mesh);
  std::vector<VertexDerivative> derivatives(mesh.positions.size(), VertexDerivative::Zero());
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    const float sign = v % 2 == 0 ? 1.0F : -0.9F;
    derivatives[v][0] = sign;
    derivatives[v][4] = sign;
    derivatives[v][8] = 1;
    derivatives[v][9] = std::sqrt(2.0F);
  }
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const LinearMap map = carried_map(mesh, f, rest, derivatives);
    EXPECT_NEAR(std::norm(map.fz) - std::norm(map.fzbar), 2, 1e-5) << f;
  }
}

}  // namespace
}  // namespace beltrami
