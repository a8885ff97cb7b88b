// Meshes as atlases, and what every atlas is to be.
#pragma once

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "atlas/atlas.h"
#include "atlas/types.h"
#include "base/types.h"
#include "base/work.h"
#include "chart/flattening.h"
#include "exact/atlas_certificate.h"
#include "mesh/disk_mesh.h"
#include "support/cuts.h"
#include "support/meshes.h"
#include "support/surfaces.h"

namespace beltrami::atlases {

inline Atlas unwrapped(const meshes::TriangleList& mesh, const AtlasOptions& options = {},
                       int threads = 1) {
  return unwrap({mesh.positions, mesh.faces}, options, Work(threads));
}

inline double area_in_space(const meshes::TriangleList& mesh) {
  double area = 0;
  for (const auto& [a, b, c] : mesh.faces) {
    area += triangle_area(mesh.positions[a], mesh.positions[b], mesh.positions[c]);
  }
  return area;
}

/// Every corner has a UV vertex of its place, every face a chart or none, and the very numbers
/// delivered are injective.
inline void expect_sound(const meshes::TriangleList& mesh, const Atlas& atlas) {
  EXPECT_EQ(atlas.outcome, Outcome::kOk);
  EXPECT_TRUE(atlas.certificate.injective());
  EXPECT_EQ(atlas.certificate.touching_places, 0);
  EXPECT_TRUE(atlas.single_certificate.injective());
  ASSERT_EQ(atlas.faces.size(), mesh.faces.size());
  AtlasRules rules;
  std::vector<Triangle> oriented = atlas.faces;
  std::vector<Index> in_chart(atlas.charts.size(), 0);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const Index uv = atlas.faces[f][k];
      ASSERT_TRUE(uv >= 0 && uv < size_of(atlas.uvs));
      EXPECT_EQ(mesh.positions[atlas.input_vertex[uv]], mesh.positions[mesh.faces[f][k]]);
      EXPECT_TRUE(atlas.uvs[uv].allFinite());
    }
    if (atlas.reversed[f]) std::swap(oriented[f][1], oriented[f][2]);
    const Index chart = atlas.chart_of_face[f];
    rules.excepted.push_back(chart == kNone);
    if (chart != kNone) ++in_chart[chart];
  }
  EXPECT_TRUE(certify_atlas(oriented, atlas.uvs, rules, Work(1)).injective());
  for (std::size_t c = 0; c < atlas.charts.size(); ++c) {
    EXPECT_EQ(atlas.charts[c].faces, in_chart[c]);
    EXPECT_EQ(atlas.charts[c].outcome, Outcome::kOk);
  }
  EXPECT_NEAR(atlas.area, area_in_space(mesh), 1e-9 * atlas.area);
  EXPECT_GE(atlas.energy.symmetric_dirichlet, 2 - 1e-9);
  EXPECT_LE(atlas.energy.symmetric_dirichlet, atlas.energy.max);
  EXPECT_LE(atlas.energy.p99, atlas.energy.max);
}

inline void expect_same_bits(const Atlas& a, const Atlas& b) {
  EXPECT_EQ(a.uvs, b.uvs);
  EXPECT_EQ(a.faces, b.faces);
  EXPECT_EQ(a.input_vertex, b.input_vertex);
  EXPECT_EQ(a.chart_of_face, b.chart_of_face);
  EXPECT_EQ(a.energy.symmetric_dirichlet, b.energy.symmetric_dirichlet);
  EXPECT_EQ(a.energy.p99, b.energy.p99);
  EXPECT_EQ(a.seam_over_root_area, b.seam_over_root_area);
}

/// A bit of everything: closed, with handles, one-sided, a disk, single triangles.
inline meshes::TriangleList zoo() {
  meshes::TriangleList mesh =
      meshes::together({disks::blob(2), meshes::torus(6), meshes::moebius(8), meshes::grid(4, 3),
                        meshes::soup(meshes::octahedron())});
  // Each part in a place of its own, so that nothing is welded across.
  Index next = 0;
  for (const Index parts : {size_of(disks::blob(2).positions), Index{36}, Index{16}}) {
    for (Index v = 0; v < parts; ++v) mesh.positions[next + v].z() += 10 + next;
    next += parts;
  }
  return mesh;
}

/// A sphere of octahedra split often, with a few small holes.
inline meshes::TriangleList perforated() {
  meshes::TriangleList mesh = disks::blob(4);
  for (const Index f : {900, 500, 100}) mesh.faces.erase(mesh.faces.begin() + f);
  return mesh;
}

}  // namespace beltrami::atlases
