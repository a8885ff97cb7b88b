#include "cut/search.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <numeric>
#include <thread>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "cut/cut_into_charts.h"
#include "cut/level_search.h"
#include "cut/open_minimal.h"
#include "cut/seam_costs.h"
#include "cut/search_level.h"
#include "cut/straighten.h"

namespace beltrami {
namespace {

/// Seams are decided on so many faces: finer ones add little to what is to be seen of a shape.
constexpr Index kCoarseFaces = 10'000;
/// What is to be joined by long seams is seen on so many.
constexpr Index kRoughFaces = 3000;
/// What a path costs beside its own, in roots of the area: one search prefers many short ones, one
/// few long ones, and the better is taken.
constexpr double kManyPaths = 0.02, kFewPaths = 0.06;
/// With care, a surface is searched from so many starts with either, of which so many are finished,
/// and their charts joined on trial: seams are 2% shorter.
constexpr int kStarts = 3;
constexpr std::size_t kFinished = 3;
/// Straightening that gains more than the rest moves seams from where they are needed.
constexpr double kStraight = 0.95;

/// A cut graph that is as short as is easily had.
AnchoredSeams opened(const SearchLevel& level, const Work& work) {
  const Surface& surface = level.surface;
  return {open_minimal(surface, topology_of(surface, work), level.locked, work),
          std::vector<bool>(surface.positions.size(), false)};
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

Attempt best_of(std::vector<Attempt> made) {
  Attempt best;
  for (Attempt& attempt : made) {
    if (attempt.is_better_than(best)) best = std::move(attempt);
  }
  return best;
}

/// Of one level alone.
Attempt search_directly(const SearchLevel& level, const std::vector<Start>& starts,
                        const SeamTarget& target, const Work& work) {
  const AnchoredSeams open = opened(level, work);
  return best_of(attempts(work, starts, [&](const Start& start, const Work& part) {
    return LevelSearch(level, open, start, target, part).run(false);
  }));
}

/// Where the level has many faces, first on one of fewer; `is_thorough`: from more starts, of which
/// more are finished.
Attempt search_level(const SearchLevel& level, bool is_thorough, const SeamTarget& target,
                     const SeamWeights& weights, const Work& work) {
  std::vector<Start> starts;
  for (int number = 0; number < (is_thorough ? kStarts : 1); ++number) {
    for (const double least_cost : {kManyPaths, kFewPaths}) starts.push_back({least_cost, number});
  }
  const SearchLevel rough =
      coarser_level(level.surface, level.real_faces, topology_of(level.surface, work), {},
                    kRoughFaces, weights, level.hints, work);
  if (rough.fine_vertex.empty()) return search_directly(level, starts, target, work);
  const AnchoredSeams open = opened(rough, work);
  const std::vector<Attempt> sketches =
      attempts(work.part(0, 0.3), starts, [&](const Start& start, const Work& part) {
        return LevelSearch(rough, open, start, target, part).sketch();
      });
  std::vector<std::size_t> order(starts.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return sketches[a].promised() < sketches[b].promised();
  });
  order.resize(is_thorough ? kFinished : 1);
  return best_of(attempts(work.part(0.3, 1), order, [&](std::size_t i, const Work& part) {
    AnchoredSeams carried =
        carry_to_finer(rough, level.surface, level.cost, level.locked, sketches[i].seams, part);
    // Coarse seams do not heed locked edges: what gave way may have opened the surface.
    const bool is_open = level.locked.empty() ||
                         cut_into_charts(level.surface, carried.seams, part).non_disks.empty();
    if (!is_open) carried = opened(level, part);
    return LevelSearch(level, std::move(carried), starts[i], target, part).run(is_open);
  }));
}

/// Seams that would lose a bend for which they were made, if they were straightened, are held.
void hold_bends(const SearchLevel& level, const Work& work, Attempt& found) {
  const EdgeMarks straight = straighten(level.surface, found.seams.seams, level.cost,
                                        found.seams.anchors, level.locked, work);
  double cost = 0;
  for (Index h = 0; h < size_of(straight); ++h) {
    if (straight[h] && level.surface.edge(h) == h) cost += level.cost[h];
  }
  if (cost >= kStraight * found.cost) return;
  for (Index h = 0; h < size_of(straight); ++h) {
    if (found.seams.seams[h]) found.seams.anchors[level.surface.origin(h)] = true;
  }
}

}  // namespace

SearchedSeams search_seams(const Surface& surface, Index real_faces, const Topology& topology,
                           const EdgeMarks& locked, const SeamTarget& target,
                           const SeamWeights& weights, const SeamHints& hints,
                           const BegunSearch& begun, const Work& work) {
  SearchedSeams searched;
  searched.search.level = begun.level ? begun.level
                                      : std::make_shared<const SearchLevel>(coarser_level(
                                            surface, real_faces, topology, locked, kCoarseFaces,
                                            weights, hints, work.part(0, 0.3)));
  const SearchLevel& coarse = *searched.search.level;
  Attempt found;
  if (!begun.seams.seams.empty()) {
    found = LevelSearch(coarse, begun.seams, Start(), target, work.part(0.3, 0.9)).run(true);
  } else {
    const bool is_thorough = surface.face_count() <= kThoroughFaces;
    found = search_level(coarse, is_thorough, target, weights, work.part(0.3, 0.8));
    if (is_thorough) {
      LevelSearch(coarse, found.seams, Start(), target, work.part(0.8, 0.9)).join_charts(found);
    }
  }
  searched.energy = found.energy;
  if (coarse.fine_vertex.empty()) {
    const EdgeMarks& seams = found.seams.seams;
    const bool is_cut = std::find(seams.begin(), seams.end(), true) != seams.end();
    if (is_cut) searched.maps = std::move(found.maps);
    searched.seams = std::move(found.seams.seams);
    return searched;
  }
  searched.search.seams = found.seams;
  hold_bends(coarse, work.aside(), found);
  searched.seams = carry_to_finer(coarse, surface,
                                  finer_costs(coarse, surface, real_faces, weights, hints, work),
                                  locked, found.seams, work.part(0.9, 1))
                       .seams;
  return searched;
}

}  // namespace beltrami
