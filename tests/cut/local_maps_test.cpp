// The maps that judge seams.
#include "cut/local_maps.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cmath>
#include <utility>
#include <vector>

#include "cut/open_minimal.h"
#include "cut/seam_costs.h"
#include "cut/seam_tree.h"
#include "exact/crossings.h"
#include "mesh/chart.h"
#include "mesh/disk_mesh.h"
#include "multilevel/options.h"
#include "support/cuts.h"
#include "support/disks.h"
#include "support/meshes.h"
#include "support/surfaces.h"

namespace beltrami {
namespace {

using meshes::TriangleList;

constexpr double kTolerance = 1e-4;
constexpr double kAnyLength = 0;
constexpr double kLeastCost = 0.02;

Surface built(const TriangleList& mesh) {
  return build_surface(mesh.positions, mesh.faces, Work(1));
}

EdgeMarks opened(const Surface& surface) {
  return open_minimal(surface, topology_of(surface, Work(1)), {}, Work(1));
}

/// Short seams, and some more, by which the model's excess over 2 falls to a fourth.
std::pair<EdgeMarks, EdgeMarks> growing_seams(const Surface& surface) {
  const std::vector<double> cost = edge_lengths(surface, Work(1));
  SeamTree search(surface, surface.face_count(), cost, opened(surface), kAnyLength, kLeastCost,
                  Work(1));
  const EdgeMarks few = search.seams();
  search.extend(2 + 0.25 * (search.energy() - 2));
  return {few, search.seams()};
}

std::vector<TriangleList> surfaces() {
  return {disks::blob(3), meshes::torus(12), meshes::bumps(10, 10),
          meshes::together({disks::blob(2), meshes::torus(8), meshes::grid(4, 4)})};
}

double area_of(const Surface& surface, Index f) {
  const auto [a, b, c] = surface.faces[f];
  return triangle_area(surface.positions[a], surface.positions[b], surface.positions[c]);
}

/// Folded faces and energies that are no mean are not to be.
void expect_sound(const Surface& surface, const LocalMaps& maps) {
  double sum = 0, whole = 0;
  for (Index f = 0; f < surface.face_count(); ++f) {
    EXPECT_GE(maps.energies[f], 2 - 1e-9);
    sum += maps.energies[f] * area_of(surface, f);
    whole += area_of(surface, f);
  }
  EXPECT_NEAR(maps.energy, sum / whole, 1e-9 * maps.energy);
  ASSERT_EQ(maps.uvs.size(), maps.cut.charts.size());
  for (std::size_t c = 0; c < maps.uvs.size(); ++c) {
    const DiskMesh& mesh = maps.cut.charts[c].mesh;
    ASSERT_EQ(maps.uvs[c].size(), mesh.positions.size());
    for (const auto& [i, j, k] : mesh.faces) {
      const Vec2 p = maps.uvs[c][j] - maps.uvs[c][i], q = maps.uvs[c][k] - maps.uvs[c][i];
      EXPECT_GT(p.x() * q.y() - p.y() * q.x(), 0);
    }
  }
}

LocalMaps mapped(const Surface& surface, const EdgeMarks& seams, const LocalMaps* before = nullptr,
                 int threads = 1) {
  KnownMaps known;
  return map_locally(surface, surface.face_count(), seams, kTolerance, before, known,
                     Work(threads));
}

TEST(LocalMaps, AreNotFoldedAndJudgedFaceByFace) {
  for (const TriangleList& mesh : surfaces()) {
    const Surface surface = built(mesh);
    expect_sound(surface, mapped(surface, opened(surface)));
  }
}

TEST(LocalMaps, WhatIsDevelopableIsNotDistortedThoughItLiesOnItself) {
  // More than a turn of a flat band.
  TriangleList mesh = disks::winding(60, 3, 0.3, 1.3);
  for (Vec3& p : mesh.positions) p.z() = 0;
  for (const TriangleList& flat : {mesh, meshes::grid(5, 4)}) {
    const Surface surface = built(flat);
    const LocalMaps maps = mapped(surface, EdgeMarks(surface.twin.size(), false));
    expect_sound(surface, maps);
    EXPECT_NEAR(maps.energy, 2, 10 * kTolerance);
  }
}

TEST(LocalMaps, ContactKeepsThemOffThemselvesAtACost) {
  const Surface surface = built(disks::winding(60, 3, 0.3, 1.3));
  const LocalMaps maps = mapped(surface, EdgeMarks(surface.twin.size(), false));
  const auto is_injective = [](const LocalMaps& of) {
    return is_simple(of.cut.charts[0].mesh.boundary, of.uvs[0]);
  };
  ASSERT_FALSE(is_injective(maps));
  KnownMaps known;
  const LocalMaps apart =
      with_contact(maps, surface.face_count(), kTolerance, nullptr, known, Work(1));
  EXPECT_TRUE(is_injective(apart));
  EXPECT_GT(apart.energy, maps.energy);
  expect_sound(surface, apart);
  // What lies on itself nowhere stays to the bit.
  const Surface grid = built(meshes::grid(5, 4));
  const LocalMaps flat = mapped(grid, EdgeMarks(grid.twin.size(), false));
  KnownMaps of_grid;
  EXPECT_EQ(with_contact(flat, grid.face_count(), kTolerance, nullptr, of_grid, Work(1)).uvs,
            flat.uvs);
}

TEST(LocalMaps, ChartsThatStayKeepTheirMaps) {
  const TriangleList mesh = meshes::together({disks::blob(2), meshes::torus(8)});
  const Surface surface = built(mesh);
  const EdgeMarks few = opened(surface);
  const LocalMaps before = mapped(surface, few);
  EXPECT_EQ(mapped(surface, few, &before).uvs, before.uvs);
  // One edge more, at the end of a seam of the torus.
  EdgeMarks more = few;
  const Index blob = size_of(disks::blob(2).faces);
  for (Index h = 3 * blob; h < size_of(more); ++h) {
    if (few[h]) continue;
    int at_origin = 0, at_target = 0;
    surface.for_each_outgoing(surface.origin(h), [&](Index g) { at_origin += few[g] ? 1 : 0; });
    surface.for_each_outgoing(surface.target(h), [&](Index g) { at_target += few[g] ? 1 : 0; });
    if (at_origin == 0 || at_target > 0) continue;
    mark_edge(surface, h, more);
    break;
  }
  ASSERT_NE(more, few);
  const LocalMaps after = mapped(surface, more, &before);
  ASSERT_EQ(after.uvs.size(), 2u);
  EXPECT_EQ(after.uvs[0], before.uvs[0]);
  EXPECT_NE(after.uvs[1].size(), before.uvs[1].size());
  EXPECT_LE(after.energy, before.energy);
}

TEST(LocalMaps, AreKnownOnceTheyAreMade) {
  for (const TriangleList& mesh : surfaces()) {
    const Surface surface = built(mesh);
    const EdgeMarks seams = opened(surface);
    KnownMaps known;
    const auto map = [&] {
      return map_locally(surface, surface.face_count(), seams, kTolerance, nullptr, known, Work(1));
    };
    const LocalMaps first = map();
    const MapSetting setting{Injectivity::kLocal, kTolerance};
    const MapSetting other{Injectivity::kGlobal, kTolerance};
    for (std::size_t c = 0; c < first.uvs.size(); ++c) {
      EXPECT_EQ(known.find(first.cut.charts[c], setting), first.uvs[c]);
      EXPECT_FALSE(known.find(first.cut.charts[c], other));
      Chart turned = first.cut.charts[c];
      std::swap(turned.mesh.faces[0][0], turned.mesh.faces[0][1]);
      EXPECT_FALSE(known.find(turned, setting));
    }
    EXPECT_EQ(map().uvs, first.uvs);
    EXPECT_EQ(mapped(surface, seams).uvs, first.uvs);
  }
}

TEST(LocalMaps, MoreSeamsDistortLess) {
  for (const TriangleList& mesh : {disks::blob(3), meshes::torus(12), meshes::bumps(10, 10)}) {
    const Surface surface = built(mesh);
    const auto [few, more] = growing_seams(surface);
    const LocalMaps before = mapped(surface, few), after = mapped(surface, more);
    EXPECT_LT(after.energy - 2, 0.8 * (before.energy - 2));
  }
}

TEST(LocalMaps, StartFromThoseBeforeAndComeToTheSame) {
  for (const TriangleList& mesh : surfaces()) {
    const Surface surface = built(mesh);
    const auto [few, more] = growing_seams(surface);
    const LocalMaps before = mapped(surface, few);
    const LocalMaps warm = mapped(surface, more, &before), cold = mapped(surface, more);
    expect_sound(surface, warm);
    EXPECT_NEAR(warm.energy, cold.energy, 0.02 * (cold.energy - 2) + 1e-9);
    // Seams that were taken away: what was apart cannot be where it was.
    const LocalMaps back = mapped(surface, few, &warm);
    expect_sound(surface, back);
    EXPECT_NEAR(back.energy, before.energy, 0.02 * (before.energy - 2) + 1e-9);
  }
}

TEST(LocalMaps, VirtualFacesWeighNothing) {
  const Surface surface = built(meshes::bumps(8, 8));
  const EdgeMarks none(surface.twin.size(), false);
  const Index real_faces = 70;
  const LocalMaps all = mapped(surface, none);
  KnownMaps known;
  const LocalMaps some =
      map_locally(surface, real_faces, none, kTolerance, nullptr, known, Work(1));
  EXPECT_EQ(some.uvs, all.uvs);
  double sum = 0, whole = 0;
  for (Index f = 0; f < surface.face_count(); ++f) {
    EXPECT_EQ(std::isnan(some.energies[f]), f >= real_faces);
    if (f >= real_faces) continue;
    EXPECT_EQ(some.energies[f], all.energies[f]);
    sum += some.energies[f] * area_of(surface, f);
    whole += area_of(surface, f);
  }
  EXPECT_NEAR(some.energy, sum / whole, 1e-9);
}

TEST(LocalMaps, FacesWithoutAreaAreLeftOut) {
  const Surface surface = built(disks::degenerate_faces(8));
  const LocalMaps maps = mapped(surface, EdgeMarks(surface.twin.size(), false));
  EXPECT_TRUE(std::isfinite(maps.energy));
  Index without_area = 0;
  for (Index f = 0; f < surface.face_count(); ++f) {
    if (area_of(surface, f) == 0) {
      EXPECT_TRUE(std::isnan(maps.energies[f]));
      ++without_area;
    }
  }
  EXPECT_GT(without_area, 0);
}

TEST(LocalMaps, AreAsLargeAsTheSurface) {
  for (const double scale : {0x1p-40, 1.0, 0x1p40}) {
    TriangleList mesh = disks::blob(3);
    for (Vec3& p : mesh.positions) p *= scale;
    const Surface surface = built(mesh);
    const LocalMaps maps = mapped(surface, opened(surface));
    expect_sound(surface, maps);
    Eigen::AlignedBox2d box;
    for (const Vec2& w : maps.uvs[0]) box.extend(w / scale);
    EXPECT_GT(box.sizes().maxCoeff(), 2);
    EXPECT_LT(box.sizes().maxCoeff(), 20);
  }
}

TEST(LocalMaps, TheSameBitsAtOneThreadAndAtTwo) {
  const Surface surface = built(surfaces().back());
  const EdgeMarks seams = opened(surface);
  const LocalMaps one = mapped(surface, seams), two = mapped(surface, seams, nullptr, 2);
  EXPECT_EQ(one.uvs, two.uvs);
  EXPECT_EQ(one.energy, two.energy);
  EXPECT_EQ(mapped(surface, seams, &one).uvs, mapped(surface, seams, &two, 2).uvs);
}

}  // namespace
}  // namespace beltrami
