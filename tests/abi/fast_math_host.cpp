// A host that is linked with -ffast-math: its start-up code switches on flush-to-zero, before main.
// Prints what is wrong and ends with 1, or ends with 0.
#include <beltrami/beltrami.h>
#include <xmmintrin.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <vector>

namespace {

constexpr unsigned kFlushing = 0x8040;  // FTZ and DAZ
constexpr int kSide = 25;

std::vector<double> flatten(const std::vector<double>& positions,
                            const std::vector<uint32_t>& indices) {
  beltrami_context* context = nullptr;
  if (beltrami_create(&context) != BELTRAMI_OK) return {};
  beltrami_mesh mesh{};
  mesh.struct_size = sizeof mesh;
  mesh.vertex_count = positions.size() / 3;
  mesh.face_count = indices.size() / 3;
  mesh.positions = {positions.data(), 0, BELTRAMI_F64, 0};
  mesh.indices = {indices.data(), 0, BELTRAMI_U32, 0};
  std::vector<double> uvs(2 * mesh.vertex_count);
  beltrami_set_int(context, BELTRAMI_OPTION_COARSE_FACES, 300);
  beltrami_set_int(context, BELTRAMI_OPTION_THREADS, 2);
  if (beltrami_set_mesh(context, &mesh) != BELTRAMI_OK ||
      beltrami_run(context, nullptr, nullptr) != BELTRAMI_OK ||
      beltrami_get_uvs(context, uvs.data(), BELTRAMI_F64, 0) != BELTRAMI_OK) {
    std::printf("%s\n", beltrami_error_message(context));
    uvs.clear();
  }
  beltrami_destroy(context);
  return uvs;
}

/// A face whose corners are subnormal numbers apart, which flushing would make degenerate.
bool subnormal_face_is_positive() {
  const uint32_t face[3] = {0, 1, 2};
  const uint64_t smallest[3][2] = {{0, 0}, {4, 0}, {0, 4}};  // as bits: flushing spares these
  beltrami_mesh mesh{};
  mesh.struct_size = sizeof mesh;
  mesh.vertex_count = 3;
  mesh.face_count = 1;
  mesh.indices = {face, 0, BELTRAMI_U32, 0};
  const beltrami_buffer uvs = {smallest, 0, BELTRAMI_F64, 0};
  beltrami_certificate certificate{};
  certificate.struct_size = sizeof certificate;
  return beltrami_check_injective(&mesh, &uvs, &certificate) == BELTRAMI_OK &&
         certificate.positive == 1;
}

bool fail(const char* text) {
  std::printf("%s\n", text);
  return false;
}

bool works() {
  std::vector<double> positions;
  std::vector<uint32_t> indices;
  for (int j = 0; j < kSide; ++j) {
    for (int i = 0; i < kSide; ++i) {
      positions.insert(positions.end(), {double(i), double(j), std::sin(0.5 * i) * std::cos(j)});
      if (i + 1 == kSide || j + 1 == kSide) continue;
      const auto a = static_cast<uint32_t>(j * kSide + i), c = a + 1 + kSide;
      indices.insert(indices.end(), {a, a + 1, c, a, c, c - 1});
    }
  }
  const unsigned mode = _mm_getcsr();
  if ((mode & kFlushing) != kFlushing) return fail("this host does not flush: nothing is tested");
  const std::vector<double> flushing = flatten(positions, indices);
  if (!subnormal_face_is_positive()) return fail("a subnormal face was flushed");
  if ((_mm_getcsr() & kFlushing) != kFlushing) return fail("the host's mode was not restored");
  _mm_setcsr(mode & ~kFlushing);
  const std::vector<double> expected = flatten(positions, indices);
  if (expected.empty() || flushing.size() != expected.size() ||
      std::memcmp(flushing.data(), expected.data(), expected.size() * sizeof(double)) != 0) {
    return fail("flushing changes the bits");
  }
  return true;
}

}  // namespace

int main() {
  return works() ? 0 : 1;
}
