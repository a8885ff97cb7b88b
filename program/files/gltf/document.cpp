#include "files/gltf/document.h"

#include <algorithm>
#include <optional>

#include "files/gltf/decompress.h"
#include "files/gltf/little.h"
#include "files/gltf/uri.h"
#include "process/descriptor.h"
#include "process/failure.h"
#include "process/interrupt.h"

namespace beltrami::cli::gltf {
namespace {

constexpr std::string_view kMagic = "glTF";
constexpr std::uint32_t kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;
/// Deeper than any document is. Writing JSON takes stack for each level.
constexpr int kMaxDepth = 200;

/// The parts of a GLB file, or of the text of a .gltf file.
struct Container {
  std::string_view json;
  std::optional<std::string_view> chunk;  ///< the binary one
  bool other_chunks = false;
};

Container open_glb(std::string_view bytes, const std::string& path) {
  const std::string short_file = path + ": the file is cut short";
  if (bytes.size() < 12) throw Failure(short_file);
  const auto version = little<std::uint32_t>(bytes.data() + 4);
  if (version != 2) {
    throw Failure(path + ": this is glTF " + std::to_string(version) +
                  ": convert it to glTF 2.0 first");
  }
  const auto length = little<std::uint32_t>(bytes.data() + 8);
  if (length > bytes.size() || length < 12) throw Failure(short_file);
  Container found;
  std::string_view rest = bytes.substr(12, length - 12);
  for (int chunk = 0; rest.size() >= 8; ++chunk) {
    const auto size = little<std::uint32_t>(rest.data());
    const auto type = little<std::uint32_t>(rest.data() + 4);
    if (size > rest.size() - 8) throw Failure(short_file);
    const std::string_view content = rest.substr(8, size);
    rest.remove_prefix(8 + std::size_t{size});
    if (chunk == 0 && type != kJsonChunk) {
      throw Failure(path + ": the first chunk is not JSON: export the file again");
    }
    if (chunk == 0) {
      found.json = content;
    } else if (chunk == 1 && type == kBinaryChunk) {
      found.chunk = content;
    } else {
      found.other_chunks = true;
    }
  }
  if (found.json.empty()) throw Failure(short_file);
  return found;
}

Json parse(std::string_view text, const std::string& path) {
  const auto visit = [&](int depth, Json::parse_event_t, const Json&) {
    if (depth > kMaxDepth) {
      throw Failure(path + ": the JSON is nested deeper than " + std::to_string(kMaxDepth) +
                    " levels: export the file again");
    }
    throw_if_interrupted();
    return true;
  };
  try {
    return Json::parse(text.begin(), text.end(), visit);
  } catch (const Json::parse_error& error) {
    throw Failure(path + ": byte " + std::to_string(error.byte) +
                  " of the JSON is not as it should be: export the file again");
  } catch (const Json::exception&) {
    throw Failure(path + ": the JSON has a number beyond all bounds: export the file again");
  }
}

void require_version(const Document& document) {
  const Item root = document.root();
  if (!document.json.is_object()) root.fail("the JSON is no object: this is not glTF");
  const std::optional<Item> asset = root.object("asset");
  if (!asset) root.fail("there is no asset: this is not glTF");
  const Json* number = asset->find("version");
  // Files of glTF 1.0 have a number there, too.
  const bool is_one = number != nullptr && number->is_number() && *number < 2;
  const std::string version = is_one ? number->dump() : asset->text("version");
  if (version.starts_with("2.")) return;
  root.fail(version.empty()
                ? "asset.version is missing: this is not glTF 2.0"
                : "this is glTF " + one_line(version) + ": convert it to glTF 2.0 first");
}

/// Buffers may be of one file, which is read once: else a short document could ask for any amount.
std::string bytes_of_file(Document& document, const Item& buffer, const std::string& uri,
                          Reach reach) {
  const NamedFile file = follow_uri(document.path, uri, reach);
  if (file.path.empty()) buffer.fail("its uri '" + one_line(uri) + "' " + file.refusal);
  const std::uint64_t number = document.buffers.size();
  const auto [first, is_new] = document.files.try_emplace(file.path, number);
  document.first_of_file[number] = first->second;
  return is_new ? read_file(file.path) : std::string();
}

void read_buffers(Document& document, const std::optional<std::string_view>& chunk, Reach reach) {
  for (std::uint64_t i = 0; i < document.count("buffers"); ++i) {
    const Item buffer = document.entry("buffers", i);
    const std::string uri = buffer.text("uri");
    Storage storage = Storage::kEmbedded;
    std::string bytes;
    document.first_of_file.push_back(i);
    if (is_fallback(buffer)) {
      // Its views are decoded to another one; a buffer must be of something.
      document.buffers.emplace_back(1, '\0');
      document.json["buffers"][i] = {{"byteLength", 1}};
      continue;
    }
    if (uri.empty()) {
      storage = Storage::kChunk;
      if (i != 0 || !chunk) buffer.fail("it has no bytes: export the file again");
      bytes = *chunk;
    } else if (is_data(uri)) {
      std::optional<std::string> data = decode_data(uri);
      if (!data) buffer.fail("its uri is no data in base 64: export the file again");
      bytes = std::move(*data);
    } else {
      storage = Storage::kFile;
      bytes = bytes_of_file(document, buffer, uri, reach);
    }
    if (i == 0) document.storage = storage;
    document.buffers.push_back(std::move(bytes));
    const std::uint64_t length = buffer.required("byteLength");
    const std::uint64_t found = document.buffers[document.first_of_file[i]].size();
    if (length > found) {
      buffer.fail("there are " + std::to_string(found) + " of its " + std::to_string(length) +
                  " bytes: the file is cut short");
    }
    // The text would be as long as the bytes once more, and the output has one of its own.
    if (storage == Storage::kEmbedded) document.json["buffers"][i].erase("uri");
  }
}

/// What is to be lists of the document is that: else it would be found out when the file is
/// written.
void require_lists(const Document& document) {
  for (const char* list :
       {"accessors", "animations", "bufferViews", "buffers", "images", "materials", "meshes",
        "nodes", "samplers", "scenes", "skins", "textures"}) {
    static_cast<void>(document.count(list));
  }
}

}  // namespace

BufferView buffer_view(const Document& document, std::uint64_t number) {
  return stretch_of(document, document.entry("bufferViews", number));
}

BufferView stretch_of(const Document& document, const Item& item) {
  BufferView view;
  view.buffer = item.required("buffer");
  view.offset = item.whole("byteOffset", 0);
  view.length = item.required("byteLength");
  view.stride = item.whole("byteStride", 0);
  // byteLength of a buffer is no more than the bytes that it has.
  const std::uint64_t size = document.entry("buffers", view.buffer).required("byteLength");
  if (view.offset > size || view.length > size - view.offset) {
    item.fail("it reaches beyond buffers[" + std::to_string(view.buffer) +
              "]: the file is damaged, export it again");
  }
  view.buffer = document.first_of_file[view.buffer];
  return view;
}

Item Document::entry(const char* list, std::uint64_t number) const {
  static const Json no_entries = Json::array();
  const std::optional<Item> all = root().array(list);
  return all ? (*all)[number] : Item{no_entries, list, path}[number];
}

std::uint64_t Document::count(const char* list) const {
  const std::optional<Item> all = root().array(list);
  return all ? all->size() : 0;
}

Document read_document(std::string_view bytes, const std::string& path, Reach reach) {
  if (bytes.empty()) throw Failure(path + ": the file is empty");
  Document document;
  document.path = path;
  Container container;
  if (bytes.starts_with(kMagic)) {
    container = open_glb(bytes, path);
  } else {
    container.json = bytes;
  }
  if (container.other_chunks) document.not_kept.emplace_back("chunks that are not of glTF 2.0");
  document.json = parse(container.json, path);
  require_version(document);
  require_lists(document);
  read_buffers(document, container.chunk, reach);
  decompress(document);
  for (std::uint64_t i = 0; i < document.count("bufferViews"); ++i) buffer_view(document, i);
  return document;
}

}  // namespace beltrami::cli::gltf
