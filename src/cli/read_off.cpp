// Geomview OFF in text: the header, three counts, a line per vertex, a line per face. Colours and
// normals after the coordinates (COFF, NOFF and so on) are passed over.
#include <algorithm>
#include <limits>

#include "failure.h"
#include "mesh_file.h"
#include "text_cursor.h"

namespace beltrami::cli {
namespace {

void read_header(TextCursor& cursor) {
  cursor.skip_to_word();
  const std::string_view header = cursor.word();
  const bool known = header == "OFF" || header == "COFF" || header == "NOFF" || header == "CNOFF" ||
                     header == "STOFF" || header == "STCOFF" || header == "STNOFF" ||
                     header == "STCNOFF";
  if (!known) cursor.fail("this is not an OFF file of three-dimensional vertices");
  cursor.skip_blanks();
  if (cursor.peek() == 'B') cursor.fail("binary OFF is not read");
}

std::uint64_t read_count(TextCursor& cursor, const char* what) {
  cursor.skip_to_word();
  const std::int64_t count = cursor.integer(what);
  if (count < 0 || count > std::numeric_limits<std::int32_t>::max()) {
    cursor.fail(std::string(what) + " is out of range: " + std::to_string(count));
  }
  return static_cast<std::uint64_t>(count);
}

void read_face(TextCursor& cursor, std::uint64_t face, MeshFile& mesh) {
  cursor.skip_to_word();
  const std::string name = "face " + std::to_string(face) + " (counted from 0)";
  const std::int64_t corners = cursor.integer("a corner count");
  if (corners != 3) {
    cursor.fail(name + " has " + std::to_string(corners) + " corners: triangulate the mesh first",
                BELTRAMI_ELEMENT_FACE, face);
  }
  const auto vertices = static_cast<std::int64_t>(mesh.vertex_count());
  for (int k = 0; k < 3; ++k) {
    const std::int64_t index = cursor.integer("a vertex number");
    if (index < 0 || index >= vertices) {
      throw Failure(BELTRAMI_E_INDEX_OUT_OF_RANGE,
                    cursor.place() + name + " names vertex " + std::to_string(index) +
                        ", but the file has " + std::to_string(vertices),
                    BELTRAMI_ELEMENT_FACE, face);
    }
    mesh.faces.push_back(static_cast<std::uint32_t>(index));
  }
  cursor.skip_line();
}

}  // namespace

MeshFile read_off(std::string_view text, const std::string& path, Content content) {
  if (content == Content::kUvs) {
    throw Failure(path + ": OFF files carry no texture coordinates: use OBJ or PLY");
  }
  TextCursor cursor(text, path);
  read_header(cursor);
  const std::uint64_t vertices = read_count(cursor, "the vertex count");
  const std::uint64_t faces = read_count(cursor, "the face count");
  cursor.skip_line();  // the edge count, which nobody fills in
  if (vertices == 0) throw Failure(path + ": no vertices");
  if (faces == 0) throw Failure(path + ": no faces");

  MeshFile mesh;
  // A line has two bytes at least: a wrong count must not make us reserve what is not there.
  mesh.positions.reserve(3 * std::min<std::uint64_t>(vertices, text.size() / 2));
  mesh.faces.reserve(3 * std::min<std::uint64_t>(faces, text.size() / 2));
  for (std::uint64_t i = 0; i < vertices; ++i) {
    cursor.skip_to_word();
    for (int k = 0; k < 3; ++k) mesh.positions.push_back(cursor.number("a coordinate"));
    cursor.skip_line();
  }
  for (std::uint64_t i = 0; i < faces; ++i) read_face(cursor, i, mesh);
  return mesh;
}

}  // namespace beltrami::cli
