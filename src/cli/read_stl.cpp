// STL, text and binary. STL repeats the coordinates of every corner: corners with the same
// coordinates to the last bit become one vertex, numbered by first appearance. (0 and -0 are the
// same coordinate: exporters give both for one point.)
#include <bit>
#include <cstring>
#include <limits>

#include "failure.h"
#include "mesh_file.h"
#include "text_cursor.h"

namespace beltrami::cli {
namespace {

constexpr std::size_t kHeaderBytes = 84, kFacetBytes = 50;

/// Numbers corners by their coordinates: a hash table with open addressing over the vertices.
class Welder {
 public:
  explicit Welder(MeshFile& mesh) : mesh_(mesh), slots_(1024, kFree) {}

  void add_corner(double x, double y, double z) {
    if (2 * (mesh_.vertex_count() + 1) > slots_.size()) grow();
    const double corner[3] = {x + 0.0, y + 0.0, z + 0.0};  // -0 + 0 is 0
    std::size_t slot = hash(corner) & (slots_.size() - 1);
    while (slots_[slot] != kFree) {
      const std::uint32_t vertex = slots_[slot];
      if (std::memcmp(&mesh_.positions[3 * std::size_t{vertex}], corner, sizeof corner) == 0) {
        mesh_.faces.push_back(vertex);
        ++mesh_.welded_vertices;
        return;
      }
      slot = (slot + 1) & (slots_.size() - 1);
    }
    slots_[slot] = static_cast<std::uint32_t>(mesh_.vertex_count());
    mesh_.faces.push_back(slots_[slot]);
    mesh_.positions.insert(mesh_.positions.end(), corner, corner + 3);
  }

 private:
  static constexpr std::uint32_t kFree = std::numeric_limits<std::uint32_t>::max();

  static std::size_t hash(const double* corner) {
    std::uint64_t state = 0;
    for (int k = 0; k < 3; ++k) {
      state = (state ^ std::bit_cast<std::uint64_t>(corner[k])) * 0x9E3779B97F4A7C15u;
      state ^= state >> 29;
    }
    return static_cast<std::size_t>(state);
  }

  void grow() {
    slots_.assign(2 * slots_.size(), kFree);
    for (std::size_t i = 0; i < mesh_.vertex_count(); ++i) {
      std::size_t slot = hash(&mesh_.positions[3 * i]) & (slots_.size() - 1);
      while (slots_[slot] != kFree) slot = (slot + 1) & (slots_.size() - 1);
      slots_[slot] = static_cast<std::uint32_t>(i);
    }
  }

  MeshFile& mesh_;
  std::vector<std::uint32_t> slots_;
};

std::uint32_t little_u32(const char* bytes) {
  std::uint32_t value = 0;
  for (int k = 3; k >= 0; --k) value = value << 8 | static_cast<unsigned char>(bytes[k]);
  return value;
}

/// The size is the only certain mark: many binary files begin with "solid".
bool is_binary(std::string_view text) {
  return text.size() >= kHeaderBytes &&
         text.size() == kHeaderBytes + kFacetBytes * std::size_t{little_u32(text.data() + 80)};
}

MeshFile read_binary(std::string_view text) {
  MeshFile mesh;
  Welder welder(mesh);
  const std::size_t faces = (text.size() - kHeaderBytes) / kFacetBytes;
  mesh.faces.reserve(3 * faces);
  for (std::size_t i = 0; i < faces; ++i) {
    const char* facet = text.data() + kHeaderBytes + kFacetBytes * i + 12;  // after the normal
    for (int k = 0; k < 3; ++k, facet += 12) {
      welder.add_corner(std::bit_cast<float>(little_u32(facet)),
                        std::bit_cast<float>(little_u32(facet + 4)),
                        std::bit_cast<float>(little_u32(facet + 8)));
    }
  }
  return mesh;
}

MeshFile read_text(std::string_view text, const std::string& path) {
  MeshFile mesh;
  Welder welder(mesh);
  TextCursor cursor(text, path);
  int corners = 0;
  bool in_solid = false;
  for (cursor.skip_to_word(); !cursor.at_end(); cursor.skip_to_word()) {
    const std::string_view keyword = cursor.word();
    if (keyword == "vertex") {
      const double x = cursor.number("a coordinate"), y = cursor.number("a coordinate");
      welder.add_corner(x, y, cursor.number("a coordinate"));
      ++corners;
    } else if (keyword == "endloop" || keyword == "facet" || keyword == "endsolid") {
      const std::uint64_t face = (mesh.faces.size() - static_cast<std::size_t>(corners)) / 3;
      if (corners != (keyword == "endloop" ? 3 : 0)) {
        cursor.fail("face " + std::to_string(face) + " (counted from 0) has " +
                        std::to_string(corners) + " corners instead of 3",
                    BELTRAMI_ELEMENT_FACE, face);
      }
      corners = 0;
      if (keyword != "endloop") cursor.skip_line();  // a normal or a name
      if (keyword == "endsolid") in_solid = false;
    } else if (keyword == "solid") {
      in_solid = true;
      cursor.skip_line();
    } else if (keyword != "outer" && keyword != "loop" && keyword != "endfacet") {
      cursor.fail("unknown keyword '" + std::string(keyword.substr(0, 40)) + "'");
    }
  }
  if (in_solid) cursor.fail("the file is truncated: it has no endsolid");
  return mesh;
}

}  // namespace

MeshFile read_stl(std::string_view text, const std::string& path, Content content) {
  if (content == Content::kUvs) {
    throw Failure(path + ": STL files carry no texture coordinates: use OBJ or PLY");
  }
  MeshFile mesh;
  if (is_binary(text)) {
    mesh = read_binary(text);
  } else if (text.substr(0, 5) == "solid") {
    mesh = read_text(text, path);
  } else {
    throw Failure(path + (text.size() < kHeaderBytes
                              ? ": this is not an STL file, or it is truncated"
                              : ": the file is truncated, or not STL: " +
                                    std::to_string(little_u32(text.data() + 80)) +
                                    " faces do not fit its size"));
  }
  if (mesh.faces.empty()) throw Failure(path + ": no faces");
  return mesh;
}

}  // namespace beltrami::cli
