// glTF that was damaged at random: refused, or read to the last proof and written.
#include <gtest/gtest.h>

#include <iterator>
#include <random>
#include <utility>

#include "files/column.h"
#include "files/gltf_file.h"
#include "files/mesh_file.h"
#include "files/polygons.h"
#include "gltf_builder.h"
#include "mutator.h"
#include "process/failure.h"

namespace beltrami::cli {
namespace {

using Json = GltfBuilder::Json;

/// Whatever the reader and the writer have a branch for.
GltfBuilder rich_scene() {
  GltfBuilder builder;
  const int positions = builder.vectors3({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
  const int places = builder.view({1}), values = builder.view(std::string(12, '\1'));
  builder.json["accessors"].push_back(
      {{"componentType", 5126},
       {"count", 4},
       {"type", "VEC3"},
       {"sparse",
        {{"count", 1},
         {"indices", {{"bufferView", places}, {"componentType", 5121}}},
         {"values", {{"bufferView", values}}}}}});
  const std::size_t morph = builder.json["accessors"].size() - 1;
  Json& primitive = builder.mesh(
      {{"POSITION", positions},
       {"TANGENT",
        builder.accessor<float>("VEC4", 4, {1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1})},
       {"TEXCOORD_0", builder.vectors2({0, 0, 1, 0, 1, 1, 0, 1})}},
      builder.indices<std::uint8_t>({0, 1, 2, 0, 2, 3}));
  primitive["targets"] = {{{"POSITION", morph}}};
  primitive["material"] = 0;
  builder.mesh({{"POSITION", positions}}, builder.indices<std::uint16_t>({0, 1, 3, 2}))["mode"] = 5;
  builder.json["materials"] = {{{"normalTexture", {{"index", 0}}}}};
  builder.json["nodes"] = {{{"mesh", 1}, {"children", {1}}, {"rotation", {0, 0, 1, 0}}},
                           {{"mesh", 0}, {"scale", {1, 2, 3}}}};
  builder.json["extensions"] = {{"UNKNOWN", {{"view", 2}}}};
  return builder;
}

/// What the command and the library rely on; then all vertices apart, and back.
void work_on(MeshFile file) {
  const std::vector<std::uint32_t> corners = file.polygons.corners();
  ASSERT_EQ(file.positions.size() % 3, 0u);
  ASSERT_EQ(corners.size() % 3, 0u);
  for (const std::uint32_t vertex : corners) ASSERT_LT(vertex, file.vertex_count());
  for (const Column& column : file.face_columns) ASSERT_EQ(column.size(), file.polygons.size());
  gltf_uvs(file, 0);

  for (std::uint32_t number = 0; number < corners.size(); ++number) {
    file.corner_uvs.of_corner.push_back(number);
    file.corner_uvs.values.insert(file.corner_uvs.values.end(), {double(number), 0.5});
  }
  for (const char* path : {"b.glb", "b.gltf"}) {
    GltfOutput output;
    try {
      output = write_gltf(file, 0, path);
    } catch (const Failure& failure) {
      FAIL() << "what was read can be written: " << failure.what();
    }
    std::string bytes;
    for (const std::string& piece : output.files.back().pieces) bytes += piece;
    const MeshFile back = read_gltf(bytes, path, Content::kAll);
    ASSERT_EQ(back.polygons.corners().size(), corners.size()) << bytes;
    for (std::size_t c = 0; c < corners.size(); ++c) {
      const std::size_t before = corners[c], after = back.polygons.corners()[c];
      ASSERT_EQ(back.uvs[2 * after], double(c)) << bytes;
      for (std::size_t k = 0; k < 3; ++k) {
        const double p = file.positions[3 * before + k], q = back.positions[3 * after + k];
        ASSERT_TRUE(p == q || (p != p && q != q)) << bytes;
      }
    }
  }
}

/// Bytes at random.
struct Bytes {
  Mutator mutator{{"-1", "0", "7", "1e999", "null", "{}", "\"\"", std::string(1, '\0'), "\xff\xff"},
                  ",:]}\n"};
  GltfBuilder scene = rich_scene();
  bool chunk = false;

  std::string whole() const { return chunk ? scene.glb() : scene.text(); }
  std::string damaged() { return mutator.damaged(whole()); }
};

/// Values in the tree of JSON: every one is well formed, and stands where it means something.
struct Values {
  std::mt19937_64 random{15};
  GltfBuilder scene = rich_scene();

  std::string whole() const { return glb_of(scene.json); }
  std::string glb_of(Json json) const {
    if (!json.is_object()) return GltfBuilder::glb_of(json.dump(), scene.buffer());
    if (!json.contains("buffers")) json["buffers"] = {{{"byteLength", scene.buffer().size()}}};
    return GltfBuilder::glb_of(json.dump(), scene.buffer());
  }

  static void collect(Json& json, std::vector<Json*>& all) {
    all.push_back(&json);
    if (!json.is_structured()) return;
    for (Json& child : json) collect(child, all);
  }
  std::string damaged() {
    static const Json pieces = Json::parse(
        R"([-1, 0, 1, 2, 3, 4, 6, 9, 12, 5120, 5121, 5123, 5125, 5126, 4294967295, 0.5, 1.0, 1e300,
            18446744073709551615, 9007199254740993, null, true, "", "VEC2", "VEC3", "MAT4", "SCALAR",
            [], {}, [0], {"bufferView": 0}, "data:application/octet-stream;base64,AAAA"])");
    static const std::vector<std::string> keys = {
        "bufferView", "byteOffset", "byteLength", "byteStride", "sparse",  "count",
        "normalized", "mode",       "indices",    "material",   "targets", "children",
        "matrix",     "extensions", "min",        "buffers",    "uri",     "texCoord",
        "NORMAL",     "TEXCOORD_0", "extras"};
    Json json = scene.json;
    for (std::size_t n = 1 + random() % 3; n > 0; --n) {
      std::vector<Json*> all;
      collect(json, all);
      Json& at = *all[random() % all.size()];
      Json piece = random() % 4 ? pieces[random() % pieces.size()] : *all[random() % all.size()];
      if (at.is_object() && random() % 2) {
        at[keys[random() % keys.size()]] = std::move(piece);
      } else if (at.is_structured() && !at.empty() && random() % 2) {
        at.erase(std::next(at.begin(), static_cast<std::ptrdiff_t>(random() % at.size())));
      } else {
        at = std::move(piece);
      }
    }
    return glb_of(json);
  }
};

/// How many of the damaged documents could be read.
template <class Damage>
int read_damaged(Damage damage, int count) {
  int read = 0;
  for (int i = 0; i < count; ++i) {
    const std::string bytes = i == 0 ? damage.whole() : damage.damaged();
    SCOPED_TRACE(bytes);
    MeshFile file;
    try {
      file = read_gltf(bytes, "a", Content::kSurface);
    } catch (const Failure& failure) {
      EXPECT_NE(failure.what(), std::string());
      continue;
    }
    ++read;
    work_on(std::move(file));
    if (::testing::Test::HasFatalFailure()) break;
  }
  return read;
}

// Damage that leaves nothing to read shows nothing.
TEST(DamagedGltf, IsRefusedOrReadToTheLastProof) {
  EXPECT_GT(read_damaged(Bytes{}, 1500), 10);
  Bytes chunk;
  chunk.chunk = true;
  EXPECT_GT(read_damaged(chunk, 1500), 10);
  EXPECT_GT(read_damaged(Values{}, 3000), 300);
}

}  // namespace
}  // namespace beltrami::cli
