// Meshes that KHR_draco_mesh_compression has made small.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "files/gltf/accessor.h"

namespace beltrami::cli::gltf {

/// Whether this build has the decoder: it is Draco's.
bool reads_draco();

/// An attribute, and how its values are wanted.
struct DracoAttribute {
  std::uint64_t id = 0;  ///< Draco's unique one
  Component component = Component::kF32;
  std::uint64_t width = 0;  ///< components of a value

  /// Bytes from one value to the next, as glTF has it for vertices: a multiple of four.
  std::uint64_t stride() const { return (width * size_of(component) + 3) / 4 * 4; }
};

/// The values of an attribute, and what they lie between.
struct DracoValues {
  std::string bytes;  ///< points * stride()
  std::array<double, 4> low{}, high{};
};

struct DracoMesh {
  std::uint64_t points = 0;
  std::vector<std::uint32_t> corners;  ///< three a triangle
  std::vector<DracoValues> values;     ///< per wanted attribute
};

/// Nothing where the bytes are damaged, or lack an attribute.
std::optional<DracoMesh> decode_draco(std::string_view packed,
                                      const std::vector<DracoAttribute>& wanted);

}  // namespace beltrami::cli::gltf
