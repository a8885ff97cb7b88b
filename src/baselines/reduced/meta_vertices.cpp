#include "baselines/reduced/meta_vertices.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "base/portable_math.h"
#include "base/vectors.h"
#include "mesh/boundary.h"

namespace beltrami {
namespace {

constexpr Index kMostByStride = 250;  // the Newton systems are dense: cost grows with its cube
constexpr Index kUsualStride = 10;
constexpr Index kLargeMesh = 500000;  // faces, beyond which only the cap decides
constexpr Index kShortBoundary = 100;
/// The straight pieces are no longer than this share of the square root of the area: a long
/// boundary, as of a mesh cut open, carries more of the shape (tenth vertices alone: 12% to 25%
/// more energy).
constexpr double kLongestPiece = 0.05;
constexpr double kCurvedShare = 0.001;

Index stride_along(const DiskMesh& mesh, const std::vector<double>& lengths, const Work& work) {
  const Index count = size_of(mesh.boundary);
  if (count < kShortBoundary) return 1;
  const Index cap = (count + kMostByStride - 1) / kMostByStride;
  if (mesh.face_count() > kLargeMesh) return cap;
  const double length = std::accumulate(lengths.begin(), lengths.end(), 0.0);
  const double longest = kLongestPiece * std::sqrt(surface_area(mesh, work));
  const auto fitting = static_cast<Index>(std::min<double>(kUsualStride, longest * count / length));
  return std::max({cap, fitting, Index{1}});
}

/// pi minus the sum of the angles at a boundary vertex.
double boundary_curvature(const DiskMesh& mesh, Index vertex) {
  double curvature = std::numbers::pi;
  mesh.for_each_outgoing(vertex, [&](Index h) {
    const Vec3& centre = mesh.positions[vertex];
    const Vec3 a = mesh.positions[mesh.target(h)] - centre;
    const Vec3 b = mesh.positions[mesh.origin(DiskMesh::previous(h))] - centre;
    curvature -= portable::atan2(a.cross(b).norm(), a.dot(b));
  });
  return curvature;
}

void choose_curved(const DiskMesh& mesh, std::vector<bool>& chosen) {
  const Index count = size_of(mesh.boundary);
  std::vector<std::pair<double, Index>> ranked;  // ties go to the earlier position
  for (Index i = 0; i < count; ++i) {
    ranked.emplace_back(-std::abs(boundary_curvature(mesh, mesh.boundary[i])), i);
  }
  const auto wanted = static_cast<Index>(std::ceil(kCurvedShare * count));
  std::partial_sort(ranked.begin(), ranked.begin() + wanted, ranked.end());
  for (Index r = 0; r < wanted; ++r) chosen[ranked[r].second] = true;
}

/// The position strictly between two others (end may exceed the loop) nearest the middle by length.
Index middle_between(const std::vector<double>& lengths, Index begin, Index end) {
  const Index count = size_of(lengths);
  double total = 0;
  for (Index i = begin; i < end; ++i) total += lengths[i % count];
  Index middle = begin + 1;
  double before = lengths[begin % count];
  while (middle + 1 < end && before + 0.5 * lengths[middle % count] < 0.5 * total) {
    before += lengths[middle++ % count];
  }
  return middle % count;
}

void choose_at_bridges(const DiskMesh& mesh, const std::vector<double>& lengths,
                       std::vector<bool>& chosen) {
  const Index count = size_of(mesh.boundary);
  std::vector<bool> bridge_end(mesh.vertex_count(), false);
  for (Index h = 0; h < size_of(mesh.twin); ++h) {
    const Index from = mesh.origin(h), to = mesh.target(h);
    if (mesh.twin[h] == kNone || !mesh.on_boundary[from] || !mesh.on_boundary[to]) continue;
    bridge_end[from] = bridge_end[to] = true;
  }
  std::vector<Index> ends;
  for (Index i = 0; i < count; ++i) {
    if (!bridge_end[mesh.boundary[i]]) continue;
    ends.push_back(i);
    chosen[i] = true;
  }
  for (Index e = 0; e < size_of(ends); ++e) {
    const Index end = e + 1 < size_of(ends) ? ends[e + 1] : ends.front() + count;
    if (end - ends[e] > 1) chosen[middle_between(lengths, ends[e], end)] = true;
  }
}

/// Places the boundary vertices between the chosen ones.
MetaVertices connect(const std::vector<bool>& chosen, const std::vector<double>& lengths) {
  const Index count = size_of(lengths);
  MetaVertices metas;
  for (Index i = 0; i < count; ++i) {
    if (chosen[i]) metas.loop.push_back(i);
  }
  metas.piece.resize(count);
  metas.share.resize(count);
  for (Index m = 0; m < metas.count(); ++m) {
    const Index begin = metas.loop[m];
    const Index end = m + 1 < metas.count() ? metas.loop[m + 1] : metas.loop.front() + count;
    double arc = 0;
    for (Index i = begin; i < end; ++i) arc += lengths[i % count];
    metas.arc.push_back(arc);
    double along = 0;
    for (Index i = begin; i < end; ++i) {
      metas.piece[i % count] = m;
      metas.share[i % count] = along / arc;
      along += lengths[i % count];
    }
  }
  return metas;
}

}  // namespace

MetaVertices choose_meta_vertices(const DiskMesh& mesh, const Work& work) {
  const Index count = size_of(mesh.boundary);
  const std::vector<double> lengths = boundary_lengths(mesh);
  const Index stride = stride_along(mesh, lengths, work);
  std::vector<bool> chosen(count, false);
  for (Index i = 0; i < count; i += stride) chosen[i] = true;
  choose_curved(mesh, chosen);
  choose_at_bridges(mesh, lengths, chosen);
  return connect(chosen, lengths);
}

}  // namespace beltrami
