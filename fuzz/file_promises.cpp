#include "file_promises.h"

#include <beltrami/beltrami.h>

#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "files/column.h"
#include "files/polygons.h"
#include "files/surface.h"
#include "files/surface_view.h"
#include "host.h"
#include "process/failure.h"
#include "target.h"

namespace beltrami::fuzz {
namespace {

using cli::Column;
using cli::Content;
using cli::MeshFile;

void judge_columns(const std::vector<Column>& columns, std::uint64_t items) {
  for (const Column& column : columns) {
    promise((items ? column.end(items - 1) : 0) == column.size(),
            "a column has a value for each of its items");
  }
}

void judge_corners(const MeshFile& file) {
  const std::uint64_t vertices = file.vertex_count();
  const std::vector<std::uint32_t>& corners = file.polygons.corners();
  promise(file.polygons.open_corners() == 0, "every polygon is closed");
  for (const std::uint32_t v : corners) promise(v < vertices, "every corner is a vertex");
  for (std::uint64_t i = 0; i < file.polygons.size(); ++i) {
    promise(file.polygons[i].size() >= 3, "every polygon has three corners or more");
  }
  const std::vector<std::uint32_t>& normals = file.normals.of_corner;
  promise(normals.empty() || normals.size() == corners.size(), "normals are of corners");
  for (const std::uint32_t n : normals) {
    promise(n == cli::kNoNormal || 3 * std::size_t{n} + 2 < file.normals.values.size(),
            "every normal of a corner is stored");
  }
  const std::vector<std::uint32_t>& uvs = file.corner_uvs.of_corner;
  promise(uvs.empty() || uvs.size() == corners.size(), "UVs are of corners");
  for (const std::uint32_t u : uvs) {
    promise(2 * std::size_t{u} + 1 < file.corner_uvs.values.size(), "every UV is stored");
  }
}

void write_and_read_back(const MeshFile& file, const char* path) {
  cli::not_kept(file, path);
  std::string text;
  cli::write_mesh(file, path, [&](std::string_view bytes) { text += bytes; });
  const auto reader = std::string_view(path) == "a.obj" ? cli::read_obj : cli::read_ply;
  try {
    const MeshFile back = reader(text, path, Content::kUvs);
    promise(back.polygons.corners() == file.polygons.corners(), "corners are read back");
    promise(back.polygons.size() == file.polygons.size(), "polygons are read back");
  } catch (const cli::Failure&) {
    broken("what was written is read back");
  }
}

void judge_atlas(beltrami_context* context, beltrami_surface surface) {
  std::vector<double> uvs(2 * surface.corner_count);
  promise(beltrami_get_corner_uvs(context, uvs.data(), BELTRAMI_F64, 0) == BELTRAMI_OK,
          "an atlas has UVs");
  for (const double x : uvs) promise(std::isfinite(x), "UVs are finite");
  beltrami_atlas_certificate own{}, other{};
  own.struct_size = other.struct_size = sizeof own;
  promise(beltrami_get_atlas_certificate(context, BELTRAMI_F64, &own) == BELTRAMI_OK,
          "an atlas has a certificate");
  beltrami_packing packing{};
  packing.struct_size = sizeof packing;
  promise(beltrami_get_packing(context, &packing) == BELTRAMI_OK, "an atlas is packed");
  if (packing.pages != 1) return;
  surface.corner_uvs = {uvs.data(), 0, BELTRAMI_F64, 0};
  // A chart of faces that run against most of their component is mirrored in their own winding.
  beltrami_atlas atlas{};
  atlas.struct_size = sizeof atlas;
  promise(beltrami_get_atlas(context, &atlas) == BELTRAMI_OK, "an atlas has counts");
  const beltrami_status status =
      beltrami_check_atlas(&surface, atlas.reversed_faces > 0, &other, nullptr, 0);
  promise((status == BELTRAMI_OK) == (own.injective != 0), "both checks agree");
}

}  // namespace

void judge_file(MeshFile file) {
  const std::uint64_t vertices = file.vertex_count();
  promise(file.positions.size() == 3 * vertices, "positions come in threes");
  promise(file.uvs.empty() || file.uvs.size() == 2 * vertices, "UVs are of vertices");
  judge_corners(file);
  judge_columns(file.vertex_columns, vertices);
  judge_columns(file.face_columns, file.polygons.size());
  for (const cli::Table& table : file.tables) judge_columns(table.columns, table.count);
  for (const cli::Statement& statement : file.statements) {
    promise(statement.polygon <= file.polygons.size(), "statements stand before polygons");
  }
  try {
    for (const bool weld : {false, true}) {
      const cli::Surface surface(file, weld);
      cli::component_count(surface.view());
      for (const std::uint32_t v : surface.view().faces) {
        promise(v < vertices, "every corner of a triangle is a vertex");
      }
    }
  } catch (const cli::Failure&) {
    // It has no triangles, and can be written all the same.
  }
  file.corner_uvs = {};
  file.uvs.assign(2 * vertices, 0.25);
  for (const char* path : {"a.obj", "a.ply"}) write_and_read_back(file, path);
}

void unwrap_file(const MeshFile& file, int polls, std::uint64_t most_faces) {
  if (file.polygons.corners().size() > 3 * most_faces) return;
  const Context context = make_context();
  beltrami_context* const made = context.get();
  beltrami_set_int(made, BELTRAMI_OPTION_CUT, BELTRAMI_CUT_MINIMAL);
  beltrami_set_int(made, BELTRAMI_OPTION_RESOLUTION, 32);
  beltrami_set_int(made, BELTRAMI_OPTION_THREADS, 1);
  const cli::SurfaceView view(file);
  const beltrami_surface surface = view.surface();
  const beltrami_status status = beltrami_unwrap(made, &surface, count_down, &polls);
  judge_status(made, status);
  if (status >= BELTRAMI_OK) judge_atlas(made, surface);
}

}  // namespace beltrami::fuzz
