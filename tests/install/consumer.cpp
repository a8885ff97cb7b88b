// Unwraps one bent quad through the header of C++; ends with 0 if the map is injective.
#include <beltrami/beltrami.hpp>

#include <array>
#include <cstdio>
#include <vector>

int main() {
  const std::vector<std::array<float, 3>> positions{{0, 0, 0}, {1, 0, 0}, {1, 1, 1}, {0, 1, 0}};
  const std::vector<int> triangles{0, 1, 2, 0, 2, 3};
  beltrami::Context context;
  const beltrami::Atlas atlas = context.unwrap(beltrami::Surface(positions, triangles));
  std::printf("%zu corners, %s\n", atlas.corner_uvs<beltrami::Uv32>().size(),
              beltrami::name_of(atlas.status()));
  return atlas.certificate<float>().injective ? 0 : 1;
}
