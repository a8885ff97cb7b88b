#include "cut/search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "cut/local_maps.h"
#include "cut/open_minimal.h"
#include "cut/seam_search.h"
#include "simplify/simplify.h"

namespace beltrami {
namespace {

/// Seams are decided on so many faces: finer ones add little to what is to be seen of a shape.
constexpr Index kCoarseFaces = 10'000;
/// A surface of a few more is taken as it is.
constexpr double kWorthSimplifying = 1.3;
/// Faces that a component keeps on the average.
constexpr Index kLeastFaces = 300;
/// What an edge inside a filled hole costs of its length: no seam will be there.
constexpr double kVirtualCost = 0.1;
/// Tolerance of the maps that judge: their energies are within 1% of the excess over 2.
constexpr double kMapTolerance = 1e-3;
constexpr int kRounds = 6;
/// Where the excess is so near to the one asked for, a further round gains nothing.
constexpr double kNear = 0.9;
/// The next target of the model aims at so much of the excess asked for.
constexpr double kAim = 0.97;
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
  std::vector<Index> fine_vertex;  ///< per vertex; empty: this is the fine surface
  CollapseHistory history;
};

std::vector<double> costs_of(const Surface& surface, Index real_faces, const EdgeMarks& locked) {
  std::vector<double> cost(surface.twin.size());
  for (Index h = 0; h < size_of(cost); ++h) {
    const Index twin = surface.twin[h];
    const bool is_virtual = h / 3 >= real_faces && (twin == kNone || twin / 3 >= real_faces);
    const Vec3 edge = surface.positions[surface.target(h)] - surface.positions[surface.origin(h)];
    cost[h] = edge.norm() * (is_virtual ? kVirtualCost : 1);
    if (!locked.empty() && locked[h]) cost[h] = std::numeric_limits<double>::infinity();
  }
  return cost;
}

Coarse coarsen(const Surface& fine, Index real_faces, const Topology& topology,
               const EdgeMarks& locked, const Work& work) {
  Index target = 0;
  for (const Component& component : topology.components) {
    target += std::min(component.faces, kLeastFaces);
  }
  target = std::max(target, kCoarseFaces);
  Coarse coarse;
  if (fine.face_count() <= kWorthSimplifying * target) {
    coarse = {fine, real_faces, locked, costs_of(fine, real_faces, locked), {}, {}};
    return coarse;
  }
  CoarseSurface simple = simplify_surface(fine, topology.loops, target, work);
  coarse.real_faces = static_cast<Index>(
      std::lower_bound(simple.fine_face.begin(), simple.fine_face.end(), real_faces) -
      simple.fine_face.begin());
  coarse.surface = std::move(simple.mesh);
  coarse.cost = costs_of(coarse.surface, coarse.real_faces, {});
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

  /// Of two that reach the target the shorter one, else the one that is nearer to it.
  bool is_better_than(const Attempt& other, double target) const {
    const bool reaches = energy <= target;
    if (reaches != (other.energy <= target)) return reaches;
    return reaches ? cost < other.cost : energy < other.energy;
  }
};

/// Corrects the model by maps until these have the energy that is asked for.
Attempt find(const Coarse& coarse, const SeamTarget& target, const Work& work) {
  const Topology topology = topology_of(coarse.surface, work);
  SeamSearch search(coarse.surface, coarse.real_faces, coarse.cost,
                    open_minimal(coarse.surface, topology, coarse.locked, work), work);
  Attempt best;
  LocalMaps maps;
  double model_energy = target.energy;
  for (int round = 0; round < kRounds; ++round) {
    work.report(static_cast<double>(round) / kRounds);
    if (search.energy() < model_energy) search.shrink(model_energy);
    const bool goes_on = search.extend(model_energy);
    search.exchange(model_energy);
    maps = map_locally(coarse.surface, coarse.real_faces, search.seams(), kMapTolerance,
                       round == 0 ? nullptr : &maps, work);
    Attempt attempt{search.seams(), search.anchors(), search.cost(), maps.energy};
    if (attempt.is_better_than(best, target.energy)) best = std::move(attempt);
    const double excess = maps.energy - 2, wanted = target.energy - 2;
    if (excess <= wanted && excess >= kNear * wanted) break;
    if (excess > wanted && !goes_on) break;
    const double step =
        std::clamp(kAim * wanted / std::max(excess, kLeastExcess), kLeastStep, kMostStep);
    model_energy = 2 + std::max(search.energy() - 2, kLeastExcess) * step;
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

EdgeMarks carried(const Coarse& coarse, const Surface& fine, const Attempt& found) {
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
  return marks_of(fine, carry_edges(coarse.history, edges, fine.on_boundary, anchors));
}

}  // namespace

SearchedSeams search_seams(const Surface& surface, Index real_faces, const Topology& topology,
                           const EdgeMarks& locked, const SeamTarget& target, const Work& work) {
  const Coarse coarse = coarsen(surface, real_faces, topology, locked, work.part(0, 0.3));
  Attempt found = find(coarse, target, work.part(0.3, 0.9));
  if (coarse.fine_vertex.empty()) return {std::move(found.seams), found.energy};
  return {carried(coarse, surface, found), found.energy};
}

}  // namespace beltrami
