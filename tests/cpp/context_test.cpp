// Contexts: options of every kind, what moves, and what results of them know of each other.
#include <gtest/gtest.h>
#include <beltrami/beltrami.hpp>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <map>
#include <string>
#include <type_traits>
#include <utility>

#include "cpp/meshes.h"

namespace beltrami::host {
namespace {

Surface view(const Triangles& mesh) {
  return Surface(mesh.positions, mesh.faces);
}

/// The type in C of an option whose values are of type T.
template <class T>
std::int32_t type_of(Option<T>) {
  if (std::is_enum_v<T>) return BELTRAMI_TYPE_CHOICE;
  return std::is_same_v<T, double> ? BELTRAMI_TYPE_FLOAT : BELTRAMI_TYPE_INT;
}

template <class... Options>
std::map<std::int32_t, std::int32_t> types_of(Options... options) {
  return {{options.key, type_of(options)}...};
}

TEST(CppOptions, EveryOptionHasAKeyOfItsType) {
  using namespace option;  // NOLINT(google-build-using-namespace)
  const auto types =
      types_of(kMethod, kEnergy, kCoarseFaces, kTolerance, kMaxIterations, kThreads, kUnitSquare,
               kFlatten, kInjectivity, kRefine, kRefineIterations, kTimeLimit, kFloat32, kDelaunay,
               kMemoryLimit, kCut, kHardAngle, kWeld, kWeldDistance, kFillHoles, kShareCopies,
               kPreset, kTargetEnergy, kTargetP99, kMaxCharts, kSeamBudget, kConcaveSeams,
               kHiddenSeams, kHardSeams, kMaterialSeams, kPack, kResolution, kMargin,
               kTexelsPerUnit, kMaxPages, kPackTurns, kPackBlock, kFillWeight, kSymmetricSeams,
               kStraightSeams, kEffort, kFlatSeams, kStack, kRectify, kSnapTexels, kLabelPages);
  const std::vector<OptionInfo> all = options();
  EXPECT_EQ(types.size(), all.size());
  for (const OptionInfo& info : all) {
    ASSERT_TRUE(types.count(info.key)) << info.name;
    EXPECT_EQ(types.at(info.key), info.type) << info.name;
  }
}

/// How many values an enum has is told by its last one.
template <class T>
void expect_last(Option<T> option, T last) {
  const auto value = static_cast<std::int32_t>(last);
  EXPECT_NE(beltrami_option_choice(option.key, value), nullptr) << option.key;
  EXPECT_EQ(beltrami_option_choice(option.key, value + 1), nullptr) << option.key;
}

TEST(CppOptions, EveryChoiceHasItsValues) {
  expect_last(option::kMethod, Method::kUvProlongation);
  expect_last(option::kEnergy, EnergyKind::kExponentialDirichlet);
  expect_last(option::kFlatten, Flatten::kBff);
  expect_last(option::kInjectivity, Injectivity::kLocal);
  expect_last(option::kDelaunay, Delaunay::kOn);
  expect_last(option::kCut, Cut::kGiven);
  expect_last(option::kWeld, Weld::kOff);
  expect_last(option::kPreset, Preset::kHardSurface);
  expect_last(option::kPack, Pack::kNone);
  expect_last(option::kPackTurns, PackTurns::kNone);
  expect_last(option::kEffort, Effort::kHigh);
  expect_last(option::kStack, Stack::kHalves);
}

TEST(CppOptions, AreSetByKeyAndByName) {
  Context context;
  context.set(option::kTargetEnergy, 2.5)
      .set(option::kCut, Cut::kMinimal)
      .set(option::kUnitSquare, true)
      .set("margin", 3)  // a float, which an integer is as well
      .set(std::string("weld"), "off")
      .set(BELTRAMI_OPTION_THREADS, 2u);
  EXPECT_EQ(context.get(option::kTargetEnergy), 2.5);
  EXPECT_EQ(context.get(option::kCut), Cut::kMinimal);
  EXPECT_EQ(context.get(option::kUnitSquare), 1);
  EXPECT_EQ(context.get(option::kMargin), 3.0);
  EXPECT_EQ(context.get(option::kWeld), Weld::kOff);
  EXPECT_EQ(context.get(BELTRAMI_OPTION_THREADS), 2);
}

void expect_refused(const Result<void>& result, const std::string& words) {
  ASSERT_FALSE(result.has_value());
  EXPECT_EQ(result.status(), Status::kInvalidArgument);
  EXPECT_NE(std::string(result.error().what()).find(words), std::string::npos)
      << result.error().what();
}

TEST(CppOptions, WhatIsNoneIsRefusedAndTheOldValueStays) {
  Context context;
  expect_refused(context.try_set("marge", 3), "no option 'marge'");
  expect_refused(context.try_set("cut", "everywhere"), "cut has no value 'everywhere'");
  expect_refused(context.try_set("threads", 1.5), "threads takes an integer");
  expect_refused(context.try_set("margin", "wide"), "margin has no value");
  expect_refused(context.try_set(nullptr, 3), "no option");
  expect_refused(context.try_set(-1, 3), "");
  expect_refused(context.try_set(option::kThreads, -1), "threads");
  expect_refused(context.try_set("threads", std::numeric_limits<std::uint64_t>::max()), "threads");
  EXPECT_EQ(context.get(option::kThreads), 1);
  EXPECT_THROW(context.set("cut", "everywhere"), Error);
}

TEST(CppContext, MovesAndTellsWhatWasLeftBehind) {
  static_assert(!std::is_copy_constructible_v<Context>);
  static_assert(std::is_nothrow_move_constructible_v<Context>);
  const Triangles mesh = bent_quad();
  Context first;
  first.set(option::kUnitSquare, 1);
  Context second = std::move(first);
  EXPECT_EQ(second.get(option::kUnitSquare), 1);
  EXPECT_EQ(second.flatten(view(mesh)).status(), Status::kOk);
  // NOLINTBEGIN(bugprone-use-after-move): that this is told is what is tested.
  EXPECT_EQ(first.c(), nullptr);
  EXPECT_EQ(first.try_flatten(view(mesh)).status(), Status::kInvalidState);
  EXPECT_EQ(first.try_unwrap(view(mesh)).status(), Status::kInvalidState);
  EXPECT_EQ(first.try_set(option::kUnitSquare, 1).status(), Status::kInvalidState);
  EXPECT_EQ(first.try_get(option::kUnitSquare).status(), Status::kInvalidState);
  EXPECT_EQ(first.try_estimate_memory(view(mesh)).status(), Status::kInvalidState);
  first.canceller().cancel();
  // NOLINTEND(bugprone-use-after-move)
  first = std::move(second);
  EXPECT_EQ(first.flatten(view(mesh)).status(), Status::kOk);
}

TEST(CppContext, ResultsOutliveItAndMoveToo) {
  const Triangles mesh = bent_quad();
  Flattening flat = Context().flatten(view(mesh));
  EXPECT_EQ(flat.uvs().size(), 4u);
  const Flattening moved = std::move(flat);
  EXPECT_EQ(moved.uvs().size(), 4u);
  EXPECT_EQ(flat.try_uvs().status(), Status::kInvalidState);  // NOLINT(bugprone-use-after-move)
}

TEST(CppContext, ResultsKnowOfNewerOnesOfTheirKindAlone) {
  const Triangles quad = bent_quad(), cube = triangulated_cube();
  Context context;
  const Flattening flat = context.flatten(view(quad));
  const Atlas atlas = context.unwrap(view(quad));
  EXPECT_EQ(flat.uvs().size(), 4u);
  const Atlas second = context.unwrap(view(cube));
  EXPECT_EQ(second.corner_uvs().size(), 36u);
  EXPECT_EQ(flat.uvs().size(), 4u);
  EXPECT_EQ(atlas.try_corner_uvs().status(), Status::kInvalidState);
  EXPECT_EQ(atlas.try_charts().status(), Status::kInvalidState);
  EXPECT_EQ(atlas.try_packing().status(), Status::kInvalidState);
  EXPECT_EQ(atlas.try_stages().status(), Status::kInvalidState);
  EXPECT_EQ(atlas.info().faces, 2u);  // what was taken with it stays
}

TEST(CppContext, AMeshThatIsRefusedLeavesTheResults) {
  const Triangles quad = bent_quad(), cube = triangulated_cube();
  Context context;
  const Flattening flat = context.flatten(view(quad));
  EXPECT_EQ(context.try_flatten(view(cube)).status(), Status::kClosed);
  EXPECT_EQ(flat.uvs().size(), 4u);
  EXPECT_GT(context.estimate_memory(view(quad)), 0u);
  EXPECT_EQ(flat.try_uvs().status(), Status::kInvalidState);
}

TEST(CppContext, TakesItsMemoryFromAHost) {
  static std::atomic<int> living = 0;
  const beltrami_allocator memory = {
      sizeof memory, 0, nullptr,
      [](void*, std::uint64_t bytes, std::uint64_t alignment) {
        ++living;
        return std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
      },
      [](void*, void* block, std::uint64_t, std::uint64_t) {
        --living;
        std::free(block);
      }};
  {
    Result<Context> context = Context::create(&memory);
    ASSERT_TRUE(context);
    EXPECT_TRUE(context->try_unwrap(view(triangulated_cube())));
    EXPECT_GT(living.load(), 0);
  }
  EXPECT_EQ(living.load(), 0);
}

}  // namespace
}  // namespace beltrami::host
