#include "multilevel/anchors.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "descend/contact.h"
#include "exact/crossings.h"
#include "mesh/boundary.h"

namespace beltrami {
namespace {

constexpr double kFirstReach = 0.001;  // of the boundary length, anchored around a crossing
constexpr double kReachGrowth = 3;

/// Anchors the boundary vertices within `reach` times the boundary length of the given edges.
void anchor_near(const DiskMesh& mesh, const std::vector<std::array<Index, 2>>& edges, double reach,
                 std::vector<bool>& anchored) {
  const std::vector<Index>& loop = mesh.boundary;
  const Index count = size_of(loop);
  const auto next = [count](Index i) { return i + 1 == count ? 0 : i + 1; };
  const std::vector<double> lengths = boundary_lengths(mesh);
  std::vector<double> apart(count, std::numeric_limits<double>::infinity());
  for (const auto& pair : edges) {
    for (const Index edge : pair) apart[edge] = apart[next(edge)] = 0;
  }
  // Twice around, so that the way across the start of the loop counts, too.
  for (Index step = 0; step < 2 * count; ++step) {
    const Index i = step % count;
    apart[next(i)] = std::min(apart[next(i)], apart[i] + lengths[i]);
  }
  for (Index step = 2 * count - 1; step >= 0; --step) {
    const Index i = step % count;
    apart[i] = std::min(apart[i], apart[next(i)] + lengths[i]);
  }
  const double most = reach * std::accumulate(lengths.begin(), lengths.end(), 0.0);
  for (Index i = 0; i < count; ++i) {
    if (apart[i] <= most) anchored[loop[i]] = true;
  }
}

}  // namespace

std::vector<bool> vertices_in_contact(const CoarseDisk& coarse, const std::vector<Vec2>& coarse_uvs,
                                      Index fine_vertices) {
  const std::vector<double> lengths = boundary_lengths(coarse.mesh);
  const BoundaryContact contact(coarse.mesh.boundary, lengths, lengths);
  std::vector<bool> found(fine_vertices, false);
  for (const Contact& c : contact.find(coarse_uvs)) {
    for (const Index v : {c.vertex, c.from, c.to}) found[coarse.fine_vertex[v]] = true;
  }
  return found;
}

bool solve_until_simple(const DiskMesh& mesh, const std::vector<Vec2>& uvs,
                        std::vector<bool>& anchored, const std::function<bool()>& solve) {
  for (double reach = kFirstReach;; reach *= kReachGrowth) {
    if (!solve()) return false;
    const auto crossings = find_crossings(mesh.boundary, uvs);
    if (crossings.empty()) return true;
    if (reach > 1) return false;
    anchored.resize(mesh.vertex_count(), false);
    anchor_near(mesh, crossings, reach * kReachGrowth > 1 ? 1.0 : reach, anchored);
  }
}

void put_in_place(const std::vector<bool>& anchored, const std::vector<Vec2>& carried,
                  std::vector<Vec2>& uvs) {
  for (std::size_t v = 0; v < anchored.size(); ++v) {
    if (anchored[v]) uvs[v] = carried[v];
  }
}

}  // namespace beltrami
