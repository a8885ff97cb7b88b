#include "simplify/back_ends.h"

namespace beltrami {

CoarseDisk simplify(const DiskMesh& fine, Index target_faces, int /*threads*/,
                    const Checkpoint& checkpoint) {
  return simplify_by_openmesh(fine, target_faces, checkpoint);
}

const char* simplifier_name() {
  return "openmesh";
}

}  // namespace beltrami
