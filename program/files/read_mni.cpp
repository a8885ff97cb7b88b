// Surfaces of the Montreal Neurological Institute, in text: "P", five numbers of a material and the
// count of points; points, normals; the count of polygons; colours; where each polygon ends; and
// the points of all of them. Their files have the extension of Wavefront's.
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "files/column.h"
#include "files/mesh_file.h"
#include "files/polygons.h"
#include "files/text_cursor.h"
#include "process/failure.h"

namespace beltrami::cli {
namespace {

class MniReader {
 public:
  MniReader(std::string_view text, const std::string& path) : cursor_(text, path), path_(path) {}

  MeshFile read() {
    cursor_.word();  // P
    for (int k = 0; k < kMaterialNumbers; ++k) number("a number of the material");
    const std::uint64_t points = count("the count of points");
    for (std::uint64_t i = 0; i < 3 * points; ++i) {
      mesh_.positions.push_back(number("a coordinate"));
    }
    for (const char* name : {"nx", "ny", "nz"}) {
      mesh_.vertex_columns.emplace_back(name, Scalar::kF64);
    }
    for (std::uint64_t i = 0; i < 3 * points; ++i) {
      mesh_.vertex_columns[i % 3].append(number("a normal"));
    }
    const std::uint64_t polygons = count("the count of polygons");
    skip_colours(points, polygons);
    read_polygons(polygons);
    if (mesh_.positions.empty()) throw Failure(path_ + ": no vertices");
    if (mesh_.polygons.empty()) throw without_faces(path_);
    return std::move(mesh_);
  }

 private:
  static constexpr int kMaterialNumbers = 5;

  double number(const char* what) {
    cursor_.skip_to_word();
    return cursor_.number(what);
  }

  std::uint64_t count(const char* what) {
    cursor_.skip_to_word();
    const std::int64_t value = cursor_.integer(what);
    if (value < 0 || value > kMaxIndex) cursor_.fail(std::string(what) + " is out of range");
    return static_cast<std::uint64_t>(value);
  }

  /// One colour for all, one per polygon, or one per point.
  void skip_colours(std::uint64_t points, std::uint64_t polygons) {
    const std::uint64_t kind = count("the kind of colours");
    if (kind > 2) cursor_.fail("the kind of colours is none of 0, 1 and 2");
    const std::uint64_t colours = kind == 0 ? 1 : kind == 1 ? polygons : points;
    for (std::uint64_t i = 0; i < 4 * colours; ++i) number("a part of a colour");
    mesh_.not_kept.emplace_back("colours");
  }

  void read_polygons(std::uint64_t polygons) {
    std::vector<std::uint64_t> ends;
    for (std::uint64_t i = 0; i < polygons; ++i) ends.push_back(count("the end of a polygon"));
    std::uint64_t corner = 0;
    for (std::uint64_t i = 0; i < polygons; ++i) {
      if (ends[i] < corner + 3) fail_face(i, "has fewer than three corners");
      for (; corner < ends[i]; ++corner) {
        const std::uint64_t vertex = count("a vertex number");
        if (vertex >= mesh_.vertex_count()) {
          fail_face(i, "names vertex " + std::to_string(vertex) + ", which the file does not have");
        }
        mesh_.polygons.add_corner(static_cast<std::uint32_t>(vertex));
      }
      mesh_.polygons.end_polygon();
    }
  }

  [[noreturn]] void fail_face(std::uint64_t face, const std::string& what) const {
    cursor_.fail("face " + std::to_string(face) + " (counted from 0) " + what,
                 BELTRAMI_ELEMENT_FACE, face);
  }

  TextCursor cursor_;
  const std::string& path_;
  MeshFile mesh_;
};

}  // namespace

MeshFile read_mni(std::string_view text, const std::string& path, Content content) {
  if (content != Content::kSurface) {
    throw Failure(path + ": MNI objects carry no texture coordinates: use OBJ or PLY");
  }
  return MniReader(text, path).read();
}

}  // namespace beltrami::cli
