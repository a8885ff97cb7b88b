// Compiled as C++20: std::span, and a second unit of the program that includes the header.
#include "cpp/units.h"

#include <beltrami/beltrami.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace beltrami::host {

unsigned flatten_spans() {
  const std::vector<std::array<float, 3>> positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 1}};
  const std::array<std::uint32_t, 3> triangle{0, 1, 2};
  std::vector<Uv> uvs(3, Uv{-1, -1});
  // A temporary span shows what outlives it.
  const Surface surface{std::span(positions), std::span(triangle)};
  Context().flatten(surface).write_uvs(span_of(std::span(uvs)));
  unsigned written = 0;
  for (const Uv& uv : uvs) written += uv != Uv{-1, -1} ? 1 : 0;
  return written;
}

}  // namespace beltrami::host
