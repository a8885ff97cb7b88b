#include "simplify/back_ends.h"
#include "simplify/simplify.h"

namespace beltrami {

CoarseDisk simplify(const DiskMesh& fine, Index target_faces, const Work& work) {
  return simplify_by_openmesh(fine, target_faces, work);
}

const char* simplifier_name() {
  return "openmesh";
}

}  // namespace beltrami
