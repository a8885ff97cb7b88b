// Charts in the numbers that they are stored in: no face is lost where a file turns V over.
#include "atlas/round_chart.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "atlas/map_charts.h"
#include "atlas/pages.h"
#include "base/types.h"
#include "base/vectors.h"
#include "chart/flattening.h"
#include "exact/certificate.h"
#include "repair/rounding.h"
#include "support/disks.h"
#include "support/meshes.h"

namespace beltrami {
namespace {

/// A face of this height over its longest edge, between two that have a third of a page.
meshes::TriangleList sliver(double height) {
  return {{{0, 0, 0}, {1, 0, 0}, {0.5, height, 0}, {0.5, 1, 0}}, {{0, 1, 2}, {0, 2, 3}, {2, 1, 3}}};
}

/// Turned by `angle`, a third as large, and moved to `corner`.
std::vector<Vec2> placed(const DiskMesh& mesh, double angle, const Vec2& corner) {
  std::vector<Vec2> uvs = disks::flat_uvs(mesh);
  for (Vec2& w : uvs) {
    w = corner + Vec2(std::cos(angle) * w.x() - std::sin(angle) * w.y(),
                      std::sin(angle) * w.x() + std::cos(angle) * w.y()) /
                     3;
  }
  return uvs;
}

MappedChart map_of(const DiskMesh& mesh) {
  MappedChart map;
  map.uvs = disks::flat_uvs(mesh);
  return map;
}

bool injective(const DiskMesh& mesh, const std::vector<Vec2>& uvs) {
  return certify(mesh.faces, mesh.boundary, uvs, Work(1)).injective();
}

template <class Store>
bool stored_injective(const DiskMesh& mesh, std::vector<Vec2> uvs, const Store& store) {
  for (Vec2& w : uvs) w = {double{static_cast<float>(w.x())}, store(w.y())};
  return injective(mesh, uvs);
}

/// What files and hosts make of v.
double up(double v) {
  return double{static_cast<float>(v)};
}
double down(double v) {
  return -double{static_cast<float>(1 - v)};
}
double down_and_up(double v) {
  return double{1 - static_cast<float>(1 - v)};
}
double down_in_floats(double v) {
  return -double{1 - static_cast<float>(v)};
}

TEST(RoundChart, KeepsSliversWhicheverWayVIsStored) {
  int mended = 0;
  for (const double height : {1e-6, 1e-7, 1e-8, 1e-9}) {
    const DiskMesh mesh = disks::disk(sliver(height));
    for (int i = 0; i < 40; ++i) {
      const std::vector<Vec2> places = placed(mesh, 0.01 * i, {0.2 + 0.01 * i, 1e-3 + 1e-5 * i});
      for (const bool float32 : {false, true}) {
        MappedChart map = map_of(mesh);
        round_on_page(mesh, places, 0, float32, Work(1), map);
        EXPECT_EQ(map.outcome, Outcome::kOk);
        EXPECT_TRUE(injective(mesh, map.uvs));
        EXPECT_TRUE(stored_injective(mesh, map.uvs, up)) << height << " " << i;
        EXPECT_TRUE(stored_injective(mesh, map.uvs, down)) << height << " " << i;
        for (std::size_t v = 0; v < places.size(); ++v) {
          EXPECT_LT((map.uvs[v] - places[v]).norm(), 1e-4);
        }
        if (!float32) continue;
        EXPECT_TRUE(stored_injective(mesh, map.uvs, down_and_up));
        EXPECT_TRUE(stored_injective(mesh, map.uvs, down_in_floats));
      }
      std::vector<Vec2> nearest = places;
      for (Vec2& w : nearest) w = Numbers{.single = true}.nearest(w);
      mended += injective(mesh, nearest) && !stored_injective(mesh, places, down) ? 1 : 0;
    }
  }
  EXPECT_GT(mended, 10) << "faces that are lost where V points down alone";
}

TEST(RoundChart, KeepsDoublesWhereSinglePrecisionIsEnough) {
  const DiskMesh mesh = disks::disk(sliver(0.3));
  const std::vector<Vec2> places = placed(mesh, 1, {0.5, 0.01});
  MappedChart map = map_of(mesh);
  round_on_page(mesh, places, 0, false, Work(1), map);
  EXPECT_EQ(map.uvs, places);
}

TEST(RoundChart, RoundsToNumbersThatNoStoringRounds) {
  const DiskMesh mesh = disks::disk(sliver(0.3));
  for (const Index page : {0, 3, 9, 57, 990}) {
    std::vector<Vec2> places = placed(mesh, 1, {0.5, 0.01});
    for (Vec2& w : places) w += tile_of(page);
    for (const bool float32 : {false, true}) {
      if (page == 0 && !float32) continue;
      MappedChart map = map_of(mesh);
      round_on_page(mesh, places, page, float32, Work(1), map);
      EXPECT_EQ(map.outcome, Outcome::kOk);
      for (std::size_t v = 0; v < places.size(); ++v) {
        EXPECT_LE((map.uvs[v] - places[v]).cwiseAbs().maxCoeff(), step_of(page) / 2);
        const Vec2 on_page = map.uvs[v] - tile_of(page);
        for (const double x : {map.uvs[v].x(), map.uvs[v].y(), 1 - map.uvs[v].y(), on_page.x(),
                               on_page.y(), 1 - on_page.y()}) {
          EXPECT_EQ(double{static_cast<float>(x)}, x) << page;
        }
      }
    }
  }
}

TEST(RoundChart, DrawsLargerWhatIsTooSmallForAnySinglePrecision) {
  const DiskMesh mesh = disks::disk(meshes::grid(9, 9));
  for (const double size : {1e-7, 1e-9, 1e-12}) {
    std::vector<Vec2> places = disks::flat_uvs(mesh);
    for (Vec2& w : places) w = Vec2(0.5, 0.25) + size * w;
    for (const bool float32 : {false, true}) {
      MappedChart map = map_of(mesh);
      round_on_page(mesh, places, 0, float32, Work(1), map);
      EXPECT_EQ(map.outcome, Outcome::kOk);
      EXPECT_TRUE(injective(mesh, map.uvs)) << size;
      for (std::size_t v = 0; v < places.size(); ++v) {
        EXPECT_LT((map.uvs[v] - places[v]).norm(), 200 * step_of(0));
        EXPECT_EQ((Numbers{.step = step_of(0)}.nearest(map.uvs[v])), map.uvs[v]);
      }
    }
  }
}

TEST(RoundChart, LeavesWhatHasNoRoomForSuchADrawing) {
  const DiskMesh mesh = disks::disk(meshes::grid(99, 99));
  std::vector<Vec2> places = disks::flat_uvs(mesh);
  for (Vec2& w : places) w = Vec2(0.5, 0.5) + 1e-9 * w;
  MappedChart map = map_of(mesh);
  round_on_page(mesh, places, 0, true, Work(1), map);
  EXPECT_EQ(map.outcome, Outcome::kNotInjectiveFloat32);
  map = map_of(mesh);
  round_on_page(mesh, places, 0, false, Work(1), map);
  EXPECT_EQ(map.outcome, Outcome::kOk);
  EXPECT_EQ(map.uvs, places);
}

}  // namespace
}  // namespace beltrami
