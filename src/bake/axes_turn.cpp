#include "bake/axes_turn.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>

#include "base/interrupt.h"
#include "base/parallel.h"
#include "base/portable_math.h"

namespace beltrami {
namespace {

using Vector = std::array<double, 3>;

constexpr std::int64_t kTriangles = 4096;  ///< that a thread takes at once

Vector vector_at(std::span<const double> values, std::size_t i) {
  return {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
}

Vector combined(double s, const Vector& a, double t, const Vector& b) {
  return {s * a[0] + t * b[0], s * a[1] + t * b[1], s * a[2] + t * b[2]};
}

double dot(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Of length 1, or 0 where there is none.
Vector unit(const Vector& a) {
  const double length = std::sqrt(dot(a, a));
  return length > 0 && std::isfinite(length) ? combined(1 / length, a, 0, a) : Vector{};
}

/// What of `a` is across `normal`, of length 1.
Vector across(const Vector& a, const Vector& normal) {
  return unit(combined(1, a, -dot(a, normal), normal));
}

/// The direction in which u grows on a triangle, and -1 where the UVs are mirrored.
struct FaceAxis {
  Vector along{};
  double side = 1;
};

FaceAxis face_axis(std::span<const double> positions, std::span<const double> uvs, std::size_t t) {
  const auto edge = [&](std::size_t k) {
    return combined(1, vector_at(positions, 3 * t + k), -1, vector_at(positions, 3 * t));
  };
  const double* uv = &uvs[6 * t];
  const double u1 = uv[2] - uv[0], v1 = uv[3] - uv[1], u2 = uv[4] - uv[0], v2 = uv[5] - uv[1];
  const double area = u1 * v2 - u2 * v1;
  const double sign = area < 0 ? -1 : 1;
  if (!(std::abs(area) > 0)) return {};
  return {unit(combined(sign * v2, edge(1), -sign * v1, edge(2))), sign};
}

Vector normal_at(const AxesOfCorners& of, std::size_t corner) {
  if (!of.normals.empty()) {
    const Vector given = unit(vector_at(of.normals, corner));
    if (dot(given, given) > 0) return given;
  }
  const std::size_t first = corner - corner % 3;
  const Vector a = vector_at(of.positions, first);
  return unit(cross(combined(1, vector_at(of.positions, first + 1), -1, a),
                    combined(1, vector_at(of.positions, first + 2), -1, a)));
}

double angle_at(std::span<const double> positions, std::size_t corner) {
  const std::size_t first = corner - corner % 3, k = corner % 3;
  const Vector p = vector_at(positions, corner);
  const Vector a = unit(combined(1, vector_at(positions, first + (k + 1) % 3), -1, p));
  const Vector b = unit(combined(1, vector_at(positions, first + (k + 2) % 3), -1, p));
  const Vector c = cross(a, b);
  return portable::atan2(std::sqrt(dot(c, c)), dot(a, b));
}

/// An order of numbers in which those that are none come last: sorting needs one.
bool is_before(const std::array<double, 9>& a, const std::array<double, 9>& b) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i] < b[i] || (std::isnan(b[i]) && !std::isnan(a[i]))) return true;
    if (b[i] < a[i] || std::isnan(a[i]) != std::isnan(b[i])) return false;
  }
  return false;
}

/// What corners have in common whose axes are one: place, normal, UV and side.
using CornerKey = std::array<double, 9>;

/// Per corner, for one layout.
std::vector<FaceAxis> corner_axes(const AxesOfCorners& of, std::span<const double> uvs,
                                  const Work& work) {
  const std::size_t corners = of.positions.size() / 3;
  std::vector<FaceAxis> axes(corners);
  std::vector<CornerKey> keys(corners);
  parallel_for(
      work, static_cast<std::int64_t>(corners), 3 * kTriangles,
      [&](std::int64_t begin, std::int64_t end) {
        for (auto c = static_cast<std::size_t>(begin); c < static_cast<std::size_t>(end); ++c) {
          axes[c] = c % 3 == 0 ? face_axis(of.positions, uvs, c / 3) : axes[c - 1];
          const Vector p = vector_at(of.positions, c), n = normal_at(of, c);
          keys[c] = {p[0], p[1], p[2], n[0], n[1], n[2], uvs[2 * c], uvs[2 * c + 1], axes[c].side};
          // 0 and -0 are the same coordinate: exporters give both for one point.
          for (double& coordinate : keys[c]) coordinate += 0.0;
        }
      });
  std::vector<std::uint32_t> order(corners);
  std::iota(order.begin(), order.end(), 0u);
  sort_interruptibly(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return keys[a] != keys[b] ? is_before(keys[a], keys[b]) : a < b;
  });
  std::vector<FaceAxis> means = axes;
  PollSometimes poll;
  for (std::size_t first = 0; first < corners;) {
    poll();
    std::size_t end = first;
    Vector sum{};
    for (; end < corners && keys[order[end]] == keys[order[first]]; ++end) {
      const std::uint32_t c = order[end];
      const Vector n = {keys[c][3], keys[c][4], keys[c][5]};
      sum = combined(1, sum, angle_at(of.positions, c), across(axes[c].along, n));
    }
    end = std::max(end, first + 1);  // a coordinate that is no number is like none
    for (; first < end; ++first) {
      const std::uint32_t c = order[first];
      const Vector n = {keys[c][3], keys[c][4], keys[c][5]};
      const Vector mean = across(sum, n);
      means[c].along = dot(mean, mean) > 0 ? mean : across(axes[c].along, n);
    }
  }
  return means;
}

void take_given(const AxesOfCorners& of, std::vector<FaceAxis>& axes) {
  PollSometimes poll;
  for (std::size_t c = 0; 4 * c < of.tangents.size(); ++c) {
    poll();
    const double* given = &of.tangents[4 * c];
    const Vector along = across({given[0], given[1], given[2]}, normal_at(of, c));
    if (!(dot(along, along) > 0)) continue;
    axes[c] = {along, given[3] < 0 ? -1.0 : 1.0};
  }
}

}  // namespace

std::vector<AxesTurn> axes_turns(const AxesOfCorners& corners, const Work& work) {
  std::vector<FaceAxis> before = corner_axes(corners, corners.old_uvs, work);
  take_given(corners, before);
  const std::vector<FaceAxis> after = corner_axes(corners, corners.new_uvs, work);
  std::vector<AxesTurn> turns(before.size() / 3);
  PollSometimes poll;
  for (std::size_t c = 0; c < before.size(); ++c) {
    poll();
    AxesTurn& turn = turns[c / 3];
    turn.old_side = before[c].side;
    turn.new_side = after[c].side;
    const Vector& from = after[c].along;
    const Vector& to = before[c].along;
    const double cosine = dot(from, to), sine = dot(cross(normal_at(corners, c), from), to);
    if (cosine * cosine + sine * sine > 0) turn.corners[c % 3] = {cosine, sine};
  }
  return turns;
}

}  // namespace beltrami
