// Exceptions injected where a host can cause them: none crosses the C interface, and the context
// works on. (out_of_memory_test.cpp lets every allocation of the calling thread fail.)
#include <dlfcn.h>
#include <pthread.h>

#include <atomic>
#include <cerrno>
#include <stdexcept>

#include "abi/host.h"
#include "support/meshes.h"

namespace {
std::atomic<bool> no_more_threads{false};
}

/// Takes the place of the C library's for the whole process, the library under test included.
extern "C" __attribute__((visibility("default"))) int pthread_create(
    pthread_t* thread, const pthread_attr_t* attributes, void* (*body)(void*), void* argument) {
  if (no_more_threads) return EAGAIN;
  using Create = int (*)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);
  static const auto real = reinterpret_cast<Create>(dlsym(RTLD_NEXT, "pthread_create"));
  return real(thread, attributes, body, argument);
}

namespace beltrami {
namespace {

using namespace host;
using meshes::TriangleList;

struct Thrower {
  int calls = 0;
  int at;
  bool standard;  ///< throws a std::exception, or else a number
};

int32_t throw_at(void* user, double, const char*) {
  auto& self = *static_cast<Thrower*>(user);
  if (self.calls++ != self.at) return 0;
  if (self.standard) throw std::runtime_error("thrown by the host");
  throw 42;
}

TEST(Exceptions, OfAProgressCallbackEndTheRunWithAStatus) {
  const TriangleList mesh = meshes::bumps(20, 20);
  const Context context = whole_pipeline(mesh);
  Thrower counter{0, -1, false};
  ASSERT_EQ(beltrami_run(context.get(), throw_at, &counter), BELTRAMI_OK);
  const auto before = uvs(context, mesh.positions.size());
  for (int at = 0; at < counter.calls; ++at) {
    Thrower thrower{0, at, at % 2 == 0};
    EXPECT_EQ(beltrami_run(context.get(), throw_at, &thrower), BELTRAMI_E_INTERNAL) << at;
    EXPECT_NE(message(context), "");
    if (thrower.standard) {
      EXPECT_EQ(message(context), "thrown by the host");
    }
    EXPECT_TRUE(same_bits(uvs(context, mesh.positions.size()), before)) << "old results stay";
  }
  EXPECT_EQ(run(context), BELTRAMI_OK);
}

TEST(Exceptions, WhereNoThreadCanBeStartedARunGoesOnWithItsOwn) {
  const TriangleList mesh = meshes::bumps(60, 60);
  const Context context = whole_pipeline(mesh);
  ASSERT_EQ(run(context), BELTRAMI_OK);
  const auto expected = uvs(context, mesh.positions.size());
  no_more_threads = true;
  const beltrami_status status = run(context);
  no_more_threads = false;
  EXPECT_EQ(status, BELTRAMI_OK) << message(context);
  EXPECT_TRUE(same_bits(uvs(context, mesh.positions.size()), expected));
}

}  // namespace
}  // namespace beltrami
