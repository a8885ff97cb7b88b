#include "cut/search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "cut/local_maps.h"
#include "cut/open_minimal.h"
#include "cut/seam_costs.h"
#include "cut/seam_search.h"
#include "cut/split_overlaps.h"
#include "cut/straighten.h"
#include "simplify/simplify.h"

namespace beltrami {
namespace {

/// Seams are decided on so many faces: finer ones add little to what is to be seen of a shape.
constexpr Index kCoarseFaces = 10'000;
/// A surface of a few more is taken as it is.
constexpr double kWorthSimplifying = 1.3;
/// Faces that a component keeps on the average.
constexpr Index kLeastFaces = 300;
/// A seam goes so far around to leave an edge that it was carried to, and that is locked.
constexpr double kLockedCost = 1000;
/// What an edge inside a filled hole costs of its length: no seam will be there.
constexpr double kVirtualCost = 0.1;
/// Of a budget the coarse seams may spend so much: on the fine surface they are longer.
constexpr double kSpent = 0.97;
/// Tolerance of the maps that judge: their energies are within 1% of the excess over 2.
constexpr double kMapTolerance = 1e-3;
/// Where a map lies on itself on no more of its area, contact mends it at little cost.
constexpr double kCoarseOverlap = 0.005;
/// Maps whose excess is more times the one asked for are of cuts that will grow.
constexpr double kWorthParting = 1.3;
constexpr std::int64_t kGrain = 16384;
/// Beyond any excess of the model; and what differs by less is one.
constexpr double kFar = 1e9, kSame = 1.02;
constexpr int kRounds = 8;
/// Where the excess is so near to the one asked for, a further round gains nothing.
constexpr double kNear = 0.98;
/// The next target of the model aims at so much of the excess asked for.
constexpr double kAim = 0.99;
/// By how much the model is corrected in a round.
constexpr double kLeastStep = 0.3, kMostStep = 2;
/// The model's excess is not to be believed below.
constexpr double kLeastExcess = 1e-4;

/// The surface on which seams are sought.
struct Coarse {
  Surface surface;
  Index real_faces = 0;
  EdgeMarks locked;
  std::vector<double> cost;        ///< per half-edge
  std::vector<double> factor;      ///< per vertex, what seams there cost for their length by shape
  std::vector<Index> fine_vertex;  ///< per vertex; empty: this is the fine surface
  CollapseHistory history;
};

/// Edges inside filled holes cost less.
void cheapen_virtual(const Surface& surface, Index real_faces, std::vector<double>& cost) {
  for (Index h = 3 * real_faces; h < size_of(cost); ++h) {
    const Index twin = surface.twin[h];
    if (twin == kNone || twin / 3 >= real_faces) cost[h] *= kVirtualCost;
  }
}

std::vector<double> costs_of(const Surface& surface, Index real_faces, const SeamWeights& weights,
                             const SeamHints& hints, const Work& work) {
  std::vector<double> cost = seam_costs(surface, weights, hints, work);
  cheapen_virtual(surface, real_faces, cost);
  return cost;
}

/// Per vertex, what the edges at it cost for their length, without paint and labels.
std::vector<double> factors_of_shape(const Surface& surface, const SeamWeights& weights,
                                     double hard_angle, const Work& work) {
  SeamHints hints;
  hints.hard_angle = hard_angle;
  const std::vector<double> cost = seam_costs(surface, weights, hints, work);
  const std::vector<double> length = edge_lengths(surface, work);
  std::vector<Vec2> sums(surface.positions.size(), Vec2::Zero());
  for (Index h = 0; h < size_of(cost); ++h) sums[surface.origin(h)] += Vec2(cost[h], length[h]);
  std::vector<double> factors;
  for (const Vec2& sum : sums) factors.push_back(sum.y() > 0 ? sum.x() / sum.y() : 1);
  return factors;
}

/// What seams cost on the fine surface: as at the coarse vertices that its own became.
std::vector<double> fine_costs(const Coarse& coarse, const Surface& fine, Index real_faces,
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
  if (!hints.labels.empty()) weigh_labels(fine, hints.labels, weights.materials, cost, work);
  weigh_paint(fine, hints.vertex_paint, hints.edge_paint, cost, work);
  cheapen_virtual(fine, real_faces, cost);
  return cost;
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

Coarse coarsen(const Surface& fine, Index real_faces, const Topology& topology,
               const EdgeMarks& locked, const SeamWeights& weights, const SeamHints& hints,
               const Work& work) {
  Index target = 0;
  for (const Component& component : topology.components) {
    target += std::min(component.faces, kLeastFaces);
  }
  target = std::max(target, kCoarseFaces);
  Coarse coarse;
  if (fine.face_count() <= kWorthSimplifying * target) {
    coarse.surface = fine;
    coarse.real_faces = real_faces;
    coarse.locked = locked;
    coarse.cost = costs_of(fine, real_faces, weights, hints, work);
    return coarse;
  }
  CoarseSurface simple = simplify_surface(fine, topology.loops, target, work);
  coarse.real_faces = static_cast<Index>(
      std::lower_bound(simple.fine_face.begin(), simple.fine_face.end(), real_faces) -
      simple.fine_face.begin());
  coarse.cost = costs_of(simple.mesh, coarse.real_faces, weights,
                         coarse_hints(hints, simple, fine.vertex_count()), work);
  coarse.factor = factors_of_shape(simple.mesh, weights, hints.hard_angle, work);
  coarse.surface = std::move(simple.mesh);
  coarse.fine_vertex = std::move(simple.fine_vertex);
  coarse.history = std::move(simple.history);
  return coarse;
}

/// Seams and what is known of them.
struct Attempt {
  EdgeMarks seams;
  std::vector<bool> anchors;
  double cost = std::numeric_limits<double>::infinity();
  double energy = std::numeric_limits<double>::infinity();
  double excess = std::numeric_limits<double>::infinity();  ///< over 2, by that asked for

  /// Of two that reach the target the shorter one, else the one that is nearer to it.
  bool is_better_than(const Attempt& other) const {
    const bool reaches = excess <= 1;
    if (reaches != (other.excess <= 1)) return reaches;
    return reaches ? cost < other.cost : excess < other.excess;
  }
};

/// Costs for paths: infinite along edges that are not to be cut.
std::vector<double> path_costs(const Coarse& coarse) {
  std::vector<double> cost = coarse.cost;
  for (std::size_t h = 0; h < coarse.locked.size(); ++h) {
    if (coarse.locked[h]) cost[h] = std::numeric_limits<double>::infinity();
  }
  return cost;
}

/// Corrects the model by maps until these have the energy that is asked for.
class Closure {
 public:
  Closure(const Coarse& coarse, const SeamTarget& target, const Work& work)
      : coarse_(coarse),
        target_(target),
        work_(work),
        path_cost_(path_costs(coarse)),
        search_(
            coarse.surface, coarse.real_faces, path_cost_,
            open_minimal(coarse.surface, topology_of(coarse.surface, work), coarse.locked, work),
            target.seam_budget * kSpent, work) {}

  Attempt run();

 private:
  void shorten_seams(double model_energy);
  LocalMaps map(const LocalMaps* before) const;
  bool part_overlaps(const LocalMaps& maps);
  double missed_by(const LocalMaps& maps) const;

  const Coarse& coarse_;
  const SeamTarget& target_;
  const Work work_;
  std::vector<double> path_cost_;
  SeamSearch search_;
};

/// Short and straight seams miss some of what the others ran to: they are taken where they are
/// shorter with what has to be added to them.
void Closure::shorten_seams(double model_energy) {
  const EdgeMarks before = search_.seams();
  const std::vector<bool> anchors = search_.anchors();
  const double cost = search_.cost(), energy = std::max(model_energy, search_.energy());
  search_.reconnect();
  search_.take(straighten(coarse_.surface, search_.seams(), coarse_.cost, search_.anchors(),
                          coarse_.locked, work_.aside()));
  search_.extend(energy);
  const bool is_better = search_.cost() < cost && search_.energy() <= energy;
  if (!is_better) search_.take(before, anchors);
}

LocalMaps Closure::map(const LocalMaps* before) const {
  return map_locally(coarse_.surface, coarse_.real_faces, search_.seams(), kMapTolerance, before,
                     work_);
}

/// Parts the charts that lie on themselves. Whether there was one.
bool Closure::part_overlaps(const LocalMaps& maps) {
  EdgeMarks seams = search_.seams();
  bool parted = false;
  Index charts = size_of(maps.uvs);
  for (std::size_t c = 0; c < maps.uvs.size(); ++c) {
    const Chart& chart = maps.cut.charts[c];
    std::vector<double> cost(chart.mesh.twin.size());
    const auto surface_halfedge = [&](Index h) { return 3 * chart.input_face[h / 3] + h % 3; };
    for (Index h = 0; h < size_of(cost); ++h) cost[h] = path_cost_[surface_halfedge(h)];
    const OverlapSplit split =
        split_overlaps(chart.mesh, maps.uvs[c], cost, kCoarseOverlap, work_.aside());
    charts += split.parts - 1;
    if (target_.max_charts > 0 && charts > target_.max_charts) {
      charts -= split.parts - 1;
      continue;  // contact keeps its parts apart
    }
    for (Index h = 0; h < size_of(cost); ++h) {
      if (!split.seams[h]) continue;
      mark_edge(coarse_.surface, surface_halfedge(h), seams);
      parted = true;
    }
  }
  if (parted) search_.take(std::move(seams));
  return parted;
}

/// The excess of maps over 2 by that which is asked for, of the mean or of the percentile.
double Closure::missed_by(const LocalMaps& maps) const {
  double most = (maps.energy - 2) / (target_.energy - 2);
  if (target_.p99 > 0) most = std::max(most, (maps.p99 - 2) / (target_.p99 - 2));
  return most;
}

Attempt Closure::run() {
  Attempt best;
  LocalMaps maps;
  double model_energy = target_.energy;
  double reached = 0, missed = kFar;  // excesses of the model: the greatest, and the least
  for (int round = 0; round < kRounds; ++round) {
    work_.report(static_cast<double>(round) / kRounds);
    if (search_.energy() < model_energy) search_.shrink(model_energy);
    const bool goes_on = search_.extend(model_energy);
    shorten_seams(model_energy);
    maps = map(round == 0 ? nullptr : &maps);
    const bool ends = round + 1 == kRounds || work_.out_of_time();
    const bool is_last = !goes_on || ends;
    if ((missed_by(maps) <= kWorthParting || is_last) && part_overlaps(maps)) maps = map(&maps);
    const double excess = missed_by(maps);
    if (excess <= kWorthParting || is_last) {
      Attempt attempt{search_.seams(), search_.anchors(), search_.cost(), maps.energy, excess};
      if (attempt.is_better_than(best)) best = std::move(attempt);
    }
    if (ends || (excess <= 1 ? excess >= kNear : is_last)) break;
    const double model_excess = std::max(search_.energy() - 2, kLeastExcess);
    double& bound = excess <= 1 ? reached : missed;
    bound = excess <= 1 ? std::max(bound, model_excess) : std::min(bound, model_excess);
    if (reached > 0 && reached < missed && missed < kFar) {
      if (missed < kSame * reached) break;
      model_energy = 2 + std::sqrt(reached * missed);
    } else {
      const double step = std::clamp(kAim / std::max(excess, kLeastExcess), kLeastStep, kMostStep);
      model_energy = 2 + model_excess * step;
    }
  }
  return best;
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

/// The seams on the fine surface, straightened there.
EdgeMarks carried(const Coarse& coarse, const Surface& fine, std::vector<double> cost,
                  const EdgeMarks& locked, const Attempt& found, const Work& work) {
  std::vector<std::array<Index, 2>> edges;
  const Surface& surface = coarse.surface;
  for (Index h = 0; h < size_of(surface.twin); ++h) {
    if (!found.seams[h] || surface.edge(h) != h) continue;
    edges.push_back({coarse.fine_vertex[surface.origin(h)], coarse.fine_vertex[surface.target(h)]});
  }
  std::vector<bool> anchors(fine.positions.size(), false);
  for (std::size_t v = 0; v < found.anchors.size(); ++v) {
    if (found.anchors[v]) anchors[coarse.fine_vertex[v]] = true;
  }
  const EdgeMarks marks =
      marks_of(fine, carry_edges(coarse.history, edges, fine.on_boundary, anchors));
  if (locked.empty()) return straighten(fine, marks, cost, anchors, locked, work);
  // The coarse surface does not know of locked edges: seams on them go around, or give way.
  for (std::size_t h = 0; h < locked.size(); ++h) {
    if (locked[h]) cost[h] *= kLockedCost;
  }
  EdgeMarks free = straighten(fine, marks, cost, anchors, locked, work);
  for (std::size_t h = 0; h < locked.size(); ++h) free[h] = free[h] && !locked[h];
  return free;
}

}  // namespace

SearchedSeams search_seams(const Surface& surface, Index real_faces, const Topology& topology,
                           const EdgeMarks& locked, const SeamTarget& target,
                           const SeamWeights& weights, const SeamHints& hints, const Work& work) {
  const Coarse coarse =
      coarsen(surface, real_faces, topology, locked, weights, hints, work.part(0, 0.3));
  Attempt found = Closure(coarse, target, work.part(0.3, 0.9)).run();
  if (coarse.fine_vertex.empty()) return {std::move(found.seams), found.energy};
  return {carried(coarse, surface, fine_costs(coarse, surface, real_faces, weights, hints, work),
                  locked, found, work.part(0.9, 1)),
          found.energy};
}

}  // namespace beltrami
