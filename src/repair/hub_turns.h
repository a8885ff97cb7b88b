// Hubs, vertices with very many faces, in sweeps over bad faces.
#pragma once

#include <unordered_set>

#include "base/types.h"
#include "mesh/disk_mesh.h"

namespace beltrami {

inline constexpr Index kManyFaces = 64;  ///< at a vertex

/// Whether more than `faces` faces meet at the vertex. Takes no longer than to count so many.
inline bool is_hub(const DiskMesh& mesh, Index vertex, Index faces) {
  Index h = mesh.outgoing[vertex], count = 0;
  do {
    if (++count > faces) return true;
    h = mesh.rotate(h);
  } while (h != kNone && h != mesh.outgoing[vertex]);
  return false;
}

/// All faces of a hub may be bad: to work on its ring for each of them would take the square of
/// their number. So a hub has one turn in each sweep, other vertices have as many as they need.
class HubTurns {
 public:
  explicit HubTurns(const DiskMesh& mesh) : mesh_(mesh) {}

  bool take(Index vertex) {
    return !is_hub(mesh_, vertex, kManyFaces) || had_one_.insert(vertex).second;
  }

 private:
  const DiskMesh& mesh_;
  std::unordered_set<Index> had_one_;
};

}  // namespace beltrami
