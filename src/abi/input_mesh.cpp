#include "abi/input_mesh.h"

#include <utility>

#include "abi/buffers.h"
#include "base/error.h"

namespace beltrami {
namespace {

/// Builds the disk from the faces as the input numbers them, only to fail: renumbering keeps the
/// order of the vertices, so it meets the same defect, and names it by the input's numbers.
/// Costs a second pass over an invalid mesh and saves rewriting sentences.
void fail_in_input_numbers(const beltrami_mesh& mesh, const std::vector<Index>& original,
                           const std::vector<Vec3>& used_positions) {
  std::vector<Vec3> positions(mesh.vertex_count, Vec3::Zero());
  for (std::size_t i = 0; i < used_positions.size(); ++i) {
    positions[static_cast<std::size_t>(original[i])] = used_positions[i];
  }
  build_disk(std::move(positions), read_faces(mesh));
}

std::vector<Vec3> used_positions(const beltrami_mesh& mesh, const std::vector<Index>& original,
                                 Positions positions) {
  return positions == Positions::kRead ? read_positions(mesh, original)
                                       : std::vector<Vec3>(original.size(), Vec3::Zero());
}

}  // namespace

InputTriangles read_triangles(const beltrami_mesh& mesh) {
  InputTriangles triangles;
  triangles.faces = read_faces(mesh);
  triangles.original =
      drop_unreferenced(static_cast<Index>(mesh.vertex_count), triangles.faces).original;
  return triangles;
}

InputDisk read_disk(const beltrami_mesh& mesh, Positions positions) {
  InputTriangles triangles = read_triangles(mesh);
  InputDisk input;
  input.original = std::move(triangles.original);
  try {
    input.disk =
        build_disk(used_positions(mesh, input.original, positions), std::move(triangles.faces));
  } catch (const Error& error) {
    const bool renumbered = input.original.size() != mesh.vertex_count;
    if (renumbered && error.element().kind != BELTRAMI_ELEMENT_NONE) {
      fail_in_input_numbers(mesh, input.original, used_positions(mesh, input.original, positions));
    }
    throw;
  }
  return input;
}

}  // namespace beltrami
