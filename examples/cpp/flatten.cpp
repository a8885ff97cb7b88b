// Flattens a disk from C++: options, progress, the UVs, and what an error tells.
//
//   c++ -std=c++17 flatten.cpp -lbeltrami -o flatten && ./flatten
#include <beltrami/beltrami.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

/// A cup: rings and spokes, bent up to a hemisphere.
static void make_cup(std::vector<std::array<float, 3>>& positions,
                     std::vector<std::array<std::uint32_t, 3>>& faces) {
  constexpr std::uint32_t kRings = 40, kSpokes = 90;
  positions.push_back({0, 0, -1});
  for (std::uint32_t ring = 0; ring < kRings; ++ring) {
    const float down = 1.5f * float(ring + 1) / kRings;
    for (std::uint32_t spoke = 0; spoke < kSpokes; ++spoke) {
      const float turn = 6.2831853f * float(spoke) / kSpokes;
      positions.push_back(
          {std::sin(down) * std::cos(turn), std::sin(down) * std::sin(turn), -std::cos(down)});
      const std::uint32_t a = ring * kSpokes + spoke + 1;
      const std::uint32_t b = ring * kSpokes + (spoke + 1) % kSpokes + 1;
      if (ring == 0) {
        faces.push_back({0, a, b});
      } else {
        faces.push_back({a - kSpokes, a, b});
        faces.push_back({a - kSpokes, b, b - kSpokes});
      }
    }
  }
}

int main() try {
  std::vector<std::array<float, 3>> positions;
  std::vector<std::array<std::uint32_t, 3>> faces;
  make_cup(positions, faces);

  beltrami::Context context;
  context.set(beltrami::option::kCoarseFaces, 1000).set("unit-square", 1);
  const beltrami::Flattening flat =
      context.flatten(beltrami::Surface(positions, faces), [](double fraction, const char* stage) {
        std::printf("\r%3.0f%% %-10s", 100 * fraction, stage);
        return true;  // false would end it
      });
  const std::vector<beltrami::Uv32> uvs = flat.uvs<beltrami::Uv32>();
  std::printf("\n%zu faces: %s, first UV (%g, %g)\n", faces.size(),
              flat.certificate<float>().injective ? "injective" : "see the certificate",
              double{uvs[0][0]}, double{uvs[0][1]});

  faces.push_back({7, 8, 99999});
  const beltrami::Surface wrong(positions, faces);
  const auto result = context.try_flatten(wrong);  // as flatten(), without an exception
  if (result) return 1;
  std::printf("%s, face %d: %s\n", name_of(result.status()),
              static_cast<int>(result.error().element().value_or(0)), result.error().what());
  return result.status() == beltrami::Status::kIndexOutOfRange ? 0 : 1;
} catch (const beltrami::Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
