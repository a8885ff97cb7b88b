// Unwraps a mesh with two materials in C++, and judges UVs from elsewhere.
//
//   c++ -std=c++17 unwrap.cpp -lbeltrami -o unwrap && ./unwrap
#include <beltrami/beltrami.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace {

struct Mesh {
  std::vector<std::array<double, 3>> positions;
  std::vector<std::uint32_t> corners, sizes;  // polygons, one after another
  std::vector<std::uint32_t> materials;       // one per face
};

using Context = std::unique_ptr<beltrami_context, void (*)(beltrami_context*)>;

Context make_context() {
  beltrami_context* context = nullptr;
  if (beltrami_create(&context) != BELTRAMI_OK) throw std::bad_alloc();
  return {context, &beltrami_destroy};
}

void require(beltrami_status status, const Context& context) {
  if (status < 0) throw std::runtime_error(beltrami_error_message(context.get()));
}

template <class Struct>
Struct sized() {
  Struct value{};
  value.struct_size = sizeof value;
  return value;
}

/// Views of the arrays, which must outlive it.
beltrami_surface view(const Mesh& mesh) {
  auto surface = sized<beltrami_surface>();
  surface.vertex_count = mesh.positions.size();
  surface.face_count = mesh.sizes.size();
  surface.corner_count = mesh.corners.size();
  surface.positions = {mesh.positions.data(), 0, BELTRAMI_F64, 0};
  surface.indices = {mesh.corners.data(), 0, BELTRAMI_U32, 0};
  surface.face_sizes = {mesh.sizes.data(), 0, BELTRAMI_U32, 0};
  surface.face_labels = {mesh.materials.data(), 0, BELTRAMI_U32, 0};
  return surface;
}

/// A house: walls of quads, gables of five corners, a roof of another material, no floor.
Mesh house() {
  return {{{0, 0, 0},
           {4, 0, 0},
           {4, 6, 0},
           {0, 6, 0},
           {0, 0, 3},
           {4, 0, 3},
           {4, 6, 3},
           {0, 6, 3},
           {2, 0, 5},
           {2, 6, 5}},
          {0, 1, 5, 8, 4, 2, 3, 7, 9, 6, 1, 2, 6, 5, 3, 0, 4, 7, 5, 6, 9, 8, 4, 8, 9, 7},
          {5, 5, 4, 4, 4, 4},
          {0, 0, 0, 0, 1, 1}};
}

/// One (u, v) per corner.
std::vector<std::array<double, 2>> unwrap(const Mesh& mesh, beltrami_atlas& atlas) {
  const Context context = make_context();
  const beltrami_surface surface = view(mesh);
  // Short seams are searched for along which lengths change so much, and no more.
  require(beltrami_set_float(context.get(), BELTRAMI_OPTION_TARGET_ENERGY, 2.02), context);
  require(beltrami_unwrap(context.get(), &surface, nullptr, nullptr), context);
  atlas = sized<beltrami_atlas>();
  require(beltrami_get_atlas(context.get(), &atlas), context);
  std::vector<std::array<double, 2>> uvs(mesh.corners.size());
  require(beltrami_get_corner_uvs(context.get(), uvs.data(), BELTRAMI_F64, 0), context);
  return uvs;
}

/// What overlaps in UVs from anywhere.
bool judge(const Mesh& mesh, const std::vector<std::array<double, 2>>& uvs) {
  beltrami_surface surface = view(mesh);
  surface.corner_uvs = {uvs.data(), 0, BELTRAMI_F64, 0};
  auto found = sized<beltrami_atlas_certificate>();
  std::array<std::uint64_t, 8> pairs{};
  const beltrami_status status = beltrami_check_atlas(&surface, 0, &found, pairs.data(), 4);
  if (status < 0) throw std::runtime_error(beltrami_status_advice(status));
  std::printf("%s\n", status == BELTRAMI_OK ? "injective" : "not injective");
  for (std::size_t i = 0; i < pairs.size() && pairs[i] != BELTRAMI_NO_ELEMENT; i += 2) {
    std::printf("  faces %d and %d overlap\n", static_cast<int>(pairs[i]),
                static_cast<int>(pairs[i + 1]));
  }
  return status == BELTRAMI_OK;
}

}  // namespace

int main() {
  try {
    const Mesh mesh = house();
    beltrami_atlas atlas{};
    std::vector<std::array<double, 2>> uvs = unwrap(mesh, atlas);
    std::printf("%d charts, energy %.4f (2 is an isometry): the target is %s\n",
                static_cast<int>(atlas.charts), atlas.symmetric_dirichlet,
                atlas.reached != 0 ? "reached" : "missed");
    const bool ours = judge(mesh, uvs);
    std::swap(uvs[20], uvs[21]);  // a roof that is folded
    return ours && !judge(mesh, uvs) ? EXIT_SUCCESS : EXIT_FAILURE;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return EXIT_FAILURE;
  }
}
