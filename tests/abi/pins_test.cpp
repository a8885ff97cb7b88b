// Pins through the C ABI: given per corner, met to the bit, refused with the corner.
#include <beltrami/beltrami.h>
#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "abi/host.h"
#include "support/meshes.h"

namespace beltrami::host {
namespace {

using meshes::TriangleList;

struct Pinned {
  TriangleList mesh = meshes::bumps(6, 6);
  std::vector<std::uint32_t> corners = {};
  std::vector<std::array<double, 2>> uvs = {};

  beltrami_surface view() const {
    auto surface = sized<beltrami_surface>();
    surface.vertex_count = mesh.positions.size();
    surface.face_count = mesh.faces.size();
    surface.positions = {mesh.positions.data(), 0, BELTRAMI_F64, 0};
    surface.indices = {mesh.faces.data(), 0, BELTRAMI_U32, 0};
    surface.pins = {corners.data(), 0, BELTRAMI_U32, 0};
    surface.pin_uvs = {uvs.data(), 0, BELTRAMI_F64, 0};
    surface.pin_count = corners.size();
    return surface;
  }
};

beltrami_status unwrap(const Context& context, const beltrami_surface& surface) {
  return beltrami_unwrap(context.get(), &surface, nullptr, nullptr);
}

/// Corner 0 is vertex 0, 32 is beside vertex 6; 216 corners.
Pinned three_pins() {
  return {.corners = {0, 31, 215}, .uvs = {{0, 0}, {1.1, 0.2}, {0.1, 1.3}}};
}

std::vector<std::array<double, 2>> corner_uvs(const Context& context, std::size_t corners) {
  std::vector<std::array<double, 2>> uvs(corners);
  EXPECT_EQ(beltrami_get_corner_uvs(context.get(), uvs.data(), BELTRAMI_F64, 0), BELTRAMI_OK);
  return uvs;
}

TEST(AbiPins, AreMetToTheBit) {
  const Pinned pinned = three_pins();
  const Context context = create();
  ASSERT_EQ(unwrap(context, pinned.view()), BELTRAMI_OK) << message(context);
  const auto uvs = corner_uvs(context, 3 * pinned.mesh.faces.size());
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(uvs[pinned.corners[i]], pinned.uvs[i]);
  auto certificate = sized<beltrami_atlas_certificate>();
  ASSERT_EQ(beltrami_get_atlas_certificate(context.get(), BELTRAMI_F64, &certificate), BELTRAMI_OK);
  EXPECT_EQ(certificate.injective, 1);
}

TEST(AbiPins, OfAPolygonHoldItsCorner) {
  const TriangleList corners = meshes::grid(1, 1);
  const std::vector<std::uint32_t> quad = {0, 1, 3, 2};
  const std::uint64_t size = 4, corner = 2;
  const std::array<float, 2> uv = {-7, 0.5F};
  auto surface = sized<beltrami_surface>();
  surface.vertex_count = 4;
  surface.face_count = 1;
  surface.corner_count = 4;
  surface.positions = {corners.positions.data(), 0, BELTRAMI_F64, 0};
  surface.indices = {quad.data(), 0, BELTRAMI_U32, 0};
  surface.face_sizes = {&size, 0, BELTRAMI_U64, 0};
  surface.pins = {&corner, 0, BELTRAMI_U64, 0};
  surface.pin_uvs = {uv.data(), 0, BELTRAMI_F32, 0};
  surface.pin_count = 1;
  const Context context = create();
  ASSERT_EQ(unwrap(context, surface), BELTRAMI_OK) << message(context);
  EXPECT_EQ(corner_uvs(context, 4)[2], (std::array<double, 2>{-7, 0.5}));
}

TEST(AbiPins, AreNotReadFromAnOlderCaller) {
  const Pinned pinned = three_pins();
  beltrami_surface surface = pinned.view();
  surface.struct_size = offsetof(beltrami_surface, pins);
  const Context context = create();
  ASSERT_EQ(unwrap(context, surface), BELTRAMI_OK);
  EXPECT_NE(corner_uvs(context, 3 * pinned.mesh.faces.size())[215], pinned.uvs[2]);
}

/// That an unwrap fails so, and that the atlas before it stays.
void expect_refused(const Context& context, const beltrami_surface& surface, beltrami_status status,
                    const std::string& text, std::uint64_t corner) {
  EXPECT_EQ(unwrap(context, surface), status);
  EXPECT_NE(message(context).find(text), std::string::npos) << message(context);
  EXPECT_EQ(beltrami_error_element(context.get()), corner);
  EXPECT_EQ(beltrami_error_element_kind(context.get()),
            corner == BELTRAMI_NO_ELEMENT ? BELTRAMI_ELEMENT_NONE : BELTRAMI_ELEMENT_CORNER);
}

TEST(AbiPins, AreRefusedWithTheirCorner) {
  const Context context = create();
  const Pinned good = three_pins();
  ASSERT_EQ(unwrap(context, good.view()), BELTRAMI_OK);
  const auto before = corner_uvs(context, 216);

  Pinned pinned = good;
  pinned.corners[1] = 216;
  expect_refused(context, pinned.view(), BELTRAMI_E_INDEX_OUT_OF_RANGE, "pin 1 names corner 216",
                 BELTRAMI_NO_ELEMENT);
  pinned = good;
  pinned.uvs[2][1] = std::numeric_limits<double>::quiet_NaN();
  expect_refused(context, pinned.view(), BELTRAMI_E_NON_FINITE, "pin 2 (corner 215)", 215);
  pinned = good;
  pinned.corners[1] = 216 - 3;  // a vertex inside
  pinned.uvs[2] = pinned.uvs[1];
  expect_refused(context, pinned.view(), BELTRAMI_E_PINS, "pin 2 (corner 215)", 215);
  EXPECT_EQ(corner_uvs(context, 216), before);
  beltrami_surface surface = good.view();
  surface.pin_uvs.data = nullptr;
  expect_refused(context, surface, BELTRAMI_E_INVALID_ARGUMENT, "pin UVs", BELTRAMI_NO_ELEMENT);
  surface = good.view();
  surface.pins.type = BELTRAMI_F32;
  expect_refused(context, surface, BELTRAMI_E_INVALID_ARGUMENT, "pins", BELTRAMI_NO_ELEMENT);
}

TEST(AbiPins, AreSinglePrecisionNumbersWithFloat32) {
  const Context context = create();
  set_option(context, BELTRAMI_OPTION_FLOAT32, 1);
  Pinned pinned = three_pins();
  expect_refused(context, pinned.view(), BELTRAMI_E_INVALID_ARGUMENT,
                 "pin 1 (corner 31) is no single-precision number", 31);
  pinned.uvs = {{0, 0}, {1.125, 0.25}, {0.125, 1.25}};
  ASSERT_EQ(unwrap(context, pinned.view()), BELTRAMI_OK) << message(context);
  std::vector<std::array<float, 2>> uvs(216);
  ASSERT_EQ(beltrami_get_corner_uvs(context.get(), uvs.data(), BELTRAMI_F32, 0), BELTRAMI_OK);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(static_cast<double>(uvs[pinned.corners[i]][0]), pinned.uvs[i][0]);
    EXPECT_EQ(static_cast<double>(uvs[pinned.corners[i]][1]), pinned.uvs[i][1]);
  }
}

TEST(AbiPins, GoNeitherWithTheUnitSquareNorWithDensities) {
  const Pinned pinned = three_pins();
  const Context context = create();
  beltrami_surface surface = pinned.view();
  const std::vector<double> densities(pinned.mesh.faces.size(), 2.0);
  surface.densities = {densities.data(), 0, BELTRAMI_F64, 0};
  expect_refused(context, surface, BELTRAMI_E_INVALID_ARGUMENT, "densities", BELTRAMI_NO_ELEMENT);
  set_option(context, BELTRAMI_OPTION_UNIT_SQUARE, 1);
  expect_refused(context, pinned.view(), BELTRAMI_E_INVALID_ARGUMENT, "unit-square",
                 BELTRAMI_NO_ELEMENT);
}

}  // namespace
}  // namespace beltrami::host
