// glTF out: vertices are split where the UVs are, and everything else is as it was.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "files/gltf_file.h"
#include "files/mesh_file.h"
#include "gltf_builder.h"
#include "gltf_parts.h"
#include "temporary_directory.h"

namespace beltrami::cli {
namespace {

TEST(GltfWrite, WithoutSeamsOnlyTheUvsAreNew) {
  const GltfBuilder builder = rich_square();
  const Parts parts = written(builder, kWhole);
  const Parts before(builder.glb());
  EXPECT_EQ(parts.json["accessors"].size(), before.json["accessors"].size());
  for (const auto& [name, number] : before.primitive(0)["attributes"].items()) {
    const Json& accessor = parts.json["accessors"][number.get<std::size_t>()];
    EXPECT_EQ(parts.primitive(0)["attributes"][name], number) << name;
    if (name == "TEXCOORD_0") continue;
    const Json& view = before.json["accessors"][number.get<std::size_t>()]["bufferView"];
    EXPECT_EQ(parts.view(accessor["bufferView"]), before.view(view)) << name;
  }
  EXPECT_EQ(parts.primitive(0)["indices"], before.primitive(0)["indices"]);
  EXPECT_EQ(parts.values<float>(parts.primitive(0)["attributes"]["TEXCOORD_0"], 2, 2),
            (std::vector<float>{0, .75, 1, .75, 2, .75, 3, .75}));
  EXPECT_EQ(parts.chunk.size(), before.chunk.size()) << "the old UVs are gone";
}

TEST(GltfWrite, SplitVerticesHaveTheSameAttributesToTheBit) {
  const Parts parts = written(rich_square(), kCut);
  const Parts before(rich_square().glb());
  const Json& attributes = parts.primitive(0)["attributes"];
  EXPECT_EQ(parts.values<std::uint8_t>(parts.primitive(0)["indices"], 1, 1),
            (std::vector<std::uint8_t>{0, 1, 2, 4, 5, 3}))
      << "the first corner keeps the vertex, copies come behind";
  EXPECT_EQ(parts.values<float>(attributes["TEXCOORD_0"], 2, 2),
            (std::vector<float>{0, .75, 1, .75, 2, .75, 3, .75, 4, .75, 5, .75}));
  const std::map<std::string, std::size_t> sizes = {
      {"POSITION", 12}, {"NORMAL", 12},   {"TANGENT", 16}, {"COLOR_0", 4},
      {"JOINTS_0", 4},  {"WEIGHTS_0", 8}, {"_PART", 4}};
  for (const auto& [name, size] : sizes) {
    const auto bytes_of_name = [&, &attribute = name](const Parts& of) {
      const Json& number = of.primitive(0)["attributes"][attribute];
      return of.view(of.json["accessors"][number.get<std::size_t>()]["bufferView"]);
    };
    const std::string old = bytes_of_name(before);
    EXPECT_EQ(bytes_of_name(parts), old + old.substr(0, size) + old.substr(2 * size, size)) << name;
  }
  const Json& positions = parts.json["accessors"][attributes["POSITION"].get<std::size_t>()];
  EXPECT_EQ(positions["min"], Json({0, 0, 0}));
  EXPECT_EQ(positions["max"], Json({1, 1, 0}));
  EXPECT_EQ(positions["name"], "places");
  const Json& targets = parts.primitive(0)["targets"];
  EXPECT_EQ(parts.values<float>(targets[0]["POSITION"], 3, 3),
            (std::vector<float>{0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0, 4, 0, 0, 1, 0, 0, 3}));
  EXPECT_EQ(parts.values<float>(targets[1]["POSITION"], 3, 3),
            (std::vector<float>{0, 0, 0, 0, 0, 0, 5, 6, 7, 0, 0, 0, 0, 0, 0, 5, 6, 7}));
}

TEST(GltfWrite, EqualPositionsAreNotMergedAndHardEdgesStay) {
  // A cube has 24 vertices in glTF, four for each side: one UV vertex each asks for no split.
  GltfBuilder builder;
  std::vector<std::uint8_t> corners;
  const int positions =
      builder.vectors3({0, 0, 0, 0, 1, 0, 1, 1, 0, 1, 0, 0, 0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1,
                        0, 0, 0, 1, 0, 0, 1, 0, 1, 0, 0, 1, 0, 1, 0, 0, 1, 1, 1, 1, 1, 1, 1, 0,
                        0, 0, 0, 0, 0, 1, 0, 1, 1, 0, 1, 0, 1, 0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1});
  const int indices = builder.indices<std::uint8_t>(
      {0,  1,  2,  0,  2,  3,  4,  5,  6,  4,  6,  7,  8,  9,  10, 8,  10, 11,
       12, 13, 14, 12, 14, 15, 16, 17, 18, 16, 18, 19, 20, 21, 22, 20, 22, 23});
  builder.mesh({{"POSITION", positions}}, indices);
  const MeshFile file = read_bytes(builder.glb());
  EXPECT_EQ(file.vertex_count(), 24u);
  EXPECT_EQ(file.polygons.size(), 12u);
  // UV vertices of the eight corners of the welded cube: still no vertex has two.
  Corners uv_vertices;
  for (const std::uint32_t vertex : file.polygons.corners()) {
    const double* p = &file.positions[3 * std::size_t{vertex}];
    uv_vertices.push_back(static_cast<std::uint32_t>(p[0] + 2 * p[1] + 4 * p[2]));
  }
  const Parts parts(joined(write_with_uvs(file, uv_vertices).files.back()));
  EXPECT_EQ(parts.count(parts.primitive(0)["attributes"]["POSITION"]), 24u);
  EXPECT_EQ(parts.primitive(0)["indices"], indices);
}

TEST(GltfWrite, PrimitivesWithTheSameVerticesAreSplitTogether) {
  GltfBuilder builder;
  const Json attributes = {{"POSITION", builder.vectors3({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0})}};
  builder.mesh(attributes, builder.indices<std::uint8_t>({0, 1, 2}));
  const Json second = {{"attributes", attributes},
                       {"indices", builder.indices<std::uint8_t>({0, 2, 3})}};
  const Json points = {{"attributes", attributes}, {"mode", 0}};
  builder.json["meshes"][0]["primitives"].push_back(second);
  builder.json["meshes"][0]["primitives"].push_back(points);
  builder.json["meshes"].push_back({{"primitives", {second}}});
  builder.json["nodes"] = {{{"mesh", 0}}, {{"mesh", 1}}, {{"mesh", 0}, {"scale", {2, 2, 2}}}};
  // The first two join at the diagonal; the third has the number of UV vertex 0, but another mesh.
  const Parts parts = written(builder, {0, 1, 2, 0, 2, 3, 0, 5, 6});
  const Json& shared = parts.primitive(0)["attributes"];
  EXPECT_EQ(parts.primitive(0, 1)["attributes"], shared);
  EXPECT_EQ(parts.primitive(1)["attributes"], shared);
  EXPECT_EQ(parts.primitive(0, 2), points) << "points are as they were, and what they refer to";
  EXPECT_EQ(parts.values<float>(points["attributes"]["POSITION"], 3, 3).size(), 12u);
  EXPECT_EQ(parts.count(shared["POSITION"]), 7u);
  using Bytes = std::vector<std::uint8_t>;
  EXPECT_EQ(parts.values<std::uint8_t>(parts.primitive(0)["indices"], 1, 1), (Bytes{0, 1, 2}));
  EXPECT_EQ(parts.values<std::uint8_t>(parts.primitive(0, 1)["indices"], 1, 1), (Bytes{0, 2, 3}));
  EXPECT_EQ(parts.values<std::uint8_t>(parts.primitive(1)["indices"], 1, 1), (Bytes{4, 5, 6}));
  EXPECT_EQ(parts.json["nodes"], builder.json["nodes"]);
}

TEST(GltfWrite, WhatHasNoIndicesDrawsNoCopies) {
  GltfBuilder builder;
  const Json attributes = {{"POSITION", builder.vectors3({0, 0, 0, 1, 0, 0, 1, 1, 0})}};
  builder.json["meshes"] = {{{"primitives", {{{"attributes", attributes}}}}},
                            {{"primitives", {{{"attributes", attributes}}}}}};
  builder.json["nodes"] = {{{"mesh", 0}}, {{"mesh", 1}}};
  const Parts parts = written(builder, {0, 1, 2, 3, 4, 5});
  EXPECT_EQ(parts.count(parts.primitive(0)["attributes"]["POSITION"]), 6u);
  using Numbers = std::vector<std::uint16_t>;
  EXPECT_EQ(parts.values<std::uint16_t>(parts.primitive(0)["indices"], 1, 1), (Numbers{0, 1, 2}));
  EXPECT_EQ(parts.values<std::uint16_t>(parts.primitive(1)["indices"], 1, 1), (Numbers{3, 4, 5}));
}

TEST(GltfWrite, IndicesGrowWhereTheyMust) {
  GltfBuilder builder;
  const int positions = builder.vectors3({0, 0, 0, 1, 0, 0, 0, 1, 0});
  builder.mesh({{"POSITION", positions}}, builder.indices<std::uint8_t>({0, 1, 2}));
  Json& indices = builder.json["accessors"][1];
  std::string many;
  for (int i = 0; i < 30000; ++i) many += std::string("\0\1\2", 3);
  const auto type_with = [&](std::size_t triangles) {
    builder.json["bufferViews"][1] = builder.json["bufferViews"][std::size_t(builder.view(many))];
    indices["count"] = 3 * triangles;
    Corners uv_vertices(3 * triangles);
    std::iota(uv_vertices.begin(), uv_vertices.end(), 0u);
    const Parts parts = written(builder, uv_vertices);
    const Json& primitive = parts.primitive(0);
    EXPECT_EQ(parts.count(primitive["attributes"]["POSITION"]), 3 * triangles);
    return parts.json["accessors"][primitive["indices"].get<std::size_t>()]["componentType"];
  };
  EXPECT_EQ(type_with(85), 5121) << "255 vertices, the last of them 254";
  EXPECT_EQ(type_with(86), 5123);
  EXPECT_EQ(type_with(21845), 5123) << "65535 vertices";
  EXPECT_EQ(type_with(21846), 5125);
}

TEST(GltfWrite, StripsAndWhatHasNoIndicesGetThemWhereTheyMust) {
  GltfBuilder builder;
  const int positions = builder.vectors3({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0});
  builder.mesh({{"POSITION", positions}})["mode"] = 5;
  builder.mesh({{"POSITION", builder.vectors3({0, 0, 0, 1, 0, 0, 0, 1, 0})}});
  const Parts parts = written(builder, {0, 1, 2, 3, 4, 5, 6, 7, 8});
  EXPECT_EQ(parts.primitive(0)["mode"], 4);
  EXPECT_EQ(parts.values<std::uint16_t>(parts.primitive(0)["indices"], 1, 1),
            (std::vector<std::uint16_t>{0, 1, 2, 4, 3, 5}));
  EXPECT_FALSE(parts.primitive(1).contains("indices")) << "no vertex of it has two corners";
}

TEST(GltfWrite, MissingBoundsOfPositionsAreMadeWhereTheyAreSplit) {
  GltfBuilder builder;
  builder.mesh({{"POSITION", builder.vectors3({0, -2, 0, 1, 0, 0.5, 1, 1, 0, 0, 1, 7})}},
               builder.indices<std::uint8_t>({0, 1, 2, 0, 2, 3}));
  const Parts parts = written(builder, kCut);
  const Json& number = parts.primitive(0)["attributes"]["POSITION"];
  const Json& positions = parts.json["accessors"][number.get<std::size_t>()];
  EXPECT_EQ(positions["min"], Json({0.0, -2.0, 0.0}));
  EXPECT_EQ(positions["max"], Json({1.0, 1.0, 7.0}));
}

TEST(GltfWrite, TheRestOfTheDocumentIsAsItWas) {
  GltfBuilder builder = rich_square();
  const int image = builder.view("not a picture, but bytes");
  const int times = builder.accessor<float>("SCALAR", 1, {0, 1});
  const int weights = builder.accessor<float>("SCALAR", 1, {0, 0, 1, 1});
  const int binds =
      builder.accessor<float>("MAT4", 16, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
  const int secret = builder.view("of an extension nobody knows");
  Json& json = builder.json;
  json["images"] = {{{"bufferView", image}, {"mimeType", "image/png"}}};
  json["textures"] = {{{"source", 0}}};
  json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}},
                        {"extensions", {{"KHR_materials_ior", {{"ior", 1.4}}}}},
                        {"extras", {{"a", 0.1}, {"b", {nullptr, true, "\xC3\xA4"}}}}}};
  json["nodes"] = {{{"mesh", 0}, {"skin", 0}}, {{"name", "joint"}}};
  json["skins"] = {{{"joints", {1}}, {"inverseBindMatrices", binds}}};
  json["animations"] = {
      {{"samplers", {{{"input", times}, {"output", weights}}}},
       {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}}}}};
  json["extensionsUsed"] = {"NOBODY_knows", "KHR_materials_ior"};
  json["extensions"] = {{"NOBODY_knows", {{"view", secret}, {"x", 1e-300}}}};
  json["meshes"][0]["primitives"][0]["material"] = 0;
  json["meshes"][0]["weights"] = {0.25, 0};
  json["meshes"][0]["extras"] = {{"targetNames", {"up", "out"}}};
  json["scenes"] = {{{"nodes", {0, 1}}}};
  json["scene"] = 0;
  const Parts parts = written(builder, kCut);
  for (const auto& [key, value] : json.items()) {
    if (key == "accessors" || key == "bufferViews" || key == "buffers" || key == "meshes") continue;
    EXPECT_EQ(parts.json[key].dump(), value.dump()) << key;
  }
  Json mesh = parts.json["meshes"][0], before = json["meshes"][0];
  for (const char* key : {"attributes", "indices", "targets"}) {
    mesh["primitives"][0].erase(key);
    before["primitives"][0].erase(key);
  }
  EXPECT_EQ(mesh.dump(), before.dump());
  EXPECT_EQ(parts.view(image), "not a picture, but bytes");
  EXPECT_EQ(parts.view(secret), "of an extension nobody knows") << "its number is known to nobody";
  EXPECT_EQ(parts.values<float>(times, 1, 1), (std::vector<float>{0, 1}));
  EXPECT_EQ(parts.values<float>(weights, 1, 1), (std::vector<float>{0, 0, 1, 1}));
  EXPECT_EQ(parts.values<float>(binds, 16, 16).size(), 16u);
}

TEST(GltfWrite, WrittenTwiceItHasTheSameSize) {
  const auto again = [](const std::string& glb, const Corners& uv_vertices) {
    return joined(write_with_uvs(read_bytes(glb), uv_vertices).files.back());
  };
  const std::string once = again(rich_square().glb(), kCut), twice = again(once, kCut);
  EXPECT_EQ(once.size(), twice.size()) << "old UVs, and vertices from before the split, are gone";
  EXPECT_EQ(again(twice, kCut), twice);
}

TEST(GltfWrite, TangentsGoWithTheUvsThatTheyBelongedTo) {
  const auto not_kept = [](const Json& normal_texture, std::uint32_t uv_set) {
    GltfBuilder builder = rich_square();
    builder.json["materials"] = {{{"normalTexture", normal_texture}}, Json::object()};
    builder.json["meshes"][0]["primitives"][0]["material"] = 0;
    const GltfOutput output = write_with_uvs(read_bytes(builder.glb()), kCut, uv_set);
    const Parts parts(joined(output.files.back()));
    EXPECT_EQ(parts.primitive(0)["attributes"].contains("TANGENT"), output.not_kept.empty());
    return output.not_kept;
  };
  const std::vector<std::string> tangents = {"tangents"};
  EXPECT_EQ(not_kept({{"index", 0}}, 0), tangents);
  EXPECT_TRUE(not_kept({{"index", 0}}, 1).empty());
  EXPECT_EQ(not_kept({{"index", 0}, {"texCoord", 1}}, 1), tangents);
  const Json moved = {{"index", 0},
                      {"texCoord", 1},
                      {"extensions", {{"KHR_texture_transform", {{"texCoord", 0}}}}}};
  EXPECT_EQ(not_kept(moved, 0), tangents);
  EXPECT_TRUE(not_kept(moved, 1).empty());
}

TEST(GltfWrite, MorphsOfTheOldUvsAreLeftOut) {
  GltfBuilder builder = rich_square();
  Json& target = builder.json["meshes"][0]["primitives"][0]["targets"][0];
  target["TEXCOORD_0"] = builder.vectors2({0, 0, 1, 0, 0, 0, 0, 0});
  const GltfOutput output = write_with_uvs(read_bytes(builder.glb()), kCut);
  const Parts parts(joined(output.files.back()));
  EXPECT_EQ(output.not_kept, std::vector<std::string>{"morphs of UVs"});
  EXPECT_FALSE(parts.primitive(0)["targets"][0].contains("TEXCOORD_0"));
}

TEST(GltfWrite, TheBufferIsWhereTheInputHadIt) {
  const TemporaryDirectory directory;
  const GltfBuilder builder = rich_square();
  directory.file("a b.bin", builder.buffer());
  const std::string input = directory.file("a b.gltf", builder.text("a%20b.bin"));
  const MeshFile file = read_mesh(input, Content::kSurface);
  const auto put = [&](const GltfOutput& output) {
    for (const GltfOutput::File& each : output.files) {
      directory.file(std::filesystem::path(each.path).filename().string(), joined(each));
    }
    return read_mesh(output.files.back().path, Content::kSurface);
  };
  const std::vector<double> uvs = {0, .25, 1, .25, 2, .25, 4, .25, 5, .25, 3, .25};
  const GltfOutput beside = write_with_uvs(file, kCut, 0, directory.path("c%.gltf"));
  ASSERT_EQ(beside.files.size(), 2u);
  EXPECT_EQ(beside.files[0].path, directory.path("c%.bin"));
  EXPECT_EQ(corner_uvs(put(beside), 0), uvs);
  EXPECT_EQ(gltf_output_paths(file, directory.path("c%.gltf")),
            (std::vector<std::string>{directory.path("c%-1.bin"), directory.path("c%.gltf")}))
      << "c%.bin is there now";
  EXPECT_EQ(corner_uvs(put(write_with_uvs(file, kCut, 0, directory.path("c.glb"))), 0), uvs);
  EXPECT_EQ(corner_uvs(put(write_with_uvs(file, kCut, 0, input)), 0), uvs) << "in place";

  const GltfOutput embedded =
      write_with_uvs(read_bytes(builder.glb()), kCut, 0, directory.path("d.gltf"));
  EXPECT_EQ(embedded.files.size(), 1u);
  EXPECT_EQ(corner_uvs(put(embedded), 0), uvs);
}

TEST(GltfWrite, ABufferThatIsThereIsNotReplacedUnderItsModel) {
  const TemporaryDirectory directory;
  const GltfBuilder builder = rich_square();
  directory.file("a.bin", builder.buffer());
  const MeshFile file =
      read_mesh(directory.file("a.gltf", builder.text("a.bin")), Content::kSurface);
  const auto buffer_of = [&](const char* name) {
    const std::string path = write_with_uvs(file, kCut, 0, directory.path(name)).files[0].path;
    return std::filesystem::path(path).filename().string();
  };
  const auto replaced_by = [&](const char* name) {
    std::vector<std::string> names;
    for (const std::string& path : write_with_uvs(file, kCut, 0, directory.path(name)).replaced) {
      names.push_back(std::filesystem::path(path).filename().string());
    }
    return names;
  };
  const std::vector<std::string> none;
  EXPECT_EQ(buffer_of("b.gltf"), "b.bin");
  EXPECT_EQ(replaced_by("b.gltf"), none);
  EXPECT_EQ(buffer_of("a.gltf"), "a-1.bin");
  EXPECT_EQ(replaced_by("a.gltf"), std::vector<std::string>{"a.bin"}) << "in place";

  directory.file("b.bin", "of another program");
  directory.file("b.gltf", "no model");
  EXPECT_EQ(buffer_of("b.gltf"), "b-1.bin");
  EXPECT_EQ(replaced_by("b.gltf"), none) << "nothing tells that b.bin is of b.gltf";
  directory.file("b-1.bin", builder.buffer());
  directory.file("b.gltf", builder.text("b-1.bin"));
  EXPECT_EQ(buffer_of("b.gltf"), "b-2.bin");
  EXPECT_EQ(replaced_by("b.gltf"), std::vector<std::string>{"b-1.bin"});
  EXPECT_EQ(replaced_by("b.glb"), none);
  directory.file("b.gltf", builder.text("a.bin"));
  EXPECT_EQ(replaced_by("b.gltf"), none) << "the name is of another model";
}

TEST(GltfWrite, ABufferOfTheInputStaysWhereAnotherModelHasItsName) {
  const TemporaryDirectory directory;
  const GltfBuilder builder = rich_square();
  directory.file("b.bin", builder.buffer());
  directory.file("b.gltf", builder.text("b.bin"));
  const MeshFile file =
      read_mesh(directory.file("a.gltf", builder.text("b.bin")), Content::kSurface);
  const GltfOutput output = write_with_uvs(file, kCut, 0, directory.path("b.gltf"));
  EXPECT_EQ(output.files[0].path, directory.path("b-1.bin"));
  EXPECT_TRUE(output.replaced.empty());
}

TEST(GltfWrite, ImagesThatStayBehindAreNamed) {
  const TemporaryDirectory directory;
  GltfBuilder builder = rich_square();
  builder.json["images"] = {{{"uri", "wood%20a.png"}}, {{"uri", "data:image/png;base64,AAAA"}}};
  const MeshFile file = read_mesh(directory.file("a.gltf", builder.text()), Content::kSurface);
  EXPECT_TRUE(write_with_uvs(file, kCut, 0, directory.path("b.gltf")).not_kept.empty());
  EXPECT_EQ(write_with_uvs(file, kCut, 0, directory.path("c/b.gltf")).not_kept,
            std::vector<std::string>{"1 image beside the input (wood a.png)"});
}

}  // namespace
}  // namespace beltrami::cli
