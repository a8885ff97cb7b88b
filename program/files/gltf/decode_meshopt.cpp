#include "files/gltf/decode_meshopt.h"

#ifdef BELTRAMI_MESHOPT
#include <meshoptimizer.h>
#endif

namespace beltrami::cli::gltf {

#ifdef BELTRAMI_MESHOPT

bool reads_meshopt() {
  return true;
}

bool decode_meshopt(const MeshoptView& view, std::string_view packed, std::string& plain) {
  const auto* const bytes = reinterpret_cast<const unsigned char*>(packed.data());
  const std::uint64_t count = view.count, stride = view.stride;
  if (view.mode == "TRIANGLES" || view.mode == "INDICES") {
    if (stride != 2 && stride != 4) return false;
    if (view.mode == "INDICES") {
      return meshopt_decodeIndexSequence(plain.data(), count, stride, bytes, packed.size()) == 0;
    }
    return count % 3 == 0 &&
           meshopt_decodeIndexBuffer(plain.data(), count, stride, bytes, packed.size()) == 0;
  }
  if (view.mode != "ATTRIBUTES" || stride % 4 != 0 || stride > 256) return false;
  if (meshopt_decodeVertexBuffer(plain.data(), count, stride, bytes, packed.size()) != 0) {
    return false;
  }
  if (view.filter.empty() || view.filter == "NONE") return true;
  if (view.filter == "OCTAHEDRAL" && (stride == 4 || stride == 8)) {
    meshopt_decodeFilterOct(plain.data(), count, stride);
  } else if (view.filter == "QUATERNION" && stride == 8) {
    meshopt_decodeFilterQuat(plain.data(), count, stride);
  } else if (view.filter == "EXPONENTIAL") {
    meshopt_decodeFilterExp(plain.data(), count, stride);
  } else {
    return false;
  }
  return true;
}

#else

bool reads_meshopt() {
  return false;
}

bool decode_meshopt(const MeshoptView&, std::string_view, std::string&) {
  return false;
}

#endif

}  // namespace beltrami::cli::gltf
