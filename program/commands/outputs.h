// Meshes with new corner UVs, as commands write them.
#pragma once

#include <beltrami/beltrami.h>

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "commands/report.h"
#include "files/atomic_file.h"
#include "files/gltf_file.h"
#include "files/mesh_file.h"

namespace beltrami::cli {

/// Throws Failure unless a mesh read from `input` can be written as `output`: OBJ, PLY, or glTF of
/// glTF.
void require_output_format(const std::string& input, const std::string& output);

/// Throws Failure for a set of UVs other than the first where `output` is not glTF.
void require_uv_set_of_gltf(std::uint32_t uv_set, const std::string& output);

/// Gives a mesh these UVs, u v for each corner, instead of those that it has.
void set_corner_uvs(MeshFile& file, const std::vector<double>& uvs, bool single);

/// The verdict on the numbers that a file at `path` holds of the corner UVs of `file`; nothing
/// where it holds them exactly. `share`: faces that have the UVs of another one are copies or
/// stacked, and overlap it on purpose. `mirrored`: charts that are mirrored as a whole are no
/// fault. Throws Failure with the path of the input.
std::optional<beltrami_atlas_certificate> judge_held_uvs(const MeshFile& file,
                                                         const std::string& path, bool share,
                                                         bool mirrored);

/// Notes in the report where what a file holds of an atlas that is injective is not; `held`: the
/// verdict on it.
void note_held(const beltrami_atlas_certificate& held, Report& report);

/// Writes a mesh with its UVs, and textures that were baked for them or what is said of those that
/// were not, where it is glTF, complete on the disk but not in place. Notes in the report what of
/// it is not kept, and what else is to be known of it.
void write_outputs(const MeshFile& file, const std::string& path, std::uint32_t uv_set,
                   std::deque<AtomicFile>& outputs, Report& report,
                   const GltfTextures& textures = {});

}  // namespace beltrami::cli
