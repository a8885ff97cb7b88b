// Functions named try_ where memory runs out: a Failure, and nothing thrown. Replaces operator new,
// so it is a program of its own.
#include <gtest/gtest.h>
#include <beltrami/beltrami.hpp>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>
#include <vector>

#include "cpp/meshes.h"

namespace {

/// Allocations that succeed from now on, of the headers and of the library; negative: all do.
std::atomic<long> left{-1};

bool refuses() {
  if (left.load() < 0 || left.fetch_sub(1) > 0) return false;
  left = 0;
  return true;
}

void* allocate(void*, std::uint64_t bytes, std::uint64_t alignment) {
  if (refuses()) return nullptr;
  return std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
}
void release(void*, void* block, std::uint64_t, std::uint64_t) {
  std::free(block);
}
const beltrami_allocator kMemory = {sizeof kMemory, 0, nullptr, allocate, release};

}  // namespace

void* operator new(std::size_t size) {
  if (refuses()) throw std::bad_alloc();
  if (void* block = std::malloc(size == 0 ? 1 : size)) return block;
  throw std::bad_alloc();
}
void operator delete(void* block) noexcept {
  std::free(block);
}
void operator delete(void* block, std::size_t) noexcept {
  std::free(block);
}

namespace beltrami::host {
namespace {

/// Calls with room for 0, 1, 2 ... allocations, in strides that grow, since whole runs have many,
/// until it goes well. Returns the room that it went well with.
template <class Call>
long until_there_is_room(Call call) {
  for (long room = 0;; room += 1 + room / 8) {
    left = room;
    const auto result = call();
    left = -1;
    if (result) return room;
    EXPECT_EQ(result.status(), Status::kOutOfMemory);
    EXPECT_STRNE(result.error().what(), "");
    if (room > 10000000) ADD_FAILURE() << "there is never room enough";
    if (::testing::Test::HasFailure()) return room;
  }
}

TEST(CppMemory, WhereItRunsOutThereIsAFailureAndNothingIsThrown) {
  const Triangles quad = bent_quad();
  const Surface surface(quad.positions, quad.faces);
  EXPECT_GT(until_there_is_room([] { return Context::create(&kMemory); }), 0);

  Context context = Context::create(&kMemory).value();
  context.set(option::kMethod, Method::kTutte).set(option::kCut, Cut::kMinimal);
  EXPECT_GT(until_there_is_room([&] { return context.try_flatten(surface); }), 0);
  EXPECT_GT(until_there_is_room([&] { return context.try_unwrap(surface); }), 0);

  EXPECT_GT(until_there_is_room([&] { return Editor::begin(context, surface); }), 0);
  Editor editor(context, surface);
  EXPECT_GT(until_there_is_room([&] { return editor.try_update(); }), 0);
  EXPECT_GT(until_there_is_room([&] { return editor.try_changes(); }), 0);
  EXPECT_GT(until_there_is_room([&] { return editor.try_charts(); }), 0);

  const Atlas atlas = context.unwrap(surface);
  const Flattening flat = context.flatten(surface);
  EXPECT_GT(until_there_is_room([&] { return atlas.try_corner_uvs(); }), 0);
  EXPECT_GT(until_there_is_room([&] { return atlas.try_charts(); }), 0);
  EXPECT_GT(until_there_is_room([&] { return flat.try_uvs<float>(); }), 0);
  EXPECT_GT(until_there_is_room([&] { return flat.try_stages(); }), 0);

  const std::vector<Uv> uvs = flat.uvs();
  EXPECT_GT(until_there_is_room([&] { return context.try_pack(UvMesh(uvs, quad.faces)); }), 0);
  EXPECT_GT(until_there_is_room([&] { return try_measure_faces(surface, uvs); }), 0);
  EXPECT_GT(until_there_is_room([&] { return try_triangulate(surface); }), 0);
}

}  // namespace
}  // namespace beltrami::host
