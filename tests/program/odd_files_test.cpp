// Files that other programs take, and that this one is to take as well.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "binary.h"
#include "files/column.h"
#include "files/mesh_file.h"
#include "process/failure.h"
#include "temporary_directory.h"

namespace beltrami::cli {
namespace {

using Faces = std::vector<std::uint32_t>;
using Words = std::vector<std::string>;

const Faces kTwo = {0, 1, 2, 0, 2, 3};

MeshFile off(const std::string& text, Content content = Content::kSurface) {
  return read_off(text, "a.off", content);
}
MeshFile stl(const std::string& text) {
  return read_stl(text, "a.stl", Content::kSurface);
}
MeshFile ply(const std::string& text, Content content = Content::kSurface) {
  return read_ply(text, "a.ply", content);
}

TEST(OddOff, CountsWordsAndNotLines) {
  const std::vector<double> square = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
  const std::string vertices = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n", faces = "3 0 1 2\n3 0 2 3\n";
  for (const std::string& text :
       {"OFF4 2 0\n" + vertices + faces, "off\n4 2 0\n" + vertices + faces,
        "Off 4 2\n" + vertices + faces, "4 2 0\n" + vertices + faces,
        "OFF\n4\n2\n5\n" + vertices + faces, "OFF # a\n4 2 # b\n" + vertices + faces,
        "OFF\n4 2 0\n" + vertices + "3 0 1\n2\n3 0\n2 3\n",
        "OFF\n4 2 0\n" + vertices + "3 0 1 2 3 0 2 3\n",
        std::string("OFF 4 2 0 0 0 0 1 0 0 1 1 0 0 1 0 3 0 1 2 3 0 2 3"),
        "OFF\n4 2 0\n0 0 0 1 0 0\n1 1 0 0 1 0\n" + faces,
        "OFF\n4 2 0\n0 0\n0 1 0 0 1\n1 0 0 1 0\n" + faces,
        std::string("OFF\n4\n2\n0\n0\n0\n0\n1\n0\n0\n1\n1\n0\n0\n1\n0\n3\n0\n1\n2\n3\n0\n2\n3\n"),
        "nOFF 3\n4 2 0\n" + vertices + faces,
        std::string("4OFF\n4 2 0\n0 0 0 1\n2 0 0 2\n1 1 0 1\n0 1 0 1\n") + faces}) {
    const MeshFile mesh = off(text);
    EXPECT_EQ(mesh.positions, square) << text;
    EXPECT_EQ(mesh.polygons.corners(), kTwo) << text;
    EXPECT_EQ(not_kept(mesh, "a.obj"), Words{}) << text;
  }
}

TEST(OddOff, KeepsWhatTheHeaderSaysAlsoBrokenIntoLines) {
  const std::string rest = "3 0 1 2\n";
  for (const std::string& text :
       {"NOFF\n3 1 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n" + rest,
        "noff 3 1 0\n0 0 0\n0 0 1\n1 0 0\n0 0 1\n0 1 0\n0 0 1\n" + rest}) {
    const MeshFile mesh = off(text);
    ASSERT_EQ(mesh.vertex_columns.size(), 3u) << text;
    EXPECT_EQ(mesh.vertex_columns[2][1], 1) << text;
    EXPECT_EQ(mesh.positions[3], 1) << text;
  }
  const std::string with_uvs = "STOFF\n3 1 0\n0 0 0 0 0\n1 0 0 0.5 0\n0 1 0 0 0.75\n" + rest;
  EXPECT_EQ(off(with_uvs, Content::kUvs).uvs, (std::vector<double>{0, 0, 0.5, 0, 0, 0.75}));
  EXPECT_EQ(not_kept(off(with_uvs), "a.obj"), Words{});
}

TEST(OddOff, EndsAmidItsFacesOrHasShortOnes) {
  const std::string begin = "OFF\n4 4 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
  const MeshFile cut = off(begin + "3 0 1 2\n3 0 2 3\n3 1 2\n");
  EXPECT_EQ(cut.polygons.corners(), kTwo);
  EXPECT_NE(cut.truncated.find("face 2"), std::string::npos) << cut.truncated;
  const MeshFile brief = off(begin + "3 0 1 2\n2 0 1\n3 0 2 3\n1 0\n");
  EXPECT_EQ(brief.polygons.corners(), kTwo);
  EXPECT_EQ(brief.short_faces, 2u);
  EXPECT_EQ(not_kept(brief, "a.obj"), Words{"2 faces of fewer than three corners"});
}

std::string facet(const std::string& corners) {
  return " facet normal 0 0 1\n  outer loop\n" + corners + "  endloop\n endfacet\n";
}
const std::string kSolid = "solid a\n" +
                           facet("   vertex 0 0 0\n   vertex 1 0 0\n   vertex 1 1 0\n") +
                           facet("   vertex 0 0 0\n   vertex 1 1 0\n   vertex 0 1 0\n");

std::string upper(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

TEST(OddStl, TakesTextInAnyCaseBehindBlanksAndWithoutItsLastLine) {
  const std::string whole = kSolid + "endsolid a\n";
  for (const std::string& text :
       {whole, upper(whole), "  " + whole, "\n\n" + whole, "\t\r\n" + whole, kSolid,
        kSolid.substr(kSolid.find('\n')), kSolid + " endloop\n endfacet\n\n",
        kSolid + "color 1 0 0\nendsolid"}) {
    EXPECT_EQ(stl(text).polygons.corners(), kTwo) << text;
  }
  EXPECT_EQ(not_kept(stl(whole), "a.obj"), Words{});
  EXPECT_EQ(not_kept(stl(kSolid), "a.obj"),
            Words{"what may be missing of the input (it has no endsolid)"});
  EXPECT_EQ(not_kept(stl(whole + "color 1 0 0"), "a.obj"), Words{"lines 'color'"});
}

TEST(OddStl, TakesFacesOfOtherCornersThanThree) {
  const MeshFile mesh =
      stl("solid\n" + facet("vertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nvertex 0 1 0\n") +
          facet("vertex 0 0 0\nvertex 1 0 0\n") + "endsolid\n");
  EXPECT_EQ(mesh.polygons.size(), 1u);
  EXPECT_EQ(mesh.polygons[0].size(), 4u);
  EXPECT_EQ(mesh.short_faces, 1u);
}

TEST(OddStl, ATextThatEndsInAFacetIsTakenAsFarAsItGoes) {
  const MeshFile mesh = stl(kSolid + " facet normal 0 0 1\n  outer loop\n   vertex 0 0");
  EXPECT_EQ(mesh.polygons.corners(), kTwo);
  EXPECT_EQ(mesh.truncated, "the file is truncated: it ends in face 2 (counted from 0)");
}

/// Two facets behind a header that begins with `name`.
std::string binary(const std::string& name, std::uint32_t count) {
  std::string text = name;
  text.resize(80, ' ');
  text += bytes_of(count, false);
  for (const auto& corners : {std::vector<float>{0, 0, 0, 1, 0, 0, 1, 1, 0},
                              std::vector<float>{0, 0, 0, 1, 1, 0, 0, 1, 0}}) {
    text += std::string(12, '\0');
    for (const float x : corners) text += bytes_of(x, false);
    text += std::string(2, '\0');
  }
  return text;
}

TEST(OddStl, TakesBinaryThatBeginsWithSolidOrHasBytesBehind) {
  for (const char* name : {"solid exported by X", "SOLID", "x", " solid"}) {
    EXPECT_EQ(stl(binary(name, 2)).polygons.corners(), kTwo) << name;
    const MeshFile longer = stl(binary(name, 2) + std::string(37, '\0'));
    EXPECT_EQ(longer.polygons.corners(), kTwo) << name;
    EXPECT_EQ(not_kept(longer, "a.obj"), Words{"37 bytes behind the facets"});
  }
  for (const std::uint32_t uncounted : {0U, 0xFFFFFFFFU}) {
    EXPECT_EQ(stl(binary("x", uncounted)).polygons.corners(), kTwo) << uncounted;
  }
  EXPECT_THROW(stl(binary("solid", 3)), Failure) << "a facet is missing";
  EXPECT_THROW(stl(binary("x", 2000000000)), Failure);
}

const std::string kPlyVertices =
    "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
const std::string kPlyRows = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

TEST(OddPly, PassesOverHeaderLinesThatItDoesNotKnow) {
  const MeshFile mesh =
      ply("PLY\nFormat ascii 1.0\nauthor me\nauthor you\n\nDate 2001\n" + kPlyVertices +
          "element face 2\nproperty list UCHAR int vertex_index\n" + "END_HEADER\n" + kPlyRows +
          "3 0 1 2\n3 0 2 3\n");
  EXPECT_EQ(mesh.polygons.corners(), kTwo);
  EXPECT_EQ(not_kept(mesh, "a.obj"), (Words{"header lines 'author'", "header lines 'date'"}));
}

TEST(OddPly, SetsFacesOfTwoCornersAsideWithWhatTheyHave) {
  const MeshFile mesh =
      ply("ply\nformat ascii 1.0\n" + kPlyVertices +
              "element face 4\nproperty uchar flag\nproperty list uchar float texcoord\n"
              "property list uchar int vertex_index\nend_header\n" +
              kPlyRows + "7 4 9 9 9 9 2 0 1\n8 6 0 0 1 0 1 1 3 0 1 2\n9 0 0\n" +
              "10 6 0 0 1 1 0 1 3 0 2 3\n",
          Content::kAll);
  EXPECT_EQ(mesh.polygons.corners(), kTwo);
  EXPECT_EQ(mesh.short_faces, 2u);
  EXPECT_EQ(mesh.uvs, (std::vector<double>{0, 0, 1, 0, 1, 1, 0, 1}));
  const Column* flags = find_column(mesh.face_columns, "flag");
  ASSERT_EQ(flags->size(), 2u);
  EXPECT_EQ((*flags)[0], 8);
  EXPECT_EQ((*flags)[1], 10);
}

TEST(OddPly, TakesAHeaderOfLinesThatEndInReturns) {
  const TemporaryDirectory directory;
  std::string header = "ply\nformat binary_little_endian 1.0\n" + kPlyVertices +
                       "element face 2\nproperty list uchar uchar vertex_index\nend_header\n";
  for (char& c : header) c = c == '\n' ? '\r' : c;
  for (const float x : {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}) header += bytes_of(x, false);
  header += std::string("\3\0\1\2\3\0\2\3", 8);
  EXPECT_EQ(read_mesh(directory.file("a.ply", header), Content::kSurface).polygons.corners(), kTwo);
}

TEST(OddPly, RefusesThousandsOfNames) {
  std::string header = "ply\nformat ascii 1.0\nelement vertex 1\n";
  for (int i = 0; i < 5000; ++i) header += "property float p" + std::to_string(i) + "\n";
  EXPECT_THROW(ply(header + "end_header\n"), Failure);
}

TEST(OddObj, FacesOfTwoCornersBecomeLines) {
  const std::string text =
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nvt 0 0\nf 1\nf 1/1/1 2/1/1\nf 1//1 2//1 "
      "3//1\nf\nf 1 3 4\nf 1 9\n";
  const MeshFile mesh = read_obj(text, "a.obj", Content::kSurface);
  EXPECT_EQ(mesh.polygons.corners(), kTwo);
  EXPECT_EQ(mesh.short_faces, 4u);
  EXPECT_EQ(mesh.normals.of_corner, (Faces{0, 0, 0, kNoNormal, kNoNormal, kNoNormal}));
  ASSERT_EQ(mesh.statements.size(), 2u);
  EXPECT_EQ(mesh.statements[0].text, "p 1");
  EXPECT_EQ(mesh.statements[1].text, "l 1 2");
  EXPECT_EQ(not_kept(mesh, "b.obj"), Words{"4 faces of fewer than three corners"});
  const MeshFile uvs = read_obj(
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/3 2/3\nf "
      "1/1 2/2 3/3\n",
      "a.obj", Content::kUvs);
  EXPECT_EQ(uvs.uvs, (std::vector<double>{0, 0, 1, 0, 0, 1}));
}

TEST(OddObj, LinesThatNameNothingAreLeftOut) {
  const MeshFile mesh = read_obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2\nl 0 1\np x\nf 1 2 3\n", "a.obj",
                                 Content::kSurface);
  ASSERT_EQ(mesh.statements.size(), 1u);
  EXPECT_EQ(not_kept(mesh, "b.obj"), Words{"lines and points that name what is no vertex"});
}

}  // namespace
}  // namespace beltrami::cli
