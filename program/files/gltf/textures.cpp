#include "files/gltf/textures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string_view>

#include "files/gltf/document.h"
#include "files/gltf/materials.h"
#include "files/gltf/uri.h"
#include "files/inside_folder.h"
#include "files/mesh_file.h"
#include "files/texture_use.h"
#include "process/descriptor.h"
#include "process/failure.h"

namespace beltrami::cli::gltf {
namespace {

constexpr std::uint64_t kNone = std::numeric_limits<std::uint64_t>::max();
constexpr const char* kTransform = "KHR_texture_transform";
/// Extensions by which a texture has an image of another format.
constexpr std::array<const char*, 4> kOtherFormats = {"KHR_texture_basisu", "EXT_texture_webp",
                                                      "EXT_texture_avif", "MSFT_texture_dds"};
/// Extensions of a scene whose numbers are those of no texture.
constexpr std::array<std::string_view, 2> kWithoutTextures = {"KHR_lights_punctual",
                                                              "KHR_materials_variants"};
/// What OpenGL calls the ways of samplers.
constexpr std::uint64_t kClampToEdge = 33071, kMirroredRepeat = 33648, kNearest = 9728;

/// Calls visit(json, key, pointer) for what says how a texture is drawn, wherever it is in `json`,
/// the member `key` of something, but in extras.
template <class AnyJson, class Visit>
void visit_uses(AnyJson& json, std::string_view key, const std::string& pointer,
                const Visit& visit) {
  if (is_texture(json, key)) visit(json, key, pointer);
  if (json.is_array()) {
    for (std::size_t i = 0; i < json.size(); ++i) {
      visit_uses(json[i], key, pointer + "/" + std::to_string(i), visit);
    }
  } else if (json.is_object()) {
    for (auto& [name, value] : json.items()) {
      if (name != "extras") visit_uses(value, name, pointer + "/" + name, visit);
    }
  }
}

std::string without_end(std::string_view key) {
  constexpr std::string_view kEnd = "Texture";
  return std::string(key.ends_with(kEnd) ? key.substr(0, key.size() - kEnd.size()) : key);
}

/// By the names of members, those of extensions among them.
Meaning meaning_of(std::string_view key, const Item& material) {
  if (key.ends_with("ormalTexture") || key == "anisotropyTexture") return Meaning::kDirections;
  const bool base = key == "baseColorTexture" || key == "diffuseTexture";
  const std::string alpha = material.text("alphaMode");
  if (base && (alpha == "BLEND" || alpha == "MASK")) return Meaning::kTransparent;
  const bool colour = key.ends_with("olorTexture") || key == "diffuseTexture" ||
                      key == "emissiveTexture" || key == "specularGlossinessTexture";
  return colour ? Meaning::kColours : Meaning::kNumbers;
}

std::array<double, 2> pair_of(const Item& item, const char* key, double otherwise) {
  const Json* found = item.find(key);
  if (!found) return {otherwise, otherwise};
  if (!found->is_array() || found->size() != 2 || !(*found)[0].is_number() ||
      !(*found)[1].is_number()) {
    item.fail(std::string(key) + " is no pair of numbers");
  }
  return {(*found)[0].get<double>(), (*found)[1].get<double>()};
}

/// With the V axis of both UVs up; that of glTF points down.
std::array<double, 6> transform_of(const Item& texture) {
  const std::optional<Item> found = extension(texture, kTransform);
  if (!found) return {1, 0, 0, 0, 1, 0};
  const auto [x, y] = pair_of(*found, "offset", 0);
  const auto [width, height] = pair_of(*found, "scale", 1);
  const Json* rotation = found->find("rotation");
  const double angle = rotation && rotation->is_number() ? rotation->get<double>() : 0;
  const double c = std::cos(angle), s = std::sin(angle);
  // Down: u' = c w u + s h v + x, v' = -s w u + c h v + y, in which v is 1 - v up.
  return {c * width, -s * height, s * height + x, s * width, c * height, 1 - c * height - y};
}

Beyond beyond(std::uint64_t wrap) {
  if (wrap == kClampToEdge) return Beyond::kClamp;
  return wrap == kMirroredRepeat ? Beyond::kMirror : Beyond::kRepeat;
}

/// "materials[2] 'wood'".
std::string named(const Item& item) {
  const std::string name = one_line(item.text("name"));
  return name.empty() ? item.name : item.name + " '" + name + "'";
}

/// The image of a texture: one that an extension has instead where there is no other.
std::uint64_t image_of_texture(const Item& texture) {
  if (const std::optional<std::uint64_t> source = texture.whole("source")) return *source;
  for (const char* format : kOtherFormats) {
    const std::optional<Item> other = extension(texture, format);
    if (other && other->whole("source")) return *other->whole("source");
  }
  return kNone;
}

class Uses {
 public:
  explicit Uses(const Document& document) : document_(document) {}

  void add_material(std::uint64_t number) {
    const Item material = document_.entry("materials", number);
    visit_uses(
        material.json, "", "",
        [&](const Json& json, std::string_view key, const std::string& pointer) {
          add(material, number, {json, material.name + pointer, material.path}, key, pointer);
        });
  }
  std::vector<TextureUse> take() { return std::move(uses_); }

 private:
  void add(const Item& material, std::uint64_t number, const Item& texture, std::string_view key,
           const std::string& pointer) {
    TextureUse use;
    use.material = number;
    use.name = std::string(key) + " of " + named(material);
    const std::string name = material.text("name");
    use.stem = (name.empty() ? "material" + std::to_string(number) : name) + "_" + without_end(key);
    use.uv_set = set_of_texture(texture);
    use.transform = transform_of(texture);
    use.meaning = meaning_of(key, material);
    const std::uint64_t index = texture.required("index");
    const Item drawn = document_.entry("textures", index);
    use.number = image_of_texture(drawn);
    use.image = use.number < document_.count("images")
                    ? named(document_.entry("images", use.number))
                    : drawn.name;
    if (const std::optional<std::uint64_t> sampler = drawn.whole("sampler")) {
      const Item item = document_.entry("samplers", *sampler);
      use.reading.along_u = beyond(item.whole("wrapS", 0));
      use.reading.along_v = beyond(item.whole("wrapT", 0));
      use.reading.nearest = item.whole("magFilter", 0) == kNearest;
    }
    for (TextureUse& known : uses_) {
      if (known.material != number || indices_[known.slots.front()] != index) continue;
      if (known.meaning != use.meaning || known.uv_set != use.uv_set) continue;
      if (known.transform != use.transform) continue;
      known.slots.push_back("/materials/" + std::to_string(number) + pointer);
      return;
    }
    use.slots = {"/materials/" + std::to_string(number) + pointer};
    indices_[use.slots.front()] = index;
    uses_.push_back(std::move(use));
  }

  const Document& document_;
  std::vector<TextureUse> uses_;
  std::map<std::string, std::uint64_t> indices_;  ///< of textures, by slot
};

/// Whole numbers anywhere in something that nobody here knows may be those of textures and images.
void mark_numbers(const Json& json, std::vector<bool>& marks) {
  if (const std::optional<std::uint64_t> number = whole_of(json)) {
    if (*number < marks.size()) marks[*number] = true;
  } else if (json.is_structured()) {
    for (const Json& item : json) mark_numbers(item, marks);
  }
}

/// The entries of a list that something refers to.
class Taken {
 public:
  Taken(const Json& json, const char* list)
      : marks_(json.contains(list) ? json[list].size() : 0, false) {
    if (json.contains("extras")) mark_numbers(json["extras"], marks_);
    if (!json.contains("extensions")) return;
    // Extensions of scenes, such as those of avatars, have materials of their own.
    for (const auto& [name, extension] : json["extensions"].items()) {
      const bool has_none = std::find(kWithoutTextures.begin(), kWithoutTextures.end(), name) !=
                            kWithoutTextures.end();
      if (!has_none) mark_numbers(extension, marks_);
    }
  }
  void mark(const Json& number) {
    const std::optional<std::uint64_t> found = whole_of(number);
    if (found && *found < marks_.size()) marks_[*found] = true;
  }
  /// Puts a value where nothing is referred to, or behind all.
  std::uint64_t put(Json& list, Json value) {
    while (next_ < marks_.size() && marks_[next_]) ++next_;
    if (next_ >= marks_.size()) {
      list.push_back(std::move(value));
      return list.size() - 1;
    }
    list[next_] = std::move(value);
    return next_++;
  }
  /// The places that are still free.
  std::vector<std::uint64_t> left() const {
    std::vector<std::uint64_t> places;
    for (std::uint64_t i = next_; i < marks_.size(); ++i) {
      if (!marks_[i]) places.push_back(i);
    }
    return places;
  }

 private:
  std::vector<bool> marks_;
  std::uint64_t next_ = 0;
};

/// Takes what drew the old texture away, and marks the slots.
void free_slots(Json& json, const std::vector<BakedTexture>& baked, std::uint64_t uv_set) {
  for (const BakedTexture& texture : baked) {
    for (const std::string& slot : texture.use.slots) {
      Json& info = json[Json::json_pointer(slot)];
      info["index"] = Json();
      info.erase("texCoord");
      if (uv_set != 0) info["texCoord"] = uv_set;
      if (!info.contains("extensions") || !info["extensions"].is_object()) continue;
      info["extensions"].erase(kTransform);
      if (info["extensions"].empty()) info.erase("extensions");
    }
  }
}

Taken textures_in_use(Json& json) {
  Taken taken(json, "textures");
  for (auto& [key, value] : json.items()) {
    if (key == "extras") continue;
    visit_uses(value, key, "", [&](Json& info, std::string_view, const std::string&) {
      taken.mark(info["index"]);
    });
  }
  return taken;
}

/// Those of textures that are not to be replaced.
Taken images_in_use(const Json& json, const std::vector<std::uint64_t>& replaced) {
  Taken taken(json, "images");
  const std::set<std::uint64_t> gone(replaced.begin(), replaced.end());
  if (!json.contains("textures")) return taken;
  for (std::uint64_t i = 0; i < json["textures"].size(); ++i) {
    const Json& texture = json["textures"][i];
    if (gone.contains(i) || !texture.is_object()) continue;
    if (texture.contains("source")) taken.mark(texture["source"]);
    if (!texture.contains("extensions")) continue;
    for (const Json& other : texture["extensions"]) {
      if (other.is_object() && other.contains("source")) taken.mark(other["source"]);
    }
  }
  return taken;
}

/// A sampler as that of a texture, but clamped: a chart near an edge must not show the other one.
std::uint64_t clamped_sampler(Json& json, bool nearest) {
  Json& samplers = json["samplers"];
  if (!samplers.is_array()) samplers = Json::array();
  constexpr std::uint64_t kLinear = 9729, kLinearMipmapLinear = 9987, kNearestMipmapLinear = 9986;
  const Json wanted = {{"magFilter", nearest ? kNearest : kLinear},
                       {"minFilter", nearest ? kNearestMipmapLinear : kLinearMipmapLinear},
                       {"wrapS", kClampToEdge},
                       {"wrapT", kClampToEdge}};
  const auto found = std::find(samplers.begin(), samplers.end(), wanted);
  if (found != samplers.end()) return static_cast<std::uint64_t>(found - samplers.begin());
  samplers.push_back(wanted);
  return samplers.size() - 1;
}

}  // namespace

std::vector<TextureUse> textures_of(const Model& model) {
  std::set<std::uint64_t> materials;
  for (const Primitive& place : model.primitives) {
    for (const std::uint64_t number : materials_of(model.primitive(place.mesh, place.primitive))) {
      materials.insert(number);
    }
  }
  Uses uses(model.document);
  for (const std::uint64_t number : materials) uses.add_material(number);
  return uses.take();
}

std::vector<NewImage> put_textures(Json& json, const std::vector<BakedTexture>& baked,
                                   std::uint64_t uv_set) {
  std::vector<NewImage> added;
  if (baked.empty()) return added;
  free_slots(json, baked, uv_set);
  Taken textures = textures_in_use(json);
  Taken images = images_in_use(json, textures.left());
  for (const char* list : {"textures", "images"}) {
    if (!json.contains(list)) json[list] = Json::array();
  }
  Json texture_left, image_left;
  for (const BakedTexture& texture : baked) {
    Json image = {{"name", texture.use.stem}, {"mimeType", "image/png"}};
    if (!texture.uri.empty()) image["uri"] = texture.uri;
    const std::uint64_t source = images.put(json["images"], image);
    if (texture.uri.empty()) added.push_back({{source}, &texture.png});
    const Json drawn = {{"sampler", clamped_sampler(json, texture.use.reading.nearest)},
                        {"source", source}};
    const std::uint64_t index = textures.put(json["textures"], drawn);
    for (const std::string& slot : texture.use.slots) {
      json[Json::json_pointer(slot)]["index"] = index;
    }
    if (texture_left.is_null()) texture_left = drawn;
    if (image_left.is_null()) image_left = image;
  }
  // Numbers must stay, so that a list cannot become shorter: its free entries are another one
  // again.
  for (const std::uint64_t place : textures.left()) json["textures"][place] = texture_left;
  for (const std::uint64_t place : images.left()) {
    json["images"][place] = image_left;
    if (!added.empty()) added.front().places.push_back(place);
  }
  for (const char* name : kOtherFormats) forget_extension(json, name);
  forget_extension(json, kTransform);
  return added;
}

}  // namespace beltrami::cli::gltf

namespace beltrami::cli {

std::vector<TextureUse> gltf_textures(const MeshFile& file) {
  return gltf::textures_of(gltf::model_of(file));
}

std::vector<std::string> gltf_sources(const MeshFile& file) {
  const gltf::Document& document = gltf::model_of(file).document;
  std::vector<std::string> found = {document.path};
  for (const auto& [path, buffer] : document.files) found.push_back(path);
  for (std::uint64_t i = 0; i < document.count("images"); ++i) {
    const gltf::Item image = document.entry("images", i);
    const gltf::Json* const named_uri = image.find("uri");
    if (named_uri == nullptr || !named_uri->is_string()) continue;
    const auto uri = named_uri->get<std::string>();
    if (uri.empty() || gltf::is_data(uri)) continue;
    NamedFile named = follow_uri(document.path, uri, file.reach);
    if (!named.path.empty()) found.push_back(std::move(named.path));
  }
  return found;
}

std::string gltf_image_path(const MeshFile& file, const TextureUse& use) {
  const gltf::Document& document = gltf::model_of(file).document;
  if (use.number == gltf::kNone) {
    throw Failure(document.path + ": " + use.name + ": its texture has no image that is known");
  }
  const gltf::Item image = document.entry("images", use.number);
  const std::string uri = image.text("uri");
  if (uri.empty() || gltf::is_data(uri)) return {};
  NamedFile named = follow_uri(document.path, uri, file.reach);
  if (named.path.empty()) image.fail("its uri '" + one_line(uri) + "' " + named.refusal);
  return std::move(named.path);
}

std::string gltf_image(const MeshFile& file, const TextureUse& use) {
  const std::string path = gltf_image_path(file, use);
  if (!path.empty()) return read_file(path);
  const gltf::Document& document = gltf::model_of(file).document;
  const gltf::Item image = document.entry("images", use.number);
  const std::string uri = image.text("uri");
  if (uri.empty()) {
    const gltf::BufferView view = gltf::buffer_view(document, image.required("bufferView"));
    return document.buffers[view.buffer].substr(view.offset, view.length);
  }
  std::optional<std::string> data = gltf::decode_data(uri);
  if (!data) image.fail("its uri is no data in base 64: export the file again");
  return *std::move(data);
}

}  // namespace beltrami::cli
