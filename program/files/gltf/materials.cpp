#include "files/gltf/materials.h"

#include <algorithm>

#include "process/failure.h"

namespace beltrami::cli::gltf {
namespace {

constexpr const char* kTransform = "KHR_texture_transform";
constexpr const char* kVariants = "KHR_materials_variants";

/// Calls visit(json) for all such in `json`, the member `key` of something.
template <class Visit>
void visit_textures(Json& json, std::string_view key, const Visit& visit) {
  if (is_texture(json, key)) visit(json);
  if (json.is_array()) {
    for (Json& item : json) visit_textures(item, key, visit);
  } else if (json.is_object()) {
    for (auto& [name, value] : json.items()) {
      if (name != "extras") visit_textures(value, name, visit);
    }
  }
}

/// What is not as it should be uses no set.
bool uses_set(const Json& texture, std::uint64_t uv_set) {
  static const std::string nobody;
  try {
    return set_of_texture({texture, "", nobody}) == uv_set;
  } catch (const Failure&) {
    return false;
  }
}

bool any_texture_uses(Json& json, std::uint64_t uv_set) {
  bool found = false;
  visit_textures(json, "", [&](Json& texture) { found = found || uses_set(texture, uv_set); });
  return found;
}

/// The extensions of `json`, an object of the document, whose textures use the set.
void add_extensions(Json& json, std::uint64_t uv_set, std::set<std::string>& found) {
  if (!json.is_object() || !json.contains("extensions")) return;
  for (auto& [name, value] : json["extensions"].items()) {
    if (name != kVariants && any_texture_uses(value, uv_set)) found.insert(name);
  }
}

/// Leaves the extension itself where something else is in it, or may point to it: without these
/// members it stands for none. Returns whether there was something to take away.
bool take_transform(Json& texture, bool keep_extension) {
  if (!texture.contains("extensions") || !texture["extensions"].contains(kTransform)) return false;
  Json& extensions = texture["extensions"];
  Json& transform = extensions[kTransform];
  if (!transform.is_object()) return false;
  bool any = false;
  for (const char* key : {"offset", "rotation", "scale"}) any = transform.erase(key) > 0 || any;
  if (keep_extension || !transform.empty()) return any;
  extensions.erase(kTransform);
  if (extensions.empty()) texture.erase("extensions");
  return any;
}

bool has_key(const Json& json, const char* key) {
  if (!json.is_structured()) return false;
  if (json.is_object() && json.contains(key)) return true;
  return std::any_of(json.begin(), json.end(),
                     [&](const Json& item) { return has_key(item, key); });
}

}  // namespace

std::optional<Item> extension(const Item& item, const char* name) {
  const std::optional<Item> all = item.object("extensions");
  return all ? all->object(name) : std::nullopt;
}

std::uint64_t set_of_texture(const Item& texture) {
  const std::uint64_t set = texture.whole("texCoord", 0);
  const std::optional<Item> transform = extension(texture, kTransform);
  return transform ? transform->whole("texCoord", set) : set;
}

std::vector<std::uint64_t> materials_of(const Item& primitive) {
  std::vector<std::uint64_t> numbers;
  const auto add = [&](const Item& user) {
    if (const std::optional<std::uint64_t> number = user.whole("material")) {
      numbers.push_back(*number);
    }
  };
  add(primitive);
  const std::optional<Item> variants = extension(primitive, kVariants);
  const std::optional<Item> mappings = variants ? variants->array("mappings") : std::nullopt;
  for (std::uint64_t i = 0; mappings && i < mappings->size(); ++i) add((*mappings)[i]);
  return numbers;
}

bool is_texture(const Json& json, std::string_view key) {
  if (!json.is_object() || !json.contains("index")) return false;
  return key.ends_with("exture") || json.contains("texCoord") || json.contains("channels");
}

void forget_extension(Json& json, const char* extension_name) {
  if (has_key(json, extension_name)) return;
  for (const char* key : {"extensionsUsed", "extensionsRequired"}) {
    if (!json.contains(key) || !json[key].is_array()) continue;
    Json left = Json::array();
    for (Json& name : json[key]) {
      if (name != extension_name) left.push_back(std::move(name));
    }
    json[key] = std::move(left);
    if (json[key].empty()) json.erase(key);
  }
}

std::vector<std::uint64_t> sets_of_normal_maps(const Document& document, const Item& primitive) {
  std::vector<std::uint64_t> sets;
  for (const std::uint64_t number : materials_of(primitive)) {
    const std::optional<Item> texture = document.entry("materials", number).object("normalTexture");
    if (texture) sets.push_back(set_of_texture(*texture));
  }
  return sets;
}

SetUsers free_set_of_textures(const Document& document, const std::vector<Item>& primitives,
                              std::uint64_t uv_set, Json& json) {
  SetUsers users;
  const bool animated = has_key(json, "KHR_animation_pointer");
  std::set<std::uint64_t> materials;
  for (const Item& primitive : primitives) {
    for (const std::uint64_t number : materials_of(primitive)) materials.insert(number);
    Json own = primitive.json;
    add_extensions(own, uv_set, users.extensions);
  }
  if (!primitives.empty()) add_extensions(json, uv_set, users.extensions);
  for (const std::uint64_t number : materials) {
    document.entry("materials", number);  // is there
    bool uses = false;
    visit_textures(json["materials"][number], "", [&](Json& texture) {
      if (!uses_set(texture, uv_set)) return;
      uses = true;
      users.transforms += take_transform(texture, animated) ? 1 : 0;
    });
    users.materials += uses ? 1 : 0;
  }
  if (users.transforms > 0) forget_extension(json, kTransform);
  return users;
}

}  // namespace beltrami::cli::gltf
