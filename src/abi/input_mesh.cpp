#include "abi/input_mesh.h"

#include <utility>

#include "abi/buffers.h"
#include "base/error.h"
#include "base/parallel.h"
#include "base/types.h"
#include "mesh/locality.h"

namespace beltrami {
namespace {

/// Builds the disk from the faces as the input numbers them, only to fail: it meets a defect that
/// the renumbered mesh has too, and names it by the input's numbers. Costs a second pass over an
/// invalid mesh and saves rewriting sentences.
void fail_in_input_numbers(const beltrami_mesh& mesh, const InputDisk& input,
                           const std::vector<Vec3>& used_positions) {
  std::vector<Vec3> positions(mesh.vertex_count, Vec3::Zero());
  for (std::size_t i = 0; i < used_positions.size(); ++i) {
    positions[static_cast<std::size_t>(input.original[i])] = used_positions[i];
  }
  build_disk(std::move(positions), read_faces(mesh));
}

/// Calls body(i) for i in [0, count), side by side.
template <class Body>
void for_each(int threads, std::size_t count, const Body& body) {
  constexpr std::int64_t kGrain = 16384;
  parallel_for(threads, static_cast<std::int64_t>(count), kGrain,
               [&](std::int64_t begin, std::int64_t end) {
                 for (std::int64_t i = begin; i < end; ++i) body(static_cast<std::size_t>(i));
               });
}

/// The items of `order`, one after the other.
template <class Item>
std::vector<Item> arranged(const std::vector<Item>& items, const std::vector<Index>& order,
                           int threads) {
  std::vector<Item> result;
  parallel_assign(threads, result, order.size());
  for_each(threads, order.size(), [&](std::size_t i) { result[i] = items[order[i]]; });
  return result;
}

/// Renumbers vertices and faces by where they are. Precondition: finite positions.
void arrange(const std::vector<Vec3>& positions, int threads, InputDisk& input,
             std::vector<Triangle>& faces) {
  const std::vector<Index> order = along_hilbert_curve(positions, threads);
  std::vector<Index> place(order.size());
  for_each(threads, order.size(), [&](std::size_t i) { place[order[i]] = static_cast<Index>(i); });
  for_each(threads, faces.size(), [&](std::size_t f) {
    for (Index& v : faces[f]) v = place[v];
  });
  input.original = arranged(input.original, order, threads);
  input.original_face = by_least_vertex(size_of(order), faces, threads);
  faces = arranged(faces, input.original_face, threads);
}

}  // namespace

InputTriangles read_triangles(const beltrami_mesh& mesh, int threads) {
  InputTriangles triangles;
  triangles.faces = read_faces(mesh, threads);
  triangles.original =
      drop_unreferenced(static_cast<Index>(mesh.vertex_count), triangles.faces, threads);
  return triangles;
}

InputDisk read_disk(const beltrami_mesh& mesh, int threads) {
  InputTriangles triangles = read_triangles(mesh, threads);
  InputDisk input;
  input.original = std::move(triangles.original);
  std::vector<Vec3> positions = read_positions(mesh, input.original, threads);
  try {
    validate_indices(size_of(positions), triangles.faces, threads);
    validate_positions(positions, threads);
    arrange(positions, threads, input, triangles.faces);
    positions = read_positions(mesh, input.original, threads);
    input.disk = build_disk(std::move(positions), std::move(triangles.faces), threads);
  } catch (const Error& error) {
    if (error.element().kind != BELTRAMI_ELEMENT_NONE) {
      fail_in_input_numbers(mesh, input, read_positions(mesh, input.original));
    }
    throw;
  }
  return input;
}

InputDisk read_topology(const beltrami_mesh& mesh) {
  InputTriangles triangles = read_triangles(mesh);
  InputDisk input;
  input.original = std::move(triangles.original);
  const std::vector<Vec3> positions(input.original.size(), Vec3::Zero());
  try {
    input.disk = build_disk(positions, std::move(triangles.faces));
  } catch (const Error& error) {
    const bool renumbered = input.original.size() != mesh.vertex_count;
    if (renumbered && error.element().kind != BELTRAMI_ELEMENT_NONE) {
      fail_in_input_numbers(mesh, input, positions);
    }
    throw;
  }
  return input;
}

}  // namespace beltrami
