#include "files/gltf/merge.h"

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "files/gltf/document.h"
#include "files/gltf/materials.h"
#include "files/gltf/textures.h"
#include "files/gltf_file.h"
#include "files/mesh_file.h"
#include "process/failure.h"

namespace beltrami::cli::gltf {
namespace {

constexpr const char* kPbr = "pbrMetallicRoughness";

/// The textures that glTF itself has.
enum Slot : std::size_t { kBaseColour, kRoughness, kNormal, kOcclusion, kEmissive, kSlots };
constexpr std::array<const char*, kSlots> kPointers = {
    "/pbrMetallicRoughness/baseColorTexture", "/pbrMetallicRoughness/metallicRoughnessTexture",
    "/normalTexture", "/occlusionTexture", "/emissiveTexture"};
constexpr std::array<const char*, kSlots> kStems = {"baseColor", "metallicRoughness", "normal",
                                                    "occlusion", "emissive"};

std::string pointer_to(std::uint64_t material, std::size_t slot) {
  return "/materials/" + std::to_string(material) + kPointers[slot];
}

double number_in(const Json& json, const char* key, double otherwise) {
  return json.is_object() && json.contains(key) && json[key].is_number() ? json[key].get<double>()
                                                                         : otherwise;
}

template <std::size_t kCount>
std::array<double, 4> numbers_in(const Json& json, const char* key, double otherwise) {
  std::array<double, 4> found = {1, 1, 1, 1};
  for (std::size_t i = 0; i < kCount; ++i) {
    const bool has = json.is_object() && json.contains(key) && json[key].is_array() &&
                     i < json[key].size() && json[key][i].is_number();
    found[i] = has ? json[key][i].get<double>() : otherwise;
  }
  return found;
}

const Json& member(const Json& json, const char* key) {
  static const Json nothing;
  return json.is_object() && json.contains(key) ? json[key] : nothing;
}

/// A material, with what of it is baked apart from the rest.
struct Parted {
  std::uint64_t number = 0;
  std::string name;
  Json rest;  ///< without names, textures and factors, and without what is the default
  std::array<std::array<double, 4>, kSlots> factors{};
  std::array<std::optional<TextureUse>, kSlots> textures;
  std::vector<TextureUse> others;  ///< of extensions
  bool opaque = true;
};

Parted part(const Model& model, std::uint64_t number, const std::vector<TextureUse>& uses) {
  const Item material = model.document.entry("materials", number);
  Parted parted;
  parted.number = number;
  parted.name = material.text("name");
  Json& rest = parted.rest = material.json;
  const Json& pbr = member(material.json, kPbr);
  const std::string alpha = material.text("alphaMode");
  parted.opaque = alpha != "BLEND" && alpha != "MASK";
  parted.factors[kBaseColour] = numbers_in<4>(pbr, "baseColorFactor", 1);
  if (parted.opaque) parted.factors[kBaseColour][3] = 1;
  parted.factors[kRoughness] = {1, number_in(pbr, "roughnessFactor", 1),
                                number_in(pbr, "metallicFactor", 1), 1};
  parted.factors[kNormal] = {number_in(member(rest, "normalTexture"), "scale", 1), 1, 1, 1};
  parted.factors[kOcclusion] = {number_in(member(rest, "occlusionTexture"), "strength", 1), 1, 1,
                                1};
  parted.factors[kEmissive] = numbers_in<3>(rest, "emissiveFactor", 0);
  for (const char* key :
       {"name", "normalTexture", "occlusionTexture", "emissiveTexture", "emissiveFactor"}) {
    rest.erase(key);
  }
  if (rest.contains(kPbr) && rest[kPbr].is_object()) {
    for (const char* key : {"baseColorFactor", "baseColorTexture", "roughnessFactor",
                            "metallicFactor", "metallicRoughnessTexture"}) {
      rest[kPbr].erase(key);
    }
    if (rest[kPbr].empty()) rest.erase(kPbr);
  }
  if (parted.opaque) rest.erase("alphaMode");
  if (alpha != "MASK" || number_in(rest, "alphaCutoff", 0.5) == 0.5) rest.erase("alphaCutoff");
  if (!material.truth("doubleSided")) rest.erase("doubleSided");
  for (const TextureUse& use : uses) {
    if (use.material != number) continue;
    std::vector<std::string> others = use.slots;
    for (std::size_t slot = 0; slot < kSlots; ++slot) {
      const auto found = std::find(others.begin(), others.end(), pointer_to(number, slot));
      if (found == others.end()) continue;
      parted.textures[slot] = use;
      others.erase(found);
    }
    if (others.empty()) continue;
    parted.others.push_back(use);
    parted.others.back().slots = std::move(others);
  }
  return parted;
}

/// Whether occlusion is the red of what metals and roughness are the blue and green of.
bool share_one_picture(const std::vector<Parted>& materials) {
  return std::all_of(materials.begin(), materials.end(), [](const Parted& material) {
    const auto& occlusion = material.textures[kOcclusion];
    const auto& roughness = material.textures[kRoughness];
    return !occlusion || (roughness && roughness->slots == occlusion->slots);
  });
}

class Planner {
 public:
  explicit Planner(const Model& model) {
    std::set<std::uint64_t> numbers;
    for (const Primitive& place : model.primitives) {
      const Item primitive = model.primitive(place.mesh, place.primitive);
      if (extension(primitive, "KHR_materials_variants")) {
        primitive.fail(
            "it has variants of materials, which one material is not: do without "
            "--merge-materials");
      }
      for (const std::uint64_t number : materials_of(primitive)) numbers.insert(number);
    }
    const std::vector<TextureUse> uses = textures_of(model);
    for (const std::uint64_t number : numbers) all_.push_back(part(model, number, uses));
  }

  MergePlan plan() {
    if (all_.empty()) return {};
    for (const Parted& material : all_) {
      const auto same = std::find_if(groups_.begin(), groups_.end(), [&](const auto& group) {
        return group.front()->rest == material.rest;
      });
      if (same == groups_.end()) {
        groups_.push_back({&material});
      } else {
        same->push_back(&material);
      }
    }
    for (const auto& group : groups_) add_material(group);
    const bool one_picture = share_one_picture(all_);
    for (std::size_t slot = 0; slot < kSlots; ++slot) {
      if (slot == kOcclusion && one_picture) continue;
      add_slot(static_cast<Slot>(slot), slot == kRoughness && one_picture);
    }
    for (const auto& group : groups_) add_others(group);
    return std::move(plan_);
  }

 private:
  void add_material(const std::vector<const Parted*>& group) {
    MergedMaterial merged;
    for (const Parted* material : group) merged.members.push_back(material->number);
    merged.json = Json::object();
    const std::string name = group.size() == 1    ? group.front()->name
                             : groups_.size() > 1 ? group.front()->name + "_merged"
                                                  : "merged";
    if (!name.empty()) merged.json["name"] = name;
    merged.json.update(group.front()->rest);
    if (&group != &groups_.front() && plan_.note.empty()) plan_.note = difference(group);
    plan_.materials.push_back(std::move(merged));
  }

  /// Why a group is not merged with the first one.
  std::string difference(const std::vector<const Parted*>& group) const {
    const auto named = [](const Parted& material) {
      std::string name(1, '\'');
      name += material.name.empty() ? std::to_string(material.number) : one_line(material.name);
      return name.append(1, '\'');
    };
    const Parted &first = *groups_.front().front(), &other = *group.front();
    std::string what;
    for (const Json* json : {&first.rest, &other.rest}) {
      for (const auto& [key, value] : json->items()) {
        if (what.empty() && member(first.rest, key.c_str()) != member(other.rest, key.c_str())) {
          what = key;
        }
      }
    }
    return std::to_string(groups_.size()) + " of " + std::to_string(all_.size()) +
           " materials are left, which share their pictures: " + named(first) + " and " +
           named(other) + " differ in " + what;
  }

  /// Factors that all have stay factors; else they are baked.
  bool same_factors(Slot slot) const {
    return std::all_of(all_.begin(), all_.end(), [&](const Parted& material) {
      return material.factors[slot] == all_.front().factors[slot];
    });
  }

  void add_slot(Slot slot, bool with_occlusion) {
    const auto textured = [&](const Parted& material) {
      return material.textures[slot].has_value();
    };
    const bool any = std::any_of(all_.begin(), all_.end(), textured);
    const bool same = same_factors(slot);
    const bool black = slot == kEmissive && same && !lights(all_.front());
    if (same) keep_factors(slot);
    if (black) return;
    // Without a texture there is nothing that a scale or a strength is of.
    const bool of_texture = slot == kNormal || slot == kOcclusion;
    if (!any && (same || of_texture)) return;
    if (!same && slot == kEmissive) set_all(nullptr, "emissiveFactor", Json{1.0, 1.0, 1.0});
    MergedTexture merged;
    for (const Parted& material : all_) {
      MergedPart part;
      part.material = material.number;
      part.texture = material.textures[slot];
      part.opaque = material.opaque;
      if (!same) part.factors = material.factors[slot];
      if (with_occlusion) {
        const bool has = material.textures[kOcclusion].has_value();
        part.factors[0] = has ? material.factors[kOcclusion][0] : 0;
      }
      merged.parts.push_back(std::move(part));
    }
    describe(slot, with_occlusion, merged);
    plan_.textures.push_back(std::move(merged));
  }

  static bool lights(const Parted& material) {
    const auto& factor = material.factors[kEmissive];
    return factor[0] > 0 || factor[1] > 0 || factor[2] > 0;
  }

  void describe(Slot slot, bool with_occlusion, MergedTexture& merged) const {
    TextureUse& use = merged.use;
    use.name = std::string(kStems[slot]) + "Texture of all materials";
    use.stem = std::string("merged_") + kStems[slot];
    use.material = kEveryMaterial;
    const bool occludes =
        with_occlusion && std::any_of(all_.begin(), all_.end(), [](const auto& m) {
          return m.textures[kOcclusion].has_value();
        });
    for (const MergedMaterial& material : plan_.materials) {
      use.slots.push_back(pointer_to(material.members.front(), slot));
      if (occludes) use.slots.push_back(pointer_to(material.members.front(), kOcclusion));
    }
    const auto opaque = [](const Parted& material) { return material.opaque; };
    if (slot == kBaseColour) {
      use.meaning =
          std::all_of(all_.begin(), all_.end(), opaque) ? Meaning::kColours : Meaning::kTransparent;
    } else if (slot == kEmissive) {
      use.meaning = Meaning::kColours;
    } else if (slot == kNormal) {
      use.meaning = Meaning::kDirections;
    }
  }

  void set_all(const char* parent, const char* key, const Json& value) {
    for (MergedMaterial& material : plan_.materials) {
      Json& place = parent != nullptr ? material.json[parent] : material.json;
      place[key] = value;
    }
  }

  void keep_factors(Slot slot) {
    const std::array<double, 4>& f = all_.front().factors[slot];
    if (slot == kBaseColour && f != std::array<double, 4>{1, 1, 1, 1}) {
      set_all(kPbr, "baseColorFactor", {f[0], f[1], f[2], f[3]});
    } else if (slot == kRoughness) {
      if (f[1] != 1) set_all(kPbr, "roughnessFactor", f[1]);
      if (f[2] != 1) set_all(kPbr, "metallicFactor", f[2]);
    } else if (slot == kEmissive && lights(all_.front())) {
      set_all(nullptr, "emissiveFactor", {f[0], f[1], f[2]});
    } else if ((slot == kNormal || slot == kOcclusion) && f[0] != 1) {
      const bool normal = slot == kNormal;
      set_all(normal ? "normalTexture" : "occlusionTexture", normal ? "scale" : "strength", f[0]);
    }
  }

  void add_others(const std::vector<const Parted*>& group) {
    for (std::size_t i = 0; i < group.front()->others.size(); ++i) {
      MergedTexture merged;
      merged.use = group.front()->others[i];
      // The rest of all of them is the same, and so are its textures.
      for (const Parted* material : group) {
        merged.parts.push_back({material->number, material->others[i], {1, 1, 1, 1}, false});
      }
      plan_.textures.push_back(std::move(merged));
    }
  }

  std::vector<Parted> all_;
  std::vector<std::vector<const Parted*>> groups_;
  MergePlan plan_;
};

/// Extensions whose numbers are not those of materials.
bool is_known(std::string_view name) {
  if (name == "KHR_materials_variants") return false;
  for (const char* start :
       {"KHR_materials_", "KHR_texture_", "EXT_texture_", "KHR_lights_", "KHR_mesh_", "EXT_mesh_",
        "EXT_meshopt_", "KHR_meshopt_", "KHR_draco_", "MSFT_texture_", "KHR_xmp_"}) {
    if (name.starts_with(start)) return true;
  }
  return false;
}

bool may_renumber(const Json& json) {
  for (const char* key : {"extensions", "extras"}) {
    if (!json.contains(key) || !json[key].is_object()) continue;
    if (key == std::string_view("extras") && !json[key].empty()) return false;
    for (const auto& [name, value] : json[key].items()) {
      if (!is_known(name)) return false;
    }
  }
  if (!json.contains("extensionsUsed")) return true;
  for (const Json& name : json["extensionsUsed"]) {
    if (!name.is_string() || !is_known(name.get<std::string>())) return false;
  }
  return true;
}

template <class Visit>
void visit_primitives(Json& json, const Visit& visit) {
  if (!json.contains("meshes")) return;
  for (Json& mesh : json["meshes"]) {
    if (!mesh.is_object() || !mesh.contains("primitives")) continue;
    for (Json& primitive : mesh["primitives"]) {
      if (primitive.is_object() && primitive.contains("material")) visit(primitive);
    }
  }
}

}  // namespace

MergePlan merge_plan(const Model& model) {
  return Planner(model).plan();
}

void merge_materials(Json& json, const Model& model, const MergePlan& plan) {
  std::map<std::uint64_t, std::uint64_t> first_of;
  for (const MergedMaterial& merged : plan.materials) {
    for (const std::uint64_t member : merged.members) first_of[member] = merged.members.front();
  }
  std::set<const Json*> of_triangles;
  for (const Primitive& place : model.primitives) {
    of_triangles.insert(&json["meshes"][place.mesh]["primitives"][place.primitive]);
  }
  // Lines and points stay as they were, and with them what they are drawn with.
  std::map<std::uint64_t, std::uint64_t> copies;
  visit_primitives(json, [&](Json& primitive) {
    Json& number = primitive["material"];
    const std::optional<std::uint64_t> own = whole_of(number);
    if (!own || !first_of.contains(*own)) return;
    if (of_triangles.contains(&primitive)) {
      number = first_of[*own];
      return;
    }
    const auto [copy, is_new] = copies.try_emplace(*own, json["materials"].size());
    if (is_new) json["materials"].push_back(Json(json["materials"][*own]));
    number = copy->second;
  });
  for (const MergedMaterial& merged : plan.materials) {
    for (const std::uint64_t member : merged.members) json["materials"][member] = Json();
    json["materials"][merged.members.front()] = merged.json;
  }
}

void drop_merged(Json& json, const MergePlan& plan) {
  if (plan.materials.empty()) return;
  Json& materials = json["materials"];
  const bool shorter = may_renumber(json);
  std::vector<std::uint64_t> numbers(materials.size());
  Json left = Json::array();
  for (std::uint64_t i = 0; i < materials.size(); ++i) {
    numbers[i] = left.size();
    if (!materials[i].is_null()) {
      left.push_back(materials[i]);
      continue;
    }
    if (shorter) continue;
    for (const MergedMaterial& merged : plan.materials) {
      const auto& members = merged.members;
      if (std::find(members.begin(), members.end(), i) == members.end()) continue;
      left.push_back(materials[members.front()]);
    }
  }
  materials = std::move(left);
  visit_primitives(json, [&](Json& primitive) {
    Json& number = primitive["material"];
    const std::optional<std::uint64_t> old = whole_of(number);
    if (old && *old < numbers.size()) number = numbers[*old];
  });
}

}  // namespace beltrami::cli::gltf

namespace beltrami::cli {

MaterialMerge gltf_merge(const MeshFile& file) {
  auto plan = std::make_shared<gltf::MergePlan>(gltf::merge_plan(gltf::model_of(file)));
  MaterialMerge merge;
  merge.textures = plan->textures;
  merge.note = plan->note;
  merge.plan = std::move(plan);
  return merge;
}

}  // namespace beltrami::cli
