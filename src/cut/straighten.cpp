// Paths in a patch that can be shrunk to a point and touches seams at the ends of the path alone
// can be moved into each other across the patch: its neighbourhood is a disk, of which other seams
// at these ends cut off nothing between them. So the shortest one parts what any of them parts.
#include "cut/straighten.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <queue>
#include <span>
#include <utility>

#include "base/interrupt.h"
#include "base/parallel.h"
#include "base/types.h"

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

/// Bounds the time: what sweeps after the third gain of carried cuts is about 0.01%.
constexpr Index kMostSweeps = 12;

/// Paths are replaced by those cheaper by more than what sums round: so no two take turns.
constexpr double kGain = 1e-9;

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

/// The disk around a path: the complex that is induced by its vertices, which have numbers of
/// their own in it.
class Patch {
 public:
  explicit Patch(const Surface& surface)
      : surface_(surface), number_(surface.positions.size(), kNone) {}

  void clear() {
    for (const Index v : vertices_) number_[v] = kNone;
    vertices_.clear();
    euler_ = 0;
  }
  Index number(Index v) const { return number_[v]; }
  Index vertex(Index number) const { return vertices_[number]; }
  Index size() const { return size_of(vertices_); }
  /// Of a connected patch, which is no closed surface.
  bool is_disk() const { return euler_ == 1; }

  void add(Index v) {
    euler_ += euler_with(v);
    number_[v] = size();
    vertices_.push_back(v);
  }
  /// Whether the patch stays connected, and holes in it become no more.
  bool may_add(Index v) const {
    const Index change = euler_with(v);
    return change == 0 || (change == 1 && euler_ < 1 && !vertices_.empty());
  }

 private:
  /// By how much the vertex, its edges into the patch and faces between these raise the Euler
  /// characteristic: 1 less the runs of neighbours, or 1 where they go all around.
  Index euler_with(Index v) const {
    Index edges = 0, faces = 0, last = kNone;
    surface_.for_each_outgoing(v, [&](Index h) {
      const bool has_this = number_[surface_.target(h)] != kNone;
      last = surface_.origin(Surface::previous(h));
      edges += has_this ? 1 : 0;
      faces += has_this && number_[last] != kNone ? 1 : 0;
    });
    if (surface_.on_boundary[v] && number_[last] != kNone) ++edges;
    return 1 - edges + faces;
  }

  const Surface& surface_;
  std::vector<Index> number_;  ///< per vertex of the surface, or kNone
  std::vector<Index> vertices_;
  Index euler_ = 0;
};

class Straightening {
 public:
  Straightening(const Surface& surface, const EdgeMarks& seams, const std::vector<double>& cost,
                const std::vector<bool>& anchored, const EdgeMarks& locked)
      : surface_(surface),
        cost_(cost),
        anchored_(anchored),
        locked_(locked),
        seams_(seams),
        degree_(surface.positions.size(), 0),
        patch_(surface) {}

  EdgeMarks run(const Work& work) {
    std::vector<Arc> arcs = find_arcs(work);
    bool moved = true;
    for (Index sweep = 1; moved && sweep <= kMostSweeps; ++sweep) {
      moved = false;
      for (Arc& arc : arcs) moved = straighten_arc(arc, sweep) || moved;
    }
    return std::move(seams_);
  }

 private:
  std::vector<Arc> find_arcs(const Work& work);
  Arc trace(Index first, EdgeMarks& taken);
  bool straighten_arc(Arc& arc, Index sweep);
  void straighten_window(std::span<const Step> window, Index sweep, Path& result);
  bool fill_patch(std::span<const Step> window);
  bool ends_share_other_seam(std::span<const Step> window) const;
  bool find_cheaper(std::span<const Step> window);
  void find_paths(std::span<const Step> window, double most);
  void take(std::span<const Step> window, Index sweep, Path& result);

  bool is_seam(Index h) const { return seams_[h] && surface_.twin[h] != kNone; }
  bool is_node(Index v) const {
    return degree_[v] != 2 || surface_.on_boundary[v] || (!anchored_.empty() && anchored_[v]);
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

  // Of a window.
  Patch patch_;
  std::vector<double> distance_;   ///< per vertex of the patch
  std::vector<Index> reached_by_;  ///< likewise the half-edge that leads there
  std::vector<Index> shortest_;    ///< half-edges
  PollSometimes poll_;
};

// --- Arcs ---------------------------------------------------------------------------------------

std::vector<Arc> Straightening::find_arcs(const Work& work) {
  const std::vector<Index> edges =
      parallel_filter(work, size_of(surface_.twin), kGrain,
                      [&](Index h) { return is_seam(h) && surface_.edge(h) == h; });
  for (const Index h : edges) change_ends(h, 1);
  EdgeMarks taken(surface_.twin.size(), false);
  std::vector<Arc> arcs;
  for (const Index e : edges) {
    for (const Index h : {e, surface_.twin[e]}) {
      if (is_node(surface_.origin(h)) && !taken[h]) arcs.push_back(trace(h, taken));
    }
  }
  for (const Index h : edges) {
    if (taken[h]) continue;
    arcs.push_back(trace(h, taken));
    arcs.back().is_free_loop = true;
  }
  return arcs;
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
bool Straightening::straighten_arc(Arc& arc, Index sweep) {
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
  Index length = sweep % 2 == 0 ? full * 3 / 4 : full;
  for (Index next = 0; next < size_of(before); length = full) {
    const Index kept = std::min(size_of(arc.path), full / 2);
    window.assign(arc.path.end() - kept, arc.path.end());
    arc.path.resize(arc.path.size() - kept);
    const Index end = std::min(next + length - kept, size_of(before));
    window.insert(window.end(), before.begin() + next, before.begin() + end);
    next = end;
    straighten_window(window, sweep, arc.path);
  }
  return std::any_of(arc.path.begin(), arc.path.end(),
                     [&](const Step& step) { return step.moved_in == sweep; });
}

// --- Windows ------------------------------------------------------------------------------------

/// Appends what becomes of the window. Where there is no disk around it, of its halves.
void Straightening::straighten_window(std::span<const Step> window, Index sweep, Path& result) {
  const bool is_due = std::any_of(window.begin(), window.end(),
                                  [&](const Step& step) { return step.moved_in >= sweep - 1; });
  const bool is_narrow = is_due && !fill_patch(window);
  if (is_narrow && window.size() > 1) {
    const std::size_t half = window.size() / 2;
    straighten_window(window.first(half), sweep, result);
    return straighten_window(window.subspan(half), sweep, result);
  }
  if (is_due && !is_narrow && find_cheaper(window)) return take(window, sweep, result);
  result.insert(result.end(), window.begin(), window.end());
}

/// Whether there is a disk that the path may move through.
bool Straightening::fill_patch(std::span<const Step> window) {
  patch_.clear();
  const Index start = surface_.origin(window.front().halfedge);
  if (start == surface_.target(window.back().halfedge)) return false;
  if (ends_share_other_seam(window)) return false;
  patch_.add(start);
  for (const Step& step : window) patch_.add(surface_.target(step.halfedge));
  Index next = 0;
  for (Index ring = 0; ring < kRings; ++ring) {
    for (const Index end = patch_.size(); next < end; ++next) {
      poll_();
      surface_.for_each_outgoing(patch_.vertex(next), [&](Index h) {
        const Index v = surface_.target(h);
        const bool is_free = degree_[v] == 0 && !surface_.on_boundary[v];
        if (is_free && patch_.number(v) == kNone && patch_.may_add(v)) patch_.add(v);
      });
    }
  }
  return patch_.is_disk();
}

/// Whether an edge between the ends is a seam that the window does not have: across that one the
/// path must not move, but it is in the patch.
bool Straightening::ends_share_other_seam(std::span<const Step> window) const {
  if (window.size() == 1) return false;
  const Index end = surface_.target(window.back().halfedge);
  bool found = false;
  surface_.for_each_outgoing(surface_.origin(window.front().halfedge), [&](Index h) {
    found = found || (surface_.target(h) == end && is_seam(h));
  });
  return found;
}

/// Whether there is a cheaper path between the ends: left in shortest_.
bool Straightening::find_cheaper(std::span<const Step> window) {
  double before = 0;
  for (const Step& step : window) before += cost_[step.halfedge];
  find_paths(window, before * (1 - kGain));
  const Index start = surface_.origin(window.front().halfedge);
  Index v = surface_.target(window.back().halfedge);
  if (reached_by_[patch_.number(v)] == kNone) return false;
  shortest_.clear();
  for (; v != start; v = surface_.origin(shortest_.back())) {
    shortest_.push_back(reached_by_[patch_.number(v)]);
  }
  std::reverse(shortest_.begin(), shortest_.end());
  return true;
}

/// Shortest paths from the start to all that costs less than `most` (Dijkstra 1959), through the
/// inside of the surface.
void Straightening::find_paths(std::span<const Step> window, double most) {
  const Index start = surface_.origin(window.front().halfedge);
  const Index end = surface_.target(window.back().halfedge);
  // The sides of an edge on its own would be one again.
  const bool is_on_its_own = is_loose_end(start) && is_loose_end(end);
  distance_.assign(patch_.size(), most);
  reached_by_.assign(patch_.size(), kNone);
  using Entry = std::pair<double, Index>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  distance_[patch_.number(start)] = 0;
  queue.emplace(0, patch_.number(start));
  while (!queue.empty()) {
    poll_();
    const auto [reached, n] = queue.top();
    queue.pop();
    if (reached > distance_[n]) continue;
    const Index v = patch_.vertex(n);
    if (v == end) return;
    surface_.for_each_outgoing(v, [&, reached = reached](Index h) {
      const Index other = patch_.number(surface_.target(h));
      if (other == kNone || surface_.twin[h] == kNone) return;
      const double through = reached + cost_[h];
      if (!(through < distance_[other])) return;
      if (!locked_.empty() && locked_[h] && !seams_[h]) return;
      if (is_on_its_own && v == start && surface_.target(h) == end) return;
      distance_[other] = through;
      reached_by_[other] = h;
      queue.emplace(through, other);
    });
  }
}

void Straightening::take(std::span<const Step> window, Index sweep, Path& result) {
  const std::size_t first = result.size();
  for (const Index h : shortest_) {
    const auto kept = std::find_if(window.begin(), window.end(),
                                   [&](const Step& step) { return step.halfedge == h; });
    result.push_back({h, kept == window.end() ? sweep : kept->moved_in});
  }
  for (const Step& step : window) set_seam(step.halfedge, false);
  for (std::size_t i = first; i < result.size(); ++i) set_seam(result[i].halfedge, true);
}

}  // namespace

EdgeMarks straighten(const Surface& surface, const EdgeMarks& seams,
                     const std::vector<double>& cost, const std::vector<bool>& anchored,
                     const EdgeMarks& locked, const Work& work) {
  return Straightening(surface, seams, cost, anchored, locked).run(work);
}

}  // namespace beltrami
