// The simplifiers that this build has, to be held to one contract and compared.
#pragma once

#include <ostream>
#include <vector>

#include "base/types.h"
#include "base/work.h"
#include "mesh/disk_mesh.h"
#include "simplify/back_ends.h"
#include "simplify/coarse.h"

namespace beltrami {

struct Simplifier {
  const char* name;
  CoarseDisk (*simplify)(const DiskMesh& fine, Index target_faces, const Work& work);
};

inline std::ostream& operator<<(std::ostream& stream, const Simplifier& simplifier) {
  return stream << simplifier.name;
}

/// Our own, and OpenMesh's where it was found.
inline std::vector<Simplifier> simplifiers() {
  std::vector<Simplifier> found = {{"native", simplify_in_passes}};
#ifdef BELTRAMI_WITH_OPENMESH
  found.push_back({"openmesh", simplify_by_openmesh});
#endif
  return found;
}

}  // namespace beltrami
