#include "commands/to_gltf.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "commands/mtl_images.h"
#include "files/column.h"
#include "files/gltf/item.h"
#include "files/gltf/little.h"
#include "files/mtl.h"
#include "files/point_numbers.h"
#include "files/polygons.h"
#include "files/texture_use.h"
#include "files/triangulate.h"
#include "picture/stb_in_one_place.h"
#include "process/descriptor.h"
#include "process/failure.h"
#include "process/interrupt.h"

namespace beltrami::cli {
namespace {

using gltf::Json;
using Vector = std::array<double, 3>;

constexpr std::uint64_t kFloat = 5126, kUnsignedInt = 5125;       // types of accessors
constexpr std::uint64_t kArrayBuffer = 34962, kElements = 34963;  // targets of views
constexpr std::uint64_t kClampToEdge = 33071;

/// A document that grows.
struct Document {
  Json json = {{"asset", {{"version", "2.0"}, {"generator", "beltrami"}}},
               {"scene", 0},
               {"scenes", Json::array({{{"nodes", {0}}}})},
               {"nodes", Json::array({{{"mesh", 0}}})},
               {"meshes", Json::array()},
               {"accessors", Json::array()},
               {"bufferViews", Json::array()}};
  std::string buffer;

  std::uint64_t view(const std::string& bytes, std::uint64_t target = 0) {
    buffer.append((4 - buffer.size() % 4) % 4, '\0');
    Json view = {{"buffer", 0}, {"byteOffset", buffer.size()}, {"byteLength", bytes.size()}};
    if (target != 0) view["target"] = target;
    json["bufferViews"].push_back(std::move(view));
    buffer += bytes;
    return json["bufferViews"].size() - 1;
  }

  std::uint64_t accessor(std::uint64_t view, const char* type, std::uint64_t component,
                         std::uint64_t count, std::uint64_t offset = 0) {
    Json accessor = {
        {"bufferView", view}, {"componentType", component}, {"count", count}, {"type", type}};
    if (offset > 0) accessor["byteOffset"] = offset;
    json["accessors"].push_back(std::move(accessor));
    return json["accessors"].size() - 1;
  }

  std::uint64_t numbers(const std::vector<double>& values, const char* type, std::size_t width) {
    std::string bytes;
    for (const double value : values) gltf::append_little(bytes, static_cast<float>(value));
    return accessor(view(bytes, kArrayBuffer), type, kFloat, values.size() / width);
  }

  std::string glb() {
    buffer.append((4 - buffer.size() % 4) % 4, '\0');
    json["buffers"] = Json::array({{{"byteLength", buffer.size()}}});
    std::string text = json.dump();
    text.append((4 - text.size() % 4) % 4, ' ');
    constexpr std::uint64_t kHeads = 12 + 8 + 8;
    const std::uint64_t size = kHeads + text.size() + buffer.size();
    if (size > std::numeric_limits<std::uint32_t>::max()) {
      throw Failure("the mesh takes more than 4 GB as glTF: use the extension .obj or .ply");
    }
    std::string file = "glTF";
    const auto append = [&](std::uint64_t number) {
      gltf::append_little(file, static_cast<std::uint32_t>(number));
    };
    append(2);
    append(size);
    append(text.size());
    file += "JSON" + text;
    append(buffer.size());
    file += std::string("BIN\0", 4) + buffer;
    return file;
  }
};

std::vector<double> numbers_in(std::string_view text) {
  std::vector<double> numbers;
  while (!text.empty()) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error == std::errc() && std::isfinite(value)) numbers.push_back(value);
    text.remove_prefix(std::min(text.find_first_of(" \t"), text.size()));
    text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
  }
  return numbers;
}

double within_unit(double value) {
  return std::clamp(value, 0.0, 1.0);
}

double linear_of(double s) {
  return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

/// Three numbers of a statement, or one for all.
std::optional<Json> colour_of(const MaterialLibraries& libraries, std::uint64_t material,
                              std::string_view keyword) {
  std::vector<double> numbers = numbers_in(libraries.value(material, keyword));
  if (numbers.empty()) return std::nullopt;
  if (numbers.size() < 3) numbers.assign(3, numbers[0]);
  return Json{within_unit(numbers[0]), within_unit(numbers[1]), within_unit(numbers[2])};
}

std::optional<double> number_of(const MaterialLibraries& libraries, std::uint64_t material,
                                std::string_view keyword) {
  const std::vector<double> numbers = numbers_in(libraries.value(material, keyword));
  if (numbers.empty()) return std::nullopt;
  return numbers[0];
}

/// What glTF says of a material, but for its textures.
Json material_of(const MaterialLibraries& libraries, std::uint64_t number) {
  Json pbr = Json::object();
  Json factor = colour_of(libraries, number, "kd").value_or(Json{1.0, 1.0, 1.0});
  double alpha = number_of(libraries, number, "d").value_or(1);
  if (const auto transparent = number_of(libraries, number, "tr"); transparent && alpha >= 1) {
    alpha = 1 - *transparent;
  }
  alpha = within_unit(alpha);
  factor.push_back(alpha);
  pbr["baseColorFactor"] = std::move(factor);
  pbr["metallicFactor"] = within_unit(number_of(libraries, number, "pm").value_or(0));
  double roughness = 1;
  // The exponent of Blinn and Phong of about the same width (Walter et al. 2007).
  if (const auto shine = number_of(libraries, number, "ns")) {
    roughness = std::sqrt(2 / (std::max(*shine, 0.0) + 2));
  }
  if (const auto given = number_of(libraries, number, "pr")) roughness = *given;
  pbr["roughnessFactor"] = within_unit(roughness);
  Json material = {{"name", libraries.name(number)}, {"pbrMetallicRoughness", std::move(pbr)}};
  const Json black = {0.0, 0.0, 0.0};
  if (const auto light = colour_of(libraries, number, "ke"); light && *light != black) {
    material["emissiveFactor"] = *light;
  }
  if (alpha < 1) material["alphaMode"] = "BLEND";
  return material;
}

/// From a mesh to the document.
class ToGltf {
 public:
  ToGltf(const MeshFile& mesh, const MeshFile* with_uvs) : mesh_(mesh), with_uvs_(with_uvs) {}

  std::string run() {
    corners_ = triangle_corners(mesh_);
    material_of_face_.assign(mesh_.polygons.size(), kNoMaterial);
    if (format_of(mesh_.path) == MeshFormat::kObj) add_materials();
    add_vertices();
    add_primitives();
    note_rest();
    return document_.glb();
  }

  std::vector<std::string> take_not_kept() { return std::move(not_kept_); }
  std::vector<std::uint64_t> take_polygons() { return std::move(polygons_); }

 private:
  static constexpr std::uint64_t kNoMaterial = std::numeric_limits<std::uint64_t>::max();

  void add_materials() {
    const MaterialLibraries libraries(mesh_, false);
    for (const std::string& what : libraries.unread())
      not_kept_.push_back("materials (" + what + ")");
    const std::vector<std::uint64_t> of_face = libraries.material_of_faces();
    std::vector<std::uint64_t> number(libraries.count(), kNoMaterial);
    for (const std::uint64_t material : of_face) {
      if (material != MaterialLibraries::kNone) number[material] = 0;
    }
    Json materials = Json::array();
    for (std::uint64_t i = 0; i < libraries.count(); ++i) {
      if (number[i] == kNoMaterial) continue;
      number[i] = materials.size();
      materials.push_back(material_of(libraries, i));
    }
    if (materials.empty()) return;
    document_.json["materials"] = std::move(materials);
    for (std::size_t f = 0; f < of_face.size(); ++f) {
      if (of_face[f] != MaterialLibraries::kNone) material_of_face_[f] = number[of_face[f]];
    }
    for (std::uint64_t i = 0; i < libraries.count(); ++i) {
      if (number[i] != kNoMaterial) add_textures(libraries, libraries.textures_of(i), number[i]);
    }
  }

  /// A map of a material that can be read.
  struct Map {
    const TextureUse* use;
    std::string bytes;
  };

  void add_textures(const MaterialLibraries& libraries, const std::vector<TextureUse>& uses,
                    std::uint64_t material) {
    std::vector<Map> maps;
    for (const TextureUse& use : uses) {
      std::string bytes;
      try {
        bytes = read_file(libraries.image_path(use));
      } catch (const Failure& failure) {
        if (failure.exit_code == kExitCancelled) throw;
      }
      if (with_uvs_ != nullptr && is_image(bytes)) {
        maps.push_back({&use, std::move(bytes)});
      } else {
        not_kept_.push_back(use.name);
      }
    }
    const std::vector<const TextureUse*> packed = add_packed(maps, material);
    for (const Map& map : maps) {
      if (std::find(packed.begin(), packed.end(), map.use) == packed.end() &&
          !add_texture(map, material)) {
        not_kept_.push_back(map.use->name);
      }
    }
  }

  /// Maps that glTF has in channels of one image. Returns those that became part of one.
  std::vector<const TextureUse*> add_packed(const std::vector<Map>& maps, std::uint64_t material) {
    std::vector<const TextureUse*> done;
    const auto find = [&](const char* keyword, const TextureUse* like) -> const Map* {
      for (const Map& map : maps) {
        if (map.use->keyword != keyword) continue;
        const bool alike = like == nullptr || (map.use->transform == like->transform &&
                                               map.use->reading.along_u == like->reading.along_u);
        if (alike) return &map;
      }
      return nullptr;
    };
    const auto channel = [&](const Map* map, bool matte) -> std::optional<Pixels> {
      const std::optional<Pixels> image = map != nullptr ? read_image(map->bytes) : std::nullopt;
      if (!image) return std::nullopt;
      done.push_back(map->use);
      return channel_of(*image, map->use->channel, matte);
    };
    const auto pbr = [&]() -> Json& {
      return document_.json["materials"][material]["pbrMetallicRoughness"];
    };
    const auto put = [&](const char* place, const Map* map, const Pixels& image) {
      Json info = texture_info(*map->use, png_bytes(image));
      pbr()[place] = std::move(info);
    };
    const Map* rough = find("map_pr", nullptr);
    const Map* metal = find("map_pm", rough != nullptr ? rough->use : nullptr);
    const auto roughness = channel(rough, false), metalness = channel(metal, false);
    if (roughness || metalness) {
      put("metallicRoughnessTexture", roughness ? rough : metal,
          roughness_and_metal(roughness, metalness));
      // As for colours, what is beside a picture is of no account.
      if (roughness) pbr()["roughnessFactor"] = 1.0;
      if (metalness) pbr()["metallicFactor"] = 1.0;
    }
    const Map* opacity = find("map_d", nullptr);
    const auto alpha = channel(opacity, true);
    if (!alpha) return done;
    const Map* base = find("map_kd", opacity->use);
    const std::optional<Pixels> colour = base != nullptr ? read_image(base->bytes) : std::nullopt;
    put("baseColorTexture", opacity, colour_and_alpha(colour, *alpha));
    if (colour) {
      done.push_back(base->use);
      for (std::size_t k = 0; k < 3; ++k) pbr()["baseColorFactor"][k] = 1.0;
    }
    pbr()["baseColorFactor"][3] = 1.0;
    document_.json["materials"][material]["alphaMode"] = is_cut_out(*alpha) ? "MASK" : "BLEND";
    return done;
  }

  bool add_texture(const Map& map, std::uint64_t material) {
    const TextureUse* const use = map.use;
    const std::string& bytes = map.bytes;
    // Found anew at each use: what is added to the document moves its parts.
    const auto own = [&]() -> Json& { return document_.json["materials"][material]; };
    const auto pbr = [&]() -> Json& { return own()["pbrMetallicRoughness"]; };
    const auto add = [&](const auto& place, const char* slot) {
      if (place().contains(slot)) return false;
      Json info = texture_info(*use, bytes);
      place()[slot] = std::move(info);
      return true;
    };
    if (use->keyword == "map_kd") {
      if (!add(pbr, "baseColorTexture")) return false;
      // Exporters leave any colour beside a picture, and viewers of OBJ show the picture alone.
      for (std::size_t k = 0; k < 3; ++k) pbr()["baseColorFactor"][k] = 1.0;
      return true;
    }
    if (use->keyword == "map_ke") {
      if (!add(own, "emissiveTexture")) return false;
      own()["emissiveFactor"] = {1.0, 1.0, 1.0};
      return true;
    }
    if (use->meaning == Meaning::kDirections) return add(own, "normalTexture");
    if (use->meaning != Meaning::kRelief) return false;
    const std::optional<Pixels> image = read_image(bytes);
    return image && shows_directions(*image) && add(own, "normalTexture");
  }

  Json texture_info(const TextureUse& use, const std::string& bytes) {
    Json& json = document_.json;
    const bool png = bytes.starts_with("\x89PNG"), jpeg = bytes.starts_with("\xFF\xD8");
    // glTF itself has these two alone.
    if (!png && !jpeg) return texture_info(use, png_bytes(*read_image(bytes)));
    json["images"].push_back({{"name", use.stem},
                              {"mimeType", png ? "image/png" : "image/jpeg"},
                              {"bufferView", document_.view(bytes)}});
    Json sampler = {{"magFilter", 9729}, {"minFilter", 9987}};
    if (use.reading.along_u == Beyond::kClamp) {
      sampler["wrapS"] = sampler["wrapT"] = kClampToEdge;
    }
    json["samplers"].push_back(std::move(sampler));
    const std::uint64_t number = json["images"].size() - 1;
    json["textures"].push_back({{"sampler", number}, {"source", number}});
    Json info = {{"index", number}};
    if (use.transform == TextureUse{}.transform) return info;
    // The V axis of glTF points down.
    const auto& t = use.transform;
    info["extensions"]["KHR_texture_transform"] = {{"offset", {t[2], 1 - t[4] - t[5]}},
                                                   {"scale", {t[0], t[4]}}};
    json["extensionsUsed"] = {"KHR_texture_transform"};
    return info;
  }

  /// The normal of a corner, of length 1; that of its triangle where it has none.
  Vector normal_at(std::size_t at) const {
    const std::uint32_t corner = corners_[at];
    Vector normal{};
    if (!mesh_.normals.of_corner.empty()) {
      const std::uint32_t number = mesh_.normals.of_corner[corner];
      if (number != kNoNormal) {
        for (std::size_t d = 0; d < 3; ++d)
          normal[d] = mesh_.normals.values[3 * std::size_t{number} + d];
      }
    } else {
      for (std::size_t d = 0; d < 3; ++d)
        normal[d] = (*normals_[d])[mesh_.polygons.corners()[corner]];
    }
    const auto has_length = [](const Vector& v) {
      const double square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
      return square > 0 && std::isfinite(square);
    };
    if (!has_length(normal)) {
      std::array<const double*, 3> p{};
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t vertex = mesh_.polygons.corners()[corners_[at - at % 3 + k]];
        p[k] = &mesh_.positions[3 * vertex];
      }
      for (std::size_t d = 0; d < 3; ++d) {
        const std::size_t e = (d + 1) % 3, f = (d + 2) % 3;
        normal[d] =
            (p[1][e] - p[0][e]) * (p[2][f] - p[0][f]) - (p[1][f] - p[0][f]) * (p[2][e] - p[0][e]);
      }
    }
    if (!has_length(normal)) return {0, 0, 1};
    const double length = std::hypot(normal[0], normal[1], normal[2]);
    return {normal[0] / length, normal[1] / length, normal[2] / length};
  }

  std::array<double, 2> uv_at(std::uint32_t corner) const {
    const auto& [values, of_corner] = with_uvs_->corner_uvs;
    const bool per_vertex = of_corner.empty();
    const std::size_t at = per_vertex ? with_uvs_->polygons.corners()[corner] : of_corner[corner];
    const std::vector<double>& uvs = per_vertex ? with_uvs_->uvs : values;
    // In glTF faces have UVs or none together: those without any here have the same.
    if (std::isnan(uvs[2 * at])) return {};
    return {uvs[2 * at], 1 - uvs[2 * at + 1]};
  }

  /// Vertices with one normal and one UV each, of all primitives.
  void add_vertices() {
    for (const char* name : {"nx", "ny", "nz"}) {
      normals_.push_back(find_column(mesh_.vertex_columns, name));
    }
    const bool has_normals = !mesh_.normals.of_corner.empty() ||
                             std::find(normals_.begin(), normals_.end(), nullptr) == normals_.end();
    PointNumbers<6> numbers;  // vertex, normal, UV
    std::vector<double> positions, normals, uvs;
    std::vector<std::uint64_t> vertices;
    for (std::size_t at = 0; at < corners_.size(); ++at) {
      if (at % 3 == 0) throw_if_interrupted();
      const std::uint32_t vertex = mesh_.polygons.corners()[corners_[at]];
      const Vector normal = has_normals ? normal_at(at) : Vector{};
      const auto uv = with_uvs_ != nullptr ? uv_at(corners_[at]) : std::array<double, 2>{};
      const std::uint32_t number =
          numbers.number({double(vertex), normal[0], normal[1], normal[2], uv[0], uv[1]});
      index_.push_back(number);
      if (number < vertices.size()) continue;
      vertices.push_back(vertex);
      for (std::size_t d = 0; d < 3; ++d) {
        positions.push_back(position(vertex, d));
        normals.push_back(normal[d]);
      }
      uvs.insert(uvs.end(), uv.begin(), uv.end());
    }
    attributes_["POSITION"] = document_.numbers(positions, "VEC3", 3);
    add_bounds(positions);
    if (has_normals) attributes_["NORMAL"] = document_.numbers(normals, "VEC3", 3);
    if (with_uvs_ != nullptr) attributes_["TEXCOORD_0"] = document_.numbers(uvs, "VEC2", 2);
    add_colours(vertices);
  }

  double position(std::uint32_t vertex, std::size_t d) const {
    const auto value = static_cast<float>(mesh_.positions[3 * std::size_t{vertex} + d]);
    if (!std::isfinite(value)) {
      throw Failure(mesh_.path + ": vertex " + std::to_string(vertex) +
                    " has a coordinate that single precision does not hold, which glTF has: use "
                    "the extension .obj or .ply");
    }
    return value;
  }

  void add_bounds(const std::vector<double>& positions) {
    Vector low{}, high{};
    for (std::size_t i = 0; i < positions.size(); ++i) {
      low[i % 3] = i < 3 ? positions[i] : std::min(low[i % 3], positions[i]);
      high[i % 3] = i < 3 ? positions[i] : std::max(high[i % 3], positions[i]);
    }
    Json& accessor = document_.json["accessors"].back();
    accessor["min"] = low;
    accessor["max"] = high;
  }

  /// Colours are of sRGB in all formats but glTF.
  void add_colours(const std::vector<std::uint64_t>& vertices) {
    std::vector<const Column*> columns;
    for (const char* name : {"red", "green", "blue"}) {
      columns.push_back(find_column(mesh_.vertex_columns, name));
      if (columns.back() == nullptr) return;
      if (columns.back()->type() != Scalar::kU8 && !mesh_.unit_colours) return;
    }
    const double most = mesh_.unit_colours ? 1 : 255;
    std::vector<double> colours;
    for (const std::uint64_t vertex : vertices) {
      for (const Column* column : columns) {
        const double value = (*column)[vertex] / most;
        colours.push_back(std::isfinite(value) ? linear_of(within_unit(value)) : 0);
      }
    }
    attributes_["COLOR_0"] = document_.numbers(colours, "VEC3", 3);
    has_colours_ = true;
  }

  void add_primitives() {
    const std::uint64_t materials =
        document_.json.contains("materials") ? document_.json["materials"].size() : 0;
    std::vector<std::string> indices(materials + 1);
    std::vector<std::vector<std::uint64_t>> polygons(materials + 1);
    for (std::size_t at = 0; at < corners_.size(); ++at) {
      const std::uint64_t polygon = mesh_.polygons.of_corner(corners_[at]);
      const std::uint64_t place = std::min(material_of_face_[polygon], materials);
      gltf::append_little(indices[place], index_[at]);
      if (at % 3 == 0) polygons[place].push_back(polygon);
    }
    for (const auto& own : polygons) polygons_.insert(polygons_.end(), own.begin(), own.end());
    Json primitives = Json::array();
    for (std::uint64_t i = 0; i <= materials; ++i) {
      if (indices[i].empty()) continue;
      Json primitive = {
          {"attributes", attributes_},
          {"indices", document_.accessor(document_.view(indices[i], kElements), "SCALAR",
                                         kUnsignedInt, indices[i].size() / 4)}};
      if (i < materials) primitive["material"] = i;
      primitives.push_back(std::move(primitive));
    }
    document_.json["meshes"].push_back({{"primitives", std::move(primitives)}});
  }

  void note_rest() {
    if (!mesh_.polygons.all_triangles()) not_kept_.emplace_back("polygons");
    for (const Column& column : mesh_.vertex_columns) {
      const std::string& name = column.name();
      const bool kept = name == "nx" || name == "ny" || name == "nz" ||
                        (has_colours_ && (name == "red" || name == "green" || name == "blue"));
      if (!kept) not_kept_.push_back("vertex property " + one_line(name));
    }
    for (const Column& column : mesh_.face_columns) {
      not_kept_.push_back("face property " + one_line(column.name()));
    }
    for (const Table& table : mesh_.tables) {
      not_kept_.push_back("element " + one_line(table.name));
    }
    const auto is_group = [](const Statement& statement) {
      return !statement.text.starts_with("usemtl") && !statement.text.starts_with("mtllib");
    };
    if (std::any_of(mesh_.statements.begin(), mesh_.statements.end(), is_group)) {
      not_kept_.emplace_back("groups");
    }
    if (!mesh_.comments.empty()) not_kept_.emplace_back("comments");
  }

  const MeshFile& mesh_;
  const MeshFile* with_uvs_;  ///< the same faces, or null
  Document document_;
  std::vector<std::uint32_t> corners_, index_;   ///< of triangles
  std::vector<std::uint64_t> material_of_face_;  ///< in the document
  std::vector<std::uint64_t> polygons_;          ///< of its triangles
  std::vector<const Column*> normals_;           ///< of vertices
  Json attributes_ = Json::object();
  bool has_colours_ = false;
  std::vector<std::string> not_kept_;
};

}  // namespace

AsGltf as_gltf(const MeshFile& mesh, Content content) {
  std::optional<MeshFile> with_uvs;
  const bool has_uvs = !mesh.uvs.empty() || !mesh.corner_uvs.values.empty();
  if (!has_uvs && format_of(mesh.path) == MeshFormat::kObj &&
      !MaterialLibraries(mesh, false).textures().empty()) {
    try {
      with_uvs = read_mesh(mesh.path, Content::kSomeUvs, mesh.reach);
    } catch (const Failure& failure) {
      if (failure.exit_code == kExitCancelled) throw;  // else it has no UVs
    }
  }
  const MeshFile* uvs = has_uvs ? &mesh : with_uvs ? &*with_uvs : nullptr;
  ToGltf conversion(mesh, uvs);
  MeshFile file = read_gltf(conversion.run(), mesh.path, content, mesh.reach);
  file.path = mesh.path;
  file.reach = mesh.reach;
  file.welded_corners = mesh.welded_corners;
  file.short_faces = mesh.short_faces;
  file.truncated = mesh.truncated;
  file.not_kept = mesh.not_kept;
  for (std::string& what : conversion.take_not_kept()) file.not_kept.push_back(std::move(what));
  return {std::move(file), conversion.take_polygons()};
}

}  // namespace beltrami::cli
