// The formats behind write_mesh and not_kept: what is written and what is said to be left out stand
// side by side.
#pragma once

#include <string>
#include <vector>

#include "files/mesh_file.h"
#include "files/writer.h"

namespace beltrami::cli {

void write_obj(const MeshFile& mesh, Writer& out);
void write_ply(const MeshFile& mesh, Writer& out);

/// What write_obj and write_ply leave out.
std::vector<std::string> not_in_obj(const MeshFile& mesh);
std::vector<std::string> not_in_ply(const MeshFile& mesh);

}  // namespace beltrami::cli
