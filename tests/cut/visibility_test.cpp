// What is seen of a surface from outside.
#include "cut/visibility.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "base/portable_math.h"
#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "cut/surface_sketch.h"
#include "mesh/surface.h"
#include "support/meshes.h"
#include "support/solids.h"
#include "support/surfaces.h"

namespace beltrami {
namespace {

using meshes::TriangleList;

Surface surface_of(const TriangleList& mesh) {
  return build_surface(mesh.positions, mesh.faces, Work(1));
}

std::vector<double> seen_at_vertices(const TriangleList& mesh) {
  const Surface surface = surface_of(mesh);
  const SurfaceSketch few = sketch(surface, Work(1));
  return carry_to_vertices(few, surface, visibility(few, Work(1)), Work(1));
}

double least(const std::vector<double>& values) {
  return *std::min_element(values.begin(), values.end());
}

/// A wall of a box with a hole drilled into it: a sphere whose top is pushed deep inside.
TriangleList pot() {
  return meshes::moved(meshes::sphere(4), [](const Vec3& p) {
    const double across = std::sqrt(p.x() * p.x() + p.y() * p.y());
    const bool is_inside = p.z() > 0 && across < 0.6;
    return Vec3(p.x(), p.y(), is_inside ? p.z() - 1.2 * (1 - across / 0.6) : p.z());
  });
}

TEST(Visibility, IsWholeWhereASurfaceIsConvex) {
  for (const TriangleList& mesh :
       {meshes::tetrahedron(), meshes::cube(), meshes::sphere(4), meshes::sphere(6),
        meshes::moved(meshes::sphere(4),
                      [](const Vec3& p) { return Vec3(p.x(), p.y(), 9 * p.z()); }),
        meshes::grid(20, 20)}) {
    EXPECT_GT(least(seen_at_vertices(mesh)), 0.97);
  }
}

TEST(Visibility, IsLittleInsideAPitWhicheverWayFacesTurn) {
  TriangleList mesh = pot();
  for (int turned = 0; turned < 2; ++turned) {
    const std::vector<double> seen = seen_at_vertices(mesh);
    for (Index v = 0; v < size_of(seen); ++v) {
      const Vec3& p = mesh.positions[v];
      const double across = std::sqrt(p.x() * p.x() + p.y() * p.y());
      if (p.z() < 0.1 && p.z() > -0.3 && across < 0.1) {
        EXPECT_LT(seen[v], 0.5);
      } else if (p.z() < -0.5) {
        EXPECT_GT(seen[v], 0.97);
      }
    }
    for (Triangle& face : mesh.faces) std::swap(face[1], face[2]);
  }
}

TEST(Visibility, OfASheetIsThatOfItsBetterSide) {
  // A lid hides one side of the sheet below it.
  TriangleList sheets = meshes::together({meshes::grid(20, 20), meshes::grid(20, 20)});
  for (Index v = 21 * 21; v < 2 * 21 * 21; ++v) sheets.positions[v].z() = 0.1;
  EXPECT_GT(least(seen_at_vertices(sheets)), 0.97);
  // Between two lids it is dark, but at its rim.
  sheets = meshes::together({sheets, meshes::grid(20, 20)});
  for (Index v = 2 * 21 * 21; v < 3 * 21 * 21; ++v) sheets.positions[v].z() = -0.1;
  EXPECT_LT(seen_at_vertices(sheets)[10 * 21 + 10], 0.1);
}

/// The share that rays find, by directions of another kind.
double seen_by_rays(const Surface& surface, const SurfaceSketch& sketch, Index cluster) {
  const Vec3 normal = sketch.normals[cluster];
  const Vec3 from = sketch.positions[cluster] + 0.03 * normal;
  double seen = 0, all = 0;
  constexpr int kRings = 12;
  for (int ring = 0; ring < kRings; ++ring) {
    for (int k = 0; k < 2 * kRings; ++k) {
      const double z = 2 * (ring + 0.5) / kRings - 1, angle = std::numbers::pi * k / kRings;
      const double radius = std::sqrt(1 - z * z);
      const Vec3 ray(radius * portable::cos(angle), radius * portable::sin(angle), z);
      const double weight = ray.dot(normal);
      if (weight <= 0) continue;
      all += weight;
      const bool is_hit =
          std::any_of(surface.faces.begin(), surface.faces.end(), [&](const Triangle& face) {
            std::array<Vec3, 3> p;
            for (int i = 0; i < 3; ++i) p[i] = surface.positions[face[i]] - from;
            const double a = ray.dot(p[1].cross(p[2])), b = ray.dot(p[2].cross(p[0])),
                         c = ray.dot(p[0].cross(p[1]));
            const bool meets = (a > 0 && b > 0 && c > 0) || (a < 0 && b < 0 && c < 0);
            return meets && p[0].dot((p[1] - p[0]).cross(p[2] - p[0])) * (a + b + c) > 0;
          });
      if (!is_hit) seen += weight;
    }
  }
  return seen / all;
}

TEST(Visibility, IsWhatRaysFind) {
  for (const TriangleList& mesh : {meshes::torus(24), pot()}) {
    const Surface surface = surface_of(mesh);
    const SurfaceSketch own = sketch(surface, Work(1));
    const std::vector<double> seen = visibility(own, Work(1));
    double sum = 0;
    Index count = 0;
    for (Index c = 0; c < own.cluster_count(); c += 3, ++count) {
      const double difference = std::abs(seen[c] - seen_by_rays(surface, own, c));
      EXPECT_LT(difference, 0.2);
      sum += difference;
    }
    EXPECT_LT(sum / count, 0.05);
  }
}

TEST(Visibility, OfFewClustersIsThatOfAllVertices) {
  // The same torus, fine enough for clusters, and coarse.
  constexpr Index kFine = 160, kCoarse = 80;
  const Surface fine = surface_of(meshes::torus(kFine));
  const SurfaceSketch few = sketch(fine, Work(1));
  ASSERT_LT(few.cluster_count(), fine.vertex_count() / 2);
  const std::vector<double> seen = seen_at_vertices(meshes::torus(kFine));
  const std::vector<double> expected = seen_at_vertices(meshes::torus(kCoarse));
  double sum = 0;
  for (Index j = 0; j < kCoarse; ++j) {
    for (Index i = 0; i < kCoarse; ++i) {
      const double difference = std::abs(seen[2 * j * kFine + 2 * i] - expected[j * kCoarse + i]);
      EXPECT_LT(difference, 0.12);
      sum += difference;
    }
  }
  EXPECT_LT(sum / (kCoarse * kCoarse), 0.03);
}

TEST(Visibility, ClustersKeepTheSidesOfAThinSheetApart) {
  const TriangleList mesh = meshes::moved(
      meshes::sphere(6), [](const Vec3& p) { return Vec3(p.x(), p.y(), 0.01 * p.z()); });
  const Surface surface = surface_of(mesh);
  const SurfaceSketch few = sketch(surface, Work(1));
  ASSERT_LT(few.cluster_count(), surface.vertex_count());
  for (Index v = 0; v < surface.vertex_count(); ++v) {
    const Vec3& p = surface.positions[v];
    if (p.x() * p.x() + p.y() * p.y() > 0.9 || p.z() == 0) continue;
    EXPECT_GT(few.positions[few.cluster_of[v]].z() * p.z(), 0);
  }
}

}  // namespace
}  // namespace beltrami
