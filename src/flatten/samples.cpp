#include "flatten/samples.h"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace beltrami {
namespace {

constexpr double kCells = 1024;  // of the curve along each axis: 10 bits

/// Spreads the low 10 bits of `x`, two zeros between each.
std::uint32_t spread(std::uint32_t x) {
  x = (x | x << 16) & 0x030000ff;
  x = (x | x << 8) & 0x0300f00f;
  x = (x | x << 4) & 0x030c30c3;
  return (x | x << 2) & 0x09249249;
}

/// The faces that are not `taken`, along a Morton curve through their centroids.
std::vector<Index> along_curve(const DiskMesh& mesh, const std::vector<bool>& taken) {
  Vec3 low = mesh.positions.front(), high = low;
  for (const Vec3& p : mesh.positions) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double extent = (high - low).maxCoeff();
  const double cells_per_length = extent > 0 ? kCells / extent : 0;
  std::vector<std::pair<std::uint32_t, Index>> keyed;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    if (taken[f]) continue;
    const Triangle& t = mesh.faces[f];
    const Vec3 centroid = (mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]]) / 3;
    std::uint32_t key = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double cell =
          std::clamp((centroid[axis] - low[axis]) * cells_per_length, 0.0, kCells - 1);
      key |= spread(static_cast<std::uint32_t>(cell)) << axis;
    }
    keyed.emplace_back(key, f);
  }
  std::sort(keyed.begin(), keyed.end());
  std::vector<Index> order;
  order.reserve(keyed.size());
  for (const auto& [key, face] : keyed) order.push_back(face);
  return order;
}

}  // namespace

SampledFaces sample_faces(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                          const std::vector<Index>& vertices, Index strata) {
  std::vector<bool> taken(mesh.face_count(), false);
  for (const Index v : vertices) {
    mesh.for_each_outgoing(v, [&](Index h) { taken[h / 3] = true; });
  }
  SampledFaces samples;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    if (!taken[f]) continue;
    samples.faces.push_back(f);
    samples.weights.push_back(rest[f].area());
  }
  const std::vector<Index> others = along_curve(mesh, taken);
  if (size_of(others) <= strata) {
    for (const Index f : others) {
      samples.faces.push_back(f);
      samples.weights.push_back(rest[f].area());
    }
    return samples;
  }
  double total = 0;
  for (const Index f : others) total += rest[f].area();
  // Run r covers the area [r, r + 1) * stride. A face larger than a run stands for several.
  const double stride = total / strata;
  double before = 0;
  Index run = 0;
  for (const Index f : others) {
    before += rest[f].area();
    Index runs = 0;
    while (run < strata && (run + 0.5) * stride < before) {
      ++runs;
      ++run;
    }
    if (runs == 0) continue;
    samples.faces.push_back(f);
    samples.weights.push_back(runs * stride);
  }
  return samples;
}

}  // namespace beltrami
