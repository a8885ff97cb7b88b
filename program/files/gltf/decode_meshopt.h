// Bytes that EXT_meshopt_compression has made small.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace beltrami::cli::gltf {

/// Whether this build has the decoder: it is meshoptimizer's.
bool reads_meshopt();

/// How a view is compressed, in the words of the extension.
struct MeshoptView {
  std::string mode, filter;
  std::uint64_t count = 0, stride = 0;  ///< elements, and bytes of each
};

/// Decodes `packed` into the count * stride bytes of `plain`. Returns false for what the extension
/// does not allow, and where the bytes are damaged.
bool decode_meshopt(const MeshoptView& view, std::string_view packed, std::string& plain);

}  // namespace beltrami::cli::gltf
