// Sets of UVs in glTF: the one that is new, those before it, and what draws through them.
#include <gtest/gtest.h>

#include "files/gltf_file.h"
#include "files/mesh_file.h"
#include "gltf_builder.h"
#include "gltf_parts.h"
#include "process/failure.h"

namespace beltrami::cli {
namespace {

/// The rich square, of material 0 with this texture.
GltfBuilder textured(const Json& texture) {
  GltfBuilder builder = rich_square();
  builder.json["textures"] = {Json::object()};
  builder.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", texture}}}}};
  builder.json["meshes"][0]["primitives"][0]["material"] = 0;
  return builder;
}

/// The rich square, and a mesh of one triangle without UVs.
GltfBuilder mixed() {
  GltfBuilder builder = rich_square();
  builder.mesh({{"POSITION", builder.vectors3({0, 0, 0, 1, 0, 0, 0, 1, 0})}});
  return builder;
}

const Corners kMixed = {0, 1, 2, 0, 2, 3, 4, 5, 6};

TEST(GltfSets, NoneIsLeftOutThatNoPrimitiveHas) {
  const MeshFile file = read_bytes(rich_square().glb());
  require_uv_set(file, 0);
  require_uv_set(file, 1);
  try {
    write_with_uvs(file, kWhole, 2);
    FAIL() << "TEXCOORD_1 is missing";
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.what(), std::string("a.glb: no primitive has TEXCOORD_1, and glTF leaves "
                                          "none out before TEXCOORD_2: use set 1"));
  }
  const GltfOutput output = write_with_uvs(file, kCut, 1);
  const MeshFile back = read_bytes(joined(output.files.back()));
  EXPECT_EQ(corner_uvs(back, 1),
            (std::vector<double>{0, .25, 1, .25, 2, .25, 4, .25, 5, .25, 3, .25}));
  EXPECT_EQ(corner_uvs(back, 0), corner_uvs(file, 0)) << "to the bit";
  EXPECT_TRUE(output.notes.empty());
}

TEST(GltfSets, PrimitivesWithoutThoseBeforeGetTheNewUvsThereToo) {
  const MeshFile file = read_bytes(mixed().glb());
  const GltfOutput output = write_with_uvs(file, kMixed, 1);
  const Parts parts(joined(output.files.back()));
  const MeshFile back = read_bytes(joined(output.files.back()));
  const std::vector<double> before = corner_uvs(file, 0), after = corner_uvs(back, 0);
  EXPECT_TRUE(std::equal(before.begin(), before.begin() + 12, after.begin())) << "textured: kept";
  const std::vector<double> added = corner_uvs(back, 1);
  EXPECT_TRUE(std::equal(added.begin() + 12, added.end(), after.begin() + 12)) << "plain: added";
  const Json& plain = parts.primitive(1)["attributes"];
  EXPECT_EQ(plain["TEXCOORD_0"], plain["TEXCOORD_1"]) << "stored once";
  EXPECT_EQ(output.notes, std::vector<std::string>{
                              "1 primitive had no UVs in the sets before TEXCOORD_1, which glTF "
                              "asks for: the new ones are there, too"});
  GltfBuilder bare;
  bare.mesh({{"POSITION", bare.vectors3({0, 0, 0, 1, 0, 0, 0, 1, 0})}});
  EXPECT_NO_THROW(require_uv_set(read_bytes(bare.glb()), 1))
      << "light maps of a scene without textures";
}

TEST(GltfSets, TexturesOfUvsThatAreNewAreNoted) {
  const auto notes = [](const Json& texture, std::uint32_t uv_set) {
    return write_with_uvs(read_bytes(textured(texture).glb()), kWhole, uv_set).notes;
  };
  const std::vector<std::string> none;
  const auto note = [](const std::string& set, const std::string& free) {
    return std::vector<std::string>{"1 texture (baseColorTexture of materials[0]) was for " + set +
                                    ", which is new now: beltrami transfer makes them anew, "
                                    "--uv-set " +
                                    free + " leaves them the old UVs"};
  };
  EXPECT_EQ(notes({{"index", 0}}, 0), note("TEXCOORD_0", "1"));
  EXPECT_EQ(notes({{"index", 0}}, 1), none);
  EXPECT_EQ(notes({{"index", 0}, {"texCoord", 1}}, 0), none);
  EXPECT_EQ(notes({{"index", 0}, {"texCoord", 1}}, 1), none) << "there was no such set before";
  const Json moved = {{"index", 0},
                      {"texCoord", 1},
                      {"extensions", {{"KHR_texture_transform", {{"texCoord", 0}}}}}};
  EXPECT_EQ(notes(moved, 0), note("TEXCOORD_0", "1"));
  EXPECT_EQ(notes("no texture", 0), none);
}

TEST(GltfSets, TexturesOfExtensionsOfMaterialsCountAsTheirs) {
  GltfBuilder builder = textured({{"index", 0}});
  builder.json["materials"] = {
      {{"extensions", {{"KHR_materials_clearcoat", {{"clearcoatTexture", {{"index", 0}}}}}}},
       {"extras", {{"ownTexture", {{"index", 0}}}}}},
      {{"emissiveTexture", {{"index", 0}}}},
      {{"emissiveTexture", {{"index", 0}}}}};
  builder.json["meshes"][0]["primitives"][0]["extensions"]["KHR_materials_variants"] = {
      {"mappings", {{{"material", 1}, {"variants", {0}}}}}};
  const std::vector<std::string> notes = write_with_uvs(read_bytes(builder.glb()), kWhole).notes;
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_EQ(notes[0].find("2 textures ("), 0u) << "the third is of nothing: " << notes[0];
}

TEST(GltfSets, TransformsOfTexturesGoWithTheUvsThatTheyMoved) {
  const Json transform = {{"offset", {0.5, 0}}, {"rotation", 1}, {"scale", {4, 4}}};
  const Json texture = {{"index", 0}, {"extensions", {{"KHR_texture_transform", transform}}}};
  GltfBuilder builder = textured(texture);
  builder.json["extensionsUsed"] = {"KHR_texture_transform", "NOBODY_knows"};
  builder.json["extensionsRequired"] = {"KHR_texture_transform"};
  const GltfOutput output = write_with_uvs(read_bytes(builder.glb()), kWhole);
  EXPECT_EQ(output.not_kept, std::vector<std::string>{"KHR_texture_transform of 1 texture"});
  const Json json = Parts(joined(output.files.back())).json;
  const Json& drawn = json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"];
  EXPECT_EQ(drawn, Json({{"index", 0}}));
  EXPECT_EQ(json["extensionsUsed"], Json({"NOBODY_knows"}));
  EXPECT_FALSE(json.contains("extensionsRequired"));

  const GltfOutput beside = write_with_uvs(read_bytes(builder.glb()), kWhole, 1);
  EXPECT_TRUE(beside.not_kept.empty());
  const Json kept = Parts(joined(beside.files.back())).json;
  EXPECT_EQ(kept["materials"].dump(), builder.json["materials"].dump());
  EXPECT_EQ(kept["extensionsUsed"].size(), 2u);
}

TEST(GltfSets, ATransformThatNamesASetStaysWithoutWhatMoves) {
  const Json transform = {{"scale", {4, 4}}, {"texCoord", 0}};
  const Json texture = {
      {"index", 0}, {"texCoord", 1}, {"extensions", {{"KHR_texture_transform", transform}}}};
  GltfBuilder builder = textured(texture);
  builder.json["extensionsUsed"] = {"KHR_texture_transform"};
  const Json json =
      Parts(joined(write_with_uvs(read_bytes(builder.glb()), kWhole).files.back())).json;
  const Json& drawn = json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"];
  EXPECT_EQ(drawn["extensions"]["KHR_texture_transform"], Json({{"texCoord", 0}}));
  EXPECT_EQ(json["extensionsUsed"].size(), 1u);
}

TEST(GltfSets, ExtensionsWhoseTexturesUseTheNewUvsAreNoted) {
  GltfBuilder builder = textured({{"index", 0}, {"texCoord", 1}});
  builder.json["meshes"][0]["primitives"][0]["extensions"] = {
      {"EXT_mesh_features",
       {{"featureIds", {{{"featureCount", 2}, {"texture", {{"index", 0}, {"channels", {0}}}}}}}}},
      {"OTHER_extension", {{"index", 0}}}};
  builder.json["extensions"] = {
      {"EXT_structural_metadata",
       {{"propertyTextures",
         {{{"class", "a"}, {"properties", {{"heat", {{"index", 0}, {"channels", {0}}}}}}}}}}}};
  const auto notes = [&](std::uint32_t uv_set) {
    return write_with_uvs(read_bytes(builder.glb()), kWhole, uv_set).notes;
  };
  const std::string end =
      " has textures for TEXCOORD_0, which is new now: --uv-set 1 leaves it as it is";
  EXPECT_EQ(notes(0),
            (std::vector<std::string>{"EXT_mesh_features" + end, "EXT_structural_metadata" + end}));
  EXPECT_TRUE(notes(1).empty());
}

}  // namespace
}  // namespace beltrami::cli
