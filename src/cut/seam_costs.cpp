#include "cut/seam_costs.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/interrupt.h"
#include "base/parallel.h"
#include "base/portable_math.h"
#include "base/vectors.h"
#include "cut/visibility.h"

namespace beltrami {
namespace {

constexpr std::int64_t kGrain = 16384;

/// A neighbourhood by the spacing of the sketch. A crease across a ring of the sketch gets its own
/// concavity at twice this.
constexpr double kReach = 2.5, kCreaseWidth = 2;

Vec3 along(const Surface& surface, Index h) {
  return surface.positions[surface.target(h)] - surface.positions[surface.origin(h)];
}

/// Calls visit(half-edge) for the one that each edge is called by, side by side.
template <class Visit>
void for_each_edge(const Surface& surface, const Work& work, const Visit& visit) {
  parallel_for(work, size_of(surface.twin), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (auto h = static_cast<Index>(begin); h < end; ++h) {
      if (surface.edge(h) == h) visit(h);
    }
  });
}

void set_edge(const Surface& surface, Index h, double value, std::vector<double>& values) {
  values[h] = value;
  if (surface.twin[h] != kNone) values[surface.twin[h]] = value;
}

/// Multiplies by factor(half-edge) what the edges cost.
template <class Factor>
void multiply(const Surface& surface, std::vector<double>& costs, const Work& work,
              const Factor& factor) {
  for_each_edge(surface, work, [&](Index h) { set_edge(surface, h, costs[h] * factor(h), costs); });
}

/// Per half-edge the chord between the normals of its faces, positive where it is concave as seen
/// from outside.
std::vector<double> edge_bends(const Surface& surface, const SurfaceSketch& sketch,
                               const Work& work) {
  std::vector<double> bends(surface.twin.size(), 0);
  for_each_edge(surface, work, [&](Index h) {
    if (surface.twin[h] == kNone) return;
    const Vec3& one = sketch.face_normals[h / 3];
    const Vec3& other = sketch.face_normals[surface.twin[h] / 3];
    if (one.isZero(0) || other.isZero(0)) return;
    const double chord = (one - other).norm();
    const bool is_ridge = one.cross(other).dot(along(surface, h)) > 0;
    const bool is_inside_out = sketch.inside_out[sketch.cluster_of[surface.origin(h)]];
    set_edge(surface, h, is_ridge == is_inside_out ? chord : -chord, bends);
  });
  return bends;
}

/// Per cluster, the bends of the edges around it, by their length over the area there.
std::vector<double> cluster_concavity(const Surface& surface, const SurfaceSketch& sketch,
                                      const std::vector<double>& bends) {
  const Index count = sketch.cluster_count();
  std::vector<double> turned(count, 0), mean(count, 0);
  PollSometimes poll;
  for (Index h = 0; h < size_of(surface.twin); ++h) {
    poll();
    if (bends[h] == 0 || surface.edge(h) != h) continue;
    const double half = bends[h] * along(surface, h).norm() / 2;
    turned[sketch.cluster_of[surface.origin(h)]] += half;
    turned[sketch.cluster_of[surface.target(h)]] += half;
  }
  const double reach = kReach * sketch.spacing, width = kCreaseWidth * sketch.spacing;
  for (Index c = 0; c < count; ++c) {
    double bend = turned[c], area = sketch.areas[c];
    for (Index i = sketch.start[c]; i < sketch.start[c + 1]; ++i) {
      const Index other = sketch.neighbours[i];
      const double weight =
          kernel((sketch.positions[c] - sketch.positions[other]).squaredNorm(), reach);
      bend += weight * turned[other];
      area += weight * sketch.areas[other];
    }
    if (area > 0) mean[c] = std::clamp(bend / area * width / std::numbers::sqrt2, -1.0, 1.0);
  }
  return mean;
}

double clamped_paint(double factor) {
  return std::max(kLeastPaint, std::min(factor, kMostPaint));
}

/// The half-edge between two vertices that the edge is called by, or kNone.
Index find_edge(const Surface& surface, Index a, Index b) {
  Index found = kNone;
  const auto look = [&](Index from, Index to) {
    if (surface.outgoing[from] == kNone) return;
    surface.for_each_outgoing(from, [&](Index h) {
      if (surface.target(h) == to) found = surface.edge(h);
    });
  };
  look(a, b);
  look(b, a);  // on the boundary only one of them goes out
  return found;
}

}  // namespace

std::vector<double> edge_lengths(const Surface& surface, const Work& work) {
  std::vector<double> lengths(surface.twin.size());
  for_each_edge(surface, work,
                [&](Index h) { set_edge(surface, h, along(surface, h).norm(), lengths); });
  const double sum =
      parallel_sum(work, size_of(lengths), kGrain, [&](std::int64_t begin, std::int64_t end) {
        double part = 0;
        for (std::int64_t h = begin; h < end; ++h) part += lengths[h];
        return part;
      });
  const double least = sum > 0 ? 1e-6 * sum / static_cast<double>(lengths.size()) : 1;
  for (double& length : lengths) length = std::max(length, least);
  return lengths;
}

std::vector<double> edge_concavity(const Surface& surface, const SurfaceSketch& sketch,
                                   const Work& work) {
  std::vector<double> bends = edge_bends(surface, sketch, work);
  const std::vector<double> around =
      carry_to_vertices(sketch, surface, cluster_concavity(surface, sketch, bends), work);
  const double width = 2 * kCreaseWidth * sketch.spacing;
  for_each_edge(surface, work, [&](Index h) {
    const double mean = (around[surface.origin(h)] + around[surface.target(h)]) / 2;
    if (surface.twin[h] == kNone) return set_edge(surface, h, mean, bends);
    const double length = along(surface, h).norm();
    const double area = sketch.face_areas[h / 3] + sketch.face_areas[surface.twin[h] / 3];
    const double own = std::clamp(bends[h] / std::numbers::sqrt2, -1.0, 1.0);
    const double share = length * width > area ? area / (length * width) : 1.0;
    set_edge(surface, h, share * own + (1 - share) * mean, bends);
  });
  return bends;
}

void weigh_concavity(const Surface& surface, const SurfaceSketch& sketch, double weight,
                     std::vector<double>& costs, const Work& work) {
  const std::vector<double> concavity = edge_concavity(surface, sketch, work);
  multiply(surface, costs, work, [&](Index h) { return portable::exp(-weight * concavity[h]); });
}

void weigh_visibility(const Surface& surface, const SurfaceSketch& sketch, double weight,
                      std::vector<double>& costs, const Work& work) {
  const std::vector<double> seen =
      carry_to_vertices(sketch, surface, visibility(sketch, work), work);
  multiply(surface, costs, work, [&](Index h) {
    return 1 + weight * (seen[surface.origin(h)] + seen[surface.target(h)]) / 2;
  });
}

void weigh_hard_edges(const Surface& surface, const SurfaceSketch& sketch, double angle,
                      double factor, std::vector<double>& costs, const Work& work) {
  if (angle >= std::numbers::pi) return;
  const double cosine = portable::cos(angle);
  multiply(surface, costs, work, [&](Index h) {
    if (surface.twin[h] == kNone) return 1.0;
    const Vec3& one = sketch.face_normals[h / 3];
    const Vec3& other = sketch.face_normals[surface.twin[h] / 3];
    const bool is_hard = !one.isZero(0) && !other.isZero(0) && one.dot(other) < cosine;
    return is_hard ? factor : 1.0;
  });
}

void weigh_labels(const Surface& surface, const std::vector<Index>& labels, double factor,
                  std::vector<double>& costs, const Work& work) {
  multiply(surface, costs, work, [&](Index h) {
    const Index twin = surface.twin[h];
    return twin != kNone && labels[h / 3] != labels[twin / 3] ? factor : 1.0;
  });
}

void weigh_paint(const Surface& surface, const std::vector<double>& vertex_paint,
                 const std::vector<PaintedEdge>& edge_paint, std::vector<double>& costs,
                 const Work& work) {
  if (!vertex_paint.empty()) {
    multiply(surface, costs, work, [&](Index h) {
      return std::sqrt(clamped_paint(vertex_paint[surface.origin(h)]) *
                       clamped_paint(vertex_paint[surface.target(h)]));
    });
  }
  for (const PaintedEdge& painted : edge_paint) {
    const Index h = find_edge(surface, painted.ends[0], painted.ends[1]);
    if (h != kNone) set_edge(surface, h, costs[h] * clamped_paint(painted.factor), costs);
  }
}

std::vector<double> seam_costs(const Surface& surface, const SeamWeights& weights,
                               const SeamHints& hints, const Work& work) {
  std::vector<double> costs = edge_lengths(surface, work);
  const SurfaceSketch sketch = beltrami::sketch(surface, work);
  if (weights.concavity > 0) weigh_concavity(surface, sketch, weights.concavity, costs, work);
  if (weights.visibility > 0) weigh_visibility(surface, sketch, weights.visibility, costs, work);
  weigh_hard_edges(surface, sketch, hints.hard_angle, weights.hard_edges, costs, work);
  if (!hints.labels.empty()) weigh_labels(surface, hints.labels, weights.materials, costs, work);
  weigh_paint(surface, hints.vertex_paint, hints.edge_paint, costs, work);
  return costs;
}

}  // namespace beltrami
