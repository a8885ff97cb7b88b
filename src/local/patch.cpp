#include "local/patch.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <utility>

#include "base/interrupt.h"
#include "base/sort_unique.h"
#include "mesh/hub.h"

namespace beltrami {
namespace {

/// What `of` gives to the items, each once.
template <class Visit>
std::vector<Index> gather(const std::vector<Index>& items, const Visit& of) {
  std::vector<Index> found;
  PollSometimes poll;
  for (const Index item : items) {
    of(item, [&](Index i) {
      poll();
      found.push_back(i);
    });
  }
  sort_unique(found);
  return found;
}

/// The items that are not in `known`; both increasing.
std::vector<Index> without(const std::vector<Index>& items, const std::vector<Index>& known) {
  std::vector<Index> rest;
  std::set_difference(items.begin(), items.end(), known.begin(), known.end(),
                      std::back_inserter(rest));
  return rest;
}

void merge_into(std::vector<Index>& known, const std::vector<Index>& items) {
  const auto middle = static_cast<std::ptrdiff_t>(known.size());
  known.insert(known.end(), items.begin(), items.end());
  std::inplace_merge(known.begin(), known.begin() + middle, known.end());
}

std::vector<Index> corners_of(const DiskMesh& mesh, const std::vector<Index>& faces) {
  return gather(faces, [&](Index f, const auto& take) {
    for (const Index v : mesh.faces[f]) take(v);
  });
}

/// What lies around a face, each list increasing.
struct Surroundings {
  std::vector<Index> faces;
  std::vector<Index> vertices;  ///< of the faces
  std::vector<Index> inner;     ///< of these, those that were gone around: with all their faces
};

/// Each vertex is gone around once.
Surroundings look_around(const DiskMesh& mesh, Index face, int rings) {
  Surroundings found{{face}, {}, {}};
  std::vector<Index> front{face};
  for (int ring = 0; ring <= rings && !front.empty(); ++ring) {
    const std::vector<Index> corners = without(corners_of(mesh, front), found.vertices);
    merge_into(found.vertices, corners);
    if (ring == rings) break;
    std::vector<Index> inner;
    front = without(gather(corners,
                           [&](Index v, const auto& take) {
                             if (is_hub(mesh, v, kLargeHubFaces)) return;
                             inner.push_back(v);
                             mesh.for_each_outgoing(v, [&](Index h) { take(h / 3); });
                           }),
                    found.faces);
    merge_into(found.inner, inner);
    merge_into(found.faces, front);
  }
  return found;
}

/// Whether all faces at the vertex are among these, which increase; not of a hub, which is fixed.
bool is_inside(const DiskMesh& mesh, Index vertex, const std::vector<Index>& faces) {
  if (is_hub(mesh, vertex, kLargeHubFaces)) return false;
  Index h = mesh.outgoing[vertex];
  do {
    if (!std::binary_search(faces.begin(), faces.end(), h / 3)) return false;
    h = mesh.rotate(h);
  } while (h != kNone && h != mesh.outgoing[vertex]);
  return true;
}

}  // namespace

void Patch::refresh(const std::vector<Vec2>& mesh_uvs) {
  for (std::size_t v = 0; v < uvs.size(); ++v) uvs[v] = mesh_uvs[mesh_vertices[v]];
}

void Patch::exchange(std::vector<Vec2>& mesh_uvs) {
  for (std::size_t i = 0; i < mesh_vertices.size(); ++i) {
    std::swap(mesh_uvs[mesh_vertices[i]], uvs[i]);
  }
}

Patch make_patch(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                 const std::vector<Vec2>& uvs, std::vector<Index> faces,
                 const std::vector<Index>& moving) {
  Patch patch;
  patch.mesh_faces = std::move(faces);
  patch.mesh_vertices = corners_of(mesh, patch.mesh_faces);
  PollSometimes poll;
  for (const Index f : patch.mesh_faces) {
    poll();
    Triangle& corners = patch.faces.emplace_back(mesh.faces[f]);
    for (Index& v : corners) {
      const auto& all = patch.mesh_vertices;
      v = static_cast<Index>(std::lower_bound(all.begin(), all.end(), v) - all.begin());
    }
    if (!rest.empty()) patch.rest.push_back(rest[f]);
  }
  auto next = moving.begin();
  for (const Index v : patch.mesh_vertices) {
    const bool moves = next != moving.end() && *next == v;
    if (moves) ++next;
    patch.uvs.push_back(uvs[v]);
    patch.fixed.push_back(!moves);
    patch.moves_boundary = patch.moves_boundary || (moves && mesh.on_boundary[v]);
  }
  // A patch that is the whole mesh would drift.
  if (moving.size() == patch.mesh_vertices.size()) patch.fixed[0] = true;
  return patch;
}

Patch cut_patch(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                const std::vector<Vec2>& uvs, Index face, int rings) {
  const Surroundings around = look_around(mesh, face, rings);
  std::vector<Index> moving = around.inner;
  for (const Index v : without(around.vertices, around.inner)) {
    if (is_inside(mesh, v, around.faces)) moving.push_back(v);
  }
  std::sort(moving.begin(), moving.end());
  return make_patch(mesh, rest, uvs, around.faces, moving);
}

void hold_boundary(const DiskMesh& mesh, Patch& patch) {
  for (std::size_t i = 0; i < patch.fixed.size(); ++i) {
    if (mesh.on_boundary[patch.mesh_vertices[i]]) patch.fixed[i] = true;
  }
  patch.moves_boundary = false;
}

}  // namespace beltrami
