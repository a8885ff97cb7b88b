// Geomview OFF in text: the header, three counts, a line per vertex, a line per face. Normals and
// colours of vertices are kept, those of faces passed over.
#include <algorithm>
#include <array>

#include "files/extra_numbers.h"
#include "files/mesh_file.h"
#include "files/text_cursor.h"
#include "process/failure.h"

namespace beltrami::cli {
namespace {

/// What follows the coordinates of a vertex, in this order.
struct Layout {
  bool normals = false, colours = false, uvs = false;
};

Layout read_header(TextCursor& cursor) {
  cursor.skip_to_word();
  const std::string_view header = cursor.word();
  std::string_view rest = header;
  const auto take = [&](std::string_view prefix) {
    if (rest.substr(0, prefix.size()) != prefix) return false;
    rest.remove_prefix(prefix.size());
    return true;
  };
  Layout layout;
  layout.uvs = take("ST");
  layout.colours = take("C");
  layout.normals = take("N");
  if (rest != "OFF") cursor.fail("this is not an OFF file of three-dimensional vertices");
  cursor.skip_blanks();
  if (cursor.peek() == 'B') cursor.fail("binary OFF is not read");
  return layout;
}

std::uint64_t read_count(TextCursor& cursor, const char* what) {
  cursor.skip_to_word();
  const std::int64_t count = cursor.integer(what);
  if (count < 0 || count > kMaxIndex) {
    cursor.fail(std::string(what) + " is out of range: " + std::to_string(count));
  }
  return static_cast<std::uint64_t>(count);
}

/// Returns whether something stands behind the corners: a colour.
bool read_face(TextCursor& cursor, MeshFile& mesh) {
  cursor.skip_to_word();
  const std::uint64_t face = mesh.polygons.size();
  const std::int64_t corners = cursor.integer("a corner count");
  const auto name = [&] { return "face " + std::to_string(face) + " (counted from 0)"; };
  if (corners < 3) {
    cursor.fail(name() + " has " + std::to_string(corners) + " corners: a face needs 3 or more",
                BELTRAMI_ELEMENT_FACE, face);
  }
  const auto vertices = static_cast<std::int64_t>(mesh.vertex_count());
  for (std::int64_t k = 0; k < corners; ++k) {
    const std::int64_t index = cursor.integer("a vertex number");
    if (index < 0 || index >= vertices) {
      throw Failure(BELTRAMI_E_INDEX_OUT_OF_RANGE,
                    cursor.place() + name() + " names vertex " + std::to_string(index) +
                        ", but the file has " + std::to_string(vertices),
                    BELTRAMI_ELEMENT_FACE, face);
    }
    mesh.polygons.add_corner(static_cast<std::uint32_t>(index));
  }
  mesh.polygons.end_polygon();
  cursor.skip_blanks();
  const bool more = !cursor.at_line_end();
  cursor.skip_line();
  return more;
}

class OffVertices {
 public:
  explicit OffVertices(Layout layout) : layout_(layout) {}

  void read(TextCursor& cursor, MeshFile& mesh) {
    cursor.skip_to_word();
    for (int k = 0; k < 3; ++k) mesh.positions.push_back(cursor.number("a coordinate"));
    unknown_ |= extra_.read(cursor, mesh.vertex_count() - 1);
    cursor.skip_line();
  }

  void finish(MeshFile& mesh) const {
    const std::uint64_t rows = mesh.vertex_count();
    std::size_t at = 0;
    if (layout_.normals && extra_.width() >= 3) {
      for (const char* name : {"nx", "ny", "nz"}) {
        mesh.vertex_columns.push_back(extra_.column(at++, name, rows));
      }
    }
    const std::size_t last =
        extra_.width() - std::min(extra_.width(), std::size_t(2 * layout_.uvs));
    if (layout_.colours && (last == at + 3 || last == at + 4)) {
      const double scale = extra_.exceeds_one(at) ? 1.0 / 255 : 1;
      mesh.unit_colours = true;
      constexpr std::array<const char*, 4> kNames = {"red", "green", "blue", "alpha"};
      for (std::size_t k = 0; at < last; ++k) {
        mesh.vertex_columns.push_back(extra_.column(at++, kNames[k], rows, scale));
      }
    }
    if (unknown_ || at < last) mesh.not_kept.emplace_back("numbers after the coordinates");
  }

 private:
  Layout layout_;
  ExtraNumbers extra_;
  bool unknown_ = false;  ///< something else stands behind the numbers
};

}  // namespace

MeshFile read_off(std::string_view text, const std::string& path, Content content) {
  if (content != Content::kSurface) {
    throw Failure(path + ": OFF files carry no texture coordinates: use OBJ or PLY");
  }
  TextCursor cursor(text, path);
  OffVertices reader(read_header(cursor));
  const std::uint64_t vertices = read_count(cursor, "the vertex count");
  const std::uint64_t faces = read_count(cursor, "the face count");
  cursor.skip_line();  // the edge count, which nobody fills in
  if (vertices == 0) throw Failure(path + ": no vertices");
  if (faces == 0) throw Failure(path + ": no faces");

  MeshFile mesh;
  // A line has two bytes at least: a wrong count must not make us reserve what is not there.
  mesh.positions.reserve(3 * std::min<std::uint64_t>(vertices, text.size() / 6));
  mesh.polygons.reserve(std::min<std::uint64_t>(faces, text.size() / 8));
  for (std::uint64_t i = 0; i < vertices; ++i) reader.read(cursor, mesh);
  reader.finish(mesh);
  bool colours = false;
  for (std::uint64_t i = 0; i < faces; ++i) colours |= read_face(cursor, mesh);
  if (colours) mesh.not_kept.emplace_back("colours of faces");
  return mesh;
}

}  // namespace beltrami::cli
