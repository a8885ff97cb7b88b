#include "mesh/boundary.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "base/portable_math.h"
#include "base/types.h"

namespace beltrami {
namespace {

constexpr double kShortestShare = 1e-3;  // of the mean edge

}  // namespace

std::vector<double> boundary_lengths(const DiskMesh& mesh) {
  const Index count = size_of(mesh.boundary);
  std::vector<double> lengths(count);
  for (Index i = 0; i < count; ++i) {
    const Index a = mesh.boundary[i], b = mesh.boundary[i + 1 == count ? 0 : i + 1];
    lengths[i] = (mesh.positions[b] - mesh.positions[a]).norm();
  }
  const double total = std::accumulate(lengths.begin(), lengths.end(), 0.0);
  const double shortest = total > 0 ? kShortestShare * total / count : 1.0;
  for (double& length : lengths) length = std::max(length, shortest);
  return lengths;
}

std::vector<Vec2> boundary_on_circle(const DiskMesh& mesh, const Work& work) {
  const std::vector<double> lengths = boundary_lengths(mesh);
  const double total = std::accumulate(lengths.begin(), lengths.end(), 0.0);
  // A surface without area, as simplification may leave of one that is mostly collapsed, still
  // gets a circle.
  const double area = surface_area(mesh, work);
  const double radius =
      area > 0 ? std::sqrt(area / std::numbers::pi) : total / (2 * std::numbers::pi);
  std::vector<Vec2> places;
  double along = 0;
  for (const double length : lengths) {
    const double angle = 2 * std::numbers::pi * along / total;
    places.push_back(radius * Vec2(portable::cos(angle), portable::sin(angle)));
    along += length;
  }
  return places;
}

std::vector<Vec2> boundary_polygon(const DiskMesh& mesh, const std::vector<Vec2>& uvs) {
  std::vector<Vec2> polygon;
  for (const Index v : mesh.boundary) polygon.push_back(uvs[v]);
  return polygon;
}

std::vector<bool> only_first_of_boundary(const DiskMesh& mesh) {
  std::vector<bool> held(mesh.vertex_count(), false);
  held[mesh.boundary.front()] = true;
  return held;
}

}  // namespace beltrami
