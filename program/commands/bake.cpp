#include "commands/bake.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include "commands/bake_call.h"
#include "commands/command.h"
#include "commands/merged_images.h"
#include "files/column.h"
#include "files/gltf/uri.h"
#include "files/gltf_file.h"
#include "files/polygons.h"
#include "picture/stb_in_one_place.h"
#include "picture/webp.h"
#include "process/descriptor.h"
#include "process/failure.h"
#include "process/interrupt.h"

namespace beltrami::cli {
namespace {

namespace fs = std::filesystem;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
/// Texels of the old side for one of the new one from which a note says so: less is not seen.
constexpr double kMuchCoarser = 1.5;
/// A name of a file is no longer, whatever materials are called.
constexpr std::size_t kLongestStem = 100;

/// Letters, digits and a few signs, so that a name of a material cannot lead anywhere.
std::string file_name_of(const std::string& stem) {
  std::string name;
  for (const char c : stem.substr(0, kLongestStem)) {
    const bool good = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                      c == '-' || c == '_';
    name += good ? c : '_';
  }
  return name;
}

/// The format of an image that cannot be read, by its first bytes.
std::string format_of_image(const std::string& bytes) {
  const std::string_view head = std::string_view(bytes).substr(0, 32);
  if (head.starts_with("\xABKTX 20")) return "KTX2";
  if (head.starts_with("\xABKTX 11")) return "KTX";
  if (head.starts_with("RIFF") && head.substr(8).starts_with("WEBP")) {
    return has_webp() ? "a WebP file that is damaged or moves" : "WebP";
  }
  if (head.starts_with("\x76\x2F\x31\x01")) return "OpenEXR";
  if (head.starts_with("DDS ")) return "DDS";
  if (head.starts_with("#?RADIANCE") || head.starts_with("#?RGBE")) return "Radiance HDR";
  if (head.starts_with("GIF8")) return "GIF";
  if (head.starts_with("BM")) return "BMP";
  if (head.starts_with("II*") || head.starts_with("MM")) return "TIFF";
  if (head.substr(std::min<std::size_t>(4, head.size())).starts_with("ftypavif")) return "AVIF";
  if (head.starts_with("\x89PNG") || head.starts_with("\xFF\xD8")) return "a damaged image";
  return "of a format that is not known";
}

[[noreturn]] void refuse_image(const std::string& path, const TextureUse& use,
                               const std::string& bytes) {
  throw Failure(path + ": " + use.image + " (" + use.name + ") is " + format_of_image(bytes) +
                ", and --bake of this program reads PNG" + (has_webp() ? ", WebP" : "") +
                " and JPEG: save it as one of these");
}

std::string one_digit(double value) {
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), "%.1f", value);
  return text.data();
}

std::vector<double> vertex_normals(const MeshFile& file) {
  std::vector<const Column*> columns;
  for (const char* name : {"nx", "ny", "nz"}) {
    const Column* column = find_column(file.vertex_columns, name);
    if (!column) return {};
    columns.push_back(column);
  }
  std::vector<double> values;
  for (std::uint64_t i = 0; i < file.vertex_count(); ++i) {
    for (const Column* column : columns) values.push_back((*column)[i]);
  }
  return values;
}

}  // namespace

struct TextureBake::Places {
  std::vector<std::uint32_t> corners;    ///< three for each triangle, of the file's faces
  std::vector<double> old_uvs, new_uvs;  ///< per corner
};

TextureBake::TextureBake(const MeshFile& file, const std::string& output, bool merges)
    : file_(file) {
  const MeshFormat format = file.gltf ? MeshFormat::kGltf : format_of(file.path);
  if (format == MeshFormat::kObj && format_of(output) == MeshFormat::kObj) {
    libraries_ = std::make_unique<MaterialLibraries>(file, true);
  } else if (format != MeshFormat::kGltf || format_of(output) != MeshFormat::kGltf) {
    throw Failure(
        "--bake: textures are those of materials of OBJ and glTF: write .obj, .gltf or .glb for "
        ".obj, and .gltf or .glb for glTF");
  }
  if (merges) {
    merge_ = gltf_merge(file);
    for (const MergedTexture& merged : merge_->textures) {
      for (const MergedPart& part : merged.parts) {
        if (part.texture) require_image(*part.texture);
      }
      baked_.push_back({merged.use, {}, {}, {}});
    }
  } else {
    list_textures(libraries_ ? libraries_->textures() : gltf_textures(file));
  }
  name_files(output);
  if (!libraries_ || baked_.empty()) return;
  const MeshFile old = read_mesh(file.path, Content::kSomeUvs, file.reach);
  const auto& [values, of_corner] = old.corner_uvs;
  const std::vector<double>& uvs = of_corner.empty() ? old.uvs : values;
  for (const std::size_t uv : of_corner.empty() ? old.polygons.corners() : of_corner) {
    obj_uvs_.insert(obj_uvs_.end(), {uvs[2 * uv], uvs[2 * uv + 1]});
  }
}

void TextureBake::list_textures(std::vector<TextureUse> uses) {
  for (TextureUse& use : uses) {
    std::string path;
    try {
      path = libraries_ ? libraries_->image_path(use) : gltf_image_path(file_, use);
    } catch (const Failure& failure) {
      if (failure.exit_code == kExitCancelled) throw;
      missing_.push_back(std::string(failure.what()) + " (" + use.name +
                         "): its name stays, and nothing is baked for it");
      continue;
    }
    std::error_code ignored;
    if (!path.empty() && !fs::exists(path, ignored)) {
      missing_.push_back(path + " (" + use.name +
                         ") is missing: its name stays, and nothing is baked for it; put the "
                         "image there and bake again");
    } else {
      require_image(use);
      baked_.push_back({std::move(use), {}, {}, {}});
    }
  }
  // A bake of nothing is not what was asked for.
  if (baked_.empty() && !uses.empty()) require_image(uses.front());
}

std::string TextureBake::image_of(const TextureUse& use) const {
  return libraries_ ? read_file(libraries_->image_path(use)) : gltf_image(file_, use);
}

void TextureBake::require_image(const TextureUse& use) const {
  const std::string bytes = image_of(use);
  if (!is_image(bytes)) refuse_image(file_.path, use, bytes);
}

Pixels TextureBake::pixels_of(const TextureUse& use) const {
  const std::string bytes = image_of(use);
  std::optional<Pixels> image = read_image(bytes);
  if (!image) refuse_image(file_.path, use, bytes);
  return *std::move(image);
}

void TextureBake::name_files(const std::string& output) {
  const fs::path base(output);
  if (base.extension().string().size() == 4 && !libraries_) return;  // .glb holds its images
  std::vector<std::string> taken = {file_.path, output};
  const std::vector<std::string> sources = libraries_ ? libraries_->sources() : gltf_sources(file_);
  taken.insert(taken.end(), sources.begin(), sources.end());
  // What the textures are read from must stay until they are written.
  const auto free_path = [&](const std::string& end, const char* extension) {
    for (int number = 0;; ++number) {
      fs::path path = base;
      path.replace_extension();
      std::string name = end;
      if (number > 0) name.append(1, '-').append(std::to_string(number));
      path += name.append(extension);
      const auto same = [&](const std::string& other) { return same_file(other, path.string()); };
      if (std::any_of(taken.begin(), taken.end(), same)) continue;
      taken.push_back(path.string());
      return path.string();
    }
  };
  for (BakedTexture& baked : baked_) {
    baked.path = free_path(std::string("_").append(file_name_of(baked.use.stem)), ".png");
    const std::string name = fs::path(baked.path).filename().string();
    baked.uri = libraries_ ? name : gltf::encode_path(name);
  }
  if (libraries_ && !baked_.empty()) library_path_ = free_path("", ".mtl");
}

std::vector<std::string> TextureBake::paths() const {
  std::vector<std::string> found;
  for (const BakedTexture& baked : baked_) {
    if (!baked.path.empty()) found.push_back(baked.path);
  }
  if (!library_path_.empty()) found.push_back(library_path_);
  return found;
}

void TextureBake::place(const std::vector<std::uint32_t>& triangles) {
  corners_ = triangles;
  // A polygon is cut along its own order: so its triangles have the winding of the file again.
  for (auto first = corners_.begin(); first != corners_.end(); first += 3) {
    std::sort(first, first + 3);
  }
  new_uvs_.clear();
  const auto& [values, of_corner] = file_.corner_uvs;
  for (const std::uint32_t corner : corners_) {
    const std::size_t uv = of_corner[corner];
    new_uvs_.insert(new_uvs_.end(), {values[2 * uv], values[2 * uv + 1]});
  }
}

std::vector<double> TextureBake::old_uvs(std::uint64_t uv_set) const {
  std::vector<double> found;
  found.reserve(2 * corners_.size());
  if (libraries_) {
    for (const std::size_t corner : corners_) {
      found.insert(found.end(), {obj_uvs_[2 * corner], obj_uvs_[2 * corner + 1]});
    }
    return found;
  }
  const std::vector<double> uvs = gltf_uvs(file_, static_cast<std::uint32_t>(uv_set));
  for (const std::uint32_t corner : corners_) {
    const std::size_t vertex = file_.polygons.corners()[corner];
    for (std::size_t k = 0; k < 2; ++k) {
      found.push_back(uvs.empty() ? kNone : uvs[2 * vertex + k]);
    }
  }
  return found;
}

TextureBake::Places TextureBake::places_of(std::uint64_t material, const TextureUse* use) const {
  std::vector<bool> has;
  if (libraries_) {
    for (const std::uint64_t own : libraries_->material_of_faces()) has.push_back(own == material);
  } else {
    has = gltf_faces_of(file_, material);
  }
  const std::vector<double> uvs = use != nullptr ? old_uvs(use->uv_set) : std::vector<double>();
  const auto [a, b, c, d, e, f] = use != nullptr ? use->transform : TextureUse{}.transform;
  Places places;
  for (std::size_t first = 0; first < corners_.size(); first += 3) {
    if (!has[file_.polygons.of_corner(corners_[first])]) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t at = 2 * (first + k);
      // What has no texture shows one texel.
      const double u = uvs.empty() ? 0.5 : uvs[at], v = uvs.empty() ? 0.5 : uvs[at + 1];
      places.corners.push_back(corners_[first + k]);
      places.old_uvs.insert(places.old_uvs.end(), {a * u + b * v + c, d * u + e * v + f});
      places.new_uvs.insert(places.new_uvs.end(), {new_uvs_[at], new_uvs_[at + 1]});
    }
  }
  return places;
}

namespace {

/// Picks `width` numbers for each corner's vertex; empty for none.
std::vector<double> of_corners(const MeshFile& file, const std::vector<double>& of_vertices,
                               const std::vector<std::uint32_t>& corners, std::size_t width) {
  std::vector<double> found;
  if (of_vertices.empty()) return found;
  found.reserve(width * corners.size());
  for (const std::uint32_t corner : corners) {
    const std::size_t vertex = file.polygons.corners()[corner];
    for (std::size_t k = 0; k < width; ++k) found.push_back(of_vertices[width * vertex + k]);
  }
  return found;
}

std::vector<double> normals_of_corners(const MeshFile& file,
                                       const std::vector<std::uint32_t>& corners) {
  const auto& [values, of_corner] = file.normals;
  if (of_corner.empty()) return of_corners(file, vertex_normals(file), corners, 3);
  std::vector<double> found;
  for (const std::uint32_t corner : corners) {
    const std::uint32_t normal = of_corner[corner];
    for (std::size_t k = 0; k < 3; ++k) {
      found.push_back(normal == kNoNormal ? kNone : values[3 * std::size_t{normal} + k]);
    }
  }
  return found;
}

/// What the axes of normals are found by, behind what is there.
void add_axes(const MeshFile& file, const TextureUse* use,
              const std::vector<std::uint32_t>& corners, BakeCall& call) {
  const auto append = [&](std::vector<double>& to, const std::vector<double>& values,
                          std::size_t width) {
    // What only some have is not a number elsewhere.
    if (values.empty() && to.empty()) return;
    to.resize(call.positions.size() / 3 * width - width * corners.size(), kNone);
    to.insert(to.end(), values.begin(), values.end());
    to.resize(call.positions.size() / 3 * width, kNone);
  };
  if (file.gltf) {
    // Viewers find tangents in the coordinates of the mesh itself.
    const auto of_gltf = [&](const char* name, std::size_t width) {
      return of_corners(file, gltf_attribute(file, name, width), corners, width);
    };
    const std::vector<double> positions = of_gltf("POSITION", 3);
    call.positions.insert(call.positions.end(), positions.begin(), positions.end());
    append(call.normals, of_gltf("NORMAL", 3), 3);
    // Those of a file are for the UVs of its normal map as they are, without a transform.
    const bool plain = use != nullptr && use->transform == TextureUse{}.transform;
    append(call.tangents, plain ? of_gltf("TANGENT", 4) : std::vector<double>(), 4);
  } else {
    call.positions = of_corners(file, file.positions, corners, 3);
    append(call.normals, normals_of_corners(file, corners), 3);
  }
}

}  // namespace

BakeCall TextureBake::call_of(TextureUse& use) const {
  BakeCall call;
  Pixels image = pixels_of(use);
  if (use.meaning == Meaning::kRelief) {
    use.meaning = shows_directions(image) ? Meaning::kDirections : Meaning::kNumbers;
  }
  if (image.components < 3 && use.meaning == Meaning::kDirections) {
    use.meaning = Meaning::kNumbers;  // a grey image has no directions
  }
  call.images.push_back(std::move(image));
  call.meaning = use.meaning;
  call.reading = use.reading;
  Places places = places_of(use.material, &use);
  if (call.meaning == Meaning::kDirections) add_axes(file_, &use, places.corners, call);
  call.old_uvs = std::move(places.old_uvs);
  call.new_uvs = std::move(places.new_uvs);
  return call;
}

BakeCall TextureBake::merged_call(const MergedTexture& merged, TextureUse& use) const {
  BakeCall call;
  call.meaning = use.meaning;
  std::vector<MergedImage> images;
  for (const MergedPart& part : merged.parts) {
    const TextureUse* texture = part.texture ? &*part.texture : nullptr;
    Places places = places_of(part.material, texture);
    if (call.meaning == Meaning::kDirections) add_axes(file_, texture, places.corners, call);
    call.new_uvs.insert(call.new_uvs.end(), places.new_uvs.begin(), places.new_uvs.end());
    call.old_pages.insert(call.old_pages.end(), places.new_uvs.size() / 6, images.size());
    MergedImage& image = images.emplace_back();
    image.pixels = texture != nullptr ? pixels_of(*texture) : plain_image(call.meaning);
    if (texture != nullptr) image.reading = texture->reading;
    image.uvs = std::move(places.old_uvs);
    apply_factors(image.pixels, call.meaning, part);
  }
  call.reading = unite(images, file_.path + ": " + use.name);
  use.reading.nearest = call.reading.nearest;
  for (MergedImage& image : images) {
    call.old_uvs.insert(call.old_uvs.end(), image.uvs.begin(), image.uvs.end());
    call.images.push_back(std::move(image.pixels));
  }
  return call;
}

void TextureBake::bake_one(std::size_t number, beltrami_context* context, int side,
                           const BakeProgress& progress, Report& report) {
  BakedTexture& baked = baked_[number];
  BakeCall call = merge_ ? merged_call(merge_->textures[number], baked.use) : call_of(baked.use);
  call.side = side;
  const BakeOutcome outcome = call.run(context, file_.path + ": " + baked.use.name, progress);
  if (2 * outcome.without_source > outcome.texels) {
    throw Failure(file_.path + ": " + baked.use.name +
                  ": most of its texels have no source, since " +
                  "their faces have no UVs in set " + std::to_string(baked.use.uv_set) +
                  ": do without --bake");
  }
  if (outcome.texels == 0) {
    report.notes.push_back(baked.use.name + " covers no texel: raise --resolution");
  }
  coarser_ = std::max(coarser_, outcome.old_texels);
  texels_ += outcome.texels;
  without_source_ += outcome.without_source;
  call.images.clear();
  baked.png = png_bytes(call.pages.front());
}

void TextureBake::run(beltrami_context* context, int side, const BakeProgress& progress,
                      Report& report) {
  for (std::size_t i = 0; i < baked_.size(); ++i) {
    throw_if_interrupted();
    const auto part = [&](double share) { progress((double(i) + share) / double(baked_.size())); };
    part(0);
    bake_one(i, context, side, part, report);
  }
  report.textures = {baked_.size(), texels_, without_source_};
  report.notes.insert(report.notes.end(), missing_.begin(), missing_.end());
  if (merge_ && !merge_->note.empty()) report.notes.push_back(merge_->note);
  if (baked_.empty()) {
    report.notes.emplace_back("no material has a texture, so that --bake has nothing to do");
  } else if (coarser_ > kMuchCoarser) {
    const double wanted = std::exp2(std::ceil(std::log2(side * coarser_ / kMuchCoarser)));
    report.notes.push_back("the textures have fewer texels where the old ones had more, one for " +
                           one_digit(coarser_) + " along a side at most: --resolution " +
                           std::to_string(static_cast<int>(std::min(wanted, 32768.0))) +
                           " keeps them");
  }
}

GltfTextures TextureBake::take_textures() {
  GltfTextures textures;
  textures.baked = std::move(baked_);
  if (merge_) textures.merge = merge_->plan;
  return textures;
}

void TextureBake::write_obj_parts(MeshFile& written, std::deque<AtomicFile>& outputs) const {
  if (!libraries_ || baked_.empty()) return;
  const auto write = [&](const std::string& path, const std::string& bytes) {
    throw_if_interrupted();
    AtomicFile& output = outputs.emplace_back(path);
    output.write(bytes);
    output.close();
  };
  for (const BakedTexture& baked : baked_) write(baked.path, baked.png);
  write(library_path_, libraries_->text(baked_));
  MaterialLibraries::name_library(written, fs::path(library_path_).filename().string());
}

std::string textures_that_misfit(const MeshFile& file) {
  constexpr std::size_t kMostNames = 6;  // more would bury the rest of the line
  const std::vector<TextureUse> uses = MaterialLibraries(file, false).textures();
  if (uses.empty()) return {};
  std::string names;
  for (std::size_t i = 0; i < std::min(uses.size(), kMostNames); ++i) {
    names += (i > 0 ? ", " : "") + uses[i].name;
  }
  if (uses.size() > kMostNames) names += ", ...";
  return std::to_string(uses.size()) + (uses.size() == 1 ? " texture (" : " textures (") + names +
         (uses.size() == 1 ? ") was" : ") were") + " for the UVs of the input";
}

}  // namespace beltrami::cli
