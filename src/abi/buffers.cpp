#include "abi/buffers.h"

#include <cstdint>
#include <limits>
#include <string>

#include "base/parallel.h"

namespace beltrami {
namespace {

constexpr std::uint64_t kMaxVertices = std::numeric_limits<Index>::max();
constexpr std::uint64_t kMaxFaces = 700'000'000;  // 3 half-edges each fit an Index
constexpr std::int64_t kGrain = 16384;

[[noreturn]] void refuse(const std::string& message) {
  throw Error(Fault::kInvalidArgument, message);
}

std::size_t element_size(std::int32_t type) {
  if (type == BELTRAMI_U16) return 2;
  return type == BELTRAMI_F32 || type == BELTRAMI_U32 ? 4 : 8;
}

/// The stride in bytes, 0 resolved. Throws if items overlap or leave the address space.
std::size_t checked_stride(std::uint64_t stride, std::int32_t type, int components,
                           std::uint64_t count, const char* what) {
  const std::size_t item = element_size(type) * static_cast<std::size_t>(components);
  if (stride == 0) stride = item;
  if (stride < item) {
    refuse("the stride of the " + std::string(what) + ", " + std::to_string(stride) +
           " bytes, is less than an item's " + std::to_string(item));
  }
  if (count > 0 && stride > static_cast<std::uint64_t>(PTRDIFF_MAX) / count) {
    refuse("the stride of the " + std::string(what) + ", " + std::to_string(stride) +
           " bytes, is more than memory can hold: is it in bytes, and not negative?");
  }
  return static_cast<std::size_t>(stride);
}

[[noreturn]] void refuse_type(std::int32_t type, const char* what, const char* instead) {
  refuse("the type of the " + std::string(what) + " is " + std::to_string(type) + ": give " +
         instead);
}

void require_real(std::int32_t type, const char* what) {
  if (type != BELTRAMI_F32 && type != BELTRAMI_F64) {
    refuse_type(type, what, "BELTRAMI_F32 or BELTRAMI_F64");
  }
}

void require_integer(std::int32_t type, const char* what) {
  if (type != BELTRAMI_U16 && type != BELTRAMI_U32 && type != BELTRAMI_U64) {
    refuse_type(type, what, "BELTRAMI_U32, BELTRAMI_U64 or BELTRAMI_U16");
  }
}

/// Nothing needs none.
void require_memory(const void* out, std::uint64_t count) {
  if (out == nullptr && count > 0) refuse("the memory to write to is NULL");
}

/// Throws Error INVALID_ARGUMENT for types that a buffer may not have.
using RequireType = void (*)(std::int32_t type, const char* what);

/// Items of `components` elements, checked once and then read without checks.
class Reader {
 public:
  Reader(const beltrami_buffer& buffer, RequireType require_type, std::uint64_t count,
         int components, const char* what)
      : data_(static_cast<const unsigned char*>(buffer.data)) {
    // First, since a buffer that was left out has no type either.
    if (data_ == nullptr) refuse("the data of the " + std::string(what) + " is NULL");
    require_type(buffer.type, what);
    if (buffer.reserved != 0) {
      refuse("the field `reserved` of the " + std::string(what) + " is not 0");
    }
    stride_ = checked_stride(buffer.stride, buffer.type, components, count, what);
  }

  /// memcpy, since the caller's memory need not be aligned.
  template <class Scalar>
  Scalar read(std::size_t item, int component) const {
    Scalar value;
    std::memcpy(&value, data_ + item * stride_ + static_cast<std::size_t>(component) * sizeof value,
                sizeof value);
    return value;
  }

 private:
  const unsigned char* data_;
  std::size_t stride_;
};

/// Calls `use` with a value of the integers' type, which has passed require_integer.
template <class Use>
auto with_integer(std::int32_t type, const Use& use) {
  if (type == BELTRAMI_U16) return use(std::uint16_t{});
  return type == BELTRAMI_U32 ? use(std::uint32_t{}) : use(std::uint64_t{});
}

/// Throws Error INVALID_ARGUMENT where the type has no number for `value`: all bits set is none,
/// and stands for kNone.
void require_room_in(std::int32_t type, Index value) {
  constexpr Index kAllBits = std::numeric_limits<std::uint16_t>::max();
  if (type != BELTRAMI_U16 || value < kAllBits) return;
  refuse("the number " + std::to_string(value) +
         " is to be written, and BELTRAMI_U16 holds those below 65535: give BELTRAMI_U32");
}

/// Component `k` of an item; all bits set for kNone.
void write_integer(unsigned char* item, std::size_t k, Index value, std::int32_t type) {
  with_integer(type, [&](auto integer) {
    integer = static_cast<decltype(integer)>(std::int64_t{value});
    std::memcpy(item + k * sizeof integer, &integer, sizeof integer);
  });
}

template <class Integer>
std::vector<Triangle> read_faces_as(const Reader& reader, std::uint64_t count,
                                    std::uint64_t vertex_count, const Work& work) {
  std::vector<Triangle> faces;
  parallel_assign(work, faces, count);
  const auto items = static_cast<std::int64_t>(count);
  const auto in_range = [&](std::int64_t f, int k) {
    return reader.read<Integer>(static_cast<std::size_t>(f), k) < vertex_count;
  };
  const auto outside = parallel_find(work, items, kGrain, [&](std::int64_t f) {
    for (int k = 0; k < 3; ++k) {
      faces[f][k] = static_cast<Index>(reader.read<Integer>(static_cast<std::size_t>(f), k));
    }
    return !in_range(f, 0) || !in_range(f, 1) || !in_range(f, 2);
  });
  if (outside == items) return faces;
  const auto f = static_cast<std::size_t>(outside);
  int k = 0;
  while (in_range(outside, k)) ++k;
  throw Error(Fault::kIndexOutOfRange,
              "face " + std::to_string(f) + " names vertex " +
                  std::to_string(reader.read<Integer>(f, k)) + ", but there are " +
                  std::to_string(vertex_count) + " vertices: indices count from 0",
              Element::face(f));
}

template <class Scalar, class Vector>
std::vector<Vector> read_points(const Reader& reader, const std::vector<Index>& original,
                                const Work& work) {
  std::vector<Vector> points;
  points.reserve(original.size());
  touch_memory(work, points.data(), original.size() * sizeof(Vector));
  points.resize(original.size());
  parallel_for(work, size_of(original), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
      for (int k = 0; k < Vector::RowsAtCompileTime; ++k) {
        points[i][k] = reader.read<Scalar>(static_cast<std::size_t>(original[i]), k);
      }
    }
  });
  return points;
}

/// All elements of `count` items, one after the other.
template <class Scalar, class Value>
std::vector<Value> read_elements(const Reader& reader, std::uint64_t count, int components,
                                 const Work& work) {
  std::vector<Value> values;
  parallel_assign(work, values, count * static_cast<std::uint64_t>(components));
  parallel_for(work, static_cast<std::int64_t>(count), kGrain,
               [&](std::int64_t begin, std::int64_t end) {
                 auto* value = values.data() + begin * components;
                 for (std::int64_t i = begin; i < end; ++i) {
                   for (int k = 0; k < components; ++k) {
                     *value++ = reader.read<Scalar>(static_cast<std::size_t>(i), k);
                   }
                 }
               });
  return values;
}

}  // namespace

beltrami_mesh read_mesh_header(const beltrami_mesh* theirs) {
  beltrami_mesh mesh = read_sized(theirs, "the mesh");
  if (mesh.struct_size < sizeof mesh) mesh.cancel = nullptr;  // half a pointer is none
  if (mesh.flags != 0) refuse("the field `flags` of the mesh is not 0");
  if (mesh.vertex_count == 0 || mesh.face_count == 0) {
    throw Error(Fault::kEmpty, "the mesh has no vertices or no faces: there is nothing to do");
  }
  if (mesh.vertex_count > kMaxVertices || mesh.face_count > kMaxFaces) {
    refuse("the mesh has " + std::to_string(mesh.vertex_count) + " vertices and " +
           std::to_string(mesh.face_count) + " faces: at most " + std::to_string(kMaxVertices) +
           " and " + std::to_string(kMaxFaces) + " are possible");
  }
  return mesh;
}

std::vector<Triangle> read_faces(const beltrami_mesh& mesh, const Work& work) {
  const Reader reader(mesh.indices, require_integer, mesh.face_count, 3, "indices");
  return with_integer(mesh.indices.type, [&](auto integer) {
    return read_faces_as<decltype(integer)>(reader, mesh.face_count, mesh.vertex_count, work);
  });
}

std::vector<Vec3> read_positions(const beltrami_mesh& mesh, const std::vector<Index>& original,
                                 const Work& work) {
  const Reader reader(mesh.positions, require_real, mesh.vertex_count, 3, "positions");
  return mesh.positions.type == BELTRAMI_F32 ? read_points<float, Vec3>(reader, original, work)
                                             : read_points<double, Vec3>(reader, original, work);
}

std::vector<Vec2> read_uvs(const beltrami_buffer* uvs, std::uint64_t vertex_count,
                           const std::vector<Index>& original, const Work& work) {
  if (uvs == nullptr) refuse("uvs is NULL");
  const Reader reader(*uvs, require_real, vertex_count, 2, "UVs");
  std::vector<Vec2> points = uvs->type == BELTRAMI_F32
                                 ? read_points<float, Vec2>(reader, original, work)
                                 : read_points<double, Vec2>(reader, original, work);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].allFinite()) {
      const auto vertex = static_cast<std::uint64_t>(original[i]);
      throw Error(Fault::kNonFinite,
                  "the UV of vertex " + std::to_string(vertex) + " is infinite or not a number",
                  Element::vertex(vertex));
    }
  }
  return points;
}

std::uint64_t all_bits_of(std::int32_t type) {
  return with_integer(type, [](auto integer) -> std::uint64_t {
    return std::numeric_limits<decltype(integer)>::max();
  });
}

std::vector<std::uint64_t> read_integers(const beltrami_buffer& buffer, std::uint64_t count,
                                         int components, const char* what, const Work& work) {
  const Reader reader(buffer, require_integer, count, components, what);
  return with_integer(buffer.type, [&](auto integer) {
    return read_elements<decltype(integer), std::uint64_t>(reader, count, components, work);
  });
}

std::vector<double> read_numbers(const beltrami_buffer& buffer, std::uint64_t count, int components,
                                 const char* what, const Work& work) {
  const Reader reader(buffer, require_real, count, components, what);
  return buffer.type == BELTRAMI_F32
             ? read_elements<float, double>(reader, count, components, work)
             : read_elements<double, double>(reader, count, components, work);
}

void write_faces(const std::vector<Triangle>& faces, const std::vector<Index>& original,
                 const std::vector<Index>& original_face, void* out, std::int32_t type,
                 std::uint64_t stride) {
  require_memory(out, faces.size());
  require_integer(type, "output");
  const std::size_t step = checked_stride(stride, type, 3, faces.size(), "output");
  for (const Index vertex : original) require_room_in(type, vertex);
  for (std::size_t f = 0; f < faces.size(); ++f) {
    auto* item =
        static_cast<unsigned char*>(out) + step * static_cast<std::size_t>(original_face[f]);
    for (std::size_t k = 0; k < 3; ++k) {
      write_integer(item, k, original[static_cast<std::size_t>(faces[f][k])], type);
    }
  }
}

void write_integers(const std::vector<Index>& values, int components, void* out, std::int32_t type,
                    std::uint64_t stride) {
  require_memory(out, values.size());
  require_integer(type, "output");
  const auto per_item = static_cast<std::size_t>(components);
  const std::size_t step =
      checked_stride(stride, type, components, values.size() / per_item, "output");
  for (const Index value : values) require_room_in(type, value);
  for (std::size_t i = 0; i < values.size(); ++i) {
    auto* item = static_cast<unsigned char*>(out) + step * (i / per_item);
    write_integer(item, i % per_item, values[i], type);
  }
}

Writer::Writer(void* out, std::int32_t type, std::uint64_t stride, std::uint64_t count,
               int components)
    : out_(static_cast<unsigned char*>(out)),
      components_(components),
      single_(type == BELTRAMI_F32) {
  require_memory(out, count);
  require_real(type, "output");
  stride_ = checked_stride(stride, type, components, count, "output");
}

void Writer::write(std::size_t index, const double* components) {
  unsigned char* item = out_ + index * stride_;
  for (int k = 0; k < components_; ++k) {
    if (single_) {
      const double greatest = std::numeric_limits<float>::max();
      const auto value = static_cast<float>(std::clamp(components[k], -greatest, greatest));
      std::memcpy(item, &value, sizeof value);
      item += sizeof value;
    } else {
      std::memcpy(item, &components[k], sizeof(double));
      item += sizeof(double);
    }
  }
}

}  // namespace beltrami
