#include "files/gltf/split.h"

#include <array>
#include <cstddef>
#include <unordered_map>

#include "files/gltf/little.h"
#include "files/gltf/model.h"
#include "files/polygons.h"
#include "files/uv_numbers.h"

namespace beltrami::cli::gltf {
namespace {

/// Splits the vertices of one set.
class Splitter {
 public:
  explicit Splitter(std::uint64_t vertices)
      : taken_(vertices, false), uvs_(vertices, std::array<double, 2>{}) {}

  /// The vertex of the set for a corner at vertex `of_file` of the file, `of_set` of the set.
  std::uint32_t vertex_of(std::uint32_t of_file, std::uint32_t of_set, std::uint32_t uv_vertex,
                          std::array<double, 2> uv) {
    const std::uint64_t key = std::uint64_t{of_file} << 32 | uv_vertex;
    const auto [found, is_new] = known_.try_emplace(key, of_set);
    if (!is_new) return found->second;
    if (!taken_[of_set]) {
      taken_[of_set] = true;
      uvs_[of_set] = uv;
    } else {
      found->second = static_cast<std::uint32_t>(uvs_.size());
      uvs_.push_back(uv);
      copies_.push_back(of_set);
    }
    return found->second;
  }

  std::vector<std::uint32_t> take_copies() { return std::move(copies_); }
  std::string uv_bytes() const {
    std::string bytes;
    bytes.reserve(8 * uvs_.size());
    for (const auto& [u, v] : uvs_) {
      append_little(bytes, static_cast<float>(u));
      append_little(bytes, static_cast<float>(v));
    }
    return bytes;
  }

 private:
  std::vector<bool> taken_;  ///< an old vertex has its UV
  std::vector<std::array<double, 2>> uvs_;
  std::vector<std::uint32_t> copies_;
  /// By vertex of the file and UV vertex. Meshes may share a set, but no vertices of the file.
  std::unordered_map<std::uint64_t, std::uint32_t> known_;
};

}  // namespace

Split split_vertices(const MeshFile& file) {
  const Model& model = model_of(file);
  const std::vector<std::uint32_t>& vertices = file.polygons.corners();
  const auto& [values, of_corner] = file.corner_uvs;
  const std::vector<double>& uvs = of_corner.empty() ? file.uvs : values;
  const std::vector<std::uint32_t>& uv_of_corner = of_corner.empty() ? vertices : of_corner;
  const UvNumbers numbers = uv_numbers(MeshFormat::kGltf, file.single_uvs);
  Split split;
  split.corners.resize(vertices.size());
  std::vector<std::vector<const Primitive*>> primitives(model.sets.size());
  for (const Primitive& primitive : model.primitives) {
    primitives[primitive.set].push_back(&primitive);
  }
  for (std::size_t set = 0; set < model.sets.size(); ++set) {
    Splitter splitter(model.sets[set].count);
    for (const Primitive* primitive : primitives[set]) {
      const std::uint64_t first = 3 * primitive->first_face;
      for (std::uint64_t c = first; c < first + 3 * primitive->face_count; ++c) {
        const std::uint32_t vertex = vertices[c], uv = uv_of_corner[c];
        const double* at = &uvs[2 * std::size_t{uv}];
        split.corners[c] =
            splitter.vertex_of(vertex, model.local[vertex], uv, numbers.held(at[0], at[1]));
      }
    }
    split.copies.push_back(splitter.take_copies());
    split.uvs.push_back(splitter.uv_bytes());
  }
  return split;
}

}  // namespace beltrami::cli::gltf
