// A glTF file in memory: its JSON, and the bytes of its buffers.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "files/gltf/item.h"
#include "files/inside_folder.h"

namespace beltrami::cli::gltf {

/// Where the bytes of a buffer were.
enum class Storage { kChunk, kFile, kEmbedded };

struct Document {
  std::string path;
  Json json;                         ///< an object; embedded buffers are without their URIs
  std::vector<std::string> buffers;  ///< each as long as its byteLength at least, or empty where
                                     ///< an earlier one is of the same file
  std::vector<std::uint64_t> first_of_file;  ///< per buffer: that one, or itself
  Storage storage = Storage::kChunk;         ///< of the first buffer
  /// The paths of buffers in files, with the first buffer of each.
  std::map<std::string, std::uint64_t> files;
  std::vector<std::string> not_kept;  ///< what was passed over, in words

  Item root() const { return {json, "", path}; }
  /// Entry `number` of the list of this name: "accessors". Throws Failure if there is none.
  Item entry(const char* list, std::uint64_t number) const;
  /// How many entries that list has.
  std::uint64_t count(const char* list) const;
};

/// A part of a buffer that has its bytes.
struct BufferView {
  std::uint64_t buffer = 0, offset = 0, length = 0;
  std::uint64_t stride = 0;  ///< 0 where items stand side by side
};

/// Takes `bytes` apart, the whole file at `path`, and reads its buffers, files within `reach` among
/// them. Throws Failure for what is
/// not glTF 2.0 or is cut short. What extensions compress is decoded.
/// Every buffer view lies within its buffer.
Document read_document(std::string_view bytes, const std::string& path, Reach reach);

/// What an object names by `buffer`, `byteOffset`, `byteLength` and `byteStride`, as views do.
/// Throws Failure where that is not within the buffer.
BufferView stretch_of(const Document& document, const Item& item);

/// Throws Failure where there is none of this number.
BufferView buffer_view(const Document& document, std::uint64_t number);

}  // namespace beltrami::cli::gltf
