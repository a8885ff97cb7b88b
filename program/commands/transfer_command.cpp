// beltrami transfer: bake a texture of an old layout of UVs for a new one of the same mesh.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <deque>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "commands/command.h"
#include "commands/pages.h"
#include "commands/report.h"
#include "files/atomic_file.h"
#include "files/mesh_file.h"
#include "files/polygons.h"
#include "files/triangulate.h"
#include "picture/resample.h"
#include "picture/stb_in_one_place.h"
#include "process/failure.h"
#include "process/interrupt.h"

namespace beltrami::cli {
namespace {

using Uv = std::array<double, 2>;
using TriangleUvs = std::array<Uv, 3>;

constexpr std::uint64_t kMostRows = 100;  // of pages

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
    const MeshFile from = read_mesh(arguments_.old_mesh, Content::kUvs);
    const MeshFile to = read_mesh(arguments_.new_mesh, Content::kUvs);
    require_same_faces(from, to);
    for (const std::uint32_t corner : triangle_corners(to)) {
      if (from_.empty() || filled_ == 3) {
        from_.emplace_back();
        to_.emplace_back();
        filled_ = 0;
      }
      from_.back()[filled_] = uv_of_corner(from, corner);
      to_.back()[filled_++] = uv_of_corner(to, corner);
    }
  }

  void require_same_faces(const MeshFile& from, const MeshFile& to) const {
    bool same = from.polygons.size() == to.polygons.size() &&
                from.polygons.corners().size() == to.polygons.corners().size();
    for (std::uint64_t i = 0; same && i < to.polygons.size(); ++i) {
      same = from.polygons.end(i) == to.polygons.end(i);
    }
    if (same) return;
    throw Failure(arguments_.new_mesh + ": has other faces than " + arguments_.old_mesh +
                  ": a texture goes from a mesh to the same one with other UVs");
  }

  /// The texture of each page that is read.
  void read_pages() {
    std::uint64_t pages = 0;
    for (TriangleUvs& uvs : from_) {
      from_page_.push_back(take_page(uvs, arguments_.old_mesh));
      pages = std::max(pages, from_page_.back() + 1);
    }
    for (std::uint64_t page = 0; page < pages; ++page) {
      const bool used = std::find(from_page_.begin(), from_page_.end(), page) != from_page_.end();
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

  int write_pages() {
    std::uint64_t pages = 0;
    std::vector<std::uint64_t> to_page;
    for (TriangleUvs& uvs : to_) {
      to_page.push_back(take_page(uvs, arguments_.new_mesh));
      pages = std::max(pages, to_page.back() + 1);
    }
    std::deque<AtomicFile> outputs;
    for (std::uint64_t page = 0; page < pages; ++page) {
      throw_if_interrupted();
      std::vector<BakedTriangle> triangles;
      for (std::size_t t = 0; t < to_.size(); ++t) {
        if (to_page[t] != page) continue;
        BakedTriangle& triangle = triangles.emplace_back();
        triangle.from = from_[t];
        triangle.from_page = from_page_[t];
        for (std::size_t k = 0; k < 3; ++k) {
          for (std::size_t d = 0; d < 2; ++d) triangle.to[k][d] = side_ * to_[t][k][d];
        }
      }
      const Pixels image = bake(triangles, textures_, side_, arguments_.margin);
      AtomicFile& file = outputs.emplace_back(pages > 1 ? path_of_page(arguments_.output, page)
                                                        : arguments_.output);
      file.write(png_bytes(side_, side_, components_, image.values.data()));
      file.close();
    }
    throw_if_interrupted();
    for (AtomicFile& file : outputs) file.commit();
    if (arguments_.quiet) return kExitInjective;
    const std::string summary = "pages      " + std::to_string(pages) + " of " +
                                std::to_string(side_) + " texels\nwritten    " +
                                one_line(arguments_.output) + "\n";
    return print(summary, "the summary", kExitInjective);
  }

  const TransferArguments& arguments_;
  std::vector<TriangleUvs> from_, to_;  ///< on their pages, once these are known
  std::size_t filled_ = 0;              ///< corners of the last triangle
  std::vector<std::uint64_t> from_page_;
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
