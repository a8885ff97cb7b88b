// Atlases that are asked for a distortion: certified, at that distortion, cut where it is said.
#include <gtest/gtest.h>

#include <map>
#include <utility>
#include <vector>

#include "atlas/atlas.h"
#include "atlas/types.h"
#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "cut/seam_costs.h"
#include "cut/seam_target.h"
#include "energy/energy.h"
#include "support/atlases.h"
#include "support/cuts.h"
#include "support/meshes.h"
#include "support/solids.h"
#include "support/surfaces.h"

namespace beltrami {
namespace {

using atlases::expect_same_bits;
using atlases::expect_sound;
using atlases::perforated;
using atlases::unwrapped;
using atlases::zoo;
using meshes::TriangleList;

AtlasOptions aiming_at(double energy) {
  AtlasOptions options;
  options.target = SeamTarget{.energy = energy};
  return options;
}

/// The length of edges whose ends are both in the list and that are seams of the atlas: whose two
/// sides have different UV vertices.
double seam_length_among(const TriangleList& mesh, const Atlas& atlas,
                         const std::vector<bool>& is_listed) {
  std::map<std::pair<Index, Index>, std::pair<Index, Index>> sides;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const int l = next_corner(k);
      sides[{mesh.faces[f][k], mesh.faces[f][l]}] = {atlas.faces[f][k], atlas.faces[f][l]};
    }
  }
  double sum = 0;
  for (const auto& [edge, uvs] : sides) {
    const auto [a, b] = edge;
    if (a > b || !is_listed[a] || !is_listed[b]) continue;
    const auto& [c, d] = sides.at({b, a});
    if (uvs != std::pair(d, c)) sum += (mesh.positions[a] - mesh.positions[b]).norm();
  }
  return sum;
}

TEST(UnwrapToATarget, MeetsIt) {
  for (const TriangleList& mesh :
       {meshes::sphere(4), meshes::torus(20), disks::refined(meshes::cube(), 3)}) {
    double shorter = 0;
    for (const double energy : {2.05, 2.01}) {
      const Atlas atlas = unwrapped(mesh, aiming_at(energy));
      expect_sound(mesh, atlas);
      EXPECT_LE(atlas.energy.symmetric_dirichlet, energy + 1e-4);
      EXPECT_EQ(atlas.charts.size(), 1);
      EXPECT_GE(atlas.seam_over_root_area, 0.99 * shorter);
      shorter = atlas.seam_over_root_area;
    }
  }
}

// The target is one of symmetric Dirichlet whatever the maps minimise.
TEST(UnwrapToATarget, MeetsItWithMapsOfAnotherEnergyToo) {
  for (const Energy energy : {Energy::kSymmetricArap, Energy::kExponentialDirichlet}) {
    for (const TriangleList& mesh : {meshes::torus(20), disks::refined(meshes::cube(), 3)}) {
      AtlasOptions options = aiming_at(2.05);
      options.chart.energy = energy;
      const Atlas atlas = unwrapped(mesh, options);
      expect_sound(mesh, atlas);
      EXPECT_LE(atlas.energy.symmetric_dirichlet, 2.05 + 1e-4) << static_cast<int>(energy);
    }
  }
}

TEST(UnwrapToATarget, AnythingIsUnwrapped) {
  const TriangleList mesh = zoo();
  for (const double energy : {2.02, 3.0, 100.0}) {
    const Atlas atlas = unwrapped(mesh, aiming_at(energy));
    expect_sound(mesh, atlas);
    EXPECT_LE(atlas.energy.symmetric_dirichlet, energy + 1e-4);
    EXPECT_EQ(atlas.admitted.components, 5);
  }
}

// Each component has a search of its own where bounds on the whole do not bind: a search over all
// at once missed the length that the others keep to.
TEST(UnwrapToATarget, BoundsThatDoNotBindChangeNothing) {
  const TriangleList mesh = zoo();
  const Atlas free = unwrapped(mesh, aiming_at(2.05));
  AtlasOptions bounded = aiming_at(2.05);
  bounded.target->seam_budget = free.seam_over_root_area * (1 + 1e-9);
  bounded.target->max_charts = size_of(free.charts);
  expect_same_bits(free, unwrapped(mesh, bounded));
  bounded.target->seam_budget = 0.9 * free.seam_over_root_area;
  const Atlas shorter = unwrapped(mesh, bounded);
  expect_sound(mesh, shorter);
  EXPECT_LE(shorter.seam_over_root_area, free.seam_over_root_area);
}

TEST(UnwrapToATarget, LargeSurfacesHandTheirLevelsDown) {
  const TriangleList mesh = meshes::torus(210);
  const Atlas one = unwrapped(mesh, aiming_at(2.05)), two = unwrapped(mesh, aiming_at(2.05), 2);
  expect_sound(mesh, one);
  expect_same_bits(one, two);
  EXPECT_LE(one.energy.symmetric_dirichlet, 2.06);
}

TEST(UnwrapToATarget, ATetrahedronIsOpenedForAnyEnergy) {
  const TriangleList mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
  for (const double energy : {2.0001, 2.5, 10.0, 1000.0}) {
    expect_sound(mesh, unwrapped(mesh, aiming_at(energy)));
  }
}

// The search follows edges, of which none ends inside these: walls of a house and of a rail,
// folded.
TEST(UnwrapToATarget, AFewLongTrianglesMeetItInParts) {
  const TriangleList wall{{{0, 1.5284, 0},
                           {0, 1.5209, .0069},
                           {0, 0, 0},
                           {0, .0075, .0069},
                           {0, .0075, 1.3274},
                           {-.0069, .0075, .0069},
                           {-.0104, 1.5209, .0069},
                           {-.0104, .0075, .0069},
                           {-.0035, .0075, .0069},
                           {-.0035, .0075, 1.3274},
                           {-.0069, .0075, 1.3274},
                           {-.0104, .0075, 1.3274}},
                          {{0, 1, 2},
                           {2, 1, 3},
                           {2, 3, 4},
                           {5, 6, 7},
                           {3, 8, 9},
                           {3, 9, 4},
                           {9, 8, 5},
                           {9, 5, 10},
                           {10, 5, 7},
                           {10, 7, 11}}};
  const TriangleList rail{
      {{0, .02, 0},
       {-.0359, .0141, .6032},
       {0, .02, .5532},
       {1.0897, 0, 0},
       {0, 0, 0},
       {0, 0, .5532},
       {1.0897, .02, .5532},
       {-.0359, .0141, -.05}},
      {{0, 1, 2}, {3, 0, 4}, {4, 2, 5}, {6, 2, 1}, {0, 7, 1}, {5, 2, 6}, {4, 0, 2}}};
  for (const TriangleList& mesh : {wall, rail}) {
    const Atlas atlas = unwrapped(mesh, aiming_at(2.05));
    atlases::expect_sound(mesh, atlas);
    EXPECT_LE(atlas.energy.symmetric_dirichlet, 2.05 + 1e-6);
  }
}

TEST(UnwrapToATarget, GivenCutsStayCut) {
  const TriangleList mesh = disks::refined(meshes::cube(), 2);
  AtlasInput input{mesh.positions, mesh.faces};
  input.cuts.hard_angle = 1;
  const Atlas sides = unwrap(input, aiming_at(2.05), Work(1));
  expect_sound(mesh, sides);
  EXPECT_EQ(sides.charts.size(), 6);
  EXPECT_NEAR(sides.seam_length, 12, 1e-9);
  input.cuts = {};
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) input.cuts.labels.push_back(f < 32 ? 1 : 0);
  const Atlas two = unwrap(input, aiming_at(2.05), Work(1));
  expect_sound(mesh, two);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    EXPECT_NE(two.chart_of_face[f], two.chart_of_face[f < 32 ? 32 : 0]);
  }
}

TEST(UnwrapToATarget, HolesCostNoSeamAndPolygonsStayWhole) {
  const TriangleList holes = perforated();
  const Atlas atlas = unwrapped(holes, aiming_at(2.05));
  expect_sound(holes, atlas);
  EXPECT_EQ(atlas.filled_holes, 2) << "the longest stays";
  EXPECT_LE(atlas.energy.symmetric_dirichlet, 2.05 + 1e-4);
  const TriangleList mesh = meshes::torus(10);
  std::vector<Index> polygons;
  for (Index f = 0; f < size_of(mesh.faces); ++f) polygons.push_back(f / 2);
  AtlasOptions options = aiming_at(2.05);
  options.admit.polygons.polygon = polygons;
  const Atlas quads = unwrapped(mesh, options);
  expect_sound(mesh, quads);
  for (std::size_t f = 0; f < mesh.faces.size(); f += 2) {
    // The diagonal runs from the first corner to the third.
    EXPECT_EQ(quads.faces[f][0], quads.faces[f + 1][0]);
    EXPECT_EQ(quads.faces[f][2], quads.faces[f + 1][1]);
  }
}

TEST(UnwrapToATarget, PaintKeepsSeamsAway) {
  // From where they are by far the most without.
  const TriangleList mesh = meshes::sphere(3);
  const Atlas usual = unwrapped(mesh, aiming_at(2.1));
  const std::vector<bool> all(mesh.positions.size(), true);
  EXPECT_NEAR(seam_length_among(mesh, usual, all), usual.seam_length, 1e-9);
  std::vector<bool> half, other;
  for (const Vec3& p : mesh.positions) {
    half.push_back(p.dot(Vec3(1, 2, 3)) > 0.1);
    other.push_back(p.dot(Vec3(1, 2, 3)) < -0.1);
  }
  if (seam_length_among(mesh, usual, half) < seam_length_among(mesh, usual, other)) half = other;
  AtlasInput input{mesh.positions, mesh.faces};
  for (const bool is_dear : half) input.hints.vertex_paint.push_back(is_dear ? kMostPaint : 1);
  const Atlas painted = unwrap(input, aiming_at(2.1), Work(1));
  expect_sound(mesh, painted);
  EXPECT_LT(seam_length_among(mesh, painted, half), 0.5 * seam_length_among(mesh, usual, half));
}

TEST(UnwrapToATarget, PaintDrawsSeams) {
  // A ring around a torus, by vertices or by edges, where no seam would be without.
  const Index n = 16, at = 3;
  const TriangleList mesh = meshes::torus(n);
  const Atlas usual = unwrapped(mesh, aiming_at(2.5));
  for (const bool is_across : {false, true}) {
    std::vector<bool> ring;
    for (Index v = 0; v < n * n; ++v) ring.push_back((is_across ? v % n : v / n) == at);
    AtlasInput input{mesh.positions, mesh.faces};
    for (const bool is_there : ring) input.hints.vertex_paint.push_back(is_there ? kLeastPaint : 1);
    const Atlas by_vertices = unwrap(input, aiming_at(2.5), Work(1));
    input.hints = {};
    for (const auto& [a, b, c] : mesh.faces) {
      for (const auto& [from, to] : {std::pair(a, b), {b, c}, {c, a}}) {
        if (ring[from] && ring[to]) input.hints.edge_paint.push_back({{to, from}, kLeastPaint});
      }
    }
    const Atlas by_edges = unwrap(input, aiming_at(2.5), Work(1));
    EXPECT_LT(seam_length_among(mesh, usual, ring), 1);
    for (const Atlas& painted : {by_vertices, by_edges}) {
      expect_sound(mesh, painted);
      EXPECT_GT(seam_length_among(mesh, painted, ring), 5);
    }
  }
}

TEST(UnwrapToATarget, TheSameBitsAtOneThreadAndAtTwoAndInAnyUnit) {
  const TriangleList mesh = meshes::together({disks::blob(3), meshes::torus(9)});
  const AtlasOptions options = aiming_at(2.05);
  const Atlas one = unwrapped(mesh, options);
  expect_same_bits(one, unwrapped(mesh, options, 2));
  TriangleList large = mesh;
  for (Vec3& p : large.positions) p *= 0x1p20;
  Atlas scaled = unwrapped(large, options);
  for (Vec2& w : scaled.uvs) w *= 0x1p-20;
  expect_same_bits(one, scaled);
}

}  // namespace
}  // namespace beltrami
