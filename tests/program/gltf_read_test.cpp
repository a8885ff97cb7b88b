// glTF in: triangles out of every way to write them, and sentences for what cannot be read.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numeric>

#include "files/column.h"
#include "files/gltf_file.h"
#include "files/mesh_file.h"
#include "files/polygons.h"
#include "gltf_builder.h"
#include "process/failure.h"
#include "temporary_directory.h"

namespace beltrami::cli {
namespace {

using Json = GltfBuilder::Json;
using Corners = std::vector<std::uint32_t>;

/// The corners of a unit square, then a fifth vertex, in the plane.
int square(GltfBuilder& builder) {
  return builder.vectors3({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 2, 2, 0});
}

MeshFile read_bytes(const GltfBuilder& builder) {
  return read_gltf(builder.text(), "a.gltf", Content::kSurface);
}

std::vector<double> values(const Column* column) {
  std::vector<double> found;
  for (std::uint64_t i = 0; column && i < column->size(); ++i) found.push_back((*column)[i]);
  return found;
}

std::vector<double> corner(const MeshFile& file, std::size_t number) {
  const auto at = file.positions.begin() + 3 * std::ptrdiff_t{file.polygons.corners()[number]};
  return {at, at + 3};
}

TEST(GltfRead, TakesIndicesOfEveryTypeAndNone) {
  GltfBuilder builder;
  const int positions = square(builder);
  builder.mesh({{"POSITION", positions}}, builder.indices<std::uint8_t>({0, 1, 2, 0, 2, 3}));
  builder.mesh({{"POSITION", positions}}, builder.indices<std::uint16_t>({0, 1, 2}));
  builder.mesh({{"POSITION", positions}}, builder.indices<std::uint32_t>({2, 3, 4}));
  builder.mesh({{"POSITION", builder.vectors3({0, 0, 0, 1, 0, 0, 5, 6, 7})}});
  const MeshFile file = read_bytes(builder);
  EXPECT_EQ(file.polygons.corners(), (Corners{0, 1, 2, 0, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}));
  const std::vector<double> meshes = {0, 0, 1, 2, 3}, none(5, -1);
  EXPECT_EQ(values(find_column(file.face_columns, "mesh")), meshes);
  EXPECT_EQ(values(find_column(file.face_columns, "material")), none);
  EXPECT_EQ(corner(file, 14), (std::vector<double>{5, 6, 7}));
  EXPECT_EQ(corner(file, 11), (std::vector<double>{2, 2, 0})) << "the fifth vertex";
}

TEST(GltfRead, StripsAndFansAreTrianglesInTheirOrientation) {
  GltfBuilder builder;
  const int positions = square(builder);
  // 0 1 3 | 3 1 2, and two triangles that join nothing to nothing.
  builder.mesh({{"POSITION", positions}},
               builder.indices<std::uint8_t>({0, 1, 3, 2, 2, 2}))["mode"] = 5;
  builder.mesh({{"POSITION", positions}}, builder.indices<std::uint8_t>({0, 1, 2, 3}))["mode"] = 6;
  builder.mesh({{"POSITION", positions}}, builder.indices<std::uint8_t>({0, 1}))["mode"] = 1;
  const MeshFile file = read_bytes(builder);
  EXPECT_EQ(file.polygons.corners(), (Corners{0, 1, 3, 1, 2, 3, 5, 6, 4, 6, 7, 4}));
  EXPECT_EQ(file.vertex_count(), 8u) << "lines are no triangles";
}

TEST(GltfRead, PrimitivesOfAMeshShareTheVerticesThatTheyShareInTheFile) {
  GltfBuilder builder;
  const int positions = square(builder);
  builder.mesh({{"POSITION", positions}}, builder.indices<std::uint8_t>({0, 1, 2}));
  Json second = {{"attributes", {{"POSITION", positions}}},
                 {"indices", builder.indices<std::uint8_t>({0, 2, 3})}};
  builder.json["meshes"][0]["primitives"].push_back(second);
  builder.json["meshes"].push_back({{"primitives", {second}}});
  const MeshFile file = read_bytes(builder);
  EXPECT_EQ(file.polygons.corners(), (Corners{0, 1, 2, 0, 2, 3, 4, 5, 6}))
      << "another mesh, other vertices";
  EXPECT_EQ(values(find_column(file.face_columns, "primitive")), (std::vector<double>{0, 1, 0}));
}

TEST(GltfRead, SparseValuesStandInPlaceOfOthers) {
  GltfBuilder builder;
  const int positions = square(builder);
  const int places = builder.view({1, 3}),
            values = builder.view(GltfBuilder::bytes_of_all<float>({7, 8, 9, -1, -2, -3}));
  builder.json["accessors"][positions]["sparse"] = {
      {"count", 2},
      {"indices", {{"bufferView", places}, {"componentType", 5121}}},
      {"values", {{"bufferView", values}}}};
  builder.mesh({{"POSITION", positions}}, builder.indices<std::uint8_t>({0, 1, 3}));
  const MeshFile file = read_bytes(builder);
  EXPECT_EQ(file.positions, (std::vector<double>{0, 0, 0, 7, 8, 9, -1, -2, -3}));
}

TEST(GltfRead, QuantizedPositionsAndUvsHaveTheirValues) {
  GltfBuilder builder;
  // Elements four numbers apart, as KHR_mesh_quantization wants them: the fourth is nothing.
  const int positions = builder.accessor<std::int16_t>(
      "VEC3", 4, {32767, -32768, 0, 9, -32767, 0, 0, 9, 0, 16384, 0, 9});
  builder.json["bufferViews"][0]["byteStride"] = 8;
  builder.json["accessors"][positions]["normalized"] = true;
  const int uvs = builder.accessor<std::uint8_t>("VEC2", 2, {255, 0, 0, 51, 0, 0});
  builder.json["accessors"][uvs]["normalized"] = true;
  builder.mesh({{"POSITION", positions}, {"TEXCOORD_0", uvs}});
  const MeshFile file = read_bytes(builder);
  EXPECT_EQ(file.positions, (std::vector<double>{1, -1, 0, -1, 0, 0, 0, 16384. / 32767, 0}));
  EXPECT_EQ(gltf_uvs(file, 0), (std::vector<double>{1, 1, 0, 0.8, 0, 1})) << "V points up here";
  EXPECT_TRUE(gltf_uvs(file, 1).empty());
  EXPECT_EQ(read_gltf(builder.text(), "a", Content::kUvs).uvs, gltf_uvs(file, 0));
}

TEST(GltfRead, AMeshIsWhereTheFirstNodeHasItThatDoesNotFlattenIt) {
  GltfBuilder builder;
  builder.mesh({{"POSITION", builder.vectors3({0, 0, 0, 1, 0, 0, 0, 1, 2})}});
  builder.json["nodes"] = {
      {{"mesh", 0}, {"scale", {1, 1, 0}}},
      {{"mesh", 0}, {"scale", {2, 3, 4}}},
      {{"mesh", 0}},
      {{"children", {1}},
       {"rotation", {0, 0, std::sqrt(0.5), std::sqrt(0.5)}},
       {"translation", {10, 0, 0}}},
      {{"children", {3}}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 5, 1}}}};
  const MeshFile file = read_bytes(builder);
  const std::vector<double> expected = {10, 0, 5, 10, 2, 5, 7, 0, 13};
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(file.positions[i], expected[i], 1e-12) << i;
}

TEST(GltfRead, AMeshThatASkinMovesStaysInItsOwnCoordinates) {
  GltfBuilder builder;
  builder.mesh({{"POSITION", builder.vectors3({0, 0, 0, 1, 0, 0, 0, 1, 2})}});
  builder.json["nodes"] = {{{"mesh", 0}, {"skin", 0}, {"scale", {9, 9, 9}}}};
  EXPECT_EQ(read_bytes(builder).positions, (std::vector<double>{0, 0, 0, 1, 0, 0, 0, 1, 2}));
}

TEST(GltfRead, BuffersAreInChunksFilesOrUris) {
  GltfBuilder builder;
  builder.mesh({{"POSITION", builder.vectors3({0, 0, 0, 1, 0, 0, 0, 1, 2})}});
  const TemporaryDirectory directory;
  directory.file("my buffer%.bin", builder.buffer());
  const MeshFile embedded = read_mesh(directory.file("a.gltf", builder.text()), Content::kSurface);
  const MeshFile beside =
      read_mesh(directory.file("b.gltf", builder.text("my%20buffer%.bin")), Content::kSurface);
  const MeshFile chunk = read_mesh(directory.file("c.GLB", builder.glb()), Content::kSurface);
  EXPECT_EQ(embedded.positions, beside.positions);
  EXPECT_EQ(embedded.positions, chunk.positions);
  EXPECT_EQ(embedded.positions.size(), 9u);
}

TEST(GltfRead, OtherFormatsKeepTheTrianglesAndSaySo) {
  GltfBuilder builder;
  builder.mesh({{"POSITION", square(builder)}}, builder.indices<std::uint8_t>({0, 1, 2}));
  const MeshFile file = read_bytes(builder);
  EXPECT_EQ(not_kept(file, "a.ply"),
            std::vector<std::string>{
                "nodes, materials, textures, animations and attributes of vertices of glTF"});
  EXPECT_TRUE(not_kept(file, "a.glb").empty());
}

TEST(GltfRead, UvsThatAreAskedForMustBeThere) {
  GltfBuilder builder;
  builder.mesh({{"POSITION", builder.vectors3({0, 0, 0, 1, 0, 0, 0, 1, 2})}});
  try {
    read_gltf(builder.text(), "a.gltf", Content::kUvs);
    FAIL() << "there are none";
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.what(), std::string("a.gltf: meshes[0].primitives[0]: it has no texture "
                                          "coordinates, TEXCOORD_0"));
  }
}

/// What the reader says of a document that `spoil` made bad.
std::string refusal(const std::function<void(Json&)>& spoil) {
  GltfBuilder builder;
  const int positions = square(builder);
  builder.mesh({{"POSITION", positions}}, builder.indices<std::uint8_t>({0, 1, 2}));
  builder.json["nodes"] = {{{"mesh", 0}}, {{"name", "a"}}};
  builder.json["buffers"] = Json::array({{{"byteLength", builder.buffer().size()}}});
  spoil(builder.json);
  try {
    read_gltf(GltfBuilder::glb_of(builder.json.dump(), builder.buffer()), "a.glb",
              Content::kSurface);
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.exit_code, kExitUnusable);
    return failure.what();
  }
  return "nothing";
}

void expect_refusal(const std::function<void(Json&)>& spoil, const std::string& words) {
  const std::string said = refusal(spoil);
  EXPECT_NE(said.find(words), std::string::npos) << said;
}

TEST(GltfRead, AnImageThatNothingUsesMayHaveAnyUri) {
  GltfBuilder builder;
  builder.mesh({{"POSITION", square(builder)}}, builder.indices<std::uint8_t>({0, 1, 2}));
  builder.json["images"] = {{{"uri", 7}}, 7};
  EXPECT_EQ(gltf_sources(read_bytes(builder)), std::vector<std::string>{"a.gltf"});
}

TEST(GltfRead, WhatWouldGrowBeyondReasonIsRefusedBeforeItDoes) {
  // One strip over three vertices, by indices of a byte each, drawn by so many primitives.
  constexpr std::size_t kIndices = 60'000;
  const auto strips = [&](int primitives) {
    GltfBuilder builder;
    std::string bytes;
    for (std::size_t i = 0; i < kIndices; ++i) bytes += static_cast<char>(i % 3);
    builder.json["accessors"].push_back({{"bufferView", builder.view(bytes)},
                                         {"componentType", 5121},
                                         {"count", kIndices},
                                         {"type", "SCALAR"}});
    Json& strip = builder.mesh({{"POSITION", builder.vectors3({0, 0, 0, 1, 0, 0, 0, 1, 0})}}, 0);
    strip["mode"] = 5;
    const Json copy = strip;
    for (int i = 1; i < primitives; ++i) builder.json["meshes"][0]["primitives"].push_back(copy);
    return read_gltf(builder.glb(), "a.glb", Content::kSurface);
  };
  EXPECT_EQ(strips(4).polygons.size(), 4 * (kIndices - 2));
  try {
    strips(40);
    FAIL() << "2,400,000 faces of 65,000 bytes";
  } catch (const Failure& failure) {
    EXPECT_NE(std::string(failure.what()).find("items for each byte"), std::string::npos)
        << failure.what();
  }
}

TEST(GltfRead, BuffersOfOneFileAreReadOnce) {
  const TemporaryDirectory directory;
  GltfBuilder builder;
  builder.mesh({{"POSITION", builder.vectors3({0, 0, 0, 1, 0, 0, 0, 1, 0})}},
               builder.indices<std::uint8_t>({0, 1, 2}));
  Json json = Json::parse(builder.text("b.bin"));
  for (int i = 0; i < 3; ++i) json["buffers"].push_back(json["buffers"][0]);
  json["bufferViews"][1]["buffer"] = 3;
  directory.file("b.bin", builder.buffer());
  MeshFile file = read_mesh(directory.file("a.gltf", json.dump()), Content::kSurface);
  EXPECT_EQ(file.polygons.corners(), (std::vector<std::uint32_t>{0, 1, 2}));
  file.corner_uvs = {{0, 0, 1, 0, 0, 1}, {0, 1, 2}};
  const GltfOutput output = write_gltf(file, 0, directory.path("c.glb"));
  const MeshFile back = read_gltf(
      std::accumulate(output.files[0].pieces.begin(), output.files[0].pieces.end(), std::string()),
      "c.glb", Content::kAll);
  EXPECT_EQ(back.positions, file.positions);
  EXPECT_EQ(back.uvs, (std::vector<double>{0, 0, 1, 0, 0, 1}));
}

TEST(GltfRead, WhatIsOutOfRangeIsNamed) {
  static constexpr std::uint64_t kHuge = 0xFFFFFFFFFFFFFFFF;
  expect_refusal([](Json& j) { j["accessors"][0]["count"] = 6; }, "accessors[0]: its 6 elements");
  expect_refusal([](Json& j) { j["accessors"][0]["count"] = kHuge; }, "elements reach beyond");
  expect_refusal([](Json& j) { j["accessors"][0]["count"] = 0; }, "its count is 0");
  expect_refusal([](Json& j) { j["accessors"][0]["count"] = -1; }, "count is no whole number");
  expect_refusal([](Json& j) { j["accessors"][0]["count"] = "5"; }, "count is no whole number");
  expect_refusal([](Json& j) { j["accessors"][0]["byteOffset"] = kHuge; }, "elements reach beyond");
  expect_refusal([](Json& j) { j["accessors"][0]["bufferView"] = 7; },
                 "bufferViews[7] is referred to, but there are 2 bufferViews");
  expect_refusal([](Json& j) { j["accessors"][0].erase("bufferView"); }, "it has no bufferView");
  expect_refusal([](Json& j) { j["accessors"][0]["type"] = "VEC2"; }, "positions are no vectors");
  expect_refusal([](Json& j) { j["accessors"][1]["componentType"] = 5126; }, "elements reach");
  expect_refusal([](Json& j) { j["accessors"][1]["componentType"] = 5120; }, "indices are no");
  expect_refusal([](Json& j) { j["bufferViews"][0]["byteStride"] = 4; }, "elements overlap");
  expect_refusal([](Json& j) { j["bufferViews"][0]["byteLength"] = kHuge; }, "reaches beyond");
  expect_refusal([](Json& j) { j["bufferViews"][0]["byteOffset"] = kHuge; }, "reaches beyond");
  expect_refusal([](Json& j) { j["buffers"][0]["byteLength"] = 1000; }, "cut short");
  expect_refusal([](Json& j) { j["buffers"][0]["uri"] = "data:,abc"; }, "no data in base 64");
  expect_refusal([](Json& j) { j["buffers"][0]["uri"] = "https://a/b.bin"; }, "its uri 'https:");
  expect_refusal([](Json& j) { j["buffers"][0]["uri"] = "/b.bin"; }, "--allow-outside");
  expect_refusal([](Json& j) { j["meshes"][0]["primitives"][0]["indices"] = 0; }, "indices are no");
  expect_refusal([](Json& j) { j["meshes"][0]["primitives"][0]["mode"] = 7; }, "mode 7 is none");
  expect_refusal([](Json& j) { j["meshes"][0]["primitives"][0]["material"] = 0; }, "materials[0]");
  expect_refusal([](Json& j) { j["meshes"][0]["primitives"][0].erase("indices"); },
                 "its 5 corners are no whole triangles");
  expect_refusal([](Json& j) { j["accessors"][0]["count"] = 2; }, "not below the 2 vertices");
  expect_refusal([](Json& j) { j["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = 1; },
                 "its count is 3, but that of the positions beside it is 5");
  expect_refusal(
      [](Json& j) {
        j["accessors"].push_back({{"componentType", 5121}, {"count", 5}, {"type", "SCALAR"}});
        j["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", 2}}};
      },
      "accessors[2]: the positions of a morph target are no vectors");
  expect_refusal([](Json& j) { j["meshes"] = Json::array(); }, "shows a mesh that is not there");
  expect_refusal([](Json& j) { j.erase("meshes"), j.erase("nodes"); }, "no triangles");
}

TEST(GltfRead, ListsThatAreNoneAreRefused) {
  for (const char* list : {"images", "textures", "materials", "animations", "samplers", "skins"}) {
    expect_refusal([&](Json& j) { j[list] = {{"bufferView", 0}}; }, list);
  }
}

TEST(GltfRead, NodesAreAForest) {
  expect_refusal([](Json& j) { j["nodes"][0]["children"] = {0}; }, "nodes[0]: it is below itself");
  expect_refusal(
      [](Json& j) {
        j["nodes"] = {{{"children", {1}}}, {{"children", {0}}}};
      },
      "it is below itself");
  expect_refusal([](Json& j) { j["nodes"][0]["children"] = {1, 1}; }, "the child of two nodes");
  expect_refusal([](Json& j) { j["nodes"][0]["children"] = {2}; }, "a node that is not there");
  expect_refusal([](Json& j) { j["nodes"][0]["scale"] = {1, 2}; }, "it has not 3 numbers");
}

TEST(GltfRead, WhatIsNotGltf2IsRefused) {
  const auto refused = [](const std::string& bytes) -> std::string {
    try {
      read_gltf(bytes, "a", Content::kSurface);
    } catch (const Failure& failure) {
      return failure.what();
    }
    return "nothing";
  };
  EXPECT_EQ(refused(""), "a: the file is empty");
  EXPECT_EQ(refused("{"), "a: byte 2 of the JSON is not as it should be: export the file again");
  EXPECT_EQ(refused("[1e999]"),
            "a: the JSON has a number beyond all bounds: export the file again");
  EXPECT_EQ(refused("[]"), "a: the JSON is no object: this is not glTF");
  EXPECT_EQ(refused("{}"), "a: there is no asset: this is not glTF");
  EXPECT_EQ(refused(R"({"asset":{"version":"1.0"}})"),
            "a: this is glTF 1.0: convert it to glTF 2.0 first");
  EXPECT_EQ(refused(std::string("glTF\1\0\0\0\0\0\0\0", 12)),
            "a: this is glTF 1: convert it to glTF 2.0 first");
  EXPECT_EQ(refused("glTF"), "a: the file is cut short");
  GltfBuilder builder;
  builder.mesh({{"POSITION", square(builder)}}, builder.indices<std::uint8_t>({0, 1, 2}));
  const std::string whole = builder.glb();
  for (std::size_t length = 4; length < whole.size(); ++length) {
    EXPECT_EQ(refused(whole.substr(0, length)), "a: the file is cut short") << length;
  }
  // As deep as no stack holds; the writer of JSON calls itself.
  EXPECT_EQ(refused(std::string(1000000, '[')),
            "a: the JSON is nested deeper than 200 levels: export the file again");
}

}  // namespace
}  // namespace beltrami::cli
