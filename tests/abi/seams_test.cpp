// The search for seams through the C ABI: its options and presets, what draws seams, the seams
// themselves and back again.
#include <beltrami/beltrami.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "abi/host.h"
#include "base/types.h"
#include "support/meshes.h"
#include "support/surfaces.h"

namespace beltrami::host {
namespace {

using meshes::TriangleList;
using Edges = std::vector<std::array<std::uint32_t, 2>>;

beltrami_status unwrap(const Context& context, const beltrami_surface& surface) {
  return beltrami_unwrap(context.get(), &surface, nullptr, nullptr);
}

beltrami_atlas atlas_of(const Context& context) {
  auto atlas = sized<beltrami_atlas>();
  EXPECT_EQ(beltrami_get_atlas(context.get(), &atlas), BELTRAMI_OK) << message(context);
  return atlas;
}

Edges seams_of(const Context& context) {
  Edges seams(atlas_of(context).seams);
  EXPECT_EQ(beltrami_get_seams(context.get(), seams.data(), BELTRAMI_U32, 0), BELTRAMI_OK);
  return seams;
}

std::vector<std::uint64_t> face_charts(const Context& context) {
  std::vector<std::uint64_t> charts(atlas_of(context).faces);
  EXPECT_EQ(beltrami_get_face_charts(context.get(), charts.data(), BELTRAMI_U64, 0), BELTRAMI_OK);
  return charts;
}

double option(const Context& context, std::int32_t key) {
  double value = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(beltrami_get_option(context.get(), key, &value), BELTRAMI_OK) << message(context);
  return value;
}

/// Every edge, the lesser end first, in order.
Edges edges_of(const TriangleList& mesh) {
  std::set<std::array<std::uint32_t, 2>> edges;
  for (const Triangle& face : mesh.faces) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto a = static_cast<std::uint32_t>(face[k]),
                 b = static_cast<std::uint32_t>(face[(k + 1) % 3]);
      edges.insert({std::min(a, b), std::max(a, b)});
    }
  }
  return {edges.begin(), edges.end()};
}

TEST(AbiSeams, AreSearchedForByDefaultAndReachTheTarget) {
  const TriangleList cube = meshes::cube();
  const Context context = create();
  ASSERT_EQ(unwrap(context, surface_view(cube)), BELTRAMI_OK) << message(context);
  const beltrami_atlas atlas = atlas_of(context);
  EXPECT_EQ(atlas.searched, 1);
  EXPECT_EQ(atlas.reached, 1);
  EXPECT_LE(atlas.symmetric_dirichlet, 2.05 + 1e-4);
  set_option(context, BELTRAMI_OPTION_CUT, BELTRAMI_CUT_MINIMAL);
  ASSERT_EQ(unwrap(context, surface_view(cube)), BELTRAMI_OK);
  EXPECT_EQ(atlas_of(context).searched, 0);
  EXPECT_EQ(atlas_of(context).reached, 0);
}

TEST(AbiSeams, ATargetThatIsMissedIsSaidAndNoError) {
  const TriangleList cube = meshes::cube();
  const Context context = create();
  // Less than the cube's shortest cut into disks.
  ASSERT_EQ(beltrami_set_float(context.get(), BELTRAMI_OPTION_SEAM_BUDGET, 0.01), BELTRAMI_OK);
  ASSERT_EQ(unwrap(context, surface_view(cube)), BELTRAMI_OK) << message(context);
  EXPECT_EQ(atlas_of(context).searched, 1);
  EXPECT_EQ(atlas_of(context).reached, 0);
}

TEST(AbiSeams, AreEdgesOnceAndInOrder) {
  const TriangleList cube = meshes::cube();
  const Context context = create();
  ASSERT_EQ(unwrap(context, surface_view(cube)), BELTRAMI_OK);
  const Edges seams = seams_of(context), edges = edges_of(cube);
  ASSERT_FALSE(seams.empty());
  double length = 0;
  for (std::size_t i = 0; i < seams.size(); ++i) {
    const auto [a, b] = seams[i];
    EXPECT_LT(a, b);
    if (i > 0) {
      EXPECT_LT(seams[i - 1], seams[i]);
    }
    EXPECT_TRUE(std::binary_search(edges.begin(), edges.end(), seams[i]));
    length += (cube.positions[a] - cube.positions[b]).norm();
  }
  EXPECT_NEAR(length, atlas_of(context).seam_length, 1e-12);
  // An open border is no seam.
  const TriangleList grid = meshes::grid(3, 2);
  ASSERT_EQ(unwrap(context, surface_view(grid)), BELTRAMI_OK);
  EXPECT_EQ(atlas_of(context).seams, 0u);
  EXPECT_EQ(beltrami_get_seams(context.get(), nullptr, BELTRAMI_F32, 0),
            BELTRAMI_E_INVALID_ARGUMENT);
}

TEST(AbiSeams, GivenBackMakeTheSameCharts) {
  for (const TriangleList& mesh :
       {meshes::cube(), meshes::soup(meshes::cube()), meshes::torus(12), meshes::octahedron()}) {
    const Context context = create();
    ASSERT_GE(unwrap(context, surface_view(mesh)), BELTRAMI_OK) << message(context);
    const Edges seams = seams_of(context);
    const std::vector<std::uint64_t> charts = face_charts(context);
    set_option(context, BELTRAMI_OPTION_CUT, BELTRAMI_CUT_GIVEN);
    beltrami_surface surface = surface_view(mesh);
    surface.seams = {seams.data(), 0, BELTRAMI_U32, 0};
    surface.seam_count = seams.size();
    ASSERT_GE(unwrap(context, surface), BELTRAMI_OK) << message(context);
    EXPECT_EQ(seams_of(context), seams);
    EXPECT_EQ(face_charts(context), charts);
    EXPECT_EQ(atlas_of(context).searched, 0);
  }
}

TEST(AbiSeams, APresetSetsTheOtherOptionsAndIsOverridden) {
  const Context context = create();
  auto info = sized<beltrami_option_info>();
  for (std::int32_t key = 0; beltrami_option_describe(key, &info) == BELTRAMI_OK; ++key) {
    EXPECT_EQ(option(context, key), info.default_value) << info.name;
  }
  set_option(context, BELTRAMI_OPTION_PRESET, BELTRAMI_PRESET_LIGHTMAP);
  EXPECT_EQ(option(context, BELTRAMI_OPTION_TARGET_ENERGY), 2.1);
  EXPECT_EQ(option(context, BELTRAMI_OPTION_HIDDEN_SEAMS), 0);
  EXPECT_EQ(option(context, BELTRAMI_OPTION_THREADS), 1);
  ASSERT_EQ(beltrami_set_float(context.get(), BELTRAMI_OPTION_TARGET_ENERGY, 2.3), BELTRAMI_OK);
  EXPECT_EQ(option(context, BELTRAMI_OPTION_TARGET_ENERGY), 2.3);
  set_option(context, BELTRAMI_OPTION_PRESET, BELTRAMI_PRESET_ONE_CHART);
  EXPECT_EQ(option(context, BELTRAMI_OPTION_TARGET_ENERGY), 2.05);
  EXPECT_EQ(option(context, BELTRAMI_OPTION_MAX_CHARTS), 1);
  EXPECT_EQ(option(context, BELTRAMI_OPTION_HIDDEN_SEAMS), 0.2);
  set_option(context, BELTRAMI_OPTION_PRESET, BELTRAMI_PRESET_NONE);
  EXPECT_EQ(option(context, BELTRAMI_OPTION_MAX_CHARTS), 0);
  double value = 7;
  EXPECT_EQ(beltrami_get_option(context.get(), 1000, &value), BELTRAMI_E_INVALID_ARGUMENT);
  EXPECT_EQ(value, 7);
  EXPECT_EQ(beltrami_get_option(context.get(), 0, nullptr), BELTRAMI_E_INVALID_ARGUMENT);
}

TEST(AbiSeams, WhatIsToldTheSearchIsRefusedWithoutOne) {
  const TriangleList mesh = meshes::cube();
  const std::vector<double> paint(8, 1);
  const auto refused = [&](const std::function<void(const Context&, beltrami_surface&)>& set) {
    const Context context = create();
    set_option(context, BELTRAMI_OPTION_CUT, BELTRAMI_CUT_MINIMAL);
    beltrami_surface surface = surface_view(mesh);
    set(context, surface);
    EXPECT_EQ(unwrap(context, surface), BELTRAMI_E_INVALID_ARGUMENT);
    return message(context);
  };
  EXPECT_NE(refused([](const Context& context, beltrami_surface&) {
              beltrami_set_float(context.get(), BELTRAMI_OPTION_TARGET_ENERGY, 2.5);
            }).find("target-energy=2.5 has no effect with cut=minimal"),
            std::string::npos);
  EXPECT_NE(refused([](const Context& context, beltrami_surface&) {
              set_option(context, BELTRAMI_OPTION_PRESET, BELTRAMI_PRESET_LIGHTMAP);
            }).find("preset=lightmap has no effect with cut=minimal"),
            std::string::npos);
  EXPECT_NE(refused([&](const Context&, beltrami_surface& surface) {
              surface.vertex_paint = {paint.data(), 0, BELTRAMI_F64, 0};
            }).find("vertex_paint"),
            std::string::npos);
}

TEST(AbiSeams, PaintAndMaterialsAreTakenInAnyLayout) {
  const TriangleList mesh = meshes::cube();
  const Context context = create();
  const std::vector<std::array<float, 2>> paint(8, {0.5F, -1});  // every other number
  const std::vector<std::uint64_t> edges = {0, 1, 5, 4, 0, 7};   // the last is none
  const std::vector<float> factors = {0, 3, 1};
  const std::vector<std::uint32_t> materials = {7, 7, 7, 7, 7, 7, 2, 2, 2, 2, 2, 2};
  beltrami_surface surface = surface_view(mesh);
  surface.vertex_paint = {paint.data(), sizeof paint[0], BELTRAMI_F32, 0};
  surface.painted_edges = {edges.data(), 0, BELTRAMI_U64, 0};
  surface.edge_paint = {factors.data(), 0, BELTRAMI_F32, 0};
  surface.painted_edge_count = 3;
  surface.materials = {materials.data(), 0, BELTRAMI_U32, 0};
  ASSERT_EQ(unwrap(context, surface), BELTRAMI_OK) << message(context);
  EXPECT_EQ(atlas_of(context).searched, 1);
}

TEST(AbiSeams, PaintThatIsNoneIsRefusedWithItsElement) {
  const TriangleList mesh = meshes::cube();
  const Context context = create();
  for (const double bad :
       {-0.5, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    std::vector<double> paint(8, 1);
    paint[6] = bad;
    beltrami_surface surface = surface_view(mesh);
    surface.vertex_paint = {paint.data(), 0, BELTRAMI_F64, 0};
    EXPECT_EQ(unwrap(context, surface), BELTRAMI_E_INVALID_ARGUMENT);
    EXPECT_EQ(beltrami_error_element(context.get()), 6u);
    EXPECT_EQ(beltrami_error_element_kind(context.get()), BELTRAMI_ELEMENT_VERTEX);
    EXPECT_NE(message(context).find("vertex 6"), std::string::npos) << message(context);

    std::vector<std::uint32_t> edges = {0, 1, 1, 3};
    const std::vector<double> factors = {1, bad};
    surface = surface_view(mesh);
    surface.painted_edges = {edges.data(), 0, BELTRAMI_U32, 0};
    surface.edge_paint = {factors.data(), 0, BELTRAMI_F64, 0};
    surface.painted_edge_count = 2;
    EXPECT_EQ(unwrap(context, surface), BELTRAMI_E_INVALID_ARGUMENT);
    EXPECT_NE(message(context).find("painted edge 1"), std::string::npos) << message(context);
    edges[1] = 8;
    EXPECT_EQ(unwrap(context, surface), BELTRAMI_E_INDEX_OUT_OF_RANGE);
    EXPECT_NE(message(context).find("painted edge 0 names vertex 8"), std::string::npos);
  }
  beltrami_surface surface = surface_view(mesh);
  surface.painted_edge_count = 1;
  EXPECT_EQ(unwrap(context, surface), BELTRAMI_E_INVALID_ARGUMENT) << "there are no edges";
}

// A buffer that is left out is all zeros: what is wrong is that there is none, not its type.
TEST(AbiSurface, WhatHasACountIsNotNull) {
  const TriangleList cube = meshes::cube();
  const struct {
    std::uint64_t beltrami_surface::*count;
    const char* what;
  } counted[] = {{&beltrami_surface::seam_count, "seams"},
                 {&beltrami_surface::pin_count, "pins"},
                 {&beltrami_surface::painted_edge_count, "painted edges"},
                 {&beltrami_surface::straight_edge_count, "straight edges"},
                 {&beltrami_surface::rectangle_count, "rectangles"}};
  for (const auto& [count, what] : counted) {
    const Context context = create();
    beltrami_surface surface = surface_view(cube);
    surface.*count = 1;
    EXPECT_EQ(unwrap(context, surface), BELTRAMI_E_INVALID_ARGUMENT) << what;
    EXPECT_NE(message(context).find(std::string(what) + " is NULL"), std::string::npos)
        << message(context);
  }
}

TEST(AbiSeams, NoneNeedNoMemory) {
  const TriangleList mesh = meshes::quad();
  const beltrami_surface surface = surface_view(mesh);
  const Context context = create();
  ASSERT_EQ(beltrami_unwrap(context.get(), &surface, nullptr, nullptr), BELTRAMI_OK);
  auto atlas = sized<beltrami_atlas>();
  ASSERT_EQ(beltrami_get_atlas(context.get(), &atlas), BELTRAMI_OK);
  EXPECT_EQ(atlas.seams, 0u);
  EXPECT_EQ(beltrami_get_seams(context.get(), nullptr, BELTRAMI_U32, 0), BELTRAMI_OK);
  EXPECT_EQ(beltrami_get_face_charts(context.get(), nullptr, BELTRAMI_U32, 0),
            BELTRAMI_E_INVALID_ARGUMENT);
}

}  // namespace
}  // namespace beltrami::host
