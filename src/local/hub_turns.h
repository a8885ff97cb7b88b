// Hubs in sweeps over bad faces.
#pragma once

#include <unordered_set>

#include "base/types.h"
#include "mesh/disk_mesh.h"
#include "mesh/hub.h"

namespace beltrami {

/// All faces of a hub may be bad: to work on its ring for each of them would take the square of
/// their number. So a hub has one turn in each sweep, other vertices have as many as they need.
class HubTurns {
 public:
  explicit HubTurns(const DiskMesh& mesh) : mesh_(mesh) {}

  bool take(Index vertex) {
    return !is_hub(mesh_, vertex, kHubFaces) || had_one_.insert(vertex).second;
  }

 private:
  const DiskMesh& mesh_;
  std::unordered_set<Index> had_one_;
};

}  // namespace beltrami
