// Buffers of every type, stride and alignment, and structs of every size.
#include <cmath>
#include <cstddef>

#include "abi/host.h"
#include "base/vectors.h"
#include "support/meshes.h"

namespace beltrami {
namespace {

using namespace host;
using meshes::TriangleList;

/// Items of `components` elements in raw bytes: `offset` bytes in front, `stride` bytes apart.
template <class Element>
struct Strided {
  std::vector<unsigned char> bytes;
  std::size_t offset, stride;
  static constexpr unsigned char kFiller = 0xa5;

  template <class Items>
  Strided(const Items& items, int components, std::size_t offset_in, std::size_t stride_in)
      : offset(offset_in), stride(stride_in) {
    bytes.assign(offset + stride * items.size(), kFiller);
    for (std::size_t i = 0; i < items.size(); ++i) {
      for (int k = 0; k < components; ++k) {
        const auto value = static_cast<Element>(items[i][k]);
        std::memcpy(&bytes[offset + i * stride + k * sizeof value], &value, sizeof value);
      }
    }
  }
  beltrami_buffer view(int32_t type) const { return {bytes.data() + offset, stride, type, 0}; }
};

/// Positions that float holds exactly, so that all types describe the same mesh.
TriangleList exact_mesh() {
  TriangleList mesh = meshes::bumps(5, 4);
  for (Vec3& p : mesh.positions) {
    for (int k = 0; k < 3; ++k) {
      // volatile: GCC 12 vectorizes the way to float and back into nothing.
      const volatile auto rounded = static_cast<float>(p[k]);
      p[k] = rounded;
    }
  }
  return mesh;
}

TEST(Buffers, EveryTypeStrideAndAlignmentGivesTheSameBits) {
  const TriangleList mesh = exact_mesh();
  const std::size_t vertices = mesh.positions.size();
  const Context reference = loaded(mesh);
  ASSERT_EQ(run(reference), BELTRAMI_OK);
  const auto expected = uvs(reference, vertices);

  for (const std::size_t offset : {0, 1, 3}) {
    for (const std::size_t extra : {0, 1, 5, 8}) {
      SCOPED_TRACE(testing::Message() << "offset " << offset << ", extra " << extra);
      const Strided<float> f32(mesh.positions, 3, offset, 12 + extra);
      const Strided<double> f64(mesh.positions, 3, offset, 24 + extra);
      const Strided<uint32_t> u32(mesh.faces, 3, offset, 12 + extra);
      const Strided<uint64_t> u64(mesh.faces, 3, offset, 24 + extra);
      for (const beltrami_buffer& positions : {f32.view(BELTRAMI_F32), f64.view(BELTRAMI_F64)}) {
        for (const beltrami_buffer& indices : {u32.view(BELTRAMI_U32), u64.view(BELTRAMI_U64)}) {
          beltrami_mesh mesh_view = view(mesh);
          mesh_view.positions = positions;
          mesh_view.indices = indices;
          const Context context = loaded(meshes::quad());
          ASSERT_EQ(beltrami_set_mesh(context.get(), &mesh_view), BELTRAMI_OK) << message(context);
          ASSERT_EQ(run(context), BELTRAMI_OK);
          EXPECT_TRUE(same_bits(uvs(context, vertices), expected));
        }
      }
    }
  }
}

TEST(Buffers, RefusesWhatCannotBeABuffer) {
  const TriangleList quad = meshes::quad();
  const beltrami_mesh good = view(quad);
  const Context context = create();
  const auto expect_refused = [&](auto&& change) {
    beltrami_mesh mesh = good;
    change(mesh);
    EXPECT_EQ(beltrami_set_mesh(context.get(), &mesh), BELTRAMI_E_INVALID_ARGUMENT);
    EXPECT_NE(message(context), "");
  };
  expect_refused([](beltrami_mesh& m) { m.positions.data = nullptr; });
  expect_refused([](beltrami_mesh& m) { m.indices.data = nullptr; });
  expect_refused([](beltrami_mesh& m) { m.positions.type = BELTRAMI_U32; });
  expect_refused([](beltrami_mesh& m) { m.positions.type = 4; });
  expect_refused([](beltrami_mesh& m) { m.positions.type = -1; });
  expect_refused([](beltrami_mesh& m) { m.indices.type = BELTRAMI_F64; });
  expect_refused([](beltrami_mesh& m) { m.positions.stride = 23; });
  expect_refused([](beltrami_mesh& m) { m.indices.stride = 11; });
  expect_refused([](beltrami_mesh& m) { m.positions.stride = static_cast<uint64_t>(-24); });
  expect_refused([](beltrami_mesh& m) { m.indices.stride = uint64_t{1} << 62; });
  expect_refused([](beltrami_mesh& m) { m.positions.reserved = 1; });
  expect_refused([](beltrami_mesh& m) { m.indices.reserved = 1; });
}

TEST(Buffers, WritesUvsOfEveryTypeAndStrideAndNothingBetween) {
  const TriangleList mesh = meshes::bumps(4, 4);
  const std::size_t vertices = mesh.positions.size();
  const Context context = loaded(mesh);
  ASSERT_EQ(run(context), BELTRAMI_OK);
  const auto expected = uvs(context, vertices);
  for (const int32_t type : {BELTRAMI_F32, BELTRAMI_F64}) {
    const std::size_t size = type == BELTRAMI_F32 ? 4 : 8;
    for (const std::size_t extra : {0, 1, 7}) {
      const std::size_t stride = 2 * size + extra;
      std::vector<unsigned char> bytes(1 + stride * vertices + 1, 0xa5);
      ASSERT_EQ(beltrami_get_uvs(context.get(), bytes.data() + 1, type, stride), BELTRAMI_OK);
      EXPECT_EQ(bytes.front(), 0xa5);
      EXPECT_EQ(bytes.back(), 0xa5);
      for (std::size_t v = 0; v < vertices; ++v) {
        for (std::size_t k = 0; k < 2; ++k) {
          const unsigned char* at = &bytes[1 + v * stride + k * size];
          float single;
          double wide;
          std::memcpy(&single, at, sizeof single);
          if (type == BELTRAMI_F32) {
            EXPECT_EQ(single, static_cast<float>(expected[v][k]));
          } else {
            std::memcpy(&wide, at, sizeof wide);
            EXPECT_EQ(wide, expected[v][k]);
          }
        }
        for (std::size_t i = 2 * size; i < stride; ++i) EXPECT_EQ(bytes[1 + v * stride + i], 0xa5);
      }
    }
  }
  double room[2];
  EXPECT_EQ(beltrami_get_uvs(context.get(), room, BELTRAMI_U32, 0), BELTRAMI_E_INVALID_ARGUMENT);
  EXPECT_EQ(beltrami_get_uvs(context.get(), room, BELTRAMI_F64, 15), BELTRAMI_E_INVALID_ARGUMENT);
}

TEST(Buffers, WritesFaceEnergiesWithAStride) {
  const TriangleList mesh = meshes::bumps(3, 3);
  const Context context = loaded(mesh);
  ASSERT_EQ(run(context), BELTRAMI_OK);
  std::vector<double> packed(mesh.faces.size());
  ASSERT_EQ(beltrami_get_face_energies(context.get(), packed.data(), 0), BELTRAMI_OK);
  std::vector<std::array<double, 2>> strided(mesh.faces.size(), {0, -1});
  ASSERT_EQ(beltrami_get_face_energies(context.get(), strided.data(), 16), BELTRAMI_OK);
  auto energy = sized<beltrami_energy>();
  ASSERT_EQ(beltrami_get_energy(context.get(), &energy), BELTRAMI_OK);
  for (std::size_t f = 0; f < packed.size(); ++f) {
    EXPECT_EQ(strided[f], (std::array<double, 2>{packed[f], -1}));
    EXPECT_GE(packed[f], 2 - 1e-12);
    EXPECT_LE(packed[f], energy.max);
  }
  EXPECT_EQ(packed[energy.worst_face], energy.max);
  EXPECT_EQ(beltrami_get_face_energies(context.get(), packed.data(), 7),
            BELTRAMI_E_INVALID_ARGUMENT);
}

/// Calls `fill` on the struct with a struct_size of less than its first release had, of that, and
/// of more than the library's, each with canaries behind the size it claims.
template <class Struct, class Fill>
void expect_sizes_respected(Fill&& fill, std::size_t first_size = sizeof(Struct)) {
  const std::size_t size = sizeof(Struct);
  for (const uint32_t claimed : {0u, 4u, 7u, static_cast<uint32_t>(first_size - 1)}) {
    Struct out;
    std::memset(static_cast<void*>(&out), 0xa5, sizeof out);
    out.struct_size = claimed;
    EXPECT_EQ(fill(&out), BELTRAMI_E_INVALID_ARGUMENT) << claimed;
    std::vector<unsigned char> bytes(size);
    std::memcpy(bytes.data(), &out, size);
    EXPECT_EQ(out.struct_size, claimed);
    for (std::size_t i = 4; i < size; ++i) EXPECT_EQ(bytes[i], 0xa5) << "byte " << i;
  }
  Struct older;
  std::memset(static_cast<void*>(&older), 0xa5, sizeof older);
  older.struct_size = static_cast<uint32_t>(first_size);
  EXPECT_GE(fill(&older), BELTRAMI_OK);
  std::vector<unsigned char> bytes(size);
  std::memcpy(bytes.data(), &older, size);
  for (std::size_t i = first_size; i < size; ++i) EXPECT_EQ(bytes[i], 0xa5) << "byte " << i;
  for (const std::size_t extra : {0, 8, 64}) {  // a caller newer than the library
    struct {
      Struct out;
      unsigned char canary[128];
    } room;
    std::memset(static_cast<void*>(&room), 0xa5, sizeof room);
    room.out.struct_size = static_cast<uint32_t>(size + extra);
    EXPECT_GE(fill(&room.out), BELTRAMI_OK);
    EXPECT_EQ(room.out.struct_size, size + extra) << "the caller's size must stay";
    for (const unsigned char byte : room.canary) EXPECT_EQ(byte, 0xa5);
  }
}

TEST(StructSize, IsRespectedByEveryOutput) {
  const TriangleList mesh = meshes::quad();
  const Context context = loaded(mesh);
  ASSERT_EQ(run(context), BELTRAMI_OK);
  const auto flat = flat_uvs(mesh);
  const beltrami_mesh mesh_view = view(mesh);
  const beltrami_buffer uv_view = view(flat);
  beltrami_context* c = context.get();
  expect_sizes_respected<beltrami_result>(
      [&](beltrami_result* out) { return beltrami_get_result(c, out); });
  expect_sizes_respected<beltrami_certificate>(
      [&](beltrami_certificate* out) { return beltrami_get_certificate(c, out); });
  expect_sizes_respected<beltrami_energy>(
      [&](beltrami_energy* out) { return beltrami_get_energy(c, out); });
  expect_sizes_respected<beltrami_stage>(
      [&](beltrami_stage* out) { return beltrami_get_stage(c, 0, out); });
  expect_sizes_respected<beltrami_option_info>(
      [&](beltrami_option_info* out) { return beltrami_option_describe(0, out); },
      offsetof(beltrami_option_info, calls));
  for (const auto check :
       {beltrami_check_triangles, beltrami_check_boundary, beltrami_check_injective}) {
    expect_sizes_respected<beltrami_certificate>(
        [&](beltrami_certificate* out) { return check(&mesh_view, &uv_view, out); });
  }
  expect_sizes_respected<beltrami_energy>(
      [&](beltrami_energy* out) { return beltrami_measure(&mesh_view, &uv_view, out, nullptr); });
}

TEST(StructSize, IsRespectedByEveryOutputOfAnAtlas) {
  const TriangleList mesh = meshes::tetrahedron();
  const Context context = create();
  beltrami_context* c = context.get();
  auto surface = sized<beltrami_surface>();
  surface.vertex_count = mesh.positions.size();
  surface.face_count = mesh.faces.size();
  surface.positions = {mesh.positions.data(), 0, BELTRAMI_F64, 0};
  surface.indices = {mesh.faces.data(), 0, BELTRAMI_U32, 0};
  ASSERT_EQ(beltrami_unwrap(c, &surface, nullptr, nullptr), BELTRAMI_OK);
  std::vector<double> uvs(2 * 3 * mesh.faces.size());
  ASSERT_EQ(beltrami_get_corner_uvs(c, uvs.data(), BELTRAMI_F64, 0), BELTRAMI_OK);
  surface.corner_uvs = {uvs.data(), 0, BELTRAMI_F64, 0};
  expect_sizes_respected<beltrami_atlas>(
      [&](beltrami_atlas* out) { return beltrami_get_atlas(c, out); },
      offsetof(beltrami_atlas, seams));
  expect_sizes_respected<beltrami_chart>(
      [&](beltrami_chart* out) { return beltrami_get_chart(c, 0, out); },
      offsetof(beltrami_chart, page));
  expect_sizes_respected<beltrami_packing>(
      [&](beltrami_packing* out) { return beltrami_get_packing(c, out); },
      offsetof(beltrami_packing, splits));
  expect_sizes_respected<beltrami_stage>(
      [&](beltrami_stage* out) { return beltrami_get_atlas_stage(c, 0, out); });
  expect_sizes_respected<beltrami_atlas_certificate>([&](beltrami_atlas_certificate* out) {
    return beltrami_get_atlas_certificate(c, BELTRAMI_F64, out);
  });
  expect_sizes_respected<beltrami_atlas_certificate>([&](beltrami_atlas_certificate* out) {
    return beltrami_check_atlas(&surface, 0, out, nullptr, 0);
  });
}

TEST(StructSize, IsRespectedByTheMesh) {
  const TriangleList quad = meshes::quad();
  const Context context = create();
  for (const uint32_t claimed :
       {0u, 4u, 8u, static_cast<uint32_t>(offsetof(beltrami_mesh, cancel) - 1)}) {
    beltrami_mesh mesh = view(quad);
    mesh.struct_size = claimed;
    EXPECT_EQ(beltrami_set_mesh(context.get(), &mesh), BELTRAMI_E_INVALID_ARGUMENT) << claimed;
    EXPECT_NE(message(context).find("struct_size"), std::string::npos);
  }
  struct {
    beltrami_mesh mesh;
    unsigned char later[64];
  } newer = {view(quad), {}};
  newer.mesh.struct_size = sizeof newer;
  EXPECT_EQ(beltrami_set_mesh(context.get(), &newer.mesh), BELTRAMI_OK);
}

}  // namespace
}  // namespace beltrami
