// Memory of the host's in place of the C library's: all of a context's, given back to the last
// byte, and the same bits.
#include <beltrami/beltrami.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <mutex>
#include <new>
#include <set>
#include <thread>
#include <utility>
#include <vector>

#include "abi/host.h"
#include "support/meshes.h"
#include "support/surfaces.h"

namespace beltrami::host {
namespace {

using meshes::TriangleList;

/// An allocator that knows what is out, and from which threads it was asked.
class Ledger {
 public:
  beltrami_allocator allocator() {
    auto made = sized<beltrami_allocator>();
    made.user = this;
    made.allocate = [](void* user, std::uint64_t bytes, std::uint64_t alignment) {
      return static_cast<Ledger*>(user)->allocate(bytes, alignment);
    };
    made.release = [](void* user, void* block, std::uint64_t bytes, std::uint64_t alignment) {
      static_cast<Ledger*>(user)->release(block, bytes, alignment);
    };
    return made;
  }

  std::uint64_t taken() const { return taken_; }  ///< bytes in all
  std::size_t living() const { return out_.size(); }
  std::size_t threads() const { return threads_.size(); }

 private:
  using Request = std::pair<std::uint64_t, std::uint64_t>;

  void* allocate(std::uint64_t bytes, std::uint64_t alignment) {
    EXPECT_GE(alignment, 8u);
    EXPECT_LE(alignment, 4096u);
    EXPECT_EQ(alignment & (alignment - 1), 0u);
    void* const block =
        std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
    const std::lock_guard lock(guard_);
    taken_ += bytes;
    threads_.insert(std::this_thread::get_id());
    out_[block] = {bytes, alignment};
    return block;
  }

  void release(void* block, std::uint64_t bytes, std::uint64_t alignment) {
    {
      const std::lock_guard lock(guard_);
      const auto found = out_.find(block);
      ASSERT_NE(found, out_.end());
      EXPECT_EQ(found->second, Request(bytes, alignment));
      out_.erase(found);
    }
    std::free(block);
  }

  std::mutex guard_;
  std::map<void*, Request> out_;
  std::set<std::thread::id> threads_;
  std::uint64_t taken_ = 0;
};

Context create_with(Ledger& ledger) {
  const beltrami_allocator allocator = ledger.allocator();
  beltrami_context* context = nullptr;
  EXPECT_EQ(beltrami_create_with(&allocator, &context), BELTRAMI_OK);
  return Context(context);
}

std::vector<double> unwrapped(const Context& context, const TriangleList& mesh) {
  const beltrami_surface surface = surface_view(mesh);
  EXPECT_EQ(beltrami_unwrap(context.get(), &surface, nullptr, nullptr), BELTRAMI_OK)
      << message(context);
  std::vector<double> corners(6 * mesh.faces.size());
  EXPECT_EQ(beltrami_get_corner_uvs(context.get(), corners.data(), BELTRAMI_F64, 0), BELTRAMI_OK);
  return corners;
}

TEST(AbiAllocator, ThisBuildHasOne) {
  EXPECT_EQ(beltrami_has("allocator"), 1);
}

TEST(AbiAllocator, GivesWhatAnAtlasTakesAndGetsItBack) {
  const TriangleList mesh = meshes::torus(12);
  Ledger ledger;
  const std::vector<double> expected = unwrapped(create(), mesh);
  {
    const Context context = create_with(ledger);
    set_option(context, BELTRAMI_OPTION_THREADS, 3);
    EXPECT_EQ(unwrapped(context, mesh), expected);
    EXPECT_GT(ledger.threads(), 1u);
    auto atlas = sized<beltrami_atlas>();
    ASSERT_EQ(beltrami_get_atlas(context.get(), &atlas), BELTRAMI_OK);
    EXPECT_GT(ledger.taken(), 100 * mesh.faces.size());
  }
  EXPECT_EQ(ledger.living(), 0u);
}

TEST(AbiAllocator, GivesWhatARunTakesAndGetsItBack) {
  const TriangleList mesh = meshes::bumps(24, 24);
  Ledger ledger;
  {
    const Context context = create_with(ledger);
    set_option(context, BELTRAMI_OPTION_COARSE_FACES, 200);
    set_option(context, BELTRAMI_OPTION_THREADS, 3);
    ASSERT_EQ(set_mesh(context, mesh), BELTRAMI_OK) << message(context);
    ASSERT_EQ(run(context), BELTRAMI_OK) << message(context);
    const Context other = create();
    set_option(other, BELTRAMI_OPTION_COARSE_FACES, 200);
    ASSERT_EQ(set_mesh(other, mesh), BELTRAMI_OK);
    ASSERT_EQ(run(other), BELTRAMI_OK);
    const std::size_t vertices = mesh.positions.size();
    EXPECT_EQ(uvs(context, vertices), uvs(other, vertices));
  }
  EXPECT_EQ(ledger.living(), 0u);
}

TEST(AbiAllocator, HoldsWhatIsTakenWhileAnotherContextRuns) {
  // A host may call one context from the progress of another: each has its own memory.
  const TriangleList mesh = meshes::torus(8);
  Ledger outer_ledger, inner_ledger;
  {
    const Context outer = create_with(outer_ledger);
    struct Inner {
      Context context;
      const TriangleList& mesh;
      int calls = 0;
    } inner = {create_with(inner_ledger), mesh};
    const beltrami_surface surface = surface_view(mesh);
    const auto nested = [](void* user, double, const char*) -> std::int32_t {
      auto& self = *static_cast<Inner*>(user);
      if (self.calls++ == 0) unwrapped(self.context, self.mesh);
      return 0;
    };
    ASSERT_EQ(beltrami_unwrap(outer.get(), &surface, nested, &inner), BELTRAMI_OK);
    EXPECT_GT(inner.calls, 0);
    EXPECT_EQ(unwrapped(outer, mesh), unwrapped(inner.context, mesh));
  }
  EXPECT_EQ(outer_ledger.living(), 0u);
  EXPECT_EQ(inner_ledger.living(), 0u);
}

TEST(AbiAllocator, GetsBackWhatAFailedCallTook) {
  TriangleList mesh = meshes::torus(8);
  mesh.faces[5][1] = 100000;
  Ledger ledger;
  {
    const Context context = create_with(ledger);
    const beltrami_surface surface = surface_view(mesh);
    EXPECT_EQ(beltrami_unwrap(context.get(), &surface, nullptr, nullptr),
              BELTRAMI_E_INDEX_OUT_OF_RANGE);
    EXPECT_NE(message(context), "");
  }
  EXPECT_EQ(ledger.living(), 0u);
}

TEST(AbiAllocator, AnswersWhereTheHostHasNoMemory) {
  auto allocator = sized<beltrami_allocator>();
  allocator.allocate = [](void*, std::uint64_t, std::uint64_t) -> void* { return nullptr; };
  allocator.release = [](void*, void*, std::uint64_t, std::uint64_t) { FAIL(); };
  beltrami_context* context = nullptr;
  EXPECT_EQ(beltrami_create_with(&allocator, &context), BELTRAMI_E_OUT_OF_MEMORY);
  EXPECT_EQ(context, nullptr);
}

/// A handler of the program's may end it: it knows of another heap.
TEST(AbiAllocator, DoesNotAskTheHandlerOfTheProgram) {
  static long left = 0;
  auto allocator = sized<beltrami_allocator>();
  allocator.allocate = [](void*, std::uint64_t bytes, std::uint64_t alignment) -> void* {
    if (left-- <= 0) return nullptr;
    return std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
  };
  allocator.release = [](void*, void* block, std::uint64_t, std::uint64_t) { std::free(block); };
  static int asked = 0;
  const std::new_handler before = std::set_new_handler([] {
    ++asked;
    throw std::bad_alloc();
  });
  left = 1000;
  beltrami_context* context = nullptr;
  ASSERT_EQ(beltrami_create_with(&allocator, &context), BELTRAMI_OK);
  const TriangleList mesh = meshes::torus(8);
  const beltrami_surface surface = surface_view(mesh);
  left = 20;
  EXPECT_EQ(beltrami_unwrap(context, &surface, nullptr, nullptr), BELTRAMI_E_OUT_OF_MEMORY);
  beltrami_destroy(context);
  std::set_new_handler(before);
  EXPECT_EQ(asked, 0);
}

TEST(AbiAllocator, IsNotOfChecksThatTheHostMakesInItsLoops) {
  const TriangleList mesh = meshes::bumps(40, 40);
  Ledger ledger;
  {
    const Context context = create_with(ledger);
    set_option(context, BELTRAMI_OPTION_THREADS, 2);
    static const Ledger* of_the_run = nullptr;
    of_the_run = &ledger;
    const auto run_and_check = [](void* user, std::int32_t count, beltrami_job job, void* data) {
      const auto& flat = *static_cast<const TriangleList*>(user);
      const beltrami_surface surface = surface_view(flat);
      std::vector<std::uint64_t> triangles(3 * flat.faces.size());
      const std::uint64_t taken = of_the_run->taken();
      beltrami_triangulate(&surface, triangles.data(), BELTRAMI_U64, 0, nullptr);
      EXPECT_EQ(of_the_run->taken(), taken);
      for (std::int32_t i = 0; i < count; ++i) job(data, i);
    };
    TriangleList user = mesh;
    ASSERT_EQ(beltrami_set_parallel_for(context.get(), run_and_check, &user), BELTRAMI_OK);
    ASSERT_EQ(set_mesh(context, mesh), BELTRAMI_OK);
    EXPECT_EQ(run(context), BELTRAMI_OK) << message(context);
  }
  EXPECT_EQ(ledger.living(), 0u);
}

TEST(AbiAllocator, RefusesOneThatLacksAFunctionOrASize) {
  Ledger ledger;
  beltrami_context* context = nullptr;
  beltrami_allocator allocator = ledger.allocator();
  allocator.release = nullptr;
  EXPECT_EQ(beltrami_create_with(&allocator, &context), BELTRAMI_E_INVALID_ARGUMENT);
  allocator = ledger.allocator();
  allocator.struct_size = 8;
  EXPECT_EQ(beltrami_create_with(&allocator, &context), BELTRAMI_E_INVALID_ARGUMENT);
  allocator = ledger.allocator();
  allocator.reserved = 1;
  EXPECT_EQ(beltrami_create_with(&allocator, &context), BELTRAMI_E_INVALID_ARGUMENT);
  EXPECT_EQ(context, nullptr);
  ASSERT_EQ(beltrami_create_with(nullptr, &context), BELTRAMI_OK);
  beltrami_destroy(context);
}

}  // namespace
}  // namespace beltrami::host
