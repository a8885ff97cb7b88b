// What a small host would write round the C ABI.
#pragma once

#include <beltrami/beltrami.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "base/vectors.h"
#include "support/meshes.h"

namespace beltrami::host {

struct Destroy {
  void operator()(beltrami_context* context) const { beltrami_destroy(context); }
};
using Context = std::unique_ptr<beltrami_context, Destroy>;

/// Of contexts that tests create; null: the C library's.
inline const beltrami_allocator* memory = nullptr;

inline Context create() {
  beltrami_context* context = nullptr;
  EXPECT_EQ(beltrami_create_with(memory, &context), BELTRAMI_OK);
  return Context(context);
}

/// Views of a triangle list, which must outlive them.
inline beltrami_mesh view(const meshes::TriangleList& mesh) {
  beltrami_mesh view{};
  view.struct_size = sizeof view;
  view.vertex_count = mesh.positions.size();
  view.face_count = mesh.faces.size();
  view.positions = {mesh.positions.data(), 0, BELTRAMI_F64, 0};
  view.indices = {mesh.faces.data(), 0, BELTRAMI_U32, 0};
  return view;
}

inline beltrami_buffer view(const std::vector<std::array<double, 2>>& uvs) {
  return {uvs.data(), 0, BELTRAMI_F64, 0};
}
inline beltrami_buffer view(const std::vector<std::array<float, 2>>& uvs) {
  return {uvs.data(), 0, BELTRAMI_F32, 0};
}

template <class Struct>
Struct sized() {
  Struct value{};
  value.struct_size = sizeof value;
  return value;
}

/// Of triangles, which must outlive it.
inline beltrami_surface surface_view(const meshes::TriangleList& mesh) {
  auto surface = sized<beltrami_surface>();
  surface.vertex_count = mesh.positions.size();
  surface.face_count = mesh.faces.size();
  surface.positions = {mesh.positions.data(), 0, BELTRAMI_F64, 0};
  surface.indices = {mesh.faces.data(), 0, BELTRAMI_U32, 0};
  return surface;
}

/// Of polygons of any sizes, which must outlive it.
inline beltrami_surface polygon_view(const std::vector<Vec3>& positions,
                                     const std::vector<std::uint32_t>& corners,
                                     const std::vector<std::uint32_t>& sizes) {
  auto surface = sized<beltrami_surface>();
  surface.vertex_count = positions.size();
  surface.face_count = sizes.size();
  surface.corner_count = corners.size();
  surface.positions = {positions.data(), 0, BELTRAMI_F64, 0};
  surface.indices = {corners.data(), 0, BELTRAMI_U32, 0};
  surface.face_sizes = {sizes.data(), 0, BELTRAMI_U32, 0};
  return surface;
}

inline std::string message(const Context& context) {
  return beltrami_error_message(context.get());
}

inline beltrami_status set_mesh(const Context& context, const meshes::TriangleList& mesh) {
  const beltrami_mesh mesh_view = view(mesh);
  return beltrami_set_mesh(context.get(), &mesh_view);
}

/// Sets an integer or a choice.
inline void set_option(const Context& context, std::int32_t key, std::uint64_t value) {
  EXPECT_EQ(beltrami_set_int(context.get(), key, static_cast<std::int64_t>(value)), BELTRAMI_OK)
      << message(context);
}

/// The bytes that the next run is estimated to need.
inline std::uint64_t estimate(const Context& context) {
  std::uint64_t bytes = 0;
  EXPECT_EQ(beltrami_estimate_memory(context.get(), &bytes), BELTRAMI_OK) << message(context);
  return bytes;
}

/// A context with this mesh, set to the method that depends on the fewest stages.
inline Context loaded(const meshes::TriangleList& mesh) {
  Context context = create();
  EXPECT_EQ(beltrami_set_int(context.get(), BELTRAMI_OPTION_METHOD, BELTRAMI_METHOD_TUTTE),
            BELTRAMI_OK);
  EXPECT_EQ(set_mesh(context, mesh), BELTRAMI_OK) << message(context);
  return context;
}

/// A context with this mesh, set to go through all stages of the default method, with workers.
inline Context whole_pipeline(const meshes::TriangleList& mesh) {
  Context context = loaded(mesh);
  EXPECT_EQ(beltrami_set_int(context.get(), BELTRAMI_OPTION_METHOD, BELTRAMI_METHOD_BELTRAMI),
            BELTRAMI_OK);
  EXPECT_EQ(beltrami_set_int(context.get(), BELTRAMI_OPTION_COARSE_FACES, 200), BELTRAMI_OK);
  EXPECT_EQ(beltrami_set_int(context.get(), BELTRAMI_OPTION_THREADS, 3), BELTRAMI_OK);
  return context;
}

inline beltrami_status run(const Context& context) {
  return beltrami_run(context.get(), nullptr, nullptr);
}

inline std::vector<std::array<double, 2>> uvs(const Context& context, std::size_t vertices) {
  std::vector<std::array<double, 2>> uvs(vertices);
  EXPECT_EQ(beltrami_get_uvs(context.get(), uvs.data(), BELTRAMI_F64, 0), BELTRAMI_OK)
      << message(context);
  return uvs;
}

/// The vertices' x and y as UVs: injective for a flat mesh.
inline std::vector<std::array<double, 2>> flat_uvs(const meshes::TriangleList& mesh) {
  std::vector<std::array<double, 2>> uvs;
  for (const Vec3& p : mesh.positions) uvs.push_back({p.x(), p.y()});
  return uvs;
}

/// Whether two arrays hold the same bits.
template <class Item>
bool same_bits(const std::vector<Item>& a, const std::vector<Item>& b) {
  if (a.size() != b.size()) return false;
  return a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Item)) == 0;
}

}  // namespace beltrami::host
