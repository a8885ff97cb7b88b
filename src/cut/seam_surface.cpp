#include "cut/seam_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "base/parallel.h"
#include "base/vectors.h"
#include "cut/seam_costs.h"
#include "cut/straighten.h"
#include "simplify/coarse.h"
#include "simplify/simplify.h"

namespace beltrami {
namespace {

/// A surface of a few more faces is taken as it is.
constexpr double kWorthSimplifying = 1.3;
/// Faces that a component keeps on the average.
constexpr Index kLeastFaces = 300;
/// A seam goes so far around to leave an edge that it was carried to, and that is locked.
constexpr double kLockedCost = 1000;
/// What an edge inside a filled hole costs of its length: no seam will be there.
constexpr double kVirtualCost = 0.1;
constexpr std::int64_t kGrain = 16384;

/// Edges inside filled holes cost less.
void cheapen_virtual(const Surface& surface, Index real_faces, std::vector<double>& cost) {
  for (Index h = 3 * real_faces; h < size_of(cost); ++h) {
    const Index twin = surface.twin[h];
    if (twin == kNone || twin / 3 >= real_faces) cost[h] *= kVirtualCost;
  }
}

/// Without paint and labels.
std::vector<double> costs_of_shape(const Surface& surface, const SeamWeights& weights,
                                   double hard_angle, const Work& work) {
  SeamHints hints;
  hints.hard_angle = hard_angle;
  return seam_costs(surface, weights, hints, work);
}

/// Paint and labels, and what is virtual.
void weigh_hints(const Surface& surface, Index real_faces, const SeamWeights& weights,
                 const SeamHints& hints, const Work& work, std::vector<double>& cost) {
  if (!hints.labels.empty()) weigh_labels(surface, hints.labels, weights.materials, cost, work);
  weigh_paint(surface, hints.vertex_paint, hints.edge_paint, cost, work);
  cheapen_virtual(surface, real_faces, cost);
}

/// Per vertex, what the edges at it cost for their length.
std::vector<double> factors_of(const Surface& surface, const std::vector<double>& cost,
                               const Work& work) {
  const std::vector<double> length = edge_lengths(surface, work);
  std::vector<Vec2> sums(surface.positions.size(), Vec2::Zero());
  for (Index h = 0; h < size_of(cost); ++h) sums[surface.origin(h)] += Vec2(cost[h], length[h]);
  std::vector<double> factors;
  for (const Vec2& sum : sums) factors.push_back(sum.y() > 0 ? sum.x() / sum.y() : 1);
  return factors;
}

/// The hints for a coarse surface: of an edge, the paint goes to its ends.
SeamHints coarse_hints(const SeamHints& fine, const CoarseSurface& coarse, Index fine_vertices) {
  SeamHints hints;
  hints.hard_angle = fine.hard_angle;
  std::vector<double> paint = fine.vertex_paint;
  if (!fine.edge_paint.empty()) {
    paint.resize(fine_vertices, 1);
    for (const PaintedEdge& edge : fine.edge_paint) {
      for (const Index v : edge.ends) paint[v] *= edge.factor;
    }
  }
  for (const Index v : coarse.fine_vertex) {
    if (!paint.empty()) hints.vertex_paint.push_back(paint[v]);
  }
  for (const Index f : coarse.fine_face) {
    if (!fine.labels.empty()) hints.labels.push_back(fine.labels[f]);
  }
  return hints;
}

/// Marks the edges between these vertices.
EdgeMarks marks_of(const Surface& surface, const std::vector<std::array<Index, 2>>& edges) {
  EdgeMarks marks(surface.twin.size(), false);
  for (const auto& [a, b] : edges) {
    surface.for_each_outgoing(a, [&, b = b](Index h) {
      if (surface.target(h) == b) mark_edge(surface, h, marks);
      if (surface.origin(Surface::previous(h)) == b) {
        mark_edge(surface, Surface::previous(h), marks);
      }
    });
  }
  return marks;
}

}  // namespace

Index coarse_target(const Surface& fine, const Topology& topology, Index faces) {
  Index target = 0;
  for (const Component& component : topology.components) {
    target += std::min(component.faces, kLeastFaces);
  }
  target = std::max(target, faces);
  return fine.face_count() <= kWorthSimplifying * target ? fine.face_count() : target;
}

SeamSurface make_seam_surface(const Surface& fine, Index real_faces, const Topology& topology,
                              const EdgeMarks& locked, Index faces, const SeamWeights& weights,
                              const SeamHints& hints, const Work& work) {
  const Index target = coarse_target(fine, topology, faces);
  SeamSurface coarse;
  coarse.straightness = weights.straightness;
  if (target == fine.face_count()) {
    coarse.surface = fine;
    coarse.real_faces = real_faces;
    coarse.locked = locked;
    coarse.hints = hints;
    coarse.cost = costs_of_shape(fine, weights, hints.hard_angle, work);
    weigh_hints(fine, real_faces, weights, hints, work, coarse.cost);
    return coarse;
  }
  CoarseSurface simple = simplify_surface(fine, topology.loops, target, work);
  coarse.real_faces = static_cast<Index>(
      std::lower_bound(simple.fine_face.begin(), simple.fine_face.end(), real_faces) -
      simple.fine_face.begin());
  coarse.hints = coarse_hints(hints, simple, fine.vertex_count());
  coarse.cost = costs_of_shape(simple.mesh, weights, hints.hard_angle, work);
  coarse.factor = factors_of(simple.mesh, coarse.cost, work);
  weigh_hints(simple.mesh, coarse.real_faces, weights, coarse.hints, work, coarse.cost);
  coarse.surface = std::move(simple.mesh);
  coarse.fine_vertex = std::move(simple.fine_vertex);
  coarse.history = std::move(simple.history);
  return coarse;
}

std::vector<double> finer_costs(const SeamSurface& coarse, const Surface& fine, Index real_faces,
                                const SeamWeights& weights, const SeamHints& hints,
                                const Work& work) {
  std::vector<double> factor(fine.positions.size(), 1);
  for (std::size_t v = 0; v < coarse.factor.size(); ++v) {
    factor[coarse.fine_vertex[v]] = coarse.factor[v];
  }
  const auto& steps = coarse.history.steps;
  for (auto step = steps.rbegin(); step != steps.rend(); ++step) {
    factor[step->vertex] = factor[step->target];
  }
  std::vector<double> cost = edge_lengths(fine, work);
  parallel_for(work, fine.face_count(), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (auto h = static_cast<Index>(3 * begin); h < 3 * end; ++h) {
      cost[h] *= std::sqrt(factor[fine.origin(h)] * factor[fine.target(h)]);
    }
  });
  weigh_hints(fine, real_faces, weights, hints, work, cost);
  return cost;
}

AnchoredSeams carry_to_finer(const SeamSurface& coarse, const Surface& fine,
                             std::vector<double> cost, const EdgeMarks& locked,
                             const AnchoredSeams& seams, const Work& work) {
  std::vector<std::array<Index, 2>> edges;
  const Surface& surface = coarse.surface;
  for (Index h = 0; h < size_of(surface.twin); ++h) {
    if (!seams.seams[h] || surface.edge(h) != h) continue;
    edges.push_back({coarse.fine_vertex[surface.origin(h)], coarse.fine_vertex[surface.target(h)]});
  }
  std::vector<bool> anchors(fine.positions.size(), false);
  for (std::size_t v = 0; v < seams.anchors.size(); ++v) {
    if (seams.anchors[v]) anchors[coarse.fine_vertex[v]] = true;
  }
  const EdgeMarks marks =
      marks_of(fine, carry_edges(coarse.history, edges, fine.on_boundary, anchors));
  if (locked.empty()) {
    EdgeMarks straight = straighten(fine, marks, cost, anchors, locked, coarse.straightness, work);
    return {std::move(straight), std::move(anchors)};
  }
  // The coarse surface does not know of locked edges: seams on them go around, or give way.
  for (std::size_t h = 0; h < locked.size(); ++h) {
    if (locked[h]) cost[h] *= kLockedCost;
  }
  EdgeMarks free = straighten(fine, marks, cost, anchors, locked, coarse.straightness, work);
  for (std::size_t h = 0; h < locked.size(); ++h) free[h] = free[h] && !locked[h];
  return {std::move(free), std::move(anchors)};
}

std::vector<double> path_costs(const SeamSurface& coarse) {
  std::vector<double> cost = coarse.cost;
  for (std::size_t h = 0; h < coarse.locked.size(); ++h) {
    if (coarse.locked[h]) cost[h] = std::numeric_limits<double>::infinity();
  }
  return cost;
}

}  // namespace beltrami
