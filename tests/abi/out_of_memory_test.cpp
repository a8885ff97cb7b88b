// Every allocation fails once: the library answers with a status and goes on working.
#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <vector>

#include "abi/host.h"
#include "base/types.h"
#include "support/meshes.h"
#include "support/surfaces.h"

namespace {

/// Of all threads: which allocations from now on fail.
enum class Fails { kNone, kOne, kAllFrom };
std::atomic<Fails> fails = Fails::kNone;
std::atomic<long> to_come = 0;  // allocations before the first of them
std::atomic<long> living = 0;   // pieces of memory that were not given back

bool refuses() {
  const Fails which = fails.load();
  if (which == Fails::kNone) return false;
  const long before = to_come.fetch_sub(1);
  return which == Fails::kOne ? before == 0 : before <= 0;
}

void* counted(void* memory) {
  if (memory != nullptr) ++living;
  return memory;
}

}  // namespace

#ifdef BELTRAMI_REPLACES_MALLOC
// What the C library and Eigen allocate fails, too.
extern "C" {
void* __libc_malloc(std::size_t size) noexcept;
void* __libc_calloc(std::size_t count, std::size_t size) noexcept;
void* __libc_realloc(void* memory, std::size_t size) noexcept;
void* __libc_memalign(std::size_t alignment, std::size_t size) noexcept;
void __libc_free(void* memory) noexcept;

void* malloc(std::size_t size) noexcept {
  if (!refuses()) return counted(__libc_malloc(size));
  errno = ENOMEM;
  return nullptr;
}
void* calloc(std::size_t count, std::size_t size) noexcept {
  if (!refuses()) return counted(__libc_calloc(count, size));
  errno = ENOMEM;
  return nullptr;
}
void* realloc(void* memory, std::size_t size) noexcept {
  if (!refuses()) return memory == nullptr ? malloc(size) : __libc_realloc(memory, size);
  errno = ENOMEM;
  return nullptr;
}
void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  if (!refuses()) return counted(__libc_memalign(alignment, size));
  errno = ENOMEM;
  return nullptr;
}
int posix_memalign(void** memory, std::size_t alignment, std::size_t size) noexcept {
  *memory = aligned_alloc(alignment, size);
  return *memory == nullptr ? ENOMEM : 0;
}
void free(void* memory) noexcept {
  if (memory != nullptr) --living;
  __libc_free(memory);
}
}
#else
// Where malloc is the sanitizers' business, contexts take memory from here.
namespace {
void* allocate(void*, std::uint64_t bytes, std::uint64_t alignment) {
  if (refuses()) return nullptr;
  return counted(std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment));
}
void release(void*, void* block, std::uint64_t, std::uint64_t) {
  --living;
  std::free(block);
}
const beltrami_allocator counting = {sizeof counting, 0, nullptr, allocate, release};
[[maybe_unused]] const auto* const used = beltrami::host::memory = &counting;
}  // namespace
#endif

namespace beltrami {
namespace {

using namespace host;
using meshes::TriangleList;

/// What a call returns whose allocations fail, some or one, after so many; and what it leaves.
template <class Call>
beltrami_status call_with(Fails which, long after, const Call& call) {
  to_come = after;
  fails = which;
  const beltrami_status status = call();
  fails = Fails::kNone;
  return status;
}

template <class Call>
long allocations_of(const Call& call) {
  constexpr long kMany = 1L << 40;
  EXPECT_EQ(call_with(Fails::kAllFrom, kMany, call), BELTRAMI_OK);
  return kMany - to_come;
}

/// Calls `call` with 0, 1, 2, ... allocations allowed until it succeeds; it must fail with
/// OUT_OF_MEMORY until then. Returns the number of failures.
template <class Call>
long failures_of(const Call& call) {
  for (long allowance = 0; allowance < 100000; ++allowance) {
    const beltrami_status status = call_with(Fails::kAllFrom, allowance, call);
    if (status == BELTRAMI_OK) return allowance;
    EXPECT_EQ(status, BELTRAMI_E_OUT_OF_MEMORY) << "after " << allowance << " allocations";
    if (status != BELTRAMI_E_OUT_OF_MEMORY) return -1;
  }
  ADD_FAILURE() << "never succeeds";
  return -1;
}

/// Lets about `times` of the allocations of a call fail, each alone in a call of its own; what
/// comes after it succeeds, as what a handler does. The call is to say so, to leave nothing behind
/// and to change nothing, or to do without (std::stable_sort does); then it succeeds. `results` is
/// what it has led to.
template <class Call, class Results>
void expect_status_wherever_memory_ends(const Call& call, long times, const Results& results) {
  ASSERT_EQ(call(), BELTRAMI_OK);
  const auto expected = results();
  const long all = allocations_of(call), stride = std::max(1L, all / times);
  long failures = 0;
  for (long after = 0; after < all; after += stride) {
    const long before = living;
    const beltrami_status status = call_with(Fails::kOne, after, call);
    if (status != BELTRAMI_OK) {
      ++failures;
      EXPECT_EQ(status, BELTRAMI_E_OUT_OF_MEMORY) << "after " << after << " of " << all;
      EXPECT_EQ(living, before) << "after " << after << " of " << all;
    }
    ASSERT_TRUE(same_bits(results(), expected)) << "after " << after << " of " << all;
  }
  EXPECT_GE(failures, 5);
  EXPECT_EQ(call(), BELTRAMI_OK);
  EXPECT_TRUE(same_bits(results(), expected));
}

/// Two triangles apart, each a chart.
struct TwoCharts {
  std::vector<std::array<double, 2>> uvs = {{0, 0}, {1, 0}, {0, 1}, {3, 0}, {4, 0}, {3, 1}};
  std::vector<Triangle> faces = {{0, 1, 2}, {3, 4, 5}};

  beltrami_uv_mesh view() const {
    auto mesh = sized<beltrami_uv_mesh>();
    mesh.uv_count = uvs.size();
    mesh.face_count = faces.size();
    mesh.uvs = host::view(uvs);
    mesh.uv_indices = {faces.data(), 0, BELTRAMI_U32, 0};
    return mesh;
  }
};

/// A context for small pages and one thread, or several.
Context for_small_pages(std::uint64_t threads = 1) {
  Context context = create();
  set_option(context, BELTRAMI_OPTION_THREADS, threads);
  set_option(context, BELTRAMI_OPTION_RESOLUTION, 64);
  return context;
}

TEST(OutOfMemory, CreateAnswers) {
  beltrami_context* context = nullptr;
  EXPECT_GE(failures_of([&] {
              const beltrami_status status = beltrami_create_with(memory, &context);
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
    status = call_with(Fails::kAllFrom, allowance, [&] { return run(context); });
    if (status == BELTRAMI_OK) break;
    ASSERT_EQ(status, BELTRAMI_E_OUT_OF_MEMORY) << "after " << allowance << " allocations";
    EXPECT_NE(message(context), "");
  }
  EXPECT_GE(failures, 20);
}

TEST(OutOfMemory, ARunAnswersWhereverMemoryEnds) {
  const TriangleList mesh = meshes::bumps(16, 16);
  const Context context = whole_pipeline(mesh);
  set_option(context, BELTRAMI_OPTION_THREADS, 1);
  expect_status_wherever_memory_ends([&] { return run(context); }, 60,
                                     [&] { return uvs(context, mesh.positions.size()); });
}

TEST(OutOfMemory, AnAtlasAnswersWhereverMemoryEnds) {
  if (beltrami_has("gpl")) GTEST_SKIP() << "CHOLMOD keeps two blocks where memory ends";
  const TriangleList mesh = meshes::cube();
  const beltrami_surface surface = surface_view(mesh);
  const Context context = for_small_pages();
  expect_status_wherever_memory_ends(
      [&] { return beltrami_unwrap(context.get(), &surface, nullptr, nullptr); }, 60,
      [&] {
        std::vector<std::array<double, 2>> uvs(3 * mesh.faces.size());
        EXPECT_EQ(beltrami_get_corner_uvs(context.get(), uvs.data(), BELTRAMI_F64, 0), BELTRAMI_OK);
        return uvs;
      });
}

TEST(OutOfMemory, APackingAnswersWhereverMemoryEnds) {
  const TwoCharts charts;
  const beltrami_uv_mesh mesh = charts.view();
  const beltrami_uv_mesh* const meshes[] = {&mesh};
  const Context context = for_small_pages();
  const auto pack = [&] { return beltrami_pack(context.get(), meshes, 1, nullptr, nullptr); };
  const auto results = [&] {
    std::vector<std::array<double, 2>> uvs(charts.uvs.size());
    EXPECT_EQ(beltrami_get_packed_uvs(context.get(), 0, uvs.data(), BELTRAMI_F64, 0), BELTRAMI_OK);
    return uvs;
  };
  expect_status_wherever_memory_ends(pack, 20, results);
  // At a density that is given little is tried, and each allocation can fail, those for what is
  // given back among them.
  set_option(context, BELTRAMI_OPTION_RESOLUTION, 16);
  const beltrami_status sparse =
      beltrami_set_float(context.get(), BELTRAMI_OPTION_TEXELS_PER_UNIT, 2);
  ASSERT_EQ(sparse, BELTRAMI_OK);
  expect_status_wherever_memory_ends(pack, 1L << 40, results);
}

TEST(OutOfMemory, ASessionAnswersWhereverMemoryEnds) {
  const TriangleList mesh = meshes::bumps(5, 5);
  const beltrami_surface surface = surface_view(mesh);
  const Context context = for_small_pages();
  beltrami_context* const c = context.get();
  const auto begin = [&] { return beltrami_session_begin(c, &surface, nullptr, nullptr); };
  const auto session_uvs = [&] {
    std::vector<std::array<double, 2>> uvs(3 * mesh.faces.size());
    EXPECT_EQ(beltrami_get_session_uvs(c, uvs.data(), BELTRAMI_F64, 0), BELTRAMI_OK);
    return uvs;
  };
  expect_status_wherever_memory_ends(begin, 60, session_uvs);
  ASSERT_EQ(beltrami_session_update(c, 0, 0, nullptr, nullptr), BELTRAMI_OK);
  ASSERT_EQ(beltrami_session_pack(c, nullptr, 0, nullptr, nullptr), BELTRAMI_OK);
  std::uint64_t mark = 0;
  ASSERT_EQ(beltrami_session_save(c, &mark), BELTRAMI_OK);
  const auto saved = session_uvs();
  // All of a call is done, or nothing: from where the session was saved.
  const auto all_or_nothing = [&](const auto& call) {
    ASSERT_EQ(call(), BELTRAMI_OK);
    const auto made = session_uvs();
    ASSERT_EQ(beltrami_session_restore(c, mark), BELTRAMI_OK);
    const long all = allocations_of(call), stride = std::max(1L, all / 60);
    EXPECT_TRUE(same_bits(session_uvs(), made));
    ASSERT_EQ(beltrami_session_restore(c, mark), BELTRAMI_OK);
    long before = -1;  // of the first round alone what is kept from then on
    for (long after = 0; after < all; after += stride) {
      const beltrami_status status = call_with(Fails::kOne, after, call);
      EXPECT_TRUE(status == BELTRAMI_E_OUT_OF_MEMORY || status == BELTRAMI_OK) << after;
      EXPECT_TRUE(same_bits(session_uvs(), status == BELTRAMI_OK ? made : saved)) << after;
      ASSERT_EQ(beltrami_session_restore(c, mark), BELTRAMI_OK);
      const long left = living;
      if (before >= 0 && status != BELTRAMI_OK) {
        EXPECT_EQ(left, before) << after;
      }
      before = left;
    }
  };
  const std::array<std::uint32_t, 6> ends = {2, 8, 8, 14, 14, 20};
  const beltrami_buffer edges = {ends.data(), 0, BELTRAMI_U32, 0};
  all_or_nothing([&] {
    const beltrami_status noted = beltrami_session_set_seams(c, &edges, 3, 1);
    return noted == BELTRAMI_OK ? beltrami_session_update(c, 0, 0, nullptr, nullptr) : noted;
  });
  all_or_nothing([&] { return beltrami_session_pack(c, nullptr, 0, nullptr, nullptr); });
  all_or_nothing([&] { return beltrami_session_restore(c, mark); });
  auto certificate = sized<beltrami_atlas_certificate>();
  all_or_nothing([&] { return beltrami_session_check(c, &certificate); });
}

TEST(OutOfMemory, ABakingAnswersWhereverMemoryEnds) {
  // Normals of an image that is made smaller, and places of another surface.
  const std::vector<double> old_uvs = {0, 0, 3, 0, 3, 3, 0, 0, 3, 3, 0, 3};
  const std::vector<double> new_uvs = {0, 0, 1, 0, 1, 1, 0, 0, 1, 1, 0, 1};
  const std::vector<double> positions = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1, 0, 0, 1, 0};
  const std::vector<std::uint8_t> texels(3 * 16 * 16, 99);
  std::vector<std::uint8_t> pixels(3 * 8 * 8);
  const beltrami_image image = {texels.data(), 16, 16, 0, BELTRAMI_U8, 3};
  const Context context = create();
  for (const bool elsewhere : {false, true}) {
    auto job = sized<beltrami_bake_job>();
    job.images = &image;
    job.image_count = 1;
    job.pixels = elsewhere ? BELTRAMI_PIXELS_SRGB : BELTRAMI_PIXELS_NORMALS;
    job.face_count = 2;
    job.new_uvs = {new_uvs.data(), 0, BELTRAMI_F64, 0};
    job.old_uvs = {old_uvs.data(), 0, BELTRAMI_F64, 0};
    job.positions = {positions.data(), 0, BELTRAMI_F64, 0};
    if (elsewhere) {
      job.source_face_count = 2;
      job.source_positions = job.positions;
    }
    job.resolution = 8;
    job.gutter = std::numeric_limits<std::uint64_t>::max();
    job.page_count = 1;
    auto baked = sized<beltrami_baked>();
    baked.pixels = pixels.data();
    const auto bake = [&] { return beltrami_bake(context.get(), &job, &baked, nullptr, nullptr); };
    // After an error pixels hold anything: what matters is that the next baking makes them.
    expect_status_wherever_memory_ends(bake, 1L << 40, [&] {
      EXPECT_EQ(bake(), BELTRAMI_OK);
      return pixels;
    });
  }
}

TEST(OutOfMemory, ThreadsAnswer) {
  // Where a thread cannot be started for want of memory a run may go on with those that it has.
  const TriangleList mesh = meshes::torus(8);
  const beltrami_surface surface = surface_view(mesh);
  const Context context = for_small_pages(3);
  const auto unwrap = [&] { return beltrami_unwrap(context.get(), &surface, nullptr, nullptr); };
  const long all = allocations_of(unwrap);
  for (long after = 0; after < all; after += all / 20 + 1) {
    const beltrami_status status = call_with(Fails::kOne, after, unwrap);
    EXPECT_TRUE(status == BELTRAMI_E_OUT_OF_MEMORY || status == BELTRAMI_OK) << after;
  }
  EXPECT_EQ(unwrap(), BELTRAMI_OK);
}

#ifdef BELTRAMI_REPLACES_MALLOC
// Checks have no context: their memory is the C library's.
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

TEST(OutOfMemory, ChecksOfAtlasesAnswer) {
  const TriangleList mesh = meshes::grid(4, 4);
  std::vector<std::array<double, 2>> corners;
  for (const Triangle& face : mesh.faces) {
    for (const Index v : face) corners.push_back({mesh.positions[v].x(), mesh.positions[v].y()});
  }
  beltrami_surface surface = surface_view(mesh);
  surface.corner_uvs = view(corners);
  auto certificate = sized<beltrami_atlas_certificate>();
  const auto check = [&] { return beltrami_check_atlas(&surface, 0, &certificate, nullptr, 0); };
  EXPECT_GE(failures_of(check), 5);
  expect_status_wherever_memory_ends(check, 1L << 40, [] { return std::vector<int>(); });
}
#endif

TEST(OutOfMemory, AMessageWithoutMemoryIsTheAdvice) {
  const Context context = create();
  for (long allowance = 0; allowance < 8; ++allowance) {
    const beltrami_status status = call_with(Fails::kAllFrom, allowance, [&] {
      return beltrami_set_int(context.get(), BELTRAMI_OPTION_METHOD, 99);
    });
    EXPECT_TRUE(status == BELTRAMI_E_OUT_OF_MEMORY || status == BELTRAMI_E_INVALID_ARGUMENT);
    EXPECT_NE(message(context), "");
  }
}

}  // namespace
}  // namespace beltrami
