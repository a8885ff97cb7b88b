// Pages through the C ABI: packed atlases, anybody's charts, masks, and what is refused.
#include <beltrami/beltrami.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "abi/host.h"
#include "base/types.h"
#include "base/vectors.h"
#include "support/meshes.h"
#include "support/surfaces.h"

namespace beltrami::host {
namespace {

using meshes::TriangleList;
using Uvs = std::vector<std::array<double, 2>>;

/// A cube whose faces are charts.
Context with_six_charts() {
  Context context = create();
  EXPECT_EQ(beltrami_set_float(context.get(), BELTRAMI_OPTION_HARD_ANGLE, 45), BELTRAMI_OK);
  return context;
}

beltrami_packing packing_of(const Context& context) {
  auto packing = sized<beltrami_packing>();
  EXPECT_EQ(beltrami_get_packing(context.get(), &packing), BELTRAMI_OK) << message(context);
  return packing;
}

/// Some triangles, each a chart.
struct Confetti {
  Uvs uvs;
  std::vector<std::array<std::uint32_t, 3>> faces;
  std::vector<std::array<double, 3>> positions;  ///< of UV vertices
  std::vector<std::uint64_t> kept, labels;

  explicit Confetti(std::uint32_t count, double size = 1) {
    for (std::uint32_t i = 0; i < count; ++i) {
      const double x = 2.0 * i;
      for (const auto& [u, v] : {std::pair(x, 0.0), std::pair(x + 1, 0.2), std::pair(x, 1.0)}) {
        uvs.push_back({u, v});
        positions.push_back({size * u, size * v, 0});
      }
      faces.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
  }

  beltrami_uv_mesh view(bool in_space = false) const {
    auto mesh = sized<beltrami_uv_mesh>();
    mesh.uv_count = uvs.size();
    mesh.face_count = faces.size();
    mesh.uvs = host::view(uvs);
    mesh.uv_indices = {faces.data(), 0, BELTRAMI_U32, 0};
    if (in_space) {
      mesh.vertex_count = positions.size();
      mesh.positions = {positions.data(), 0, BELTRAMI_F64, 0};
    }
    if (!kept.empty()) mesh.kept_pages = {kept.data(), 0, BELTRAMI_U64, 0};
    if (!labels.empty()) mesh.page_labels = {labels.data(), 0, BELTRAMI_U64, 0};
    return mesh;
  }
};

beltrami_status pack(const Context& context, const std::vector<beltrami_uv_mesh>& meshes) {
  std::vector<const beltrami_uv_mesh*> pointers;
  for (const beltrami_uv_mesh& mesh : meshes) pointers.push_back(&mesh);
  return beltrami_pack(context.get(), pointers.data(), pointers.size(), nullptr, nullptr);
}

Uvs packed_uvs(const Context& context, std::uint64_t mesh, std::size_t count) {
  Uvs uvs(count);
  EXPECT_EQ(beltrami_get_packed_uvs(context.get(), mesh, uvs.data(), BELTRAMI_F64, 0), BELTRAMI_OK)
      << message(context);
  return uvs;
}

double area(const Uvs& uvs, const std::array<std::uint32_t, 3>& face) {
  const auto &a = uvs[face[0]], &b = uvs[face[1]], &c = uvs[face[2]];
  return 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
}

TEST(AbiPacking, AnAtlasLiesOnAPage) {
  const TriangleList mesh = meshes::cube();
  const Context context = with_six_charts();
  auto none = sized<beltrami_packing>();
  EXPECT_EQ(beltrami_get_packing(context.get(), &none), BELTRAMI_E_INVALID_STATE);
  const beltrami_surface surface = surface_view(mesh);
  ASSERT_EQ(beltrami_unwrap(context.get(), &surface, nullptr, nullptr), BELTRAMI_OK);
  const beltrami_packing packing = packing_of(context);
  EXPECT_EQ(packing.charts, 6u);
  EXPECT_EQ(packing.pages, 1u);
  EXPECT_EQ(packing.resolution, 1024u);
  EXPECT_GE(packing.margin, 2);
  auto atlas = sized<beltrami_atlas>();
  ASSERT_EQ(beltrami_get_atlas(context.get(), &atlas), BELTRAMI_OK);
  EXPECT_EQ(atlas.pages, 1u);
  EXPECT_EQ(atlas.utilisation, packing.utilisation);
  EXPECT_NEAR(atlas.symmetric_dirichlet, 2, 1e-9);
  const double side = packing.texels_per_unit / 1024;
  EXPECT_NEAR(packing.utilisation, 6 * side * side, 1e-9);
  double share = 0;
  ASSERT_EQ(beltrami_get_page_utilisations(context.get(), &share, BELTRAMI_F64, 0), BELTRAMI_OK);
  EXPECT_EQ(share, packing.utilisation);
  auto chart = sized<beltrami_chart>();
  ASSERT_EQ(beltrami_get_chart(context.get(), 3, &chart), BELTRAMI_OK);
  EXPECT_EQ(chart.page, 0u);
  EXPECT_GE(chart.box[0], 1 / 1024.0);
  EXPECT_LE(chart.box[3], 1 - 1 / 1024.0);
}

TEST(AbiPacking, PagesAreToldForEveryCorner) {
  const TriangleList mesh = meshes::cube();
  const Context context = with_six_charts();
  ASSERT_EQ(beltrami_set_float(context.get(), BELTRAMI_OPTION_TEXELS_PER_UNIT, 700), BELTRAMI_OK);
  const beltrami_surface surface = surface_view(mesh);
  ASSERT_EQ(beltrami_unwrap(context.get(), &surface, nullptr, nullptr), BELTRAMI_OK);
  EXPECT_EQ(packing_of(context).pages, 6u);
  std::vector<std::uint32_t> of_charts(6), of_corners(36), charts(12);
  ASSERT_EQ(beltrami_get_chart_pages(context.get(), of_charts.data(), BELTRAMI_U32, 0),
            BELTRAMI_OK);
  ASSERT_EQ(beltrami_get_corner_pages(context.get(), of_corners.data(), BELTRAMI_U32, 0),
            BELTRAMI_OK);
  ASSERT_EQ(beltrami_get_face_charts(context.get(), charts.data(), BELTRAMI_U32, 0), BELTRAMI_OK);
  for (std::size_t c = 0; c < 36; ++c) EXPECT_EQ(of_corners[c], of_charts[charts[c / 3]]);
  Uvs uvs(36);
  ASSERT_EQ(beltrami_get_corner_uvs(context.get(), uvs.data(), BELTRAMI_F64, 0), BELTRAMI_OK);
  for (const auto& uv : uvs) {
    for (const double x : uv) EXPECT_TRUE(x >= 0 && x <= 1) << x;
  }
  for (const std::int32_t type : {BELTRAMI_F32, BELTRAMI_F64}) {
    auto certificate = sized<beltrami_atlas_certificate>();
    ASSERT_EQ(beltrami_get_packing_certificate(context.get(), type, &certificate), BELTRAMI_OK);
    EXPECT_EQ(certificate.injective, 1);
    EXPECT_EQ(certificate.positive, 12u);
  }

  ASSERT_EQ(beltrami_set_int(context.get(), BELTRAMI_OPTION_MAX_PAGES, 2), BELTRAMI_OK);
  EXPECT_EQ(beltrami_unwrap(context.get(), &surface, nullptr, nullptr), BELTRAMI_E_NO_ROOM);
  EXPECT_FALSE(message(context).empty());
  EXPECT_EQ(packing_of(context).pages, 6u) << "the old result stays";
}

TEST(AbiPacking, OptionsOfPagesWantPages) {
  const TriangleList mesh = meshes::cube();
  const Context context = create();
  set_option(context, BELTRAMI_OPTION_PACK, BELTRAMI_PACK_NONE);
  set_option(context, BELTRAMI_OPTION_RESOLUTION, 64);
  const beltrami_surface surface = surface_view(mesh);
  EXPECT_EQ(beltrami_unwrap(context.get(), &surface, nullptr, nullptr),
            BELTRAMI_E_INVALID_ARGUMENT);
  EXPECT_NE(message(context).find("resolution=64 has no effect with pack=none"), std::string::npos)
      << message(context);
  set_option(context, BELTRAMI_OPTION_RESOLUTION, 1024);
  ASSERT_EQ(beltrami_unwrap(context.get(), &surface, nullptr, nullptr), BELTRAMI_OK);
  auto atlas = sized<beltrami_atlas>();
  ASSERT_EQ(beltrami_get_atlas(context.get(), &atlas), BELTRAMI_OK);
  EXPECT_EQ(atlas.pages, 0u);
  auto packing = sized<beltrami_packing>();
  EXPECT_EQ(beltrami_get_packing(context.get(), &packing), BELTRAMI_E_INVALID_STATE);
}

TEST(AbiPacking, SplitsChartsAtAPrice) {
  TriangleList mesh = meshes::grid(40, 2);
  for (Vec3& p : mesh.positions) p.x() *= 20;
  const Context context = create();
  const beltrami_surface surface = surface_view(mesh);
  ASSERT_EQ(beltrami_set_float(context.get(), BELTRAMI_OPTION_FILL_WEIGHT, 0), BELTRAMI_OK);
  ASSERT_EQ(beltrami_unwrap(context.get(), &surface, nullptr, nullptr), BELTRAMI_OK);
  const beltrami_packing whole = packing_of(context);
  EXPECT_EQ(whole.splits, 0u);
  EXPECT_EQ(whole.split_length, 0);
  EXPECT_EQ(whole.unsplit_utilisation, whole.utilisation);
  ASSERT_EQ(beltrami_set_float(context.get(), BELTRAMI_OPTION_FILL_WEIGHT, 20), BELTRAMI_OK);
  ASSERT_EQ(beltrami_unwrap(context.get(), &surface, nullptr, nullptr), BELTRAMI_OK);
  const beltrami_packing packing = packing_of(context);
  EXPECT_GT(packing.splits, 0u);
  EXPECT_EQ(packing.charts, 1 + packing.splits);
  EXPECT_NEAR(packing.unsplit_utilisation, whole.utilisation, 1e-9);
  EXPECT_GE(20 * (packing.utilisation - packing.unsplit_utilisation), packing.split_length);
  auto atlas = sized<beltrami_atlas>();
  ASSERT_EQ(beltrami_get_atlas(context.get(), &atlas), BELTRAMI_OK);
  EXPECT_NEAR(atlas.seam_length / std::sqrt(atlas.area), packing.split_length, 1e-9);
  EXPECT_GT(atlas.seams, 0u);

  const auto refused = [&](std::int32_t key, std::int64_t value, const char* where) {
    set_option(context, key, value);
    EXPECT_EQ(beltrami_unwrap(context.get(), &surface, nullptr, nullptr),
              BELTRAMI_E_INVALID_ARGUMENT);
    EXPECT_NE(message(context).find("fill-weight=20 has no effect with " + std::string(where)),
              std::string::npos)
        << message(context);
  };
  refused(BELTRAMI_OPTION_PACK, BELTRAMI_PACK_NONE, "pack=none");
  set_option(context, BELTRAMI_OPTION_PACK, BELTRAMI_PACK_PAGES);
  ASSERT_EQ(beltrami_set_float(context.get(), BELTRAMI_OPTION_TEXELS_PER_UNIT, 8), BELTRAMI_OK);
  refused(BELTRAMI_OPTION_MAX_PAGES, 9, "texels-per-unit=8");
}

/// A bar of square section that is bent twice: a U.
TriangleList bent_bar(Index length) {
  TriangleList mesh;
  std::map<std::array<Index, 3>, Index> numbers;
  const auto vertex = [&](Index x, Index y, Index z) {
    const auto [found, is_new] = numbers.try_emplace({x, y, z}, size_of(mesh.positions));
    if (is_new) mesh.positions.emplace_back(x, y, z);
    return found->second;
  };
  const auto quad = [&](std::array<Index, 4> v) {
    mesh.faces.push_back({v[0], v[1], v[2]});
    mesh.faces.push_back({v[0], v[2], v[3]});
  };
  const auto is_full = [&](Index x, Index y) {
    const Index last = length - 1;
    if (x < 0 || y < 0 || x > last || y > last) return false;
    return x == 0 || y == 0 || x == last;
  };
  for (Index x = 0; x < length; ++x) {
    for (Index y = 0; y < length; ++y) {
      if (!is_full(x, y)) continue;
      const auto side = [&](Index ax, Index ay, Index bx, Index by) {
        quad({vertex(ax, ay, 0), vertex(bx, by, 0), vertex(bx, by, 1), vertex(ax, ay, 1)});
      };
      quad({vertex(x, y, 1), vertex(x + 1, y, 1), vertex(x + 1, y + 1, 1), vertex(x, y + 1, 1)});
      quad({vertex(x, y, 0), vertex(x, y + 1, 0), vertex(x + 1, y + 1, 0), vertex(x + 1, y, 0)});
      if (!is_full(x, y - 1)) side(x, y, x + 1, y);
      if (!is_full(x + 1, y)) side(x + 1, y, x + 1, y + 1);
      if (!is_full(x, y + 1)) side(x + 1, y + 1, x, y + 1);
      if (!is_full(x - 1, y)) side(x, y + 1, x, y);
    }
  }
  return mesh;
}

TEST(AbiPacking, HardSurfacesAreSplitForTheirPageToo) {
  const TriangleList mesh = bent_bar(20);
  const Context context = create();
  const beltrami_surface surface = surface_view(mesh);
  set_option(context, BELTRAMI_OPTION_PRESET, BELTRAMI_PRESET_HARD_SURFACE);
  ASSERT_EQ(beltrami_unwrap(context.get(), &surface, nullptr, nullptr), BELTRAMI_OK)
      << message(context);
  auto atlas = sized<beltrami_atlas>();
  ASSERT_EQ(beltrami_get_atlas(context.get(), &atlas), BELTRAMI_OK);
  EXPECT_LT(atlas.symmetric_dirichlet, 2 + 1e-9);  // the parts are as flat as the whole
  const beltrami_packing packing = packing_of(context);
  EXPECT_GT(packing.splits, 0U);
  EXPECT_GT(packing.utilisation, 2 * packing.unsplit_utilisation);
}

TEST(AbiPacking, PacksSeveralMeshes) {
  const Confetti one(5), other(7);
  const Context context = create();
  ASSERT_EQ(pack(context, {one.view(), other.view()}), BELTRAMI_OK) << message(context);
  const beltrami_packing packing = packing_of(context);
  EXPECT_EQ(packing.charts, 12u);
  EXPECT_GE(packing.margin, 2);
  const Uvs first = packed_uvs(context, 0, 15), second = packed_uvs(context, 1, 21);
  double sum = 0;
  for (const auto& face : one.faces) sum += area(first, face);
  for (const auto& face : other.faces) sum += area(second, face);
  EXPECT_NEAR(sum, packing.utilisation, 1e-12);
  const double scale = packing.texels_per_unit / 1024;
  EXPECT_NEAR(area(first, one.faces[2]), scale * scale * area(one.uvs, one.faces[2]), 1e-12);
  std::vector<std::uint64_t> charts(7);
  ASSERT_EQ(beltrami_get_packed_charts(context.get(), 1, charts.data(), BELTRAMI_U64, 0),
            BELTRAMI_OK);
  EXPECT_EQ(charts.front(), 5u);
  EXPECT_EQ(charts.back(), 11u);
  EXPECT_EQ(beltrami_get_packed_charts(context.get(), 2, charts.data(), BELTRAMI_U64, 0),
            BELTRAMI_E_INVALID_ARGUMENT);
}

TEST(AbiPacking, EvensDensitiesWithPositions) {
  const Confetti small(2, 1), large(2, 3);
  const Context context = create();
  ASSERT_EQ(pack(context, {small.view(true), large.view(true)}), BELTRAMI_OK) << message(context);
  const Uvs first = packed_uvs(context, 0, 6), second = packed_uvs(context, 1, 6);
  EXPECT_NEAR(area(second, large.faces[0]) / area(first, small.faces[0]), 9, 1e-9);
}

TEST(AbiPacking, GivesTheSameBitsOnAnyNumberOfThreads) {
  const Confetti mesh(30);
  std::vector<Uvs> results;
  for (const std::uint64_t threads : {1, 2}) {
    const Context context = create();
    set_option(context, BELTRAMI_OPTION_THREADS, threads);
    ASSERT_EQ(pack(context, {mesh.view()}), BELTRAMI_OK);
    results.push_back(packed_uvs(context, 0, 90));
  }
  EXPECT_TRUE(same_bits(results[0], results[1]));
}

TEST(AbiPacking, LeavesWhatStays) {
  Confetti mesh(6);
  const Context context = create();
  ASSERT_EQ(beltrami_set_float(context.get(), BELTRAMI_OPTION_TEXELS_PER_UNIT, 100), BELTRAMI_OK);
  ASSERT_EQ(pack(context, {mesh.view()}), BELTRAMI_OK) << message(context);
  mesh.uvs = packed_uvs(context, 0, 18);
  ASSERT_EQ(beltrami_set_float(context.get(), BELTRAMI_OPTION_TEXELS_PER_UNIT, 0), BELTRAMI_OK);
  mesh.kept = {0, 0, 0, 0, 0, BELTRAMI_NO_ELEMENT};
  const Confetti another(3, 100.0 / 1024);
  ASSERT_EQ(pack(context, {mesh.view()}), BELTRAMI_OK) << message(context);
  const Uvs after = packed_uvs(context, 0, 18);
  for (std::size_t v = 0; v < 15; ++v) EXPECT_EQ(after[v], mesh.uvs[v]);
  EXPECT_GE(packing_of(context).margin, 2);
}

TEST(AbiPacking, LabelsHavePagesOfTheirOwn) {
  Confetti one(4), other(2);
  one.labels = {9, 4, 9, 4};
  other.labels = {BELTRAMI_NO_ELEMENT, 9};
  const Context context = create();
  ASSERT_EQ(pack(context, {one.view(), other.view()}), BELTRAMI_OK) << message(context);
  EXPECT_EQ(packing_of(context).pages, 3u) << "of 4, 9, and the greatest number";
  std::vector<std::uint32_t> pages(6);
  ASSERT_EQ(beltrami_get_chart_pages(context.get(), pages.data(), BELTRAMI_U32, 0), BELTRAMI_OK);
  EXPECT_EQ(pages, (std::vector<std::uint32_t>{1, 0, 1, 0, 2, 1}));
  EXPECT_EQ(pack(context, {one.view(), Confetti(2).view()}), BELTRAMI_E_INVALID_ARGUMENT)
      << "all meshes have labels, or none";
  one.kept.assign(4, 0);
  EXPECT_EQ(pack(context, {one.view()}), BELTRAMI_E_INVALID_ARGUMENT);
  EXPECT_NE(message(context).find("charts that stay"), std::string::npos);
}

TEST(AbiPacking, SurfacesOfOneLabelShareItsPages) {
  const TriangleList mesh = meshes::cube();
  std::vector<std::uint32_t> labels(12, 5);
  for (std::size_t f = 0; f < 6; ++f) labels[f] = 8;
  beltrami_surface surface = surface_view(mesh), whole = surface_view(mesh);
  const std::vector<std::uint32_t> one_label(12, 8);
  surface.face_labels = {labels.data(), 0, BELTRAMI_U32, 0};
  whole.face_labels = {one_label.data(), 0, BELTRAMI_U32, 0};
  const Context context = create();
  ASSERT_EQ(beltrami_set_int(context.get(), BELTRAMI_OPTION_LABEL_PAGES, 1), BELTRAMI_OK);
  const std::array<const beltrami_surface*, 2> both = {&surface, &whole};
  ASSERT_EQ(beltrami_unwrap_surfaces(context.get(), both.data(), 2, nullptr, nullptr), BELTRAMI_OK)
      << message(context);
  EXPECT_EQ(packing_of(context).pages, 2u);
  std::vector<std::uint32_t> pages(72);
  ASSERT_EQ(beltrami_get_corner_pages(context.get(), pages.data(), BELTRAMI_U32, 0), BELTRAMI_OK);
  for (std::size_t c = 0; c < 72; ++c) EXPECT_EQ(pages[c], c < 18 || c >= 36 ? 1u : 0u) << c;
  surface.face_labels = {};
  EXPECT_EQ(beltrami_unwrap(context.get(), &surface, nullptr, nullptr), BELTRAMI_E_INVALID_ARGUMENT)
      << "there are no labels";
  ASSERT_EQ(beltrami_set_int(context.get(), BELTRAMI_OPTION_STACK, BELTRAMI_STACK_COPIES),
            BELTRAMI_OK);
  EXPECT_EQ(beltrami_unwrap(context.get(), &whole, nullptr, nullptr), BELTRAMI_E_INVALID_ARGUMENT);
}

TEST(AbiPacking, SaysWhatIsFlipped) {
  Confetti mesh(4);
  std::swap(mesh.faces[2][0], mesh.faces[2][1]);
  const Context context = create();
  EXPECT_EQ(pack(context, {mesh.view()}), BELTRAMI_NOT_INJECTIVE);
  auto certificate = sized<beltrami_atlas_certificate>();
  ASSERT_EQ(beltrami_get_packing_certificate(context.get(), BELTRAMI_F64, &certificate),
            BELTRAMI_OK);
  EXPECT_EQ(certificate.negative, 1u);
  EXPECT_EQ(certificate.first_bad_face, 2u);
  EXPECT_EQ(packing_of(context).status, BELTRAMI_NOT_INJECTIVE);
}

TEST(AbiPacking, RefusesWhatItCannotRead) {
  const Context context = create();
  EXPECT_EQ(beltrami_pack(context.get(), nullptr, 1, nullptr, nullptr),
            BELTRAMI_E_INVALID_ARGUMENT);
  EXPECT_EQ(pack(context, {}), BELTRAMI_E_INVALID_ARGUMENT);
  const Confetti good(3);
  Confetti far = good;
  far.faces[1][2] = 9;
  EXPECT_EQ(pack(context, {good.view(), far.view()}), BELTRAMI_E_INDEX_OUT_OF_RANGE);
  EXPECT_EQ(beltrami_error_element(context.get()), 1u);
  EXPECT_NE(message(context).find("face 1 of mesh 1"), std::string::npos) << message(context);
  Confetti odd = good;
  odd.uvs[4][1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(pack(context, {odd.view()}), BELTRAMI_E_NON_FINITE);
  EXPECT_EQ(beltrami_error_element(context.get()), 4u);
  EXPECT_EQ(pack(context, {good.view(), good.view(true)}), BELTRAMI_E_INVALID_ARGUMENT);
  Confetti apart = good;
  apart.kept = {0, 0, 0};
  EXPECT_EQ(pack(context, {apart.view()}), BELTRAMI_E_INVALID_ARGUMENT) << "beyond its page";
  EXPECT_EQ(beltrami_error_element(context.get()), 1u);
  Confetti inside(1);
  inside.kept = {0};
  EXPECT_EQ(pack(context, {inside.view(), apart.view()}), BELTRAMI_E_INVALID_ARGUMENT);
  EXPECT_EQ(beltrami_error_element(context.get()), 1u) << "counted in its mesh";
  EXPECT_NE(message(context).find("face 1 of mesh 1"), std::string::npos) << message(context);
  auto empty = good.view();
  empty.face_count = 0;
  EXPECT_EQ(pack(context, {empty}), BELTRAMI_E_EMPTY);
  set_option(context, BELTRAMI_OPTION_RESOLUTION, 8);
  EXPECT_EQ(pack(context, {Confetti(100).view()}), BELTRAMI_E_NO_ROOM) << message(context);
}

// The density of a chart a million million times as long as wide came out as 0, and what was packed
// at it was read.
TEST(AbiPacking, TakesChartsThatAreAllLength) {
  for (const double length : {1e8, 1e16, 1e99}) {
    Confetti mesh(2);
    mesh.uvs[1][0] = length;
    const Context context = create();
    set_option(context, BELTRAMI_OPTION_RESOLUTION, 64);
    EXPECT_GE(pack(context, {mesh.view()}), BELTRAMI_OK) << length << message(context);
    EXPECT_GT(packing_of(context).texels_per_unit, 0) << length;
  }
}

TEST(AbiPacking, RefusesWhatHasNoArea) {
  const Context context = create();
  Confetti mesh(2), in_space(2, 1e150);
  mesh.uvs[4] = {0, -1e194};
  EXPECT_EQ(pack(context, {mesh.view()}), BELTRAMI_E_NON_FINITE);
  EXPECT_EQ(beltrami_error_element(context.get()), 4u);
  EXPECT_EQ(pack(context, {in_space.view(true)}), BELTRAMI_E_NON_FINITE);
}

TEST(AbiPacking, DrawsMasks) {
  const Confetti mesh(4);
  const Context context = create();
  set_option(context, BELTRAMI_OPTION_RESOLUTION, 64);
  ASSERT_EQ(pack(context, {mesh.view()}), BELTRAMI_OK);
  std::vector<std::uint8_t> mask(64 * 80, 7);
  ASSERT_EQ(beltrami_get_page_mask(context.get(), 0, mask.data(), 80), BELTRAMI_OK);
  std::array<int, 3> counts{};
  for (std::size_t row = 0; row < 64; ++row) {
    for (std::size_t column = 0; column < 64; ++column) ++counts.at(mask[80 * row + column]);
    EXPECT_EQ(mask[80 * row + 64], 7) << "behind the row";
  }
  const double share = packing_of(context).utilisation;
  EXPECT_GT(counts[BELTRAMI_TEXEL_COVERED], 64 * 64 * share);
  EXPECT_GT(counts[BELTRAMI_TEXEL_GUTTER], 0);
  EXPECT_EQ(beltrami_get_page_mask(context.get(), 1, mask.data(), 0), BELTRAMI_E_INVALID_ARGUMENT);
  EXPECT_EQ(beltrami_get_page_mask(context.get(), 0, mask.data(), 63), BELTRAMI_E_INVALID_ARGUMENT);
}

}  // namespace
}  // namespace beltrami::host
