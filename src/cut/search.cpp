#include "cut/search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "cut/local_maps.h"
#include "cut/open_minimal.h"
#include "cut/seam_costs.h"
#include "cut/seam_search.h"
#include "cut/search_level.h"
#include "cut/split_overlaps.h"
#include "cut/straighten.h"
#include "mesh/chart.h"

namespace beltrami {
namespace {

/// Seams are decided on so many faces: finer ones add little to what is to be seen of a shape.
constexpr Index kCoarseFaces = 10'000;
/// What is to be joined by long seams is seen on so many.
constexpr Index kRoughFaces = 3000;
/// What a path costs beside its own, in roots of the area: one search prefers many short ones, one
/// few long ones, and the better is taken.
constexpr std::array kLeastCosts = {0.02, 0.06};
/// Of a surface of no more faces both are finished, which makes seams 2% shorter: on a larger one
/// the search is to take less than half of the flattening.
constexpr Index kThoroughFaces = 100'000;
/// Of a budget the coarse seams may spend so much: on the fine surface they are longer.
constexpr double kSpent = 0.97;
/// Tolerance of the maps that judge: their energies are within 1% of the excess over 2.
constexpr double kMapTolerance = 1e-3;
/// Where a map lies on itself on no more of its area, contact mends it: at a cost of no more than
/// so much of the excess, or the map is parted, too, where it lies on itself on less.
constexpr double kMostOverlap = 0.03, kLeastOverlap = 0.005, kWorthContact = 0.06;
/// Maps whose excess is more times the one asked for are of cuts that will grow.
constexpr double kWorthParting = 1.3;
/// Straightening that gains more than the rest moves seams from where they are needed.
constexpr double kStraight = 0.95;
/// Beyond any excess of the model; and what differs by less is one.
constexpr double kFar = 1e9, kSame = 1.02;
constexpr int kRounds = 8, kTrims = 3;
/// Where the excess is so near to the one asked for, a further round gains nothing.
constexpr double kNear = 0.98;
/// The next target of the model aims at so much of the excess asked for.
constexpr double kAim = 0.99;
/// By how much the model is corrected in a round.
constexpr double kLeastStep = 0.3, kMostStep = 2;
/// The model's excess is not to be believed below.
constexpr double kLeastExcess = 1e-4;

/// Seams and what is known of them.
struct Attempt {
  AnchoredSeams seams;
  double model_energy = 2;
  double cost = std::numeric_limits<double>::infinity();
  double energy = std::numeric_limits<double>::infinity();
  double excess = std::numeric_limits<double>::infinity();  ///< over 2, by that asked for
  std::vector<std::vector<Vec2>> maps;                      ///< per chart

  /// Of two that reach the target the shorter one, else the one that is nearer to it.
  bool is_better_than(const Attempt& other) const {
    const bool reaches = excess <= 1;
    if (reaches != (other.excess <= 1)) return reaches;
    return reaches ? cost < other.cost : excess < other.excess;
  }
};

/// Costs for paths: infinite along edges that are not to be cut.
std::vector<double> path_costs(const SearchLevel& level) {
  std::vector<double> cost = level.cost;
  for (std::size_t h = 0; h < level.locked.size(); ++h) {
    if (level.locked[h]) cost[h] = std::numeric_limits<double>::infinity();
  }
  return cost;
}

/// Seams of a level: by the model, and corrected by maps until these have the energy asked for.
class LevelSearch {
 public:
  LevelSearch(const SearchLevel& level, AnchoredSeams start, double least_cost,
              const SeamTarget& target, const Work& work)
      : level_(level),
        target_(target),
        work_(work),
        path_cost_(path_costs(level)),
        search_(level.surface, level.real_faces, path_cost_, std::move(start.seams),
                target.seam_budget * kSpent, least_cost, work, std::move(start.anchors)) {}

  /// By the model alone.
  Attempt sketch();
  /// `is_sketched`: the start is a sketch.
  Attempt run(bool is_sketched);

 private:
  void shorten_seams(double model_energy);
  LocalMaps map(const LocalMaps* before) const;
  bool part_overlaps(const LocalMaps& maps, double tolerance);
  double missed_by(const LocalMaps& maps) const;
  bool judge(bool is_last, LocalMaps& maps, Attempt& attempt);
  void trim(LocalMaps& maps, Attempt& best);

  const SearchLevel& level_;
  const SeamTarget& target_;
  const Work work_;
  std::vector<double> path_cost_;
  SeamSearch search_;
};

/// Short and straight seams miss some of what the others ran to: they are taken where they are
/// shorter with what has to be added to them.
void LevelSearch::shorten_seams(double model_energy) {
  const EdgeMarks before = search_.seams();
  const std::vector<bool> anchors = search_.anchors();
  const double cost = search_.cost(), energy = std::max(model_energy, search_.energy());
  search_.reconnect();
  search_.take(straighten(level_.surface, search_.seams(), level_.cost, search_.anchors(),
                          level_.locked, work_.aside()));
  search_.extend(energy);
  const bool is_better = search_.cost() < cost && search_.energy() <= energy;
  if (!is_better) search_.take(before, anchors);
}

Attempt LevelSearch::sketch() {
  search_.reopen();
  search_.extend(target_.energy);
  shorten_seams(target_.energy);
  search_.exchange(std::max(target_.energy, search_.energy()));
  search_.reopen();
  shorten_seams(target_.energy);
  Attempt sketch;
  sketch.seams = {search_.seams(), search_.anchors()};
  sketch.energy = sketch.model_energy = search_.energy();
  sketch.cost = search_.cost();
  sketch.excess = (sketch.energy - 2) / (target_.energy - 2);
  return sketch;
}

LocalMaps LevelSearch::map(const LocalMaps* before) const {
  return map_locally(level_.surface, level_.real_faces, search_.seams(), kMapTolerance, before,
                     work_);
}

/// Parts the charts that lie on themselves on more of their area. Whether there was one.
bool LevelSearch::part_overlaps(const LocalMaps& maps, double tolerance) {
  EdgeMarks seams = search_.seams();
  bool parted = false;
  Index charts = size_of(maps.uvs);
  for (std::size_t c = 0; c < maps.uvs.size(); ++c) {
    const Chart& chart = maps.cut.charts[c];
    std::vector<double> cost(chart.mesh.twin.size());
    const auto surface_halfedge = [&](Index h) { return 3 * chart.input_face[h / 3] + h % 3; };
    for (Index h = 0; h < size_of(cost); ++h) cost[h] = path_cost_[surface_halfedge(h)];
    const OverlapSplit split =
        split_overlaps(chart.mesh, maps.uvs[c], cost, tolerance, work_.aside());
    charts += split.parts - 1;
    if (target_.max_charts > 0 && charts > target_.max_charts) {
      charts -= split.parts - 1;
      continue;  // contact keeps its parts apart
    }
    for (Index h = 0; h < size_of(cost); ++h) {
      if (!split.seams[h]) continue;
      mark_edge(level_.surface, surface_halfedge(h), seams);
      parted = true;
    }
  }
  if (parted) search_.take(std::move(seams));
  return parted;
}

/// The excess of maps over 2 by that which is asked for, of the mean or of the percentile.
double LevelSearch::missed_by(const LocalMaps& maps) const {
  double most = (maps.energy - 2) / (target_.energy - 2);
  if (target_.p99 > 0) most = std::max(most, (maps.p99 - 2) / (target_.p99 - 2));
  return most;
}

/// Maps along the seams that there are, and what they are worth, overlaps parted where they are
/// near what is asked for. Whether they are.
bool LevelSearch::judge(bool is_last, LocalMaps& maps, Attempt& attempt) {
  maps = map(maps.uvs.empty() ? nullptr : &maps);
  attempt = Attempt();
  attempt.excess = missed_by(maps);
  if (attempt.excess > kWorthParting && !is_last) return false;
  LocalMaps apart;
  for (const double overlap : {kMostOverlap, kLeastOverlap}) {
    if (part_overlaps(maps, overlap)) maps = map(&maps);
    apart = with_contact(maps, level_.real_faces, kMapTolerance, work_);
    if (apart.energy - maps.energy <= kWorthContact * (target_.energy - 2)) break;
  }
  attempt = {{search_.seams(), search_.anchors()},
             search_.energy(),
             search_.cost(),
             apart.energy,
             missed_by(apart),
             std::move(apart.uvs)};
  return true;
}

/// Gives back what is left of the energy asked for: ends of branches.
void LevelSearch::trim(LocalMaps& maps, Attempt& best) {
  double share = 1;
  for (int i = 0; i < kTrims && best.excess < kNear && !work_.out_of_time(); ++i) {
    const double excess = best.model_energy - 2;
    search_.take(best.seams.seams, best.seams.anchors);
    search_.shrink(2 + excess * (1 + share * (kAim / std::max(best.excess, 0.5) - 1)));
    if (search_.cost() >= best.cost) return;
    Attempt attempt;
    const bool fine = judge(false, maps, attempt);
    if (fine && attempt.is_better_than(best)) {
      best = std::move(attempt);
    } else {
      share /= 2;
    }
  }
}

Attempt LevelSearch::run(bool is_sketched) {
  Attempt best;
  LocalMaps maps;
  double model_energy = target_.energy;
  if (!is_sketched) search_.reopen();
  std::array<double, 2> last = {-1, -1};  // cost and energy of the model, judged before
  double excess = kFar;
  double reached = 0, missed = kFar;  // excesses of the model: the greatest, and the least
  for (int round = 0; round < kRounds; ++round) {
    work_.report(static_cast<double>(round) / kRounds);
    if (search_.energy() < model_energy) search_.shrink(model_energy);
    const bool goes_on = search_.extend(model_energy);
    shorten_seams(model_energy);
    if (round == 0 && !is_sketched) {
      search_.exchange(std::max(model_energy, search_.energy()));
      shorten_seams(model_energy);
    }
    const bool ends = round + 1 == kRounds || work_.out_of_time();
    const bool is_last = !goes_on || ends;
    const std::array state = {search_.cost(), search_.energy()};
    if (state != last) {
      Attempt attempt;
      const bool is_near = judge(is_last, maps, attempt);
      excess = attempt.excess;
      if (is_near && attempt.is_better_than(best)) best = std::move(attempt);
    }
    last = {search_.cost(), search_.energy()};
    if (ends || (excess <= 1 ? excess >= kNear : is_last)) break;
    // An aim between the energies that there are ends at one of them.
    const double aimed = model_energy - 2;
    const double model_excess = std::max(search_.energy() - 2, kLeastExcess);
    if (excess <= 1) {
      reached = std::max({reached, model_excess, std::min(aimed, missed)});
    } else {
      missed = std::min({missed, model_excess, std::max(aimed, reached)});
    }
    if (reached > 0 && reached < missed && missed < kFar) {
      if (missed < kSame * reached) break;
      model_energy = 2 + std::sqrt(reached * missed);
    } else {
      const double step = std::clamp(kAim / std::max(excess, kLeastExcess), kLeastStep, kMostStep);
      model_energy = 2 + model_excess * step;
    }
  }
  if (best.excess <= 1) trim(maps, best);
  return best;
}

/// A cut graph that is as short as is easily had.
AnchoredSeams opened(const SearchLevel& level, const Work& work) {
  const Surface& surface = level.surface;
  return {open_minimal(surface, topology_of(surface, work), level.locked, work),
          std::vector<bool>(surface.positions.size(), false)};
}

/// The better of what `run` makes of each of the costs that a path may have beside its own.
template <typename Run>
Attempt best_of(const Work& work, const Run& run) {
  Attempt best;
  for (std::size_t i = 0; i < kLeastCosts.size(); ++i) {
    const double count = kLeastCosts.size(), from = i / count;
    Attempt attempt = run(kLeastCosts[i], work.part(from, from + 1 / count));
    if (attempt.is_better_than(best)) best = std::move(attempt);
  }
  return best;
}

/// Where the level has many faces, first on one of fewer; `is_thorough`: what comes of each start
/// there is finished, and not the better one alone.
Attempt search_level(const SearchLevel& level, bool is_thorough, const SeamTarget& target,
                     const SeamWeights& weights, const Work& work) {
  const auto without_sketch = [&] {
    const AnchoredSeams start = opened(level, work);
    return best_of(work, [&](double least_cost, const Work& part) {
      return LevelSearch(level, start, least_cost, target, part).run(false);
    });
  };
  if (!level.locked.empty()) return without_sketch();  // which coarse seams would not heed
  const SearchLevel rough =
      coarser_level(level.surface, level.real_faces, topology_of(level.surface, work), {},
                    kRoughFaces, weights, level.hints, work);
  if (rough.fine_vertex.empty()) return without_sketch();
  const AnchoredSeams start = opened(rough, work);
  const auto sketch = [&](double least_cost, const Work& part) {
    return LevelSearch(rough, start, least_cost, target, part).sketch();
  };
  const auto finish = [&](const Attempt& from, double least_cost, const Work& part) {
    AnchoredSeams carried = carry_to_finer(rough, level.surface, level.cost, {}, from.seams, part);
    return LevelSearch(level, std::move(carried), least_cost, target, part).run(true);
  };
  if (!is_thorough) {
    return finish(best_of(work.part(0, 0.3), sketch), kLeastCosts[0], work.part(0.3, 1));
  }
  return best_of(work, [&](double least_cost, const Work& part) {
    return finish(sketch(least_cost, part.part(0, 0.2)), least_cost, part.part(0.2, 1));
  });
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
                           const SeamWeights& weights, const SeamHints& hints, const Work& work) {
  SearchLevel coarse = coarser_level(surface, real_faces, topology, locked, kCoarseFaces, weights,
                                     hints, work.part(0, 0.3));
  Attempt found = search_level(coarse, surface.face_count() <= kThoroughFaces, target, weights,
                               work.part(0.3, 0.9));
  if (coarse.fine_vertex.empty()) {
    const bool is_cut = std::find(found.seams.seams.begin(), found.seams.seams.end(), true) !=
                        found.seams.seams.end();
    if (!is_cut) found.maps.clear();
    return {std::move(found.seams.seams), found.energy, {}, std::move(found.maps)};
  }
  hold_bends(coarse, work.aside(), found);
  AnchoredSeams fine = carry_to_finer(
      coarse, surface, finer_costs(coarse, surface, real_faces, weights, hints, work), locked,
      found.seams, work.part(0.9, 1));
  return {std::move(fine.seams), found.energy, std::move(coarse.history), {}};
}

}  // namespace beltrami
