// STL, text and binary. STL repeats the coordinates of every corner: corners with the same
// coordinates become one vertex, numbered by first appearance. Names of solids and attributes of
// binary facets are kept; normals of facets are not, being those of their corners.
#include <array>
#include <bit>
#include <limits>

#include "files/column.h"
#include "files/mesh_file.h"
#include "files/notes.h"
#include "files/point_numbers.h"
#include "files/polygons.h"
#include "files/text_cursor.h"
#include "process/failure.h"
#include "process/interrupt.h"

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

/// How many facets the header of a binary file counts. Writers that did not come back to count
/// left nothing there, or all bits.
std::uint64_t counted_facets(std::string_view text) {
  const std::uint32_t count = little_u32(text.data() + kHeaderBytes - 4);
  const std::uint64_t room = (text.size() - kHeaderBytes) / kFacetBytes;
  const bool uncounted = count == 0 || count == std::numeric_limits<std::uint32_t>::max();
  return uncounted && (text.size() - kHeaderBytes) % kFacetBytes == 0 ? room : count;
}

/// A count that fits the size is the only certain mark: many binary files begin with "solid", and
/// some have bytes behind their facets. In text four characters stand there, which are a count of
/// gigabytes.
bool is_binary(std::string_view text) {
  if (text.size() < kHeaderBytes + kFacetBytes) return false;
  const std::uint64_t count = counted_facets(text);
  return count > 0 && count <= (text.size() - kHeaderBytes) / kFacetBytes;
}

MeshFile read_binary(std::string_view text, const std::string& path) {
  MeshFile mesh;
  Corners corners(mesh, path);
  const std::uint64_t faces = counted_facets(text);
  const std::uint64_t behind = text.size() - kHeaderBytes - kFacetBytes * faces;
  if (behind > 0) mesh.not_kept.push_back(std::to_string(behind) + " bytes behind the facets");
  mesh.polygons.reserve(faces);
  Column attributes("attributes", Scalar::kU16);
  bool any = false;
  for (std::uint64_t i = 0; i < faces; ++i) {
    throw_if_interrupted();
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

std::string lower(std::string_view word) {
  std::string text(word);
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return text;
}

/// Keywords in any case. What is no keyword is passed over with its line.
class TextReader {
 public:
  TextReader(std::string_view text, const std::string& path)
      : cursor_(text, path), corners_(mesh_, path) {}

  MeshFile read() {
    for (cursor_.skip_to_word(); !cursor_.at_end(); cursor_.skip_to_word()) read_statement();
    end_of_file();
    corners_.finish();
    return std::move(mesh_);
  }

 private:
  void read_statement() {
    const std::string keyword = lower(cursor_.word());
    if (keyword == "vertex") {
      read_vertex();
    } else if (keyword == "endloop" || keyword == "endfacet" || keyword == "facet") {
      end_face();
      in_facet_ = keyword == "facet";
      if (keyword == "facet") cursor_.skip_line();  // a normal
    } else if (keyword == "endsolid") {
      end_face();
      in_solid_ = in_facet_ = false;
      cursor_.skip_line();  // a name
    } else if (keyword == "solid") {
      in_solid_ = true;
      read_name();
    } else if (keyword != "outer" && keyword != "loop") {
      note_unknown(mesh_.not_kept, "lines", keyword);
      cursor_.skip_line();
    }
  }

  void read_vertex() {
    std::array<double, 3> place{};
    for (double& coordinate : place) {
      cursor_.skip_blanks();
      if (cursor_.at_end()) return;  // and the facet ends early
      coordinate = cursor_.number("a coordinate");
    }
    corners_.add(place[0], place[1], place[2]);
  }

  /// The vertices since the last face are one.
  void end_face() {
    const std::uint64_t corners = mesh_.polygons.open_corners();
    if (corners == 0) return;
    if (corners >= 3) return mesh_.polygons.end_polygon();
    mesh_.polygons.drop_open_corners();
    ++mesh_.short_faces;
  }

  /// Some writers leave the last line out; but a copy that was cut short ends so, too.
  void end_of_file() {
    if (in_facet_ || mesh_.polygons.open_corners() > 0) {
      mesh_.polygons.drop_open_corners();
      mesh_.truncated = "the file is truncated: it ends in face " +
                        std::to_string(mesh_.polygons.size()) + " (counted from 0)";
    } else if (in_solid_) {
      mesh_.not_kept.emplace_back("what may be missing of the input (it has no endsolid)");
    }
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
  bool in_solid_ = false, in_facet_ = false;
};

/// Whether the text begins as STL does, solids or facets alone, in any case and behind blanks. The
/// header of a binary file that is cut short may do so, too, but its count has zero bytes.
bool is_text(std::string_view text, const std::string& path) {
  if (text.substr(0, kHeaderBytes).find('\0') != std::string_view::npos) return false;
  TextCursor cursor(text, path);
  cursor.skip_to_word();
  const std::string word = lower(cursor.word());
  return word == "solid" || word == "facet";
}

}  // namespace

MeshFile read_stl(std::string_view text, const std::string& path, Content content) {
  if (content != Content::kSurface) {
    throw Failure(path + ": STL files carry no texture coordinates: use OBJ or PLY");
  }
  MeshFile mesh;
  if (is_binary(text)) {
    mesh = read_binary(text, path);
  } else if (is_text(text, path)) {
    mesh = TextReader(text, path).read();
  } else if (text.size() >= kHeaderBytes && counted_facets(text) == 0) {
    throw without_faces(path);
  } else {
    throw Failure(path + (text.size() < kHeaderBytes
                              ? ": this is not an STL file, or it is truncated"
                              : ": the file is truncated, or not STL: " +
                                    std::to_string(little_u32(text.data() + 80)) +
                                    " faces do not fit its size"));
  }
  if (mesh.polygons.empty() && mesh.truncated.empty()) throw without_faces(path);
  if (mesh.polygons.empty()) throw Failure(path + ": " + mesh.truncated);
  return mesh;
}

}  // namespace beltrami::cli
