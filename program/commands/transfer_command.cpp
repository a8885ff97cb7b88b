// beltrami transfer: bake a texture of an old layout of UVs for a new one, of the same mesh or of
// another of the same shape.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <deque>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "commands/bake_call.h"
#include "commands/command.h"
#include "commands/detail.h"
#include "commands/pages.h"
#include "commands/report.h"
#include "commands/spelling.h"
#include "commands/tiles.h"
#include "files/atomic_file.h"
#include "files/mesh_file.h"
#include "files/polygons.h"
#include "files/texture_use.h"
#include "files/triangulate.h"
#include "picture/light.h"
#include "picture/stb_in_one_place.h"
#include "picture/webp.h"
#include "process/descriptor.h"
#include "process/failure.h"
#include "process/interrupt.h"

namespace beltrami::cli {
namespace {

using Uv = std::array<double, 2>;
using TriangleUvs = std::array<Uv, 3>;
using SpacePoint = std::array<double, 3>;

constexpr std::uint64_t kNoPage = BakeCall::kNoPage;

/// Of the size of OLD: how far corners of the same face may be apart, as single precision and a few
/// digits of a text leave them.
constexpr double kSame = 1e-5;

Uv uv_of_corner(const MeshFile& file, std::uint32_t corner) {
  const auto& [values, of_corner] = file.corner_uvs;
  const bool per_vertex = of_corner.empty();
  const std::size_t at = per_vertex ? file.polygons.corners()[corner] : of_corner[corner];
  const std::vector<double>& uvs = per_vertex ? file.uvs : values;
  return {uvs[2 * at], uvs[2 * at + 1]};
}

/// The tile of the plane that a triangle is in, by its centre: what is on an edge as a whole is in
/// the tile below. Nothing where a UV is not finite.
std::optional<Uv> tile_of(const TriangleUvs& uvs) {
  Uv tile{};
  for (std::size_t k = 0; k < 2; ++k) {
    tile[k] = std::floor((uvs[0][k] + uvs[1][k] + uvs[2][k]) / 3);
    if (!std::isfinite(tile[k])) return std::nullopt;
    const bool on_edge = std::max({uvs[0][k], uvs[1][k], uvs[2][k]}) == tile[k];
    if (on_edge && tile[k] > 0) tile[k] -= 1;
  }
  return tile;
}

bool is_page(const Uv& tile) {
  return tile[0] >= 0 && tile[0] < double(kPagesInARow) && tile[1] >= 0 &&
         tile[1] < double(kMostRowsOfPages);
}

Pixels read_texture(const std::string& path) {
  if (is_gltf_name(path)) {
    throw Failure(path + ": textures are read from files of their own: save it as .png or .jpg");
  }
  const std::string bytes = read_file(path);
  std::optional<Pixels> image = read_image(bytes);
  if (!image) image = read_light(bytes);
  if (image) return *std::move(image);
  std::string formats = "PNG, JPEG";
  if (has_webp()) formats += ", WebP";
  if (has_exr()) formats += ", EXR";
  throw Failure(path + ": is no " + formats + " or HDR file that can be read");
}

/// Throws Failure where a picture has another format than its texture can be written in.
void require_output(const std::string& path, bool light) {
  const LightFormat format = light_format_of(path);
  if (!light) return require_png_name(path);
  if (format == LightFormat::kNone) {
    throw Failure(path + ": the texture is in single precision: use the extension .exr or .hdr");
  }
  if (format == LightFormat::kExr && !has_exr()) {
    throw Failure(path + ": this program is built without OpenEXR: use the extension .hdr");
  }
}

/// The triangles of a mesh: where they are in space, and on the pages of a texture.
struct Textured {
  std::vector<SpacePoint> places;    ///< of the corners
  std::vector<TriangleUvs> uvs;      ///< on their pages
  std::vector<std::uint64_t> pages;  ///< kNoPage for a triangle that no texture is on
  bool tiled = false;                ///< a triangle is in another tile of the plane than [0,1]^2
};

/// With all triangles on page 0, and their UVs as they are.
Textured textured(const MeshFile& file, const std::vector<std::uint32_t>& corners) {
  Textured mesh;
  for (std::size_t first = 0; first < corners.size(); first += 3) {
    TriangleUvs& uvs = mesh.uvs.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t vertex = file.polygons.corners()[corners[first + k]];
      const double* place = &file.positions[3 * vertex];
      mesh.places.push_back({place[0], place[1], place[2]});
      uvs[k] = uv_of_corner(file, corners[first + k]);
    }
    const std::optional<Uv> tile = tile_of(uvs);
    mesh.tiled = mesh.tiled || (tile && *tile != Uv{0, 0});
    mesh.pages.push_back(tile ? 0 : kNoPage);
  }
  return mesh;
}

/// Puts triangles on the pages that the tiles of UDIM are. Throws Failure, with `advice`, where one
/// is beside them.
void part_into_pages(Textured& mesh, const std::string& path, const std::string& advice) {
  for (std::size_t t = 0; t < mesh.uvs.size(); ++t) {
    if (mesh.pages[t] == kNoPage) continue;
    const Uv tile = *tile_of(mesh.uvs[t]);
    if (!is_page(tile)) {
      throw Failure(path + ": a face has its UVs beside [0,1]^2 and the tiles of UDIM: " + advice);
    }
    for (Uv& uv : mesh.uvs[t]) {
      for (std::size_t k = 0; k < 2; ++k) uv[k] -= tile[k];
    }
    mesh.pages[t] =
        static_cast<std::uint64_t>(tile[0]) + kPagesInARow * static_cast<std::uint64_t>(tile[1]);
  }
}

/// Those that have a triangle, ascending.
std::vector<std::uint64_t> pages_in_use(const Textured& mesh) {
  std::vector<std::uint64_t> pages = mesh.pages;
  std::sort(pages.begin(), pages.end());
  pages.erase(std::unique(pages.begin(), pages.end()), pages.end());
  if (!pages.empty() && pages.back() == kNoPage) pages.pop_back();
  return pages;
}

bool exists(const std::string& path) {
  std::error_code ignored;
  return std::filesystem::exists(path, ignored);
}

bool same_polygons(const MeshFile& from, const MeshFile& to) {
  bool same = from.polygons.size() == to.polygons.size() &&
              from.polygons.corners().size() == to.polygons.corners().size();
  for (std::uint64_t i = 0; same && i < to.polygons.size(); ++i) {
    same = from.polygons.end(i) == to.polygons.end(i);
  }
  return same;
}

/// Whether vertices join faces: where each corner has its own, their numbers say nothing.
bool joins_faces(const MeshFile& file) {
  return file.vertex_count() < file.polygons.corners().size();
}

bool same_places(const MeshFile& from, const MeshFile& to, double tolerance) {
  const auto& of_from = from.polygons.corners();
  const auto& of_to = to.polygons.corners();
  for (std::size_t i = 0; i < of_to.size(); ++i) {
    for (std::size_t d = 0; d < 3; ++d) {
      const double apart = from.positions[3 * std::size_t{of_from[i]} + d] -
                           to.positions[3 * std::size_t{of_to[i]} + d];
      if (!(std::abs(apart) <= tolerance)) return false;
    }
  }
  return true;
}

std::string format_number(double value) {
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), "%.6g", value);
  return text.data();
}

/// The diagonal of the box around a mesh.
double size_of(const Textured& mesh) {
  SpacePoint low = mesh.places.empty() ? SpacePoint{} : mesh.places.front(), high = low;
  for (const SpacePoint& place : mesh.places) {
    for (std::size_t d = 0; d < 3; ++d) {
      low[d] = std::min(low[d], place[d]);
      high[d] = std::max(high[d], place[d]);
    }
  }
  return std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
}

/// x y z of each corner.
std::vector<double> numbers_of(const std::vector<SpacePoint>& places) {
  std::vector<double> numbers;
  numbers.reserve(3 * places.size());
  for (const SpacePoint& place : places) numbers.insert(numbers.end(), place.begin(), place.end());
  return numbers;
}

std::vector<double> numbers_of(const std::vector<TriangleUvs>& triangles) {
  std::vector<double> numbers;
  numbers.reserve(6 * triangles.size());
  for (const TriangleUvs& uvs : triangles) {
    for (const Uv& uv : uvs) numbers.insert(numbers.end(), uv.begin(), uv.end());
  }
  return numbers;
}

/// u v of the corners of some triangles.
std::vector<double> picked(const std::vector<TriangleUvs>& uvs,
                           const std::vector<std::size_t>& triangles) {
  std::vector<TriangleUvs> some;
  for (const std::size_t t : triangles) some.push_back(uvs[t]);
  return numbers_of(some);
}

/// x y z of the corners of some triangles.
std::vector<double> picked(const std::vector<SpacePoint>& places,
                           const std::vector<std::size_t>& triangles) {
  std::vector<SpacePoint> some;
  for (const std::size_t t : triangles) {
    for (std::size_t k = 0; k < 3 && !places.empty(); ++k) some.push_back(places[3 * t + k]);
  }
  return numbers_of(some);
}

class Transfer {
 public:
  explicit Transfer(const TransferArguments& arguments) : arguments_(arguments) {}

  int run() {
    require_distinct({arguments_.old_mesh, arguments_.texture, arguments_.output});
    require_distinct({arguments_.new_mesh, arguments_.texture, arguments_.output});
    const std::optional<Detail> detail = detail_named(arguments_.texture);
    if (arguments_.rays > 0 && detail != Detail::kOcclusion) {
      throw Failure("--rays are for 'occlusion' alone: leave them out");
    }
    if (detail) return run_detail(*detail);
    if (!exists(arguments_.texture)) {
      const std::string meant =
          nearest_spelling(arguments_.texture, {"normals", "heights", "occlusion"});
      if (!meant.empty()) {
        throw Failure(arguments_.texture + ": there is no such file: '" + meant +
                      "' bakes what OLD itself has");
      }
    }
    if (light_format_of(arguments_.output) == LightFormat::kNone) {
      require_png_name(arguments_.output);
    }
    read_triangles();
    part_into_pages(to_, arguments_.new_mesh, "pack it first");
    find_pages();
    if (shows_tiles()) {
      part_into_pages(from_, arguments_.old_mesh,
                      "a texture that repeats is read with --wrap repeat");
    }
    read_pages();
    return write_pages();
  }

 private:
  void read_triangles() {
    const MeshFile from = read_mesh(arguments_.old_mesh, Content::kUvs, arguments_.reach);
    const MeshFile to = read_mesh(arguments_.new_mesh, Content::kUvs, arguments_.reach);
    const std::vector<std::uint32_t> corners = triangle_corners(to);
    to_ = textured(to, corners);
    // Who gives a cage wants what is seen from there, whatever the faces are.
    if (arguments_.cage > 0) {
      const std::vector<double> normals = smooth_normals(numbers_of(to_.places));
      for (std::size_t i = 0; i < normals.size(); i += 3) {
        ray_normals_.push_back({normals[i], normals[i + 1], normals[i + 2]});
      }
    } else if (same_polygons(from, to)) {
      const bool same_vertices =
          joins_faces(to) && from.polygons.corners() == to.polygons.corners();
      from_ = textured(from, corners);
      if (same_vertices || same_places(from, to, kSame * size_of(from_))) return;
    }
    from_ = textured(from, triangle_corners(from));
    elsewhere_ = true;
  }

  /// Whether UVs of OLD beyond [0,1]^2 are on other pages, and not on the one texture again.
  bool shows_tiles() const {
    if (arguments_.wrap != "auto") return arguments_.wrap == "tiles";
    if (!from_.tiled) return false;
    for (const TriangleUvs& uvs : from_.uvs) {
      const std::optional<Uv> tile = tile_of(uvs);
      if (!tile || !is_page(*tile) || *tile == Uv{0, 0}) continue;
      const auto page = static_cast<std::uint64_t>((*tile)[0] + double(kPagesInARow) * (*tile)[1]);
      if (exists(texture_of_page(arguments_.texture, page))) return true;
    }
    return false;
  }

  Reading reading() const {
    if (arguments_.wrap == "mirror") return {Beyond::kMirror, Beyond::kMirror};
    const bool repeats = arguments_.wrap == "repeat" || (arguments_.wrap == "auto" && repeats_);
    const Beyond beyond = repeats ? Beyond::kRepeat : Beyond::kClamp;
    return {beyond, beyond};
  }

  /// The texture of each page that is read.
  void read_pages() {
    const std::vector<std::uint64_t> pages = pages_in_use(from_);
    if (pages.empty()) throw Failure(arguments_.old_mesh + ": no face has UVs that are numbers");
    repeats_ = pages.back() == 0 && from_.tiled;
    textures_.resize(pages.back() + 1);
    for (const std::uint64_t page : pages) {
      const bool first = pages.size() == 1 && page == 0;
      const std::string path =
          first ? arguments_.texture : texture_of_page(arguments_.texture, page);
      // The first of several pages may have no number.
      const bool unnumbered = page == 0 && !exists(path) && exists(arguments_.texture);
      if (!first && !unnumbered && !exists(path)) {
        throw Failure(path + ": is not there, and faces of " + arguments_.old_mesh +
                      " are on that tile: a texture that repeats is read with --wrap repeat");
      }
      Pixels texture = read_texture(unnumbered ? arguments_.texture : path);
      const Pixels& known = textures_[pages.front()];
      if (page != pages.front() &&
          (texture.components != known.components || texture.bytes != known.bytes)) {
        throw Failure(path + ": has other components or bits than the pages before it");
      }
      side_ = std::max({side_, texture.width, texture.height});
      textures_[page] = std::move(texture);
    }
    if (arguments_.resolution > 0) side_ = arguments_.resolution;
  }

  int write_pages() {
    const Pixels& known = textures_[pages_in_use(from_).front()];
    const bool light = known.bytes == sizeof(float);
    const LightFormat format = light_format_of(arguments_.output);
    require_output(arguments_.output, light);
    if (format == LightFormat::kHdr && known.components != 3) {
      throw Failure(arguments_.output + ": HDR has three components, and the texture has " +
                    std::to_string(known.components) + ": use the extension .exr");
    }
    for (const std::uint64_t page : pages_) {
      BakeCall call = call_of(triangles_of(page));
      call.images = std::move(textures_);
      call.reading = reading();
      call.gutter = static_cast<std::uint64_t>(arguments_.margin);
      add(call.run(context_.get(), arguments_.new_mesh, {}));
      textures_ = std::move(call.images);
      const Pixels& made = call.pages.front();
      write_page(page, light ? light_bytes(made, format) : png_bytes(made));
    }
    return finish("");
  }

  /// Of triangles of NEW, without images.
  BakeCall call_of(const std::vector<std::size_t>& triangles) const {
    BakeCall call;
    call.side = side_;
    call.new_uvs = picked(to_.uvs, triangles);
    if (!elsewhere_) {
      call.old_uvs = picked(from_.uvs, triangles);
      for (const std::size_t t : triangles) call.old_pages.push_back(from_.pages[t]);
      return call;
    }
    call.old_uvs = numbers_of(from_.uvs);
    call.old_pages = from_.pages;
    call.positions = picked(to_.places, triangles);
    call.source_positions = numbers_of(from_.places);
    call.cage = arguments_.cage;
    call.normals = picked(ray_normals_, triangles);
    return call;
  }

  std::vector<std::size_t> triangles_of(std::uint64_t page) const {
    std::vector<std::size_t> found;
    for (std::size_t t = 0; t < to_.pages.size(); ++t) {
      if (to_.pages[t] == page) found.push_back(t);
    }
    return found;
  }

  void add(const BakeOutcome& outcome) {
    outcome_.texels += outcome.texels;
    outcome_.without_source += outcome.without_source;
  }

  void write_page(std::uint64_t page, const std::string& bytes) {
    throw_if_interrupted();
    AtomicFile& file = outputs_.emplace_back(
        pages_.back() > 0 ? path_of_page(arguments_.output, page) : arguments_.output);
    file.write(bytes);
    file.close();
  }

  /// Puts the files in place, and prints the summary, with a line of one kind of output.
  int finish(const std::string& line) {
    const auto& [covered, without_source, old_texels] = outcome_;
    require_sources(covered, without_source);
    throw_if_interrupted();
    commit(outputs_);
    if (arguments_.quiet) return kExitInjective;
    std::string summary = "pages      " + std::to_string(pages_.size()) + " of " +
                          std::to_string(side_) + " texels\n";
    if (repeats_) summary += "texture    repeats: UVs of OLD go beyond [0,1]^2\n";
    if (elsewhere_) {
      summary += arguments_.cage > 0
                     ? "faces      what rays meet in the cage, else the nearest places of OLD\n"
                     : "faces      others than those of OLD: the nearest places of it are taken\n";
    }
    if (without_source > 0 || elsewhere_) {
      summary += "no source  " + std::to_string(without_source) + " of " + std::to_string(covered) +
                 " texels, which nothing of OLD is near\n";
    }
    summary += line + "written    " + one_line(arguments_.output) + "\n";
    return print(summary, "the summary", kExitInjective);
  }

  /// What OLD itself has, which needs no UVs and no texture.
  int run_detail(Detail detail) {
    const LightFormat format = light_format_of(arguments_.output);
    if (format == LightFormat::kNone) require_png_name(arguments_.output);
    const bool exact = format == LightFormat::kExr;
    if (format == LightFormat::kHdr || (exact && !has_exr())) {
      throw Failure(arguments_.output + ": " + arguments_.texture + " is written as .png" +
                    (has_exr() ? " or .exr" : ": this program is built without OpenEXR"));
    }
    const MeshFile from = read_mesh(arguments_.old_mesh, Content::kSurface, arguments_.reach);
    const MeshFile to = read_mesh(arguments_.new_mesh, Content::kAll, arguments_.reach);
    const std::vector<std::uint32_t> corners = triangle_corners(to);
    to_ = textured(to, corners);
    part_into_pages(to_, arguments_.new_mesh, "pack it first");
    elsewhere_ = true;
    constexpr int kUsual = 1024;  // where nothing says how many texels there are
    side_ = arguments_.resolution > 0 ? arguments_.resolution : kUsual;
    find_pages();
    DetailLooks looks{detail, arguments_.cage, arguments_.rays, side_};
    const DetailMesh fine = detail_mesh(from, triangle_corners(from));
    const DetailMesh coarse = detail_mesh(to, corners);
    const auto bake = [&](std::uint64_t page) {
      const std::vector<std::size_t> triangles = triangles_of(page);
      return bake_detail(looks, fine, part_of(coarse, triangles), picked(to_.uvs, triangles),
                         context_.get(), arguments_.new_mesh);
    };
    std::optional<DetailPage> made;
    double scale = 0;
    // All pages have one scale, and one of them is in memory: several are baked twice.
    for (const std::uint64_t page : pages_) {
      if (detail != Detail::kHeights) break;
      made = bake(page);
      scale = std::max(scale, greatest(made->page));
    }
    for (const std::uint64_t page : pages_) {
      if (!made || pages_.size() > 1) made = bake(page);
      add(made->outcome);
      write_page(page, exact ? light_bytes(made->page, format)
                             : png_bytes(in_whole_numbers(made->page, detail, scale)));
    }
    std::string line;
    if (detail == Detail::kHeights) {
      line = "heights    up to " + format_number(scale) + " in the unit of OLD" +
             (exact ? "" : ", for which white stands; 0 is grey") + "\n";
    }
    return finish(line);
  }

  /// The pages to write. Throws Failure where there are none.
  void find_pages() {
    pages_ = pages_in_use(to_);
    if (pages_.empty()) throw Failure(arguments_.new_mesh + ": no face has UVs that are numbers");
  }

  /// A texture of which most was made up is no transfer, and nobody would look for it in one.
  void require_sources(std::uint64_t covered, std::uint64_t without_source) const {
    if (covered == 0) {
      throw Failure(arguments_.new_mesh +
                    ": its UVs cover no texel: unwrap or pack it first, or raise --resolution");
    }
    if (2 * without_source <= covered) return;
    throw Failure(arguments_.new_mesh + ": " + std::to_string(without_source) + " of its " +
                  std::to_string(covered) + " texels are near nothing of " + arguments_.old_mesh +
                  " that looks the same way: a texture goes to a mesh of the same shape, in the "
                  "same place and at the same scale");
  }

  const TransferArguments& arguments_;
  const Context context_ = make_context();
  Textured from_, to_;
  std::vector<SpacePoint> ray_normals_;  ///< of the corners of NEW, with a cage
  std::vector<std::uint64_t> pages_;     ///< to write, ascending
  std::deque<AtomicFile> outputs_;
  BakeOutcome outcome_;
  bool elsewhere_ = false;        ///< NEW has other faces than OLD: nearest places are read
  std::vector<Pixels> textures_;  ///< of the pages of OLD; without pixels for those without faces
  bool repeats_ = false;          ///< UVs of OLD go beyond the one texture
  int side_ = 0;
};

}  // namespace

int transfer_command(const TransferArguments& arguments) {
  Report report;
  report.command = "transfer";
  report.input_path = arguments.texture;
  return run_guarded(report, "", {}, [&] { return Transfer(arguments).run(); });
}

}  // namespace beltrami::cli
