// The numbers in which each format holds UVs: the one place that knows them.
#pragma once

#include <array>

#include "files/mesh_file.h"

namespace beltrami::cli {

/// From u and v of a mesh, whose V axis points up, to what stands in a file.
struct UvNumbers {
  bool single = false;  ///< in single precision, rounded to nearest; else as they are
  bool down = false;    ///< with the V axis down: 1 - v

  std::array<double, 2> held(double u, double v) const {
    const std::array<double, 2> numbers = {u, down ? 1 - v : v};
    if (!single) return numbers;
    return {double{static_cast<float>(numbers[0])}, double{static_cast<float>(numbers[1])}};
  }
  /// The same with the V axis up again, moved by a whole number along it. Exact: a verdict on these
  /// is one on the numbers held.
  std::array<double, 2> judged(double u, double v) const {
    const auto [x, y] = held(u, v);
    return {x, down ? -y : y};
  }
  /// Whether the numbers held stand for u and v exactly.
  bool keeps(double u, double v) const {
    const auto [x, y] = held(u, v);
    return x == u && (down ? 1 - y == v && y + v == 1 : y == v);
  }
};

/// Those of `format`. `single_uvs`: as MeshFile has it.
inline UvNumbers uv_numbers(MeshFormat format, bool single_uvs) {
  if (format == MeshFormat::kGltf) return {.single = true, .down = true};
  return {.single = format == MeshFormat::kPly && single_uvs};
}

}  // namespace beltrami::cli
