// The simplifiers that this build has, to be held to one contract and compared.
#pragma once

#include <ostream>
#include <vector>

#include "base/checkpoint.h"
#include "base/types.h"
#include "mesh/disk_mesh.h"
#include "simplify/back_ends.h"
#include "simplify/simplify.h"

namespace beltrami {

struct Simplifier {
  const char* name;
  CoarseDisk (*simplify)(const DiskMesh& fine, Index target_faces, int threads,
                         const Checkpoint& checkpoint);
};

inline std::ostream& operator<<(std::ostream& stream, const Simplifier& simplifier) {
  return stream << simplifier.name;
}

/// Our own, and OpenMesh's where it was found.
inline std::vector<Simplifier> simplifiers() {
  std::vector<Simplifier> found = {{"native", simplify_in_passes}};
#ifdef BELTRAMI_WITH_OPENMESH
  found.push_back({"openmesh", [](const DiskMesh& fine, Index target_faces, int /*threads*/,
                                  const Checkpoint& checkpoint) {
                     return simplify_by_openmesh(fine, target_faces, checkpoint);
                   }});
#endif
  return found;
}

}  // namespace beltrami
