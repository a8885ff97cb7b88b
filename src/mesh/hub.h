// Hubs: vertices with very many faces.
#pragma once

#include "base/types.h"
#include "mesh/disk_mesh.h"

namespace beltrami {

/// Faces at a hub, more than that: to go round it for each of them is not to be done often.
inline constexpr Index kHubFaces = 64;

/// Faces at a large hub, more than that: it is left where it is, for a patch or a system with all
/// of them is not small.
inline constexpr Index kLargeHubFaces = 1000;

/// Whether more than `faces` faces meet at the vertex. Takes no longer than to count so many.
inline bool is_hub(const DiskMesh& mesh, Index vertex, Index faces) {
  Index h = mesh.outgoing[vertex], count = 0;
  do {
    if (++count > faces) return true;
    h = mesh.rotate(h);
  } while (h != kNone && h != mesh.outgoing[vertex]);
  return false;
}

}  // namespace beltrami
