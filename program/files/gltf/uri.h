// URIs of buffers and images: data in themselves, or the name of a file beside the document.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace beltrami::cli::gltf {

/// Whether the URI holds its data.
bool is_data(std::string_view uri);
/// The bytes that a data URI holds in base 64; nothing where it holds none, or not in base 64.
std::optional<std::string> decode_data(std::string_view uri);
/// A data URI of these bytes.
std::string encode_data(std::string_view bytes);

/// The relative path that the URI stands for; nothing for what is absolute or has a scheme.
std::optional<std::string> decode_path(std::string_view uri);
/// The URI of a file name.
std::string encode_path(std::string_view name);

}  // namespace beltrami::cli::gltf
