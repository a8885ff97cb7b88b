// Every allocation fails once: the library answers with a status and goes on working.
#include <cstdlib>
#include <new>

#include "abi/host.h"
#include "support/meshes.h"

namespace {

// Allocations of the armed thread that still succeed; negative: not armed.
thread_local long allowed = -1;

void* allocate(std::size_t size) {
  if (allowed == 0) return nullptr;
  if (allowed > 0) --allowed;
  return std::malloc(size > 0 ? size : 1);
}

}  // namespace

void* operator new(std::size_t size) {
  if (void* memory = allocate(size)) return memory;
  throw std::bad_alloc();
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return allocate(size);
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, const std::nothrow_t&) noexcept {
  std::free(memory);
}

namespace beltrami {
namespace {

using namespace host;
using meshes::TriangleList;

/// Calls `call` with 0, 1, 2, ... allocations allowed until it succeeds; it must fail with
/// OUT_OF_MEMORY until then. Returns the number of failures.
template <class Call>
long failures_of(Call&& call) {
  for (long allowance = 0; allowance < 100000; ++allowance) {
    allowed = allowance;
    const beltrami_status status = call();
    allowed = -1;
    if (status == BELTRAMI_OK) return allowance;
    EXPECT_EQ(status, BELTRAMI_E_OUT_OF_MEMORY) << "after " << allowance << " allocations";
    if (status != BELTRAMI_E_OUT_OF_MEMORY) return -1;
  }
  ADD_FAILURE() << "never succeeds";
  return -1;
}

TEST(OutOfMemory, CreateAnswers) {
  beltrami_context* context = nullptr;
  EXPECT_GE(failures_of([&] {
              const beltrami_status status = beltrami_create(&context);
              EXPECT_EQ(context != nullptr, status == BELTRAMI_OK);
              return status;
            }),
            1);
  beltrami_destroy(context);
}

TEST(OutOfMemory, SetMeshAnswersAndKeepsTheOldMesh) {
  const TriangleList mesh = meshes::with_unused_in_front(meshes::bumps(4, 4), 3);
  const beltrami_mesh mesh_view = view(mesh);
  const Context context = loaded(meshes::quad());
  ASSERT_EQ(run(context), BELTRAMI_OK);
  EXPECT_GE(failures_of([&] {
              const beltrami_status status = beltrami_set_mesh(context.get(), &mesh_view);
              if (status != BELTRAMI_OK) {
                EXPECT_STRNE(beltrami_error_message(context.get()), "");
                EXPECT_GE(beltrami_stage_count(context.get()), 1);
              }
              return status;
            }),
            5);
  EXPECT_EQ(run(context), BELTRAMI_OK);
}

TEST(OutOfMemory, RunAnswersAndKeepsTheOldResults) {
  const Context context = loaded(meshes::bumps(4, 4));
  EXPECT_GE(failures_of([&] { return run(context); }), 5);
}

TEST(OutOfMemory, EveryStageAnswers) {
  // Too many allocations to let each fail: more and more of them succeed.
  const Context context = whole_pipeline(meshes::bumps(24, 24));
  beltrami_status status = BELTRAMI_E_INTERNAL;
  int failures = 0;
  for (long allowance = 0; status != BELTRAMI_OK; allowance += 1 + allowance / 8, ++failures) {
    allowed = allowance;
    status = run(context);
    allowed = -1;
    if (status == BELTRAMI_OK) break;
    ASSERT_EQ(status, BELTRAMI_E_OUT_OF_MEMORY) << "after " << allowance << " allocations";
    EXPECT_NE(message(context), "");
  }
  EXPECT_GE(failures, 20);
}

TEST(OutOfMemory, ChecksAnswer) {
  const TriangleList mesh = meshes::grid(4, 4);
  const auto flat = flat_uvs(mesh);
  const beltrami_mesh mesh_view = view(mesh);
  const beltrami_buffer uv_view = view(flat);
  auto certificate = sized<beltrami_certificate>();
  auto energy = sized<beltrami_energy>();
  for (const auto check :
       {beltrami_check_triangles, beltrami_check_boundary, beltrami_check_injective}) {
    EXPECT_GE(failures_of([&] { return check(&mesh_view, &uv_view, &certificate); }), 2);
  }
  EXPECT_GE(failures_of([&] { return beltrami_measure(&mesh_view, &uv_view, &energy, nullptr); }),
            2);
}

TEST(OutOfMemory, AMessageWithoutMemoryIsTheAdvice) {
  const Context context = create();
  for (long allowance = 0; allowance < 8; ++allowance) {
    allowed = allowance;
    const beltrami_status status = beltrami_set_int(context.get(), BELTRAMI_OPTION_METHOD, 99);
    allowed = -1;
    EXPECT_TRUE(status == BELTRAMI_E_OUT_OF_MEMORY || status == BELTRAMI_E_INVALID_ARGUMENT);
    EXPECT_NE(message(context), "");
  }
}

}  // namespace
}  // namespace beltrami
