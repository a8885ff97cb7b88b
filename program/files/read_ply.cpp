// Stanford PLY: text, and binary of either byte order. Faces are polygons or triangle strips. What
// is of no use to a run is kept for the output, whatever its order and types.
#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>

#include "files/column.h"
#include "files/mesh_file.h"
#include "files/notes.h"
#include "files/ply_header.h"
#include "files/polygons.h"
#include "files/text_cursor.h"
#include "process/failure.h"
#include "process/interrupt.h"

namespace beltrami::cli {
namespace {

/// The values of the body one after another.
class Values {
 public:
  /// `rows`: how many there are to be.
  Values(TextCursor& cursor, PlyEncoding encoding, std::uint64_t rows, const char* end)
      : cursor_(cursor), encoding_(encoding), at_(cursor.position()), end_(end) {
    if (encoding != PlyEncoding::kText) return;
    std::uint64_t lines = 0;
    TextCursor look = cursor;
    for (look.skip_to_word(); !look.at_end(); look.skip_to_word()) {
      look.skip_line();
      ++lines;
    }
    row_is_line_ = lines == rows;
  }

  /// False at the end of the file.
  bool next(Scalar type, double& value) {
    throw_if_interrupted();
    if (encoding_ == PlyEncoding::kText) {
      cursor_.skip_to_word();
      if (cursor_.at_end()) return false;
      value = cursor_.number("a value");
      return true;
    }
    const std::size_t size = size_of(type);
    if (static_cast<std::size_t>(end_ - at_) < size) return false;
    std::array<char, 8> bytes{};
    std::memcpy(bytes.data(), at_, size);
    at_ += size;
    const bool file_is_little = encoding_ == PlyEncoding::kLittle;
    if (file_is_little != (std::endian::native == std::endian::little)) {
      std::reverse(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    }
    value = decode(type, bytes.data());
    return true;
  }

  /// Passes over what a row has beyond the header's properties: that can be told where each row has
  /// a line of its own, as the format wants it.
  void end_row() {
    if (!row_is_line_) return;
    cursor_.skip_blanks();
    if (cursor_.at_line_end()) return;
    has_more_ = true;
    cursor_.skip_line();
  }
  bool has_more() const { return has_more_; }

  /// For messages: the line in text, nothing in binary.
  std::string place(const std::string& path) const {
    return encoding_ == PlyEncoding::kText ? cursor_.place() : path + ": ";
  }

 private:
  TextCursor& cursor_;
  PlyEncoding encoding_;
  const char* at_;
  const char* end_;
  bool row_is_line_ = false, has_more_ = false;
};

std::string short_number(double value) {
  std::array<char, 32> digits;
  return {digits.data(), std::to_chars(digits.data(), digits.data() + 32, value).ptr};
}

/// The names that UVs of vertices have: the first pair that is there counts.
constexpr std::array<std::array<std::string_view, 2>, 3> kUvNames = {
    {{"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}}};

/// A file that ends too early.
class Truncation : public Failure {
 public:
  Truncation(const std::string& path, const std::string& where)
      : Failure(path + ": " + where), where_(where) {}
  const std::string& where() const { return where_; }

 private:
  std::string where_;
};

std::uint64_t rows_of(const PlyHeader& header) {
  std::uint64_t rows = 0;
  for (const PlyElement& element : header.elements) rows += element.count;
  return rows;
}

class PlyReader {
 public:
  PlyReader(std::string_view text, const std::string& path, Content content)
      : path_(path),
        content_(content),
        cursor_(text, path),
        header_(read_ply_header(cursor_)),
        values_(cursor_, header_.encoding, rows_of(header_), text.data() + text.size()) {}

  MeshFile read() {
    if (count_of("vertex") == 0) throw Failure(path_ + ": no vertices");
    if (count_of("face") + count_of("tristrips") == 0) throw without_faces(path_);
    for (const PlyElement& element : header_.elements) {
      if (element.name == "vertex") {
        read_vertices(element);
      } else if (element.name == "face") {
        if (element.count > 0) read_faces_there_are(element);
        if (!mesh_.truncated.empty()) break;
      } else if (element.name == "tristrips") {
        if (element.count > 0) read_strips(element);
      } else {
        read_table(element);
      }
    }
    if (mesh_.polygons.empty()) throw without_faces(path_);
    require_indices();
    if (!mesh_.corner_uvs.of_corner.empty()) unite_corner_uvs(mesh_);
    for (const std::string& keyword : header_.unknown) {
      note_unknown(mesh_.not_kept, "header lines", keyword);
    }
    if (values_.has_more()) mesh_.not_kept.emplace_back("numbers that the header does not name");
    mesh_.comments = std::move(header_.comments);
    return std::move(mesh_);
  }

 private:
  /// Where the values of a property go: nowhere, to a place in the row, or to a column.
  struct Target {
    const PlyProperty* property = nullptr;
    int slot = -1, column = -1;
  };

  std::uint64_t count_of(std::string_view name) const {
    const PlyElement* element = header_.find(name);
    return element ? element->count : 0;
  }

  bool wants_uvs() const { return content_ != Content::kSurface; }
  /// Whether UVs are those of corners: with both, these are the ones that a texture was made for.
  bool corners_have_uvs() const {
    const PlyElement* faces = header_.find("face");
    return faces != nullptr && faces->find_list("texcoord") != nullptr &&
           count_of("tristrips") == 0;
  }

  /// A column for the property, where columns are kept.
  Target keep(const PlyProperty& property, std::vector<Column>& columns) const {
    Target target{&property, -1, -1};
    if (!wants_attributes(content_)) return target;
    target.column = static_cast<int>(columns.size());
    columns.emplace_back(property.name, property.type, property.count_type.has_value());
    return target;
  }

  std::vector<Target> vertex_targets(const PlyElement& element) {
    std::array<std::string_view, 5> names = {"x", "y", "z", "", ""};
    std::vector<std::string_view> replaced = {"s", "t"};
    if (!element.find("x") || !element.find("y") || !element.find("z")) {
      throw Failure(path_ + ": vertices without the properties x, y and z");
    }
    for (const auto& pair : kUvNames) {
      if (!element.find(pair[0]) || !element.find(pair[1])) continue;
      replaced.insert(replaced.end(), pair.begin(), pair.end());
      if (names[3].empty()) std::copy(pair.begin(), pair.end(), names.begin() + 3);
    }
    if (wants_uvs() && !corners_have_uvs() && names[3].empty()) {
      throw Failure(path_ +
                    ": no texture coordinates: vertices need the properties s and t, u and v, or "
                    "texture_u and texture_v, or faces the list texcoord");
    }
    std::vector<Target> targets;
    for (const PlyProperty& property : element.properties) {
      const auto found = std::find(names.begin(), names.end(), property.name);
      const bool is_replaced =
          std::find(replaced.begin(), replaced.end(), property.name) != replaced.end();
      if (found != names.end() && !property.count_type) {
        targets.push_back({&property, static_cast<int>(found - names.begin()), -1});
      } else if (is_replaced) {
        targets.push_back({&property, -1, -1});
      } else {
        targets.push_back(keep(property, mesh_.vertex_columns));
      }
    }
    return targets;
  }

  void read_vertices(const PlyElement& element) {
    const std::vector<Target> targets = vertex_targets(element);
    std::array<double, 5> row{};
    for (std::uint64_t i = 0; i < element.count; ++i) {
      for (const Target& target : targets) {
        read_value(target, element, i, mesh_.vertex_columns, row.data());
      }
      mesh_.positions.insert(mesh_.positions.end(), row.begin(), row.begin() + 3);
      if (wants_uvs() && !corners_have_uvs()) {
        mesh_.uvs.insert(mesh_.uvs.end(), row.begin() + 3, row.end());
      }
      values_.end_row();
    }
  }

  /// The corner lists of faces or strips.
  const PlyProperty& corner_property(const PlyElement& element) const {
    const PlyProperty* corners = element.find_list("vertex_indices");
    if (!corners) corners = element.find_list("vertex_index");
    if (!corners) throw Failure(path_ + ": faces without the list property vertex_indices");
    return *corners;
  }

  /// Faces that have corners alone are whole up to where the file ends.
  void read_faces_there_are(const PlyElement& element) {
    try {
      read_faces(element);
    } catch (const Truncation& end) {
      mesh_.polygons.drop_open_corners();
      if (element.properties.size() > 1 || mesh_.polygons.empty()) throw;
      mesh_.truncated = end.where();
    }
  }

  void read_faces(const PlyElement& element) {
    const PlyProperty& corners = corner_property(element);
    // Strips become faces without properties: then there is no column for all of the faces.
    const bool with_columns = count_of("tristrips") == 0;
    const PlyProperty* textures = element.find_list("texcoord");
    std::vector<Target> targets;
    for (const PlyProperty& property : element.properties) {
      // UVs are replaced, or read for themselves.
      const bool skipped = property.name == "vertex_indices" || property.name == "vertex_index" ||
                           property.name == "texcoord";
      if (skipped || !with_columns) {
        targets.push_back({&property, -1, -1});
      } else {
        targets.push_back(keep(property, mesh_.face_columns));
      }
    }
    if (!with_columns && element.properties.size() > 1) {
      mesh_.not_kept.emplace_back("face properties beside triangle strips");
    }
    std::vector<std::uint64_t> rows;  // of the faces, where some rows are none
    for (std::uint64_t i = 0; i < element.count; ++i) {
      const std::uint64_t before = mesh_.polygons.size();
      for (const Target& target : targets) {
        if (target.property == &corners) {
          read_face(corners, element, i);
        } else if (wants_uvs() && with_columns && target.property == textures) {
          read_corner_uvs(*textures, element, i);
        } else {
          read_value(target, element, i, mesh_.face_columns, nullptr);
        }
      }
      values_.end_row();
      if (mesh_.polygons.size() == before) {
        set_aside(i, rows);
      } else {
        if (mesh_.short_faces > 0) rows.push_back(i);
        if (wants_uvs() && with_columns && textures != nullptr) require_corner_uvs(i);
      }
    }
    if (mesh_.short_faces == 0) return;
    for (Column& column : mesh_.face_columns) column = picked(column, rows);
  }

  /// A row of fewer than three corners is no face: exporters write edges so.
  void set_aside(std::uint64_t row, std::vector<std::uint64_t>& rows) {
    if (mesh_.short_faces++ == 0) {
      for (std::uint64_t i = 0; i < row; ++i) rows.push_back(i);
    }
    CornerUvs& uvs = mesh_.corner_uvs;
    const std::size_t corners = mesh_.polygons.corners().size();
    uvs.values.resize(std::min(uvs.values.size(), 2 * corners));
    uvs.of_corner.resize(std::min(uvs.of_corner.size(), corners));
  }

  /// The corners of a face may come before their UVs or after them.
  void require_corner_uvs(std::uint64_t face) const {
    const std::size_t corners = mesh_.polygons.corners().size();
    if (mesh_.corner_uvs.values.size() == 2 * corners) return;
    throw Failure(values_.place(path_) + "face " + std::to_string(face) +
                      " (counted from 0) needs two values in its list texcoord for each corner",
                  BELTRAMI_ELEMENT_FACE, face);
  }

  void read_corner_uvs(const PlyProperty& property, const PlyElement& element, std::uint64_t item) {
    CornerUvs& uvs = mesh_.corner_uvs;
    const std::uint64_t count = read_list_size(property, element, item);
    for (std::uint64_t k = 0; k < count; ++k) {
      uvs.values.push_back(next(property.type, element, item));
    }
    for (std::uint64_t k = 0; k < count / 2; ++k) {
      uvs.of_corner.push_back(static_cast<std::uint32_t>(uvs.of_corner.size()));
    }
  }

  void read_face(const PlyProperty& property, const PlyElement& element, std::uint64_t item) {
    const std::uint64_t count = read_list_size(property, element, item);
    for (std::uint64_t k = 0; k < count; ++k) {
      mesh_.polygons.add_corner(to_vertex(next(property.type, element, item)));
    }
    if (count < 3) return mesh_.polygons.drop_open_corners();
    mesh_.polygons.end_polygon();
  }

  /// Strips have a triangle for every three vertices in a row, every other one turned round; -1
  /// begins a new strip in the same list, and a vertex that is repeated makes a bridge, not a face.
  void read_strips(const PlyElement& element) {
    const PlyProperty& corners = corner_property(element);
    for (std::uint64_t i = 0; i < element.count; ++i) {
      for (const PlyProperty& property : element.properties) {
        if (&property == &corners) {
          read_strip(property, element, i);
        } else {
          read_value({&property, -1, -1}, element, i, mesh_.face_columns, nullptr);  // passed over
        }
      }
      values_.end_row();
    }
  }

  void read_strip(const PlyProperty& property, const PlyElement& element, std::uint64_t item) {
    const std::uint64_t count = read_list_size(property, element, item);
    std::array<std::uint32_t, 3> last{};
    std::uint64_t length = 0;  // of the strip so far
    for (std::uint64_t k = 0; k < count; ++k) {
      const double index = next(property.type, element, item);
      if (index == -1) {
        length = 0;
        continue;
      }
      last = {last[1], last[2], to_vertex(index)};
      if (++length < 3 || last[0] == last[1] || last[1] == last[2] || last[2] == last[0]) continue;
      const bool turned = length % 2 == 0;
      mesh_.polygons.add_corner(last[turned ? 1 : 0]);
      mesh_.polygons.add_corner(last[turned ? 0 : 1]);
      mesh_.polygons.add_corner(last[2]);
      mesh_.polygons.end_polygon();
    }
  }

  void read_table(const PlyElement& element) {
    Table table{element.name, element.count, {}};
    std::vector<Target> targets;
    for (const PlyProperty& property : element.properties) {
      targets.push_back(keep(property, table.columns));
    }
    if (targets.empty()) return;
    for (std::uint64_t i = 0; i < element.count; ++i) {
      for (const Target& target : targets) read_value(target, element, i, table.columns, nullptr);
      values_.end_row();
    }
    if (!table.columns.empty()) mesh_.tables.push_back(std::move(table));
  }

  /// Reads a value or a list to where it goes.
  void read_value(const Target& target, const PlyElement& element, std::uint64_t item,
                  std::vector<Column>& columns, double* row) {
    const PlyProperty& property = *target.property;
    Column* column =
        target.column < 0 ? nullptr : &columns[static_cast<std::size_t>(target.column)];
    const std::uint64_t count =
        property.count_type ? read_list_size(property, element, item) : std::uint64_t{1};
    for (std::uint64_t k = 0; k < count; ++k) {
      const double value = next(property.type, element, item);
      if (target.slot >= 0) row[target.slot] = value;
      if (column) column->append(value);
    }
    if (column && property.count_type) column->end_list();
  }

  std::uint64_t read_list_size(const PlyProperty& property, const PlyElement& element,
                               std::uint64_t item) {
    const double count = next(*property.count_type, element, item);
    // Negated so that NaN fails too.
    if (!(count >= 0 && count <= 4294967295.0 && count == std::floor(count))) {
      throw Failure(values_.place(path_) + "a list of " + element.name + " " +
                    std::to_string(item) + " (counted from 0) has " + short_number(count) +
                    " items");
    }
    return static_cast<std::uint64_t>(count);
  }

  double next(Scalar type, const PlyElement& element, std::uint64_t item) {
    double value = 0;
    if (!values_.next(type, value)) {
      throw Truncation(path_, "the file is truncated: it ends in " + element.name + " " +
                                  std::to_string(item) + " (counted from 0) of " +
                                  std::to_string(element.count));
    }
    return value;
  }

  /// What cannot be a vertex fails here, and what is not one too where the vertices came first, as
  /// they mostly do: then the line is known.
  std::uint32_t to_vertex(double index) const {
    const double limit = mesh_.positions.empty() ? static_cast<double>(kMaxIndex)
                                                 : static_cast<double>(mesh_.vertex_count());
    // Negated so that NaN fails too.
    if (!(index >= 0 && index < limit && index == std::floor(index))) {
      fail_index(values_.place(path_), short_number(index), mesh_.polygons.size());
    }
    return static_cast<std::uint32_t>(index);
  }

  void require_indices() const {
    const std::vector<std::uint32_t>& corners = mesh_.polygons.corners();
    for (std::size_t i = 0; i < corners.size(); ++i) {
      if (corners[i] < mesh_.vertex_count()) continue;
      fail_index(path_ + ": ", std::to_string(corners[i]), mesh_.polygons.of_corner(i));
    }
  }

  [[noreturn]] void fail_index(const std::string& place, const std::string& index,
                               std::uint64_t face) const {
    throw Failure(BELTRAMI_E_INDEX_OUT_OF_RANGE,
                  place + "face " + std::to_string(face) + " (counted from 0) names vertex " +
                      index + ", but the file has " + std::to_string(count_of("vertex")),
                  BELTRAMI_ELEMENT_FACE, face);
  }

  const std::string& path_;
  Content content_;
  TextCursor cursor_;
  PlyHeader header_;
  Values values_;
  MeshFile mesh_;
};

}  // namespace

MeshFile read_ply(std::string_view text, const std::string& path, Content content) {
  return PlyReader(text, path, content).read();
}

}  // namespace beltrami::cli
