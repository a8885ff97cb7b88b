// Atlases on pages of a texture: apart by the margin, never mirrored, whatever the unit of the
// surface and the number of threads.
#include "atlas/pages.h"
#include "atlas/assemble.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "atlas/margin.h"
#include "atlas/pack_uvs.h"
#include "atlas/page_mask.h"
#include "atlas/types.h"
#include "base/error.h"
#include "chart/flattening.h"
#include "support/atlases.h"
#include "support/cuts.h"
#include "support/meshes.h"
#include "support/surfaces.h"

namespace beltrami {
namespace {

using atlases::expect_same_bits;
using atlases::expect_sound;
using atlases::unwrapped;
using atlases::zoo;
using meshes::TriangleList;

AtlasOptions packed(const PackOptions& pack = {}) {
  AtlasOptions options;
  options.pack = pack;
  return options;
}

PackOptions small_page() {
  PackOptions pack;
  pack.resolution = 256;
  return pack;
}

double area(const std::vector<Vec2>& uvs, const Triangle& face) {
  const Vec2 p = uvs[face[1]] - uvs[face[0]], q = uvs[face[2]] - uvs[face[0]];
  return 0.5 * (p.x() * q.y() - p.y() * q.x());
}

double area(const std::vector<Vec2>& uvs, const std::vector<Triangle>& faces) {
  double sum = 0;
  for (const Triangle& face : faces) sum += area(uvs, face);
  return sum;
}

/// The margin by all pairs of corners and edges, of charts of one page.
double slow_margin(const UvMesh& mesh, const PackedUvs& packed) {
  const auto point = [&](Index v) -> Vec2 {
    return packed.pages.resolution * (packed.uvs[v] - tile_of(packed.page_of_uv[v]));
  };
  double least = 1e300;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    for (const Index v : mesh.faces[f]) {
      const Vec2 p = point(v);
      least = std::min({least, 2 * p.minCoeff(), 2 * (packed.pages.resolution - p.maxCoeff())});
      for (std::size_t g = 0; g < mesh.faces.size(); ++g) {
        if (packed.chart_of_face[f] == packed.chart_of_face[g]) continue;
        if (packed.page_of_uv[v] != packed.page_of_uv[mesh.faces[g][0]]) continue;
        for (int k = 0; k < 3; ++k) {
          const Vec2 a = point(mesh.faces[g][k]), along = point(mesh.faces[g][(k + 1) % 3]) - a;
          const double t = std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
          least = std::min(least, (p - a - t * along).norm());
        }
      }
    }
  }
  return least;
}

/// Triangles of several sizes, each by itself.
UvMesh confetti(Index count) {
  UvMesh mesh;
  for (Index i = 0; i < count; ++i) {
    const double size = 1 + 0.1 * (i % 7), x = 3 * i;
    for (const Vec2& w : {Vec2(x, 0), Vec2(x + size, 0.2), Vec2(x + 0.3, size)}) {
      mesh.uvs.push_back(w);
    }
    mesh.faces.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

TEST(Pages, HoldAnAtlasApartByItsMargin) {
  const TriangleList mesh = zoo();
  const Atlas atlas = unwrapped(mesh, packed(small_page()));
  expect_sound(mesh, atlas);
  ASSERT_TRUE(atlas.pages);
  EXPECT_EQ(atlas.pages->count, 1);
  EXPECT_GE(atlas.pages->margin, 2);
  EXPECT_EQ(atlas.utilisation, atlas.pages->utilisation);
  EXPECT_GT(atlas.utilisation, 0.2);
  for (const Vec2& w : atlas.uvs) {
    EXPECT_GE(w.minCoeff(), 0);
    EXPECT_LE(w.maxCoeff(), 1);
  }
}

TEST(Pages, LeaveEnergiesAtTheScaleOfTheSurface) {
  const TriangleList mesh = zoo();
  const Atlas apart = unwrapped(mesh), atlas = unwrapped(mesh, packed(small_page()));
  EXPECT_NEAR(atlas.energy.symmetric_dirichlet, apart.energy.symmetric_dirichlet, 1e-6);
  EXPECT_NEAR(atlas.energy.p99, apart.energy.p99, 1e-6);
  EXPECT_EQ(atlas.seam_over_root_area, apart.seam_over_root_area);
  // One density for all: areas on the pages are those of the maps.
  const double scale = atlas.pages->texels_per_unit / atlas.pages->resolution;
  EXPECT_NEAR(area(atlas.uvs, oriented_faces(atlas)),
              scale * scale * area(apart.uvs, oriented_faces(apart)), 1e-6);
}

TEST(Pages, GiveTheSameBitsOnAnyNumberOfThreads) {
  const TriangleList mesh = zoo();
  const AtlasOptions options = packed(small_page());
  expect_same_bits(unwrapped(mesh, options), unwrapped(mesh, options, 2));
}

TEST(Pages, DoNotDependOnTheUnit) {
  const TriangleList mesh = zoo();
  const Atlas atlas = unwrapped(mesh, packed(small_page()));
  for (const int exponent : {-300, -3, 4, 300}) {
    TriangleList scaled = mesh;
    for (Vec3& p : scaled.positions) {
      for (double& x : p) x = std::ldexp(x, exponent);
    }
    const Atlas other = unwrapped(scaled, packed(small_page()));
    EXPECT_EQ(atlas.uvs, other.uvs);
    EXPECT_EQ(atlas.pages->texels_per_unit, std::ldexp(other.pages->texels_per_unit, exponent));
  }
}

TEST(Pages, AreAsManyAsADensityTakes) {
  const TriangleList mesh = meshes::soup(meshes::octahedron());
  PackOptions pack = small_page();
  const auto on_pages = [&] {
    AtlasOptions options = packed(pack);
    options.admit.weld_distance.reset();  // a chart for each face
    return unwrapped(mesh, options);
  };
  const double density = on_pages().pages->texels_per_unit;
  pack.texels_per_unit = 1.3 * density;
  EXPECT_THROW(on_pages(), Error);
  pack.max_pages = 100;
  const Atlas atlas = on_pages();
  expect_sound(mesh, atlas);
  EXPECT_GT(atlas.pages->count, 1);
  EXPECT_NEAR(atlas.pages->texels_per_unit, pack.texels_per_unit, 1e-9 * density);
  EXPECT_GE(atlas.pages->margin, 2);
  for (std::size_t v = 0; v < atlas.uvs.size(); ++v) {
    const Vec2 on_page = atlas.uvs[v] - tile_of(atlas.page_of_uv[v]);
    EXPECT_GE(on_page.minCoeff(), 0);
    EXPECT_LE(on_page.maxCoeff(), 1);
    if (atlas.page_of_uv[v] == 0) continue;
    // So that single precision holds it with the page's corner and without.
    EXPECT_EQ(Vec2(on_page.cast<float>().cast<double>()), on_page);
  }
}

TEST(Pages, TakeChartsInPartsThatAreLargerThanThem) {
  const TriangleList mesh = disks::blob(3);
  PackOptions pack = small_page();
  const auto on_pages = [&](int most_charts) {
    AtlasOptions options = packed(pack);
    options.target.emplace();
    options.target->max_charts = most_charts;
    return unwrapped(mesh, options);
  };
  const Atlas one = on_pages(0);
  ASSERT_EQ(one.pages->count, 1);
  pack.texels_per_unit = 2 * one.pages->texels_per_unit;
  pack.max_pages = 100;
  const Atlas atlas = on_pages(0);
  expect_sound(mesh, atlas);
  EXPECT_GT(atlas.pages->count, 3);  // four times the area
  EXPECT_GT(atlas.charts.size(), one.charts.size());
  EXPECT_NEAR(atlas.pages->texels_per_unit, pack.texels_per_unit, 1e-9 * pack.texels_per_unit);
  EXPECT_GE(atlas.pages->margin, 2);
  // Where their number is bound, and where no page holds a face, there is no way.
  EXPECT_THROW(on_pages(1), Error);
  pack.texels_per_unit *= 1000;
  EXPECT_THROW(on_pages(0), Error);
}

TEST(Pages, HoldSinglePrecision) {
  const TriangleList mesh = zoo();
  AtlasOptions options = packed(small_page());
  options.float32 = true;
  const Atlas atlas = unwrapped(mesh, options);
  expect_sound(mesh, atlas);
  EXPECT_GE(atlas.pages->margin, 2);
  for (const Vec2& w : atlas.uvs) EXPECT_EQ(Vec2(w.cast<float>().cast<double>()), w);
}

TEST(PackUvs, KeepsChartsApartAndUnmirrored) {
  const UvMesh mesh = confetti(40);
  const PackedUvs result = pack_uvs(mesh, small_page(), false, Work(1));
  EXPECT_EQ(result.outcome, Outcome::kOk);
  EXPECT_TRUE(result.certificate.injective());
  EXPECT_EQ(result.pages.page_of_chart.size(), 40);
  EXPECT_GE(result.pages.margin, 2);
  EXPECT_NEAR(result.pages.margin, slow_margin(mesh, result), 1e-9);
  const double scale = result.pages.texels_per_unit / 256;
  for (const Triangle& face : mesh.faces) {
    EXPECT_NEAR(area(result.uvs, face), scale * scale * area(mesh.uvs, face), 1e-12);
  }
  EXPECT_NEAR(result.pages.utilisation, area(result.uvs, mesh.faces), 1e-12);
  EXPECT_EQ(result.uvs, pack_uvs(mesh, small_page(), false, Work(2)).uvs);
}

TEST(PackUvs, EvensDensitiesOut) {
  UvMesh mesh = confetti(6);
  mesh.areas = {1, 2, 3, 4, 5, 6};
  const PackedUvs result = pack_uvs(mesh, small_page(), false, Work(1));
  const double first = area(result.uvs, mesh.faces[0]);
  for (Index f = 0; f < 6; ++f) {
    EXPECT_NEAR(area(result.uvs, mesh.faces[f]) / first, mesh.areas[f], 1e-9);
  }
}

TEST(PackUvs, LeavesChartsThatStay) {
  UvMesh mesh = confetti(8);
  PackOptions pack = small_page();
  pack.texels_per_unit = 30;
  const PackedUvs before = pack_uvs(mesh, pack, false, Work(1));
  mesh.uvs = before.uvs;
  mesh.kept_page.assign(8, 0);
  mesh.kept_page[5] = kNone;
  pack.texels_per_unit = 0;
  const PackedUvs after = pack_uvs(mesh, pack, false, Work(1));
  EXPECT_TRUE(after.certificate.injective());
  EXPECT_GE(after.pages.margin, 2);
  for (std::size_t v = 0; v < mesh.uvs.size(); ++v) {
    if (v / 3 == 5) continue;
    EXPECT_EQ(after.uvs[v], before.uvs[v]);
  }
  EXPECT_NEAR(area(after.uvs, mesh.faces[5]), area(before.uvs, mesh.faces[5]), 1e-12);

  mesh.uvs[0].x() = -1;
  EXPECT_THROW(pack_uvs(mesh, pack, false, Work(1)), Error);
}

TEST(PackUvs, SaysWhatCameFolded) {
  UvMesh mesh = confetti(3);
  std::swap(mesh.faces[1][0], mesh.faces[1][1]);
  const PackedUvs result = pack_uvs(mesh, small_page(), false, Work(1));
  EXPECT_EQ(result.outcome, Outcome::kNotInjective);
  EXPECT_EQ(result.certificate.orientations.negative, 1);
  EXPECT_EQ(result.certificate.overlaps.faces, 0);
  EXPECT_LT(area(result.uvs, mesh.faces[1]), 0);
  EXPECT_GE(result.pages.margin, 2);
}

TEST(PackUvs, FacesWithoutAreaAreNoCharts) {
  const UvMesh alone = confetti(12);
  const PackedUvs expected = pack_uvs(alone, small_page(), false, Work(1));
  // Before the others a face that is a point, and after them one that is a line.
  UvMesh mesh = alone;
  const Index first = size_of(mesh.uvs);
  mesh.uvs.insert(mesh.uvs.end(), {{0, 0}, {0, 0}, {0, 0}, {7, 7}, {8, 8}, {9, 9}});
  mesh.faces.insert(mesh.faces.begin(), {first, first + 1, first + 2});
  mesh.faces.push_back({first + 3, first + 4, first + 5});
  mesh.excepted.assign(mesh.faces.size(), false);
  mesh.excepted.front() = mesh.excepted.back() = true;
  const PackedUvs result = pack_uvs(mesh, small_page(), false, Work(1));
  EXPECT_EQ(result.outcome, Outcome::kOk);
  EXPECT_EQ(result.pages.page_of_chart.size(), 12);
  EXPECT_EQ(result.pages.margin, expected.pages.margin);
  EXPECT_EQ(result.pages.texels_per_unit, expected.pages.texels_per_unit);
  for (Index v = 0; v < size_of(mesh.uvs); ++v) {
    EXPECT_EQ(result.uvs[v], expected.uvs[v < first ? v : 0]);
  }
}

TEST(PackUvs, FacesWithoutAreaTieNoChartsTogether) {
  UvMesh mesh = confetti(2);
  mesh.faces.push_back({0, 0, 3});
  mesh.excepted = {false, false, true};
  const PackedUvs result = pack_uvs(mesh, small_page(), false, Work(1));
  EXPECT_EQ(result.outcome, Outcome::kOk);
  EXPECT_EQ(result.uvs, pack_uvs(confetti(2), small_page(), false, Work(1)).uvs);
  EXPECT_EQ(result.chart_of_face, (std::vector<Index>{0, 1, 0}));
  mesh.excepted.clear();
  EXPECT_EQ(pack_uvs(mesh, small_page(), false, Work(1)).pages.page_of_chart.size(), 1)
      << "one that may have an area on the surface does";
}

TEST(PackUvs, SaysThatThereAreNoCharts) {
  try {
    pack_uvs({.uvs = {{0.5, 0.5}}, .faces = {{0, 0, 0}}}, small_page(), false, Work(1));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::kZeroArea);
  }
}

TEST(PackUvs, SaysThatThereIsNoRoom) {
  PackOptions pack;
  pack.resolution = 16;
  try {
    pack_uvs(confetti(200), pack, false, Work(1));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::kNoRoom);
    EXPECT_NE(std::string(error.what()).find("margin"), std::string::npos) << error.what();
  }
}

TEST(LeastMargin, SeesCrossingsAndEdgesOfPages) {
  UvMesh mesh = confetti(2);
  for (Vec2& w : mesh.uvs) w = Vec2(0.1, 0.1) + 0.05 * w;
  const std::vector<Index> charts = {0, 1}, pages = {0, 0};
  const double margin = least_margin({mesh.faces, mesh.uvs, charts, pages, 100}, Work(1));
  EXPECT_NEAR(margin, 100 * 0.05 * std::sqrt(4.04), 1e-9);
  for (Vec2& w : mesh.uvs) w.x() -= 0.1;
  EXPECT_NEAR(least_margin({mesh.faces, mesh.uvs, charts, pages, 100}, Work(1)), 0, 1e-9);
  for (std::size_t v = 3; v < 6; ++v) mesh.uvs[v].x() -= 0.14;
  for (Vec2& w : mesh.uvs) w.x() += 0.2;
  EXPECT_EQ(least_margin({mesh.faces, mesh.uvs, charts, pages, 100}, Work(1)), 0);
  const std::vector<Index> apart = {0, 1};
  mesh.uvs[3].x() += 1;
  mesh.uvs[4].x() += 1;
  mesh.uvs[5].x() += 1;
  EXPECT_GT(least_margin({mesh.faces, mesh.uvs, charts, apart, 100}, Work(1)), 0);
}

TEST(PageMask, MarksWhatFacesMeetAndWhatIsNear) {
  UvMesh mesh;
  mesh.uvs = {{0.25, 0.25}, {0.5, 0.25}, {0.25, 0.5}};
  mesh.faces = {{0, 1, 2}};
  Pages pages;
  pages.count = 1;
  pages.resolution = 16;
  pages.asked_margin = 2;
  pages.page_of_chart = {0};
  const std::vector<Texel> texels = page_mask(mesh.faces, mesh.uvs, {0}, pages, 0);
  const auto at = [&](int column, int row) { return texels[16 * (15 - row) + column]; };
  EXPECT_EQ(at(4, 4), Texel::kCovered);
  EXPECT_EQ(at(7, 4), Texel::kCovered);
  EXPECT_EQ(at(4, 7), Texel::kCovered);
  EXPECT_EQ(at(8, 4), Texel::kGutter);
  EXPECT_EQ(at(2, 4), Texel::kGutter);
  EXPECT_EQ(at(1, 4), Texel::kFree);
  EXPECT_EQ(at(2, 2), Texel::kFree) << "its distance is that of a diagonal of 2";
  EXPECT_EQ(at(3, 3), Texel::kGutter);
  EXPECT_EQ(at(12, 12), Texel::kFree);
  EXPECT_EQ(std::count(texels.begin(), texels.end(), Texel::kCovered), 10);
}

}  // namespace
}  // namespace beltrami
