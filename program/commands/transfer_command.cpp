// beltrami transfer: bake a texture of an old layout of UVs for a new one, of the same mesh or of
// another of the same shape.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include "commands/command.h"
#include "commands/pages.h"
#include "commands/report.h"
#include "files/atomic_file.h"
#include "files/mesh_file.h"
#include "files/polygons.h"
#include "files/triangulate.h"
#include "picture/nearest_face.h"
#include "picture/resample.h"
#include "picture/stb_in_one_place.h"
#include "process/failure.h"
#include "process/interrupt.h"

namespace beltrami::cli {
namespace {

using Uv = std::array<double, 2>;
using TriangleUvs = std::array<Uv, 3>;

constexpr std::uint64_t kMostRows = 100;  // of pages

/// Of the size of OLD: how far corners of the same face may be apart, as single precision and a few
/// digits of a text leave them; and how far what a texel shows may be from it.
constexpr double kSame = 1e-5, kReach = 0.02;

Uv uv_of_corner(const MeshFile& file, std::uint32_t corner) {
  const auto& [values, of_corner] = file.corner_uvs;
  const bool per_vertex = of_corner.empty();
  const std::size_t at = per_vertex ? file.polygons.corners()[corner] : of_corner[corner];
  const std::vector<double>& uvs = per_vertex ? file.uvs : values;
  return {uvs[2 * at], uvs[2 * at + 1]};
}

/// The page of a triangle, by its centre; and its UVs on it.
std::uint64_t take_page(TriangleUvs& uvs, const std::string& path) {
  std::array<double, 2> corner{};
  for (std::size_t k = 0; k < 2; ++k) {
    corner[k] = std::floor((uvs[0][k] + uvs[1][k] + uvs[2][k]) / 3);
  }
  const bool is_page = corner[0] >= 0 && corner[0] < double(kPagesInARow) && corner[1] >= 0 &&
                       corner[1] < double(kMostRows);
  if (!is_page) {
    throw Failure(path +
                  ": a face has its UVs beside the pages of a texture, [0,1]^2 and the "
                  "tiles of UDIM: pack it first");
  }
  for (Uv& uv : uvs) {
    for (std::size_t k = 0; k < 2; ++k) uv[k] -= corner[k];
  }
  return static_cast<std::uint64_t>(corner[0]) +
         kPagesInARow * static_cast<std::uint64_t>(corner[1]);
}

Pixels read_texture(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw Failure(path + ": cannot be read");
  const std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  std::optional<Pixels> image = read_png(bytes);
  if (!image) throw Failure(path + ": is no PNG file that can be read");
  return *std::move(image);
}

/// The triangles of a mesh: where they are in space, and on the pages of a texture.
struct Textured {
  std::vector<PlacedTriangle> places;
  std::vector<TriangleUvs> uvs;
  std::vector<std::uint64_t> pages;
};

Textured textured(const MeshFile& file, const std::vector<std::uint32_t>& corners) {
  Textured mesh;
  for (std::size_t first = 0; first < corners.size(); first += 3) {
    PlacedTriangle& place = mesh.places.emplace_back();
    TriangleUvs& uvs = mesh.uvs.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t vertex = file.polygons.corners()[corners[first + k]];
      for (std::size_t d = 0; d < 3; ++d) place[k][d] = file.positions[3 * vertex + d];
      uvs[k] = uv_of_corner(file, corners[first + k]);
    }
    mesh.pages.push_back(take_page(uvs, file.path));
  }
  return mesh;
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

class Transfer {
 public:
  explicit Transfer(const TransferArguments& arguments) : arguments_(arguments) {}

  int run() {
    require_distinct({arguments_.old_mesh, arguments_.texture, arguments_.output});
    require_distinct({arguments_.new_mesh, arguments_.texture, arguments_.output});
    read_triangles();
    read_pages();
    return write_pages();
  }

 private:
  void read_triangles() {
    const MeshFile from = read_mesh(arguments_.old_mesh, Content::kUvs, arguments_.reach);
    const MeshFile to = read_mesh(arguments_.new_mesh, Content::kUvs, arguments_.reach);
    const std::vector<std::uint32_t> corners = triangle_corners(to);
    to_ = textured(to, corners);
    if (same_polygons(from, to)) {
      const bool same_vertices =
          joins_faces(to) && from.polygons.corners() == to.polygons.corners();
      from_ = textured(from, corners);
      surface_.emplace(from_.places);
      if (same_vertices || same_places(from, to, kSame * surface_->size())) {
        surface_.reset();
        return;
      }
    }
    from_ = textured(from, triangle_corners(from));
    surface_.emplace(from_.places);
  }

  /// Where the texture has what a point of a new triangle shows.
  std::optional<Source> source(std::size_t triangle, const std::array<double, 3>& weights) {
    OnFace at{triangle, weights};
    if (surface_) {
      const PlacedTriangle& place = to_.places[triangle];
      Place point{0, 0, 0};
      for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t d = 0; d < 3; ++d) point[d] += weights[k] * place[k][d];
      }
      const std::optional<OnFace> found =
          surface_->find(point, normal_of(place), kReach * surface_->size(), last_found_);
      if (!found) return std::nullopt;
      at = *found;
      last_found_ = at.face;
    }
    Source source{from_.pages[at.face], 0, 0};
    for (std::size_t k = 0; k < 3; ++k) {
      source.u += at.weights[k] * from_.uvs[at.face][k][0];
      source.v += at.weights[k] * from_.uvs[at.face][k][1];
    }
    return source;
  }

  /// The texture of each page that is read.
  void read_pages() {
    std::uint64_t pages = 0;
    for (const std::uint64_t page : from_.pages) pages = std::max(pages, page + 1);
    for (std::uint64_t page = 0; page < pages; ++page) {
      const bool used =
          std::find(from_.pages.begin(), from_.pages.end(), page) != from_.pages.end();
      const std::string path =
          pages > 1 ? path_of_page(arguments_.texture, page) : arguments_.texture;
      textures_.push_back(used ? read_texture(path) : Pixels{});
      if (!used) continue;
      if (components_ == 0) components_ = textures_.back().components;
      if (textures_.back().components != components_) {
        throw Failure(path + ": has other components than the pages before it");
      }
      side_ = std::max(side_, textures_.back().width);
    }
    if (arguments_.resolution > 0) side_ = arguments_.resolution;
    // An unused page has no texels, and none are read; but it is asked how many components it has.
    for (Pixels& texture : textures_) texture.components = components_;
  }

  /// What is on a page of NEW.
  Baked bake_page(std::uint64_t page) {
    std::vector<BakedTriangle> triangles;
    std::vector<std::size_t> number;
    for (std::size_t t = 0; t < to_.uvs.size(); ++t) {
      if (to_.pages[t] != page) continue;
      BakedTriangle& triangle = triangles.emplace_back(to_.uvs[t]);
      for (auto& corner : triangle) {
        for (double& x : corner) x *= side_;
      }
      number.push_back(t);
    }
    const auto source_of = [&](std::size_t t, const std::array<double, 3>& weights) {
      return source(number[t], weights);
    };
    return bake(triangles, source_of, textures_, side_, arguments_.margin);
  }

  int write_pages() {
    std::uint64_t pages = 0, covered = 0, without_source = 0;
    for (const std::uint64_t page : to_.pages) pages = std::max(pages, page + 1);
    std::deque<AtomicFile> outputs;
    for (std::uint64_t page = 0; page < pages; ++page) {
      throw_if_interrupted();
      const Baked baked = bake_page(page);
      covered += baked.covered;
      without_source += baked.without_source;
      AtomicFile& file = outputs.emplace_back(pages > 1 ? path_of_page(arguments_.output, page)
                                                        : arguments_.output);
      file.write(png_bytes(side_, side_, components_, baked.image.values.data()));
      file.close();
    }
    if (covered > 0 && without_source == covered) {
      throw Failure(arguments_.new_mesh + ": no part of it is near " + arguments_.old_mesh +
                    " and looks the same way: a texture goes to a mesh of the same shape, in the "
                    "same place and at the same scale");
    }
    throw_if_interrupted();
    for (AtomicFile& file : outputs) file.commit();
    if (arguments_.quiet) return kExitInjective;
    std::string summary =
        "pages      " + std::to_string(pages) + " of " + std::to_string(side_) + " texels\n";
    if (surface_) {
      summary += "faces      others than those of OLD: the nearest places of it are taken\n";
      summary += "no source  " + std::to_string(without_source) + " of " + std::to_string(covered) +
                 " texels, which nothing of OLD is near\n";
    }
    summary += "written    " + one_line(arguments_.output) + "\n";
    return print(summary, "the summary", kExitInjective);
  }

  const TransferArguments& arguments_;
  Textured from_, to_;
  std::optional<NearestFace> surface_;  ///< of OLD, where NEW has other faces
  std::size_t last_found_ = 0;          ///< neighbours are near one another
  std::vector<Pixels> textures_;
  int side_ = 0, components_ = 0;
};

}  // namespace

int transfer_command(const TransferArguments& arguments) {
  Report report;
  report.command = "transfer";
  report.input_path = arguments.texture;
  return run_guarded(report, "", {}, [&] { return Transfer(arguments).run(); });
}

}  // namespace beltrami::cli
