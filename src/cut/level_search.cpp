#include "cut/level_search.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/portable_math.h"
#include "cut/cut_into_charts.h"
#include "cut/edge_marks.h"
#include "cut/mirrored_seams.h"
#include "cut/split_overlaps.h"
#include "cut/straighten.h"
#include "cut/turning.h"
#include "mesh/chart.h"
#include "mesh/disk_mesh.h"
#include "mesh/surface.h"

namespace beltrami {
namespace {

/// First paths go astray by what they cost: times exp(a sin), waves of so many roots of the area in
/// three directions.
constexpr double kAstray = 0.25, kWaveLength = 1.0 / 3;
/// Of a budget the coarse seams may spend so much: on the fine surface they are longer.
constexpr double kSpent = 0.97;
/// Tolerance of the maps that judge: their energies are within 1% of the excess over 2.
constexpr double kMapTolerance = 1e-3;
/// Where a map lies on itself on no more of its area, contact mends it: at a cost of no more than
/// so much of the excess, or the map is parted, too, where it lies on itself on less.
constexpr double kMostOverlap = 0.03, kLeastOverlap = 0.005, kWorthContact = 0.06;
/// Maps whose excess is more times the one asked for are of cuts that will grow.
constexpr double kWorthParting = 1.3;
/// Charts are joined again on trial so often.
constexpr int kJoins = 6;
/// What is shorter by less is not worth another map.
constexpr double kWorthMapping = 1e-3;
/// Beyond any excess of the model; and what differs by less is one.
constexpr double kFar = 1e9, kSame = 1.02;
constexpr int kRounds = 8, kTrims = 6;
/// Where the excess is so near to the one asked for, a further round gains nothing; trimming goes
/// on to there.
constexpr double kNear = 0.98, kFull = 0.997;
/// The next target of the model aims at so much of the excess asked for.
constexpr double kAim = 0.99;
/// By how much the model is corrected in a round.
constexpr double kLeastStep = 0.3, kMostStep = 2;
/// The model's excess is not to be believed below.
constexpr double kLeastExcess = 1e-4;
/// An excess so far below the one asked for leaves the model in doubt.
constexpr double kDoubtful = 0.9;

/// Costs for the first paths of a start: smooth, and the same wherever the surface is moved to.
std::vector<double> costs_astray(const Surface& surface, const std::vector<double>& cost,
                                 int number, const Work& work) {
  if (number == 0) return cost;
  const double scale = 1 / (kWaveLength * std::sqrt(surface_area(surface, work)));
  Eigen::AlignedBox3d box;
  for (const Vec3& p : surface.positions) box.extend(p);
  const std::array<Vec3, 3> directions = {Vec3(0.36, 0.48, 0.8), Vec3(0.8, -0.6, 0),
                                          Vec3(0.48, 0.64, -0.6)};
  std::vector<double> factor;
  for (const Vec3& p : surface.positions) {
    double waves = 0;
    for (int k = 0; k < 3; ++k) {
      const double pitch = 1 + 0.2 * (number * (k + 1) % 5);
      const double turns = scale * pitch * directions[k].dot(p - box.center());
      waves += portable::sin(2 * std::numbers::pi * turns + number * (2.1 + k));
    }
    factor.push_back(portable::exp(kAstray * waves));
  }
  std::vector<double> astray = cost;
  for (Index h = 0; h < size_of(astray); ++h) {
    astray[h] *= std::sqrt(factor[surface.origin(h)] * factor[surface.target(h)]);
  }
  return astray;
}

}  // namespace

bool Attempt::is_better_than(const Attempt& other) const {
  const bool reaches = excess <= 1;
  if (reaches != (other.excess <= 1)) return reaches;
  return reaches ? cost < other.cost : excess < other.excess;
}

double Attempt::promised() const {
  return cost * portable::exp(kSeamPrice * portable::log(std::max(excess, 1.0)));
}

LevelSearch::LevelSearch(const SearchLevel& level, AnchoredSeams seams, const Start& start,
                         const SeamTarget& target, const Work& work, const Mirror* mirror)
    : level_(level),
      mirror_(mirror),
      start_(start),
      target_(target),
      work_(work),
      path_cost_(path_costs(level)),
      search_(level.surface, level.real_faces, path_cost_, std::move(seams.seams),
              target.seam_budget * kSpent, start.least_cost, work, std::move(seams.anchors),
              mirror) {}

/// Of the seams, and of their turns where these count.
double LevelSearch::cost_with_turns() const {
  if (level_.straightness == 0) return search_.cost();
  return search_.cost() + cost_of_turns(level_.surface, search_.seams(), level_.cost,
                                        search_.anchors(), level_.straightness);
}

/// Short and straight seams miss some of what the others ran to: they are taken where they are
/// shorter with what has to be added to them, exactly so much or what is worth most.
void LevelSearch::shorten_seams(double model_energy, bool exactly) {
  if (mirror_ != nullptr) return;  // each side on its own they would not stay alike
  const EdgeMarks before = search_.seams();
  const std::vector<bool> anchors = search_.anchors();
  const double cost = cost_with_turns(), energy = std::max(model_energy, search_.energy());
  search_.reconnect();
  search_.take(straighten(level_.surface, search_.seams(), level_.cost, search_.anchors(),
                          level_.locked, level_.straightness, work_.aside()));
  search_.extend(energy, exactly);
  const bool is_better = cost_with_turns() < cost && search_.energy() <= energy;
  if (!is_better) search_.take(before, anchors);
}

/// The first paths of this start. Whether the energy is reached.
bool LevelSearch::extend_first(double model_energy) {
  std::vector<double> cost = costs_astray(level_.surface, path_cost_, start_.number, work_.aside());
  path_cost_.swap(cost);
  search_.take(search_.seams());
  search_.reopen();
  const bool reaches = search_.extend(model_energy);
  path_cost_.swap(cost);
  search_.take(search_.seams());
  return reaches;
}

Attempt LevelSearch::sketch() {
  extend_first(target_.energy);
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

/// What was added on one side is added on the other.
void LevelSearch::mirror_seams() {
  std::array<AnchoredSeams, 2> mirrored;
  std::array<double, 2> cost = {};
  for (const int i : {0, 1}) {
    mirrored[i] = mirrored_seams(level_.surface, *mirror_, {search_.seams(), search_.anchors()},
                                 2 * i - 1, path_cost_, level_.locked, work_);
    for (Index h = 0; h < size_of(path_cost_); ++h) {
      if (mirrored[i].seams[h] && level_.surface.edge(h) == h) cost[i] += path_cost_[h];
    }
  }
  AnchoredSeams& more = mirrored[cost[1] > cost[0] ? 1 : 0];
  search_.take(std::move(more.seams), std::move(more.anchors));
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
    if (part_overlaps(maps, overlap)) {
      if (mirror_ != nullptr) mirror_seams();
      maps = map(&maps);
    }
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
  for (int i = 0; i < kTrims && best.excess < kFull && !work_.out_of_time(); ++i) {
    const double excess = best.model_energy - 2;
    search_.take(best.seams.seams, best.seams.anchors);
    search_.shrink(2 + excess * (1 + share * (kFull / std::max(best.excess, 0.5) - 1)));
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
  std::array<double, 2> last = {-1, -1};  // cost and energy of the model, judged before
  double excess = kFar;
  double reached = 0, missed = kFar;  // excesses of the model: the greatest, and the least
  for (int round = 0; round < kRounds; ++round) {
    work_.report(static_cast<double>(round) / kRounds);
    const bool is_first = round == 0 && !is_sketched;
    if (search_.energy() < model_energy) search_.shrink(model_energy);
    const bool is_correction = round > 0;
    const bool goes_on =
        is_first ? extend_first(model_energy) : search_.extend(model_energy, is_correction);
    shorten_seams(model_energy, is_correction);
    if (is_first) {
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

void LevelSearch::join_charts(Attempt& best) {
  std::vector<Index> tried;
  for (int i = 0; i < kJoins && best.excess <= 1 && !work_.out_of_time();) {
    work_.report(static_cast<double>(i) / kJoins);
    search_.take(best.seams.seams, best.seams.anchors);
    const CutSurface cut = cut_into_charts(level_.surface, search_.seams(), work_);
    const double aim = 2 + (best.model_energy - 2) * kAim / std::max(best.excess, kDoubtful);
    bool gained = false;
    for (const SeamSearch::Joint& joint : search_.joints(cut.chart_of_face, aim)) {
      if (std::find(tried.begin(), tried.end(), joint.middle()) != tried.end()) continue;
      tried.push_back(joint.middle());
      search_.take(best.seams.seams, best.seams.anchors);
      search_.join(joint);
      search_.extend(aim, true);
      shorten_seams(aim, true);
      if (search_.cost() > best.cost * (1 - kWorthMapping)) continue;
      LocalMaps maps;
      Attempt attempt;
      ++i;
      gained = judge(false, maps, attempt) && attempt.is_better_than(best);
      if (gained) best = std::move(attempt);
      if (gained || i == kJoins) break;
    }
    if (!gained) return;
  }
}

}  // namespace beltrami
