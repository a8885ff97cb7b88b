#include "files/gltf/materials.h"

#include <optional>

namespace beltrami::cli::gltf {
namespace {

std::optional<Item> extension(const Item& item, const char* name) {
  const std::optional<Item> all = item.object("extensions");
  return all ? all->object(name) : std::nullopt;
}

void add_set(const Document& document, const Item& user, std::vector<std::uint64_t>& sets) {
  const std::optional<std::uint64_t> number = user.whole("material");
  if (!number) return;
  const std::optional<Item> texture = document.entry("materials", *number).object("normalTexture");
  if (!texture) return;
  std::uint64_t set = texture->whole("texCoord", 0);
  if (const std::optional<Item> transform = extension(*texture, "KHR_texture_transform")) {
    set = transform->whole("texCoord", set);
  }
  sets.push_back(set);
}

}  // namespace

std::vector<std::uint64_t> sets_of_normal_maps(const Document& document, const Item& primitive) {
  std::vector<std::uint64_t> sets;
  add_set(document, primitive, sets);
  const std::optional<Item> variants = extension(primitive, "KHR_materials_variants");
  const std::optional<Item> mappings = variants ? variants->array("mappings") : std::nullopt;
  for (std::uint64_t i = 0; mappings && i < mappings->size(); ++i) {
    add_set(document, (*mappings)[i], sets);
  }
  return sets;
}

}  // namespace beltrami::cli::gltf
