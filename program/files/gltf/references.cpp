#include "files/gltf/references.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

namespace beltrami::cli::gltf {
namespace {

/// Members that are numbers of accessors; those in attributes and targets are too.
constexpr std::array<std::string_view, 4> kAccessorKeys = {"indices", "input", "output",
                                                           "inverseBindMatrices"};
/// Extensions that begin so have numbers of textures and of materials, and values.
constexpr std::array<std::string_view, 3> kOthersKeys = {"KHR_materials_", "KHR_texture_",
                                                         "KHR_lights_"};

enum class Within { kDocument, kAttributes, kUnknown };

void mark(std::vector<bool>& marks, std::uint64_t number) {
  if (number < marks.size()) marks[number] = true;
}

/// `json` is the member `key` of something.
void collect(const Json& json, std::string_view key, Within within, References& found) {
  if (const std::optional<std::uint64_t> number = whole_of(json)) {
    const bool unknown = within == Within::kUnknown;
    const bool accessor =
        within == Within::kAttributes ||
        std::find(kAccessorKeys.begin(), kAccessorKeys.end(), key) != kAccessorKeys.end();
    if (unknown || accessor) mark(found.accessors, *number);
    if (unknown || key == "bufferView") mark(found.views, *number);
  } else if (json.is_array()) {
    for (const Json& item : json) collect(item, key, within, found);
  } else if (json.is_object()) {
    for (const auto& [name, value] : json.items()) {
      const std::string_view member = name;
      const bool others = key == "extensions" && std::any_of(kOthersKeys.begin(), kOthersKeys.end(),
                                                             [&](std::string_view begin) {
                                                               return member.starts_with(begin);
                                                             });
      if (others) continue;
      Within inside = within;
      if (member == "extensions" || member == "extras") {
        inside = Within::kUnknown;
      } else if (within == Within::kDocument && (member == "attributes" || member == "targets")) {
        inside = Within::kAttributes;
      }
      collect(value, member, inside, found);
    }
  }
}

std::size_t size_of_list(const Json& json, const char* key) {
  const auto list = json.find(key);
  return list != json.end() && list->is_array() ? list->size() : 0;
}

}  // namespace

References references_in(const Json& json) {
  References found;
  found.accessors.assign(size_of_list(json, "accessors"), false);
  found.views.assign(size_of_list(json, "bufferViews"), false);
  for (const auto& [key, value] : json.items()) {
    if (key == "accessors") continue;
    collect(value, key,
            key == "extensions" || key == "extras" ? Within::kUnknown : Within::kDocument, found);
  }
  for (std::size_t i = 0; i < found.accessors.size(); ++i) {
    if (found.accessors[i]) collect(json["accessors"][i], "", Within::kDocument, found);
  }
  return found;
}

}  // namespace beltrami::cli::gltf
