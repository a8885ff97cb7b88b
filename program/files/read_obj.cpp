// Wavefront OBJ: the faces of the whole file are one mesh. Objects, groups, smoothing groups,
// materials, lines and points are kept as statements among the faces. Earlier texture coordinates
// are passed over where a run replaces them, comments and free-form geometry always.
#include <algorithm>
#include <array>
#include <optional>

#include "files/encoding.h"
#include "files/extra_numbers.h"
#include "files/mesh_file.h"
#include "files/notes.h"
#include "files/polygons.h"
#include "files/text_cursor.h"
#include "process/failure.h"

namespace beltrami::cli {
namespace {

constexpr std::uint32_t kNoTexture = std::numeric_limits<std::uint32_t>::max();
/// Statements that are kept as they are.
constexpr std::array<std::string_view, 14> kKept = {
    "g",   "o",        "s",        "usemtl", "mtllib",     "usemap",    "maplib",
    "lod", "c_interp", "d_interp", "bevel",  "shadow_obj", "trace_obj", "mg"};

/// Those of them that have names of other files, or names that stand there.
constexpr std::array<std::string_view, 4> kNamesElsewhere = {"usemtl", "mtllib", "usemap",
                                                             "maplib"};

class ObjReader {
 public:
  ObjReader(std::string_view text, const std::string& path, Content content)
      : text_(text), path_(path), content_(content), cursor_(text, path, true) {}

  MeshFile read() {
    while (!cursor_.at_end()) read_statement();
    if (mesh_.positions.empty()) throw Failure(path_ + ": no vertices: is this an OBJ file?");
    if (mesh_.polygons.empty()) throw without_faces(path_);
    require_forward_references();
    if (wants_uvs()) resolve_uvs();
    if (wants_attributes()) finish_attributes();
    return std::move(mesh_);
  }

 private:
  bool wants_uvs() const { return content_ != Content::kSurface; }
  bool wants_attributes() const { return cli::wants_attributes(content_); }

  void read_statement() {
    cursor_.skip_blanks();
    if (cursor_.at_line_end()) return cursor_.skip_line();
    const char* begin = cursor_.position();
    const std::string_view keyword = cursor_.word();
    if (keyword == "v") {
      read_vertex();
    } else if (keyword == "f" || keyword == "fo") {
      read_face();
    } else if (keyword == "vt") {
      if (wants_uvs()) read_texture();
    } else if (wants_attributes()) {
      return read_other(keyword, begin);
    } else {
      require_text(keyword);
    }
    cursor_.skip_line();
  }

  void require_text(std::string_view keyword) const {
    if (!keyword.empty() && keyword.front() == '\0')
      cursor_.fail("a zero byte: this is not an OBJ file");
  }

  void read_vertex() {
    for (int k = 0; k < 3; ++k) mesh_.positions.push_back(cursor_.number("a coordinate"));
    if (!wants_attributes()) return;
    unknown_numbers_ |= extra_.read(cursor_, mesh_.vertex_count() - 1);
  }

  /// Normals are of no use to a run, so wrong ones are dropped, all of them, and not refused.
  void read_normal() {
    for (int k = 0; k < 3; ++k) {
      const std::optional<double> number = cursor_.number_if_any();
      bad_normals_ |= !number;
      mesh_.normals.values.push_back(number.value_or(0));
    }
  }

  void read_texture() {
    textures_.push_back(cursor_.number("a texture coordinate"));
    cursor_.skip_blanks();
    // The second coordinate is optional in the format.
    textures_.push_back(cursor_.at_line_end() ? 0.0 : cursor_.number("a texture coordinate"));
  }

  /// Goes on to the next line.
  void read_other(std::string_view keyword, const char* begin) {
    if (keyword == "vn") {
      read_normal();
    } else if (keyword == "l" || keyword == "p") {
      read_line(keyword);
    } else if (std::find(kKept.begin(), kKept.end(), keyword) != kKept.end()) {
      cursor_.skip_line();
      std::string line(begin, cursor_.position());
      // A backslash at the end would continue the line into the next one.
      line.erase(line.find_last_not_of(" \t\r\n\\") + 1);
      keep_statement(keyword, std::move(line));
      return;
    } else {
      require_text(keyword);
      note_unknown(mesh_.not_kept, "statements", keyword);
    }
    cursor_.skip_line();
  }

  /// Readers that decode text would refuse a file with a name in another encoding. But a name that
  /// stands in another file, too, must stay what it is there.
  void keep_statement(std::string_view keyword, std::string line) {
    Statement& statement = mesh_.statements.emplace_back();
    statement.polygon = mesh_.polygons.size();
    statement.text = utf8_of(line);
    if (statement.text == line) return;
    if (std::find(kNamesElsewhere.begin(), kNamesElsewhere.end(), keyword) !=
        kNamesElsewhere.end()) {
      statement.bytes = std::move(line);
    } else {
      other_encoding_ = true;
    }
  }

  /// A polyline or points, with its numbers made absolute: they must not depend on where it stands.
  /// No run needs them, so wrong ones are left out, and not refused.
  void read_line(std::string_view keyword) {
    std::string line(keyword);
    bool good = true;
    for (cursor_.skip_blanks(); !cursor_.at_line_end(); cursor_.skip_blanks()) {
      const std::optional<std::int64_t> number = cursor_.integer_if_any();
      const std::int64_t index = number ? index_of(*number, mesh_.vertex_count()) : -1;
      if (index < 0) {
        good = false;
        break;
      }
      line += ' ';
      line += std::to_string(index + 1);
      if (cursor_.peek() != '/') continue;
      cursor_.advance();
      good = good && (!names_number() || cursor_.integer_if_any());
      if (!good) break;
      line += '/';
      line += std::to_string(index + 1);
    }
    bad_lines_ |= !good;
    if (good) mesh_.statements.push_back({mesh_.polygons.size(), std::move(line)});
  }

  void read_face() {
    for (cursor_.skip_blanks(); !cursor_.at_line_end(); cursor_.skip_blanks()) read_corner();
    if (mesh_.polygons.open_corners() >= 3) return mesh_.polygons.end_polygon();
    set_aside();
  }

  /// A face of fewer than three corners is none: exporters write edges so. It becomes a line, or a
  /// point, where its vertices are there already.
  void set_aside() {
    const std::vector<std::uint32_t>& corners = mesh_.polygons.corners();
    const std::uint64_t count = mesh_.polygons.open_corners();
    std::string line = count == 2 ? "l" : "p";
    bool known = count > 0 && wants_attributes();
    for (std::uint64_t c = corners.size() - count; c < corners.size(); ++c) {
      known = known && corners[c] < mesh_.vertex_count();
      line += ' ' + std::to_string(std::uint64_t{corners[c]} + 1);
    }
    if (known) mesh_.statements.push_back({mesh_.polygons.size(), std::move(line)});
    mesh_.polygons.drop_open_corners();
    if (wants_uvs()) corner_textures_.resize(corners.size());
    std::vector<std::uint32_t>& normals = mesh_.normals.of_corner;
    normals.resize(std::min(normals.size(), corners.size()));
    aside_.push_back(mesh_.polygons.size());
    ++mesh_.short_faces;
  }

  /// After a slash: whether something stands there. Some writers leave slashes behind nothing.
  bool names_number() const {
    const char c = cursor_.peek();
    return c != '/' && c != ' ' && c != '\t' && c != '\r' && !cursor_.at_line_end();
  }

  /// v, v/vt, v//vn or v/vt/vn.
  void read_corner() {
    mesh_.polygons.add_corner(
        resolve(cursor_.integer("a vertex number"), mesh_.vertex_count(), "vertex"));
    std::uint32_t texture = kNoTexture, normal = kNoNormal;
    if (cursor_.peek() == '/') {
      cursor_.advance();
      if (names_number()) {
        const std::int64_t number = cursor_.integer("a texture number");
        if (wants_uvs()) {
          texture = resolve(number, textures_.size() / 2, "texture coordinate");
        }
      }
      if (cursor_.peek() == '/') {
        cursor_.advance();
        if (names_number()) normal = read_normal_number();
      }
    }
    if (wants_uvs()) corner_textures_.push_back(texture);
    if (!wants_attributes()) return;
    if (normal != kNoNormal || !mesh_.normals.of_corner.empty()) {
      mesh_.normals.of_corner.resize(mesh_.polygons.corners().size() - 1, kNoNormal);
      mesh_.normals.of_corner.push_back(normal);
    }
  }

  std::uint32_t read_normal_number() {
    const std::int64_t number = cursor_.integer("a normal number");
    const std::int64_t index = index_of(number, mesh_.normals.values.size() / 3);
    bad_normals_ |= index < 0;
    return index < 0 ? kNoNormal : static_cast<std::uint32_t>(index);
  }

  /// Numbers count from 1, or backwards from the last item so far. -1 for what cannot be an index.
  static std::int64_t index_of(std::int64_t number, std::uint64_t count) {
    if (number == 0 || number < -kMaxIndex || number > kMaxIndex) return -1;
    if (number > 0) return number - 1;
    const std::int64_t index = number + static_cast<std::int64_t>(count);
    return index < kMaxIndex ? index : -1;
  }

  std::uint32_t resolve(std::int64_t number, std::uint64_t count, const char* what) const {
    const std::int64_t index = index_of(number, count);
    if (index < 0) fail_range(cursor_, number, what, mesh_.polygons.size());
    return static_cast<std::uint32_t>(index);
  }

  [[noreturn]] static void fail_range(const TextCursor& at, std::int64_t number, const char* what,
                                      std::uint64_t face) {
    throw Failure(BELTRAMI_E_INDEX_OUT_OF_RANGE,
                  at.place() + "face " + std::to_string(face) + " (counted from 0) names " + what +
                      " number " + std::to_string(number) + ", which the file does not have",
                  BELTRAMI_ELEMENT_FACE, face);
  }

  /// Faces may name vertices that come later, so the upper end is known now only.
  void require_forward_references() const {
    const std::vector<std::uint32_t>& corners = mesh_.polygons.corners();
    const std::uint64_t vertices = mesh_.vertex_count(), textures = textures_.size() / 2;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const bool named = !corner_textures_.empty() && corner_textures_[i] != kNoTexture;
      const bool no_texture = named && corner_textures_[i] >= textures;
      if (corners[i] < vertices && !no_texture) continue;
      const bool no_vertex = corners[i] >= vertices;
      const std::uint64_t face = mesh_.polygons.of_corner(i);
      fail_range(at_face(face), (no_vertex ? corners[i] : corner_textures_[i]) + std::int64_t{1},
                 no_vertex ? "vertex" : "texture coordinate", face);
    }
  }

  /// A cursor on the line of a face, found by walking the file again: lines are not stored.
  TextCursor at_face(std::uint64_t face) const {
    TextCursor cursor(text_, path_, true);
    const auto aside = std::upper_bound(aside_.begin(), aside_.end(), face) - aside_.begin();
    const std::uint64_t statement = face + static_cast<std::uint64_t>(aside);
    for (std::uint64_t seen = 0; !cursor.at_end(); cursor.skip_line()) {
      cursor.skip_blanks();
      const std::string_view keyword = cursor.word();
      if ((keyword == "f" || keyword == "fo") && seen++ == statement) break;
    }
    return cursor;
  }

  void finish_attributes() {
    if (other_encoding_) {
      mesh_.not_kept.emplace_back("the encoding of names (Latin-1 becomes UTF-8)");
    }
    if (bad_lines_) mesh_.not_kept.emplace_back("lines and points that name what is no vertex");
    CornerNormals& normals = mesh_.normals;
    for (const std::uint32_t normal : normals.of_corner) {
      bad_normals_ |= normal != kNoNormal && normal >= normals.values.size() / 3;
    }
    if (bad_normals_) {
      mesh_.not_kept.emplace_back("normals (one is not a number, or not in the file)");
    }
    if (bad_normals_ || normals.of_corner.empty()) {
      normals = {};
    } else {
      normals.of_corner.resize(mesh_.polygons.corners().size(), kNoNormal);
    }
    name_extra_numbers();
  }

  /// One number is a weight, three are a colour, four have an alpha.
  void name_extra_numbers() {
    const std::size_t width = extra_.width();
    std::vector<const char*> names;
    if (width == 1) names = {"w"};
    if (width == 3) names = {"red", "green", "blue"};
    if (width == 4) names = {"red", "green", "blue", "alpha"};
    if (unknown_numbers_ || (width > 0 && names.empty()))
      mesh_.not_kept.emplace_back("numbers after the coordinates");
    mesh_.unit_colours = true;
    for (std::size_t k = 0; k < names.size(); ++k) {
      mesh_.vertex_columns.push_back(extra_.column(k, names[k], mesh_.vertex_count()));
    }
  }

  /// Corners without texture coordinates get some that are no numbers.
  void fill_uvs() {
    const auto none = static_cast<std::uint32_t>(textures_.size() / 2);
    textures_.resize(textures_.size() + 2, std::numeric_limits<double>::quiet_NaN());
    std::replace(corner_textures_.begin(), corner_textures_.end(), kNoTexture, none);
  }

  void resolve_uvs() {
    bool named = false;
    for (const std::uint32_t texture : corner_textures_) named |= texture != kNoTexture;
    if (!named && textures_.size() / 2 == mesh_.vertex_count()) {
      mesh_.uvs = std::move(textures_);  // some writers pair the vt with the v silently
      return;
    }
    if (!named) throw Failure(path_ + ": no texture coordinates: faces need the form v/vt");
    if (content_ == Content::kSomeUvs) fill_uvs();
    for (std::size_t i = 0; i < corner_textures_.size(); ++i) {
      if (corner_textures_[i] != kNoTexture) continue;
      const std::uint64_t face = mesh_.polygons.of_corner(i);
      at_face(face).fail(
          "face " + std::to_string(face) + " (counted from 0) has no texture coordinates",
          BELTRAMI_ELEMENT_FACE, face);
    }
    mesh_.corner_uvs = {std::move(textures_), std::move(corner_textures_)};
    unite_corner_uvs(mesh_);
  }

  std::string_view text_;
  const std::string& path_;
  Content content_;
  TextCursor cursor_;
  MeshFile mesh_;
  ExtraNumbers extra_;                          ///< after the coordinates of vertices
  bool unknown_numbers_ = false;                ///< something else stands behind those
  bool other_encoding_ = false;                 ///< a name is no UTF-8
  bool bad_lines_ = false;                      ///< a line names what is no vertex
  std::vector<std::uint64_t> aside_;            ///< per face set aside: faces before it
  bool bad_normals_ = false;                    ///< a normal is no number, or not there
  std::vector<double> textures_;                ///< u v per vt statement
  std::vector<std::uint32_t> corner_textures_;  ///< one per corner, kNoTexture for none
};

}  // namespace

MeshFile read_obj(std::string_view text, const std::string& path, Content content) {
  return ObjReader(text, path, content).read();
}

}  // namespace beltrami::cli
