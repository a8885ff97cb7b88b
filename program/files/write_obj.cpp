// OBJ with one vt per vertex, or those of corners.
#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "files/column.h"
#include "files/mesh_file.h"
#include "files/moved_names.h"
#include "files/writer.h"

namespace beltrami::cli {
namespace {

/// Columns that a `v` can carry behind its coordinates, and vn statements.
constexpr std::array<std::string_view, 4> kColour = {"red", "green", "blue", "alpha"};
constexpr std::array<std::string_view, 3> kNormal = {"nx", "ny", "nz"};
constexpr std::string_view kWeight = "w";

/// The columns with these names, as many as there are up to the first that is missing.
template <std::size_t N>
std::vector<const Column*> columns_named(const MeshFile& mesh,
                                         const std::array<std::string_view, N>& names,
                                         std::size_t least) {
  std::vector<const Column*> found;
  for (const std::string_view name : names) {
    const Column* column = find_column(mesh.vertex_columns, name);
    if (!column) break;
    found.push_back(column);
  }
  if (found.size() < least) found.clear();
  return found;
}

/// What stands behind the coordinates of a vertex: a colour, or a weight, or nothing.
std::vector<const Column*> extra_columns(const MeshFile& mesh) {
  std::vector<const Column*> found = columns_named(mesh, kColour, 3);
  if (found.empty()) found = columns_named(mesh, std::array{kWeight}, 1);
  return found;
}

std::vector<const Column*> normal_columns(const MeshFile& mesh) {
  return columns_named(mesh, kNormal, 3);
}

/// What divides a part of a colour, so that it goes from 0 to 1: integers have their full range.
double whole_of(const MeshFile& mesh, const Column& column) {
  if (mesh.unit_colours || column.name() == kWeight) return 1;
  return column.type() == Scalar::kU8 ? 255 : column.type() == Scalar::kU16 ? 65535 : 1;
}

void write_vertices(const MeshFile& mesh, Writer& out) {
  const std::vector<const Column*> extra = extra_columns(mesh);
  for (std::uint64_t i = 0; i < mesh.vertex_count(); ++i) {
    out.text("v");
    for (std::size_t k = 0; k < 3; ++k) {
      out.text(" ");
      out.number(mesh.positions[3 * i + k]);
    }
    for (const Column* column : extra) {
      const double value = (*column)[i] / whole_of(mesh, *column);
      if (std::isnan(value)) break;  // the line of the input was shorter than others
      out.text(" ");
      out.number(value);
    }
    out.text("\n");
  }
}

void write_uvs(const MeshFile& mesh, Writer& out) {
  const std::vector<double>& uvs =
      mesh.corner_uvs.of_corner.empty() ? mesh.uvs : mesh.corner_uvs.values;
  for (std::size_t i = 0; i < uvs.size(); i += 2) {
    out.text("vt ");
    out.number(uvs[i]);
    out.text(" ");
    out.number(uvs[i + 1]);
    out.text("\n");
  }
}

void write_normals(const MeshFile& mesh, const std::vector<const Column*>& columns, Writer& out) {
  const auto write = [&](auto value_of, std::uint64_t count) {
    for (std::uint64_t i = 0; i < count; ++i) {
      out.text("vn");
      for (std::size_t k = 0; k < 3; ++k) {
        out.text(" ");
        out.number(value_of(i, k));
      }
      out.text("\n");
    }
  };
  if (columns.empty()) {
    const std::vector<double>& values = mesh.normals.values;
    write([&](std::uint64_t i, std::size_t k) { return values[3 * i + k]; }, values.size() / 3);
  } else {
    write([&](std::uint64_t i, std::size_t k) { return (*columns[k])[i]; }, mesh.vertex_count());
  }
}

void write_face(const MeshFile& mesh, std::uint64_t face, bool vertex_normals, Writer& out) {
  const std::vector<std::uint32_t>& of_corner = mesh.normals.of_corner;
  const std::vector<std::uint32_t>& uv_of_corner = mesh.corner_uvs.of_corner;
  out.text("f");
  for (std::uint64_t c = mesh.polygons.begin(face); c < mesh.polygons.end(face); ++c) {
    const std::uint64_t number = std::uint64_t{mesh.polygons.corners()[c]} + 1;
    out.text(" ");
    out.number(number);
    out.text("/");
    out.number(uv_of_corner.empty() ? number : std::uint64_t{uv_of_corner[c]} + 1);
    const std::uint64_t normal = vertex_normals              ? number
                                 : of_corner.empty()         ? 0
                                 : of_corner[c] == kNoNormal ? 0
                                                             : std::uint64_t{of_corner[c]} + 1;
    if (normal == 0) continue;
    out.text("/");
    out.number(normal);
  }
  out.text("\n");
}

bool is_line(const Statement& statement) {
  const std::string_view keyword =
      std::string_view(statement.text).substr(0, statement.text.find(' '));
  return keyword == "l" || keyword == "p";
}

/// A line of vertices, without the UVs that they have where each has one.
std::string without_uvs(const std::string& line) {
  std::string text;
  bool in_uv = false;
  for (const char c : line) {
    in_uv = c == '/' || (in_uv && c != ' ');
    if (!in_uv) text += c;
  }
  return text;
}

}  // namespace

void write_obj(const MeshFile& mesh, const std::string& path, Writer& out) {
  MovedNames names(mesh, path);
  const bool per_vertex = mesh.corner_uvs.of_corner.empty();
  out.text(per_vertex ? "# UVs by beltrami: one vt per vertex, in vertex order\n"
                      : "# UVs by beltrami\n");
  auto next = mesh.statements.begin();
  const auto write_statement = [&] {
    out.text(next->leads_on                  ? next->text
             : per_vertex || !is_line(*next) ? names.line(next->in_file())
                                             : without_uvs(next->text));
    out.text("\n");
    ++next;
  };
  const auto end = mesh.statements.end();
  // Files begin with mtllib and a first name, which readers may want before the vertices.
  while (next != end && next->polygon == 0 && !is_line(*next)) write_statement();
  const std::vector<const Column*> normals = normal_columns(mesh);
  write_vertices(mesh, out);
  write_uvs(mesh, out);
  write_normals(mesh, normals, out);
  for (std::uint64_t i = 0; i < mesh.polygons.size(); ++i) {
    while (next != end && next->polygon <= i) write_statement();
    write_face(mesh, i, !normals.empty(), out);
  }
  while (next != end) write_statement();
}

std::vector<std::string> not_in_obj(const MeshFile& mesh, const std::string& path) {
  std::vector<const Column*> kept = extra_columns(mesh);
  for (const Column* column : normal_columns(mesh)) kept.push_back(column);
  MovedNames names(mesh, path);
  for (const Statement& statement : mesh.statements) {
    if (!statement.leads_on) names.line(statement.in_file());
  }
  std::vector<std::string> found = names.notes();
  for (const Column& column : mesh.vertex_columns) {
    if (std::find(kept.begin(), kept.end(), &column) != kept.end()) continue;
    found.push_back("vertex property " + column.name());
  }
  if (!mesh.gltf) {  // whose properties of faces are the numbers of its meshes and materials
    for (const Column& column : mesh.face_columns) {
      found.push_back("face property " + column.name());
    }
  }
  for (const Table& table : mesh.tables) found.push_back("element " + table.name);
  return found;
}

}  // namespace beltrami::cli
