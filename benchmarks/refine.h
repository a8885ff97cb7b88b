// Meshes from files, and high-resolution ones from small ones, so that benchmarks need no data of
// their own.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "files/surface.h"

namespace beltrami::benchmarks {

struct TriangleMesh {
  std::vector<double> positions;
  std::vector<std::uint32_t> faces;

  std::uint64_t vertex_count() const { return positions.size() / 3; }
  std::uint64_t face_count() const { return faces.size() / 3; }
  cli::TriangleView view() const { return {positions, faces, {}}; }
};

/// The triangles of a mesh file. Throws cli::Failure.
TriangleMesh read_triangles(const std::string& path);

/// Subdivides by Loop's rules (boundary rules included; Loop 1987) while four times the faces stay
/// within `faces`, then splits longest edges until about `faces` are there. Manifold meshes only.
TriangleMesh refine(const TriangleMesh& mesh, std::uint64_t faces);

}  // namespace beltrami::benchmarks
