#include "files/gltf/transforms.h"

#include <cmath>
#include <cstdint>
#include <limits>

#include "files/gltf/item.h"

namespace beltrami::cli::gltf {
namespace {

constexpr Transform kIdentity = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}}};
constexpr std::uint64_t kNone = std::numeric_limits<std::uint64_t>::max();

/// `outer` after `inner`.
Transform product(const Transform& outer, const Transform& inner) {
  Transform found;
  for (std::size_t column = 0; column < 4; ++column) {
    found[column] = image_of(outer, inner[column]);
    if (column == 3) continue;  // only points are moved
    for (std::size_t k = 0; k < 3; ++k) found[column][k] -= outer[3][k];
  }
  return found;
}

/// The member's numbers, or `otherwise` where it is missing.
template <std::size_t N>
std::array<double, N> numbers(const Item& node, const char* key,
                              const std::array<double, N>& otherwise) {
  const std::optional<Item> list = node.array(key);
  if (!list) return otherwise;
  if (list->size() != N) list->fail("it has not " + std::to_string(N) + " numbers");
  std::array<double, N> found;
  for (std::size_t i = 0; i < N; ++i) {
    if (!list->json[i].is_number()) list->fail("it has not " + std::to_string(N) + " numbers");
    found[i] = list->json[i].get<double>();
  }
  return found;
}

Transform local_transform(const Item& node) {
  Transform found = kIdentity;
  if (node.find("matrix")) {
    const auto m = numbers<16>(node, "matrix", {});
    for (std::size_t column = 0; column < 4; ++column) {
      for (std::size_t k = 0; k < 3; ++k) found[column][k] = m[4 * column + k];
    }
    return found;
  }
  const auto t = numbers<3>(node, "translation", {0, 0, 0});
  const auto r = numbers<4>(node, "rotation", {0, 0, 0, 1});
  const auto s = numbers<3>(node, "scale", {1, 1, 1});
  // Written with six digits, a quaternion is a unit one to six digits: not a change of scale.
  const double norm_sq = r[0] * r[0] + r[1] * r[1] + r[2] * r[2] + r[3] * r[3];
  const double f = norm_sq > 0 ? 2 / norm_sq : 0;
  const auto [x, y, z, w] = r;
  found[0] = {1 - f * (y * y + z * z), f * (x * y + z * w), f * (x * z - y * w)};
  found[1] = {f * (x * y - z * w), 1 - f * (x * x + z * z), f * (y * z + x * w)};
  found[2] = {f * (x * z + y * w), f * (y * z - x * w), 1 - f * (x * x + y * y)};
  for (std::size_t column = 0; column < 3; ++column) {
    for (double& value : found[column]) value *= s[column];
  }
  found[3] = t;
  return found;
}

bool can_be_inverted(const Transform& t) {
  const auto& [a, b, c, translation] = t;
  const double volume = a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                        a[2] * (b[0] * c[1] - b[1] * c[0]);
  const double reach =
      std::abs(translation[0]) + std::abs(translation[1]) + std::abs(translation[2]);
  return std::isfinite(volume) && volume != 0 && std::isfinite(reach);
}

/// The node that each is a child of, or kNone.
std::vector<std::uint64_t> parents_of_nodes(const Document& document) {
  std::vector<std::uint64_t> parents(document.count("nodes"), kNone);
  for (std::uint64_t i = 0; i < parents.size(); ++i) {
    const std::optional<Item> children = document.entry("nodes", i).array("children");
    for (std::uint64_t k = 0; children && k < children->size(); ++k) {
      const std::optional<std::uint64_t> child = whole_of(children->json[k]);
      if (!child || *child >= parents.size()) children->fail("it names a node that is not there");
      if (parents[*child] != kNone) {
        document.entry("nodes", *child).fail("it is the child of two nodes: export the file again");
      }
      parents[*child] = i;
    }
  }
  return parents;
}

/// From the node to the scene. With one parent each, nodes that are not below a root are in
/// circles.
std::vector<Transform> node_transforms(const Document& document) {
  const std::vector<std::uint64_t> parents = parents_of_nodes(document);
  std::vector<Transform> found(parents.size(), kIdentity);
  std::vector<bool> known(parents.size(), false);
  std::vector<std::uint64_t> path;
  for (std::uint64_t start = 0; start < parents.size(); ++start) {
    path.clear();
    for (std::uint64_t i = start; i != kNone && !known[i]; i = parents[i]) {
      path.push_back(i);
      if (path.size() > parents.size()) {
        document.entry("nodes", start).fail("it is below itself: export the file again");
      }
    }
    for (; !path.empty(); path.pop_back()) {
      const std::uint64_t i = path.back();
      const Transform local = local_transform(document.entry("nodes", i));
      found[i] = parents[i] == kNone ? local : product(found[parents[i]], local);
      known[i] = true;
    }
  }
  return found;
}

}  // namespace

std::vector<std::optional<Transform>> mesh_transforms(const Document& document) {
  const std::vector<Transform> nodes = node_transforms(document);
  std::vector<std::optional<Transform>> found(document.count("meshes"));
  std::vector<bool> decided(found.size(), false);
  for (std::uint64_t i = 0; i < nodes.size(); ++i) {
    const Item node = document.entry("nodes", i);
    const std::optional<std::uint64_t> mesh = node.whole("mesh");
    if (!mesh) continue;
    if (*mesh >= found.size()) node.fail("it shows a mesh that is not there");
    if (decided[*mesh] || !can_be_inverted(nodes[i])) continue;
    decided[*mesh] = true;
    if (!node.find("skin")) found[*mesh] = nodes[i];
  }
  return found;
}

}  // namespace beltrami::cli::gltf
