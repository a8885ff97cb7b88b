// What benchmarks that call the library share.
#pragma once

#include <beltrami/beltrami.h>

#include "mesh_file.h"

namespace beltrami::benchmarks {

/// The arrays of the file as the library takes them; they must outlive the view.
inline beltrami_mesh view_of(const cli::MeshFile& file) {
  beltrami_mesh mesh{};
  mesh.struct_size = sizeof mesh;
  mesh.vertex_count = file.vertex_count();
  mesh.face_count = file.face_count();
  mesh.positions = {file.positions.data(), 0, BELTRAMI_F64, 0};
  mesh.indices = {file.faces.data(), 0, BELTRAMI_U32, 0};
  return mesh;
}

}  // namespace beltrami::benchmarks
