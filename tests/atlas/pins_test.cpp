// Pins: held to the very number, in maps that stay injective, or refused by name.
#include "atlas/pins.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "atlas/atlas.h"
#include "atlas/types.h"
#include "base/error.h"
#include "base/work.h"
#include "chart/flattening.h"
#include "support/disks.h"
#include "support/meshes.h"
#include "support/surfaces.h"

namespace beltrami {
namespace {

using meshes::TriangleList;

/// Holds the first corner of a vertex.
void pin_vertex(const TriangleList& mesh, Index vertex, const Vec2& uv, std::vector<Pin>& pins) {
  for (Index f = 0; f < size_of(mesh.faces); ++f) {
    for (int k = 0; k < 3; ++k) {
      if (mesh.faces[f][k] != vertex) continue;
      pins.push_back({f, k, uv, size_of(pins), 3 * f + k});
      return;
    }
  }
  FAIL() << "no face has vertex " << vertex;
}

Atlas pinned(const TriangleList& mesh, const std::vector<Pin>& pins,
             const AtlasOptions& options = {}, int threads = 1) {
  return unwrap({.positions = mesh.positions, .faces = mesh.faces, .pins = pins}, options,
                Work(threads));
}

Vec2 uv_of(const Atlas& atlas, const Pin& pin) {
  return atlas.uvs[atlas.faces[pin.face][pin.corner]];
}

void expect_met(const Atlas& atlas, const std::vector<Pin>& pins) {
  for (const Pin& pin : pins) EXPECT_EQ(uv_of(atlas, pin), pin.uv) << "pin " << pin.number;
  EXPECT_TRUE(atlas.certificate.injective());
  EXPECT_EQ(atlas.outcome, Outcome::kOk);
}

struct Refusal {
  std::optional<Fault> fault = {};
  Element element = {};
  std::string message = {};
};

Refusal refusal(const TriangleList& mesh, const std::vector<Pin>& pins) {
  try {
    pinned(mesh, pins);
  } catch (const Error& error) {
    return {error.fault(), error.element(), error.what()};
  }
  return {};
}

/// That pin `first` is named, and the reason.
void expect_refused(const TriangleList& mesh, const std::vector<Pin>& pins, Index first,
                    const std::string& why) {
  const Refusal found = refusal(mesh, pins);
  EXPECT_EQ(found.fault, Fault::kPins) << found.message;
  EXPECT_EQ(found.element.kind, ElementKind::kCorner);
  const auto corner = static_cast<std::uint64_t>(pins[first].of_caller);
  EXPECT_EQ(found.element.index, corner) << found.message;
  EXPECT_NE(found.message.find("pin " + std::to_string(first) + " (corner "), std::string::npos)
      << found.message;
  EXPECT_NE(found.message.find(why), std::string::npos) << found.message;
}

Index corner_of_grid(Index n, Index i, Index j) {
  return j * (n + 1) + i;
}

/// The corners of an n x n grid, counter-clockwise.
std::vector<Pin> four_corners(const TriangleList& mesh, Index n, const std::vector<Vec2>& places) {
  std::vector<Pin> pins;
  const std::vector<Index> corners = {corner_of_grid(n, 0, 0), corner_of_grid(n, n, 0),
                                      corner_of_grid(n, n, n), corner_of_grid(n, 0, n)};
  for (std::size_t i = 0; i < corners.size(); ++i) pin_vertex(mesh, corners[i], places[i], pins);
  return pins;
}

/// The boundary of a mesh that is one disk, as it runs.
std::vector<Index> boundary_of(const TriangleList& mesh) {
  return disks::disk(mesh).boundary;
}

/// Pins the whole boundary to a circle; `turns`: -1 mirrors it.
std::vector<Pin> on_circle(const TriangleList& mesh, double radius, double turns = 1) {
  std::vector<Pin> pins;
  const std::vector<Index> loop = boundary_of(mesh);
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const double angle =
        turns * 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(loop.size());
    pin_vertex(mesh, loop[i], radius * Vec2(std::cos(angle), std::sin(angle)), pins);
  }
  return pins;
}

TEST(Pins, OneMovesTheFreeMap) {
  const TriangleList mesh = meshes::bumps(8, 8);
  std::vector<Pin> pins;
  pin_vertex(mesh, 40, {0.1, -1e3 / 3}, pins);
  const Atlas atlas = pinned(mesh, pins);
  expect_met(atlas, pins);
  const Atlas free = pinned(mesh, {});
  const Vec2 shift = pins[0].uv - uv_of(free, pins[0]);
  for (std::size_t v = 0; v < free.uvs.size(); ++v) {
    EXPECT_LE((free.uvs[v] + shift - atlas.uvs[v]).norm(), 1e-10);
  }
  EXPECT_EQ(atlas.charts[0].density, 1);
}

TEST(Pins, TwoTurnAndScaleTheFreeMap) {
  const TriangleList mesh = meshes::bumps(8, 8);
  std::vector<Pin> pins;
  pin_vertex(mesh, 0, {1, 1}, pins);
  pin_vertex(mesh, 80, {1, 40}, pins);
  const Atlas atlas = pinned(mesh, pins), free = pinned(mesh, {});
  expect_met(atlas, pins);
  const double scale = 39 / (uv_of(free, pins[1]) - uv_of(free, pins[0])).norm();
  EXPECT_NEAR(atlas.charts[0].density, scale, 1e-9 * scale);
  EXPECT_NEAR(atlas.energy.symmetric_dirichlet, free.energy.symmetric_dirichlet, 1e-9);
}

TEST(Pins, BendAGridToATrapezoid) {
  const Index n = 12;
  const TriangleList mesh = meshes::grid(n, n);
  const auto pins = four_corners(mesh, n, {{0, 0}, {12, 0}, {9, 10}, {4, 11}});
  const Atlas atlas = pinned(mesh, pins);
  expect_met(atlas, pins);
  EXPECT_LT(atlas.energy.symmetric_dirichlet, 2.3);
}

TEST(Pins, HoldVerticesInside) {
  const Index n = 16;
  const TriangleList mesh = meshes::bumps(n, n);
  auto pins = four_corners(mesh, n, {{0, 0}, {16, 0}, {16, 16}, {0, 16}});
  pin_vertex(mesh, corner_of_grid(n, 8, 8), {11, 10}, pins);
  pin_vertex(mesh, corner_of_grid(n, 4, 4), {4, 6}, pins);
  const Atlas atlas = pinned(mesh, pins);
  expect_met(atlas, pins);
}

TEST(Pins, LayTheBoundaryOnACircle) {
  const TriangleList mesh = meshes::bumps(12, 12);
  const auto pins = on_circle(mesh, 7);
  const Atlas atlas = pinned(mesh, pins);
  expect_met(atlas, pins);
}

TEST(Pins, LayTheBoundaryOnAPolygonThatIsNotConvex) {
  const TriangleList mesh = meshes::grid(12, 12);
  std::vector<Pin> pins;
  for (const Index v : boundary_of(mesh)) {
    const Vec3& p = mesh.positions[v];
    pin_vertex(mesh, v, {p.x(), p.y() + 6 * (p.x() - 0.5) * (p.x() - 0.5)}, pins);
  }
  const Atlas atlas = pinned(mesh, pins);
  expect_met(atlas, pins);
}

TEST(Pins, TurnRoundWhatIsBetweenThem) {
  // A pin in the middle goes half way to the border, past others that hold the border.
  const Index n = 10;
  const TriangleList mesh = meshes::grid(n, n);
  std::vector<Pin> pins;
  for (const Index v : boundary_of(mesh)) {
    pin_vertex(mesh, v, mesh.positions[v].head<2>(), pins);
  }
  pin_vertex(mesh, corner_of_grid(n, 5, 5), {0.875, 0.5}, pins);
  expect_met(pinned(mesh, pins), pins);
}

TEST(Pins, OnBothSidesOfASeam) {
  // A tube is cut open; the two copies of a vertex on the cut are held apart.
  const TriangleList mesh = meshes::torus(8);
  const Atlas free = pinned(mesh, {});
  std::vector<Pin> pins;
  for (Index f = 0; f < size_of(mesh.faces) && pins.size() < 2; ++f) {
    for (int k = 0; k < 3 && pins.size() < 2; ++k) {
      const Index uv = free.faces[f][k];
      if (!pins.empty() && (mesh.faces[f][k] != mesh.faces[pins[0].face][pins[0].corner] ||
                            uv == free.faces[pins[0].face][pins[0].corner])) {
        continue;
      }
      if (std::count(free.input_vertex.begin(), free.input_vertex.end(), free.input_vertex[uv]) <
          2) {
        continue;
      }
      pins.push_back({f, k, free.uvs[uv] + 0.1 * Vec2(1, 2), size_of(pins), 3 * f + k});
    }
  }
  ASSERT_EQ(pins.size(), 2u);
  expect_met(pinned(mesh, pins), pins);
}

TEST(Pins, LetTheBoundaryTouchItself) {
  // A slit that is sewn up in the plane: both sides of it pinned to the same places.
  TriangleList mesh = meshes::grid(6, 6);
  std::vector<Index> copy(mesh.positions.size(), kNone);
  for (Index i = 0; i < 3; ++i) {
    const Index v = corner_of_grid(6, i, 3);
    copy[v] = size_of(mesh.positions);
    mesh.positions.push_back(mesh.positions[v]);
  }
  for (Triangle& face : mesh.faces) {
    double height = 0;
    for (const Index v : face) height += mesh.positions[v].y() / 3;
    for (Index& v : face) {
      if (height > 0.5 && copy[v] != kNone) v = copy[v];
    }
  }
  std::vector<Pin> pins;
  for (const Index v : boundary_of(mesh)) {
    pin_vertex(mesh, v, mesh.positions[v].head<2>(), pins);
  }
  AtlasOptions options;
  options.admit.weld_distance.reset();
  const Atlas atlas = pinned(mesh, pins, options);
  expect_met(atlas, pins);
  EXPECT_GT(atlas.certificate.touching_places, 0);
}

TEST(Pins, LetTwoVerticesOfTheBoundaryMeet) {
  const Index n = 8;
  const TriangleList mesh = meshes::grid(n, n);
  std::vector<Pin> pins;
  pin_vertex(mesh, corner_of_grid(n, 0, 0), {0, 0}, pins);
  pin_vertex(mesh, corner_of_grid(n, n, 0), {1, 0}, pins);
  pin_vertex(mesh, corner_of_grid(n, 0, n), {0, 0}, pins);
  const Atlas atlas = pinned(mesh, pins);
  EXPECT_EQ(uv_of(atlas, pins[0]), uv_of(atlas, pins[2]));
  EXPECT_TRUE(atlas.certificate.injective());
  EXPECT_EQ(atlas.certificate.touching_places, 1);
}

TEST(Pins, LeaveTheOtherChartsRoom) {
  TriangleList mesh = meshes::together({meshes::bumps(6, 6), meshes::bumps(7, 5)});
  for (std::size_t v = 49; v < mesh.positions.size(); ++v) mesh.positions[v].z() += 20;
  std::vector<Pin> pins;
  pin_vertex(mesh, 0, {1e3, -1e3}, pins);
  const Atlas atlas = pinned(mesh, pins);
  expect_met(atlas, pins);
  ASSERT_EQ(atlas.charts.size(), 2u);
  EXPECT_GT(atlas.charts[1].box.min().y(), atlas.charts[0].box.max().y());
}

TEST(Pins, ThatLayChartsOnEachOtherAreReported) {
  TriangleList mesh = meshes::together({meshes::grid(3, 3), meshes::grid(3, 3)});
  for (std::size_t v = 16; v < mesh.positions.size(); ++v) mesh.positions[v].z() += 20;
  std::vector<Pin> pins;
  pin_vertex(mesh, 5, {0, 0}, pins);
  pin_vertex(mesh, 16 + 5, {0, 0}, pins);
  for (const bool float32 : {false, true}) {
    const Atlas atlas = pinned(mesh, pins, {.float32 = float32});
    EXPECT_EQ(atlas.outcome, Outcome::kNotInjective);
    EXPECT_GT(atlas.certificate.overlaps.faces, 0);
    for (const ChartInfo& chart : atlas.charts) EXPECT_EQ(chart.outcome, Outcome::kOk);
  }
}

TEST(Pins, HoldInSinglePrecision) {
  const Index n = 10;
  const TriangleList mesh = meshes::bumps(n, n);
  const auto pins = four_corners(mesh, n, {{0, 0}, {12.5, 0}, {9, 10.25}, {4, 11}});
  const Atlas atlas = pinned(mesh, pins, {.float32 = true});
  expect_met(atlas, pins);
  for (const Vec2& w : atlas.uvs) EXPECT_EQ(w.cast<float>().cast<double>(), w);
}

TEST(Pins, SetTheCornersOfFacesWithoutArea) {
  TriangleList mesh = meshes::grid(3, 3);
  mesh.faces.push_back({0, 1, 2});
  std::vector<Pin> pins;
  pin_vertex(mesh, 0, {5, 5}, pins);
  pins.push_back({size_of(mesh.faces) - 1, 1, {77, 78}, 1, 3 * (size_of(mesh.faces) - 1) + 1});
  expect_met(pinned(mesh, pins), pins);
}

TEST(Pins, HaveTheSameBitsOnAllThreads) {
  const Index n = 40;
  const TriangleList mesh = meshes::bumps(n, n);
  auto pins = four_corners(mesh, n, {{0, 0}, {40, 3}, {31, 45}, {-6, 36}});
  pin_vertex(mesh, corner_of_grid(n, 20, 20), {24, 17}, pins);
  const Atlas one = pinned(mesh, pins, {}, 1), two = pinned(mesh, pins, {}, 2);
  expect_met(one, pins);
  EXPECT_EQ(one.uvs, two.uvs);
}

TEST(Pins, ScaleWithTheSurfaceBitForBit) {
  const Index n = 10;
  TriangleList mesh = meshes::bumps(n, n);
  auto pins = four_corners(mesh, n, {{0, 0}, {12.5, 0}, {9, 10.25}, {4, 11}});
  const Atlas unit = pinned(mesh, pins);
  for (Vec3& p : mesh.positions) p *= 0x1p20;
  for (Pin& pin : pins) pin.uv *= 0x1p20;
  const Atlas large = pinned(mesh, pins);
  for (std::size_t v = 0; v < unit.uvs.size(); ++v) {
    EXPECT_EQ(Vec2(0x1p20 * unit.uvs[v]), large.uvs[v]);
  }
}

TEST(Pins, OfOneUvVertexMustAgree) {
  const TriangleList mesh = meshes::grid(2, 2);
  std::vector<Pin> pins;
  pin_vertex(mesh, 4, {0, 0}, pins);
  for (Index f = 1; f < size_of(mesh.faces) && pins.size() < 2; ++f) {
    for (int k = 0; k < 3; ++k) {
      if (mesh.faces[f][k] == 4 && f != pins[0].face) pins.push_back({f, k, {0, 0}, 1, 3 * f + k});
    }
  }
  pins.resize(2);
  expect_met(pinned(mesh, pins), pins);
  pins[1].uv = {0, 0.5};
  expect_refused(mesh, pins, 1, "the same UV vertex");
}

TEST(Pins, CannotLieAtOnePlace) {
  const TriangleList mesh = meshes::grid(4, 4);
  std::vector<Pin> pins;
  pin_vertex(mesh, 0, {0, 0}, pins);
  pin_vertex(mesh, 4, {4, 0}, pins);
  pin_vertex(mesh, 12, {0, 0}, pins);
  pin_vertex(mesh, 24, {0, 0}, pins);
  expect_refused(mesh, pins, 2, "the place of pin 0");
}

TEST(Pins, CannotTurnAFaceOver) {
  const TriangleList mesh = meshes::grid(4, 4);
  const auto [a, b, c] = mesh.faces[9];
  std::vector<Pin> pins;
  pin_vertex(mesh, 0, {9, 9}, pins);
  pin_vertex(mesh, a, {0, 0}, pins);
  pin_vertex(mesh, b, {0, 1}, pins);
  pin_vertex(mesh, c, {1, 0}, pins);
  pin_vertex(mesh, 24, {-9, 9}, pins);
  expect_refused(mesh, pins, 3, "turned over");
}

TEST(Pins, CannotCrossTheBoundary) {
  const TriangleList mesh = meshes::grid(6, 6);
  std::vector<Pin> pins;
  pin_vertex(mesh, 0, {0, 0}, pins);
  pin_vertex(mesh, 1, {2, 0}, pins);
  pin_vertex(mesh, 48, {1, 1}, pins);
  pin_vertex(mesh, 47, {1, -1}, pins);
  pin_vertex(mesh, 3, {8, 8}, pins);
  expect_refused(mesh, pins, 3, "cross that between pin 0");
}

TEST(Pins, CannotRunClockwise) {
  const TriangleList mesh = meshes::bumps(6, 6);
  const auto pins = on_circle(mesh, 3, -1);
  // Faces in the corners have three pins: the first of them tells already.
  EXPECT_EQ(refusal(mesh, pins).fault, Fault::kPins);
  const TriangleList fan = meshes::fan(7);
  const auto around = on_circle(fan, 3, -1);
  expect_refused(fan, around, size_of(around) - 1, "clockwise");
}

TEST(Pins, InsideCannotLieOutside) {
  // Nothing proves it before the attempt.
  const Index n = 6;
  const TriangleList mesh = meshes::grid(n, n);
  std::vector<Pin> pins;
  for (const Index v : boundary_of(mesh)) {
    pin_vertex(mesh, v, mesh.positions[v].head<2>(), pins);
  }
  pin_vertex(mesh, corner_of_grid(n, 2, 2), {0.3, 0.3}, pins);
  pin_vertex(mesh, corner_of_grid(n, 3, 3), {2, 0.5}, pins);
  pin_vertex(mesh, corner_of_grid(n, 4, 4), {0.7, 0.7}, pins);
  expect_refused(mesh, pins, size_of(pins) - 2, "no way was found");
}

TEST(Pins, OfAFanHaveTheirOrder) {
  // The hub lies beyond the rim; what comes after it does not matter.
  const TriangleList mesh = meshes::fan(6);
  std::vector<Pin> pins;
  const std::vector<Index> loop = boundary_of(mesh);
  pin_vertex(mesh, loop[0], {0, 0}, pins);
  pin_vertex(mesh, loop[1], {1, 0}, pins);
  pin_vertex(mesh, loop[2], {1, 1}, pins);
  pin_vertex(mesh, 0, {5, 5}, pins);
  pin_vertex(mesh, loop[4], {-1, 2}, pins);
  const Refusal found = refusal(mesh, pins);
  EXPECT_EQ(found.fault, Fault::kPins);
  EXPECT_NE(found.message.find("pin 3"), std::string::npos) << found.message;
}

}  // namespace
}  // namespace beltrami
