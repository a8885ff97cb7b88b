// Hosts with odd floating-point modes: flush-to-zero, other roundings, traps.
#include <cfenv>
#include <cmath>

#include "abi/host.h"
#include "support/meshes.h"

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace beltrami {
namespace {

using namespace host;
using meshes::TriangleList;

/// Everything that a host can learn, as bits.
struct Outcome {
  std::vector<std::array<double, 2>> uvs;
  std::vector<std::array<float, 2>> single_uvs;
  std::vector<double> energies;
  int64_t subnormal_positive = 0;
};

Outcome outcome(const TriangleList& mesh) {
  Outcome out;
  const Context context = whole_pipeline(mesh);
  EXPECT_EQ(run(context), BELTRAMI_OK);
  out.uvs = uvs(context, mesh.positions.size());
  out.single_uvs.resize(mesh.positions.size());
  EXPECT_EQ(beltrami_get_uvs(context.get(), out.single_uvs.data(), BELTRAMI_F32, 0), BELTRAMI_OK);
  out.energies.resize(mesh.faces.size());
  EXPECT_EQ(beltrami_get_face_energies(context.get(), out.energies.data(), 0), BELTRAMI_OK);

  // A face whose corners are subnormal numbers apart.
  const TriangleList triangle = meshes::triangle();
  const std::vector<std::array<double, 2>> tiny = {{0, 0}, {0x1p-1070, 0}, {0, 0x1p-1070}};
  const beltrami_mesh mesh_view = view(triangle);
  const beltrami_buffer uv_view = view(tiny);
  auto certificate = sized<beltrami_certificate>();
  beltrami_check_injective(&mesh_view, &uv_view, &certificate);
  out.subnormal_positive = static_cast<int64_t>(certificate.positive);
  return out;
}

void expect_same(const Outcome& a, const Outcome& b) {
  EXPECT_TRUE(same_bits(a.uvs, b.uvs));
  EXPECT_TRUE(same_bits(a.single_uvs, b.single_uvs));
  EXPECT_TRUE(same_bits(a.energies, b.energies));
  EXPECT_EQ(b.subnormal_positive, 1) << "subnormals were flushed";
}

TEST(FloatingPoint, RoundingModesChangeNothingAndComeBack) {
  const TriangleList mesh = meshes::bumps(50, 50);
  const Outcome expected = outcome(mesh);
  for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
    ASSERT_EQ(std::fesetround(mode), 0);
    const Outcome found = outcome(mesh);
    EXPECT_EQ(std::fegetround(), mode);
    std::fesetround(FE_TONEAREST);
    expect_same(expected, found);
  }
}

#if defined(__SSE2__)
TEST(FloatingPoint, FlushToZeroChangesNothingAndComesBack) {
  const TriangleList mesh = meshes::bumps(50, 50);
  const Outcome expected = outcome(mesh);
  const unsigned before = _mm_getcsr();
  const unsigned flushing = before | 0x8040;  // FTZ and DAZ
  _mm_setcsr(flushing);
  const Outcome found = outcome(mesh);
  const unsigned after = _mm_getcsr();
  _mm_setcsr(before);
  EXPECT_EQ(after & 0xffc0, flushing & 0xffc0);
  expect_same(expected, found);
}

TEST(FloatingPoint, UnmaskedTrapsDoNotFire) {
  const TriangleList mesh = meshes::bumps(20, 20);
  const Outcome expected = outcome(mesh);
  const unsigned before = _mm_getcsr();
  const Context context = whole_pipeline(mesh);
  std::vector<std::array<double, 2>> found(mesh.positions.size());
  _mm_setcsr((before & ~0x3fu) & ~0x1f80u);  // every exception traps
  const beltrami_status ran = beltrami_run(context.get(), nullptr, nullptr);
  const beltrami_status got = beltrami_get_uvs(context.get(), found.data(), BELTRAMI_F64, 0);
  const unsigned after = _mm_getcsr();
  _mm_setcsr(before);
  EXPECT_EQ(ran, BELTRAMI_OK);
  EXPECT_EQ(got, BELTRAMI_OK);
  EXPECT_EQ(after & 0xffc0, 0u);
  EXPECT_TRUE(same_bits(found, expected.uvs));
}

TEST(FloatingPoint, AProgressCallbackMayChangeTheMode) {
  const TriangleList mesh = meshes::bumps(20, 20);
  const Outcome expected = outcome(mesh);
  const Context context = whole_pipeline(mesh);
  const auto spoil = [](void*, double, const char*) -> int32_t {
    std::fesetround(FE_UPWARD);
    _mm_setcsr(_mm_getcsr() | 0x8040);
    return 0;
  };
  ASSERT_EQ(beltrami_run(context.get(), spoil, nullptr), BELTRAMI_OK);
  EXPECT_EQ(std::fegetround(), FE_TONEAREST);
  EXPECT_TRUE(same_bits(uvs(context, mesh.positions.size()), expected.uvs));
}
#endif

}  // namespace
}  // namespace beltrami
