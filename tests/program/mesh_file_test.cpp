// Readers and writers.
#include "files/mesh_file.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include "binary.h"
#include "process/failure.h"
#include "temporary_directory.h"
#include "tiny_meshes.h"

namespace beltrami::cli {
namespace {

using Faces = std::vector<std::uint32_t>;
using Numbers = std::vector<double>;

MeshFile obj(const std::string& text, Content content = Content::kSurface) {
  return read_obj(text, "a.obj", content);
}

std::string obj_error(const std::string& text, Content content = Content::kSurface) {
  try {
    obj(text, content);
  } catch (const Failure& failure) {
    return failure.what();
  }
  return "read";
}

const std::string kThree = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

TEST(ReadObj, KeepsVerticesAndFacesInOrder) {
  const MeshFile mesh = obj(kSquare);
  EXPECT_EQ(mesh.positions, (Numbers{0, 0, 0, 1, 0, 0, 1, 1, 0.25, 0, 1, 0}));
  EXPECT_EQ(mesh.polygons.corners(), (Faces{0, 1, 2, 0, 2, 3}));
  EXPECT_TRUE(mesh.uvs.empty());
}

TEST(ReadObj, CountsNegativeIndicesBackwards) {
  EXPECT_EQ(obj(kThree + "f -3 -2 -1\nv 2 2 2\nf -3 -1 -2\n").polygons.corners(),
            (Faces{0, 1, 2, 1, 3, 2}));
}

TEST(ReadObj, TakesAllFormsOfCorners) {
  EXPECT_EQ(obj(kThree + "vt 0 0\nvn 0 0 1\nf 1/1 2//1 3/1/1\n").polygons.corners(),
            (Faces{0, 1, 2}));
  EXPECT_EQ(obj(kThree + "f 1/ 2/ 3/\n").polygons.corners().size(), 3u)
      << "an empty texture number";
}

TEST(ReadObj, CopesWithCommentsGroupsAndColours) {
  const MeshFile mesh = obj(
      "# v 9 9 9\nmtllib a.mtl\no thing\n\n  v 0 0 0 0.5 0.5 0.5 # red\nv\t1 0 0 1\r\nv 0 1 0\r\n"
      "g x\nusemtl y\ns off\nl 1 2\nvp 1\nf 1 2 3 # end\r\n");
  EXPECT_EQ(mesh.positions, (Numbers{0, 0, 0, 1, 0, 0, 0, 1, 0}));
  EXPECT_EQ(mesh.polygons.corners(), (Faces{0, 1, 2}));
}

TEST(ReadObj, FollowsContinuedLines) {
  const MeshFile mesh = obj("v 0 \\\n 0 0\nv 1 0\\\r\n 0\nv 0 1 0\ng a \\\nf b\nf 1 2 \\\n3\n");
  EXPECT_EQ(mesh.positions, (Numbers{0, 0, 0, 1, 0, 0, 0, 1, 0}));
  EXPECT_EQ(mesh.polygons.corners(), (Faces{0, 1, 2}));
}

TEST(ReadObj, TakesPolygons) {
  const MeshFile mesh = obj("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 2 0\nf 1 2 3\nf 1 3 5 4\n");
  EXPECT_EQ(mesh.polygons.size(), 2u);
  EXPECT_EQ(mesh.polygons.corners(), (Faces{0, 1, 2, 0, 2, 4, 3}));
  EXPECT_EQ(mesh.polygons[1].size(), 4u);
  EXPECT_EQ(mesh.polygons.of_corner(2), 0u);
  EXPECT_EQ(mesh.polygons.of_corner(3), 1u);
}

TEST(ReadObj, TakesFacesBeforeTheirVertices) {
  EXPECT_EQ(obj("f 1 2 3\n" + kThree).polygons.corners(), (Faces{0, 1, 2}));
}

TEST(ReadObj, RoundsCorrectly) {
  // 2^53 + 1 lies between two doubles, and goes to the even one, until a digit is added.
  const MeshFile mesh =
      obj("v 9007199254740993 9007199254740993.00000000000000000001 +1e-400\n"
          "v 4.9e-324 1e999 -.5\nv 0 1 0\nf 1 2 3\n");
  EXPECT_EQ(mesh.positions[0], 9007199254740992.0);
  EXPECT_EQ(mesh.positions[1], 9007199254740994.0);
  EXPECT_EQ(mesh.positions[2], 0.0);
  EXPECT_EQ(mesh.positions[3], std::numeric_limits<double>::denorm_min());
  EXPECT_TRUE(std::isinf(mesh.positions[4]));
  EXPECT_EQ(mesh.positions[5], -0.5);
}

TEST(ReadObj, SaysWhere) {
  EXPECT_EQ(obj_error("v 0 0\n"), "a.obj: line 1: a coordinate is missing: the line ends early");
  EXPECT_EQ(obj_error(kThree + "\nv 1 x 0\n"), "a.obj: line 5: a coordinate is not a number: 'x'");
  EXPECT_EQ(obj_error(kThree + "f 1 2\n"),
            "a.obj: no faces: export the surface as triangles or polygons");
  EXPECT_EQ(obj_error(kThree + "f 1 2\nf 1 2 3\nf 2 3\n\nf 1 2 4\n"),
            "a.obj: line 8: face 1 (counted from 0) names vertex number 4, which the file does not "
            "have");
  EXPECT_EQ(obj_error(kThree + "f 1 \\\n2 3\nf 1 2 4\nf 5 5 5\n"),
            "a.obj: line 6: face 1 (counted from 0) names vertex number 4, which the file does "
            "not have");
}

TEST(ReadObj, RefusesIndicesThatDoNotExist) {
  for (const char* face : {"f 0 1 2", "f 1 2 -4", "f 1 2 99999999999", "f 1 2 2147483648"}) {
    try {
      obj(kThree + "f 1 2 3\n" + face + "\n");
      ADD_FAILURE() << face;
    } catch (const Failure& failure) {
      EXPECT_EQ(failure.status, "BELTRAMI_E_INDEX_OUT_OF_RANGE") << face;
      EXPECT_EQ(failure.element_kind, BELTRAMI_ELEMENT_FACE);
      EXPECT_EQ(failure.element, 1u);
    }
  }
}

TEST(ReadObj, RefusesGarbage) {
  EXPECT_NE(obj_error("hello world\n").find("no vertices"), std::string::npos);
  EXPECT_NE(obj_error(kThree).find("no faces"), std::string::npos);
  EXPECT_NE(obj_error(std::string("\0\1\2", 3)).find("zero byte"), std::string::npos);
  EXPECT_NE(obj_error(kThree + "f 1 2 999999999999999999999\n").find("not a number"),
            std::string::npos);
  EXPECT_NE(obj_error(kThree + "f 1 2 3.5\n").find("not a number"), std::string::npos);
  EXPECT_NE(obj_error("v 1 0 1.#QNAN\n").find("'1.#QNAN'"), std::string::npos)
      << obj_error("v 1 0 1.#QNAN\n");
}

TEST(ReadObjUvs, FollowsTheFacesTextureNumbers) {
  const MeshFile mesh =
      obj(kThree + "v 5 5 5\nvt 0 1\nvt 0.5\nvt 1 0 0\nf 1/3 2/2 3/1\n", Content::kUvs);
  EXPECT_EQ(mesh.uvs, (Numbers{1, 0, 0.5, 0, 0, 1, 0, 0})) << "unused vertices get (0, 0)";
}

TEST(ReadObjUvs, GivesVerticesOneUvWhereTheirCornersAgree) {
  const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";
  EXPECT_EQ(obj(square + "vt 1 1\nf 1/1 2/2 3/3\nf 1/1 3/5 4/4\n", Content::kUvs).uvs,
            (Numbers{0, 0, 1, 0, 1, 1, 0, 1}));
  const MeshFile seam = obj(square + "vt 1 2\nf 1/1 2/2 3/3\nf 1/1 3/5 4/4\n", Content::kUvs);
  EXPECT_TRUE(seam.uvs.empty());
  EXPECT_EQ(seam.corner_uvs.of_corner, (std::vector<std::uint32_t>{0, 1, 2, 0, 4, 3}));
  EXPECT_EQ(seam.corner_uvs.values, (Numbers{0, 0, 1, 0, 1, 1, 0, 1, 1, 2}));
}

TEST(ReadObjUvs, RefusesMissingTextureNumbers) {
  EXPECT_NE(obj_error(kThree + "f 1 2 3\n", Content::kUvs).find("no texture coordinates"),
            std::string::npos);
  EXPECT_NE(obj_error(kThree + "vt 0 0\nf 1/1 2 3/1\n", Content::kUvs).find("face 0"),
            std::string::npos);
  EXPECT_NE(obj_error(kThree + "vt 0 0\nf 1/1 2/2 3/1\n", Content::kUvs)
                .find("texture coordinate number 2"),
            std::string::npos);
}

TEST(ReadOff, TakesCountsCommentsAndColours) {
  const MeshFile mesh = read_off(
      "COFF # shape\n# counts\n3 1 0\n0 0 0 255 0 0 255\n\n1 0 0 1 1 1\n0 1 0\n3 0 1 2 7 7\n",
      "a.off", Content::kSurface);
  EXPECT_EQ(mesh.positions, (Numbers{0, 0, 0, 1, 0, 0, 0, 1, 0}));
  EXPECT_EQ(mesh.polygons.corners(), (Faces{0, 1, 2}));
  EXPECT_EQ(read_off("OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2", "a.off", Content::kSurface)
                .polygons.corners(),
            (Faces{0, 1, 2}));
}

std::string off_error(const std::string& text) {
  try {
    read_off(text, "a.off", Content::kSurface);
  } catch (const Failure& failure) {
    return failure.what();
  }
  return "read";
}

TEST(ReadOff, SaysWhere) {
  EXPECT_EQ(off_error("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n2 0 1\n"),
            "a.off: no faces: export the surface as triangles or polygons");
  EXPECT_EQ(off_error("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"),
            "a.off: line 6: face 0 (counted from 0) names vertex 3, but the file has 3");
  EXPECT_EQ(off_error("OFF\n3 1 0\n0 0 0\n1 0 0\n"),
            "a.off: line 5: a coordinate is missing: the file ends early");
  EXPECT_EQ(off_error("nOFF 4\n"),
            "a.off: line 1: this is not an OFF file of three-dimensional vertices");
  EXPECT_EQ(off_error("OFF\n0 0 0\n"), "a.off: no vertices");
  EXPECT_NE(off_error("OFF\n2000000000 2000000000 0\n0 0 0\n").find("line 4"), std::string::npos)
      << "a wrong count must not take the memory for it";
}

const std::string kPlyHeader =
    "ply\r\nformat ascii 1.0\r\ncomment by hand\r\nobj_info x\r\nelement vertex 3\r\n"
    "property float x\r\nproperty uchar red\r\nproperty float32 y\r\nproperty double z\r\n"
    "property float s\r\nproperty float t\r\nelement extra 1\r\nproperty list uchar int data\r\n"
    "element face 1\r\nproperty uchar flags\r\nproperty list uchar int vertex_index\r\n"
    "end_header\r\n";

TEST(ReadPly, PassesOverWhatItDoesNotNeed) {
  const MeshFile mesh = read_ply(kPlyHeader +
                                     "0 9 0 0 0.5 0.25\n1 9 0 0 1 0\n0 9 1 0 0 1\n"
                                     "2 7 7\n5 3 0 1 2\n",
                                 "a.ply", Content::kUvs);
  EXPECT_EQ(mesh.positions, (Numbers{0, 0, 0, 1, 0, 0, 0, 1, 0}));
  EXPECT_EQ(mesh.uvs, (Numbers{0.5, 0.25, 1, 0, 0, 1}));
  EXPECT_EQ(mesh.polygons.corners(), (Faces{0, 1, 2}));
}

std::string binary_ply(bool big, int third = 2) {
  std::string text = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                     "_endian 1.0\nelement vertex 3\nproperty float x\nproperty double y\n"
                     "property short z\nelement face 1\nproperty list ushort uint vertex_indices\n"
                     "property list uchar double texcoord\nend_header\n";
  for (int i = 0; i < 3; ++i) {
    text += bytes_of(0.1f * static_cast<float>(i), big) + bytes_of(0.1 * i, big) +
            bytes_of(static_cast<std::int16_t>(-i), big);
  }
  text += bytes_of(std::uint16_t{3}, big) + bytes_of(std::uint32_t{0}, big) +
          bytes_of(std::uint32_t{1}, big) + bytes_of(static_cast<std::uint32_t>(third), big);
  return text + bytes_of(std::uint8_t{1}, big) + bytes_of(0.5, big);
}

TEST(ReadPly, TakesBothByteOrders) {
  for (const bool big : {false, true}) {
    const MeshFile mesh = read_ply(binary_ply(big), "a.ply", Content::kSurface);
    EXPECT_EQ(mesh.positions, (Numbers{0, 0, 0, 0.1f, 0.1, -1, 0.2f, 0.2, -2}));
    EXPECT_EQ(mesh.polygons.corners(), (Faces{0, 1, 2}));
  }
}

std::string ply_error(const std::string& text, Content content = Content::kSurface) {
  try {
    read_ply(text, "a.ply", content);
  } catch (const Failure& failure) {
    return failure.what();
  }
  return "read";
}

// Rows of a line each may hold more than the header names; rows that share lines are told apart by
// their numbers alone.
TEST(ReadPly, PassesOverWhatTheHeaderDoesNotName) {
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n";
  const std::string rows = "0 0 0 7\n1 0 0\n\n0 1 0\n3 0 1 2 6 0.5 0.25\n3 2 1 0\n";
  const MeshFile mesh = read_ply(header + rows, "a.ply", Content::kSurface);
  EXPECT_EQ(mesh.positions, (Numbers{0, 0, 0, 1, 0, 0, 0, 1, 0}));
  EXPECT_EQ(mesh.polygons.corners(), (Faces{0, 1, 2, 2, 1, 0}));
  EXPECT_EQ(mesh.not_kept, std::vector<std::string>{"numbers that the header does not name"});
  const MeshFile shared =
      read_ply(header + "0 0 0 1 0 0\n0 1 0 3 0 1 2\n3 2 1 0\n", "a.ply", Content::kSurface);
  EXPECT_EQ(shared.polygons.corners(), (Faces{0, 1, 2, 2, 1, 0}));
  EXPECT_TRUE(shared.not_kept.empty());
}

TEST(ReadPly, CountsWhatIsStoredAndNothingElse) {
  const std::string coordinates = "property float x\nproperty float y\nproperty float z\n";
  const std::string uvs = "property float s\nproperty float t\n";
  const std::string face = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  const std::string begin = "ply\nformat ascii 1.0\n", rows = "0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n";
  EXPECT_EQ(ply_error(begin + "element vertex 1000000\nelement vertex 3\n" + coordinates + uvs +
                          face + rows + "3 0 1 999999\n",
                      Content::kUvs),
            "a.ply: line 4: a second element 'vertex'");
  EXPECT_EQ(ply_error(begin + "element vertex 3\n" + face + "3 0 1 2\n", Content::kUvs),
            "a.ply: vertices without the properties x, y and z");
  EXPECT_EQ(ply_error(begin + "element vertex 3\n" + coordinates + "property float x\n" + face),
            "a.ply: line 7: a second property 'x'");
  // Faces before the vertices: the upper end is known later.
  const std::string faces_first = begin +
                                  "element face 1\nproperty list uchar int vertex_indices\n" +
                                  "element vertex 3\n" + coordinates + "end_header\n";
  EXPECT_EQ(ply_error(faces_first + "3 0 1 2\n0 0 0\n1 0 0\n0 1 0\n"), "read");
  EXPECT_EQ(ply_error(faces_first + "3 0 1 3\n0 0 0\n1 0 0\n0 1 0\n"),
            "a.ply: face 0 (counted from 0) names vertex 3, but the file has 3");
  for (const char* bad : {"3 0 1 0.5", "3 0 1 -1", "3 0 1 nan", "2.5 0 1 2", "-1 0 1 2"}) {
    EXPECT_NE(ply_error(faces_first + bad + "\n0 0 0\n1 0 0\n0 1 0\n"), "read") << bad;
  }
}

TEST(ReadPly, AWrongCountTakesNoMemory) {
  const std::string vertices =
      "element vertex 2000000000\nproperty float x\nproperty float y\nproperty float z\n";
  const std::string faces = "element face 2000000000\nproperty list uint int vertex_indices\n";
  for (const char* format : {"ascii", "binary_little_endian"}) {
    const std::string begin = std::string("ply\nformat ") + format + " 1.0\n";
    const std::string other = "element other 2000000000\nproperty list uint double data\n";
    for (const std::string& elements :
         {vertices + faces, faces + vertices, other + vertices + faces}) {
      EXPECT_NE(ply_error(begin + elements + "end_header\n9 9 9 9 9 9 9"), "read");
    }
  }
}

TEST(ReadPly, TakesTriangleStrips) {
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\n"
      "property float z\nelement tristrips 2\nproperty list int int vertex_indices\nend_header\n"
      "0 0 0\n0 1 0\n1 0 0\n1 1 0\n2 0 0\n2 1 0\n";
  const auto corners = [&](const std::string& strips) {
    return read_ply(header + strips, "a.ply", Content::kSurface).polygons.corners();
  };
  EXPECT_EQ(corners("4 0 1 2 3\n0\n"), (Faces{0, 1, 2, 2, 1, 3}));
  EXPECT_EQ(corners("7 0 1 2 -1 2 3 4\n3 4 3 5\n"), (Faces{0, 1, 2, 2, 3, 4, 4, 3, 5}))
      << "-1 begins a new strip";
  EXPECT_EQ(corners("8 0 1 2 2 3 3 4 5\n0\n"), (Faces{0, 1, 2, 4, 3, 5}))
      << "repeated vertices are no faces, but they are counted";
  EXPECT_EQ(ply_error(header + "4 0 1 2 6\n0\n"),
            "a.ply: line 16: face 1 (counted from 0) names vertex 6, but the file has 6");
  EXPECT_EQ(ply_error(header + "0\n2 1 2\n"),
            "a.ply: no faces: export the surface as triangles or polygons");
}

TEST(ReadPly, EveryTruncationIsAnError) {
  const std::string whole = binary_ply(false);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_NE(ply_error(whole.substr(0, size)), "read") << size;
  }
  EXPECT_EQ(ply_error(whole.substr(0, whole.find("end_header\n") + 11 + 20)),
            "a.ply: the file is truncated: it ends in vertex 1 (counted from 0) of 3");
}

TEST(ReadPly, SaysWhere) {
  EXPECT_EQ(ply_error(binary_ply(true, 3)),
            "a.ply: face 0 (counted from 0) names vertex 3, but the file has 3");
  EXPECT_EQ(ply_error(kPlyHeader + "0 9 0 0 0 0\n1 9 0 0 1 x\n"),
            "a.ply: line 19: a value is not a number: 'x'");
  EXPECT_EQ(ply_error(kPlyHeader + "0 9 0 0 0 0\n1 9 0 0 1 0\n0 9 1 0 0 1\n0\n5 2 0 1\n"),
            "a.ply: no faces: export the surface as triangles or polygons");
  EXPECT_EQ(ply_error(std::string("ply\nformat ascii 1.0\nelement vertex 3\0\nproperty", 47)),
            "a.ply: line 3: an element count is not a number: '3 '");
  EXPECT_EQ(ply_error("ply\nformat ascii 1.0\nelement vertex 1\nproperty quad x\n"),
            "a.ply: line 4: unknown property type 'quad'");
  EXPECT_EQ(ply_error("garbage"),
            "a.ply: line 1: this is not a PLY file: it does not begin with 'ply'");
  std::string without_uvs = binary_ply(false);
  without_uvs.replace(without_uvs.find("texcoord"), 8, "nonsense");
  EXPECT_NE(ply_error(without_uvs, Content::kUvs).find("no texture coordinates"),
            std::string::npos);
}

std::string binary_stl() {
  std::string text = "solid, although binary";
  text.resize(80, ' ');
  text += bytes_of(std::uint32_t{2}, false);
  const float corners[6][3] = {{0, 0, 0},     {1, 0, 0},     {1, 1, 0.25f},
                               {0, -0.0f, 0}, {1, 1, 0.25f}, {0, 1, 0}};
  for (int face = 0; face < 2; ++face) {
    text += std::string(12, '\0');
    for (int k = 0; k < 3; ++k) {
      for (const float x : corners[3 * face + k]) text += bytes_of(x, false);
    }
    text += std::string(2, '\0');
  }
  return text;
}

const std::string kTextStl =
    "solid a\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n"
    "   vertex 1 1 2.5e-1\n  endloop\n endfacet\n facet normal 0 0 1\n  outer loop\n"
    "   vertex 0 0 0\n   vertex 1 1 0.25\n   vertex 0 1 0\n  endloop\n endfacet\nendsolid a\n";

TEST(ReadStl, WeldsEqualCorners) {
  for (const std::string& text : {binary_stl(), kTextStl}) {
    const MeshFile mesh = read_stl(text, "a.stl", Content::kSurface);
    EXPECT_EQ(mesh.positions, obj(kSquare).positions);
    EXPECT_EQ(mesh.polygons.corners(), obj(kSquare).polygons.corners());
    EXPECT_EQ(mesh.welded_corners, 2u);
  }
}

TEST(ReadStl, WeldsManyCorners) {
  std::string text = "solid\n";
  for (int i = 0; i < 3000; ++i) {
    text += "facet\nouter loop\nvertex 0 0 0\nvertex " + std::to_string(i) + " 1 0\nvertex " +
            std::to_string(i + 1) + " 1 0\nendloop\nendfacet\n";
  }
  const MeshFile mesh = read_stl(text + "endsolid\n", "a.stl", Content::kSurface);
  EXPECT_EQ(mesh.polygons.size(), 3000u);
  EXPECT_EQ(mesh.vertex_count(), 3002u);
  EXPECT_EQ(mesh.welded_corners, 9000u - 3002u);
}

std::string stl_error(const std::string& text) {
  try {
    read_stl(text, "a.stl", Content::kSurface);
  } catch (const Failure& failure) {
    return failure.what();
  }
  return "read";
}

TEST(ReadStl, RefusesWhatIsIncomplete) {
  EXPECT_NE(stl_error(kTextStl.substr(0, 90)), "read");
  EXPECT_EQ(stl_error(kTextStl.substr(0, 90)),
            "a.stl: the file is truncated: it ends in face 0 (counted from 0)");
  std::string binary = binary_stl();
  binary[0] = 'x';
  EXPECT_NE(stl_error(binary.substr(0, binary.size() - 1)).find("truncated"), std::string::npos);
  EXPECT_NE(stl_error("garbage").find("not an STL"), std::string::npos);
  EXPECT_EQ(stl_error(std::string(84, char{0})),
            "a.stl: no faces: export the surface as triangles or polygons");
}

TEST(ReadMesh, GoesByTheExtensionInAnyCase) {
  EXPECT_EQ(format_of("a.OBJ"), MeshFormat::kObj);
  EXPECT_EQ(format_of("b.c/d.Stl"), MeshFormat::kStl);
  EXPECT_EQ(format_of("a.GLB"), MeshFormat::kGltf);
  EXPECT_EQ(format_of("a.gltf"), MeshFormat::kGltf);
  EXPECT_THROW(format_of("a.obj.gz"), Failure);
  EXPECT_THROW(format_of("obj"), Failure);
  EXPECT_THROW(require_writable_format("a.stl"), Failure);
}

TEST(ReadMesh, CopesWithForeignLineEndsAndByteOrderMarks) {
  const TemporaryDirectory directory;
  std::string text = "\xEF\xBB\xBF" + kSquare;
  std::replace(text.begin(), text.end(), '\n', '\r');
  EXPECT_EQ(read_mesh(directory.file("a.obj", text), Content::kSurface).polygons.corners(),
            obj(kSquare).polygons.corners());
}

TEST(ReadMesh, RefusesWhatIsNoFile) {
  const TemporaryDirectory directory;
  EXPECT_THROW(read_mesh(directory.path("none.obj"), Content::kSurface), Failure);
  EXPECT_THROW(read_mesh(directory.file("empty.obj", ""), Content::kSurface), Failure);
  std::filesystem::create_directory(directory.path("folder.obj"));
  EXPECT_THROW(read_mesh(directory.path("folder.obj"), Content::kSurface), Failure);
}

std::string written(const MeshFile& mesh, const std::string& path) {
  std::string text;
  write_mesh(mesh, path, [&](std::string_view bytes) { text += bytes; });
  return text;
}

TEST(WriteMesh, HasOneTextureCoordinatePerVertex) {
  MeshFile mesh = obj(kThree + "f 3 1 2\n");
  mesh.uvs = {0.1, 0.2, 1e-5, 1e22, -3, 0.30000000000000004};
  EXPECT_EQ(written(mesh, "a.obj"),
            "# UVs by beltrami: one vt per vertex, in vertex order\nv 0 0 0\nv 1 0 0\nv 0 1 0\n"
            "vt 0.1 0.2\nvt 1e-05 1e+22\nvt -3 0.30000000000000004\nf 3/3 1/1 2/2\n");
}

TEST(WriteMesh, EveryBitSurvives) {
  MeshFile mesh;
  std::mt19937_64 random(7);
  while (mesh.positions.size() < 30000) {
    const auto value = std::bit_cast<double>(random());
    if (std::isfinite(value)) mesh.positions.push_back(value);
  }
  mesh.positions[0] = -0.0;
  mesh.positions[1] = std::numeric_limits<double>::denorm_min();
  mesh.positions[2] = std::numeric_limits<double>::max();
  mesh.uvs.assign(mesh.positions.rbegin(), mesh.positions.rbegin() + 20000);
  for (std::uint32_t i = 0; i + 2 < 10000; ++i) {
    for (const std::uint32_t vertex : {i, i + 2, i + 1}) mesh.polygons.add_corner(vertex);
    mesh.polygons.end_polygon();
  }
  const auto same_bits = [](const Numbers& a, const Numbers& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
  };
  const MeshFile text = obj(written(mesh, "a.obj") + "f 9999 10000 1\n", Content::kSurface);
  const MeshFile binary = read_ply(written(mesh, "a.ply"), "a.ply", Content::kUvs);
  EXPECT_TRUE(same_bits(text.positions, mesh.positions));
  EXPECT_TRUE(same_bits(binary.positions, mesh.positions));
  EXPECT_TRUE(same_bits(binary.uvs, mesh.uvs));
  EXPECT_EQ(binary.polygons.corners(), mesh.polygons.corners());
  EXPECT_TRUE(same_bits(obj(written(mesh, "a.obj"), Content::kUvs).uvs, mesh.uvs));
}

}  // namespace
}  // namespace beltrami::cli
