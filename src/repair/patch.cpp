#include "repair/patch.h"

#include <algorithm>
#include <iterator>

namespace beltrami {
namespace {

void sort_unique(std::vector<Index>& items) {
  std::sort(items.begin(), items.end());
  items.erase(std::unique(items.begin(), items.end()), items.end());
}

std::vector<Index> faces_around(const DiskMesh& mesh, Index face, int rings) {
  std::vector<Index> found{face}, front{face};
  for (int ring = 0; ring < rings; ++ring) {
    std::vector<Index> reached;
    for (const Index f : front) {
      for (const Index v : mesh.faces[f]) {
        mesh.for_each_outgoing(v, [&](Index h) { reached.push_back(h / 3); });
      }
    }
    sort_unique(reached);
    front.clear();
    std::set_difference(reached.begin(), reached.end(), found.begin(), found.end(),
                        std::back_inserter(front));
    found.insert(found.end(), front.begin(), front.end());
    std::sort(found.begin(), found.end());
  }
  return found;
}

}  // namespace

void Patch::exchange(std::vector<Vec2>& mesh_uvs) {
  for (std::size_t i = 0; i < mesh_vertices.size(); ++i) {
    std::swap(mesh_uvs[mesh_vertices[i]], uvs[i]);
  }
}

Patch cut_patch(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                const std::vector<Vec2>& uvs, Index face, int rings) {
  Patch patch;
  patch.mesh_faces = faces_around(mesh, face, rings);
  for (const Index f : patch.mesh_faces) {
    patch.mesh_vertices.insert(patch.mesh_vertices.end(), mesh.faces[f].begin(),
                               mesh.faces[f].end());
    if (!rest.empty()) patch.rest.push_back(rest[f]);
  }
  sort_unique(patch.mesh_vertices);
  const auto local = [&](Index v) {
    const auto& all = patch.mesh_vertices;
    return static_cast<Index>(std::lower_bound(all.begin(), all.end(), v) - all.begin());
  };
  for (const Index f : patch.mesh_faces) {
    const Triangle& t = mesh.faces[f];
    patch.faces.push_back({local(t[0]), local(t[1]), local(t[2])});
  }
  patch.fixed.assign(patch.mesh_vertices.size(), false);
  for (std::size_t i = 0; i < patch.mesh_vertices.size(); ++i) {
    const Index v = patch.mesh_vertices[i];
    patch.uvs.push_back(uvs[v]);
    mesh.for_each_outgoing(v, [&](Index h) {
      if (!std::binary_search(patch.mesh_faces.begin(), patch.mesh_faces.end(), h / 3)) {
        patch.fixed[i] = true;
      }
    });
    patch.moves_boundary = patch.moves_boundary || (!patch.fixed[i] && mesh.on_boundary[v]);
  }
  // A patch that is the whole mesh would drift.
  if (std::find(patch.fixed.begin(), patch.fixed.end(), true) == patch.fixed.end()) {
    patch.fixed[0] = true;
  }
  return patch;
}

}  // namespace beltrami
