#include "cut/refine_by_maps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <thread>
#include <utility>

#include "base/bracket.h"
#include "base/parallel.h"
#include "base/portable_math.h"
#include "base/types.h"
#include "cut/astray.h"
#include "cut/cut_into_charts.h"
#include "cut/edge_marks.h"
#include "cut/mirrored_seams.h"
#include "cut/split_overlaps.h"
#include "mesh/chart.h"
#include "mesh/surface.h"

namespace beltrami {
namespace {

/// Steps that a search takes, about: for its progress alone.
constexpr double kUsualSteps = 3;
/// Share of a budget of length that coarse seams may spend: on the fine surface they are longer.
constexpr double kSpent = 0.97;
/// Relative decrease at which maps end that judge: descents that end sooner may stop on a plateau.
constexpr double kMostTolerance = 1e-3;
/// A map that lies on itself on more of its area is parted. Contact mends the rest.
constexpr double kMostOverlap = 0.005;
/// Maps with more times the excess asked for are of cuts that will grow: not worth parting yet.
constexpr double kWorthParting = 1.3;
/// Relative gain of length below which seams are not worth another map.
constexpr double kWorthMapping = 1e-3;
/// Rounds in which what misses the target comes nearer to it.
constexpr int kMostRounds = 8;
/// Shares of the excess asked for: with so much a further round gains nothing...
constexpr double kNear = 0.98;
/// ... and settling, which takes smaller steps, goes on to here. All steps aim at it. Seams whose
/// promised cost rises by more than this share have been spoilt: half a step is tried then.
constexpr double kFull = 0.997;
/// Factor by which the excess of the model is corrected in a round, up or down, at most.
constexpr double kMostStep = 2;
/// Excesses, of the model or by the one asked for, are not to be believed below.
constexpr double kLeastExcess = 1e-4;
/// Branches that go at once where seams are varied.
constexpr int kRuined = 4;

/// By how much the excess of the model is to change where maps have so much of the one asked for.
double step_for(double map_excess) {
  return std::clamp(kFull / std::max(map_excess, kLeastExcess), 1 / kMostStep, kMostStep);
}

/// Where the model's excess is to be so that maps just have the one asked for: a bracket between
/// those with which they had less and more.
class ModelAim {
 public:
  /// Maps of seams with which the model has this excess, where another was aimed at, have so much
  /// of the excess asked for. An aim between the energies that there are ends at one of them.
  void note(double aimed, double model_excess, double map_excess) {
    Bracket& b = bracket_;
    if (map_excess <= 1) {
      b.low = std::max({b.low, model_excess, std::min(aimed, b.high)});
    } else {
      b.high = std::min({b.high, model_excess, std::max(aimed, b.low)});
    }
    next_ = is_closed() ? std::sqrt(b.low * b.high) : step_for(map_excess) * model_excess;
  }

  /// Whether the next one would be the same.
  bool is_found() const { return is_closed() && bracket_.is_within(1 / kNear); }

  double next() const { return next_; }

 private:
  bool is_closed() const {
    return bracket_.low > 0 && bracket_.low < bracket_.high && bracket_.has_high();
  }

  Bracket bracket_{.low = 0};
  double next_ = 0;
};

}  // namespace

bool Attempt::is_better_than(const Attempt& other) const {
  if (is_estimate) return false;
  const bool reaches = excess <= 1;
  if (reaches != (other.excess <= 1)) return reaches;
  return reaches ? cost < other.cost : excess < other.excess;
}

double Attempt::promised() const {
  return cost * portable::exp(kSeamPrice * portable::log(std::max(excess, kLeastExcess)));
}

SeamRefinement::SeamRefinement(const SeamSurface& coarse, KnownMaps& known, AnchoredSeams seams,
                               const Start& start, const SeamTarget& target,
                               const SearchEffort& effort, const Work& work, const Mirror* mirror)
    : coarse_(coarse),
      known_(known),
      mirror_(mirror),
      start_(start),
      target_(target),
      effort_(effort),
      work_(work),
      path_cost_(path_costs(coarse)),
      tree_(coarse.surface, coarse.real_faces, path_cost_, std::move(seams.seams),
            target.seam_budget * kSpent, start.least_cost, work.part(0, 0),
            std::move(seams.anchors), mirror) {}

SeamRefinement::SeamRefinement(const SeamRefinement& other, const Work& work)
    : coarse_(other.coarse_),
      known_(other.known_),
      mirror_(other.mirror_),
      start_(other.start_),
      target_(other.target_),
      effort_(other.effort_),
      work_(work),
      steps_(other.steps_),
      path_cost_(other.path_cost_),
      tree_(other.tree_, path_cost_, work),
      contact_(other.contact_) {}

/// How many steps there will be is not known: the progress nears the end of its share.
void SeamRefinement::report_step() {
  ++steps_;
  work_.report(steps_ / (steps_ + kUsualSteps));
}

/// For what is a part of a step, and would take the progress to the end of the share.
Work SeamRefinement::here() const {
  const double done = steps_ / (steps_ + kUsualSteps);
  return work_.part(done, done);
}

/// Adds paths that go astray, after the seams were opened again along them where `reopens`. Whether
/// the energy is reached.
bool SeamRefinement::extend_astray(double model_energy, int number, bool reopens) {
  std::vector<double> cost = costs_astray(coarse_.surface, path_cost_, number, work_.aside());
  path_cost_.swap(cost);
  tree_.take(tree_.seams());
  if (reopens) tree_.reopen();
  const bool reaches = tree_.extend(model_energy);
  path_cost_.swap(cost);
  tree_.take(tree_.seams());
  return reaches;
}

Attempt SeamRefinement::sketch() {
  report_step();
  extend_astray(target_.energy, start_.number, true);
  tree_.exchange(std::max(target_.energy, tree_.energy()), effort_.exchanges);
  tree_.reopen();
  Attempt sketch;
  sketch.seams = {tree_.seams(), tree_.anchors()};
  sketch.energy = tree_.energy();
  sketch.cost = tree_.cost();
  sketch.excess = (sketch.energy - 2) / (target_.energy - 2);
  return sketch;
}

/// Of the maps, as descents have it: a relative decrease of the energy.
double SeamRefinement::tolerance() const {
  return std::min(kMostTolerance, effort_.tolerance * (target_.energy - 2));
}

LocalMaps SeamRefinement::map(const LocalMaps* before) const {
  return map_locally(coarse_.surface, coarse_.real_faces, tree_.seams(), tolerance(), before,
                     known_, here());
}

/// Parts the charts that lie on themselves. Whether there was one.
bool SeamRefinement::part_overlaps(const LocalMaps& maps) {
  EdgeMarks seams = tree_.seams();
  bool parted = false;
  Index charts = size_of(maps.uvs);
  for (std::size_t c = 0; c < maps.uvs.size(); ++c) {
    const Chart& chart = maps.cut.charts[c];
    std::vector<double> cost(chart.mesh.twin.size());
    const auto surface_halfedge = [&](Index h) { return 3 * chart.input_face[h / 3] + h % 3; };
    for (Index h = 0; h < size_of(cost); ++h) cost[h] = path_cost_[surface_halfedge(h)];
    const OverlapSplit split =
        split_overlaps(chart.mesh, maps.uvs[c], cost, kMostOverlap, work_.aside());
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
  if (parted) tree_.take(std::move(seams));
  return parted;
}

/// What was added on one side is added on the other.
void SeamRefinement::mirror_seams() {
  std::array<AnchoredSeams, 2> mirrored;
  std::array<double, 2> cost = {};
  for (const int i : {0, 1}) {
    mirrored[i] = mirrored_seams(coarse_.surface, *mirror_, {tree_.seams(), tree_.anchors()},
                                 2 * i - 1, path_cost_, coarse_.locked, here());
    for (Index h = 0; h < size_of(path_cost_); ++h) {
      if (mirrored[i].seams[h] && coarse_.surface.edge(h) == h) cost[i] += path_cost_[h];
    }
  }
  AnchoredSeams& more = mirrored[cost[1] > cost[0] ? 1 : 0];
  tree_.take(std::move(more.seams), std::move(more.anchors));
}

/// The excess of maps over 2 by that which is asked for, of the mean or of the percentile.
double SeamRefinement::missed_by(const LocalMaps& maps) const {
  double most = (maps.energy - 2) / (target_.energy - 2);
  if (target_.p99 > 0) most = std::max(most, (maps.p99 - 2) / (target_.p99 - 2));
  return most;
}

/// Maps along the seams that there are, and what they are worth, overlaps parted where they are
/// near what is asked for. Whether they are.
bool SeamRefinement::judge(bool is_last, LocalMaps& maps, Attempt& attempt) {
  report_step();
  attempt = Attempt();
  if (work_.out_of_time()) return false;  // maps that are cut short say nothing
  maps = map(maps.uvs.empty() ? nullptr : &maps);
  attempt.excess = missed_by(maps);
  if (attempt.excess > kWorthParting && !is_last) return false;
  if (part_overlaps(maps)) {
    if (mirror_ != nullptr) mirror_seams();
    maps = map(&maps);
  }
  const double free = missed_by(maps);
  if (free > 1 && !is_last) {  // contact can only add to it
    const double guessed = free * contact_.factor;
    attempt = {{tree_.seams(), tree_.anchors()}, tree_.cost(), maps.energy, guessed, {}, true};
    return true;
  }
  const LocalMaps* const before = contact_.maps.uvs.empty() ? nullptr : &contact_.maps;
  LocalMaps apart = with_contact(maps, coarse_.real_faces, tolerance(), before, known_, here());
  contact_.maps = apart;
  contact_.factor = std::max(1.0, missed_by(apart) / std::max(free, kLeastExcess));
  attempt = {{tree_.seams(), tree_.anchors()},
             tree_.cost(),
             apart.energy,
             missed_by(apart),
             std::move(apart.uvs)};
  return true;
}

/// The energy of the model at which maps would have nearly that asked for, if it errs as it does
/// for the seams that it is at, whose maps have `excess`.
double SeamRefinement::aim(double excess) const {
  return 2 + (tree_.energy() - 2) * step_for(excess);
}

/// Brings seams to where maps just have the excess asked for: ends of branches go, or paths are
/// added. All that is better than `best` on the way takes its place.
void SeamRefinement::settle(Attempt now, LocalMaps& maps, Attempt& best) {
  double step = 1;  // of the way
  for (int i = 0; i < effort_.settling && !work_.out_of_time(); ++i) {
    if (now.excess <= 1 && now.excess >= kFull) return;
    tree_.take(now.seams.seams, now.seams.anchors);
    const double goal = 2 + (tree_.energy() - 2) * (1 + step * (step_for(now.excess) - 1));
    if (now.excess <= 1) {
      tree_.shrink(goal);
      if (tree_.cost() >= now.cost) return;
    } else {
      tree_.extend(goal, true);
      if (tree_.cost() <= now.cost) return;
    }
    Attempt attempt;
    if (!judge(false, maps, attempt)) return;
    if (attempt.is_better_than(best)) best = attempt;
    if (kFull * attempt.promised() > now.promised()) {
      step /= 2;
    } else {
      now = std::move(attempt);
    }
  }
}

/// Teaches the model what maps cost.
void SeamRefinement::calibrate(const LocalMaps& maps) {
  const std::vector<double> excess = excess_around(coarse_.surface, coarse_.real_faces, maps);
  if (!excess.empty()) tree_.calibrate(excess);
}

Attempt SeamRefinement::judged() {
  LocalMaps maps;
  Attempt attempt;
  judge(true, maps, attempt);
  return attempt;
}

Attempt SeamRefinement::run(bool is_sketched) {
  return approach(target_.energy, is_sketched, false, 0);
}

Attempt SeamRefinement::run_calibrated(int calibrations) {
  LocalMaps maps;
  Attempt found;
  if (!judge(true, maps, found)) return found;
  calibrate(maps);
  Attempt attempt = approach(aim(found.excess), true, true, calibrations);
  return attempt.is_better_than(found) ? attempt : found;
}

/// From seams with which the model is to have an energy, until maps have the one asked for. The
/// model is calibrated so often on the way. `is_calibrated`: it was already, and what just misses
/// the target is worth settling.
Attempt SeamRefinement::approach(double model_energy, bool is_sketched, bool is_calibrated,
                                 int calibrations) {
  Attempt best, promising;
  LocalMaps maps;
  std::array<double, 2> last = {-1, -1};  // cost and energy of the model, judged before
  double excess = std::numeric_limits<double>::infinity();
  ModelAim aim_of_model;
  for (int round = 0; round < kMostRounds; ++round) {
    const bool is_first = round == 0 && !is_sketched;
    if (tree_.energy() < model_energy) tree_.shrink(model_energy);
    const bool is_correction = round > 0;
    const bool goes_on = is_first ? extend_astray(model_energy, start_.number, true)
                                  : tree_.extend(model_energy, is_correction);
    if (is_first) tree_.exchange(std::max(model_energy, tree_.energy()), effort_.exchanges);
    const int most = best.excess <= 1 ? effort_.rounds : kMostRounds;
    const bool ends = round + 1 >= most || work_.out_of_time();
    const bool is_last = !goes_on || ends;
    const std::array state = {tree_.cost(), tree_.energy()};
    if (state != last) {
      Attempt attempt;
      const bool is_near = judge(is_last, maps, attempt);
      excess = attempt.excess;
      if (is_near && attempt.promised() < promising.promised()) promising = attempt;
      if (is_near && attempt.is_better_than(best)) best = std::move(attempt);
    }
    last = {tree_.cost(), tree_.energy()};
    if (calibrations > 0 && !ends && excess <= kWorthParting) {
      --calibrations;
      calibrate(maps);
      aim_of_model = {};
      last = {-1, -1};
      model_energy = aim(excess);
      tree_.exchange(std::max(model_energy, tree_.energy()), effort_.exchanges);
      continue;
    }
    if (ends || (excess <= 1 ? excess >= kNear : is_last)) break;
    aim_of_model.note(model_energy - 2, std::max(tree_.energy() - 2, kLeastExcess), excess);
    if (aim_of_model.is_found()) break;
    model_energy = 2 + aim_of_model.next();
  }
  if (is_calibrated && promising.promised() < best.cost) settle(std::move(promising), maps, best);
  if (best.excess <= 1) settle(Attempt(best), maps, best);
  return best;
}

/// Takes branches that are near one another away and lets others grow, at costs that go astray,
/// and keeps what is better by its maps (ruin and recreate, Schrimpf et al. 2000).
void SeamRefinement::vary(int rounds, Attempt& best) {
  if (mirror_ != nullptr) return;
  LocalMaps maps;
  for (int round = 1; round <= rounds && best.excess <= 1 && !work_.out_of_time(); ++round) {
    tree_.take(best.seams.seams, best.seams.anchors);
    const double energy = aim(best.excess);
    if (!tree_.ruin(round, kRuined)) return;
    extend_astray(energy, round, false);
    if (tree_.energy() < energy) tree_.shrink(energy);
    if (tree_.cost() >= best.cost) continue;
    const double promised = best.promised();
    Attempt attempt;
    if (!judge(false, maps, attempt) || attempt.promised() > promised * (1 - kWorthMapping)) {
      continue;
    }
    if (attempt.is_better_than(best)) best = attempt;
    settle(std::move(attempt), maps, best);
  }
}

void SeamRefinement::improve(int rounds, Attempt& best) {
  if (best.seams.seams.empty()) return;
  tree_.take(best.seams.seams, best.seams.anchors);
  Attempt attempt = run_calibrated(1);
  if (attempt.is_better_than(best)) best = std::move(attempt);
  join_charts(best);
  vary(rounds, best);
}

/// What parts two charts of the seams that there are, and may be worth doing without, the most
/// promising first.
std::vector<SeamTree::Joint> SeamRefinement::joints_of(const Attempt& best, double energy) {
  const CutSurface cut = cut_into_charts(coarse_.surface, tree_.seams(), here());
  std::vector<SeamTree::Joint> joints = tree_.joints(cut.chart_of_face, energy);
  // What they take away is not worth a map, and there may be thousands.
  std::erase_if(
      joints, [&](const SeamTree::Joint& joint) { return joint.cost < best.cost * kWorthMapping; });
  return joints;
}

/// The best seams without a joint, with what has to be added to them.
SeamRefinement::Trial SeamRefinement::try_joint(const SeamTree::Joint& joint, const Attempt& best,
                                                const Contact& contact, double energy) {
  contact_ = contact;
  tree_.take(best.seams.seams, best.seams.anchors);
  tree_.join(joint);
  tree_.extend(energy, true);
  if (tree_.cost() > best.cost * (1 - kWorthMapping)) return {};
  LocalMaps maps;
  Attempt attempt;
  if (!judge(false, maps, attempt)) attempt = Attempt();
  return {std::move(attempt), contact_};
}

/// Each by itself, so that those that run side by side come to the same.
std::vector<SeamRefinement::Trial> SeamRefinement::try_joints(
    std::span<const SeamTree::Joint> joints, const Attempt& best, const Contact& contact,
    double energy) {
  std::vector<Trial> trials(joints.size());
  if (joints.size() == 1) {
    trials[0] = try_joint(joints[0], best, contact, energy);
    return trials;
  }
  const std::thread::id caller = std::this_thread::get_id();
  parallel_for(work_, std::ssize(joints), 1, [&](std::int64_t i, std::int64_t) {
    const bool is_caller = std::this_thread::get_id() == caller;
    SeamRefinement own(*this, is_caller ? work_ : work_.aside());
    trials[i] = own.try_joint(joints[i], best, contact, energy);
  });
  return trials;
}

/// Charts that were parted are joined elsewhere on trial, where that makes it better: trials that
/// gain nothing tell of those that follow.
void SeamRefinement::join_charts(Attempt& best) {
  Contact contact = contact_;
  std::vector<Index> tried;
  for (int idle = 0; idle < effort_.idle_joins && best.excess <= 1 && !work_.out_of_time();) {
    tree_.take(best.seams.seams, best.seams.anchors);
    const double energy = aim(best.excess);
    std::vector<SeamTree::Joint> joints = joints_of(best, energy);
    std::erase_if(joints, [&](const SeamTree::Joint& joint) {
      return std::find(tried.begin(), tried.end(), joint.middle()) != tried.end();
    });
    bool gained = false;
    for (std::size_t next = 0;
         next < joints.size() && !gained && idle < effort_.idle_joins && !work_.out_of_time();) {
      const int most = std::min(work_.threads(), effort_.idle_joins - idle);
      const std::size_t count = std::min<std::size_t>(most, joints.size() - next);
      for (Trial& trial :
           try_joints(std::span(joints).subspan(next, count), best, contact, energy)) {
        tried.push_back(joints[next++].middle());
        if (!trial.attempt) continue;
        gained = trial.attempt->is_better_than(best);
        if (gained) {
          best = *std::move(trial.attempt);
          contact = std::move(trial.contact);
          idle = 0;
          break;
        }
        ++idle;
      }
    }
    if (!gained) break;
  }
  contact_ = std::move(contact);  // not that of the last trial, which may have been on a copy
}

}  // namespace beltrami
