// Paths in a patch that can be shrunk to a point and touches seams at the ends of the path alone
// can be moved into each other across the patch: its neighbourhood is a disk, of which other seams
// at these ends cut off nothing between them. So the shortest one parts what any of them parts.
//
// A tree that joins three ends in such a patch, and touches other seams there alone, is as good as
// any other one that leaves for them in the same order: what other seams leave of the disk is a
// disk again, with the ends on its border but for loose ones, and a map of it onto itself that
// keeps the border carries one tree to the other. The least tree has its node where the shortest
// paths to the ends have the least sum. They meet nowhere else: at a vertex that two of them meet
// at, these two would be shorter by the way there, and the third one longer by no more than that.
#include "cut/straighten.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <tuple>
#include <utility>

#include "base/interrupt.h"
#include "base/parallel.h"
#include "base/types.h"
#include "cut/seam_patch.h"
#include "cut/turning.h"

namespace beltrami {
namespace {

constexpr std::int64_t kGrain = 65536;

/// Edges of a window, which overlaps the one before by half. Windows of 48 edges take twice the
/// time, as more sweeps move something, and come out up to 0.2% dearer; 400 do no better than 200.
constexpr Index kWindow = 256;

/// Rings of vertices around a path that it may move through at once. Cuts carried to a surface of
/// thirty times the faces cost the same with 6 as with 16, and up to 0.2% more with 4; of a hundred
/// times, 0.04% less with 10, which take 1.7 times the time.
constexpr Index kRings = 6;

/// Bounds the time.
constexpr Index kMostSweeps = 12;

/// A sweep that gains less of the whole is the last. With a third of it most cuts come out the
/// same, and one of nine 0.3% cheaper.
constexpr double kWorthSweep = 3e-4;

/// Paths are replaced by those cheaper by more than what sums round: so no two take turns.
constexpr double kGain = 1e-9;

/// Edges of a window at a node that is moved. On 10,000 faces 24 and 48 come out alike, and 16 up
/// to 0.4% dearer; cuts carried to seventy times the faces are 0.3% cheaper with 48 than with 24,
/// in 1.5 times the time.
constexpr Index kNodeWindow = 32;

/// Moves of a node in a sweep, each as far as its patch is wide; what is left for the next sweep is
/// done between straighter arcs.
constexpr Index kMostMoves = 4;

/// Of so many ways to split a node that gain the best is taken: all of them where four seams meet,
/// whose two pairings no later move turns into each other.
constexpr Index kMostSplits = 4;

/// An edge of an arc, run along.
struct Step {
  Index halfedge;
  Index moved_in;  ///< the sweep that moved the arc here; 0: none
};
using Path = std::vector<Step>;

struct Arc {
  Path path;
  bool is_free_loop = false;  ///< without a node: it may begin anywhere
};

/// An arc as a node sees it.
struct ArcEnd {
  Index arc;
  bool is_back;  ///< the arc ends here
};

/// A vertex that three seams or more meet at, off the border and not anchored.
struct Node {
  Index vertex;
  std::vector<ArcEnd> ends;
};

/// A path away from a node.
struct Branch {
  ArcEnd arc{kNone, false};  ///< that it is the first part of; kNone: of none so far
  Index end = kNone;         ///< the vertex that it leads to
  Path path;
};

/// Three branches, in counter-clockwise order.
struct Star {
  Index centre;
  std::array<Branch, 3> branches;
};

/// A star, and a cheaper one with the same ends.
struct Move {
  Star before, after;
  double gain = 0;  ///< 0: there is none
};

class Straightening {
 public:
  Straightening(const Surface& surface, const EdgeMarks& seams, const std::vector<double>& cost,
                const std::vector<bool>& anchored, const EdgeMarks& locked, double straightness)
      : surface_(surface),
        cost_(cost),
        anchored_(anchored),
        locked_(locked),
        seams_(seams),
        degree_(surface.positions.size(), 0),
        patch_(surface),
        turning_(surface, cost, straightness) {}

  EdgeMarks run(const Work& work) {
    find_arcs(work);
    find_nodes();
    double total = 0;
    for (const Arc& arc : arcs_) total += cost_of(arc.path);
    for (sweep_ = 1; sweep_ <= kMostSweeps; ++sweep_) {
      gained_ = 0;
      for (Arc& arc : arcs_) straighten_arc(arc);
      // Those that nodes are parted in come after them.
      for (std::size_t i = 0; i < nodes_.size(); ++i) move_node(i);
      if (gained_ <= kWorthSweep * total) break;
    }
    return std::move(seams_);
  }

 private:
  void find_arcs(const Work& work);
  void find_nodes();
  Arc trace(Index first, EdgeMarks& taken);
  void straighten_arc(Arc& arc);
  void straighten_window(std::span<const Step> window, Index after, Path& result);
  bool fill_patch(std::span<const Step> window);
  bool find_cheaper(std::span<const Step> window, Index before, Index after);
  void take(std::span<const Step> window, Path& result);

  void move_node(std::size_t node);
  std::vector<Branch> branches_of(const Node& node) const;
  Move find_move(Star star);
  Move find_split(Index centre, const std::vector<Branch>& branches);
  bool fill_patch(const Star& star);
  bool ends_share_other_seam(const Star& star) const;
  Move find_least(const Star& star);
  Path path_to(const Branch& branch, const PathTree& tree, Index from) const;
  bool is_tree(const Star& star) const;
  void take(const Move& move);
  void take_split(std::size_t node, const Move& move);
  void replace_begin(const Branch& before, const Path& path);

  bool is_seam(Index h) const { return seams_[h] && surface_.twin[h] != kNone; }
  bool is_node(Index v) const {
    return degree_[v] != 2 || surface_.on_boundary[v] || (!anchored_.empty() && anchored_[v]);
  }
  void find_paths(const PathQuery& query, PathTree& tree) {
    patch_.find_paths(query, cost_, locked_, seams_, tree);
  }
  bool is_due(std::span<const Step> path) const {
    return std::any_of(path.begin(), path.end(),
                       [&](const Step& step) { return step.moved_in >= sweep_ - 1; });
  }
  /// When a path that replaces `before` came to take the edge.
  Index moved_in(Index h, std::span<const Step> before) const {
    const auto kept = std::find_if(before.begin(), before.end(),
                                   [&](const Step& step) { return step.halfedge == h; });
    return kept == before.end() ? sweep_ : kept->moved_in;
  }
  double cost_of(std::span<const Step> path) const {
    double sum = 0;
    for (const Step& step : path) sum += cost_[step.halfedge];
    return sum;
  }
  /// With its turns, also those from and to the half-edges around it, kNone: none.
  double turning_cost_of(std::span<const Step> path, Index before, Index after) const {
    if (turning_.weight() == 0) return cost_of(path);
    std::vector<Index> halfedges;
    for (const Step& step : path) halfedges.push_back(step.halfedge);
    return turning_.cost({halfedges, before, after});
  }
  bool is_seam_between(Index a, Index b) const {
    bool found = false;
    surface_.for_each_outgoing(
        a, [&](Index h) { found = found || (surface_.target(h) == b && is_seam(h)); });
    return found;
  }
  bool is_loose_end(Index v) const { return degree_[v] == 1 && !surface_.on_boundary[v]; }
  void change_ends(Index h, Index by) {
    degree_[surface_.origin(h)] += by;
    degree_[surface_.target(h)] += by;
  }
  void set_seam(Index h, bool is) {
    seams_[h] = seams_[surface_.twin[h]] = is;
    change_ends(h, is ? 1 : -1);
  }

  const Surface& surface_;
  const std::vector<double>& cost_;
  const std::vector<bool>& anchored_;  ///< or none
  const EdgeMarks& locked_;            ///< or none
  EdgeMarks seams_;
  std::vector<Index> degree_;  ///< per vertex its seams, but for those on the border
  std::vector<Arc> arcs_;
  std::vector<Node> nodes_;
  Index sweep_ = 0;
  double gained_ = 0;  ///< in this sweep

  // Of a window.
  SeamPatch patch_;
  Turning turning_;
  std::array<PathTree, 3> trees_;
  std::vector<Index> shortest_;  ///< half-edges
  PollSometimes poll_;
};

// --- Arcs ---------------------------------------------------------------------------------------

void Straightening::find_arcs(const Work& work) {
  const std::vector<Index> edges =
      parallel_filter(work, size_of(surface_.twin), kGrain,
                      [&](Index h) { return is_seam(h) && surface_.edge(h) == h; });
  for (const Index h : edges) change_ends(h, 1);
  EdgeMarks taken(surface_.twin.size(), false);
  for (const Index e : edges) {
    for (const Index h : {e, surface_.twin[e]}) {
      if (is_node(surface_.origin(h)) && !taken[h]) arcs_.push_back(trace(h, taken));
    }
  }
  for (const Index h : edges) {
    if (taken[h]) continue;
    arcs_.push_back(trace(h, taken));
    arcs_.back().is_free_loop = true;
  }
}

/// Those that may move.
void Straightening::find_nodes() {
  std::vector<std::tuple<Index, Index, bool>> ends;
  const auto add = [&](Index v, Index arc, bool is_back) {
    const bool stays = surface_.on_boundary[v] || (!anchored_.empty() && anchored_[v]);
    if (degree_[v] > 2 && !stays) ends.emplace_back(v, arc, is_back);
  };
  for (Index a = 0; a < size_of(arcs_); ++a) {
    add(surface_.origin(arcs_[a].path.front().halfedge), a, false);
    add(surface_.target(arcs_[a].path.back().halfedge), a, true);
  }
  std::sort(ends.begin(), ends.end());
  for (const auto& [v, arc, is_back] : ends) {
    if (nodes_.empty() || nodes_.back().vertex != v) nodes_.push_back({v, {}});
    nodes_.back().ends.push_back({arc, is_back});
  }
}

/// Along seams to the next node, or all around.
Arc Straightening::trace(Index first, EdgeMarks& taken) {
  Arc arc;
  Index h = first;
  while (h != kNone) {
    poll_();
    arc.path.push_back({h, 0});
    mark_edge(surface_, h, taken);
    if (is_node(surface_.target(h))) break;
    Index next = kNone;
    surface_.for_each_outgoing(surface_.target(h), [&](Index out) {
      if (is_seam(out) && !taken[out]) next = out;
    });
    h = next;
  }
  return arc;
}

/// Window after window; each begins with half of what became of the one before.
void Straightening::straighten_arc(Arc& arc) {
  if (arc.is_free_loop) {
    std::rotate(arc.path.begin(), arc.path.begin() + size_of(arc.path) / 3, arc.path.end());
  }
  const Path before = std::exchange(arc.path, {});
  Path window;
  // No window goes all around a loop.
  const bool is_loop =
      surface_.origin(before.front().halfedge) == surface_.target(before.back().halfedge);
  const Index full = is_loop ? std::clamp(size_of(before) / 2, 2, kWindow) : kWindow;
  // Borders of windows lie elsewhere in the next sweep.
  Index length = sweep_ % 2 == 0 ? full * 3 / 4 : full;
  for (Index next = 0; next < size_of(before); length = full) {
    const Index kept = std::min(size_of(arc.path), full / 2);
    window.assign(arc.path.end() - kept, arc.path.end());
    arc.path.resize(arc.path.size() - kept);
    const Index end = std::min(next + length - kept, size_of(before));
    window.insert(window.end(), before.begin() + next, before.begin() + end);
    next = end;
    straighten_window(window, next < size_of(before) ? before[next].halfedge : kNone, arc.path);
  }
}

// --- Windows ------------------------------------------------------------------------------------

/// Appends what becomes of the window. Where there is no disk around it, of its halves. `after`:
/// the half-edge that comes then, or kNone.
void Straightening::straighten_window(std::span<const Step> window, Index after, Path& result) {
  const bool has_moved = is_due(window);
  const bool is_narrow = has_moved && !fill_patch(window);
  if (is_narrow && window.size() > 1) {
    const std::size_t half = window.size() / 2;
    straighten_window(window.first(half), window[half].halfedge, result);
    return straighten_window(window.subspan(half), after, result);
  }
  const Index before = result.empty() ? kNone : result.back().halfedge;
  if (has_moved && !is_narrow && find_cheaper(window, before, after)) return take(window, result);
  result.insert(result.end(), window.begin(), window.end());
}

/// Whether there is a disk that the path may move through.
bool Straightening::fill_patch(std::span<const Step> window) {
  patch_.clear();
  const Index start = surface_.origin(window.front().halfedge);
  const Index end = surface_.target(window.back().halfedge);
  if (start == end) return false;
  // It must not move across a seam that it does not have, but that is in the patch.
  if (window.size() > 1 && is_seam_between(start, end)) return false;
  patch_.add(start);
  for (const Step& step : window) patch_.add(surface_.target(step.halfedge));
  patch_.grow(kRings, degree_);
  return patch_.is_disk();
}

/// Whether there is a cheaper path between the ends: left in shortest_.
bool Straightening::find_cheaper(std::span<const Step> window, Index last, Index after) {
  const double before = turning_cost_of(window, last, after);
  const Index start = surface_.origin(window.front().halfedge);
  Index v = surface_.target(window.back().halfedge);
  PathQuery query{start, before * (1 - kGain), v};
  // The sides of an edge on its own would be one again.
  if (is_loose_end(start) && is_loose_end(v)) query.not_between = v;
  if (turning_.weight() > 0) {
    shortest_ = turning_.cheapest({{}, last, after}, patch_, query, locked_, seams_);
    if (shortest_.empty()) return false;
    gained_ += before - turning_.cost({shortest_, last, after});
    return true;
  }
  PathTree& tree = trees_[0];
  find_paths(query, tree);
  if (tree.reached_by[patch_.number(v)] == kNone) return false;
  gained_ += before - tree.distance[patch_.number(v)];
  shortest_.clear();
  for (; v != start; v = surface_.origin(shortest_.back())) {
    shortest_.push_back(tree.reached_by[patch_.number(v)]);
  }
  std::reverse(shortest_.begin(), shortest_.end());
  return true;
}

void Straightening::take(std::span<const Step> window, Path& result) {
  const std::size_t first = result.size();
  for (const Index h : shortest_) result.push_back({h, moved_in(h, window)});
  for (const Step& step : window) set_seam(step.halfedge, false);
  for (std::size_t i = first; i < result.size(); ++i) set_seam(result[i].halfedge, true);
}

// --- Nodes --------------------------------------------------------------------------------------

/// Moves it while that pays. Where more than three seams meet, one that two neighbours of them meet
/// at is split off first.
void Straightening::move_node(std::size_t node) {
  for (Index moves = 0; moves < kMostMoves;) {
    std::vector<Branch> branches = branches_of(nodes_[node]);
    if (std::none_of(branches.begin(), branches.end(),
                     [&](const Branch& branch) { return is_due(branch.path); })) {
      return;
    }
    const Index centre = nodes_[node].vertex;
    const bool is_split = branches.size() > 3;
    const Move move =
        is_split
            ? find_split(centre, branches)
            : find_move({centre,
                         {std::move(branches[0]), std::move(branches[1]), std::move(branches[2])}});
    if (move.gain == 0) return;
    if (is_split) {
      take_split(node, move);
    } else {
      take(move);
      nodes_[node].vertex = move.after.centre;
      ++moves;
    }
  }
}

/// The node keeps an arc to a new one, which has the two others.
void Straightening::take_split(std::size_t node, const Move& move) {
  take(move);
  const std::array<Branch, 3>& parts = move.after.branches;
  const ArcEnd between{size_of(arcs_), false};
  arcs_.push_back({parts[0].path});
  std::vector<ArcEnd>& ends = nodes_[node].ends;
  std::erase_if(ends, [&](const ArcEnd& end) {
    return std::any_of(parts.begin(), parts.end(), [&](const Branch& part) {
      return part.arc.arc == end.arc && part.arc.is_back == end.is_back;
    });
  });
  ends.push_back({between.arc, true});
  nodes_.push_back({move.after.centre, {between, parts[1].arc, parts[2].arc}});
}

/// The first windows of its arcs, in counter-clockwise order; their ends are not the same.
std::vector<Branch> Straightening::branches_of(const Node& node) const {
  std::vector<Branch> branches;
  surface_.for_each_outgoing(node.vertex, [&](Index first) {
    for (const ArcEnd& end : node.ends) {
      const Path& path = arcs_[end.arc].path;
      const Index size = size_of(path);
      const auto outward = [&](Index i) {
        if (!end.is_back) return path[i];
        return Step{surface_.twin[path[size - 1 - i].halfedge], path[size - 1 - i].moved_in};
      };
      if (outward(0).halfedge != first) continue;
      const bool is_loop = surface_.target(outward(size - 1).halfedge) == node.vertex;
      const Index length = std::min(kNodeWindow, is_loop ? (size - 1) / 2 : size);
      Branch& branch = branches.emplace_back();
      branch.arc = end;
      for (Index i = 0; i < length; ++i) branch.path.push_back(outward(i));
    }
  });
  for (std::size_t i = 0; i < branches.size(); ++i) {
    branches[i].end = surface_.target(branches[i].path.back().halfedge);
    for (std::size_t j = 0; j < i; ++j) {
      if (branches[i].end != branches[j].end) continue;
      Branch& longer = branches[i].path.size() > 1 ? branches[i] : branches[j];
      longer.end = surface_.origin(longer.path.back().halfedge);
      longer.path.pop_back();
    }
  }
  return branches;
}

/// What gains most, of the first ways that gain, to lead two neighbours together and from there to
/// the node.
Move Straightening::find_split(Index centre, const std::vector<Branch>& branches) {
  Move best;
  Index tried = 0;
  for (std::size_t i = 0; i < branches.size() && tried < kMostSplits; ++i) {
    const Branch stem{{kNone, false}, centre, {}};
    Move move = find_move({centre, {stem, branches[i], branches[(i + 1) % branches.size()]}});
    tried += move.gain > 0 ? 1 : 0;
    if (move.gain > best.gain) best = std::move(move);
  }
  return best;
}

/// Where there is no disk around the star, of half of it.
Move Straightening::find_move(Star star) {
  while (!fill_patch(star)) {
    bool is_least = true;
    for (Branch& branch : star.branches) {
      if (branch.path.size() < 2) continue;
      is_least = false;
      branch.path.erase(branch.path.begin() + (size_of(branch.path) + 1) / 2, branch.path.end());
      branch.end = surface_.target(branch.path.back().halfedge);
    }
    if (is_least) return {};
  }
  return find_least(star);
}

/// Whether there is a disk that the star may move through.
bool Straightening::fill_patch(const Star& star) {
  patch_.clear();
  if (ends_share_other_seam(star)) return false;
  patch_.add(star.centre);
  for (const Branch& branch : star.branches) {
    for (const Step& step : branch.path) patch_.add(surface_.target(step.halfedge));
  }
  patch_.grow(kRings, degree_);
  return patch_.is_disk();
}

bool Straightening::ends_share_other_seam(const Star& star) const {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Branch &a = star.branches[i], &b = star.branches[j];
      const bool is_branch = a.path.size() == 1 && b.path.empty();
      if (!is_branch && is_seam_between(a.end, b.end)) return true;
    }
  }
  return false;
}

/// The least star in the patch with these ends.
Move Straightening::find_least(const Star& star) {
  const std::array<Branch, 3>& branches = star.branches;
  double before = 0;
  for (const Branch& branch : branches) before += cost_of(branch.path);
  double least = before * (1 - kGain);
  const std::array<Index, 3> ends{branches[0].end, branches[1].end, branches[2].end};
  find_paths({ends[0], least, kNone, {ends[1], ends[2]}}, trees_[0]);
  // The ways to the two other ends are no shorter together than those ends are apart.
  const double to_1 = trees_[0].distance[patch_.number(ends[1])];
  const double to_2 = trees_[0].distance[patch_.number(ends[2])];
  find_paths({ends[1], least - to_2 * (1 - kGain), kNone, {ends[0], ends[2]}}, trees_[1]);
  find_paths({ends[2], least - to_1 * (1 - kGain), kNone, {ends[0], ends[1]}}, trees_[2]);
  Index best = kNone;
  for (Index n = 0; n < patch_.size(); ++n) {
    const double sum = trees_[0].distance[n] + trees_[1].distance[n] + trees_[2].distance[n];
    const Index v = patch_.vertex(n);
    if (!(sum < least) || std::find(ends.begin(), ends.end(), v) != ends.end()) continue;
    least = sum;
    best = v;
  }
  if (best == kNone) return {};
  Move move{star, {best, {}}, before - least};
  for (std::size_t i = 0; i < 3; ++i) {
    Branch& branch = move.after.branches[i];
    branch = {branches[i].arc, branches[i].end, path_to(branches[i], trees_[i], best)};
  }
  if (turning_.weight() > 0) {
    move.gain = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      move.gain += turning_cost_of(branches[i].path, kNone, kNone) -
                   turning_cost_of(move.after.branches[i].path, kNone, kNone);
    }
    if (!(move.gain > before * kGain)) return {};
  }
  return is_tree(move.after) ? move : Move{};
}

/// To the end of the branch, which the tree is rooted at.
Path Straightening::path_to(const Branch& branch, const PathTree& tree, Index from) const {
  Path path;
  for (Index v = from; v != branch.end; v = surface_.target(path.back().halfedge)) {
    const Index h = surface_.twin[tree.reached_by[patch_.number(v)]];
    path.push_back({h, moved_in(h, branch.path)});
  }
  return path;
}

/// Whether branches meet at the centre alone, which rounding could break, and in their order there:
/// loose ends could come in another one.
bool Straightening::is_tree(const Star& star) const {
  std::vector<Index> vertices{star.centre}, order;
  for (const Branch& branch : star.branches) {
    for (const Step& step : branch.path) vertices.push_back(surface_.target(step.halfedge));
  }
  std::sort(vertices.begin(), vertices.end());
  if (std::adjacent_find(vertices.begin(), vertices.end()) != vertices.end()) return false;
  surface_.for_each_outgoing(star.centre, [&](Index h) {
    for (Index i = 0; i < 3; ++i) {
      if (star.branches[i].path.front().halfedge == h) order.push_back(i);
    }
  });
  return order[1] == (order[0] + 1) % 3;
}

void Straightening::take(const Move& move) {
  gained_ += move.gain;
  for (const Branch& branch : move.before.branches) {
    for (const Step& step : branch.path) set_seam(step.halfedge, false);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const Path& path = move.after.branches[i].path;
    for (const Step& step : path) set_seam(step.halfedge, true);
    if (move.before.branches[i].arc.arc != kNone) replace_begin(move.before.branches[i], path);
  }
}

/// Of the arc that the branch is the first part of.
void Straightening::replace_begin(const Branch& before, const Path& path) {
  Path& whole = arcs_[before.arc.arc].path;
  const Index count = size_of(before.path);
  if (!before.arc.is_back) {
    whole.erase(whole.begin(), whole.begin() + count);
    whole.insert(whole.begin(), path.begin(), path.end());
    return;
  }
  whole.erase(whole.end() - count, whole.end());
  for (auto step = path.rbegin(); step != path.rend(); ++step) {
    whole.push_back({surface_.twin[step->halfedge], step->moved_in});
  }
}

}  // namespace

EdgeMarks straighten(const Surface& surface, const EdgeMarks& seams,
                     const std::vector<double>& cost, const std::vector<bool>& anchored,
                     const EdgeMarks& locked, double straightness, const Work& work) {
  return Straightening(surface, seams, cost, anchored, locked, straightness).run(work);
}

}  // namespace beltrami
