// What files carry beside their surface: kept where the output can hold it, else said.
#include <gtest/gtest.h>

#include "files/column.h"
#include "files/mesh_file.h"

namespace beltrami::cli {
namespace {

using Words = std::vector<std::string>;

std::string written(MeshFile mesh, const std::string& path) {
  mesh.uvs.assign(2 * mesh.vertex_count(), 0.5);
  std::string text;
  write_mesh(mesh, path, [&](std::string_view bytes) { text += bytes; });
  return text;
}

MeshFile obj(const std::string& text) {
  return read_obj(text, "a.obj", Content::kSurface);
}
MeshFile ply(const std::string& text) {
  return read_ply(text, "a.ply", Content::kSurface);
}

/// Two quads with everything that OBJ knows, as this program writes it.
const std::string kRichObj =
    "# UVs by beltrami: one vt per vertex, in vertex order\n"
    "mtllib a.mtl\no thing\ng left side\nusemtl red\ns 1\n"
    "v 0 0 0 1 0 0\nv 1 0 0 0.501961 0.2 0\nv 2 0 0.1 0 1 0\n"
    "v 0 1 0 1 0 0\nv 1 1 0.3 1 0 0\nv 2 1 0 1 0 0\n"
    "vt 0.5 0.5\nvt 0.5 0.5\nvt 0.5 0.5\nvt 0.5 0.5\nvt 0.5 0.5\nvt 0.5 0.5\n"
    "vn 0 0 1\nvn 0 1 0\n"
    "f 1/1/1 2/2/1 5/5/1 4/4/2\ng right\nusemtl blue\nf 2/2/1 3/3/2 6/6 5/5/1\nl 6 1/1\ns off\n";

TEST(KeptInObj, EverythingButTextureCoordinates) {
  EXPECT_EQ(written(obj(kRichObj), "a.obj"), kRichObj);
  EXPECT_EQ(not_kept(obj(kRichObj), "a.obj"), Words{});
}

TEST(KeptInObj, NamesInAnotherEncodingBecomeUtf8) {
  const std::string mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  const MeshFile latin = obj(mesh + "g gr\xfcn\nf 1 2 3\n");
  EXPECT_EQ(latin.statements[0].text, "g gr\xc3\xbcn");
  EXPECT_EQ(not_kept(latin, "a.obj"), Words{"the encoding of names (Latin-1 becomes UTF-8)"});
  const MeshFile utf8 = obj(mesh + "usemtl gr\xc3\xbcn \xe2\x82\xac\nf 1 2 3\n");
  EXPECT_EQ(utf8.statements[0].text, "usemtl gr\xc3\xbcn \xe2\x82\xac");
  EXPECT_EQ(not_kept(utf8, "a.obj"), Words{});
}

TEST(KeptInObj, NamesThatOtherFilesHaveKeepTheirBytes) {
  const MeshFile latin =
      obj("mtllib gr\xfcn.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl gr\xfcn\nf 1 2 3\n");
  EXPECT_EQ(latin.statements[1].text, "usemtl gr\xc3\xbcn");
  const std::string text = written(latin, "a.obj");
  EXPECT_NE(text.find("mtllib gr\xfcn.mtl\n"), std::string::npos);
  EXPECT_NE(text.find("usemtl gr\xfcn\n"), std::string::npos);
  EXPECT_EQ(not_kept(latin, "a.obj"), Words{});
}

TEST(KeptInObj, WhateverTheOrderAndTheNumbering) {
  // Objects one after another, numbers backwards, earlier texture coordinates, comments.
  const std::string text =
      "mtllib a.mtl\n# made by hand\no a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 7 7\nvn 0 0 1\n"
      "f -3/1/-1 -2/1/-1 -1/1/-1\no b\nv 1 1 0\nvt 8 8\nvn 0 1 0\nusemtl \\\n red \nf -3//-1 "
      "-1//-1 "
      "-2//-1\nl -1/1 -2/1";
  EXPECT_EQ(written(obj(text), "b.obj"),
            "# UVs by beltrami: one vt per vertex, in vertex order\nmtllib a.mtl\no a\n"
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n"
            "vt 0.5 0.5\nvt 0.5 0.5\nvt 0.5 0.5\nvt 0.5 0.5\nvn 0 0 1\nvn 0 1 0\n"
            "f 1/1/1 2/2/1 3/3/1\no b\nusemtl \\\n red\nf 2/2/2 4/4/2 3/3/2\nl 4/4 3/3\n");
}

TEST(KeptInObj, WeightsAndShortLines) {
  const std::string text = written(obj("v 0 0 0 0.5\nv 1 0 0\nv 0 1 0 2\nf 1 2 3\n"), "a.obj");
  EXPECT_NE(text.find("v 0 0 0 0.5\nv 1 0 0\nv 0 1 0 2\n"), std::string::npos) << text;
}

TEST(KeptInObj, SaysWhatItPassesOver) {
  const std::string three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  EXPECT_EQ(not_kept(obj(three + "vp 1\ncurv 0 1 1 2\ncurv 0 1 1 2\nf 1 2 3\n"), "a.obj"),
            (Words{"statements 'vp'", "statements 'curv'"}));
  for (const char* bad : {"vn 0 0 1\nf 1//1 2//2 3//1\n", "vn 0 0 -1.#IND\nf 1//1 2//1 3//1\n",
                          "vn 0 0 1\nf 1//0 2//1 3//1\n", "vn 0 0 1\nf 1//1 2//-2 3//1\n"}) {
    const MeshFile mesh = obj(three + bad);
    EXPECT_EQ(not_kept(mesh, "a.obj"), Words{"normals (one is not a number, or not in the file)"});
    EXPECT_EQ(written(mesh, "a.obj").find("vn"), std::string::npos);
  }
  EXPECT_EQ(not_kept(obj("v 0 0 0 red\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), "a.obj"),
            Words{"numbers after the coordinates"});
}

TEST(KeptInObj, ManyKindsOfStatementsMakeAShortNote) {
  std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  for (int i = 0; i < 100; ++i) text.append("x").append(std::to_string(i)).append("\n");
  EXPECT_LT(not_kept(obj(text), "a.obj").size(), 12u);
}

TEST(KeptInPly, WhatObjAndPlyCanBothHold) {
  const std::string one_normal =
      "v 0 0 0 1 0 0\nv 1 0 0 0.501961 0 0\nv 1 1 0 0 1 0\nv 0 1 0 0 0 1\nvn 0 0 1\nvn 0 0 1\n"
      "f 1//1 2//1 3//2 4//1\n";
  const MeshFile mesh = ply(written(obj(one_normal), "b.ply"));
  EXPECT_EQ(mesh.polygons[0].size(), 4u) << "polygons stay polygons";
  ASSERT_TRUE(find_column(mesh.vertex_columns, "red"));
  const Column& red = *find_column(mesh.vertex_columns, "red");
  EXPECT_EQ(red.type(), Scalar::kU8) << "readers of PLY expect bytes";
  EXPECT_EQ(red[1], 128);
  ASSERT_TRUE(find_column(mesh.vertex_columns, "nz"));
  EXPECT_EQ((*find_column(mesh.vertex_columns, "nz"))[2], 1);
  // And back again.
  const std::string back = written(mesh, "c.obj");
  EXPECT_NE(back.find("v 0 1 0 0 0 1\n"), std::string::npos) << back;
  EXPECT_NE(back.find("f 1/1/1 2/2/2 3/3/3 4/4/4\n"), std::string::npos) << back;
  EXPECT_EQ(not_kept(mesh, "c.obj"), Words{});
}

TEST(KeptInPly, ColoursThatAreNoBytesStayFractions) {
  const MeshFile mesh =
      ply(written(obj("v 0 0 0 0.33 0 0\nv 1 0 0 1 0 0\nv 0 1 0 1 0 0\nf 1 2 3\n"), "b.ply"));
  EXPECT_EQ((*find_column(mesh.vertex_columns, "red"))[0], 0.33);
}

TEST(KeptInPly, SaysWhatOnlyObjCanHold) {
  EXPECT_EQ(not_kept(obj(kRichObj), "a.ply"),
            (Words{"materials", "objects", "groups", "smoothing groups", "lines and points",
                   "normals (a vertex has several)"}));
}

/// Every kind of property and element.
const std::string kRichPly =
    "ply\nformat ascii 1.0\ncomment TextureFile a.png\nobj_info x\nelement vertex 4\n"
    "property float x\nproperty float y\nproperty float z\nproperty uchar red\n"
    "property uchar green\nproperty uchar blue\nproperty float nx\nproperty float ny\n"
    "property float nz\nproperty float u\nproperty float v\nproperty list uchar short bones\n"
    "element edge 1\nproperty int vertex1\nproperty int vertex2\n"
    "element face 1\nproperty list uchar int vertex_index\nproperty int flags\n"
    "property list uchar float texcoord\nend_header\n"
    "0 0 0 255 128 0 0 0 1 0 0 1 7\n1 0 0 0 0 0 0 0 1 0 0 2 -8 9\n"
    "1 1 0 0 0 0 0 1 0 0 0 0\n0 1 0 0 0 0 0 0 1 0 0 0\n0 3\n4 0 1 2 3 -5 2 0.5 0.5\n";

TEST(KeptInPly, EveryPropertyInItsType) {
  const MeshFile mesh = ply(written(ply(kRichPly), "b.ply"));
  EXPECT_EQ(not_kept(mesh, "b.ply"), Words{});
  EXPECT_EQ(mesh.comments,
            (Words{"comment UVs by beltrami", "comment TextureFile a.png", "obj_info x"}));
  ASSERT_EQ(mesh.vertex_columns.size(), 7u) << "earlier UVs are replaced";
  EXPECT_EQ(mesh.vertex_columns[0].type(), Scalar::kU8);
  EXPECT_EQ(mesh.vertex_columns[3].type(), Scalar::kF32);
  const Column& bones = mesh.vertex_columns[6];
  EXPECT_TRUE(bones.is_list());
  EXPECT_EQ(bones.begin(1), 1u);
  EXPECT_EQ(bones.end(1), 3u);
  EXPECT_EQ(bones[1], -8);
  ASSERT_EQ(mesh.face_columns.size(), 1u) << "texture coordinates of corners are replaced";
  EXPECT_EQ(mesh.face_columns[0][0], -5);
  ASSERT_EQ(mesh.tables.size(), 1u);
  EXPECT_EQ(mesh.tables[0].columns[1][0], 3);
}

TEST(KeptInObj, WhatPlyAndObjCanBothHold) {
  const std::string text = written(ply(kRichPly), "b.obj");
  EXPECT_NE(text.find("v 0 0 0 1 0.5019607843137255 0\n"), std::string::npos) << text;
  EXPECT_NE(text.find("vn 0 1 0\n"), std::string::npos) << text;
  EXPECT_NE(text.find("f 1/1/1 2/2/2 3/3/3 4/4/4\n"), std::string::npos) << text;
  EXPECT_EQ(not_kept(ply(kRichPly), "b.obj"),
            (Words{"vertex property bones", "face property flags", "element edge"}));
}

TEST(KeptInPly, ValuesThatDoNotFitTheirTypeAreNotCut) {
  std::string text = kRichPly;
  text.replace(text.find("255 128 0"), 9, "300 0.5 0");
  const MeshFile mesh = ply(written(ply(text), "b.ply"));
  EXPECT_EQ(mesh.vertex_columns[0].type(), Scalar::kF64);
  EXPECT_EQ(mesh.vertex_columns[0][0], 300);
  EXPECT_EQ(mesh.vertex_columns[1][0], 0.5);
  EXPECT_EQ(mesh.vertex_columns[2].type(), Scalar::kU8);
}

TEST(KeptFromOff, NormalsAndColoursOfVertices) {
  const auto off = [](const std::string& text) {
    return read_off(text, "a.off", Content::kSurface);
  };
  const MeshFile mesh = off(
      "CNOFF\n3 1 0\n0 0 0 0 0 1 255 0 0 255\n1 0 0 0 0 1 0 255 0 255\n0 1 0 0 0 1 0 0 255 255\n"
      "3 0 1 2 1 0 0\n");
  EXPECT_NE(written(mesh, "a.obj").find("v 1 0 0 0 1 0 1\n"), std::string::npos);
  EXPECT_NE(written(mesh, "a.obj").find("vn 0 0 1\n"), std::string::npos);
  EXPECT_EQ(find_column(ply(written(mesh, "a.ply")).vertex_columns, "blue")->type(), Scalar::kU8);
  EXPECT_EQ(not_kept(mesh, "a.obj"), Words{"colours of faces"});
  EXPECT_EQ(not_kept(off("OFF\n3 1 0\n0 0 0 7\n1 0 0\n0 1 0\n3 0 1 2\n"), "a.obj"),
            Words{"numbers after the coordinates"});
}

TEST(KeptFromStl, NamesOfSolids) {
  const std::string facet =
      "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
      "endfacet\n";
  const MeshFile mesh = read_stl("solid left part\n" + facet + "endsolid\nsolid\nendsolid\n",
                                 "a.stl", Content::kSurface);
  EXPECT_NE(written(mesh, "a.obj").find("o left part\n"), std::string::npos);
  EXPECT_EQ(not_kept(mesh, "a.obj"), Words{});
  EXPECT_EQ(not_kept(mesh, "a.ply"), Words{"objects"});
}

TEST(Kept, NothingOfFacesThatAreReplaced) {
  MeshFile mesh = obj(kRichObj);
  replace_faces(mesh, {0, 1, 3, 1, 4, 3});
  EXPECT_EQ(not_kept(mesh, "a.obj"),
            (Words{"polygons", "normals of corners", "groups, materials and lines"}));
  const std::string text = written(mesh, "a.obj");
  EXPECT_NE(text.find("v 0 0 0 1 0 0\n"), std::string::npos) << "what vertices have stays";
  EXPECT_NE(text.find("f 1/1 2/2 4/4\nf 2/2 5/5 4/4\n"), std::string::npos) << text;
}

}  // namespace
}  // namespace beltrami::cli
