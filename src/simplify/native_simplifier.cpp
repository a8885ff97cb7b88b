#include "base/checkpoint.h"
#include "base/types.h"
#include "mesh/disk_mesh.h"
#include "simplify/back_ends.h"
#include "simplify/simplify.h"

namespace beltrami {

CoarseDisk simplify(const DiskMesh& fine, Index target_faces, int threads,
                    const Checkpoint& checkpoint) {
  return simplify_in_passes(fine, target_faces, threads, checkpoint);
}

const char* simplifier_name() {
  return "native";
}

}  // namespace beltrami
