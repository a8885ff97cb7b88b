#include "cut/search_seams.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <numeric>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "cut/cut_into_charts.h"
#include "cut/known_maps.h"
#include "cut/mirror.h"
#include "cut/mirrored_seams.h"
#include "cut/open_minimal.h"
#include "cut/refine_by_maps.h"
#include "cut/seam_costs.h"
#include "cut/seam_surface.h"
#include "cut/straighten.h"
#include "mesh/disk_mesh.h"

namespace beltrami {
namespace {

/// What a path costs beside its own, in roots of the area: one search prefers many short ones, one
/// few long ones, and the better is taken.
constexpr double kManyPaths = 0.02, kFewPaths = 0.06;
/// What was found is varied in rounds within these bounds.
constexpr Index kLeastRounds = 2, kMostRounds = 40;
/// What is within so much of the root of the area when mirrored is symmetric.
constexpr double kMirrorTolerance = 0.01;
/// Straightening that gains more than the rest moves seams from where they are needed.
constexpr double kStraight = 0.95;
// Shares of the progress: where a coarse surface is made; of the search on it where sketches begin
// and end; where that search ends if what it finds is improved; and where all of it ends.
constexpr double kCoarser = 0.1, kSketching = 0.05, kSketched = 0.4, kSearched = 0.35,
                 kFound = 0.94;

/// A cut graph that is as short as is easily had.
AnchoredSeams opened(const SeamSurface& coarse, const Work& work) {
  const Surface& surface = coarse.surface;
  return {open_minimal(surface, topology_of(surface, work), coarse.locked, work),
          std::vector<bool>(surface.positions.size(), false)};
}

bool any_of(const EdgeMarks& marks) {
  return std::find(marks.begin(), marks.end(), true) != marks.end();
}

/// What `run` makes of each of the items, side by side.
template <class Item, class Run>
std::vector<Attempt> attempts(const Work& work, const std::vector<Item>& items, const Run& run) {
  std::vector<Attempt> made(items.size());
  const std::thread::id caller = std::this_thread::get_id();
  const double count = static_cast<double>(items.size());
  parallel_for(work, std::ssize(items), 1, [&](std::int64_t i, std::int64_t) {
    const Work part = work.part(i / count, (i + 1) / count);
    made[i] = run(items[i], std::this_thread::get_id() == caller ? part : part.aside());
  });
  return made;
}

/// The best; without seams where none has a finite energy.
Attempt best_of(std::vector<Attempt> made) {
  Attempt best;
  for (Attempt& attempt : made) {
    if (attempt.is_better_than(best)) best = std::move(attempt);
  }
  return best;
}

/// Where the coarse surface has many faces, starts are sketched on one of fewer; `mirror`: whose
/// plane seams are drawn to, or null. Without seams where the time was up before any were judged.
Attempt search_coarse(const SeamSurface& coarse, KnownMaps& known, const SeamTarget& target,
                      const SearchEffort& effort, const SeamWeights& weights, const Mirror* mirror,
                      const Work& work) {
  std::vector<Start> starts;
  for (int i = 0; i < effort.starts; ++i) {
    starts.push_back({i % 2 == 0 ? kFewPaths : kManyPaths, i / 2});
  }
  const Surface& surface = coarse.surface;
  const Work begin = work.part(0, kSketching);
  const Topology topology = topology_of(surface, begin);
  const bool is_rough =
      coarse_target(surface, topology, effort.rough_faces) == surface.face_count();
  SeamSurface rough;
  if (!is_rough) {
    rough = make_seam_surface(surface, coarse.real_faces, topology, {}, effort.rough_faces, weights,
                              coarse.hints, begin);
    if (mirror != nullptr) weigh_mirror(rough.surface, *mirror, kAlongMirror, rough.cost, work);
  }
  const SeamSurface& sketched = is_rough ? coarse : rough;
  const AnchoredSeams open = opened(sketched, begin);
  const std::vector<Attempt> sketches =
      attempts(work.part(kSketching, kSketched), starts, [&](const Start& start, const Work& part) {
        if (part.out_of_time()) return Attempt();
        return SeamRefinement(sketched, known, open, start, target, effort, part).sketch();
      });
  std::vector<std::size_t> order(starts.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return sketches[a].promised() < sketches[b].promised();
  });
  order.resize(std::min(effort.finished, order.size()));
  const auto finish = [&](std::size_t i, const Work& part) {
    if (part.out_of_time() || sketches[i].seams.seams.empty()) return Attempt();
    AnchoredSeams carried = is_rough ? sketches[i].seams
                                     : carry_to_finer(rough, surface, coarse.cost, coarse.locked,
                                                      sketches[i].seams, part.part(0, 0));
    // Coarse seams do not heed locked edges: what gave way may have opened the surface.
    const bool is_open = is_rough || coarse.locked.empty() ||
                         cut_into_charts(surface, carried.seams, part.part(0, 0)).non_disks.empty();
    if (!is_open) carried = opened(coarse, part.part(0, 0));
    return SeamRefinement(coarse, known, std::move(carried), starts[i], target, effort, part)
        .run(is_open);
  };
  return best_of(attempts(work.part(kSketched, 1), order, finish));
}

double sum_of(const Surface& surface, const EdgeMarks& marks, const std::vector<double>& cost) {
  double sum = 0;
  for (Index h = 0; h < size_of(marks); ++h) {
    if (marks[h] && surface.edge(h) == h) sum += cost[h];
  }
  return sum;
}

double length_of(const Surface& surface, const EdgeMarks& marks) {
  double sum = 0;
  for (Index h = 0; h < size_of(marks); ++h) {
    if (!marks[h] || surface.edge(h) != h) continue;
    sum += (surface.positions[surface.target(h)] - surface.positions[surface.origin(h)]).norm();
  }
  return sum;
}

/// What half of the seams and its image make, as one that reaches the target, or comes as near to
/// it as they do; they themselves where that costs more than `most` times as much, by `cost`, or
/// breaks another bound that they keep. Whether it did not.
bool make_symmetric(const SeamSurface& coarse, KnownMaps& known, const Mirror& mirror,
                    const SeamTarget& target, const SearchEffort& effort,
                    const std::vector<double>& cost, double most, const Work& work,
                    Attempt& found) {
  const EdgeMarks& seams = found.seams.seams;
  if (!any_of(seams)) return true;
  const std::vector<double> path_cost = path_costs(coarse);
  const std::vector<int> sides = {1, -1};
  Attempt best = best_of(attempts(work, sides, [&](int side, const Work& part) {
    AnchoredSeams half =
        mirrored_seams(coarse.surface, mirror, found.seams, side, path_cost, coarse.locked, part);
    half.seams = straighten(coarse.surface, half.seams, coarse.cost, half.anchors, coarse.locked,
                            coarse.straightness, part);
    return SeamRefinement(coarse, known, std::move(half), Start(), target, effort, part, &mirror)
        .run(true);
  }));
  if (best.seams.seams.empty()) return false;
  const Surface& surface = coarse.surface;
  if (best.excess > std::max(1.0, found.excess)) return false;
  if (sum_of(surface, best.seams.seams, cost) > most * sum_of(surface, seams, cost)) return false;
  const auto is_possible = [&](const EdgeMarks& marks) {
    return std::isfinite(sum_of(surface, marks, path_cost));
  };
  if (is_possible(seams) && !is_possible(best.seams.seams)) return false;
  const double length = length_of(surface, best.seams.seams);
  const double budget = target.seam_budget * std::sqrt(surface_area(surface, work));
  if (budget > 0 && length > budget && length > length_of(surface, seams)) return false;
  const auto charts = [&](const EdgeMarks& marks) {
    return size_of(cut_into_charts(surface, marks, work).charts);
  };
  const Index parts = charts(best.seams.seams);
  if (target.max_charts > 0 && parts > target.max_charts && parts > charts(seams)) return false;
  found = std::move(best);
  return true;
}

/// On the coarse surface from nothing; `mirror`: whose plane seams are drawn to, or null.
Attempt search_anew(const SeamSurface& coarse, KnownMaps& known, const SeamTarget& target,
                    const SearchEffort& effort, const SeamWeights& weights, const Mirror* mirror,
                    const Work& work) {
  AnchoredSeams open = opened(coarse, work.part(0, 0));
  if (!any_of(open.seams)) {
    Attempt whole =
        SeamRefinement(coarse, known, open, Start(), target, effort, work.aside()).judged();
    if (whole.excess <= 1) return whole;
  }
  const double searched = effort.improves ? kSearched : 1;
  Attempt found =
      search_coarse(coarse, known, target, effort, weights, mirror, work.part(0, searched));
  if (found.seams.seams.empty()) found.seams = std::move(open);
  if (effort.improves) {
    const Index rounds =
        std::clamp(effort.varied_faces / coarse.surface.face_count(), kLeastRounds, kMostRounds);
    SeamRefinement(coarse, known, found.seams, Start(), target, effort, work.part(searched, 1))
        .improve(effort.varied_faces > 0 ? rounds : 0, found);
  }
  return found;
}

/// The mirror of a surface, towards whose plane seams are then drawn; null: it has
/// none.
std::shared_ptr<const Mirror> drawn_to_mirror(SeamSurface& coarse, const Work& work) {
  std::optional<Mirror> mirror = find_mirror(coarse.surface, kMirrorTolerance, work);
  if (!mirror) return {};
  weigh_mirror(coarse.surface, *mirror, kAlongMirror, coarse.cost, work);
  return std::make_shared<const Mirror>(*std::move(mirror));
}

/// Seams that would lose a bend for which they were made, if they were straightened, are held.
void hold_bends(const SeamSurface& coarse, const Work& work, Attempt& found) {
  const EdgeMarks straight =
      straighten(coarse.surface, found.seams.seams, coarse.cost, found.seams.anchors, coarse.locked,
                 coarse.straightness, work);
  if (sum_of(coarse.surface, straight, coarse.cost) >= kStraight * found.cost) return;
  for (Index h = 0; h < size_of(straight); ++h) {
    if (found.seams.seams[h]) found.seams.anchors[coarse.surface.origin(h)] = true;
  }
}

}  // namespace

SearchedSeams search_seams(const Surface& surface, Index real_faces, const Topology& topology,
                           const EdgeMarks& locked, const SeamTarget& target,
                           const SearchEffort& effort, const SeamWeights& weights,
                           const SeamHints& hints, const BegunSearch& begun, const Work& work) {
  SearchedSeams searched;
  BegunSearch& search = searched.search;
  search = {
      begun.coarse, {}, begun.mirror, begun.maps ? begun.maps : std::make_shared<KnownMaps>()};
  KnownMaps& known = *search.maps;
  Attempt found;
  if (begun.coarse && !begun.seams.seams.empty()) {
    SeamRefinement again(*begun.coarse, known, begun.seams, Start(), target, effort,
                         work.part(kCoarser, kFound), begun.mirror.get());
    found = effort.improves ? again.run_calibrated(0) : again.run(true);
    if (found.seams.seams.empty()) found.seams = begun.seams;
  } else {
    std::vector<double> cost;  // before any is drawn to a mirror
    if (!begun.coarse || weights.symmetry > 0) {
      SeamSurface coarse =
          make_seam_surface(surface, real_faces, topology, locked, effort.coarse_faces, weights,
                            hints, work.part(0, kCoarser));
      cost = coarse.cost;
      if (weights.symmetry > 0) search.mirror = drawn_to_mirror(coarse, work);
      search.coarse = std::make_shared<const SeamSurface>(std::move(coarse));
    }
    found = search_anew(*search.coarse, known, target, effort, weights, search.mirror.get(),
                        work.part(kCoarser, kFound));
    if (search.mirror &&
        !make_symmetric(*search.coarse, known, *search.mirror, target, effort, cost,
                        1 + weights.symmetry, work.part(kFound, 0.96), found)) {
      search.mirror.reset();
      SeamSurface coarse = *search.coarse;
      coarse.cost = std::move(cost);
      search.coarse = std::make_shared<const SeamSurface>(std::move(coarse));
      found = search_anew(*search.coarse, known, target, effort, weights, nullptr,
                          work.part(0.96, 0.97));
    }
  }
  searched.energy = found.energy;
  const SeamSurface& coarse = *search.coarse;
  if (coarse.fine_vertex.empty()) {
    if (any_of(found.seams.seams)) searched.maps = std::move(found.maps);
    searched.seams = std::move(found.seams.seams);
    return searched;
  }
  search.seams = found.seams;
  hold_bends(coarse, work.aside(), found);
  std::vector<double> cost = finer_costs(coarse, surface, real_faces, weights, hints, work);
  if (search.mirror) weigh_mirror(surface, *search.mirror, kAlongMirror, cost, work);
  AnchoredSeams carried =
      carry_to_finer(coarse, surface, std::move(cost), locked, found.seams, work.part(0.97, 1));
  if (surface.face_count() <= effort.finest_faces && !work.out_of_time() && any_of(carried.seams) &&
      !search.mirror && cut_into_charts(surface, carried.seams, work).non_disks.empty()) {
    auto whole = std::make_shared<const SeamSurface>(make_seam_surface(
        surface, real_faces, topology, locked, surface.face_count(), weights, hints, work));
    auto maps = std::make_shared<KnownMaps>();
    found = SeamRefinement(*whole, *maps, carried, Start(), target, effort, work.aside())
                .run_calibrated(0);
    if (found.excess <= 1) {
      search = {std::move(whole), found.seams, {}, std::move(maps)};
      searched.energy = found.energy;
      searched.seams = std::move(found.seams.seams);
      searched.maps = std::move(found.maps);
      return searched;
    }
  }
  searched.seams = std::move(carried.seams);
  return searched;
}

}  // namespace beltrami
