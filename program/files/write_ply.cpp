// Binary PLY with one UV per vertex, as the properties s and t: the names that Blender and most
// other readers take for UVs of vertices; or with those of corners, as the list texcoord of faces,
// as MeshLab and what follows it has them.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "files/column.h"
#include "files/mesh_file.h"
#include "files/moved_names.h"
#include "files/polygons.h"
#include "files/uv_numbers.h"
#include "files/writer.h"

namespace beltrami::cli {
namespace {

constexpr std::string_view kOwnComment = "comment UVs by beltrami";

bool is_colour(const Column& column) {
  return column.name() == "red" || column.name() == "green" || column.name() == "blue" ||
         column.name() == "alpha";
}

/// The bytes that these fractions of 1 stand for; nothing if some stand for none.
std::optional<Column> as_bytes(const Column& column) {
  Column bytes(column.name(), Scalar::kU8);
  for (std::uint64_t i = 0; i < column.size(); ++i) {
    const double scaled = 255 * column[i], rounded = std::round(scaled);
    // Writers give such a fraction four digits or more; negated so that NaN fails too.
    const bool whole = rounded >= 0 && rounded <= 255 && std::abs(scaled - rounded) < 0.02;
    if (!whole) return std::nullopt;
    bytes.append(rounded);
  }
  return bytes;
}

/// The colours of vertices in bytes, as readers of PLY expect them, where they stand for bytes;
/// empty where the columns are to be written as they are.
std::vector<Column> colours_in_bytes(const MeshFile& mesh) {
  std::vector<Column> colours;
  if (!mesh.unit_colours) return colours;
  for (const Column& column : mesh.vertex_columns) {
    if (!is_colour(column)) continue;
    std::optional<Column> bytes = as_bytes(column);
    if (!bytes) return {};
    colours.push_back(std::move(*bytes));
  }
  return colours;
}

/// Vertex columns nx, ny and nz from the normals of corners, where all corners of a vertex agree.
std::vector<Column> vertex_normals(const MeshFile& mesh) {
  const CornerNormals& normals = mesh.normals;
  if (normals.of_corner.empty()) return {};
  std::vector<std::uint32_t> of_vertex(mesh.vertex_count(), kNoNormal);
  for (std::size_t c = 0; c < normals.of_corner.size(); ++c) {
    const std::uint32_t normal = normals.of_corner[c];
    std::uint32_t& known = of_vertex[mesh.polygons.corners()[c]];
    if (known == kNoNormal) known = normal;
    if (normal == kNoNormal) return {};
    const double* values = normals.values.data();
    if (!std::equal(values + 3 * std::size_t{known}, values + 3 * std::size_t{known} + 3,
                    values + 3 * std::size_t{normal})) {
      return {};
    }
  }
  std::vector<Column> columns;
  for (std::size_t k = 0; k < 3; ++k) {
    Column& column = columns.emplace_back(std::string("n") + "xyz"[k], Scalar::kF64);
    for (const std::uint32_t normal : of_vertex) {
      column.append(normal == kNoNormal ? 0 : normals.values[3 * std::size_t{normal} + k]);
    }
  }
  return columns;
}

/// Lists count in bytes where that is enough.
Scalar count_type(const Column& column, std::uint64_t items) {
  std::uint64_t longest = 0;
  for (std::uint64_t i = 0; i < items; ++i) {
    longest = std::max(longest, column.end(i) - column.begin(i));
  }
  return longest <= std::numeric_limits<std::uint8_t>::max() ? Scalar::kU8 : Scalar::kU32;
}

void write_count(Scalar type, std::uint64_t count, Writer& out) {
  if (type == Scalar::kU8) {
    out.binary(static_cast<std::uint8_t>(count));
  } else {
    out.binary(static_cast<std::uint32_t>(count));
  }
}

/// `count`: the type of a list's count, or "".
void declare_property(std::string_view count, std::string_view type, std::string_view name,
                      Writer& out) {
  out.text("property ");
  if (!count.empty()) {
    out.text("list ");
    out.text(count);
    out.text(" ");
  }
  out.text(type);
  out.text(" ");
  out.text(name);
  out.text("\n");
}

/// Columns as they stand in the file, with the types of their counts.
class ColumnWriter {
 public:
  ColumnWriter(std::vector<const Column*> columns, std::uint64_t items)
      : columns_(std::move(columns)) {
    for (const Column* column : columns_) {
      count_types_.push_back(column->is_list() ? count_type(*column, items) : Scalar::kU8);
    }
  }

  void declare(Writer& out) const {
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      declare_property(columns_[k]->is_list() ? name_of(count_types_[k]) : "",
                       name_of(columns_[k]->type()), columns_[k]->name(), out);
    }
  }

  void write(std::uint64_t item, Writer& out) const {
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      const Column& column = *columns_[k];
      const std::uint64_t begin = column.begin(item), end = column.end(item);
      if (column.is_list()) write_count(count_types_[k], end - begin, out);
      for (std::uint64_t i = begin; i < end; ++i) out.binary(column.bytes(i));
    }
  }

 private:
  std::vector<const Column*> columns_;
  std::vector<Scalar> count_types_;
};

std::vector<const Column*> pointers_to(const std::vector<Column>& columns) {
  std::vector<const Column*> pointers;
  for (const Column& column : columns) pointers.push_back(&column);
  return pointers;
}

void declare_element(std::string_view name, std::uint64_t count, Writer& out) {
  out.text("element ");
  out.text(name);
  out.text(" ");
  out.number(count);
  out.text("\n");
}

/// Of a list with so many values for each corner.
Scalar corner_count_type(const Polygons& polygons, std::uint64_t values) {
  std::uint64_t most = 3;
  for (std::uint64_t i = 0; i < polygons.size() && !polygons.all_triangles(); ++i) {
    most = std::max(most, polygons.end(i) - polygons.begin(i));
  }
  return values * most <= std::numeric_limits<std::uint8_t>::max() ? Scalar::kU8 : Scalar::kU32;
}

bool has_corner_uvs(const MeshFile& mesh) {
  return !mesh.corner_uvs.of_corner.empty();
}

void write_uv(const MeshFile& mesh, const double* uv, Writer& out) {
  const UvNumbers numbers = uv_numbers(MeshFormat::kPly, mesh.single_uvs);
  for (const double value : numbers.held(uv[0], uv[1])) {
    if (numbers.single) {
      out.binary(static_cast<float>(value));
    } else {
      out.binary(value);
    }
  }
}

void write_vertices(const MeshFile& mesh, const ColumnWriter& columns, Writer& out) {
  for (std::uint64_t i = 0; i < mesh.vertex_count(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) out.binary(mesh.positions[3 * i + k]);
    if (has_corner_uvs(mesh)) {
      columns.write(i, out);
      continue;
    }
    write_uv(mesh, &mesh.uvs[2 * i], out);
    columns.write(i, out);
  }
}

void write_faces(const MeshFile& mesh, Scalar count_type, Scalar uv_count_type,
                 const ColumnWriter& columns, Writer& out) {
  for (std::uint64_t i = 0; i < mesh.polygons.size(); ++i) {
    const auto corners = mesh.polygons[i];
    write_count(count_type, corners.size(), out);
    for (const std::uint32_t vertex : corners) out.binary(static_cast<std::int32_t>(vertex));
    if (has_corner_uvs(mesh)) {
      write_count(uv_count_type, 2 * corners.size(), out);
      for (std::uint64_t c = mesh.polygons.begin(i); c < mesh.polygons.end(i); ++c) {
        write_uv(mesh, &mesh.corner_uvs.values[2 * std::size_t{mesh.corner_uvs.of_corner[c]}], out);
      }
    }
    columns.write(i, out);
  }
}

/// What a statement of OBJ is about, in words.
std::string subject_of(const Statement& statement) {
  const std::string keyword = statement.text.substr(0, statement.text.find_first_of(" \t"));
  if (keyword == "o") return "objects";
  if (keyword == "g") return "groups";
  if (keyword == "s") return "smoothing groups";
  if (keyword == "usemtl" || keyword == "mtllib") return "materials";
  if (keyword == "l" || keyword == "p") return "lines and points";
  return "statements '" + keyword + "'";
}

}  // namespace

void write_ply(const MeshFile& mesh, const std::string& path, Writer& out) {
  const std::vector<Column> normals = vertex_normals(mesh);
  const std::vector<Column> colours = colours_in_bytes(mesh);
  std::vector<const Column*> vertex_columns = pointers_to(mesh.vertex_columns);
  for (const Column*& column : vertex_columns) {
    if (const Column* bytes = find_column(colours, column->name())) column = bytes;
  }
  for (const Column& column : normals) vertex_columns.push_back(&column);
  const ColumnWriter of_vertices(std::move(vertex_columns), mesh.vertex_count());
  const ColumnWriter of_faces(pointers_to(mesh.face_columns), mesh.polygons.size());
  std::vector<ColumnWriter> of_tables;
  for (const Table& table : mesh.tables) {
    of_tables.emplace_back(pointers_to(table.columns), table.count);
  }

  out.text("ply\nformat binary_little_endian 1.0\n");
  out.text(kOwnComment);
  out.text("\n");
  MovedNames names(mesh, path);
  for (const std::string& comment : mesh.comments) {
    if (comment == kOwnComment) continue;
    out.text(names.line(comment));
    out.text("\n");
  }
  declare_element("vertex", mesh.vertex_count(), out);
  out.text("property double x\nproperty double y\nproperty double z\n");
  const bool single = uv_numbers(MeshFormat::kPly, mesh.single_uvs).single;
  const std::string_view number = single ? "float" : "double";
  for (const std::string_view name : {"s", "t"}) {
    if (!has_corner_uvs(mesh)) declare_property("", number, name, out);
  }
  of_vertices.declare(out);
  declare_element("face", mesh.polygons.size(), out);
  const Scalar count_type = corner_count_type(mesh.polygons, 1);
  const Scalar uv_count_type = corner_count_type(mesh.polygons, 2);
  declare_property(name_of(count_type), "int", "vertex_indices", out);
  if (has_corner_uvs(mesh)) declare_property(name_of(uv_count_type), number, "texcoord", out);
  of_faces.declare(out);
  for (std::size_t i = 0; i < mesh.tables.size(); ++i) {
    declare_element(mesh.tables[i].name, mesh.tables[i].count, out);
    of_tables[i].declare(out);
  }
  out.text("end_header\n");

  write_vertices(mesh, of_vertices, out);
  write_faces(mesh, count_type, uv_count_type, of_faces, out);
  for (std::size_t i = 0; i < mesh.tables.size(); ++i) {
    for (std::uint64_t k = 0; k < mesh.tables[i].count; ++k) of_tables[i].write(k, out);
  }
}

std::vector<std::string> not_in_ply(const MeshFile& mesh, const std::string& path) {
  MovedNames names(mesh, path);
  for (const std::string& comment : mesh.comments) names.line(comment);
  std::vector<std::string> found = names.notes();
  for (const Statement& statement : mesh.statements) {
    std::string subject = subject_of(statement);
    if (std::find(found.begin(), found.end(), subject) == found.end()) {
      found.push_back(std::move(subject));
    }
  }
  if (!mesh.normals.of_corner.empty() && vertex_normals(mesh).empty()) {
    found.emplace_back("normals (a vertex has several)");
  }
  return found;
}

}  // namespace beltrami::cli
