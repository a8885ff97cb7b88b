#include "mesh/rest_shape.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/parallel.h"

namespace beltrami {
namespace {

constexpr std::int64_t kGrain = 8192;
constexpr double kDegenerateHeight = 1e-9;  // of the longest edge
constexpr double kMollifiedHeight = 1e-3;   // of the longest edge: steep, yet far from the roundoff

/// A stand-in for a face without height: the longest edge kept, the apex lifted off it.
RestTriangle mollified(const std::array<Vec3, 3>& p, double mean_edge) {
  int k = 0;
  for (int i = 1; i < 3; ++i) {
    if ((p[next_corner(i)] - p[i]).squaredNorm() > (p[next_corner(k)] - p[k]).squaredNorm()) k = i;
  }
  const Vec3 edge = p[next_corner(k)] - p[k];
  const double longest = std::max(edge.norm(), kMollifiedHeight * mean_edge);
  const double along =
      std::clamp((p[previous_corner(k)] - p[k]).dot(edge) / (longest * longest), 0.0, 1.0);
  std::array<Complex, 3> flat;
  flat[k] = 0;
  flat[next_corner(k)] = longest;
  flat[previous_corner(k)] = Complex(along * longest, kMollifiedHeight * longest);
  const Complex e1 = flat[1] - flat[0], e2 = flat[2] - flat[0];
  const double x1 = modulus(e1);
  const Complex turned = e2 * std::conj(e1) / x1;
  return {x1, turned.real(), turned.imag()};
}

double mean_edge(const std::vector<Vec3>& positions, const std::vector<Triangle>& faces,
                 const Work& work) {
  const auto edge_sum = [&](std::int64_t begin, std::int64_t end) {
    double sum = 0;
    for (std::int64_t f = begin; f < end; ++f) {
      for (int k = 0; k < 3; ++k) {
        sum += (positions[faces[f][next_corner(k)]] - positions[faces[f][k]]).norm();
      }
    }
    return sum;
  };
  return parallel_sum(work, size_of(faces), kGrain, edge_sum) / (3.0 * size_of(faces));
}

/// Gives the degenerate faces their shapes.
void mollify_degenerate(const std::vector<Vec3>& positions, const std::vector<Triangle>& faces,
                        const Work& work, std::vector<RestTriangle>& rest) {
  const double mean = mean_edge(positions, faces, work);
  for (const Index f : degenerate_faces(positions, faces, work)) {
    const auto [a, b, c] = faces[f];
    rest[f] = mollified({positions[a], positions[b], positions[c]}, mean);
  }
}

}  // namespace

bool is_degenerate(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 e1 = b - a, e2 = c - a;
  const double longest_sq = std::max({e1.squaredNorm(), e2.squaredNorm(), (c - b).squaredNorm()});
  return !(e1.cross(e2).norm() > kDegenerateHeight * longest_sq);
}

std::vector<Index> degenerate_faces(const std::vector<Vec3>& positions,
                                    const std::vector<Triangle>& faces, const Work& work) {
  return parallel_filter(work, size_of(faces), kGrain, [&](Index f) {
    const auto [a, b, c] = faces[f];
    return is_degenerate(positions[a], positions[b], positions[c]);
  });
}

std::vector<RestTriangle> rest_triangles(const std::vector<Vec3>& positions,
                                         const std::vector<Triangle>& faces, const Work& work) {
  std::vector<RestTriangle> rest;
  parallel_assign(work, rest, faces.size());
  std::atomic<bool> all_good{true};
  parallel_for(work, size_of(faces), kGrain, [&](std::int64_t begin, std::int64_t end) {
    bool good = true;
    for (std::int64_t f = begin; f < end; ++f) {
      const auto [a, b, c] = faces[f];
      const Vec3 e1 = positions[b] - positions[a], e2 = positions[c] - positions[a];
      const double sq1 = e1.squaredNorm();
      const double longest_sq =
          std::max({sq1, e2.squaredNorm(), (positions[c] - positions[b]).squaredNorm()});
      const double x1 = std::sqrt(sq1), double_area = e1.cross(e2).norm();
      good = good && double_area > kDegenerateHeight * longest_sq;
      rest[f] = {x1, e1.dot(e2) / x1, double_area / x1};
    }
    if (!good) all_good = false;
  });
  if (!all_good) mollify_degenerate(positions, faces, work, rest);
  return rest;
}

}  // namespace beltrami
