#include "files/corner_tangents.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "files/point_numbers.h"
#include "files/vector3.h"
#include "process/interrupt.h"

namespace beltrami::cli {
namespace {

Vector3 vector_at(const std::vector<double>& values, std::size_t i) {
  return {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
}

/// What of `a` is across `normal`, of length 1; or 0.
Vector3 across(const Vector3& a, const Vector3& normal) {
  return normalized(a - dot(a, normal) * normal, {});
}

double angle_between(const Vector3& a, const Vector3& b) {
  return std::acos(std::clamp(dot(normalized(a, {}), normalized(b, {})), -1.0, 1.0));
}

/// What meets at a place with one normal, one UV and one side.
struct Sum {
  Vector3 along{}, normal{};
  double side = 1;
};

/// Across the normal, whatever it is.
Vector3 any_across(const Vector3& normal) {
  const Vector3 found = across({1, 0, 0}, normal);
  return norm(found) > 0 ? found : across({0, 1, 0}, normal);
}

}  // namespace

std::vector<std::array<double, 4>> corner_tangents(const CornersWithUvs& corners) {
  const std::size_t count = corners.positions.size() / 3;
  PointNumbers<9> numbers;
  std::vector<Sum> sums;
  std::vector<std::uint32_t> number_of(count);
  for (std::size_t first = 0; first < count; first += 3) {
    throw_if_interrupted();
    std::array<Vector3, 3> p{};
    for (std::size_t k = 0; k < 3; ++k) p[k] = vector_at(corners.positions, first + k);
    const double* uv = &corners.uvs[2 * first];
    const double u1 = uv[2] - uv[0], v1 = uv[3] - uv[1], u2 = uv[4] - uv[0], v2 = uv[5] - uv[1];
    const double side = u1 * v2 - u2 * v1 < 0 ? -1 : 1;
    const Vector3 along = normalized((side * v2) * (p[1] - p[0]) - (side * v1) * (p[2] - p[0]), {});
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3 n = normalized(vector_at(corners.normals, first + k), {});
      const std::uint32_t number = numbers.number(
          {p[k][0], p[k][1], p[k][2], n[0], n[1], n[2], uv[2 * k], uv[2 * k + 1], side});
      if (number >= sums.size()) sums.push_back({{}, n, side});
      const double angle = angle_between(p[(k + 1) % 3] - p[k], p[(k + 2) % 3] - p[k]);
      sums[number].along = sums[number].along + angle * across(along, n);
      number_of[first + k] = number;
    }
  }
  std::vector<std::array<double, 4>> found(count);
  for (std::size_t c = 0; c < count; ++c) {
    const Sum& sum = sums[number_of[c]];
    Vector3 along = across(sum.along, sum.normal);
    if (!(norm(along) > 0)) along = any_across(sum.normal);
    found[c] = {along[0], along[1], along[2], sum.side};
  }
  return found;
}

}  // namespace beltrami::cli
