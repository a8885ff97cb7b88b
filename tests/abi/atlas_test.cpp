// Atlases through the C ABI: any surface in, every corner's UV out, and the verdict on anybody's.
#include <beltrami/beltrami.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "abi/host.h"
#include "base/vectors.h"
#include "support/meshes.h"
#include "support/surfaces.h"

namespace beltrami::host {
namespace {

using meshes::TriangleList;

/// Six squares.
struct QuadCube {
  TriangleList corners = meshes::cube();
  std::vector<std::uint32_t> indices = {0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4,
                                        2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5};
  std::vector<std::uint64_t> sizes = std::vector<std::uint64_t>(6, 4);

  beltrami_surface view() const {
    auto surface = sized<beltrami_surface>();
    surface.vertex_count = 8;
    surface.face_count = 6;
    surface.corner_count = 24;
    surface.positions = {corners.positions.data(), 0, BELTRAMI_F64, 0};
    surface.indices = {indices.data(), 0, BELTRAMI_U32, 0};
    surface.face_sizes = {sizes.data(), 0, BELTRAMI_U64, 0};
    return surface;
  }
};

beltrami_status unwrap(const Context& context, const beltrami_surface& surface) {
  return beltrami_unwrap(context.get(), &surface, nullptr, nullptr);
}

/// Whose seams are those that are given, and short ones that open what is no disk.
Context with_minimal_cut() {
  Context context = create();
  set_option(context, BELTRAMI_OPTION_CUT, BELTRAMI_CUT_MINIMAL);
  return context;
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

TEST(AbiAtlas, UnwrapsACubeOfQuads) {
  const QuadCube cube;
  const Context context = with_minimal_cut();
  ASSERT_EQ(unwrap(context, cube.view()), BELTRAMI_OK) << message(context);
  const beltrami_atlas atlas = atlas_of(context);
  EXPECT_EQ(atlas.status, BELTRAMI_OK);
  EXPECT_EQ(atlas.faces, 6u);
  EXPECT_EQ(atlas.corners, 24u);
  EXPECT_EQ(atlas.triangles, 12u);
  EXPECT_EQ(atlas.charts, 1u);
  EXPECT_EQ(atlas.closed_components, 1u);
  EXPECT_NEAR(atlas.area, 6, 1e-12);
  EXPECT_GE(atlas.symmetric_dirichlet, 2);
  EXPECT_GT(atlas.seam_length, 0);
  for (const std::int32_t type : {BELTRAMI_F32, BELTRAMI_F64}) {
    auto certificate = sized<beltrami_atlas_certificate>();
    ASSERT_EQ(beltrami_get_atlas_certificate(context.get(), type, &certificate), BELTRAMI_OK);
    EXPECT_EQ(certificate.injective, 1);
    EXPECT_EQ(certificate.positive, 12u);
  }
  auto chart = sized<beltrami_chart>();
  ASSERT_EQ(beltrami_get_chart(context.get(), 0, &chart), BELTRAMI_OK);
  EXPECT_EQ(chart.triangles, 12u);
  EXPECT_EQ(chart.first_face, 0u);
  EXPECT_EQ(beltrami_get_chart(context.get(), 1, &chart), BELTRAMI_E_INVALID_ARGUMENT);
  EXPECT_NE(message(context).find("there is no chart 1"), std::string::npos) << message(context);
}

// Of an axe: five triangles wind around a vertex, the sixth continues one of them. No cut is found,
// and the map in one piece is pressed together.
TEST(AbiAtlas, AFewTrianglesThatMissTheTargetByFarAreSplit) {
  TriangleList mesh;
  mesh.positions = {{0.303259, 1.906898, 0.000943},   {0.310494, -8.42216, 0.017841},
                    {0.313138, 3.616659, -0.017874},  {0.309484, 2.945865, -0.014868},
                    {0.289586, -2.983799, -0.243538}, {0.283413, 0.063814, -0.172005},
                    {0.287758, -1.053373, 0.139758}};
  mesh.faces = {{0, 3, 2}, {0, 5, 3}, {0, 1, 4}, {0, 4, 5}, {2, 6, 3}, {2, 3, 5}};
  const Context context = create();
  ASSERT_EQ(unwrap(context, surface_view(mesh)), BELTRAMI_OK) << message(context);
  EXPECT_EQ(atlas_of(context).reached, 1);
}

TEST(AbiAtlas, UvVerticesAreAVertexBuffer) {
  // A soup: welded for the charts, and yet each UV vertex is a copy of one input vertex.
  const TriangleList mesh = meshes::soup(meshes::cube());
  const Context context = with_minimal_cut();
  ASSERT_EQ(unwrap(context, surface_view(mesh)), BELTRAMI_OK);
  const beltrami_atlas atlas = atlas_of(context);
  EXPECT_EQ(atlas.charts, 1u);
  EXPECT_EQ(atlas.welded_vertices, 36u - 8u);
  EXPECT_EQ(atlas.uv_vertices, 36u);
  std::vector<double> uvs(2 * atlas.uv_vertices);
  std::vector<std::uint32_t> origins(atlas.uv_vertices), of_corner(atlas.corners);
  ASSERT_EQ(beltrami_get_uv_vertices(context.get(), uvs.data(), BELTRAMI_F64, 0), BELTRAMI_OK);
  ASSERT_EQ(beltrami_get_uv_vertex_origins(context.get(), origins.data(), BELTRAMI_U32, 0),
            BELTRAMI_OK);
  ASSERT_EQ(beltrami_get_corner_uv_vertices(context.get(), of_corner.data(), BELTRAMI_U32, 0),
            BELTRAMI_OK);
  const std::vector<double> of_corners = corner_uvs(context);
  for (std::size_t c = 0; c < of_corner.size(); ++c) {
    EXPECT_EQ(origins[of_corner[c]], static_cast<std::uint32_t>(mesh.faces[c / 3][c % 3]));
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_EQ(uvs[2 * of_corner[c] + k], of_corners[2 * c + k]);
    }
  }
}

TEST(AbiAtlas, SeamsLabelsAnglesAndIslandsCut) {
  QuadCube cube;
  const Context context = with_minimal_cut();
  ASSERT_EQ(beltrami_set_float(context.get(), BELTRAMI_OPTION_HARD_ANGLE, 60), BELTRAMI_OK);
  ASSERT_EQ(unwrap(context, cube.view()), BELTRAMI_OK);
  EXPECT_EQ(atlas_of(context).charts, 6u);
  std::vector<double> uvs = corner_uvs(context);
  ASSERT_EQ(beltrami_set_float(context.get(), BELTRAMI_OPTION_HARD_ANGLE, 180), BELTRAMI_OK);

  beltrami_surface surface = cube.view();
  const std::vector<std::uint32_t> labels = {9, 9, 9, 9, 9, 3};
  surface.face_labels = {labels.data(), 0, BELTRAMI_U32, 0};
  ASSERT_EQ(unwrap(context, surface), BELTRAMI_OK);
  EXPECT_EQ(atlas_of(context).charts, 2u);
  std::array<std::uint64_t, 6> charts{};
  ASSERT_EQ(beltrami_get_face_charts(context.get(), charts.data(), BELTRAMI_U64, 0), BELTRAMI_OK);
  EXPECT_EQ(charts, (std::array<std::uint64_t, 6>{0, 0, 0, 0, 0, 1}));

  surface = cube.view();
  const std::vector<std::uint64_t> seams = {0, 2, 2, 3, 3, 1, 1, 0};
  surface.seams = {seams.data(), 0, BELTRAMI_U64, 0};
  surface.seam_count = 4;
  ASSERT_EQ(unwrap(context, surface), BELTRAMI_OK);
  EXPECT_EQ(atlas_of(context).charts, 2u);

  set_option(context, BELTRAMI_OPTION_CUT, BELTRAMI_CUT_ISLANDS);
  surface = cube.view();
  EXPECT_EQ(unwrap(context, surface), BELTRAMI_E_INVALID_ARGUMENT) << "there are no islands";
  surface.corner_uvs = {uvs.data(), 0, BELTRAMI_F64, 0};
  ASSERT_EQ(unwrap(context, surface), BELTRAMI_OK);
  EXPECT_EQ(atlas_of(context).charts, 6u);
  EXPECT_NEAR(atlas_of(context).max, 2, 1e-9);
}

TEST(AbiAtlas, ChecksAnybodysUvs) {
  const QuadCube cube;
  const Context context = create();
  ASSERT_EQ(unwrap(context, cube.view()), BELTRAMI_OK);
  std::vector<double> uvs = corner_uvs(context);
  beltrami_surface surface = cube.view();
  surface.corner_uvs = {uvs.data(), 0, BELTRAMI_F64, 0};
  auto found = sized<beltrami_atlas_certificate>();
  EXPECT_EQ(beltrami_check_atlas(&surface, 0, &found, nullptr, 0), BELTRAMI_OK);
  EXPECT_EQ(found.injective, 1);
  EXPECT_EQ(found.positive, 12u);

  // Every square on the unit square.
  for (std::size_t c = 0; c < 24; ++c) {
    uvs[2 * c] = c % 4 == 1 || c % 4 == 2 ? 1 : 0;
    uvs[2 * c + 1] = c % 4 >= 2 ? 1 : 0;
  }
  std::array<std::uint64_t, 200> pairs{};
  EXPECT_EQ(beltrami_check_atlas(&surface, 0, &found, pairs.data(), 100), BELTRAMI_NOT_INJECTIVE);
  EXPECT_EQ(found.injective, 0);
  EXPECT_GE(found.overlaps, 15u);
  std::set<std::uint64_t> faces;
  for (std::size_t i = 0; i < 100 && pairs[2 * i] != BELTRAMI_NO_ELEMENT; ++i) {
    EXPECT_LT(pairs[2 * i], 6u);
    EXPECT_NE(pairs[2 * i], pairs[2 * i + 1]);
    faces.insert({pairs[2 * i], pairs[2 * i + 1]});
  }
  EXPECT_EQ(faces.size(), 6u);
  EXPECT_LT(found.first_overlap[0], 6u);

  // One square, turned over.
  surface.face_count = 1;
  surface.corner_count = 4;
  for (std::size_t c = 0; c < 4; ++c) uvs[2 * c] = -uvs[2 * c];
  EXPECT_EQ(beltrami_check_atlas(&surface, 0, &found, nullptr, 0), BELTRAMI_NOT_INJECTIVE);
  EXPECT_EQ(found.first_bad_face, 0u);
  EXPECT_EQ(beltrami_check_atlas(&surface, 1, &found, nullptr, 0), BELTRAMI_OK);
  EXPECT_EQ(found.mirrored_charts, 1u);

  uvs[1] = std::nan("");
  EXPECT_EQ(beltrami_check_atlas(&surface, 0, &found, nullptr, 0), BELTRAMI_E_NON_FINITE);
  EXPECT_EQ(found.error_element, 0u);
  EXPECT_EQ(found.error_element_kind, BELTRAMI_ELEMENT_FACE);
}

TEST(AbiAtlas, CornersInAWindingThatChangesAreNoFold) {
  TriangleList mesh = meshes::grid(2, 1);
  std::swap(mesh.faces[1][1], mesh.faces[1][2]);
  const Context context = create();
  ASSERT_EQ(unwrap(context, surface_view(mesh)), BELTRAMI_OK);
  EXPECT_EQ(atlas_of(context).reversed_faces, 1u);
  const std::vector<double> uvs = corner_uvs(context);
  beltrami_surface surface = surface_view(mesh);
  surface.corner_uvs = {uvs.data(), 0, BELTRAMI_F64, 0};
  auto found = sized<beltrami_atlas_certificate>();
  EXPECT_EQ(beltrami_check_atlas(&surface, 0, &found, nullptr, 0), BELTRAMI_OK);
  // The triangles that were computed on have that face turned over.
  std::array<std::uint32_t, 12> corners{};
  ASSERT_EQ(beltrami_get_triangles(context.get(), corners.data(), BELTRAMI_U32, 0), BELTRAMI_OK);
  EXPECT_EQ(corners, (std::array<std::uint32_t, 12>{0, 1, 2, 3, 5, 4, 6, 7, 8, 9, 10, 11}));
}

TEST(AbiAtlas, RefusesWhatCannotBe) {
  const Context context = create();
  auto atlas = sized<beltrami_atlas>();
  EXPECT_EQ(beltrami_get_atlas(context.get(), &atlas), BELTRAMI_E_INVALID_STATE);
  EXPECT_EQ(beltrami_unwrap(context.get(), nullptr, nullptr, nullptr), BELTRAMI_E_INVALID_ARGUMENT);
  QuadCube cube;
  beltrami_surface surface = cube.view();
  surface.face_count = 0;
  EXPECT_EQ(unwrap(context, surface), BELTRAMI_E_EMPTY);
  surface = cube.view();
  surface.flags = 1;
  EXPECT_EQ(unwrap(context, surface), BELTRAMI_E_INVALID_ARGUMENT);
  surface = cube.view();
  surface.corner_count = 23;
  EXPECT_EQ(unwrap(context, surface), BELTRAMI_E_INVALID_ARGUMENT) << message(context);
  EXPECT_EQ(beltrami_error_element(context.get()), 5u);
  surface.corner_count = 25;
  EXPECT_EQ(unwrap(context, surface), BELTRAMI_E_INVALID_ARGUMENT) << message(context);
  surface = cube.view();
  cube.indices[22] = 8;
  EXPECT_EQ(unwrap(context, surface), BELTRAMI_E_INDEX_OUT_OF_RANGE);
  EXPECT_EQ(beltrami_error_element(context.get()), 5u);
  cube.indices[22] = 7;
  cube.sizes[2] = 2;
  EXPECT_EQ(unwrap(context, surface), BELTRAMI_E_INVALID_ARGUMENT);
  EXPECT_EQ(beltrami_error_element(context.get()), 2u);
  cube.sizes[2] = 4;
  cube.corners.positions[3].x() = std::numeric_limits<double>::infinity();
  EXPECT_EQ(unwrap(context, surface), BELTRAMI_E_NON_FINITE);
  EXPECT_EQ(beltrami_error_element(context.get()), 3u);
  for (Vec3& p : cube.corners.positions) p = Vec3::Ones();
  EXPECT_EQ(unwrap(context, surface), BELTRAMI_E_ZERO_AREA);
  surface = QuadCube(cube).view();
  const std::vector<double> densities = {1, 1, 0, 1, 1, 1};
  surface.densities = {densities.data(), 0, BELTRAMI_F64, 0};
  const QuadCube whole;
  surface.positions = whole.view().positions;
  surface.indices = whole.view().indices;
  surface.face_sizes = whole.view().face_sizes;
  EXPECT_EQ(unwrap(context, surface), BELTRAMI_E_INVALID_ARGUMENT);
  EXPECT_EQ(beltrami_error_element(context.get()), 2u);
  set_option(context, BELTRAMI_OPTION_DELAUNAY, 1);
  EXPECT_EQ(unwrap(context, whole.view()), BELTRAMI_E_INVALID_ARGUMENT);
  EXPECT_EQ(beltrami_atlas_stage_count(context.get()), 0);
}

TEST(AbiAtlas, AnOptionWithoutEffectIsNamedWithItsValue) {
  const Context context = create();
  const QuadCube cube;
  beltrami_set_int(context.get(), BELTRAMI_OPTION_WELD, BELTRAMI_WELD_OFF);
  beltrami_set_float(context.get(), BELTRAMI_OPTION_WELD_DISTANCE, 0.5);
  EXPECT_EQ(unwrap(context, cube.view()), BELTRAMI_E_INVALID_ARGUMENT);
  EXPECT_NE(message(context).find("weld-distance=0.5 has no effect with weld=off"),
            std::string::npos)
      << message(context);
}

TEST(AbiAtlas, StacksGoWithNothingThatIsAskedOfTheWhole) {
  const QuadCube cube;
  for (const std::int32_t key :
       {BELTRAMI_OPTION_MAX_CHARTS, BELTRAMI_OPTION_SEAM_BUDGET, BELTRAMI_OPTION_SYMMETRIC_SEAMS}) {
    const Context context = create();
    set_option(context, BELTRAMI_OPTION_STACK, BELTRAMI_STACK_MIRRORED);
    if (key == BELTRAMI_OPTION_MAX_CHARTS) {
      set_option(context, key, 1);
    } else {
      beltrami_set_float(context.get(), key, 1);
    }
    EXPECT_EQ(unwrap(context, cube.view()), BELTRAMI_E_INVALID_ARGUMENT) << key;
    EXPECT_NE(message(context).find("stack=mirrored has no effect with"), std::string::npos)
        << message(context);
  }
}

TEST(AbiAtlas, WhatHasNoAreaLiesBesideWhatIsStacked) {
  // Two quads, each with an edge of no length: one of its triangles has no area.
  const std::vector<double> positions = {0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0,
                                         5, 0, 0, 5, 0, 0, 6, 0, 0, 5, 1, 0};
  const std::vector<std::uint32_t> indices = {0, 1, 2, 3, 4, 5, 6, 7};
  const std::vector<std::uint64_t> sizes = {4, 4};
  auto surface = sized<beltrami_surface>();
  surface.vertex_count = 8;
  surface.face_count = 2;
  surface.corner_count = 8;
  surface.positions = {positions.data(), 0, BELTRAMI_F64, 0};
  surface.indices = {indices.data(), 0, BELTRAMI_U32, 0};
  surface.face_sizes = {sizes.data(), 0, BELTRAMI_U64, 0};
  const Context context = create();
  set_option(context, BELTRAMI_OPTION_STACK, BELTRAMI_STACK_COPIES);
  ASSERT_EQ(unwrap(context, surface), BELTRAMI_OK) << message(context);
  EXPECT_EQ(atlas_of(context).stacked_parts, 1u);
  const std::vector<double> uvs = corner_uvs(context);
  const auto area = [&](std::size_t first) {  // of the triangle of corners 0, 2 and 3 of a quad
    const double* a = &uvs[2 * first];
    return (a[4] - a[0]) * (a[7] - a[1]) - (a[5] - a[1]) * (a[6] - a[0]);
  };
  EXPECT_GT(std::abs(area(0)), 0.1);
  EXPECT_NEAR(std::abs(area(4)), std::abs(area(0)), 1e-6);
}

TEST(AbiAtlas, CubesThatAreStackedHaveTheSameUvs) {
  const QuadCube one;
  TriangleList both = one.corners;
  for (const Vec3& p : one.corners.positions) both.positions.emplace_back(p.x() + 3, p.z(), -p.y());
  std::vector<std::uint32_t> indices = one.indices;
  for (const std::uint32_t v : one.indices) indices.push_back(v + 8);
  auto surface = one.view();
  surface.vertex_count = 16;
  surface.face_count = 12;
  surface.corner_count = 48;
  surface.positions = {both.positions.data(), 0, BELTRAMI_F64, 0};
  surface.indices = {indices.data(), 0, BELTRAMI_U32, 0};
  const std::vector<std::uint64_t> sizes(12, 4);
  surface.face_sizes = {sizes.data(), 0, BELTRAMI_U64, 0};
  const Context context = create();
  set_option(context, BELTRAMI_OPTION_STACK, BELTRAMI_STACK_COPIES);
  ASSERT_EQ(unwrap(context, surface), BELTRAMI_OK) << message(context);
  EXPECT_EQ(atlas_of(context).stacked_parts, 1u);
  EXPECT_EQ(atlas_of(context).components, 2u);
  const std::vector<double> uvs = corner_uvs(context);
  const auto places = [&](std::size_t begin, std::size_t end) {
    std::multiset<std::pair<double, double>> all;
    for (std::size_t c = begin; c < end; ++c) all.insert({uvs[2 * c], uvs[2 * c + 1]});
    return all;
  };
  EXPECT_EQ(places(0, 24), places(24, 48));
}

TEST(AbiAtlas, VerticesThatNoFaceNamesMayBeAnything) {
  TriangleList mesh = meshes::with_unused_in_front(meshes::grid(2, 2), 2);
  mesh.positions[0].x() = std::nan("");
  const Context context = create();
  ASSERT_EQ(unwrap(context, surface_view(mesh)), BELTRAMI_OK) << message(context);
  EXPECT_EQ(atlas_of(context).unused_vertices, 2u);
}

TEST(AbiAtlas, AFailureOrACancelKeepsTheAtlas) {
  const QuadCube cube;
  const Context context = create();
  ASSERT_EQ(unwrap(context, cube.view()), BELTRAMI_OK);
  const std::vector<double> before = corner_uvs(context);
  const auto stop = [](void*, double, const char*) -> std::int32_t { return 1; };
  const beltrami_surface surface = cube.view();
  EXPECT_EQ(beltrami_unwrap(context.get(), &surface, stop, nullptr), BELTRAMI_E_CANCELLED);
  beltrami_cancel(context.get());
  EXPECT_EQ(unwrap(context, surface), BELTRAMI_E_CANCELLED);
  EXPECT_EQ(corner_uvs(context), before);
  EXPECT_EQ(unwrap(context, surface), BELTRAMI_OK);
  EXPECT_EQ(corner_uvs(context), before);
}

TEST(AbiAtlas, TriangulatesAsItUnwraps) {
  const QuadCube cube;
  const beltrami_surface surface = cube.view();
  std::array<std::uint64_t, 36> corners{};
  std::uint64_t repeating = 0;
  ASSERT_EQ(beltrami_triangulate(&surface, corners.data(), BELTRAMI_U64, 0, &repeating),
            BELTRAMI_OK);
  EXPECT_EQ(repeating, BELTRAMI_NO_ELEMENT);
  const Context context = create();
  ASSERT_EQ(unwrap(context, surface), BELTRAMI_OK);
  std::array<std::uint64_t, 36> used{};
  ASSERT_EQ(beltrami_get_triangles(context.get(), used.data(), BELTRAMI_U64, 0), BELTRAMI_OK);
  EXPECT_EQ(used, corners);
}

TEST(AbiAtlas, OptionsSayWhatTakesThem) {
  const auto calls = [](std::int32_t key) {
    auto info = sized<beltrami_option_info>();
    EXPECT_EQ(beltrami_option_describe(key, &info), BELTRAMI_OK);
    return info.calls;
  };
  EXPECT_EQ(calls(BELTRAMI_OPTION_THREADS),
            BELTRAMI_CALL_RUN | BELTRAMI_CALL_UNWRAP | BELTRAMI_CALL_PACK | BELTRAMI_CALL_BAKE);
  EXPECT_EQ(calls(BELTRAMI_OPTION_DELAUNAY), BELTRAMI_CALL_RUN);
  EXPECT_EQ(calls(BELTRAMI_OPTION_CUT), BELTRAMI_CALL_UNWRAP);
}

}  // namespace
}  // namespace beltrami::host
