#include "abi/input_mesh.h"

#include <utility>

#include "abi/buffers.h"
#include "base/error.h"
#include "base/parallel.h"
#include "base/types.h"
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

/// Calls body(i) for i in [0, count), side by side.
template <class Body>
void for_each(const Work& work, std::size_t count, const Body& body) {
  constexpr std::int64_t kGrain = 16384;
  parallel_for(work, static_cast<std::int64_t>(count), kGrain,
               [&](std::int64_t begin, std::int64_t end) {
                 for (std::int64_t i = begin; i < end; ++i) body(static_cast<std::size_t>(i));
               });
}

/// The items of `order`, one after the other.
template <class Item>
std::vector<Item> arranged(const std::vector<Item>& items, const std::vector<Index>& order,
                           const Work& work) {
  std::vector<Item> result;
  parallel_assign(work, result, order.size());
  for_each(work, order.size(), [&](std::size_t i) { result[i] = items[order[i]]; });
  return result;
}

/// Renumbers vertices and faces by where they are. Precondition: finite positions.
void arrange(const std::vector<Vec3>& positions, InputDisk& input, std::vector<Triangle>& faces,
             const Work& work) {
  const std::vector<Index> order = along_hilbert_curve(positions, work);
  std::vector<Index> place(order.size());
  for_each(work, order.size(), [&](std::size_t i) { place[order[i]] = static_cast<Index>(i); });
  for_each(work, faces.size(), [&](std::size_t f) {
    for (Index& v : faces[f]) v = place[v];
  });
  input.original = arranged(input.original, order, work);
  input.original_face = by_least_vertex(size_of(order), faces, work);
  faces = arranged(faces, input.original_face, work);
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
    validate_indices(size_of(positions), triangles.faces, RepeatedVertices::kRefused, work);
    validate_positions(positions, work);
    arrange(positions, input, triangles.faces, work);
    positions = read_positions(mesh, input.original, work);
    input.disk = build_disk(std::move(positions), std::move(triangles.faces), work);
  } catch (const Error& error) {
    if (error.element().kind != BELTRAMI_ELEMENT_NONE) {
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
    if (renumbered && error.element().kind != BELTRAMI_ELEMENT_NONE) {
      fail_in_input_numbers(mesh, input, positions, work);
    }
    throw;
  }
  return input;
}

}  // namespace beltrami
