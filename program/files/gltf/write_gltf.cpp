// UVs into a document.
#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "files/gltf/accessor.h"
#include "files/gltf/container.h"
#include "files/gltf/document.h"
#include "files/gltf/item.h"
#include "files/gltf/little.h"
#include "files/gltf/materials.h"
#include "files/gltf/merge.h"
#include "files/gltf/model.h"
#include "files/gltf/rebuild.h"
#include "files/gltf/split.h"
#include "files/gltf/tangents.h"
#include "files/gltf/textures.h"
#include "files/gltf_file.h"
#include "files/mesh_file.h"
#include "files/polygons.h"
#include "files/texture_use.h"
#include "process/failure.h"
#include "process/interrupt.h"

namespace beltrami::cli {
namespace gltf {
namespace {

/// The first of the names; more would bury the rest of the line.
std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t kMostNames = 6;
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kMostNames); ++i) {
    text += (i > 0 ? ", " : "") + one_line(names[i]);
  }
  return names.size() > kMostNames ? text + ", ..." : text;
}

constexpr std::uint64_t kTriangles = 4;
/// Says which corners of a mesh are one vertex of a solid, by the vertices as they were.
constexpr const char* kManifold = "EXT_mesh_manifold";

std::string name_of_set(std::uint32_t uv_set) {
  return "TEXCOORD_" + std::to_string(uv_set);
}

/// The least set that this primitive does not have.
std::uint32_t free_set(const Item& primitive) {
  const std::optional<Item> attributes = primitive.object("attributes");
  std::uint32_t set = 0;
  while (attributes->find(name_of_set(set).c_str())) ++set;
  return set;
}

std::string counted(std::uint64_t count, const char* one, const char* several) {
  return std::to_string(count) + " " + (count == 1 ? one : several);
}

/// An index type that holds indices below `count`, and is no smaller than that of the input. The
/// greatest number of a type is no index.
Component index_type(std::uint64_t count, Component least) {
  if (least == Component::kU8 && count <= 0xFF) return Component::kU8;
  if (least != Component::kU32 && count <= 0xFFFF) return Component::kU16;
  return Component::kU32;
}

class Writer {
 public:
  Writer(const MeshFile& file, std::uint32_t uv_set, const GltfTextures& textures)
      : file_(file),
        baked_(textures.baked),
        merge_(textures.merge.get()),
        advice_(textures.advice),
        model_(model_of(file)),
        document_(model_.document),
        uv_set_(uv_set),
        uv_name_(name_of_set(uv_set)),
        split_(split_vertices(file)),
        json_(document_.json),
        new_numbers_(model_.sets.size()) {}

  Buffer write() {
    for (std::size_t set = 0; set < model_.sets.size(); ++set) {
      const std::uint64_t count = model_.sets[set].count + split_.copies[set].size();
      if (count > std::numeric_limits<std::uint32_t>::max()) {
        document_.root().fail("the UVs need more vertices than glTF can number: split the file");
      }
      uvs_of_set_.push_back(add({{{"componentType", static_cast<int>(Component::kF32)},
                                  {"count", count},
                                  {"type", "VEC2"}},
                                 std::move(split_.uvs[set]),
                                 0,
                                 Target::kVertices}));
    }
    add_tangents();
    for (const Primitive& primitive : model_.primitives) {
      throw_if_interrupted();
      edit_primitive(primitive);
    }
    edit_textures();
    if (merge_ != nullptr) merge_materials(json_, model_, *merge_);
    const std::vector<NewImage> images = put_textures(json_, baked_, uv_set_);
    if (merge_ != nullptr) {
      drop_merged(json_, *merge_);
      join_primitives();
    }
    return rebuild(document_, json_, std::move(added_), images);
  }

  Json take_json() { return std::move(json_); }
  const std::set<std::string>& not_kept() const { return not_kept_; }
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  std::uint64_t add(NewAccessor accessor) {
    added_.push_back(std::move(accessor));
    return document_.count("accessors") + added_.size() - 1;
  }

  /// Of the vertex sets of primitives whose normal maps are baked. Viewers that would make their
  /// own do so each in another way.
  void add_tangents() {
    tangents_of_set_.assign(model_.sets.size(), kNone);
    std::vector<std::string> bytes;
    for (const Primitive& place : model_.primitives) {
      const Item primitive = model_.primitive(place.mesh, place.primitive);
      if (tangents_of_set_[place.set] != kNone || !turns_directions(primitive)) continue;
      // What has no normals is drawn flat, and its tangents are of no account.
      if (!primitive.object("attributes")->find("NORMAL")) continue;
      if (bytes.empty()) bytes = tangents_of(file_, split_);
      tangents_of_set_[place.set] = add({{{"componentType", static_cast<int>(Component::kF32)},
                                          {"count", bytes[place.set].size() / 16},
                                          {"type", "VEC4"}},
                                         bytes[place.set],
                                         0,
                                         Target::kVertices});
    }
  }

  void edit_primitive(const Primitive& place) {
    const Item before = model_.primitive(place.mesh, place.primitive);
    Json& mesh = json_["meshes"][place.mesh];
    Json& primitive = mesh["primitives"][place.primitive];
    const std::uint32_t set = place.set;
    const std::vector<std::uint64_t>& mapped = place.normal_maps;
    const bool tangents = std::find(mapped.begin(), mapped.end(), uv_set_) == mapped.end() &&
                          !turns_directions(before);

    edit_attributes(primitive["attributes"], false, set, tangents);
    add_uvs(primitive["attributes"], uvs_of_set_[set]);
    if (turns_directions(before) && tangents_of_set_[set] != kNone) {
      primitive["attributes"]["TANGENT"] = tangents_of_set_[set];
    }
    if (primitive.contains("targets")) {
      for (Json& target : primitive["targets"]) edit_attributes(target, true, set, tangents);
    }
    edit_indices(place, before, primitive);
    const bool stale = !split_.copies[set].empty() && mesh.contains("extensions") &&
                       mesh["extensions"].contains(kManifold);
    if (stale) {
      mesh["extensions"].erase(kManifold);
      not_kept_.insert(kManifold);
    }
  }

  /// glTF has no set of UVs without those before it: they get the same ones.
  void add_uvs(Json& attributes, std::uint64_t uvs) {
    bool filled = false;
    for (std::uint32_t before = 0; before < uv_set_; ++before) {
      const std::string name = name_of_set(before);
      if (attributes.contains(name)) continue;
      attributes[name] = uvs;
      filled = true;
    }
    attributes[uv_name_] = uvs;
    if (filled) ++filled_;
  }

  /// Textures that were drawn through the UVs that are replaced, and what is to be known of them.
  void edit_textures() {
    std::vector<Item> replaced;
    std::uint32_t free = uv_set_ + 1;
    for (const Primitive& place : model_.primitives) {
      const Item primitive = model_.primitive(place.mesh, place.primitive);
      free = std::max(free, free_set(primitive));
      if (primitive.object("attributes")->find(uv_name_.c_str())) replaced.push_back(primitive);
    }
    const SetUsers users = free_set_of_textures(document_, replaced, uv_set_, json_);
    const std::string elsewhere = "--uv-set " + std::to_string(free) + " leaves it as it is";
    if (baked_.empty() && users.materials > 0) {
      notes_.push_back(textures_that_misfit() + ", which is new now: " + advice_ + ", --uv-set " +
                       std::to_string(free) + " leaves them the old UVs");
    }
    for (const std::string& extension : users.extensions) {
      notes_.push_back(extension + " has textures for " + uv_name_ +
                       ", which is new now: " + elsewhere);
    }
    if (baked_.empty() && users.transforms > 0) {
      not_kept_.insert("KHR_texture_transform of " +
                       counted(users.transforms, "texture", "textures"));
    }
    if (filled_ > 0) {
      notes_.push_back(counted(filled_, "primitive", "primitives") +
                       " had no UVs in the sets before " + uv_name_ +
                       ", which glTF asks for: the new ones are there, too");
    }
  }

  /// Whether a material of a primitive has directions that are said along the new UVs now.
  bool turns_directions(const Item& primitive) const {
    const std::vector<std::uint64_t> own = materials_of(primitive);
    return std::any_of(baked_.begin(), baked_.end(), [&](const BakedTexture& texture) {
      if (texture.use.meaning != Meaning::kDirections) return false;
      return texture.use.material == kEveryMaterial ||
             std::find(own.begin(), own.end(), texture.use.material) != own.end();
    });
  }

  /// "2 textures (normalTexture of materials[0] 'wood', ...) were for TEXCOORD_0".
  std::string textures_that_misfit() const {
    std::vector<std::string> names;
    std::vector<TextureUse> uses;
    try {
      uses = textures_of(model_);
    } catch (const Failure&) {
      return "textures were for " + uv_name_;  // one is not as it should be, which is no hindrance
    }
    for (const TextureUse& use : uses) {
      if (use.uv_set == uv_set_) names.push_back(use.name);
    }
    return counted(names.size(), "texture", "textures") + " (" + listed(names) + ") " +
           (names.size() == 1 ? "was" : "were") + " for " + uv_name_;
  }

  /// Attributes of a primitive, or of a morph target of it.
  void edit_attributes(Json& attributes, bool morph, std::uint32_t set, bool tangents) {
    Json edited = Json::object();
    for (const auto& [name, value] : attributes.items()) {
      if (name == uv_name_) {
        if (morph) not_kept_.insert("morphs of UVs");
      } else if (name == "TANGENT" && !tangents) {
        if (morph || tangents_of_set_[set] == kNone) not_kept_.insert("tangents");
      } else {
        edited[name] = copied(*whole_of(value), set, name == "POSITION");
      }
    }
    attributes = std::move(edited);
  }

  /// The accessor with the copies of vertices behind it.
  std::uint64_t copied(std::uint64_t number, std::uint32_t set, bool positions) {
    const std::vector<std::uint32_t>& copies = split_.copies[set];
    if (copies.empty()) return number;
    const auto [found, is_new] = new_numbers_[set].try_emplace(number, 0);
    if (!is_new) return found->second;
    const Item item = document_.entry("accessors", number);
    const Accessor accessor(document_, number, model_.sets[set].count);
    const bool zeros = !item.find("bufferView") && !item.find("sparse");
    const std::uint64_t size = accessor.element_size(), stride = (size + 3) / 4 * 4;
    NewAccessor made{described(item), {}, stride == size ? 0 : stride, Target::kVertices};
    made.json["count"] = accessor.count() + copies.size();
    if (positions && (!item.find("min") || !item.find("max"))) add_bounds(accessor, made.json);
    if (!zeros) {
      made.bytes.reserve(stride * (accessor.count() + copies.size()));
      const auto append = [&](std::uint64_t i) {
        made.bytes.append(accessor.element(i));
        made.bytes.append(stride - size, '\0');
      };
      for (std::uint64_t i = 0; i < accessor.count(); ++i) append(i);
      for (const std::uint32_t i : copies) append(i);
    }
    return found->second = add(std::move(made));
  }

  /// The accessor's JSON but for where its bytes are.
  static Json described(const Item& accessor) {
    Json json = accessor.json;
    for (const char* key : {"bufferView", "byteOffset", "sparse"}) json.erase(key);
    return json;
  }

  /// glTF asks for the bounds of positions; they are of the numbers as they are stored.
  static void add_bounds(const Accessor& positions, Json& json) {
    for (const bool greatest : {false, true}) {
      Json bound = Json::array();
      for (std::uint64_t k = 0; k < 3; ++k) {
        double found = positions.stored_value(0, k);
        for (std::uint64_t i = 1; i < positions.count(); ++i) {
          const double value = positions.stored_value(i, k);
          found = greatest ? std::max(found, value) : std::min(found, value);
        }
        bound.push_back(found);
      }
      json[greatest ? "max" : "min"] = std::move(bound);
    }
  }

  /// A strip or a fan with a split vertex is none any more: all of them become triangles. What has
  /// no indices would draw the copies of vertices, too, where others that share them were split.
  void edit_indices(const Primitive& place, const Item& before, Json& primitive) {
    const bool strip = before.whole("mode", kTriangles) != kTriangles;
    const std::uint64_t first = 3 * place.first_face, end = first + 3 * place.face_count;
    bool same = !strip && (before.whole("indices") || split_.copies[place.set].empty());
    for (std::uint64_t c = first; same && c < end; ++c) {
      same = split_.corners[c] == model_.local[file_.polygons.corners()[c]];
    }
    if (same || first == end) return;  // points to vertices that kept their places
    primitive["indices"] = indices_of({&place}, before.whole("indices"));
    if (strip) primitive["mode"] = kTriangles;
  }

  /// New indices of the faces of `places`, which have one vertex set; described as `old` was.
  std::uint64_t indices_of(const std::vector<const Primitive*>& places,
                           const std::optional<std::uint64_t>& old) {
    const std::uint32_t set = places.front()->set;
    const std::uint64_t vertices = model_.sets[set].count + split_.copies[set].size();
    Json json = {{"componentType", 0}, {"count", 0}, {"type", "SCALAR"}};
    Component least = Component::kU16;
    if (old) {
      const Item accessor = document_.entry("accessors", *old);
      json = described(accessor);
      for (const char* key : {"min", "max"}) json.erase(key);
      least = static_cast<Component>(accessor.required("componentType"));
    }
    const Component type = index_type(vertices, least);
    json["componentType"] = static_cast<int>(type);
    std::string bytes;
    for (const Primitive* place : places) {
      const std::uint64_t first = 3 * place->first_face, end = first + 3 * place->face_count;
      bytes.reserve(bytes.size() + (end - first) * size_of(type));
      for (std::uint64_t c = first; c < end; ++c) {
        const std::uint32_t vertex = split_.corners[c];
        if (type == Component::kU8) {
          append_little(bytes, static_cast<std::uint8_t>(vertex));
        } else if (type == Component::kU16) {
          append_little(bytes, static_cast<std::uint16_t>(vertex));
        } else {
          append_little(bytes, vertex);
        }
      }
    }
    json["count"] = bytes.size() / size_of(type);
    return add({std::move(json), std::move(bytes), 0, Target::kIndices});
  }

  /// Primitives of a mesh that differ in their indices alone become one.
  void join_primitives() {
    std::vector<std::vector<const Primitive*>> groups;
    std::map<std::string, std::size_t> known;
    for (const Primitive& place : model_.primitives) {
      Json key = json_["meshes"][place.mesh]["primitives"][place.primitive];
      key.erase("indices");
      key["mode"] = {place.mesh, place.set};
      const auto [found, is_new] = known.try_emplace(key.dump(), groups.size());
      if (is_new) groups.emplace_back();
      groups[found->second].push_back(&place);
    }
    std::set<std::pair<std::uint32_t, std::uint32_t>> gone;
    for (const auto& group : groups) {
      if (group.size() == 1) continue;
      const Primitive& first = *group.front();
      Json& primitive = json_["meshes"][first.mesh]["primitives"][first.primitive];
      primitive["indices"] =
          indices_of(group, model_.primitive(first.mesh, first.primitive).whole("indices"));
      primitive.erase("mode");
      for (std::size_t i = 1; i < group.size(); ++i) {
        gone.emplace(group[i]->mesh, group[i]->primitive);
      }
    }
    // From behind, so that the numbers of those before stay.
    for (auto place = gone.rbegin(); place != gone.rend(); ++place) {
      json_["meshes"][place->first]["primitives"].erase(place->second);
    }
  }

  const MeshFile& file_;
  const std::vector<BakedTexture>& baked_;
  const MergePlan* merge_;  ///< or null
  std::string advice_;
  const Model& model_;
  const Document& document_;
  std::uint32_t uv_set_;
  std::string uv_name_;
  Split split_;
  Json json_;
  std::vector<NewAccessor> added_;
  static constexpr std::uint64_t kNone = std::numeric_limits<std::uint64_t>::max();
  std::vector<std::uint64_t> uvs_of_set_;
  std::vector<std::uint64_t> tangents_of_set_;                       ///< or kNone
  std::vector<std::map<std::uint64_t, std::uint64_t>> new_numbers_;  ///< per set, of old accessors
  std::set<std::string> not_kept_;
  std::vector<std::string> notes_;
  std::uint64_t filled_ = 0;  ///< primitives that got sets before the one asked for
};

}  // namespace
}  // namespace gltf

void require_uv_set(const MeshFile& file, std::uint32_t uv_set) {
  const gltf::Model& model = gltf::model_of(file);
  std::uint32_t most = 1;
  for (const gltf::Primitive& place : model.primitives) {
    most = std::max(most, gltf::free_set(model.primitive(place.mesh, place.primitive)));
  }
  if (uv_set <= most) return;
  throw Failure(model.document.path + ": no primitive has " + gltf::name_of_set(most) +
                ", and glTF leaves none out before " + gltf::name_of_set(uv_set) + ": use set " +
                std::to_string(most));
}

std::vector<std::string> gltf_output_paths(const MeshFile& file, const std::string& path) {
  const std::string beside = gltf::buffer_path(gltf::model_of(file).document, path);
  if (beside.empty()) return {path};
  return {beside, path};
}

GltfOutput write_gltf(const MeshFile& file, std::uint32_t uv_set, const std::string& path,
                      const GltfTextures& textures) {
  require_uv_set(file, uv_set);
  const gltf::Document& document = gltf::model_of(file).document;
  gltf::Writer writer(file, uv_set, textures);
  gltf::Buffer buffer = writer.write();
  gltf::Json json = writer.take_json();
  const std::vector<std::string> left = gltf::images_left_behind(document, json, path);
  GltfOutput output;
  for (const BakedTexture& texture : textures.baked) {
    if (!texture.path.empty()) output.files.push_back({texture.path, {texture.png}});
  }
  for (GltfOutput::File& part :
       gltf::files_of(document, std::move(json), std::move(buffer), path)) {
    output.files.push_back(std::move(part));
  }
  output.replaced = gltf::buffers_replaced(document, path);
  output.not_kept = file.not_kept;
  output.not_kept.insert(output.not_kept.end(), writer.not_kept().begin(), writer.not_kept().end());
  output.notes = writer.notes();
  if (!left.empty()) {
    output.not_kept.push_back(gltf::counted(left.size(), "image", "images") +
                              " beside the input (" + gltf::listed(left) + ")");
  }
  return output;
}

}  // namespace beltrami::cli
