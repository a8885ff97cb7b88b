// What a reader of mesh files has proved when it returns.
#pragma once

#include "files/mesh_file.h"

namespace beltrami::fuzz {

/// Judges all that the writers, the surface and the library rely on; then gives the file UVs,
/// writes it as OBJ and PLY, and reads it back.
void judge_file(cli::MeshFile file);

/// Unwraps the file's surface along a minimal cut, which ends after `polls` looks at its progress,
/// and has another check judge the result. Files of more than `most_faces` are left out.
void unwrap_file(const cli::MeshFile& file, int polls, std::uint64_t most_faces);

}  // namespace beltrami::fuzz
