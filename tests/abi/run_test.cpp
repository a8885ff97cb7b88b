// Runs: states, progress, cancellation, results and their bits.
#include <atomic>
#include <cmath>
#include <thread>

#include "abi/host.h"
#include "base/types.h"
#include "base/vectors.h"
#include "support/disks.h"
#include "support/meshes.h"

namespace beltrami {
namespace {

using namespace host;
using meshes::TriangleList;

Context loaded_with(const TriangleList& mesh, int32_t method) {
  Context context = loaded(mesh);
  EXPECT_EQ(beltrami_set_int(context.get(), BELTRAMI_OPTION_METHOD, method), BELTRAMI_OK);
  return context;
}

TEST(Run, NeedsAMesh) {
  const Context context = create();
  EXPECT_EQ(run(context), BELTRAMI_E_INVALID_STATE);
  EXPECT_NE(message(context).find("beltrami_set_mesh"), std::string::npos);
}

TEST(Run, ResultsNeedARun) {
  const Context context = loaded(meshes::quad());
  beltrami_context* c = context.get();
  auto result = sized<beltrami_result>();
  auto certificate = sized<beltrami_certificate>();
  auto energy = sized<beltrami_energy>();
  auto stage = sized<beltrami_stage>();
  double room[8];
  EXPECT_EQ(beltrami_get_result(c, &result), BELTRAMI_E_INVALID_STATE);
  EXPECT_EQ(beltrami_get_certificate(c, &certificate), BELTRAMI_E_INVALID_STATE);
  EXPECT_EQ(beltrami_get_energy(c, &energy), BELTRAMI_E_INVALID_STATE);
  EXPECT_EQ(beltrami_get_stage(c, 0, &stage), BELTRAMI_E_INVALID_STATE);
  EXPECT_EQ(beltrami_get_uvs(c, room, BELTRAMI_F64, 0), BELTRAMI_E_INVALID_STATE);
  EXPECT_EQ(beltrami_get_face_energies(c, room, 0), BELTRAMI_E_INVALID_STATE);
  EXPECT_NE(message(context).find("beltrami_run"), std::string::npos);
  EXPECT_EQ(beltrami_stage_count(c), 0);
}

class EveryMethod : public testing::TestWithParam<int32_t> {};
INSTANTIATE_TEST_SUITE_P(Run, EveryMethod,
                         testing::Values(BELTRAMI_METHOD_BELTRAMI, BELTRAMI_METHOD_CM,
                                         BELTRAMI_METHOD_TUTTE),
                         [](const auto& parameter) {
                           return std::string(
                               beltrami_option_choice(BELTRAMI_OPTION_METHOD, parameter.param));
                         });

TEST_P(EveryMethod, FlattensInjectively) {
  for (const TriangleList& mesh :
       {meshes::triangle(), meshes::quad(), meshes::fan(5), meshes::strip(9), meshes::bumps(12, 9),
        meshes::cap(6, 11, 1.5)}) {
    SCOPED_TRACE(testing::Message() << mesh.faces.size() << " faces");
    const Context context = loaded_with(mesh, GetParam());
    ASSERT_EQ(run(context), BELTRAMI_OK) << message(context);
    EXPECT_EQ(message(context), "");
    auto certificate = sized<beltrami_certificate>(), checked = certificate;
    ASSERT_EQ(beltrami_get_certificate(context.get(), &certificate), BELTRAMI_OK);
    EXPECT_EQ(certificate.injective, 1);
    EXPECT_EQ(certificate.positive, mesh.faces.size());
    const auto got = uvs(context, mesh.positions.size());
    const beltrami_mesh mesh_view = view(mesh);
    const beltrami_buffer uv_view = view(got);
    EXPECT_EQ(beltrami_check_injective(&mesh_view, &uv_view, &checked), BELTRAMI_OK);
    EXPECT_EQ(std::memcmp(&checked, &certificate, sizeof checked), 0)
        << "the certificate is of the UVs as returned";
  }
}

TEST(Run, CertifiesTheFloatsThatItHandsOut) {
  for (const TriangleList& mesh :
       {disks::slivers(12, 12), disks::tube(40, 6, 0.2), disks::ramp(50, 4), disks::punctured(3)}) {
    const Context context = whole_pipeline(mesh);
    ASSERT_EQ(run(context), BELTRAMI_OK);
    std::vector<std::array<float, 2>> got(mesh.positions.size());
    ASSERT_EQ(beltrami_get_uvs(context.get(), got.data(), BELTRAMI_F32, 0), BELTRAMI_OK);
    auto certificate = sized<beltrami_certificate>(), checked = certificate;
    ASSERT_EQ(beltrami_get_float32_certificate(context.get(), &certificate), BELTRAMI_OK);
    EXPECT_EQ(certificate.injective, 1);
    const beltrami_mesh mesh_view = view(mesh);
    const beltrami_buffer uv_view = view(got);
    EXPECT_EQ(beltrami_check_injective(&mesh_view, &uv_view, &checked), BELTRAMI_OK);
    EXPECT_EQ(std::memcmp(&checked, &certificate, sizeof checked), 0);

    ASSERT_EQ(beltrami_set_int(context.get(), BELTRAMI_OPTION_FLOAT32, 1), BELTRAMI_OK);
    ASSERT_EQ(run(context), BELTRAMI_OK);
    const auto wide = uvs(context, mesh.positions.size());
    for (std::size_t v = 0; v < wide.size(); ++v) {
      EXPECT_EQ(wide[v], (std::array<double, 2>{got[v][0], got[v][1]}));
    }
  }
}

TEST(Run, HandsOutTheTrianglesThatItsCertificateSpeaksOf) {
  TriangleList mesh = disks::slivers(24, 24);
  Context context = whole_pipeline(mesh);
  beltrami_context* c = context.get();
  std::vector<Triangle> faces(mesh.faces.size());
  ASSERT_EQ(run(context), BELTRAMI_OK);
  ASSERT_EQ(beltrami_get_faces(c, faces.data(), BELTRAMI_U32, 0), BELTRAMI_OK);
  EXPECT_EQ(faces, mesh.faces);

  for (const int32_t flatten : {BELTRAMI_FLATTEN_DIRICHLET, BELTRAMI_FLATTEN_METRIC}) {
    ASSERT_EQ(beltrami_set_int(c, BELTRAMI_OPTION_DELAUNAY, 1), BELTRAMI_OK);
    ASSERT_EQ(beltrami_set_int(c, BELTRAMI_OPTION_FLATTEN, flatten), BELTRAMI_OK);
    ASSERT_EQ(run(context), BELTRAMI_OK);
    auto result = sized<beltrami_result>();
    ASSERT_EQ(beltrami_get_result(c, &result), BELTRAMI_OK);
    EXPECT_GT(result.delaunay_flips, 0u);
    ASSERT_EQ(beltrami_get_faces(c, faces.data(), BELTRAMI_U32, 0), BELTRAMI_OK);
    EXPECT_NE(faces, mesh.faces);
    TriangleList flipped = mesh;
    flipped.faces = faces;
    const beltrami_mesh mesh_view = view(flipped);
    const auto got = uvs(context, mesh.positions.size());
    const beltrami_buffer uv_view = view(got);
    auto checked = sized<beltrami_certificate>();
    EXPECT_EQ(beltrami_check_injective(&mesh_view, &uv_view, &checked), BELTRAMI_OK);
  }
  std::vector<std::array<uint64_t, 4>> wide(faces.size(), {9, 9, 9, 9});
  ASSERT_EQ(beltrami_get_faces(c, wide.data(), BELTRAMI_U64, sizeof wide[0]), BELTRAMI_OK);
  for (std::size_t f = 0; f < faces.size(); ++f) {
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(wide[f][k], static_cast<uint64_t>(faces[f][k]));
    EXPECT_EQ(wide[f][3], 9u);
  }
  EXPECT_EQ(beltrami_get_faces(c, nullptr, BELTRAMI_U32, 0), BELTRAMI_E_INVALID_ARGUMENT);
  EXPECT_EQ(beltrami_get_faces(c, wide.data(), BELTRAMI_F64, 0), BELTRAMI_E_INVALID_ARGUMENT);
}

TEST(Run, NamesTheFacesWithoutArea) {
  const Context context = whole_pipeline(disks::degenerate_faces(12));
  ASSERT_EQ(run(context), BELTRAMI_OK);
  auto result = sized<beltrami_result>();
  ASSERT_EQ(beltrami_get_result(context.get(), &result), BELTRAMI_OK);
  EXPECT_GT(result.degenerate_faces, 0u);
  EXPECT_LT(result.first_degenerate_face, result.faces);
  auto energy = sized<beltrami_energy>();
  ASSERT_EQ(beltrami_get_energy(context.get(), &energy), BELTRAMI_OK);
  EXPECT_TRUE(std::isfinite(energy.symmetric_dirichlet));
}

TEST_P(EveryMethod, ReportsItsStages) {
  const TriangleList mesh = meshes::bumps(12, 9);
  const Context context = loaded_with(mesh, GetParam());
  ASSERT_EQ(run(context), BELTRAMI_OK);
  const int32_t stages = beltrami_stage_count(context.get());
  ASSERT_GE(stages, 1);
  auto result = sized<beltrami_result>();
  ASSERT_EQ(beltrami_get_result(context.get(), &result), BELTRAMI_OK);
  double seconds = 0;
  for (int32_t i = 0; i < stages; ++i) {
    auto stage = sized<beltrami_stage>();
    ASSERT_EQ(beltrami_get_stage(context.get(), i, &stage), BELTRAMI_OK);
    EXPECT_STRNE(stage.name, "");
    EXPECT_GE(stage.seconds, 0);
    EXPECT_GE(stage.cpu_seconds, 0);
    EXPECT_GE(stage.iterations, 0);
    seconds += stage.seconds;
  }
  EXPECT_LE(seconds, result.seconds + 1e-6);
  EXPECT_EQ(result.status, BELTRAMI_OK);
  EXPECT_GT(result.peak_memory_bytes, 0u);
  EXPECT_GT(result.area, 1);
  auto stage = sized<beltrami_stage>();
  EXPECT_EQ(beltrami_get_stage(context.get(), stages, &stage), BELTRAMI_E_INVALID_ARGUMENT);
  EXPECT_EQ(beltrami_get_stage(context.get(), -1, &stage), BELTRAMI_E_INVALID_ARGUMENT);
}

TEST_P(EveryMethod, GivesTheSameBitsAtAnyNumberOfThreadsAndTimes) {
  const TriangleList mesh = meshes::bumps(40, 37);
  const Context context = loaded_with(mesh, GetParam());
  ASSERT_EQ(beltrami_set_int(context.get(), BELTRAMI_OPTION_COARSE_FACES, 400), BELTRAMI_OK);
  ASSERT_GE(run(context), BELTRAMI_OK);
  const auto expected = uvs(context, mesh.positions.size());
  for (const int threads : {1, 2, 7}) {
    ASSERT_EQ(beltrami_set_int(context.get(), BELTRAMI_OPTION_THREADS, threads), BELTRAMI_OK);
    ASSERT_GE(run(context), BELTRAMI_OK);
    EXPECT_TRUE(same_bits(uvs(context, mesh.positions.size()), expected)) << threads << " threads";
  }
}

TEST_P(EveryMethod, KeepsTheUnitOfLength) {
  // Scaling by a power of two scales the UVs by it, to the bit.
  const TriangleList mesh = meshes::bumps(10, 10);
  TriangleList scaled = mesh;
  for (Vec3& p : scaled.positions) p *= 1024;
  const Context one = loaded_with(mesh, GetParam()), other = loaded_with(scaled, GetParam());
  ASSERT_GE(run(one), BELTRAMI_OK);
  ASSERT_GE(run(other), BELTRAMI_OK);
  auto expected = uvs(one, mesh.positions.size());
  for (auto& uv : expected) {
    for (double& x : uv) x *= 1024;
  }
  EXPECT_EQ(uvs(other, mesh.positions.size()), expected);
  auto a = sized<beltrami_result>(), b = sized<beltrami_result>();
  ASSERT_EQ(beltrami_get_result(one.get(), &a), BELTRAMI_OK);
  ASSERT_EQ(beltrami_get_result(other.get(), &b), BELTRAMI_OK);
  EXPECT_EQ(b.area, a.area * 1024 * 1024);
}

struct Watch {
  beltrami_context* context = nullptr;
  std::thread::id thread = std::this_thread::get_id();
  double last = -1;
  int calls = 0;
  int stop_at = -1;     ///< the call that returns non-zero
  int cancel_at = -1;   ///< the call that calls beltrami_cancel
  bool meddle = false;  ///< calls what is not allowed during a run
};

int32_t watch(void* user, double fraction, const char* stage) {
  auto& self = *static_cast<Watch*>(user);
  EXPECT_EQ(std::this_thread::get_id(), self.thread);
  EXPECT_GE(fraction, self.last);
  EXPECT_GE(fraction, 0);
  EXPECT_LE(fraction, 1);
  EXPECT_NE(stage, nullptr);
  self.last = fraction;
  if (self.calls == self.cancel_at) beltrami_cancel(self.context);
  if (self.meddle) {
    const TriangleList quad = meshes::quad();
    const beltrami_mesh mesh = view(quad);
    auto result = sized<beltrami_result>();
    beltrami_context* c = self.context;
    EXPECT_EQ(beltrami_run(c, nullptr, nullptr), BELTRAMI_E_INVALID_STATE);
    EXPECT_EQ(beltrami_set_mesh(c, &mesh), BELTRAMI_E_INVALID_STATE);
    EXPECT_EQ(beltrami_set_int(c, BELTRAMI_OPTION_THREADS, 2), BELTRAMI_E_INVALID_STATE);
    EXPECT_EQ(beltrami_set_float(c, BELTRAMI_OPTION_TOLERANCE, 0), BELTRAMI_E_INVALID_STATE);
    EXPECT_EQ(beltrami_get_result(c, &result), BELTRAMI_E_INVALID_STATE);
    EXPECT_STRNE(beltrami_error_message(c), "");
  }
  return self.calls++ == self.stop_at ? 1 : 0;
}

TEST_P(EveryMethod, ReportsProgressOnTheCallersThreadAndNeverBack) {
  const Context context = loaded_with(meshes::bumps(30, 30), GetParam());
  ASSERT_EQ(beltrami_set_int(context.get(), BELTRAMI_OPTION_COARSE_FACES, 300), BELTRAMI_OK);
  ASSERT_EQ(beltrami_set_int(context.get(), BELTRAMI_OPTION_THREADS, 4), BELTRAMI_OK);
  Watch state{context.get()};
  ASSERT_GE(beltrami_run(context.get(), watch, &state), BELTRAMI_OK);
  EXPECT_GE(state.calls, 2);
  EXPECT_EQ(state.last, 1);
}

TEST(Run, RefusesCallsFromItsOwnProgress) {
  const Context context = loaded(meshes::bumps(6, 6));
  Watch state{context.get()};
  state.meddle = true;
  EXPECT_EQ(beltrami_run(context.get(), watch, &state), BELTRAMI_OK);
  EXPECT_EQ(message(context), "");
  auto result = sized<beltrami_result>();
  EXPECT_EQ(beltrami_get_result(context.get(), &result), BELTRAMI_OK);
}

/// How often a run of this context calls its progress.
int calls_of_a_run(const Context& context) {
  Watch state{context.get()};
  EXPECT_EQ(beltrami_run(context.get(), watch, &state), BELTRAMI_OK);
  return state.calls;
}

TEST(Cancel, FromAnyCallOfProgressKeepsTheOldResults) {
  const TriangleList mesh = meshes::bumps(6, 6);
  const Context context = loaded(mesh);
  const int calls = calls_of_a_run(context);
  const auto before = uvs(context, mesh.positions.size());
  for (int at = 0; at < calls; ++at) {  // the last call included
    for (const bool by_return : {true, false}) {
      Watch state{context.get()};
      (by_return ? state.stop_at : state.cancel_at) = at;
      EXPECT_EQ(beltrami_run(context.get(), watch, &state), BELTRAMI_E_CANCELLED)
          << "call " << at << " of " << calls;
      EXPECT_NE(message(context), "");
      EXPECT_EQ(state.calls, at + 1) << "not called again";
      EXPECT_TRUE(same_bits(uvs(context, mesh.positions.size()), before));
    }
  }
  EXPECT_EQ(run(context), BELTRAMI_OK) << "a request serves one run only";
}

TEST(Cancel, BeforeARunStopsThatRunOnly) {
  const Context context = loaded(meshes::quad());
  beltrami_cancel(context.get());
  beltrami_cancel(context.get());
  EXPECT_EQ(run(context), BELTRAMI_E_CANCELLED);
  EXPECT_EQ(run(context), BELTRAMI_OK);
}

TEST(Cancel, IsDroppedByANewMesh) {
  const Context context = loaded(meshes::quad());
  beltrami_cancel(context.get());
  ASSERT_EQ(set_mesh(context, meshes::triangle()), BELTRAMI_OK);
  EXPECT_EQ(run(context), BELTRAMI_OK);
}

/// Holds a run up in its first call of progress until somebody lets go.
struct Gate {
  std::atomic<bool> reached{false}, open{false};

  static int32_t pass(void* user, double, const char*) {
    auto& self = *static_cast<Gate*>(user);
    self.reached = true;
    while (!self.open) std::this_thread::yield();
    return 0;
  }
};

TEST(Cancel, FromAnotherThreadEndsTheRun) {
  const Context context = loaded_with(meshes::bumps(30, 30), BELTRAMI_METHOD_CM);
  Gate gate;
  std::thread other([&] {
    while (!gate.reached) std::this_thread::yield();
    beltrami_cancel(context.get());
    gate.open = true;
  });
  EXPECT_EQ(beltrami_run(context.get(), Gate::pass, &gate), BELTRAMI_E_CANCELLED);
  other.join();
}

TEST(Cancel, OfOneContextLeavesAnotherOnTheSameThreadAlone) {
  // The inner run takes place inside a progress call of the outer one, which is cancelled by then.
  struct Nested {
    beltrami_context *outer, *inner;
    bool cancel_inner;
    beltrami_status inner_status, check_status;
  };
  const auto run_inside = [](void* user, double, const char*) -> int32_t {
    auto& self = *static_cast<Nested*>(user);
    beltrami_cancel(self.cancel_inner ? self.inner : self.outer);
    self.inner_status = beltrami_run(self.inner, nullptr, nullptr);
    const TriangleList quad = meshes::quad();
    const beltrami_mesh mesh = view(quad);
    const auto flat = flat_uvs(quad);
    const beltrami_buffer uv_view = view(flat);
    auto certificate = sized<beltrami_certificate>();
    self.check_status = beltrami_check_injective(&mesh, &uv_view, &certificate);
    return 0;
  };
  const Context outer = whole_pipeline(meshes::bumps(30, 30));
  const Context inner = whole_pipeline(meshes::bumps(30, 30));
  Nested nested{outer.get(), inner.get(), false, BELTRAMI_E_INTERNAL, BELTRAMI_E_INTERNAL};
  EXPECT_EQ(beltrami_run(outer.get(), run_inside, &nested), BELTRAMI_E_CANCELLED);
  EXPECT_EQ(nested.inner_status, BELTRAMI_OK);
  EXPECT_EQ(nested.check_status, BELTRAMI_OK);
  nested.cancel_inner = true;
  EXPECT_EQ(beltrami_run(outer.get(), run_inside, &nested), BELTRAMI_OK);
  EXPECT_EQ(nested.inner_status, BELTRAMI_E_CANCELLED);
}

TEST(Cancel, OfOneContextLeavesAnotherOnAnotherThreadAlone) {
  const Context cancelled = loaded_with(meshes::bumps(30, 30), BELTRAMI_METHOD_CM);
  Gate gate;
  std::thread other(
      [&] { EXPECT_EQ(beltrami_run(cancelled.get(), Gate::pass, &gate), BELTRAMI_E_CANCELLED); });
  while (!gate.reached) std::this_thread::yield();
  const Context undisturbed = whole_pipeline(meshes::bumps(40, 40));
  const auto cancel = [](void* user, double, const char*) -> int32_t {
    beltrami_cancel(static_cast<beltrami_context*>(user));
    return 0;
  };
  EXPECT_EQ(beltrami_run(undisturbed.get(), cancel, cancelled.get()), BELTRAMI_OK);
  gate.open = true;
  other.join();
}

TEST(Contexts, ShareNothingAcrossThreads) {
  const TriangleList meshes_of[2] = {meshes::bumps(14, 10), meshes::cap(7, 12, 1.8)};
  std::vector<std::array<double, 2>> expected[2], found[2];
  for (int i = 0; i < 2; ++i) {
    const Context context = loaded(meshes_of[i]);
    ASSERT_EQ(run(context), BELTRAMI_OK);
    expected[i] = uvs(context, meshes_of[i].positions.size());
  }
  const auto work = [&](int i) {
    for (int round = 0; round < 8; ++round) {
      const Context context = loaded(meshes_of[i]);
      EXPECT_EQ(set_mesh(context, meshes::octahedron()), BELTRAMI_E_CLOSED);
      EXPECT_EQ(run(context), BELTRAMI_OK);
      found[i] = uvs(context, meshes_of[i].positions.size());
      EXPECT_TRUE(same_bits(found[i], expected[i]));
    }
  };
  std::thread other(work, 0);
  work(1);
  other.join();
}

}  // namespace
}  // namespace beltrami
