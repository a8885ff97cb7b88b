// What is made of flat faces unfolds as it is, where that costs little.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "atlas/types.h"
#include "base/portable_math.h"
#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "cut/edge_marks.h"
#include "cut/seam_target.h"
#include "cut/unfold.h"
#include "mesh/surface.h"
#include "support/atlases.h"
#include "support/meshes.h"
#include "support/solids.h"
#include "support/surfaces.h"

namespace beltrami {
namespace {

using meshes::TriangleList;

/// A prism over a polygon that is seen whole from the origin.
TriangleList prism(const std::vector<Vec2>& polygon, double height) {
  TriangleList mesh;
  const Index n = size_of(polygon);
  for (const double z : {0.0, height}) {
    for (const Vec2& p : polygon) mesh.positions.emplace_back(p.x(), p.y(), z);
  }
  mesh.positions.emplace_back(0, 0, 0);
  mesh.positions.emplace_back(0, 0, height);
  for (Index i = 0; i < n; ++i) {
    const Index j = (i + 1) % n;
    mesh.faces.insert(mesh.faces.end(), {{i, j, n + j}, {i, n + j, n + i}});
    mesh.faces.insert(mesh.faces.end(), {{j, i, 2 * n}, {n + i, n + j, 2 * n + 1}});
  }
  return mesh;
}

std::vector<Vec2> star(int points) {
  std::vector<Vec2> polygon;
  for (int i = 0; i < 2 * points; ++i) {
    const double angle = std::numbers::pi * i / points, radius = i % 2 == 0 ? 1 : 0.4;
    polygon.emplace_back(radius * portable::cos(angle), radius * portable::sin(angle));
  }
  return polygon;
}

AtlasOptions searched(double flat_seams) {
  AtlasOptions options;
  options.target = SeamTarget{};
  options.target->flat_seams = flat_seams;
  return options;
}

TEST(Unfold, AThinGearIsTwoFacesAndAStrip) {
  // Along shorter seams its teeth take an energy of 2.14, and some of its maps do not converge.
  const TriangleList gear = prism(star(15), 0.002);
  const Atlas atlas = atlases::unwrapped(gear, searched(0));
  atlases::expect_sound(gear, atlas);
  EXPECT_EQ(atlas.charts.size(), 3U);
  EXPECT_LT(atlas.energy.symmetric_dirichlet, 2.0001);
}

TEST(Unfold, SeamsAreNoLongerThanAllowed) {
  const TriangleList wedge = prism({{1, -1}, {1, 0.2}, {0.3, 1}, {-1, 1}, {-1, -1}}, 1.3);
  const Atlas shortest = atlases::unwrapped(wedge, searched(0));
  double before = shortest.seam_over_root_area;
  for (const double factor : {1.5, 6.0}) {
    const Atlas atlas = atlases::unwrapped(wedge, searched(factor));
    atlases::expect_sound(wedge, atlas);
    EXPECT_LE(atlas.energy.symmetric_dirichlet, 2.05);
    EXPECT_GE(atlas.seam_over_root_area, before * (1 - 1e-12));
    EXPECT_LE(atlas.seam_over_root_area, factor * shortest.seam_over_root_area * (1 + 1e-12));
    before = atlas.seam_over_root_area;
  }
  EXPECT_LT(atlases::unwrapped(wedge, searched(6)).energy.symmetric_dirichlet, 2 + 1e-9);
}

TEST(Unfold, CopiesUnfoldAlike) {
  const TriangleList gear = prism(star(9), 0.01);
  const TriangleList two = meshes::together(
      {gear, meshes::moved(gear, [](const Vec3& p) { return Vec3(p.y(), p.z(), p.x() + 5); })});
  const Atlas atlas = atlases::unwrapped(two, searched(6));
  atlases::expect_sound(two, atlas);
  EXPECT_EQ(atlas.charts.size(), 6U);
  EXPECT_LT(atlas.energy.symmetric_dirichlet, 2 + 1e-9);
}

/// The corners of faces that all lie by themselves, as they are in space.
std::vector<std::array<Vec2, 3>> laid_flat(const Surface& surface) {
  std::vector<std::array<Vec2, 3>> corners;
  for (const auto& [a, b, c] : surface.faces) {
    const std::vector<Vec3>& p = surface.positions;
    const Vec3 x = (p[b] - p[a]).normalized(), side = p[c] - p[a];
    const Vec3 y = (side - x * x.dot(side)).normalized();
    corners.push_back({Vec2(0, 0), Vec2((p[b] - p[a]).norm(), 0), Vec2(x.dot(side), y.dot(side))});
  }
  return corners;
}

Index count_edges(const Surface& surface, const EdgeMarks& marks) {
  Index count = 0;
  for (Index h = 0; h < size_of(marks); ++h) count += marks[h] && surface.edge(h) == h ? 1 : 0;
  return count;
}

TEST(Unfold, ACubeIsACross) {
  const TriangleList cube = meshes::cube();
  const Surface surface = build_surface(cube.positions, cube.faces, Work(1));
  const EdgeMarks creases = creases_of(surface, {});
  EXPECT_EQ(count_edges(surface, creases), 12);
  // Every triangle apart: the diagonals are joined first, and five sides of the squares.
  const EdgeMarks all(surface.twin.size(), true);
  const EdgeMarks held(all.size(), false);
  const EdgeMarks seams = unfolded(surface, all, held, laid_flat(surface));
  EXPECT_EQ(count_edges(surface, seams), 7);
  const EdgeMarks none = unfolded(surface, all, all, laid_flat(surface));
  EXPECT_EQ(none, all) << "what is held stays";
}

TEST(Unfold, WhatIsCurvedHasNoCreases) {
  const TriangleList sphere = meshes::sphere(3);
  const Surface surface = build_surface(sphere.positions, sphere.faces, Work(1));
  EXPECT_TRUE(creases_of(surface, {}).empty());
}

TEST(Unfold, LockedEdgesAreNoCreases) {
  const TriangleList cube = meshes::cube();
  const Surface surface = build_surface(cube.positions, cube.faces, Work(1));
  const EdgeMarks all(surface.twin.size(), true);
  EXPECT_TRUE(creases_of(surface, all).empty());
}

}  // namespace
}  // namespace beltrami
