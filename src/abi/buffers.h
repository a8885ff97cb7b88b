// The caller's memory: strided items of any alignment, and structs that carry their own size.
#pragma once

#include <beltrami/beltrami.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <type_traits>
#include <vector>

#include "base/error.h"
#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"

namespace beltrami {

/// Bytes of a public struct in its first release: the least that any caller was compiled with.
/// A field that is added later does not change these numbers.
template <class Struct>
inline constexpr std::size_t kFirstSize = 0;
#define BELTRAMI_FIRST_SIZE(type, last) \
  template <>                           \
  inline constexpr std::size_t kFirstSize<type> = (offsetof(type, last) + sizeof(type::last))
BELTRAMI_FIRST_SIZE(beltrami_allocator, release);
BELTRAMI_FIRST_SIZE(beltrami_option_info, summary);
BELTRAMI_FIRST_SIZE(beltrami_mesh, indices);
BELTRAMI_FIRST_SIZE(beltrami_certificate, reserved);
BELTRAMI_FIRST_SIZE(beltrami_energy, left_out);
BELTRAMI_FIRST_SIZE(beltrami_result, coarse_energy);
BELTRAMI_FIRST_SIZE(beltrami_stage, name);
BELTRAMI_FIRST_SIZE(beltrami_surface, cancel);
BELTRAMI_FIRST_SIZE(beltrami_atlas, peak_memory_bytes);
BELTRAMI_FIRST_SIZE(beltrami_chart, box);
BELTRAMI_FIRST_SIZE(beltrami_atlas_certificate, reserved);
BELTRAMI_FIRST_SIZE(beltrami_uv_mesh, cancel);
BELTRAMI_FIRST_SIZE(beltrami_packing, cpu_seconds);
BELTRAMI_FIRST_SIZE(beltrami_bake_job, cancel);
BELTRAMI_FIRST_SIZE(beltrami_baked, cpu_seconds);
BELTRAMI_FIRST_SIZE(beltrami_session, cpu_seconds);
BELTRAMI_FIRST_SIZE(beltrami_session_chart, scale);
#undef BELTRAMI_FIRST_SIZE

/// The struct_size of the caller's struct; throws Error INVALID_ARGUMENT if it is null or too
/// small.
template <class Struct>
std::uint32_t require_sized(const Struct* theirs, const char* what) {
  static_assert(kFirstSize<Struct> > 0 && std::is_trivially_copyable_v<Struct>);
  if (theirs == nullptr) {
    throw Error(Fault::kInvalidArgument, std::string(what) + " is NULL");
  }
  std::uint32_t size = 0;
  std::memcpy(&size, theirs, sizeof size);
  if (size < kFirstSize<Struct>) {
    throw Error(Fault::kInvalidArgument, std::string("struct_size of ") + what + " is " +
                                             std::to_string(size) +
                                             ": set it to sizeof the struct");
  }
  return size;
}

/// Copies what the caller's size covers; fields that it does not know are zero.
template <class Struct>
Struct read_sized(const Struct* theirs, const char* what) {
  const std::uint32_t size = require_sized(theirs, what);
  Struct ours{};
  std::memcpy(&ours, theirs, std::min<std::size_t>(size, sizeof ours));
  return ours;
}

/// Writes what the caller's size covers and leaves that size alone.
/// Precondition: `theirs` has passed require_sized.
template <class Struct>
void write_sized(Struct* theirs, Struct ours) {
  std::memcpy(&ours.struct_size, theirs, sizeof ours.struct_size);
  std::memcpy(static_cast<void*>(theirs), &ours,
              std::min<std::size_t>(ours.struct_size, sizeof ours));
}

/// The caller's mesh with its sizes checked: counts within the limits, flags 0.
/// Throws Error INVALID_ARGUMENT or EMPTY.
beltrami_mesh read_mesh_header(const beltrami_mesh* mesh);

/// Reads the faces. Throws Error INVALID_ARGUMENT, or INDEX_OUT_OF_RANGE with the face.
std::vector<Triangle> read_faces(const beltrami_mesh& mesh, const Work& work);

/// Reads positions: item `original[i]` for each i. Throws Error INVALID_ARGUMENT.
std::vector<Vec3> read_positions(const beltrami_mesh& mesh, const std::vector<Index>& original,
                                 const Work& work);

/// Reads UVs: item `original[i]` for each i, of `vertex_count` in the buffer.
/// Throws Error INVALID_ARGUMENT, or NON_FINITE with the vertex.
std::vector<Vec2> read_uvs(const beltrami_buffer* uvs, std::uint64_t vertex_count,
                           const std::vector<Index>& original, const Work& work);

/// What stands for none among integers of a type: all bits set.
std::uint64_t all_bits_of(std::int32_t type);

/// Reads `count` items of integers, one after the other. Throws Error INVALID_ARGUMENT.
std::vector<std::uint64_t> read_integers(const beltrami_buffer& buffer, std::uint64_t count,
                                         int components, const char* what, const Work& work);

/// Reads `count` items of F32 or F64 elements, one after the other. Throws Error INVALID_ARGUMENT.
std::vector<double> read_numbers(const beltrami_buffer& buffer, std::uint64_t count, int components,
                                 const char* what, const Work& work);

/// Writes faces as items of 3 elements of `type` U32 or U64, `stride` bytes apart (0: packed): face
/// i as item `original_face[i]`, its vertices as `original` numbers them. Throws Error
/// INVALID_ARGUMENT.
void write_faces(const std::vector<Triangle>& faces, const std::vector<Index>& original,
                 const std::vector<Index>& original_face, void* out, std::int32_t type,
                 std::uint64_t stride);

/// Writes integers as items of `components` elements of `type` U32 or U64, `stride` bytes apart (0:
/// packed); kNone has all bits set. Throws Error INVALID_ARGUMENT.
void write_integers(const std::vector<Index>& values, int components, void* out, std::int32_t type,
                    std::uint64_t stride);

/// A strided array in the caller's memory to write to.
class Writer {
 public:
  /// `count` items of `components` elements of `type` F32 or F64, `stride` bytes apart (0: packed).
  /// Throws Error INVALID_ARGUMENT.
  Writer(void* out, std::int32_t type, std::uint64_t stride, std::uint64_t count, int components);

  /// Writes item `index`; F32 is rounded to nearest.
  void write(std::size_t index, const double* components);

 private:
  unsigned char* out_;
  std::size_t stride_;
  int components_;
  bool single_;
};

}  // namespace beltrami
