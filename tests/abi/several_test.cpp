// Several surfaces in one atlas, and integers of 16 bits.
#include <beltrami/beltrami.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "abi/host.h"
#include "base/types.h"
#include "support/meshes.h"
#include "support/surfaces.h"

namespace beltrami::host {
namespace {

using meshes::TriangleList;

beltrami_status unwrap(const Context& context, const std::vector<beltrami_surface>& surfaces) {
  std::vector<const beltrami_surface*> pointers;
  for (const beltrami_surface& surface : surfaces) pointers.push_back(&surface);
  return beltrami_unwrap_surfaces(context.get(), pointers.data(), pointers.size(), nullptr,
                                  nullptr);
}

beltrami_atlas atlas_of(const Context& context) {
  auto atlas = sized<beltrami_atlas>();
  EXPECT_EQ(beltrami_get_atlas(context.get(), &atlas), BELTRAMI_OK) << message(context);
  return atlas;
}

std::vector<double> corner_uvs(const Context& context) {
  std::vector<double> uvs(2 * atlas_of(context).corners);
  EXPECT_EQ(beltrami_get_corner_uvs(context.get(), uvs.data(), BELTRAMI_F64, 0), BELTRAMI_OK);
  return uvs;
}

template <class Integer>
std::vector<Integer> integers(const Context& context, std::size_t count, std::int32_t type,
                              beltrami_status (*get)(beltrami_context*, void*, std::int32_t,
                                                     std::uint64_t)) {
  std::vector<Integer> numbers(count);
  EXPECT_EQ(get(context.get(), numbers.data(), type, 0), BELTRAMI_OK) << message(context);
  return numbers;
}

TEST(SeveralSurfaces, OneAloneIsWhatUnwrapMakesOfIt) {
  const TriangleList torus = meshes::torus(10);
  const Context one = create(), several = create();
  const beltrami_surface surface = surface_view(torus);
  ASSERT_EQ(beltrami_unwrap(one.get(), &surface, nullptr, nullptr), BELTRAMI_OK);
  ASSERT_EQ(unwrap(several, {surface}), BELTRAMI_OK);
  EXPECT_TRUE(same_bits(corner_uvs(one), corner_uvs(several)));
}

TEST(SeveralSurfaces, ShareAPageAndAVerdictAtOneScale) {
  const TriangleList cube = meshes::cube(), torus = meshes::torus(10);
  const Context context = create();
  ASSERT_EQ(unwrap(context, {surface_view(cube), surface_view(torus), surface_view(cube)}),
            BELTRAMI_OK)
      << message(context);
  const beltrami_atlas atlas = atlas_of(context);
  EXPECT_EQ(atlas.vertices, 2 * cube.positions.size() + torus.positions.size());
  EXPECT_EQ(atlas.faces, 2 * cube.faces.size() + torus.faces.size());
  EXPECT_EQ(atlas.components, 3u);
  EXPECT_EQ(atlas.pages, 1u);
  auto certificate = sized<beltrami_atlas_certificate>();
  ASSERT_EQ(beltrami_get_atlas_certificate(context.get(), BELTRAMI_F64, &certificate), BELTRAMI_OK);
  EXPECT_EQ(certificate.injective, 1);
  EXPECT_EQ(certificate.positive, atlas.triangles);
  // Areas on the page are those of the surfaces: to the energy that seams are searched for.
  const std::vector<double> uvs = corner_uvs(context);
  const auto area = [&](std::size_t first, std::size_t faces) {
    double sum = 0;
    for (std::size_t f = first; f < first + faces; ++f) {
      const double* p = &uvs[6 * f];
      sum += (p[2] - p[0]) * (p[5] - p[1]) - (p[4] - p[0]) * (p[3] - p[1]);
    }
    return sum / 2;
  };
  const std::size_t last = cube.faces.size() + torus.faces.size();
  const double first_area = area(0, cube.faces.size());
  EXPECT_NEAR(area(last, cube.faces.size()), first_area, 1e-3 * first_area);
}

// Two cubes at one place, vertex by vertex: welded, their sides would be copies of each other.
TEST(SeveralSurfaces, AreNotWelded) {
  const TriangleList cube = meshes::cube();
  const Context context = create();
  ASSERT_EQ(unwrap(context, {surface_view(cube), surface_view(cube)}), BELTRAMI_OK);
  const beltrami_atlas atlas = atlas_of(context);
  EXPECT_EQ(atlas.components, 2u);
  EXPECT_EQ(atlas.welded_vertices, 0u);
  EXPECT_EQ(atlas.copies, 0u);
}

TEST(SeveralSurfaces, TheirOwnVerticesAreWelded) {
  const TriangleList cube = meshes::cube();
  TriangleList soup;
  for (const auto& face : cube.faces) {
    for (const Index v : face) soup.positions.push_back(cube.positions[v]);
    const auto first = static_cast<Index>(soup.positions.size()) - 3;
    soup.faces.push_back({first, first + 1, first + 2});
  }
  const Context context = create();
  ASSERT_EQ(unwrap(context, {surface_view(soup), surface_view(soup)}), BELTRAMI_OK);
  const beltrami_atlas atlas = atlas_of(context);
  EXPECT_EQ(atlas.components, 2u);
  EXPECT_EQ(atlas.welded_vertices, 2 * (36u - 8u));
}

TEST(SeveralSurfaces, UvVerticesOfOneFollowThoseOfTheOther) {
  const TriangleList cube = meshes::cube(), torus = meshes::torus(10);
  const Context context = create();
  ASSERT_EQ(unwrap(context, {surface_view(cube), surface_view(torus)}), BELTRAMI_OK);
  const auto origins = integers<std::uint32_t>(context, atlas_of(context).uv_vertices, BELTRAMI_U32,
                                               &beltrami_get_uv_vertex_origins);
  const auto of_second = [&](std::uint32_t origin) { return origin >= cube.positions.size(); };
  EXPECT_TRUE(std::ranges::is_partitioned(origins, std::not_fn(of_second)));
  EXPECT_TRUE(std::ranges::any_of(origins, of_second));
}

TEST(SeveralSurfaces, MayBeOfTrianglesAndOfPolygons) {
  const TriangleList cube = meshes::cube();
  const std::vector<std::uint32_t> square = {0, 2, 3, 1}, sizes = {4};
  auto polygon = surface_view(cube);
  polygon.face_count = 1;
  polygon.corner_count = 4;
  polygon.indices.data = square.data();
  polygon.face_sizes = {sizes.data(), 0, BELTRAMI_U32, 0};
  for (const bool polygon_first : {false, true}) {
    const Context context = create();
    const std::vector<beltrami_surface> surfaces = polygon_first
                                                       ? std::vector{polygon, surface_view(cube)}
                                                       : std::vector{surface_view(cube), polygon};
    ASSERT_EQ(unwrap(context, surfaces), BELTRAMI_OK) << message(context);
    const beltrami_atlas atlas = atlas_of(context);
    EXPECT_EQ(atlas.faces, cube.faces.size() + 1);
    EXPECT_EQ(atlas.corners, 3 * cube.faces.size() + 4);
    EXPECT_EQ(atlas.triangles, cube.faces.size() + 2);
    const auto charts =
        integers<std::uint32_t>(context, atlas.faces, BELTRAMI_U32, &beltrami_get_face_charts);
    EXPECT_EQ(std::ranges::count(charts, charts[polygon_first ? 0 : cube.faces.size()]), 1);
  }
}

// Densities of one are 1 for the other, its labels and its paint are none of the other's.
TEST(SeveralSurfaces, WhatComesWithOneIsNotForTheOthers) {
  const TriangleList cube = meshes::cube();
  const std::vector<double> densities(cube.faces.size(), 2.0);
  const std::vector<double> paint(cube.positions.size(), 3.0);
  std::vector<std::uint32_t> labels(cube.faces.size());
  for (std::uint32_t f = 0; f < labels.size(); ++f) labels[f] = f;
  auto marked = surface_view(cube);
  marked.densities = {densities.data(), 0, BELTRAMI_F64, 0};
  marked.face_labels = {labels.data(), 0, BELTRAMI_U32, 0};
  marked.materials = marked.face_labels;
  marked.vertex_paint = {paint.data(), 0, BELTRAMI_F64, 0};
  const Context context = create();
  for (const bool marked_first : {false, true}) {
    const std::vector<beltrami_surface> surfaces = marked_first
                                                       ? std::vector{marked, surface_view(cube)}
                                                       : std::vector{surface_view(cube), marked};
    ASSERT_EQ(unwrap(context, surfaces), BELTRAMI_OK) << message(context);
    const std::uint64_t charts = atlas_of(context).charts;
    std::size_t alone = 0;
    for (std::uint64_t i = 0; i < charts; ++i) {
      auto chart = sized<beltrami_chart>();
      ASSERT_EQ(beltrami_get_chart(context.get(), i, &chart), BELTRAMI_OK);
      const bool is_marked = (chart.first_face < cube.faces.size()) == marked_first;
      EXPECT_EQ(chart.density, is_marked ? 2 : 1);
      if (is_marked) {
        EXPECT_EQ(chart.triangles, 1u);
        ++alone;
      }
    }
    EXPECT_EQ(alone, cube.faces.size());
    EXPECT_LT(charts, 2 * cube.faces.size());
  }
}

TEST(SeveralSurfaces, PinsAreCornersOfTheirOwnSurface) {
  const TriangleList quad = meshes::quad(), cube = meshes::cube();
  const std::array<std::uint32_t, 2> pins = {0, 1};
  const std::array<double, 4> places = {10, 10, 12, 10};
  auto pinned = surface_view(quad);
  pinned.pins = {pins.data(), 0, BELTRAMI_U32, 0};
  pinned.pin_uvs = {places.data(), 0, BELTRAMI_F64, 0};
  pinned.pin_count = 2;
  const Context context = create();
  ASSERT_EQ(unwrap(context, {surface_view(cube), pinned}), BELTRAMI_OK) << message(context);
  const std::vector<double> uvs = corner_uvs(context);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(uvs[6 * cube.faces.size() + i], places[i]);
}

TEST(SeveralSurfaces, ErrorsNameTheSurfaceAndCountThroughAll) {
  const TriangleList cube = meshes::cube();
  TriangleList broken = cube;
  broken.faces[3][1] = 77;
  const Context context = create();
  EXPECT_EQ(unwrap(context, {surface_view(cube), surface_view(broken)}),
            BELTRAMI_E_INDEX_OUT_OF_RANGE);
  EXPECT_EQ(beltrami_error_element(context.get()), cube.faces.size() + 3);
  EXPECT_NE(message(context).find("surface 1: face 3 names vertex 77"), std::string::npos)
      << message(context);
  EXPECT_EQ(unwrap(context, {}), BELTRAMI_E_INVALID_ARGUMENT);
  const beltrami_surface* const none = nullptr;
  EXPECT_EQ(beltrami_unwrap_surfaces(context.get(), &none, 1, nullptr, nullptr),
            BELTRAMI_E_INVALID_ARGUMENT);
  EXPECT_EQ(beltrami_unwrap_surfaces(context.get(), &none, 0, nullptr, nullptr), BELTRAMI_E_EMPTY);
}

TEST(SeveralSurfaces, OneWithoutFacesIsNamed) {
  const TriangleList cube = meshes::cube();
  beltrami_surface empty = surface_view(cube);
  empty.face_count = 0;
  const Context context = create();
  EXPECT_EQ(unwrap(context, {surface_view(cube), empty}), BELTRAMI_E_EMPTY);
  EXPECT_NE(message(context).find("surface 1: "), std::string::npos) << message(context);
  const std::array<beltrami_surface, 2> surfaces = {surface_view(cube), surface_view(cube)};
  const std::array<const beltrami_surface*, 3> pointers = {&surfaces[0], &surfaces[1], nullptr};
  EXPECT_EQ(beltrami_unwrap_surfaces(context.get(), pointers.data(), 3, nullptr, nullptr),
            BELTRAMI_E_INVALID_ARGUMENT);
  EXPECT_NE(message(context).find("surface 2: "), std::string::npos) << message(context);
  EXPECT_EQ(unwrap(context, {empty}), BELTRAMI_E_EMPTY);
  EXPECT_EQ(message(context).find("surface 0"), std::string::npos) << message(context);
}

TEST(SixteenBits, IndicesGiveTheSameBitsAsThoseOfThirtyTwo) {
  const TriangleList torus = meshes::torus(10);
  std::vector<std::uint16_t> narrow;
  for (const auto& face : torus.faces) {
    for (const Index v : face) narrow.push_back(static_cast<std::uint16_t>(v));
  }
  beltrami_surface surface = surface_view(torus);
  const Context wide_context = create(), context = create();
  ASSERT_EQ(unwrap(wide_context, {surface}), BELTRAMI_OK);
  surface.indices = {narrow.data(), 0, BELTRAMI_U16, 0};
  ASSERT_EQ(unwrap(context, {surface}), BELTRAMI_OK) << message(context);
  EXPECT_TRUE(same_bits(corner_uvs(wide_context), corner_uvs(context)));
  const std::size_t corners = narrow.size();
  const auto few =
      integers<std::uint16_t>(context, corners, BELTRAMI_U16, &beltrami_get_corner_uv_vertices);
  const auto many =
      integers<std::uint32_t>(context, corners, BELTRAMI_U32, &beltrami_get_corner_uv_vertices);
  EXPECT_TRUE(std::ranges::equal(few, many));

  const TriangleList disk = meshes::bumps(5, 4);
  std::vector<std::uint16_t> faces;
  for (const auto& face : disk.faces) {
    for (const Index v : face) faces.push_back(static_cast<std::uint16_t>(v));
  }
  beltrami_mesh mesh = view(disk);
  const Context expected = loaded(disk), found = loaded(meshes::quad());
  mesh.indices = {faces.data(), 0, BELTRAMI_U16, 0};
  ASSERT_EQ(beltrami_set_mesh(found.get(), &mesh), BELTRAMI_OK) << message(found);
  ASSERT_EQ(run(expected), BELTRAMI_OK);
  ASSERT_EQ(run(found), BELTRAMI_OK);
  EXPECT_TRUE(same_bits(uvs(expected, disk.positions.size()), uvs(found, disk.positions.size())));
  std::vector<std::uint16_t> back(faces.size());
  ASSERT_EQ(beltrami_get_faces(found.get(), back.data(), BELTRAMI_U16, 0), BELTRAMI_OK);
  EXPECT_EQ(back, faces);
}

// The last vertex has the number that stands for none.
TEST(SixteenBits, WhatDoesNotFitIsRefusedAndNothingIsWritten) {
  TriangleList quad = meshes::quad();
  const Index last = 0xffff, moved = quad.faces.back()[2];
  quad.positions.resize(static_cast<std::size_t>(last) + 1, quad.positions[moved]);
  for (auto& face : quad.faces) std::ranges::replace(face, moved, last);
  const Context context = loaded(quad);
  ASSERT_EQ(run(context), BELTRAMI_OK);
  std::vector<std::uint16_t> room(3 * quad.faces.size(), 7);
  EXPECT_EQ(beltrami_get_faces(context.get(), room.data(), BELTRAMI_U16, 0),
            BELTRAMI_E_INVALID_ARGUMENT);
  EXPECT_NE(message(context).find("65535"), std::string::npos) << message(context);
  EXPECT_TRUE(std::ranges::all_of(room, [](std::uint16_t number) { return number == 7; }));
}

// All bits set is none in 16 bits, too: of faces without area, and of charts that are placed anew.
TEST(SixteenBits, AllBitsSetIsNone) {
  TriangleList mesh = meshes::cube();
  const auto same = static_cast<Index>(mesh.positions.size());
  mesh.positions.push_back(mesh.positions[0]);
  mesh.faces.push_back({0, 1, same});
  const Context context = create();
  set_option(context, BELTRAMI_OPTION_WELD, BELTRAMI_WELD_OFF);
  ASSERT_EQ(unwrap(context, {surface_view(mesh)}), BELTRAMI_OK) << message(context);
  const auto charts =
      integers<std::uint16_t>(context, mesh.faces.size(), BELTRAMI_U16, &beltrami_get_face_charts);
  EXPECT_EQ(charts.back(), 0xffff);
  EXPECT_EQ(charts.front(), 0);
}

}  // namespace
}  // namespace beltrami::host
