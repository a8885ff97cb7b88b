#include "base/types.h"
#include "base/work.h"
#include "mesh/disk_mesh.h"
#include "simplify/back_ends.h"
#include "simplify/coarse.h"
#include "simplify/simplify.h"

namespace beltrami {

CoarseDisk simplify(const DiskMesh& fine, Index target_faces, const Work& work) {
  return simplify_in_passes(fine, target_faces, work);
}

const char* simplifier_name() {
  return "native";
}

}  // namespace beltrami
