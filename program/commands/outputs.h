// Meshes with new corner UVs, as commands write them.
#pragma once

#include <beltrami/beltrami.h>

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "files/atomic_file.h"
#include "files/mesh_file.h"

namespace beltrami::cli {

/// Throws Failure unless a mesh read from `input` can be written as `output`: OBJ, PLY, or glTF of
/// glTF.
void require_output_format(const std::string& input, const std::string& output);

/// Gives a mesh these UVs, u v for each corner, instead of those that it has.
void set_corner_uvs(MeshFile& file, const std::vector<double>& uvs, bool single);

/// The verdict on what glTF stores of the mesh's UVs: u and 1 - v in single precision. A mirror and
/// a shift from them to -v are exact. Throws Failure with `path`.
beltrami_status judge_stored_uvs(MeshFile& file, const std::string& path,
                                 beltrami_atlas_certificate& found);

/// Writes a mesh with its UVs, complete on the disk but not in place. Returns what of it is not
/// kept.
std::vector<std::string> write_outputs(const MeshFile& file, const std::string& path,
                                       std::uint32_t uv_set, std::deque<AtomicFile>& outputs);

}  // namespace beltrami::cli
