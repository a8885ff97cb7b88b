#include "local/patch_tries.h"

#include <algorithm>
#include <unordered_set>
#include <utility>

#include "base/parallel.h"
#include "mesh/hub.h"

namespace beltrami {
namespace {

/// Cuts the patches around the faces in turn that have no vertex beside those of another: what is
/// nearer is in its patch.
void cut_some(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
              const std::vector<Vec2>& uvs, int rings, const Work& work,
              std::vector<PatchTry>& waiting) {
  std::vector<std::size_t> chosen;
  std::unordered_set<Index> around;  // vertices
  for (std::size_t i = 0; i < waiting.size(); ++i) {
    const Triangle& corners = mesh.faces[waiting[i].face];
    const bool near =
        std::any_of(corners.begin(), corners.end(), [&](Index v) { return around.contains(v); });
    if (near) continue;
    for (const Index v : corners) {
      around.insert(v);
      if (is_hub(mesh, v, kHubFaces)) continue;
      mesh.for_each_outgoing(v, [&](Index h) { around.insert(mesh.target(h)); });
    }
    if (!waiting[i].is_cut()) chosen.push_back(i);
  }
  parallel_for(work, size_of(chosen), 1, [&](std::int64_t i, std::int64_t) {
    PatchTry& next = waiting[chosen[i]];
    next.patch = cut_patch(mesh, rest, uvs, next.face, rings);
  });
}

}  // namespace

std::vector<PatchTry> take_apart(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                                 const std::vector<Vec2>& uvs, int rings,
                                 const std::function<bool(Index face)>& done, const Work& work,
                                 std::vector<PatchTry>& waiting) {
  std::erase_if(waiting, [&](const PatchTry& next) { return done(next.face); });
  cut_some(mesh, rest, uvs, rings, work, waiting);
  std::vector<PatchTry> apart, later;
  std::unordered_set<Index> moving, present;  // vertices
  for (PatchTry& next : waiting) {
    const Patch& patch = next.patch;
    bool meets = !next.is_cut();
    for (std::size_t i = 0; i < patch.mesh_vertices.size() && !meets; ++i) {
      meets = (patch.fixed[i] ? moving : present).contains(patch.mesh_vertices[i]);
    }
    if (meets) {
      later.push_back(std::move(next));
      continue;
    }
    for (std::size_t i = 0; i < patch.mesh_vertices.size(); ++i) {
      present.insert(patch.mesh_vertices[i]);
      if (!patch.fixed[i]) moving.insert(patch.mesh_vertices[i]);
    }
    apart.push_back(std::move(next));
  }
  waiting.swap(later);
  return apart;
}

}  // namespace beltrami
