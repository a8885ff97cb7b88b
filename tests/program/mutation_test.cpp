// Readers under files that were damaged at random: whatever they return can be worked on.
#include <gtest/gtest.h>

#include "binary.h"
#include "files/column.h"
#include "files/mesh_file.h"
#include "files/surface.h"
#include "mutator.h"
#include "process/failure.h"

namespace beltrami::cli {
namespace {

using Reader = MeshFile (*)(std::string_view, const std::string&, Content);

struct Seed {
  const char* name;
  Reader reader;
  std::string text;
};

std::string binary_ply(bool big) {
  std::string text = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                     "_endian 1.0\nelement vertex 4\nproperty float x\nproperty double y\n"
                     "property short z\nproperty float s\nproperty float t\nelement face 1\n"
                     "property list uchar int vertex_indices\nproperty list uchar float data\n"
                     "element edge 1\nproperty list int short data\nend_header\n";
  for (const auto& [x, y] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
    const auto u = static_cast<float>(x), v = static_cast<float>(y);
    text += bytes_of(u, big) + bytes_of(double{v}, big) + bytes_of(std::int16_t{0}, big) +
            bytes_of(u, big) + bytes_of(v, big);
  }
  text += '\4';
  for (const std::int32_t vertex : {0, 1, 2, 3}) text += bytes_of(vertex, big);
  text += '\1' + bytes_of(0.5f, big) + bytes_of(std::int32_t{1}, big);
  return text + bytes_of(std::int16_t{7}, big);
}

std::vector<Seed> seeds() {
  const std::string rich_obj =
      "mtllib a\no b\nv 0 0 0 1 0 0\nv 1 0 0 0.5 0 0\nv 1 1 0.25\nv 0 1 0\nv 0.5 2 0\n"
      "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt 0.5 2\nvn 0 0 1\nvn 0 1 0\ng c\ns 1\nusemtl d\n"
      "f 1/1/1 2/2/1 3/3/2 4/4/1\nf -2/-2/-1 -3/-3/-1 -1/-1/-2\nl 1 2/2\n";
  const std::string text_ply =
      "ply\nformat ascii 1.0\ncomment a\nelement vertex 4\nproperty float x\nproperty double y\n"
      "property float z\nproperty float s\nproperty float t\nproperty uchar red\n"
      "property list uchar int data\nelement face 1\nproperty list uchar int vertex_indices\n"
      "property int flags\nelement tristrips 1\nproperty list int int vertex_indices\n"
      "element edge 2\nproperty int a\nend_header\n0 0 0 0 0 255 0\n1 0 0 1 0 0 1 7\n"
      "1 1 0 1 1 0 2 7 8\n0 1 0 0 1 9 0\n4 0 1 2 3 5\n6 0 1 2 -1 1 2\n4\n5\n";
  const std::string off =
      "STCNOFF\n4 2 5\n0 0 0 0 0 1 255 0 0 0 0\n1 0 0 0 0 1 0 0 0 1 0\n"
      "1 1 0 0 0 1 0 0 0 1 1\n0 1 0 0 0 1 0 0 0 0 1\n4 0 1 2 3 9\n3 0 2 3\n";
  const std::string stl =
      "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\n"
      "endloop\nendfacet\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 1 0\n"
      "vertex 0 1 0\nendloop\nendfacet\nendsolid a\n";
  std::string binary_stl(80, ' ');
  binary_stl += std::string("\2\0\0\0", 4);
  for (int i = 0; i < 100; ++i) binary_stl += static_cast<char>(i % 7 ? 0 : i);
  return {{"obj", read_obj, rich_obj},
          {"off", read_off, off},
          {"text ply", read_ply, text_ply},
          {"little ply", read_ply, binary_ply(false)},
          {"big ply", read_ply, binary_ply(true)},
          {"text stl", read_stl, stl},
          {"binary stl", read_stl, binary_stl}};
}

/// Words of these formats, and what is in the way of readers.
Mutator mutator_of_text() {
  return Mutator({"-1",
                  "0",
                  "4294967295",
                  "2147483647",
                  "-9223372036854775808",
                  "99999999999999999999",
                  "1e999",
                  "nan",
                  "0.5",
                  "\n",
                  " ",
                  "/",
                  "//",
                  "\\\n",
                  "#",
                  std::string(1, '\0'),
                  "list uchar int ",
                  "element vertex 9\n",
                  "property float x\n",
                  "\xff\xff\xff\xff"},
                 " \n/");
}

void expect_whole(const std::vector<Column>& columns, std::uint64_t items) {
  for (const Column& column : columns) {
    ASSERT_EQ(items ? column.end(items - 1) : 0, column.size()) << column.name();
  }
}

/// All that the writers, the surface and the library rely on.
void expect_proved(const MeshFile& mesh) {
  const std::uint64_t vertices = mesh.vertex_count();
  ASSERT_EQ(mesh.positions.size(), 3 * vertices);
  ASSERT_TRUE(mesh.uvs.empty() || mesh.uvs.size() == 2 * vertices);
  ASSERT_EQ(mesh.polygons.open_corners(), 0u);
  for (const std::uint32_t vertex : mesh.polygons.corners()) ASSERT_LT(vertex, vertices);
  for (std::uint64_t i = 0; i < mesh.polygons.size(); ++i) ASSERT_GE(mesh.polygons[i].size(), 3u);
  expect_whole(mesh.vertex_columns, vertices);
  expect_whole(mesh.face_columns, mesh.polygons.size());
  for (const Table& table : mesh.tables) expect_whole(table.columns, table.count);
  const std::vector<std::uint32_t>& normals = mesh.normals.of_corner;
  ASSERT_TRUE(normals.empty() || normals.size() == mesh.polygons.corners().size());
  for (const std::uint32_t normal : normals) {
    ASSERT_TRUE(normal == kNoNormal || 3 * std::size_t{normal} + 2 < mesh.normals.values.size());
  }
  for (const Statement& statement : mesh.statements) {
    ASSERT_LE(statement.polygon, mesh.polygons.size());
    ASSERT_FALSE(statement.text.empty());
  }
}

/// What a run does with the file, but for the run.
void work_on(MeshFile mesh) {
  expect_proved(mesh);
  if (::testing::Test::HasFatalFailure()) return;
  try {
    for (const bool weld : {false, true}) {
      const Surface surface(mesh, weld);
      component_count(surface.view());
      for (const std::uint32_t vertex : surface.view().faces) {
        ASSERT_LT(vertex, mesh.vertex_count());
      }
    }
  } catch (const Failure&) {
    // No triangles: the file can be written all the same.
  }
  mesh.uvs.assign(2 * mesh.vertex_count(), 0.25);
  for (const char* path : {"a.obj", "a.ply"}) {
    not_kept(mesh, path);
    std::string text;
    write_mesh(mesh, path, [&](std::string_view bytes) { text += bytes; });
    const Reader reader = path == std::string("a.obj") ? read_obj : read_ply;
    const MeshFile back = reader(text, path, Content::kUvs);
    ASSERT_EQ(back.polygons.corners(), mesh.polygons.corners()) << text;
    ASSERT_EQ(back.polygons.size(), mesh.polygons.size()) << text;
  }
}

TEST(DamagedFiles, AreRefusedOrReadToTheLastProof) {
  const std::vector<Seed> all = seeds();
  Mutator mutator = mutator_of_text();
  for (const Seed& seed : all) {
    SCOPED_TRACE(seed.name);
    int read = 0;
    for (int i = 0; i < 3000; ++i) {
      const std::string text = i == 0 ? seed.text : mutator.damaged(seed.text);
      for (const Content content : {Content::kSurface, Content::kUvs}) {
        SCOPED_TRACE(text);
        MeshFile mesh;
        try {
          mesh = seed.reader(text, "a", content);
        } catch (const Failure& failure) {
          EXPECT_NE(failure.what(), std::string());
          continue;
        }
        ++read;
        work_on(std::move(mesh));
        if (HasFatalFailure()) return;
      }
    }
    EXPECT_GT(read, 100) << "damage that leaves nothing to read shows nothing";
  }
}

}  // namespace
}  // namespace beltrami::cli
