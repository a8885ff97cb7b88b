// Views of the caller's arrays: every layout gives the same numbers, and none is guessed at.
#include <gtest/gtest.h>
#include <beltrami/beltrami.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "cpp/meshes.h"

namespace of_others {
struct Vec3 {
  float x, y, z;
};
}  // namespace of_others
template <>
struct beltrami::ItemTraits<of_others::Vec3> : beltrami::ItemOf<float, 3> {};

namespace beltrami::host {
namespace {

struct Vertex {
  float weight;
  of_others::Vec3 position;
  std::array<float, 2> uv;
};

constexpr float kPlaces[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 1}, {0, 1, 0}};
constexpr std::int32_t kFaces[2][3] = {{0, 1, 2}, {0, 2, 3}};

std::vector<Vertex> vertices() {
  std::vector<Vertex> vertices;
  for (const auto& at : kPlaces) vertices.push_back({7, {at[0], at[1], at[2]}, {-1, -1}});
  return vertices;
}

std::vector<Uv> uvs_of(const Surface& surface) {
  return Context().flatten(surface).uvs();
}

TEST(CppSpan, EveryLayoutOfPositionsIsTheSameSurface) {
  const std::vector<Uv> expected = uvs_of(Surface(kPlaces, kFaces));
  ASSERT_EQ(expected.size(), 4u);

  const std::vector<float> flat(&kPlaces[0][0], &kPlaces[0][0] + 12);
  EXPECT_EQ(uvs_of(Surface(flat, kFaces)), expected);
  const std::vector<std::array<float, 3>> arrays{{0, 0, 0}, {1, 0, 0}, {1, 1, 1}, {0, 1, 0}};
  EXPECT_EQ(uvs_of(Surface(arrays, kFaces)), expected);
  const std::array<of_others::Vec3, 4> structs{{{0, 0, 0}, {1, 0, 0}, {1, 1, 1}, {0, 1, 0}}};
  EXPECT_EQ(uvs_of(Surface(structs, kFaces)), expected);
  const Triangles doubles = bent_quad();
  EXPECT_EQ(uvs_of(Surface(doubles.positions, kFaces)), expected);
  const std::vector<Vertex> interleaved = vertices();
  EXPECT_EQ(uvs_of(Surface(span_of(interleaved, &Vertex::position), kFaces)), expected);
  const float* const data = &kPlaces[0][0];
  EXPECT_EQ(uvs_of(Surface(Span<const float>(data, 12), kFaces)), expected);
}

TEST(CppSpan, EveryWidthOfIndicesIsTheSameSurface) {
  const std::vector<Uv> expected = uvs_of(Surface(kPlaces, kFaces));
  const std::vector<std::uint16_t> u16{0, 1, 2, 0, 2, 3};
  const std::vector<std::uint32_t> u32{0, 1, 2, 0, 2, 3};
  const std::vector<std::int32_t> i32{0, 1, 2, 0, 2, 3};
  const std::vector<std::uint64_t> u64{0, 1, 2, 0, 2, 3};
  const std::vector<std::int64_t> i64{0, 1, 2, 0, 2, 3};
  const std::vector<std::size_t> sizes{0, 1, 2, 0, 2, 3};
  EXPECT_EQ(uvs_of(Surface(kPlaces, u16)), expected);
  EXPECT_EQ(uvs_of(Surface(kPlaces, u32)), expected);
  EXPECT_EQ(uvs_of(Surface(kPlaces, i32)), expected);
  EXPECT_EQ(uvs_of(Surface(kPlaces, u64)), expected);
  EXPECT_EQ(uvs_of(Surface(kPlaces, i64)), expected);
  EXPECT_EQ(uvs_of(Surface(kPlaces, sizes)), expected);
}

TEST(CppSpan, NegativeIndicesAreOutOfRange) {
  const std::vector<std::int32_t> i32{0, 1, 2, 0, -1, 3};
  const std::vector<std::int64_t> i64{0, 1, 2, 0, -1, 3};
  for (const Surface& surface : {Surface(kPlaces, i32), Surface(kPlaces, i64)}) {
    const Result<Atlas> result = Context().try_unwrap(surface);
    EXPECT_EQ(result.status(), Status::kIndexOutOfRange);
    ASSERT_FALSE(result.has_value());
    EXPECT_EQ(result.error().element(), 1u);
    EXPECT_EQ(result.error().element_kind(), ElementKind::kFace);
  }
}

TEST(CppSpan, ResultsGoIntoAMemberOfEveryStruct) {
  std::vector<Vertex> interleaved = vertices();
  Context context;
  const Flattening flat = context.flatten(Surface(span_of(interleaved, &Vertex::position), kFaces));
  const std::vector<Uv32> expected = flat.uvs<Uv32>();
  flat.write_uvs(span_of(interleaved, &Vertex::uv));
  for (std::size_t i = 0; i < interleaved.size(); ++i) {
    EXPECT_EQ(interleaved[i].uv, expected[i]);
    EXPECT_EQ(interleaved[i].weight, 7);
  }
  const std::vector<float> one_by_one = flat.uvs<float>();
  ASSERT_EQ(one_by_one.size(), 8u);
  EXPECT_EQ(one_by_one[5], expected[2][1]);
}

TEST(CppSpan, ArraysOfTheWrongSizeAreRefusedBeforeTheyAreReadOrWritten) {
  const std::vector<float> seven(7);
  EXPECT_EQ(Context().try_unwrap(Surface(seven, kFaces)).status(), Status::kInvalidArgument);
  const std::vector<Vertex> interleaved = vertices();
  const Span<const float> strided(&interleaved[0].weight, 3, sizeof(Vertex));
  EXPECT_EQ(Context().try_unwrap(Surface(strided, kFaces)).status(), Status::kInvalidArgument);

  const Flattening flat = Context().flatten(Surface(kPlaces, kFaces));
  std::vector<Uv> three(3, Uv{5, 5});
  EXPECT_EQ(flat.try_write_uvs(span_of(three)).status(), Status::kInvalidArgument);
  EXPECT_EQ(three, std::vector<Uv>(3, Uv{5, 5}));
  std::vector<float> eight(8);
  EXPECT_TRUE(flat.try_write_uvs(span_of(eight)));
  EXPECT_EQ(flat.try_write_uvs(Span<float>(eight.data(), 8, 8)).status(), Status::kInvalidArgument);
}

TEST(CppSpan, OfTemporariesAndOtherKindsOfNumbersThereIsNone) {
  using Vectors = std::vector<std::array<float, 3>>;
  static_assert(std::is_constructible_v<Reals<3>, Vectors&>);
  static_assert(std::is_constructible_v<Reals<3>, const Vectors&>);
  static_assert(!std::is_constructible_v<Reals<3>, Vectors>);
  static_assert(!std::is_constructible_v<Reals<3>, std::vector<int>&>);
  static_assert(!std::is_constructible_v<Indices<3>, std::vector<float>&>);
  static_assert(!std::is_constructible_v<Indices<3>, std::vector<std::int16_t>&>);
  static_assert(std::is_constructible_v<Span<const float>, Span<float>>);
  static_assert(!std::is_constructible_v<Span<float>, Span<const float>>);
}

}  // namespace
}  // namespace beltrami::host
