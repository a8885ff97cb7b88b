// Arcs of the seams that go where the same is joined, or opened, at less cost.
#include <algorithm>
#include <optional>
#include <queue>
#include <unordered_set>
#include <utility>
#include <vector>

#include "base/interrupt.h"
#include "base/types.h"
#include "cut/across.h"
#include "cut/bridges.h"
#include "cut/seam_paths.h"
#include "cut/seam_tree.h"
#include "mesh/surface.h"

namespace beltrami {
namespace {

/// More rounds gain nothing.
constexpr int kReconnections = 4;

}  // namespace

/// The seams between vertices that other than two meet at, or that were ends of paths where they
/// are to end there, each by its half-edges in order; the most costly first.
std::vector<std::vector<Index>> SeamTree::arcs(bool ends_at_anchors) const {
  const auto is_node = [&](Index v) {
    return degree_[v] != 2 || (ends_at_anchors && anchored_[v]) || surface_.on_boundary[v];
  };
  std::vector<std::pair<double, std::vector<Index>>> found;
  for (Index first = 0; first < size_of(seams_); ++first) {
    if (!seams_[first] || !is_node(surface_.origin(first))) continue;
    double cost = 0;
    std::vector<Index> arc;
    for (Index h = first; h != kNone;) {
      arc.push_back(h);
      cost += cost_[h];
      const Index v = surface_.target(h), back = surface_.twin[h];
      h = kNone;
      if (is_node(v)) break;
      surface_.for_each_outgoing(v, [&](Index out) {
        if (seams_[out] && out != back) h = out;
      });
    }
    // Found from both of its ends.
    if (surface_.twin[arc.back()] == kNone || arc.front() < surface_.twin[arc.back()]) {
      found.emplace_back(-cost, std::move(arc));
    }
  }
  std::sort(found.begin(), found.end());
  std::vector<std::vector<Index>> arcs;
  for (auto& [cost, arc] : found) arcs.push_back(std::move(arc));
  return arcs;
}

/// Calls `reach(vertex)` for the vertices that a seam or border joins to this one.
template <class Reach>
void SeamTree::for_each_joined(Index vertex, const Reach& reach) const {
  surface_.for_each_outgoing(vertex, [&](Index h) {
    if (seams_[h] || surface_.twin[h] == kNone) reach(surface_.target(h));
    const Index in = Surface::previous(h);
    if (surface_.twin[in] == kNone) reach(surface_.origin(in));
  });
}

/// Per vertex, whether seams and borders lead there.
std::vector<bool> SeamTree::joined_to(Index vertex) const {
  std::vector<bool> joined(degree_.size(), false);
  std::vector<Index> open = {vertex};
  joined[vertex] = true;
  while (!open.empty()) {
    const Index v = open.back();
    open.pop_back();
    for_each_joined(v, [&](Index w) {
      if (joined[w]) return;
      joined[w] = true;
      open.push_back(w);
    });
  }
  return joined;
}

/// The one of two vertices to which seams and borders join fewer others, if they do not join the
/// two: where only few lead from one of them, that is soon known.
std::optional<Index> SeamTree::on_smaller_part(Index one, Index other) const {
  struct Reach {
    std::queue<Index> open;
    std::unordered_set<Index> seen;
  };
  Reach from_one{std::queue<Index>({one}), {one}}, from_other{std::queue<Index>({other}), {other}};
  bool met = one == other;
  const auto grow = [&](Reach& own, const Reach& others) {
    const Index v = own.open.front();
    own.open.pop();
    for_each_joined(v, [&](Index w) {
      if (!own.seen.insert(w).second) return;
      own.open.push(w);
      met = met || others.seen.contains(w);
    });
  };
  while (!met) {
    if (from_one.open.empty()) return one;
    if (from_other.open.empty()) return other;
    grow(from_one, from_other);
    if (!met) grow(from_other, from_one);
  }
  return std::nullopt;
}

/// Whether an edge that is no seam joins none and no border: it would part nothing.
bool SeamTree::is_alone(Index halfedge) const {
  const auto is_free = [&](Index v) { return degree_[v] == 0 && !surface_.on_boundary[v]; };
  return is_free(surface_.origin(halfedge)) && is_free(surface_.target(halfedge));
}

/// Whether the two parts were joined at less cost, or, with paths `across` annuli, a handle opened.
/// Where the seams stay joined without it, as they do unless it `may_part` them, the arc goes
/// around a handle, or between charts and stays.
bool SeamTree::reconnect(const std::vector<Index>& arc, PathsAcross* across, bool may_part) {
  double cost = 0;
  for (const Index h : arc) {
    // What was moved before may end here now.
    const bool is_inner = h == arc.front() || degree_[surface_.origin(h)] == 2;
    if (!seams_[h] || surface_.twin[h] == kNone || !is_inner) return false;
    cost += cost_[h];
  }
  for (const Index h : arc) mark(h, false);
  const Index begin = surface_.origin(arc.front()), end = surface_.target(arc.back());
  std::vector<Index> path = arc;
  const std::optional<Index> from = may_part ? on_smaller_part(begin, end) : std::nullopt;
  if (from) {
    const std::vector<bool> others = joined_to(*from == begin ? end : begin);
    const SeamPaths paths(surface_, joined_to(*from), cost_, cost * (1 - kLeastGain), &others);
    if (paths.reached() != kNone) path = paths.from(paths.reached()).halfedges;
    if (path.size() == 1 && is_alone(path.front())) path = arc;
  } else if (across != nullptr) {
    std::vector<Index> other =
        across->between_ends(arc.front(), surface_.twin[arc.back()], cost * (1 - kLeastGain));
    if (!other.empty()) path.swap(other);
  }
  const bool is_new = path != arc;
  for (const Index h : path) mark(h, true);
  return is_new;
}

bool SeamTree::reconnect_all(bool around_handles) {
  bool gained = false;
  std::optional<PathsAcross> across;
  if (around_handles) {
    const auto is_on = [this](Index v) { return degree_[v] > 0 || surface_.on_boundary[v]; };
    across.emplace(surface_, seams_, is_on, cost_);
  }
  // There may be hundreds of arcs around charts. One that is on a cycle stays so while others are
  // joined elsewhere, but not while they go around handles elsewhere.
  const std::vector<bool> parts =
      around_handles ? std::vector<bool>(surface_.twin.size(), true) : bridges(surface_, seams_);
  for (const std::vector<Index>& arc : arcs(true)) {
    poll_interrupt();
    if (work_.out_of_time()) return false;
    gained = reconnect(arc, across ? &*across : nullptr, parts[arc.front()]) || gained;
  }
  return gained;
}

void SeamTree::reconnect() {
  for (int round = 0; round < kReconnections && reconnect_all(false); ++round) {
  }
  refresh();
}

void SeamTree::reopen() {
  for (int round = 0; round < kReconnections && reconnect_all(true); ++round) {
  }
  refresh();
}

}  // namespace beltrami
