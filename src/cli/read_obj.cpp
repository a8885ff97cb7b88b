// Wavefront OBJ: v, vt and f statements. Objects, groups, materials, normals, lines and points are
// passed over: the faces of the whole file are one mesh.
#include <limits>

#include "failure.h"
#include "mesh_file.h"
#include "text_cursor.h"

namespace beltrami::cli {
namespace {

constexpr std::uint32_t kNoTexture = std::numeric_limits<std::uint32_t>::max();
/// What the library can index; it also keeps resolved indices clear of kNoTexture.
constexpr std::int64_t kMaxIndex = std::numeric_limits<std::int32_t>::max();

class ObjReader {
 public:
  ObjReader(std::string_view text, const std::string& path, Content content)
      : text_(text), path_(path), content_(content), cursor_(text, path, true) {}

  MeshFile read() {
    while (!cursor_.at_end()) read_statement();
    if (mesh_.positions.empty()) throw Failure(path_ + ": no vertices: is this an OBJ file?");
    if (mesh_.faces.empty()) throw Failure(path_ + ": no faces");
    require_forward_references();
    if (content_ == Content::kUvs) resolve_uvs();
    return std::move(mesh_);
  }

 private:
  void read_statement() {
    cursor_.skip_blanks();
    const char first = cursor_.peek();
    if (first == 'v' || first == 'f') {
      const std::string_view keyword = cursor_.word();
      if (keyword == "v") {
        for (int k = 0; k < 3; ++k) mesh_.positions.push_back(cursor_.number("a coordinate"));
      } else if (keyword == "f") {
        read_face();
      } else if (keyword == "vt" && content_ == Content::kUvs) {
        read_texture();
      }
    } else if (first == '\0' && !cursor_.at_end()) {
      cursor_.fail("a zero byte: this is not an OBJ file");
    }
    cursor_.skip_line();
  }

  void read_texture() {
    textures_.push_back(cursor_.number("a texture coordinate"));
    cursor_.skip_blanks();
    // The second coordinate is optional in the format.
    textures_.push_back(cursor_.at_line_end() ? 0.0 : cursor_.number("a texture coordinate"));
  }

  void read_face() {
    for (int k = 0; k < 3; ++k) {
      cursor_.skip_blanks();
      if (cursor_.at_line_end()) fail_corners(k);
      read_corner();
    }
    cursor_.skip_blanks();
    if (!cursor_.at_line_end()) fail_corners(4);
  }

  /// After a slash: whether something stands there. Some writers leave slashes behind nothing.
  bool names_number() const {
    const char c = cursor_.peek();
    return c != '/' && c != ' ' && c != '\t' && c != '\r' && !cursor_.at_line_end();
  }

  /// v, v/vt, v//vn or v/vt/vn.
  void read_corner() {
    const auto face = mesh_.faces.size() / 3;
    mesh_.faces.push_back(
        resolve(cursor_.integer("a vertex number"), mesh_.positions.size() / 3, "vertex", face));
    std::uint32_t texture = kNoTexture;
    if (cursor_.peek() == '/') {
      cursor_.advance();
      if (names_number()) {
        const std::int64_t number = cursor_.integer("a texture number");
        if (content_ == Content::kUvs) {
          texture = resolve(number, textures_.size() / 2, "texture coordinate", face);
        }
      }
      if (cursor_.peek() == '/') {
        cursor_.advance();
        if (names_number()) cursor_.integer("a normal number");
      }
    }
    if (content_ == Content::kUvs) corner_textures_.push_back(texture);
  }

  /// Numbers count from 1, or backwards from the last item so far.
  std::uint32_t resolve(std::int64_t number, std::uint64_t count, const char* what,
                        std::uint64_t face) const {
    const std::int64_t index =
        number > 0 ? number - 1
                   : (number < -kMaxIndex ? -1 : number + static_cast<std::int64_t>(count));
    if (number == 0 || index < 0 || index >= kMaxIndex) fail_range(cursor_, number, what, face);
    return static_cast<std::uint32_t>(index);
  }

  [[noreturn]] static void fail_range(const TextCursor& at, std::int64_t number, const char* what,
                                      std::uint64_t face) {
    throw Failure(BELTRAMI_E_INDEX_OUT_OF_RANGE,
                  at.place() + "face " + std::to_string(face) + " (counted from 0) names " + what +
                      " number " + std::to_string(number) + ", which the file does not have",
                  BELTRAMI_ELEMENT_FACE, face);
  }

  [[noreturn]] void fail_corners(int found) const {
    const auto face = (mesh_.faces.size() - (found < 3 ? found : 3)) / 3;
    cursor_.fail("face " + std::to_string(face) + " (counted from 0) has " +
                     (found > 3 ? "more than 3" : "only " + std::to_string(found)) +
                     " corners: triangulate the mesh first",
                 BELTRAMI_ELEMENT_FACE, face);
  }

  /// Faces may name vertices that come later, so the upper end is known now only.
  void require_forward_references() const {
    const std::uint64_t vertices = mesh_.vertex_count(), textures = textures_.size() / 2;
    for (std::size_t i = 0; i < mesh_.faces.size(); ++i) {
      if (mesh_.faces[i] >= vertices) {
        fail_range(at_face(i / 3), mesh_.faces[i] + std::int64_t{1}, "vertex", i / 3);
      }
      if (!corner_textures_.empty() && corner_textures_[i] != kNoTexture &&
          corner_textures_[i] >= textures) {
        fail_range(at_face(i / 3), corner_textures_[i] + std::int64_t{1}, "texture coordinate",
                   i / 3);
      }
    }
  }

  /// A cursor on the line of a face, found by walking the file again: lines are not stored.
  TextCursor at_face(std::uint64_t face) const {
    TextCursor cursor(text_, path_, true);
    for (std::uint64_t seen = 0;; cursor.skip_line()) {
      cursor.skip_blanks();
      if (cursor.peek() == 'f' && cursor.word() == "f" && seen++ == face) return cursor;
    }
  }

  void resolve_uvs() {
    bool named = false;
    for (const std::uint32_t texture : corner_textures_) named |= texture != kNoTexture;
    if (!named && textures_.size() / 2 == mesh_.vertex_count()) {
      mesh_.uvs = std::move(textures_);  // some writers pair the vt with the v silently
      return;
    }
    if (!named) throw Failure(path_ + ": no texture coordinates: faces need the form v/vt");
    mesh_.uvs.assign(2 * mesh_.vertex_count(), 0.0);
    std::vector<bool> known(mesh_.vertex_count(), false);
    for (std::size_t i = 0; i < mesh_.faces.size(); ++i) assign_uv(i, known);
  }

  void assign_uv(std::size_t corner, std::vector<bool>& known) {
    const std::uint32_t vertex = mesh_.faces[corner], texture = corner_textures_[corner];
    if (texture == kNoTexture) {
      at_face(corner / 3)
          .fail(
              "face " + std::to_string(corner / 3) + " (counted from 0) has no texture coordinates",
              BELTRAMI_ELEMENT_FACE, corner / 3);
    }
    const double u = textures_[2 * std::size_t{texture}];
    const double v = textures_[2 * std::size_t{texture} + 1];
    double* uv = &mesh_.uvs[2 * std::size_t{vertex}];
    // Negated so that NaN passes: the library refuses it with its vertex.
    if (known[vertex] && (uv[0] < u || uv[0] > u || uv[1] < v || uv[1] > v)) {
      at_face(corner / 3)
          .fail("vertex " + std::to_string(vertex) +
                    " (counted from 0) has two different texture coordinates: cut "
                    "the mesh along its seams first",
                BELTRAMI_ELEMENT_VERTEX, vertex);
    }
    uv[0] = u;
    uv[1] = v;
    known[vertex] = true;
  }

  std::string_view text_;
  const std::string& path_;
  Content content_;
  TextCursor cursor_;
  MeshFile mesh_;
  std::vector<double> textures_;                ///< u v per vt statement
  std::vector<std::uint32_t> corner_textures_;  ///< one per corner, kNoTexture for none
};

}  // namespace

MeshFile read_obj(std::string_view text, const std::string& path, Content content) {
  return ObjReader(text, path, content).read();
}

}  // namespace beltrami::cli
