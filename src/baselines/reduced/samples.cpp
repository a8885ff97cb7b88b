#include "baselines/reduced/samples.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numeric>
#include <queue>
#include <utility>

#include "base/vectors.h"

namespace beltrami {
namespace {

constexpr double kCells = 1024;  // of the curve along each axis: 10 bits
/// The boundary layer, in lengths of the straight piece at hand: a face at distance d has the extra
/// importance kLayer * area / (d + kInner * length)^2 up to d = kOuter * length. That makes about
/// kLayer / kInner samples for each piece.
constexpr double kInner = 0.25, kOuter = 2;
constexpr double kLayer = 3;

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

/// What is near a vertex: how far the boundary is, along edges, and how long its straight piece
/// there.
struct Near {
  double distance = std::numeric_limits<double>::infinity();
  double length = 0;
};

/// For all vertices within the boundary layer (Dijkstra's algorithm from the whole boundary).
std::vector<Near> boundary_layer(const DiskMesh& mesh, const MetaVertices& metas) {
  using Entry = std::pair<double, Index>;
  std::vector<Near> near(mesh.vertex_count());
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  for (Index i = 0; i < size_of(mesh.boundary); ++i) {
    near[mesh.boundary[i]] = {0, metas.arc[metas.piece[i]]};
    queue.emplace(0, mesh.boundary[i]);
  }
  while (!queue.empty()) {
    const double distance = queue.top().first;
    const Index v = queue.top().second;
    queue.pop();
    if (distance > near[v].distance) continue;
    const double length = near[v].length;
    mesh.for_each_outgoing(v, [&](Index h) {
      // On the boundary one neighbour has no outgoing half-edge from here; it is a source itself.
      const Index w = mesh.target(h);
      const double reached = distance + (mesh.positions[w] - mesh.positions[v]).norm();
      if (!(reached < near[w].distance) || reached > kOuter * length) return;
      near[w] = {reached, length};
      queue.emplace(reached, w);
    });
  }
  return near;
}

/// Samples per area at a face, on top of the uniform ones.
double layer_density(const Triangle& face, const std::vector<Near>& near) {
  double distance = 0, length = 0;
  for (const Index v : face) {
    distance += near[v].distance / 3;
    length += near[v].length / 3;
  }
  if (!(distance <= kOuter * length)) return 0;
  const double graded = distance + kInner * length;
  return kLayer / (graded * graded);
}

}  // namespace

SampledFaces sample_faces(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                          const MetaVertices& metas, Index strata) {
  std::vector<bool> taken(mesh.face_count(), false);
  for (const Index at : metas.loop) {
    mesh.for_each_outgoing(mesh.boundary[at], [&](Index h) { taken[h / 3] = true; });
  }
  SampledFaces samples;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    if (!taken[f]) continue;
    samples.faces.push_back(f);
    samples.weights.push_back(rest[f].area());
  }
  const auto fans = static_cast<std::ptrdiff_t>(samples.faces.size());
  const std::vector<Index> others = along_curve(mesh, taken);
  double total = 0;
  for (const Index f : others) total += rest[f].area();
  if (size_of(others) <= strata) {
    samples.faces.insert(samples.faces.end(), others.begin(), others.end());
    for (const Index f : others) samples.weights.push_back(rest[f].area());
    return samples;
  }
  const std::vector<Near> near = boundary_layer(mesh, metas);
  // Run r covers the importance [r, r + 1). A face worth several runs is taken once.
  double before = 0, run = 0.5;
  for (const Index f : others) {
    const double density = strata / total + layer_density(mesh.faces[f], near);
    before += density * rest[f].area();
    if (before <= run) continue;
    const double runs = std::ceil(before - run);
    run += runs;
    samples.faces.push_back(f);
    // A face worth less than a run stands for the others of its kind, too.
    samples.weights.push_back(runs / density);
  }
  const double sampled =
      std::accumulate(samples.weights.begin() + fans, samples.weights.end(), 0.0);
  for (auto w = samples.weights.begin() + fans; w != samples.weights.end(); ++w)
    *w *= total / sampled;
  return samples;
}

}  // namespace beltrami
