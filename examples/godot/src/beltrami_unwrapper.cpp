#include "beltrami_unwrapper.h"

#include <beltrami/beltrami.hpp>
#include <cstdint>
#include <godot_cpp/classes/mesh.hpp>
#include <godot_cpp/core/class_db.hpp>
#include <godot_cpp/variant/packed_int32_array.hpp>
#include <godot_cpp/variant/packed_vector2_array.hpp>
#include <godot_cpp/variant/packed_vector3_array.hpp>
#include <utility>
#include <vector>

using namespace godot;

namespace beltrami_godot {
namespace {

/// A surface of a mesh as the library reads it. Faces of Godot run clockwise, so two corners of
/// each change places.
struct Part {
  Array arrays;
  PackedVector3Array positions;
  std::vector<std::uint32_t> corners;

  beltrami_surface view() const {
    beltrami_surface surface{};
    surface.struct_size = sizeof surface;
    surface.vertex_count = static_cast<std::uint64_t>(positions.size());
    surface.face_count = corners.size() / 3;
    const auto scalar = sizeof(real_t) == 4 ? BELTRAMI_F32 : BELTRAMI_F64;
    surface.positions = {positions.ptr(), sizeof(Vector3), scalar, 0};
    surface.indices = {corners.data(), 0, BELTRAMI_U32, 0};
    return surface;
  }
};

Part part_of(const Array& arrays) {
  Part part;
  part.arrays = arrays;
  part.positions = arrays[Mesh::ARRAY_VERTEX];
  const PackedInt32Array indices = arrays[Mesh::ARRAY_INDEX];
  const std::int64_t count = indices.is_empty() ? part.positions.size() : indices.size();
  for (std::int64_t c = 0; c + 2 < count; c += 3) {
    for (const std::int64_t corner : {c, c + 2, c + 1}) {
      part.corners.push_back(indices.is_empty() ? static_cast<std::uint32_t>(corner)
                                                : static_cast<std::uint32_t>(indices[corner]));
    }
  }
  return part;
}

/// The items of an array, `width` for each vertex, at the vertices that UV vertices are copies of.
template <class Packed>
Variant split(const Packed& array, const std::vector<std::uint32_t>& origins,
              std::int64_t vertices) {
  const std::int64_t width = vertices > 0 ? array.size() / vertices : 0;
  Packed made;
  made.resize(width * static_cast<std::int64_t>(origins.size()));
  for (std::size_t i = 0; i < origins.size(); ++i) {
    for (std::int64_t k = 0; k < width; ++k) {
      made.set(static_cast<std::int64_t>(i) * width + k,
               array[static_cast<std::int64_t>(origins[i]) * width + k]);
    }
  }
  return made;
}

Variant split(const Variant& array, const std::vector<std::uint32_t>& origins,
              std::int64_t vertices) {
  switch (array.get_type()) {
    case Variant::PACKED_VECTOR3_ARRAY:
      return split(PackedVector3Array(array), origins, vertices);
    case Variant::PACKED_VECTOR2_ARRAY:
      return split(PackedVector2Array(array), origins, vertices);
    case Variant::PACKED_COLOR_ARRAY:
      return split(PackedColorArray(array), origins, vertices);
    case Variant::PACKED_FLOAT32_ARRAY:
      return split(PackedFloat32Array(array), origins, vertices);
    case Variant::PACKED_FLOAT64_ARRAY:
      return split(PackedFloat64Array(array), origins, vertices);
    case Variant::PACKED_INT32_ARRAY:
      return split(PackedInt32Array(array), origins, vertices);
    case Variant::PACKED_BYTE_ARRAY:
      return split(PackedByteArray(array), origins, vertices);
    default:
      return array;  // not there
  }
}

/// What is read of an atlas, of all surfaces one after another.
struct Uvs {
  std::vector<float> uvs;
  std::vector<std::uint32_t> origins, uv_of_corner;
};

Uvs read(beltrami_context* context, const beltrami_atlas& atlas) {
  Uvs read{std::vector<float>(2 * atlas.uv_vertices), std::vector<std::uint32_t>(atlas.uv_vertices),
           std::vector<std::uint32_t>(atlas.corners)};
  beltrami_get_uv_vertices(context, read.uvs.data(), BELTRAMI_F32, 0);
  beltrami_get_uv_vertex_origins(context, read.origins.data(), BELTRAMI_U32, 0);
  beltrami_get_corner_uv_vertices(context, read.uv_of_corner.data(), BELTRAMI_U32, 0);
  return read;
}

/// Where a surface begins in these.
struct Start {
  std::size_t uv = 0, vertex = 0, corner = 0;
};

/// The arrays of a surface with UVs; moves on to the next one.
Array with_uvs(const Part& part, const Uvs& all, int channel, Start& start) {
  const std::size_t vertices = static_cast<std::size_t>(part.positions.size());
  std::vector<std::uint32_t> origins;
  std::size_t end = start.uv;
  while (end < all.origins.size() && all.origins[end] < start.vertex + vertices) {
    origins.push_back(static_cast<std::uint32_t>(all.origins[end++] - start.vertex));
  }
  Array made = part.arrays.duplicate();
  for (int i = 0; i < Mesh::ARRAY_INDEX; ++i) {
    made[i] = split(part.arrays[i], origins, part.positions.size());
  }
  PackedVector2Array uvs;
  for (std::size_t i = start.uv; i < end; ++i) {  // v goes down from the top of a texture
    uvs.push_back({all.uvs[2 * i], 1 - all.uvs[2 * i + 1]});
  }
  PackedInt32Array indices;
  for (std::size_t c = 0; c < part.corners.size(); c += 3) {
    for (const std::size_t corner : {c, c + 2, c + 1}) {
      indices.push_back(
          static_cast<std::int32_t>(all.uv_of_corner[start.corner + corner] - start.uv));
    }
  }
  made[channel == BeltramiUnwrapper::UV2 ? Mesh::ARRAY_TEX_UV2 : Mesh::ARRAY_TEX_UV] = uvs;
  made[Mesh::ARRAY_INDEX] = indices;
  start = {end, start.vertex + vertices, start.corner + part.corners.size()};
  return made;
}

/// The sentence that says what is wrong with an option, or an empty one.
String apply(beltrami::Context& context, const Dictionary& options) {
  const Array names = options.keys();
  for (int i = 0; i < names.size(); ++i) {
    const CharString name = String(names[i]).utf8();
    const Variant value = options[names[i]];
    const CharString text = String(value).utf8();
    const bool is_text = value.get_type() == Variant::STRING;
    const beltrami::OptionValue number = value.get_type() == Variant::FLOAT
                                             ? beltrami::OptionValue(double(value))
                                             : beltrami::OptionValue(int64_t(value));
    const auto done = is_text ? context.try_set(name.get_data(), text.get_data())
                              : context.try_set(name.get_data(), number);
    if (!done) return String(name.get_data()) + ": " + done.error().what();
  }
  return {};
}

}  // namespace

Ref<ArrayMesh> BeltramiUnwrapper::fail(const String& why) {
  error_ = why;
  injective_ = false;
  return {};
}

Ref<ArrayMesh> BeltramiUnwrapper::unwrap(const Ref<ArrayMesh>& mesh, int channel,
                                         const Dictionary& options) {
  if (mesh.is_null()) return fail("there is no mesh");
  std::vector<Part> parts;
  for (int s = 0; s < mesh->get_surface_count(); ++s) {
    if (mesh->surface_get_primitive_type(s) != Mesh::PRIMITIVE_TRIANGLES) {
      return fail("a surface is not of triangles");
    }
    parts.push_back(part_of(mesh->surface_get_arrays(s)));
  }
  auto context = beltrami::Context::create();
  if (!context) return fail(context.error().what());
  const String odd = apply(*context, options);
  if (!odd.is_empty()) return fail(odd);
  std::vector<beltrami_surface> views;
  std::vector<const beltrami_surface*> surfaces;
  for (const Part& part : parts) views.push_back(part.view());
  for (const beltrami_surface& view : views) surfaces.push_back(&view);
  const beltrami_status status =
      beltrami_unwrap_surfaces(context->c(), surfaces.data(), surfaces.size(), nullptr, nullptr);
  if (status < 0) return fail(beltrami_error_message(context->c()));
  beltrami_atlas atlas{};
  atlas.struct_size = sizeof atlas;
  beltrami_atlas_certificate certificate{};
  certificate.struct_size = sizeof certificate;
  beltrami_get_atlas(context->c(), &atlas);
  beltrami_get_atlas_certificate(context->c(), BELTRAMI_F32, &certificate);
  const Uvs uvs = read(context->c(), atlas);
  Ref<ArrayMesh> made;
  made.instantiate();
  Start start;
  for (std::size_t s = 0; s < parts.size(); ++s) {
    const int surface = static_cast<int>(s);
    made->add_surface_from_arrays(Mesh::PRIMITIVE_TRIANGLES,
                                  with_uvs(parts[s], uvs, channel, start));
    made->surface_set_material(surface, mesh->surface_get_material(surface));
    made->surface_set_name(surface, mesh->surface_get_name(surface));
  }
  injective_ = certificate.injective == 1;
  error_ = String();
  return made;
}

void BeltramiUnwrapper::_bind_methods() {
  ClassDB::bind_method(D_METHOD("unwrap", "mesh", "channel", "options"), &BeltramiUnwrapper::unwrap,
                       DEFVAL(UV), DEFVAL(Dictionary()));
  ClassDB::bind_method(D_METHOD("is_injective"), &BeltramiUnwrapper::is_injective);
  ClassDB::bind_method(D_METHOD("get_error"), &BeltramiUnwrapper::get_error);
  BIND_ENUM_CONSTANT(UV);
  BIND_ENUM_CONSTANT(UV2);
}

}  // namespace beltrami_godot
