// Geomview OFF: the header, three counts, the vertices, the faces. Normals, colours and texture
// coordinates of vertices are kept, colours of faces passed over.
//
// The format is one of words, which may be broken into lines anywhere. But many writers put
// colours behind coordinates without a word of it in the header, which only the ends of lines tell
// from the next vertex. So where each vertex has a line, its line is read, else its words.
#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>

#include "files/column.h"
#include "files/extra_numbers.h"
#include "files/mesh_file.h"
#include "files/off_header.h"
#include "files/polygons.h"
#include "files/text_cursor.h"
#include "process/failure.h"

namespace beltrami::cli {
namespace {

/// Words of the line that the cursor is on, which it leaves.
std::uint64_t words_of_line(TextCursor& cursor) {
  std::uint64_t words = 0;
  for (cursor.skip_blanks(); !cursor.at_line_end(); cursor.skip_blanks()) {
    // A backslash ends a word for other formats; here it is a word of no meaning.
    if (cursor.word().empty()) cursor.advance();
    ++words;
  }
  cursor.skip_line();
  return words;
}

/// Whether each vertex and each face begins a line. `cursor` is a copy, before the first vertex.
bool has_lines(TextCursor cursor, const OffHeader& header) {
  std::uint64_t lines = 0;
  bool places = true, whole = true;  // each line of a vertex has coordinates, and all numbers
  for (cursor.skip_to_word(); !cursor.at_end(); cursor.skip_to_word(), ++lines) {
    const std::uint64_t words = words_of_line(cursor);
    if (lines >= header.vertices) continue;
    places = places && words >= header.coordinates();
    whole = whole && words >= header.least_numbers();
  }
  const std::uint64_t items = header.vertices + header.faces;
  // Faces may be broken into more lines than one. Some writers leave numbers out that the header
  // has: then the lines are those of vertices only if there is one for each item.
  return lines >= items && (whole || (places && lines == items));
}

class OffVertices {
 public:
  OffVertices(const OffHeader& header, bool lines) : header_(header), lines_(lines) {}

  void read(TextCursor& cursor, MeshFile& mesh) {
    for (int k = 0; k < 3; ++k) mesh.positions.push_back(next(cursor, "a coordinate"));
    if (header_.homogeneous) divide(cursor, mesh);
    const std::uint64_t row = mesh.vertex_count() - 1;
    if (lines_) {
      unknown_ |= extra_.read(cursor, row);
      cursor.skip_line();
      return;
    }
    std::array<double, ExtraNumbers::kWidth> numbers;
    const std::size_t count = header_.numbers_behind();
    for (std::size_t k = 0; k < count; ++k) numbers[k] = next(cursor, "a number of a vertex");
    extra_.add(row, std::span(numbers).first(count));
  }

  void finish(MeshFile& mesh, bool wants_uvs) const {
    const std::uint64_t rows = mesh.vertex_count();
    std::size_t at = 0;
    if (header_.normals && extra_.width() >= 3) {
      for (const char* name : {"nx", "ny", "nz"}) {
        mesh.vertex_columns.push_back(extra_.column(at++, name, rows));
      }
    }
    const std::size_t last =
        extra_.width() - std::min(extra_.width(), std::size_t(2 * header_.uvs));
    if (header_.colours && (last == at + 3 || last == at + 4)) {
      const double scale = extra_.exceeds_one(at) ? 1.0 / 255 : 1;
      mesh.unit_colours = true;
      constexpr std::array<const char*, 4> kNames = {"red", "green", "blue", "alpha"};
      for (std::size_t k = 0; at < last; ++k) {
        mesh.vertex_columns.push_back(extra_.column(at++, kNames[k], rows, scale));
      }
    }
    if (unknown_ || at < last) mesh.not_kept.emplace_back("numbers after the coordinates");
    if (wants_uvs) take_uvs(mesh, last);
  }

 private:
  static double next(TextCursor& cursor, const char* what) {
    cursor.skip_to_word();
    return cursor.number(what);
  }

  /// The fourth coordinate divides the others.
  static void divide(TextCursor& cursor, MeshFile& mesh) {
    const double weight = next(cursor, "the fourth coordinate");
    for (std::size_t k = 1; k <= 3; ++k) mesh.positions[mesh.positions.size() - k] /= weight;
  }

  void take_uvs(MeshFile& mesh, std::size_t first) const {
    if (extra_.width() < first + 2) return;
    const std::uint64_t rows = mesh.vertex_count();
    const Column u = extra_.column(first, "s", rows), v = extra_.column(first + 1, "t", rows);
    for (std::uint64_t i = 0; i < rows; ++i) mesh.uvs.insert(mesh.uvs.end(), {u[i], v[i]});
  }

  OffHeader header_;
  bool lines_;
  ExtraNumbers extra_;
  bool unknown_ = false;  ///< something else stands behind the numbers
};

class OffFaces {
 public:
  OffFaces(TextCursor& cursor, const OffHeader& header, bool lines, MeshFile& mesh)
      : cursor_(cursor), header_(header), lines_(lines), mesh_(mesh) {}

  void read() {
    for (std::uint64_t i = 0; i < header_.faces; ++i) {
      cursor_.skip_to_word();
      if (!cursor_.at_end() && read_face(i)) continue;
      mesh_.polygons.drop_open_corners();
      mesh_.truncated = "the file is truncated: it ends in face " + std::to_string(i) +
                        " (counted from 0) of " + std::to_string(header_.faces);
      break;
    }
    if (colours_) mesh_.not_kept.emplace_back("colours of faces");
  }

 private:
  /// Returns false where the file ends first.
  bool read_face(std::uint64_t face) {
    const std::int64_t corners = cursor_.integer("a corner count");
    if (corners < 0) {
      cursor_.fail(name_of(face) + " has " + std::to_string(corners) + " corners",
                   BELTRAMI_ELEMENT_FACE, face);
    }
    for (std::int64_t k = 0; k < corners; ++k) {
      cursor_.skip_to_word();
      if (cursor_.at_end()) return false;
      add_corner(face);
    }
    if (corners < 3) {
      mesh_.polygons.drop_open_corners();
      ++mesh_.short_faces;
    } else {
      mesh_.polygons.end_polygon();
    }
    if (!lines_) return true;
    cursor_.skip_blanks();
    colours_ |= !cursor_.at_line_end();
    cursor_.skip_line();
    return true;
  }

  void add_corner(std::uint64_t face) {
    const auto vertices = static_cast<std::int64_t>(mesh_.vertex_count());
    const std::int64_t index = cursor_.integer("a vertex number");
    if (index < 0 || index >= vertices) {
      throw Failure(BELTRAMI_E_INDEX_OUT_OF_RANGE,
                    cursor_.place() + name_of(face) + " names vertex " + std::to_string(index) +
                        ", but the file has " + std::to_string(vertices),
                    BELTRAMI_ELEMENT_FACE, face);
    }
    mesh_.polygons.add_corner(static_cast<std::uint32_t>(index));
  }

  static std::string name_of(std::uint64_t face) {
    return "face " + std::to_string(face) + " (counted from 0)";
  }

  TextCursor& cursor_;
  const OffHeader& header_;
  bool lines_;
  MeshFile& mesh_;
  bool colours_ = false;  ///< something stands behind the corners
};

}  // namespace

MeshFile read_off(std::string_view text, const std::string& path, Content content) {
  TextCursor cursor(text, path);
  const OffHeader header = read_off_header(cursor);
  const bool wants_uvs = content != Content::kSurface;
  if (wants_uvs && !header.uvs) {
    throw Failure(path + ": this OFF file carries no texture coordinates: use OBJ or PLY");
  }
  if (header.vertices == 0) throw Failure(path + ": no vertices");
  if (header.faces == 0) throw without_faces(path);
  const bool lines = has_lines(cursor, header);

  MeshFile mesh;
  // A word has two bytes at least: a wrong count must not make us reserve what is not there.
  mesh.positions.reserve(3 * std::min<std::uint64_t>(header.vertices, text.size() / 6));
  mesh.polygons.reserve(std::min<std::uint64_t>(header.faces, text.size() / 8));
  OffVertices vertices(header, lines);
  for (std::uint64_t i = 0; i < header.vertices; ++i) vertices.read(cursor, mesh);
  vertices.finish(mesh, wants_uvs);
  OffFaces(cursor, header, lines, mesh).read();
  if (mesh.polygons.empty()) throw without_faces(path);
  return mesh;
}

}  // namespace beltrami::cli
