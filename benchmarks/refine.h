// High-resolution meshes from small ones, so that benchmarks need no data of their own.
#pragma once

#include <cstdint>

#include "mesh_file.h"

namespace beltrami::benchmarks {

/// Subdivides by Loop's rules (boundary rules included; Loop 1987) while four times the faces stay
/// within `faces`, then splits longest edges until about `faces` are there. Manifold meshes only.
cli::MeshFile refine(const cli::MeshFile& mesh, std::uint64_t faces);

}  // namespace beltrami::benchmarks
