#include "cut/seam_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "base/interrupt.h"
#include "base/vectors.h"
#include "cut/mirrored_seams.h"
#include "cut/path_beside.h"
#include "mesh/disk_mesh.h"

namespace beltrami {
namespace {

/// Ends of paths are looked for at so many places, and so many of these are looked at closely.
constexpr std::size_t kCandidates = 12, kTried = 5;
/// They are so far apart, in roots of the area.
constexpr double kApart = 0.04;
/// Parts of a branch that may go alone: its half, quarter and so on.
constexpr std::size_t kEnds = 6;
/// What is gained less in a round is not worth another.
constexpr double kLeastExchange = 1e-3;
/// Of what is numbered, those of consecutive rounds are apart and all get their turn.
constexpr double kGoldenTurn = 0.6180339887498949;
/// The image of a path is followed within so many rings, and that of the tip of a branch is another
/// tip within so much, in roots of the area.
constexpr int kBeside = 2;
constexpr double kPairApart = 0.03;

/// What is left of a path without its first vertices.
SeamPath last_part(const SeamPath& path, std::ptrdiff_t first, const SeamPaths& paths) {
  SeamPath part;
  part.vertices.assign(path.vertices.begin() + first, path.vertices.end());
  part.halfedges.assign(path.halfedges.begin() + first, path.halfedges.end());
  part.cost = first == 0 ? path.cost : paths.costs()[part.vertices.front()];
  return part;
}

/// Where the half at the end of what is left of a path begins.
std::ptrdiff_t halved(std::ptrdiff_t first, const SeamPath& path) {
  return first + (std::ssize(path.vertices) - first + 1) / 2;
}

}  // namespace

SeamTree::SeamTree(const Surface& surface, Index real_faces, const std::vector<double>& cost,
                   EdgeMarks seams, double budget, double least_cost, const Work& work,
                   std::vector<bool> anchors, const Mirror* mirror)
    : surface_(surface),
      cost_(cost),
      work_(work),
      mirror_(mirror),
      degree_(surface.positions.size()),
      model_(surface, real_faces, work),
      scale_(std::sqrt(surface_area(surface, work))),
      budget_(budget * scale_),
      least_cost_(least_cost * scale_) {
  anchors.resize(degree_.size(), false);
  take(std::move(seams), std::move(anchors));
}

SeamTree::SeamTree(const SeamTree& other, const std::vector<double>& cost, const Work& work)
    : surface_(other.surface_),
      cost_(cost),
      work_(work),
      mirror_(other.mirror_),
      seams_(other.seams_),
      degree_(other.degree_),
      anchored_(other.anchored_),
      model_(other.model_, work),
      scale_(other.scale_),
      budget_(other.budget_),
      least_cost_(other.least_cost_),
      cost_of_seams_(other.cost_of_seams_),
      length_of_seams_(other.length_of_seams_) {}

void SeamTree::take(EdgeMarks seams, std::vector<bool> anchors) {
  anchored_ = std::move(anchors);
  take(std::move(seams));
}

void SeamTree::take(EdgeMarks seams) {
  seams_ = std::move(seams);
  paths_.reset();
  std::fill(degree_.begin(), degree_.end(), 0);
  cost_of_seams_ = length_of_seams_ = 0;
  for (Index h = 0; h < size_of(seams_); ++h) {
    if (!seams_[h] || surface_.edge(h) != h) continue;
    ++degree_[surface_.origin(h)];
    ++degree_[surface_.target(h)];
    cost_of_seams_ += cost_[h];
    length_of_seams_ += length_of(h);
  }
  refresh();
}

void SeamTree::mark(Index halfedge, bool is) {
  if (!is) paths_.reset();
  seams_[halfedge] = is;
  if (surface_.twin[halfedge] != kNone) seams_[surface_.twin[halfedge]] = is;
  const Index change = is ? 1 : -1;
  degree_[surface_.origin(halfedge)] += change;
  degree_[surface_.target(halfedge)] += change;
  cost_of_seams_ += change * cost_[halfedge];
  length_of_seams_ += change * length_of(halfedge);
}

void SeamTree::refresh() {
  std::vector<bool> pinned(degree_.size());
  for (std::size_t v = 0; v < degree_.size(); ++v) pinned[v] = degree_[v] > 0;
  model_.pin(std::move(pinned));
}

/// Local extremes of the stress, and of what pinning them would gain, the best for their cost. In a
/// plate that is clamped at a distance d a point yields in proportion to d^2.
std::vector<Index> SeamTree::candidates(const SeamPaths& paths) const {
  const std::vector<double>& stress = model_.stress();
  const auto gain = [&](Index v) {
    const double ratio = stress[v] / (paths.costs()[v] + least_cost_);
    return ratio * ratio;
  };
  std::vector<std::pair<double, Index>> found;
  for (Index v = 0; v < surface_.vertex_count(); ++v) {
    if (surface_.on_boundary[v] || degree_[v] > 0 || surface_.outgoing[v] == kNone) continue;
    if (!std::isfinite(paths.costs()[v]) || !(gain(v) > 0)) continue;
    bool is_peak = true, is_extreme = true;
    surface_.for_each_outgoing(v, [&](Index h) {
      const Index other = surface_.target(h);
      is_peak = is_peak && gain(v) >= gain(other);
      is_extreme = is_extreme && std::abs(stress[v]) >= std::abs(stress[other]);
    });
    if (is_peak || is_extreme) {
      found.emplace_back(-gain(v) / (paths.costs()[v] + least_cost_), v);
    }
  }
  std::sort(found.begin(), found.end());
  std::vector<Index> apart;
  for (const auto& [score, v] : found) {
    if (apart.size() == kCandidates) break;
    const bool is_near = std::any_of(apart.begin(), apart.end(), [v = v, this](Index other) {
      return (surface_.positions[v] - surface_.positions[other]).norm() < kApart * scale_;
    });
    if (!is_near) apart.push_back(v);
  }
  return apart;
}

double SeamTree::length_of(Index halfedge) const {
  const std::vector<Vec3>& p = surface_.positions;
  return (p[surface_.target(halfedge)] - p[surface_.origin(halfedge)]).norm();
}

/// Whether the seams stay within their budget with a path.
bool SeamTree::affords(const SeamPath& path) const {
  if (budget_ == 0) return true;
  double length = length_of_seams_;
  for (const Index h : path.halfedges) length += length_of(h);
  return length <= budget_;
}

const SeamPaths& SeamTree::paths() {
  if (paths_) return *paths_;
  std::vector<bool> root(degree_.size());
  for (std::size_t v = 0; v < root.size(); ++v) {
    root[v] = degree_[v] > 0 || surface_.on_boundary[v];
  }
  return paths_.emplace(surface_, root, cost_, std::numeric_limits<double>::infinity());
}

/// The shortest part of a path, from its tip, with which the energy of the model is at most
/// `target`. Precondition: it is with all of it.
SeamPath SeamTree::least_part(const SeamPath& whole, const ModelChange& change,
                              double target) const {
  std::ptrdiff_t first = 0, beyond = std::ssize(whole.vertices);
  const std::ptrdiff_t count = beyond;
  while (beyond - first > 1) {
    const std::ptrdiff_t middle = (first + beyond) / 2;
    (change.energy_of(middle, count - middle) <= target ? first : beyond) = middle;
  }
  return last_part(whole, first, *paths_);
}

bool SeamTree::extend_once(double target, bool exactly) {
  const SeamPaths& paths = this->paths();
  std::vector<Index> ends = candidates(paths);
  if (ends.size() > kTried) ends.resize(kTried);
  double best = 0, reached = model_.energy();
  SeamPath chosen, cheapest;  // of those that reach the target
  for (const Index v : ends) {
    const SeamPath whole = paths.from(v);
    const ModelChange change = model_.with(whole.vertices);
    const std::ptrdiff_t count = std::ssize(whole.vertices);
    if (exactly && change.energy() <= target) {
      SeamPath path = least_part(whole, change, target);
      if (affords(path) && (cheapest.halfedges.empty() || path.cost < cheapest.cost)) {
        cheapest = std::move(path);
      }
    }
    for (std::ptrdiff_t first = 0; first < count; first = halved(first, whole)) {
      const SeamPath path = last_part(whole, first, paths);
      if (!affords(path)) continue;
      const double energy = change.energy_of(first, count - first);
      const double gain = model_.energy() - energy;
      if (!(gain > kLeastGain)) break;
      const double worth = gain / (path.cost + least_cost_);
      // A half that is worth less than the whole has halves that are.
      if (worth <= best) break;
      best = worth;
      reached = energy;
      chosen = path;
    }
  }
  if (chosen.halfedges.empty()) return false;
  const bool is_last = reached <= target && !cheapest.halfedges.empty();
  if (is_last && cheapest.cost < chosen.cost) chosen = std::move(cheapest);
  add_path(chosen);
  if (mirror_ != nullptr) add_mirrored(chosen);
  refresh();
  return true;
}

void SeamTree::add_path(const SeamPath& path) {
  for (const Index h : path.halfedges) mark(h, true);
  paths_->add_roots(path.vertices);
  anchored_[path.vertices.front()] = true;
}

/// The image of a path, from that of its tip to what is a seam there already; straight to the seams
/// where there is no way beside it.
void SeamTree::add_mirrored(const SeamPath& path) {
  std::vector<Index> beside;
  for (const Index v : path.vertices) beside.push_back(mirrored(*mirror_, v));
  const Index last = path.halfedges.back(), root = surface_.target(last);
  const bool is_turned = root == path.vertices.back();
  beside.push_back(mirrored(*mirror_, is_turned ? surface_.origin(last) : root));
  const Index tip = beside.front();
  const auto is_on = [&](Index v) { return degree_[v] > 0 || surface_.on_boundary[v]; };
  if (is_on(tip) || !std::isfinite(paths_->costs()[tip])) return;
  const PathRules rules{is_on, [](Index) { return true; }};
  SeamPath image;
  image.halfedges = path_beside(surface_, beside, kBeside, cost_, rules);
  for (const Index h : image.halfedges) image.vertices.push_back(surface_.origin(h));
  if (image.halfedges.empty()) image = paths_->from(tip);
  const bool is_alone = image.halfedges.size() == 1 && this->is_alone(image.halfedges.front());
  if (!image.halfedges.empty() && !is_alone) add_path(image);
}

bool SeamTree::extend(double target, bool exactly) {
  while (model_.energy() > target) {
    poll_interrupt();
    if (work_.out_of_time() || !extend_once(target, exactly)) return false;
  }
  return true;
}

SeamTree::Branch SeamTree::branch_from(Index tip) const {
  Branch branch;
  Index v = tip, last = kNone;
  for (;;) {
    branch.vertices.push_back(v);
    Index along = kNone;
    surface_.for_each_outgoing(v, [&](Index h) {
      if (seams_[h] && surface_.edge(h) != last) along = h;
    });
    if (along == kNone) return {};
    last = surface_.edge(along);
    branch.halfedges.push_back(along);
    branch.cost += cost_[along];
    v = surface_.target(along);
    if (surface_.on_boundary[v] || degree_[v] > 2) return branch;
    if (degree_[v] == 1) return {};  // a seam alone: something has to open the surface
  }
}

void SeamTree::judge(Branch& branch, double energy_without) const {
  branch.energy = energy_without;
  branch.worth = (branch.energy - model_.energy()) / (branch.cost + least_cost_);
}

/// A branch and parts of it from its tip, judged.
std::vector<SeamTree::Branch> SeamTree::ends_of(Branch branch) const {
  std::vector<Branch> ends;
  const ModelChange change = model_.without(branch.vertices);
  for (std::ptrdiff_t count = std::ssize(branch.vertices) / 2; count > 0; count /= 2) {
    Branch& end = ends.emplace_back();
    end.vertices.assign(branch.vertices.begin(), branch.vertices.begin() + count);
    end.halfedges.assign(branch.halfedges.begin(), branch.halfedges.begin() + count);
    for (const Index h : end.halfedges) end.cost += cost_[h];
    judge(end, change.energy_of(0, count));
    if (ends.size() == kEnds) break;
  }
  judge(branch, change.energy());
  ends.push_back(std::move(branch));
  return ends;
}

/// What a branch is worth hardly falls where others go: one that is still worth less than all the
/// others were is the least.
void SeamTree::shrink(double target) {
  const auto is_worth_more = [](const Branch& a, const Branch& b) {
    return std::tuple(a.worth, a.vertices.front(), a.vertices.size()) >
           std::tuple(b.worth, b.vertices.front(), b.vertices.size());
  };
  std::vector<Branch> heap;
  const auto push = [&](Branch branch) {
    heap.push_back(std::move(branch));
    std::push_heap(heap.begin(), heap.end(), is_worth_more);
  };
  const auto push_ends = [&](Index tip) {
    if (degree_[tip] != 1 || surface_.on_boundary[tip]) return;
    Branch branch = branch_from(tip);
    if (branch.halfedges.empty()) return;
    for (Branch& end : ends_of(std::move(branch))) push(std::move(end));
  };
  for (Index v = 0; v < surface_.vertex_count(); ++v) push_ends(v);
  while (!heap.empty() && !work_.out_of_time()) {
    poll_interrupt();
    std::pop_heap(heap.begin(), heap.end(), is_worth_more);
    Branch branch = std::move(heap.back());
    heap.pop_back();
    if (!is_branch(branch)) continue;
    judge(branch, model_.without(branch.vertices).energy());
    if (branch.energy > target) continue;
    if (!heap.empty() && branch.worth > heap.front().worth) {
      push(std::move(branch));
      continue;
    }
    const Branch partner = partner_of(branch);
    if (!partner.halfedges.empty()) {
      std::vector<Index> both = branch.vertices;
      both.insert(both.end(), partner.vertices.begin(), partner.vertices.end());
      if (model_.without(both).energy() > target) continue;
    }
    const bool has_partner = !partner.halfedges.empty();
    remove(branch);
    const bool both_go = has_partner && is_branch(partner);
    if (both_go) remove(partner);
    refresh();
    if (model_.energy() > target + kLeastGain) {  // which rounding had hidden
      put_back(branch);
      if (both_go) put_back(partner);
      refresh();
      continue;
    }
    push_ends(surface_.target(branch.halfedges.back()));
    if (has_partner) push_ends(surface_.target(partner.halfedges.back()));
  }
}

void SeamTree::remove(const Branch& branch) {
  for (const Index h : branch.halfedges) mark(h, false);
}

void SeamTree::put_back(const Branch& branch) {
  for (const Index h : branch.halfedges) mark(h, true);
  paths_.reset();
}

/// As much of the branch that it is mirrored to; nothing where that is not to be told.
SeamTree::Branch SeamTree::partner_of(const Branch& branch) const {
  if (mirror_ == nullptr) return {};
  const Index image = mirrored(*mirror_, branch.vertices.front());
  Index tip = kNone;
  double least = kPairApart * scale_;
  for (Index v = 0; v < surface_.vertex_count(); ++v) {
    if (degree_[v] != 1 || surface_.on_boundary[v]) continue;
    const double apart = (surface_.positions[v] - surface_.positions[image]).norm();
    if (apart < least) {
      least = apart;
      tip = v;
    }
  }
  if (tip == kNone || tip == branch.vertices.front()) return {};
  Branch whole = branch_from(tip), part;
  for (std::size_t i = 0; i < whole.halfedges.size(); ++i) {
    const double more = part.cost + cost_[whole.halfedges[i]];
    if (std::abs(more - branch.cost) > std::abs(part.cost - branch.cost)) break;
    part.cost = more;
    part.halfedges.push_back(whole.halfedges[i]);
    part.vertices.push_back(whole.vertices[i]);
  }
  const bool is_apart = std::none_of(part.vertices.begin(), part.vertices.end(), [&](Index v) {
    return std::find(branch.vertices.begin(), branch.vertices.end(), v) != branch.vertices.end();
  });
  return is_apart ? part : Branch{};
}

/// Whether its edges are still seams that hang on their last vertex alone, and can go: an edge that
/// stays alone would part nothing.
bool SeamTree::is_branch(const Branch& branch) const {
  for (std::size_t i = 0; i < branch.vertices.size(); ++i) {
    if (degree_[branch.vertices[i]] != (i == 0 ? 1 : 2)) return false;
  }
  const Index gone = branch.halfedges.back(), last = surface_.target(gone);
  if (surface_.on_boundary[last] || degree_[last] > 2) return true;
  bool stays = false;
  surface_.for_each_outgoing(last, [&](Index h) {
    if (!seams_[h] || h == surface_.twin[gone]) return;
    stays = surface_.on_boundary[surface_.target(h)] || degree_[surface_.target(h)] > 1;
  });
  return stays;
}

/// Puts a branch to where it is worth more at the price of the energy, or nowhere. Whether it went.
bool SeamTree::move_branch(Index tip, double price) {
  Branch old = branch_from(tip);
  if (old.halfedges.empty() || !is_branch(old)) return false;
  const double before = model_.energy();
  const std::vector<bool> anchors = anchored_;
  for (const Index h : old.halfedges) mark(h, false);
  refresh();
  const SeamPaths& paths = this->paths();
  const double least = least_cost_;
  // What it costs more than its energy is worth; without it that is 0.
  double best = old.cost + least - price * (model_.energy() - before);
  best -= kLeastGain + kLeastExchange * (old.cost + least);
  SeamPath chosen;
  bool moved = best > 0;
  if (moved) best = 0;
  std::vector<Index> ends = candidates(paths);
  for (const Index v : ends) {
    const SeamPath whole = paths.from(v);
    const ModelChange change = model_.with(whole.vertices);
    const std::ptrdiff_t count = std::ssize(whole.vertices);
    for (std::ptrdiff_t first = 0; first < count; first = halved(first, whole)) {
      const SeamPath path = last_part(whole, first, paths);
      if (!affords(path)) continue;
      const double gain = model_.energy() - change.energy_of(first, count - first);
      const double value = path.cost + least - price * gain;
      if (value < best) {
        best = value;
        chosen = path;
        moved = true;
      }
      if (price * gain < least) break;
    }
  }
  if (!moved) {
    for (const Index h : old.halfedges) mark(h, true);
    paths_.reset();
    anchored_ = anchors;
    refresh();
    return false;
  }
  for (const Index h : chosen.halfedges) mark(h, true);
  paths_.reset();
  if (!chosen.vertices.empty()) anchored_[chosen.vertices.front()] = true;
  refresh();
  return true;
}

void SeamTree::exchange(double target, int rounds) {
  for (int round = 0; round < rounds; ++round) {
    const EdgeMarks before = seams_;
    const std::vector<bool> anchors = anchored_;
    const double cost = cost_of_seams_;
    const double price = kSeamPrice * cost / (target - 2);
    bool moved = false;
    for (Index v = 0; v < surface_.vertex_count(); ++v) {
      if (degree_[v] != 1 || surface_.on_boundary[v]) continue;
      if (work_.out_of_time()) break;
      moved = move_branch(v, price) || moved;
    }
    if (!moved) return;
    reconnect();
    if (model_.energy() > target) extend(target);
    shrink(target);
    reconnect();
    if (model_.energy() > target) extend(target);
    if (model_.energy() <= target && cost_of_seams_ < cost * (1 - kLeastExchange)) continue;
    take(before, anchors);
    return;
  }
}

bool SeamTree::ruin(int number, int count) {
  std::vector<Index> tips;
  for (Index v = 0; v < surface_.vertex_count(); ++v) {
    if (degree_[v] == 1 && !surface_.on_boundary[v]) tips.push_back(v);
  }
  if (tips.empty()) return false;
  const double turn = number * kGoldenTurn;
  const auto first = static_cast<std::size_t>((turn - std::floor(turn)) * std::ssize(tips));
  const Vec3 center = surface_.positions[tips[first]];
  std::vector<std::pair<double, Index>> near;
  for (const Index v : tips) near.emplace_back((surface_.positions[v] - center).norm(), v);
  std::sort(near.begin(), near.end());
  bool any = false;
  for (const auto& [distance, tip] : near) {
    if (count == 0) break;
    if (degree_[tip] != 1) continue;
    const Branch branch = branch_from(tip);
    if (branch.halfedges.empty() || !is_branch(branch)) continue;
    remove(branch);
    any = true;
    --count;
  }
  refresh();
  return any;
}

std::vector<SeamTree::Joint> SeamTree::joints(const std::vector<Index>& chart,
                                              double target) const {
  const double price = kSeamPrice * cost_of_seams_ / (target - 2);
  std::vector<std::tuple<double, Index, Joint>> found;
  for (const std::vector<Index>& arc : arcs(false)) {
    const Index twin = surface_.twin[arc.front()];
    if (twin == kNone || chart[arc.front() / 3] == chart[twin / 3]) continue;
    poll_interrupt();
    std::vector<Index> inner;
    for (std::size_t i = 0; i + 1 < arc.size(); ++i) inner.push_back(surface_.target(arc[i]));
    const ModelChange change = model_.without(inner);
    const std::ptrdiff_t count = std::ssize(arc), half = count / 2;
    for (const auto& [first, last] : {std::pair(std::ptrdiff_t{0}, count),
                                      std::pair(std::ptrdiff_t{0}, half), std::pair(half, count)}) {
      if (first == last) continue;
      Joint joint;
      joint.halfedges.assign(arc.begin() + first, arc.begin() + last);
      for (const Index h : joint.halfedges) joint.cost += cost_[h];
      joint.energy = change.energy_of(first, last - first - 1);
      const double value = joint.cost - price * (joint.energy - model_.energy());
      if (value > 0) found.emplace_back(-value, arc[first], std::move(joint));
    }
  }
  std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) {
    return std::pair(std::get<0>(a), std::get<1>(a)) < std::pair(std::get<0>(b), std::get<1>(b));
  });
  std::vector<Joint> joints;
  for (auto& [value, first, joint] : found) joints.push_back(std::move(joint));
  return joints;
}

void SeamTree::join(const Joint& joint) {
  for (const Index h : joint.halfedges) mark(h, false);
  refresh();
}

}  // namespace beltrami
