// Unwraps a mesh with two materials in C++, and judges UVs from elsewhere.
//
//   c++ -std=c++17 unwrap.cpp -lbeltrami -o unwrap && ./unwrap
#include <beltrami/beltrami.hpp>

#include <array>
#include <cstdint>
#include <cstdio>
#include <utility>
#include <vector>

// A house: walls of quads, gables of five corners, a roof of another material, no floor.
static const std::vector<std::array<double, 3>> kPositions = {
    {0, 0, 0}, {4, 0, 0}, {4, 6, 0}, {0, 6, 0}, {0, 0, 3},
    {4, 0, 3}, {4, 6, 3}, {0, 6, 3}, {2, 0, 5}, {2, 6, 5}};
static const std::vector<std::uint32_t> kCorners = {0, 1, 5, 8, 4, 2, 3, 7, 9, 6, 1, 2, 6,
                                                    5, 3, 0, 4, 7, 5, 6, 9, 8, 4, 8, 9, 7};
static const std::vector<std::uint32_t> kSizes = {5, 5, 4, 4, 4, 4};
static const std::vector<std::uint32_t> kMaterials = {0, 0, 0, 0, 1, 1};

/// Says what overlaps in UVs from anywhere.
static bool judge(beltrami::Surface house, const std::vector<beltrami::Uv>& uvs) {
  const beltrami::AtlasCheck found = beltrami::check_atlas(house.corner_uvs(uvs), 4);
  std::printf("%s\n", found.injective() ? "injective" : "not injective");
  for (const auto& [a, b] : found.pairs) {
    std::printf("  faces %d and %d overlap\n", static_cast<int>(a), static_cast<int>(b));
  }
  return found.injective();
}

int main() try {
  beltrami::Surface house(kPositions, kCorners, kSizes);  // views: the arrays stay where they are
  house.face_labels(kMaterials);
  beltrami::Context context;
  // Short seams are searched for along which lengths change so much, and no more.
  context.set(beltrami::option::kTargetEnergy, 2.02);
  const beltrami::Atlas atlas = context.unwrap(house);
  std::printf("%d charts, energy %.4f (2 is an isometry): the target is %s\n",
              static_cast<int>(atlas.info().charts), atlas.info().symmetric_dirichlet,
              atlas.info().reached ? "reached" : "missed");
  std::vector<beltrami::Uv> uvs = atlas.corner_uvs();
  const bool ours = judge(house, uvs);
  std::swap(uvs[20], uvs[21]);  // a roof that is folded
  return ours && !judge(house, uvs) ? 0 : 1;
} catch (const beltrami::Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
