// Atlases, flattenings and packings: what they hand out fits together, and is what C hands out.
#include <beltrami/beltrami.h>
#include <gtest/gtest.h>
#include <beltrami/beltrami.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "cpp/meshes.h"

namespace beltrami::host {
namespace {

Surface view(const Triangles& mesh) {
  return Surface(mesh.positions, mesh.faces);
}
Surface view(const Polygons& mesh) {
  return Surface(mesh.positions, mesh.corners, mesh.sizes);
}

TEST(CppAtlas, HasTheUvsThatCHas) {
  const Polygons mesh = cube();
  Context context;
  const Atlas atlas = context.unwrap(view(mesh));
  std::vector<Uv> of_c(mesh.corners.size());
  ASSERT_EQ(beltrami_get_corner_uvs(context.c(), of_c.data(), BELTRAMI_F64, 0), BELTRAMI_OK);
  EXPECT_EQ(atlas.corner_uvs(), of_c);
  std::vector<Uv> written(mesh.corners.size());
  atlas.write_corner_uvs(span_of(written));
  EXPECT_EQ(written, of_c);
  EXPECT_EQ(atlas.status(), Status::kOk);
  EXPECT_TRUE(atlas.injective());
  EXPECT_TRUE(atlas.certificate().injective);
  EXPECT_TRUE(atlas.certificate<float>().injective);
}

TEST(CppAtlas, ItsIndexBufferLeadsToTheSameUvs) {
  const Polygons mesh = cube();
  const Atlas atlas = Context().unwrap(view(mesh));
  const auto uvs = atlas.corner_uvs<Uv32>(), split = atlas.uv_vertices<Uv32>();
  const auto index = atlas.corner_uv_vertices();
  const auto origin = atlas.uv_vertex_origins<std::uint64_t>();
  ASSERT_EQ(index.size(), mesh.corners.size());
  for (std::size_t i = 0; i < index.size(); ++i) {
    EXPECT_EQ(split[index[i]], uvs[i]);
    EXPECT_EQ(origin[index[i]], mesh.corners[i]);
  }
  std::vector<Uv32> written(split.size());
  atlas.write_uv_vertices(span_of(written));
  EXPECT_EQ(written, split);
  using Four = std::array<std::uint32_t, 4>;
  using Five = std::array<std::uint32_t, 5>;  // of which 24 corners are no multiple
  EXPECT_EQ(atlas.corner_uv_vertices<Four>().size(), 6u);
  EXPECT_EQ(atlas.try_corner_uv_vertices<Five>().status(), Status::kInvalidArgument);
}

TEST(CppAtlas, HasChartsSeamsTrianglesPagesAndStages) {
  const Triangles mesh = triangulated_cube();
  const Atlas atlas = Context().unwrap(view(mesh));
  const std::vector<Chart> charts = atlas.charts();
  ASSERT_EQ(charts.size(), atlas.info().charts);
  const auto face_charts = atlas.face_charts();
  ASSERT_EQ(face_charts.size(), mesh.faces.size());
  for (std::size_t k = 0; k < charts.size(); ++k) {
    EXPECT_EQ(face_charts[static_cast<std::size_t>(charts[k].first_face)], k);
    EXPECT_EQ(static_cast<std::uint64_t>(std::count(face_charts.begin(), face_charts.end(), k)),
              charts[k].triangles);
  }
  EXPECT_EQ(atlas.seams().size(), atlas.info().seams);
  EXPECT_GT(atlas.seams().size(), 0u);
  EXPECT_EQ(atlas.triangles().size(), mesh.faces.size());
  EXPECT_EQ(atlas.corner_pages(), std::vector<std::uint32_t>(36, 0));
  EXPECT_FALSE(atlas.stages().empty());
  EXPECT_NE(std::string(atlas.stages()[0].name), "");
}

TEST(CppAtlas, ItsSeamsMakeTheSameChartsAgain) {
  const Triangles mesh = triangulated_cube();
  Context context;
  const Atlas atlas = context.unwrap(view(mesh));
  const std::vector<SeamEdge> seams = atlas.seams();
  const auto charts = atlas.face_charts();
  context.set(option::kCut, Cut::kGiven);
  EXPECT_EQ(context.unwrap(view(mesh).seams(seams)).face_charts(), charts);
}

TEST(CppAtlas, HasItsPagesUntilSomethingElseIsPacked) {
  const Triangles mesh = triangulated_cube();
  Context context;
  const Atlas atlas = context.unwrap(view(mesh));
  const Packing pages = atlas.packing();
  EXPECT_EQ(pages.info().charts, atlas.info().charts);
  EXPECT_EQ(pages.page_utilisations().size(), 1u);
  EXPECT_EQ(pages.chart_pages(), std::vector<std::uint32_t>(pages.info().charts, 0));
  EXPECT_TRUE(pages.injective());
  EXPECT_TRUE(pages.certificate().injective);
  const std::size_t side = static_cast<std::size_t>(pages.info().resolution);
  const std::vector<std::uint8_t> mask = pages.page_mask(0);
  ASSERT_EQ(mask.size(), side * side);
  EXPECT_GT(std::count(mask.begin(), mask.end(), BELTRAMI_TEXEL_COVERED), 0);
  EXPECT_EQ(pages.try_page_mask(1).status(), Status::kInvalidArgument);
  EXPECT_EQ(pages.try_uvs().status(), Status::kInvalidArgument) << "no UV mesh was packed";

  const auto uvs = atlas.uv_vertices();
  const auto triangles = atlas.corner_uv_vertices<TriangleCorners>();
  context.pack(UvMesh(uvs, triangles));
  EXPECT_EQ(pages.try_chart_pages().status(), Status::kInvalidState);
  EXPECT_EQ(atlas.try_packing().status(), Status::kInvalidState);
  EXPECT_EQ(atlas.corner_uvs().size(), 36u);
}

TEST(CppAtlas, WithoutPagesHasNone) {
  const Triangles mesh = triangulated_cube(), quad = bent_quad();
  const std::vector<Uv> square{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  Context context;
  context.set(option::kPack, Pack::kNone);
  const Packing packed = context.pack(UvMesh(square, quad.faces));
  const Atlas loose = context.unwrap(view(mesh));
  EXPECT_EQ(loose.try_packing().status(), Status::kInvalidState);
  EXPECT_EQ(packed.chart_pages().size(), 1u) << "what was packed before is still there";

  context.set(option::kPack, Pack::kPages);
  const Packing pages = context.unwrap(view(mesh)).packing();
  EXPECT_EQ(pages.chart_pages().size(), pages.info().charts);
  context.set(option::kPack, Pack::kNone).unwrap(view(mesh));
  EXPECT_EQ(pages.try_chart_pages().status(), Status::kInvalidState);
}

TEST(CppSurface, WhatComesWithItReachesTheLibrary) {
  const Triangles mesh = triangulated_cube();
  Context context;
  context.set(option::kCut, Cut::kMinimal);
  const std::vector<std::uint32_t> labels{0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5};
  EXPECT_EQ(context.unwrap(view(mesh).face_labels(labels)).info().charts, 6u);

  const std::vector<double> densities{4, 4, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1};
  const Atlas dense = context.unwrap(view(mesh).face_labels(labels).densities(densities));
  EXPECT_EQ(dense.charts()[0].density, 4);
  EXPECT_EQ(dense.charts()[1].density, 1);

  Context pinned;
  pinned.set(option::kCut, Cut::kMinimal);
  const Triangles quad = bent_quad();
  const std::vector<std::int64_t> pins{0};
  const std::vector<Uv> places{{3, 4}};
  EXPECT_EQ(pinned.unwrap(view(quad).pins(pins, places)).corner_uvs()[0], (Uv{3, 4}));

  Context searching;
  const std::vector<SeamEdge> edges{{0, 1}};
  const std::vector<float> factors{0.5f}, of_vertices(8, 1.0f);
  EXPECT_EQ(
      searching
          .unwrap(view(mesh).edge_paint(edges, factors).vertex_paint(of_vertices).materials(labels))
          .status(),
      Status::kOk);
}

TEST(CppSurface, ArraysOfAnotherLengthAreRefused) {
  const Triangles mesh = triangulated_cube();
  const std::vector<std::uint32_t> numbers(11);
  const std::vector<double> factors(7);
  const std::vector<Uv> uvs(35);
  const std::vector<SeamEdge> edges(3);
  for (const Surface& surface :
       {view(mesh).face_labels(numbers), view(mesh).materials(numbers),
        view(mesh).densities(factors), view(mesh).vertex_paint(factors), view(mesh).corner_uvs(uvs),
        view(mesh).pins(numbers, uvs), view(mesh).edge_paint(edges, factors)}) {
    ASSERT_NE(surface.defect(), nullptr);
    const Result<Atlas> result = Context().try_unwrap(surface);
    ASSERT_FALSE(result);
    EXPECT_EQ(result.status(), Status::kInvalidArgument);
    EXPECT_STREQ(result.error().what(), surface.defect());
    EXPECT_EQ(try_check_atlas(surface).status(), Status::kInvalidArgument);
    EXPECT_EQ(try_triangulate(surface).status(), Status::kInvalidArgument);
  }
}

TEST(CppFlattening, HasAllThatCHas) {
  const Triangles mesh = hump(8);
  const Flattening flat = Context().flatten(view(mesh));
  EXPECT_EQ(flat.status(), Status::kOk);
  EXPECT_EQ(flat.info().faces, mesh.faces.size());
  EXPECT_EQ(flat.uvs().size(), mesh.positions.size());
  EXPECT_EQ(flat.triangles(), mesh.faces);
  EXPECT_TRUE(flat.injective());
  EXPECT_TRUE(flat.certificate().injective);
  EXPECT_TRUE(flat.certificate<float>().injective);
  const std::vector<double> energies = flat.face_energies();
  ASSERT_EQ(energies.size(), mesh.faces.size());
  EXPECT_EQ(*std::max_element(energies.begin(), energies.end()), flat.energy().max);
  EXPECT_FALSE(flat.stages().empty());
}

TEST(CppPacking, HasTheUvsOfEveryMesh) {
  const Triangles quad = bent_quad();
  const std::vector<Uv> square{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  const std::vector<Uv32> strip{{0, 0}, {4, 0}, {4, 1}, {0, 1}, {9, 9}};
  Context context;
  const Packing packing = context.pack({UvMesh(square, quad.faces), UvMesh(strip, quad.faces)});
  EXPECT_EQ(packing.status(), Status::kOk);
  EXPECT_EQ(packing.info().charts, 2u);
  EXPECT_EQ(packing.uvs(0).size(), 4u);
  EXPECT_EQ(packing.uvs<Uv32>(1).size(), 5u);
  EXPECT_EQ(packing.face_charts(0), (std::vector<std::uint32_t>{0, 0}));
  EXPECT_EQ(packing.face_charts<std::uint64_t>(1), (std::vector<std::uint64_t>{1, 1}));
  std::vector<float> written(10);
  packing.write_uvs(1, span_of(written));
  EXPECT_EQ(written, packing.uvs<float>(1));
  EXPECT_EQ(packing.try_uvs(2).status(), Status::kInvalidArgument);
  EXPECT_EQ(packing.try_face_charts(2).status(), Status::kInvalidArgument);

  // A chart that stays: its page is given, and -1 places the other anew.
  const std::vector<Uv> placed = packing.uvs(0), moved = packing.uvs(1);
  const std::vector<std::int32_t> stays{0, 0}, anew{-1, -1};
  const Packing again = context.pack(
      {UvMesh(placed, quad.faces).kept_pages(stays), UvMesh(moved, quad.faces).kept_pages(anew)});
  EXPECT_EQ(again.uvs(0), placed);

  const std::vector<std::uint32_t> last{7, 7}, first{2, 2};
  const Packing apart = context.pack(
      {UvMesh(placed, quad.faces).page_labels(last), UvMesh(moved, quad.faces).page_labels(first)});
  EXPECT_EQ(apart.chart_pages(), (std::vector<std::uint32_t>{1, 0}));
}

TEST(CppPacking, PositionsGiveEqualDensity) {
  const Triangles quad = bent_quad();
  const std::vector<Uv> uvs{{0, 0}, {9, 0}, {9, 9}, {0, 9}};
  Context context;
  const double density =
      context.pack(UvMesh(uvs, quad.faces).positions(quad.positions)).info().texels_per_unit;
  EXPECT_EQ(context.pack(UvMesh(uvs, quad.faces).positions(quad.positions, quad.faces))
                .info()
                .texels_per_unit,
            density);
  const std::vector<Position> three(3);
  EXPECT_EQ(context.try_pack(UvMesh(uvs, quad.faces).positions(three)).status(),
            Status::kInvalidArgument);
  const std::vector<Face> one(1);
  EXPECT_EQ(context.try_pack(UvMesh(uvs, quad.faces).positions(quad.positions, one)).status(),
            Status::kInvalidArgument);
  const std::vector<std::uint32_t> pages(1);
  EXPECT_EQ(context.try_pack(UvMesh(uvs, quad.faces).kept_pages(pages)).status(),
            Status::kInvalidArgument);
  EXPECT_EQ(context.try_pack(UvMesh(uvs, quad.faces).page_labels(pages)).status(),
            Status::kInvalidArgument);
}

TEST(CppPacking, OfWhatIsFoldedIsNotInjective) {
  const Triangles quad = bent_quad();
  const std::vector<Uv> folded{{0, 0}, {1, 0}, {1, 1}, {2, 0.5}};
  const Packing packing = Context().pack(UvMesh(folded, quad.faces));
  EXPECT_EQ(packing.status(), Status::kNotInjective);
  EXPECT_FALSE(packing.injective());
}

TEST(CppChecks, JudgeUvsFromAnywhere) {
  const Triangles quad = bent_quad();
  const std::vector<Uv> good{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  const std::vector<Uv32> folded{{0, 0}, {1, 0}, {1, 1}, {2, 0.5f}};
  EXPECT_TRUE(check_injective(quad.faces, good).injective);
  EXPECT_EQ(check_injective(quad.faces, folded).negative, 1u);
  EXPECT_EQ(check_triangles(quad.faces, folded).first_bad_face, 1u);
  EXPECT_EQ(check_boundary(quad.faces, good).boundary_crossings, 0u);
  const std::vector<Uv> three(3);
  const Result<Certificate> outside = try_check_injective(quad.faces, three);
  EXPECT_EQ(outside.status(), Status::kIndexOutOfRange);
  EXPECT_EQ(outside.error().element(), 1u);

  EXPECT_GE(measure(view(quad), good).symmetric_dirichlet, 2);
  const std::vector<FaceDistortion> faces = measure_faces(view(quad), good);
  ASSERT_EQ(faces.size(), 2u);
  EXPECT_GE(faces[0].s1, faces[0].s2);
  EXPECT_GE(faces[0].symmetric_dirichlet, 2);
  EXPECT_EQ(try_measure(view(quad), three).status(), Status::kInvalidArgument);
  EXPECT_EQ(try_measure_faces(view(quad), three).status(), Status::kInvalidArgument);
}

TEST(CppChecks, ListFacesThatOverlap) {
  const Triangles quad = bent_quad();
  const std::vector<Uv> apart{{0, 0}, {1, 0}, {1, 1}, {2, 0}, {3, 1}, {2, 1}};
  const AtlasCheck good = check_atlas(view(quad).corner_uvs(apart), 4);
  EXPECT_TRUE(good.injective());
  EXPECT_TRUE(good.pairs.empty());
  const std::vector<Uv> over{{0, 0}, {1, 0}, {1, 1}, {0.25, 0}, {1.25, 1}, {0.25, 1}};
  const AtlasCheck bad = check_atlas(view(quad).corner_uvs(over), 4);
  EXPECT_FALSE(bad.injective());
  EXPECT_EQ(bad.pairs, (std::vector<FacePair>{{0, 1}}));
  EXPECT_FALSE(check_atlas(view(quad).corner_uvs(over)).injective());
}

TEST(CppChecks, CutPolygonsAsUnwrapDoes) {
  const Polygons mesh = cube();
  EXPECT_EQ(triangulate(view(mesh)).size(), 12u);
  const Polygons none{mesh.positions, {0, 1}, {2}};
  EXPECT_EQ(try_triangulate(view(none)).status(), Status::kInvalidArgument);
}

}  // namespace
}  // namespace beltrami::host
