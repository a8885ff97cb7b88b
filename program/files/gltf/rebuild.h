// Accessors and buffers of a document that is edited.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "files/gltf/document.h"
#include "files/gltf/item.h"

namespace beltrami::cli::gltf {

enum class Target : std::uint16_t { kVertices = 34962, kIndices = 34963 };

/// An accessor with a buffer view of its own.
struct NewAccessor {
  Json json;             ///< without bufferView and byteOffset
  std::string bytes;     ///< empty for an accessor of zeros, which needs none
  std::uint64_t stride;  ///< from element to element; 0 where they stand side by side
  Target target;
};

/// An image in the buffer.
struct NewImage {
  std::vector<std::uint64_t> places;  ///< the entries of `images` that are it
  const std::string* bytes = nullptr;
};

/// The one buffer of an edited document.
struct Buffer {
  std::vector<std::string> pieces;  ///< one after another
  std::uint64_t size = 0;
};

/// Gives `json`, an edited copy of the document's, the accessors `added`: its primitives refer to
/// added[k] by the old count of accessors plus k. Numbers of accessors and buffer views that stay
/// do not change, since extensions may have them; the places of those that nothing refers to any
/// more are taken. All that is still used is in one buffer, bytes of views that overlap once.
Buffer rebuild(const Document& document, Json& json, std::vector<NewAccessor> added,
               const std::vector<NewImage>& images);

}  // namespace beltrami::cli::gltf
