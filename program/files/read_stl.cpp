// STL, text and binary. STL repeats the coordinates of every corner: corners with the same
// coordinates become one vertex, numbered by first appearance. Names of solids and attributes of
// binary facets are kept; normals of facets are not, being those of their corners.
#include <bit>

#include "files/column.h"
#include "files/mesh_file.h"
#include "files/point_numbers.h"
#include "files/text_cursor.h"
#include "process/failure.h"

namespace beltrami::cli {
namespace {

constexpr std::uint64_t kHeaderBytes = 84, kFacetBytes = 50;

class Corners {
 public:
  Corners(MeshFile& mesh, const std::string& path) : mesh_(mesh), path_(path) {}

  void add(double x, double y, double z) {
    if (points_.size() >= static_cast<std::uint32_t>(kMaxIndex)) {
      throw Failure(path_ + ": more vertices than can be numbered");
    }
    const std::uint32_t before = points_.size();
    mesh_.polygons.add_corner(points_.number({x, y, z}));
    mesh_.welded_corners += points_.size() == before;
  }

  void finish() { mesh_.positions = points_.take_coordinates(); }

 private:
  MeshFile& mesh_;
  const std::string& path_;
  PointNumbers<3> points_;
};

std::uint32_t little_u32(const char* bytes) {
  std::uint32_t value = 0;
  for (int k = 3; k >= 0; --k) value = value << 8 | static_cast<unsigned char>(bytes[k]);
  return value;
}

/// The size is the only certain mark: many binary files begin with "solid".
bool is_binary(std::string_view text) {
  return text.size() >= kHeaderBytes &&
         text.size() == kHeaderBytes + kFacetBytes * std::uint64_t{little_u32(text.data() + 80)};
}

MeshFile read_binary(std::string_view text, const std::string& path) {
  MeshFile mesh;
  Corners corners(mesh, path);
  const std::uint64_t faces = (text.size() - kHeaderBytes) / kFacetBytes;
  mesh.polygons.reserve(faces);
  Column attributes("attributes", Scalar::kU16);
  bool any = false;
  for (std::uint64_t i = 0; i < faces; ++i) {
    const char* facet = text.data() + kHeaderBytes + kFacetBytes * i + 12;  // after the normal
    for (int k = 0; k < 3; ++k, facet += 12) {
      corners.add(std::bit_cast<float>(little_u32(facet)),
                  std::bit_cast<float>(little_u32(facet + 4)),
                  std::bit_cast<float>(little_u32(facet + 8)));
    }
    mesh.polygons.end_polygon();
    const unsigned attribute =
        static_cast<unsigned char>(facet[0]) | static_cast<unsigned char>(facet[1]) << 8;
    attributes.append(attribute);
    any |= attribute != 0;
  }
  corners.finish();
  if (any) mesh.face_columns.push_back(std::move(attributes));
  return mesh;
}

class TextReader {
 public:
  TextReader(std::string_view text, const std::string& path)
      : cursor_(text, path), corners_(mesh_, path) {}

  MeshFile read() {
    for (cursor_.skip_to_word(); !cursor_.at_end(); cursor_.skip_to_word()) read_statement();
    if (in_solid_) cursor_.fail("the file is truncated: it has no endsolid");
    corners_.finish();
    return std::move(mesh_);
  }

 private:
  void read_statement() {
    const std::string_view keyword = cursor_.word();
    if (keyword == "vertex") {
      const double x = cursor_.number("a coordinate"), y = cursor_.number("a coordinate");
      corners_.add(x, y, cursor_.number("a coordinate"));
    } else if (keyword == "endloop" || keyword == "facet" || keyword == "endsolid") {
      end_face(keyword == "endloop" ? 3 : 0);
      if (keyword != "endloop") cursor_.skip_line();  // a normal or a name
      if (keyword == "endsolid") in_solid_ = false;
    } else if (keyword == "solid") {
      in_solid_ = true;
      read_name();
    } else if (keyword != "outer" && keyword != "loop" && keyword != "endfacet") {
      cursor_.fail("unknown keyword '" + std::string(keyword.substr(0, 40)) + "'");
    }
  }

  void end_face(std::uint64_t expected) {
    const std::uint64_t face = mesh_.polygons.size(), found = mesh_.polygons.open_corners();
    if (found != expected) {
      cursor_.fail("face " + std::to_string(face) + " (counted from 0) has " +
                       std::to_string(found) + " corners instead of 3",
                   BELTRAMI_ELEMENT_FACE, face);
    }
    if (expected > 0) mesh_.polygons.end_polygon();
  }

  /// The name of a solid is an object of the mesh.
  void read_name() {
    cursor_.skip_blanks();
    const char* begin = cursor_.position();
    const bool named = !cursor_.at_line_end();
    cursor_.skip_line();
    if (!named) return;
    std::string line = "o " + std::string(begin, cursor_.position());
    line.erase(line.find_last_not_of(" \t\r\n\\") + 1);
    mesh_.statements.push_back({mesh_.polygons.size(), std::move(line)});
  }

  TextCursor cursor_;
  MeshFile mesh_;
  Corners corners_;
  bool in_solid_ = false;
};

}  // namespace

MeshFile read_stl(std::string_view text, const std::string& path, Content content) {
  if (content != Content::kSurface) {
    throw Failure(path + ": STL files carry no texture coordinates: use OBJ or PLY");
  }
  MeshFile mesh;
  if (is_binary(text)) {
    mesh = read_binary(text, path);
  } else if (text.substr(0, 5) == "solid") {
    mesh = TextReader(text, path).read();
  } else {
    throw Failure(path + (text.size() < kHeaderBytes
                              ? ": this is not an STL file, or it is truncated"
                              : ": the file is truncated, or not STL: " +
                                    std::to_string(little_u32(text.data() + 80)) +
                                    " faces do not fit its size"));
  }
  if (mesh.polygons.empty()) throw Failure(path + ": no faces");
  return mesh;
}

}  // namespace beltrami::cli
