// Meshes that extensions of glTF have compressed: the encoders are those of Draco and
// meshoptimizer.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "files/gltf/document.h"
#include "files/gltf/model.h"
#include "files/mesh_file.h"
#include "files/polygons.h"
#include "gltf_builder.h"
#include "process/failure.h"
#ifdef BELTRAMI_DRACO
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#endif
#ifdef BELTRAMI_MESHOPT
#include <meshoptimizer.h>
#endif

namespace beltrami::cli {
namespace {

using Json = GltfBuilder::Json;
using Point = std::array<float, 3>;
using Triangles = std::vector<std::array<Point, 3>>;

constexpr std::uint32_t kSide = 9;

/// A wave over a square: kSide^2 vertices.
std::vector<Point> wave() {
  std::vector<Point> points;
  for (std::uint32_t y = 0; y < kSide; ++y) {
    for (std::uint32_t x = 0; x < kSide; ++x) {
      points.push_back({static_cast<float>(x), static_cast<float>(y), std::sin(0.7F * x + y)});
    }
  }
  return points;
}

std::vector<std::uint32_t> wave_corners() {
  std::vector<std::uint32_t> corners;
  for (std::uint32_t y = 0; y + 1 < kSide; ++y) {
    for (std::uint32_t x = 0; x + 1 < kSide; ++x) {
      const std::uint32_t a = y * kSide + x, b = a + 1, c = b + kSide, d = a + kSide;
      for (const std::uint32_t corner : {a, b, c, a, c, d}) corners.push_back(corner);
    }
  }
  return corners;
}

Triangles triangles_of(const std::vector<double>& positions,
                       const std::vector<std::uint32_t>& corners) {
  Triangles triangles;
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    std::array<Point, 3> triangle;
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t l = 0; l < 3; ++l) {
        triangle[k][l] = static_cast<float>(positions[3 * corners[i + k] + l]);
      }
    }
    // Encoders may begin with another corner.
    std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()),
                triangle.end());
    triangles.push_back(triangle);
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

Triangles wave_triangles() {
  std::vector<double> positions;
  for (const Point& p : wave()) positions.insert(positions.end(), p.begin(), p.end());
  return triangles_of(positions, wave_corners());
}

void expect_wave(const MeshFile& file) {
  EXPECT_EQ(triangles_of(file.positions, file.polygons.corners()), wave_triangles());
  const std::vector<std::string> expected = {"the compression of meshes"};
  EXPECT_EQ(file.not_kept, expected);
  const std::string json = gltf::model_of(file).document.json.dump();
  EXPECT_EQ(json.find("compression"), std::string::npos) << json;
}

std::string said_of(const std::string& bytes) {
  try {
    read_gltf(bytes, "a.glb", Content::kSurface);
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.exit_code, kExitUnusable);
    return failure.what();
  }
  return "nothing";
}

#ifdef BELTRAMI_MESHOPT

/// The wave in views of EXT_meshopt_compression, as gltfpack writes them.
Json meshopt_document(std::string& chunk) {
  const std::vector<Point> points = wave();
  const std::vector<std::uint32_t> corners = wave_corners();
  std::vector<unsigned char> packed(meshopt_encodeVertexBufferBound(points.size(), sizeof(Point)));
  packed.resize(meshopt_encodeVertexBuffer(packed.data(), packed.size(), points.data(),
                                           points.size(), sizeof(Point)));
  std::vector<unsigned char> indices(meshopt_encodeIndexBufferBound(corners.size(), points.size()));
  indices.resize(
      meshopt_encodeIndexBuffer(indices.data(), indices.size(), corners.data(), corners.size()));
  chunk.assign(packed.begin(), packed.end());
  chunk.append((4 - chunk.size() % 4) % 4, '\0');
  const std::size_t second = chunk.size();
  chunk.append(indices.begin(), indices.end());
  const auto view = [](std::size_t offset, std::size_t bytes, Json own) {
    return Json{{"buffer", 1},
                {"byteOffset", offset},
                {"byteLength", bytes},
                {"extensions", {{"EXT_meshopt_compression", std::move(own)}}}};
  };
  const std::size_t bytes = points.size() * sizeof(Point), of_corners = 4 * corners.size();
  Json json = {{"asset", {{"version", "2.0"}}},
               {"extensionsUsed", {"EXT_meshopt_compression"}},
               {"extensionsRequired", {"EXT_meshopt_compression"}}};
  json["buffers"] = {{{"byteLength", chunk.size()}},
                     {{"byteLength", bytes + of_corners},
                      {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}};
  json["bufferViews"] = {view(0, bytes,
                              {{"buffer", 0},
                               {"byteLength", packed.size()},
                               {"byteStride", sizeof(Point)},
                               {"count", points.size()},
                               {"mode", "ATTRIBUTES"}}),
                         view(bytes, of_corners,
                              {{"buffer", 0},
                               {"byteOffset", second},
                               {"byteLength", indices.size()},
                               {"byteStride", 4},
                               {"count", corners.size()},
                               {"mode", "TRIANGLES"}})};
  json["accessors"] = {
      {{"bufferView", 0}, {"componentType", 5126}, {"count", points.size()}, {"type", "VEC3"}},
      {{"bufferView", 1}, {"componentType", 5125}, {"count", corners.size()}, {"type", "SCALAR"}}};
  json["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"indices", 1}}}}}};
  json["nodes"] = {{{"mesh", 0}}};
  return json;
}

TEST(GltfCompressed, ViewsOfMeshoptAreDecoded) {
  std::string chunk;
  const Json json = meshopt_document(chunk);
  expect_wave(read_gltf(GltfBuilder::glb_of(json.dump(), chunk), "a.glb", Content::kSurface));
}

TEST(GltfCompressed, DamagedViewsOfMeshoptAreRefused) {
  std::string chunk;
  const Json json = meshopt_document(chunk);
  const auto said = [&](auto&& spoil) {
    Json spoilt = json;
    spoil(spoilt["bufferViews"][0]["extensions"]["EXT_meshopt_compression"]);
    return said_of(GltfBuilder::glb_of(spoilt.dump(), chunk));
  };
  const std::string undecoded = "bufferViews[0]: its bytes cannot be decoded";
  EXPECT_NE(said([](Json& own) { own["byteLength"] = 40; }).find(undecoded), std::string::npos);
  EXPECT_NE(said([](Json& own) { own["mode"] = "COLOURS"; }).find(undecoded), std::string::npos);
  EXPECT_NE(said([](Json& own) { own["filter"] = "COLOR"; }).find(undecoded), std::string::npos);
  EXPECT_NE(said([](Json& own) { own["byteStride"] = 6; }).find(undecoded), std::string::npos);
  EXPECT_NE(said([](Json& own) { own["byteOffset"] = 1'000'000; }).find("beyond buffers[0]"),
            std::string::npos);
  for (const std::uint64_t count : {std::uint64_t{0}, std::uint64_t{1} << 40, ~std::uint64_t{0}}) {
    const std::string words = said([&](Json& own) { own["count"] = count; });
    EXPECT_NE(words.find("elements of 12 bytes, out of"), std::string::npos) << words;
  }
  // Bytes of any kind: each is read or refused.
  for (std::size_t i = 0; i < chunk.size(); ++i) {
    std::string spoilt = chunk;
    spoilt[i] = static_cast<char>(spoilt[i] ^ 0x55);
    said_of(GltfBuilder::glb_of(json.dump(), spoilt));
  }
}

#endif

#ifdef BELTRAMI_DRACO

/// The wave as one primitive of KHR_draco_mesh_compression, as the Draco of Blender writes it.
Json draco_document(std::string& chunk) {
  const std::vector<Point> points = wave();
  const std::vector<std::uint32_t> corners = wave_corners();
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(static_cast<int>(corners.size() / 3));
  const int id = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  for (std::uint32_t f = 0; f < corners.size() / 3; ++f) {
    builder.SetAttributeValuesForFace(id, draco::FaceIndex(f), points[corners[3 * f]].data(),
                                      points[corners[3 * f + 1]].data(),
                                      points[corners[3 * f + 2]].data());
  }
  draco::EncoderBuffer packed;
  draco::Encoder encoder;  // it quantizes nothing unless it is told to
  EXPECT_TRUE(encoder.EncodeMeshToBuffer(*builder.Finalize(), &packed).ok());
  chunk.assign(packed.data(), packed.size());
  Json json = {{"asset", {{"version", "2.0"}}},
               {"extensionsUsed", {"KHR_draco_mesh_compression"}},
               {"extensionsRequired", {"KHR_draco_mesh_compression"}}};
  json["buffers"] = Json::array({{{"byteLength", chunk.size()}}});
  json["bufferViews"] = Json::array({{{"buffer", 0}, {"byteLength", chunk.size()}}});
  json["accessors"] = {{{"componentType", 5126}, {"count", points.size()}, {"type", "VEC3"}},
                       {{"componentType", 5123}, {"count", corners.size()}, {"type", "SCALAR"}}};
  Json own = {{"bufferView", 0}, {"attributes", {{"POSITION", id}}}};
  Json primitive = {{"attributes", {{"POSITION", 0}}},
                    {"indices", 1},
                    {"extensions", {{"KHR_draco_mesh_compression", std::move(own)}}}};
  json["meshes"] = Json::array({{{"primitives", Json::array({std::move(primitive)})}}});
  json["nodes"] = Json::array({{{"mesh", 0}}});
  return json;
}

TEST(GltfCompressed, PrimitivesOfDracoAreDecoded) {
  std::string chunk;
  const Json json = draco_document(chunk);
  expect_wave(read_gltf(GltfBuilder::glb_of(json.dump(), chunk), "a.glb", Content::kSurface));
}

TEST(GltfCompressed, DamagedPrimitivesOfDracoAreRefused) {
  std::string chunk;
  const Json json = draco_document(chunk);
  const auto said = [&](auto&& spoil) {
    Json spoilt = json;
    spoil(spoilt["meshes"][0]["primitives"][0]);
    return said_of(GltfBuilder::glb_of(spoilt.dump(), chunk));
  };
  const auto own = [](Json& primitive) -> Json& {
    return primitive["extensions"]["KHR_draco_mesh_compression"];
  };
  EXPECT_NE(said([&](Json& j) { own(j)["attributes"]["POSITION"] = 77; }).find("be decoded"),
            std::string::npos);
  EXPECT_NE(said([&](Json& j) { own(j)["bufferView"] = 9; }).find("bufferViews"),
            std::string::npos);
  EXPECT_NE(said([&](Json& j) { own(j).erase("attributes"); }).find("has no attributes"),
            std::string::npos);
  EXPECT_NE(said([](Json& j) { j["mode"] = 6; }).find("triangles and strips alone"),
            std::string::npos);
  for (std::size_t i = 0; i < chunk.size(); ++i) {
    std::string spoilt = chunk;
    spoilt[i] = static_cast<char>(spoilt[i] ^ 0x55);
    said_of(GltfBuilder::glb_of(json.dump(), spoilt));
  }
  chunk.resize(chunk.size() / 2);
  Json cut = json;
  cut["buffers"][0]["byteLength"] = cut["bufferViews"][0]["byteLength"] = chunk.size();
  EXPECT_NE(said_of(GltfBuilder::glb_of(cut.dump(), chunk)).find("be decoded"), std::string::npos);
}

#endif

#ifndef BELTRAMI_DRACO

TEST(GltfCompressed, WhatThisBuildCannotDecodeIsRefusedWithWhatToDo) {
  GltfBuilder builder;
  const int positions = builder.vectors3({0, 0, 0, 1, 0, 0, 1, 1, 0});
  Json& primitive = builder.mesh({{"POSITION", positions}});
  primitive["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", 0}};
  EXPECT_NE(said_of(builder.glb()).find("which this build cannot read: decompress the file first"),
            std::string::npos);
}

#endif

}  // namespace
}  // namespace beltrami::cli
