#include "abi/input_mesh.h"

#include <utility>

#include "abi/buffers.h"
#include "base/error.h"
#include "base/vectors.h"
#include "mesh/locality.h"
#include "mesh/surface.h"

namespace beltrami {
namespace {

/// Builds the disk from the faces as the input numbers them, only to fail: it meets a defect that
/// the renumbered mesh has too, and names it by the input's numbers. Costs a second pass over an
/// invalid mesh and saves rewriting sentences.
void fail_in_input_numbers(const beltrami_mesh& mesh, const InputDisk& input,
                           const std::vector<Vec3>& used_positions, const Work& work) {
  std::vector<Vec3> positions(mesh.vertex_count, Vec3::Zero());
  for (std::size_t i = 0; i < used_positions.size(); ++i) {
    positions[static_cast<std::size_t>(input.original[i])] = used_positions[i];
  }
  build_disk(std::move(positions), read_faces(mesh, work), work);
}

}  // namespace

InputTriangles read_triangles(const beltrami_mesh& mesh, const Work& work) {
  InputTriangles triangles;
  triangles.faces = read_faces(mesh, work);
  triangles.original =
      drop_unreferenced(static_cast<Index>(mesh.vertex_count), triangles.faces, work);
  return triangles;
}

InputDisk read_disk(const beltrami_mesh& mesh, const Work& work) {
  InputTriangles triangles = read_triangles(mesh, work);
  InputDisk input;
  input.original = std::move(triangles.original);
  std::vector<Vec3> positions = read_positions(mesh, input.original, work);
  try {
    validate_positions(positions, work);
    Arrangement arranged = arrange(positions, triangles.faces, work);
    input.original = in_order(input.original, arranged.vertices, work);
    input.original_face = std::move(arranged.faces);
    positions = read_positions(mesh, input.original, work);
    input.disk = build_disk(std::move(positions), std::move(triangles.faces), work);
  } catch (const Error& error) {
    if (error.element().kind != ElementKind::kNothing) {
      fail_in_input_numbers(mesh, input, read_positions(mesh, input.original, work), work);
    }
    throw;
  }
  return input;
}

InputDisk read_topology(const beltrami_mesh& mesh, const Work& work) {
  InputTriangles triangles = read_triangles(mesh, work);
  InputDisk input;
  input.original = std::move(triangles.original);
  const std::vector<Vec3> positions(input.original.size(), Vec3::Zero());
  try {
    input.disk = build_disk(positions, std::move(triangles.faces), work);
  } catch (const Error& error) {
    const bool renumbered = input.original.size() != mesh.vertex_count;
    if (renumbered && error.element().kind != ElementKind::kNothing) {
      fail_in_input_numbers(mesh, input, positions, work);
    }
    throw;
  }
  return input;
}

}  // namespace beltrami
