#include "files/gltf/decompress.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "files/gltf/accessor.h"
#include "files/gltf/decode_draco.h"
#include "files/gltf/decode_meshopt.h"
#include "process/interrupt.h"

namespace beltrami::cli::gltf {
namespace {

constexpr std::array<const char*, 2> kMeshopt = {"EXT_meshopt_compression",
                                                 "KHR_meshopt_compression"};
constexpr const char* kDraco = "KHR_draco_mesh_compression";
constexpr std::uint64_t kTriangles = 4, kStrip = 5;

/// Decoded bytes for each compressed one, at most: else a short file could ask for any amount. A
/// grid of one normal takes a hundredth of its bytes.
constexpr std::uint64_t kMostPerByte = 1024;

[[noreturn]] void refuse(const Item& item, const std::string& extension) {
  item.fail("it is compressed by " + extension +
            ", which this build cannot read: decompress the file first (gltf-transform copy IN.glb "
            "OUT.glb), or export it without mesh compression");
}

[[noreturn]] void refuse_damaged(const Item& item, const std::string& extension) {
  item.fail("its bytes cannot be decoded, as " + extension +
            " has them: the file is damaged, or made by a later version of that extension: export "
            "it again, without mesh compression if that does not help");
}

/// The extension of an item, if it is an object of this name.
std::optional<Item> extension_of(const Item& item, const char* extension) {
  const std::optional<Item> all = item.object("extensions");
  return all ? all->object(extension) : std::nullopt;
}

void drop_extension(Json& json, const char* extension) {
  json["extensions"].erase(extension);
  if (json["extensions"].empty()) json.erase("extensions");
}

class Decompressor {
 public:
  explicit Decompressor(Document& document)
      : document_(document), buffer_(document.count("buffers")) {}

  void run() {
    for (const char* extension : kMeshopt) {
      for (std::uint64_t i = 0; i < document_.count("bufferViews"); ++i) decode_view(i, extension);
      forget(extension);
    }
    for (std::uint64_t m = 0; m < document_.count("meshes"); ++m) {
      const std::optional<Item> list = document_.entry("meshes", m).array("primitives");
      const std::uint64_t count = list ? list->size() : 0;
      for (std::uint64_t i = 0; i < count; ++i) decode_primitive(m, i);
    }
    forget(kDraco);
    if (bytes_.empty()) return;
    document_.json["buffers"].push_back({{"byteLength", bytes_.size()}});
    document_.first_of_file.push_back(buffer_);
    document_.buffers.push_back(std::move(bytes_));
    document_.not_kept.emplace_back("the compression of meshes");
  }

 private:
  void decode_view(std::uint64_t number, const char* extension) {
    throw_if_interrupted();
    const Item item = document_.entry("bufferViews", number);
    const std::optional<Item> own = extension_of(item, extension);
    if (!own) return;
    if (!reads_meshopt()) refuse(item, extension);
    const std::string_view packed = bytes_of(stretch_of(document_, *own));
    MeshoptView view{own->text("mode"), own->text("filter"), own->required("count"),
                     own->required("byteStride")};
    require_in_proportion(*own, view.count, view.stride, packed.size());
    std::string plain(view.count * view.stride, '\0');
    if (!decode_meshopt(view, packed, plain)) refuse_damaged(item, extension);
    Json& json = document_.json["bufferViews"][number];
    put(json, plain);
    drop_extension(json, extension);
  }

  void decode_primitive(std::uint64_t mesh, std::uint64_t number) {
    throw_if_interrupted();
    const Item item = (*document_.entry("meshes", mesh).array("primitives"))[number];
    const std::optional<Item> own = extension_of(item, kDraco);
    if (!own) return;
    if (!reads_draco()) refuse(item, kDraco);
    const std::uint64_t mode = item.whole("mode", kTriangles);
    if (mode != kTriangles && mode != kStrip) item.fail("Draco has triangles and strips alone");
    const std::string_view packed = bytes_of(buffer_view(document_, own->required("bufferView")));
    std::vector<std::uint64_t> accessors;
    std::vector<DracoAttribute> wanted;
    const std::optional<Item> ids = own->object("attributes");
    const std::optional<Item> attributes = item.object("attributes");
    if (!ids || !attributes) item.fail("it has no attributes");
    for (const auto& [name, unused] : ids->json.items()) {
      accessors.push_back(attributes->required(name.c_str()));
      const Item accessor = document_.entry("accessors", accessors.back());
      wanted.push_back(
          {ids->required(name.c_str()), component_of(accessor), width_of(accessor.text("type"))});
      if (wanted.back().width == 0) accessor.fail("its type is none that Draco has");
    }
    std::optional<DracoMesh> decoded = decode_draco(packed, wanted);
    if (!decoded || decoded->corners.empty()) refuse_damaged(item, kDraco);
    for (std::size_t k = 0; k < wanted.size(); ++k) {
      require_in_proportion(*own, decoded->points, wanted[k].stride(), packed.size());
      put_values(accessors[k], decoded->points, wanted[k], decoded->values[k]);
    }
    require_in_proportion(*own, decoded->corners.size(), 4, packed.size());
    Json& json = document_.json["meshes"][mesh]["primitives"][number];
    put_corners(json, decoded->corners);
    json.erase("mode");
    drop_extension(json, kDraco);
  }

  /// The accessor's values are those of a new view. They have been rounded, and so are their
  /// bounds.
  void put_values(std::uint64_t accessor, std::uint64_t count, const DracoAttribute& attribute,
                  const DracoValues& values) {
    Json& json = document_.json["accessors"][accessor];
    json["bufferView"] = add_view(values.bytes, attribute.stride());
    json["count"] = count;
    for (const char* key : {"byteOffset", "sparse"}) json.erase(key);
    for (const auto& [key, bounds] :
         {std::pair("min", values.low), std::pair("max", values.high)}) {
      if (json.contains(key)) {
        json[key] = std::vector<double>(bounds.begin(), bounds.begin() + attribute.width);
      }
    }
  }

  /// Primitives may have had one accessor of indices for strips and one for triangles of the same
  /// vertices: each gets its own.
  void put_corners(Json& primitive, const std::vector<std::uint32_t>& corners) {
    std::string bytes;
    bytes.reserve(4 * corners.size());
    for (const std::uint32_t corner : corners) {
      for (int shift = 0; shift < 32; shift += 8) {
        bytes.push_back(static_cast<char>(corner >> shift & 0xff));
      }
    }
    Json& accessors = document_.json["accessors"];
    primitive["indices"] = accessors.size();
    accessors.push_back({{"bufferView", add_view(bytes, 0)},
                         {"componentType", static_cast<std::uint16_t>(Component::kU32)},
                         {"count", corners.size()},
                         {"type", "SCALAR"}});
  }

  /// Returns the number of a view of these bytes.
  std::uint64_t add_view(const std::string& bytes, std::uint64_t stride) {
    Json& views = document_.json["bufferViews"];
    views.push_back(Json::object());
    put(views.back(), bytes);
    if (stride != 0) views.back()["byteStride"] = stride;
    return views.size() - 1;
  }

  /// Has a view show these bytes.
  void put(Json& view, const std::string& bytes) {
    bytes_.resize((bytes_.size() + 7) / 8 * 8);
    view["buffer"] = buffer_;
    view["byteOffset"] = bytes_.size();
    view["byteLength"] = bytes.size();
    bytes_ += bytes;
  }

  std::string_view bytes_of(const BufferView& view) const {
    return std::string_view(document_.buffers[view.buffer]).substr(view.offset, view.length);
  }

  static void require_in_proportion(const Item& item, std::uint64_t count, std::uint64_t stride,
                                    std::uint64_t packed) {
    const std::uint64_t most = kMostPerByte * packed;
    if (count > 0 && stride > 0 && stride <= most && count <= most / stride) return;
    item.fail("it is to have " + std::to_string(count) + " elements of " + std::to_string(stride) +
              " bytes, out of " + std::to_string(packed) +
              " compressed ones: the file is damaged, export it again");
  }

  void forget(const char* extension) {
    for (const char* key : {"extensionsUsed", "extensionsRequired"}) {
      const auto list = document_.json.find(key);
      if (list == document_.json.end() || !list->is_array()) continue;
      Json rest = Json::array();
      for (const Json& name : *list) {
        if (name != extension) rest.push_back(name);
      }
      if (rest.empty()) {
        document_.json.erase(key);
      } else {
        *list = std::move(rest);
      }
    }
  }

  Document& document_;
  std::uint64_t buffer_;  ///< the number of the new one
  std::string bytes_;     ///< of it
};

}  // namespace

bool is_fallback(const Item& buffer) {
  return std::any_of(kMeshopt.begin(), kMeshopt.end(), [&](const char* extension) {
    const std::optional<Item> own = extension_of(buffer, extension);
    return own && own->truth("fallback");
  });
}

void decompress(Document& document) {
  Decompressor(document).run();
}

}  // namespace beltrami::cli::gltf
