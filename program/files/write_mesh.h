// The formats behind write_mesh and not_kept: what is written and what is said to be left out stand
// side by side.
#pragma once

#include <string>
#include <vector>

#include "files/mesh_file.h"
#include "files/writer.h"

namespace beltrami::cli {

/// `path`: of the output, to which names of other files are to lead on.
void write_obj(const MeshFile& mesh, const std::string& path, Writer& out);
void write_ply(const MeshFile& mesh, const std::string& path, Writer& out);

/// What write_obj and write_ply leave out.
std::vector<std::string> not_in_obj(const MeshFile& mesh, const std::string& path);
std::vector<std::string> not_in_ply(const MeshFile& mesh, const std::string& path);

}  // namespace beltrami::cli
