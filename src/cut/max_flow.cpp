#include "cut/max_flow.h"

#include <algorithm>
#include <cmath>

#include "base/interrupt.h"

namespace beltrami {
namespace {

/// The sum of all capacities as a whole number: flows are exact, and end.
constexpr double kWhole = 0x1p50;

/// The residual graph.
class Flow {
 public:
  Flow(const std::vector<Terminal>& terminals, const std::vector<FlowEdge>& edges)
      : terminals_(terminals), start_(terminals.size() + 1, 0), nodes_(terminals.size()) {
    double sum = 0;
    for (const FlowEdge& edge : edges) sum += edge.capacity;
    const double scale = sum > 0 ? kWhole / sum : 0;
    const auto is_needed = [&](const FlowEdge& edge) {
      return edge.one != edge.other && (terminals[edge.one] == Terminal::kNeither ||
                                        terminals[edge.one] != terminals[edge.other]);
    };
    for (const FlowEdge& edge : edges) {
      if (!is_needed(edge)) continue;
      ++start_[edge.one + 1];
      ++start_[edge.other + 1];
    }
    for (std::size_t n = 1; n < start_.size(); ++n) start_[n] += start_[n - 1];
    arcs_.resize(static_cast<std::size_t>(start_.back()));
    std::vector<Index> next(start_.begin(), start_.end() - 1);
    for (const FlowEdge& edge : edges) {
      if (!is_needed(edge)) continue;
      const Index there = next[edge.one]++, back = next[edge.other]++;
      const auto capacity = static_cast<std::int64_t>(std::floor(edge.capacity * scale + 0.5));
      arcs_[there] = {edge.other, back, capacity};
      arcs_[back] = {edge.one, there, capacity};
    }
  }

  std::vector<bool> cut() {
    for (Index n = 0; n < size_of(nodes_); ++n) {
      if (terminals_[n] == Terminal::kNeither) continue;
      nodes_[n] = {terminals_[n], kRoot, 0, 0};
      active_.push_back(n);
    }
    // Nodes that have come into a tree, or may reach others again, first come first.
    for (std::size_t i = 0; i < active_.size(); ++i) {
      const Index n = active_[i];
      for (Index a = grow(n); a != kNone; a = grow(n)) {
        augment(a);
        adopt_orphans();
      }
      if (i == active_.size() / 2 && i > nodes_.size()) {
        active_.erase(active_.begin(), active_.begin() + static_cast<std::ptrdiff_t>(i));
        i = 0;
      }
    }
    std::vector<bool> is_before(nodes_.size());
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
      is_before[n] = nodes_[n].tree != Terminal::kSink;
    }
    return is_before;
  }

 private:
  struct Arc {
    Index to, reverse;
    std::int64_t residual;
  };
  /// Parents that are no arcs.
  static constexpr Index kRoot = -2, kOrphan = -3;
  struct Node {
    Terminal tree = Terminal::kNeither;
    Index parent = kNone;  ///< the arc to it
    Index checked = 0;     ///< the last augmentation after which `steps` was right
    Index steps = 0;       ///< to the root
  };

  /// What can still flow along an arc away from the root of a tree.
  std::int64_t outwards(Index a, Terminal tree) const {
    return tree == Terminal::kSource ? arcs_[a].residual : arcs_[arcs_[a].reverse].residual;
  }
  std::int64_t inwards(Index a, Terminal tree) const { return outwards(arcs_[a].reverse, tree); }
  Index from(Index a) const { return arcs_[arcs_[a].reverse].to; }

  /// Takes free neighbours into the tree of a node until one is in the other tree; returns the arc
  /// there, from the sources' tree to the sinks', or kNone.
  Index grow(Index n) {
    const Node& node = nodes_[n];
    if (node.tree == Terminal::kNeither) return kNone;
    for (Index a = start_[n]; a < start_[n + 1]; ++a) {
      poll_();
      if (outwards(a, node.tree) == 0) continue;
      Node& other = nodes_[arcs_[a].to];
      if (other.tree == Terminal::kNeither) {
        other = {node.tree, arcs_[a].reverse, node.checked, node.steps + 1};
        active_.push_back(arcs_[a].to);
      } else if (other.tree != node.tree) {
        return node.tree == Terminal::kSource ? a : arcs_[a].reverse;
      } else if (other.checked <= node.checked && other.steps > node.steps) {
        other.parent = arcs_[a].reverse;  // a shorter way
        other.checked = node.checked;
        other.steps = node.steps + 1;
      }
    }
    return kNone;
  }

  /// Fills the path through an arc between the trees; what hangs on full arcs is orphaned.
  void augment(Index bridge) {
    ++time_;
    std::int64_t least = arcs_[bridge].residual;
    const auto for_each_on_way = [&](Index n, const auto& visit) {
      for (; nodes_[n].parent != kRoot; n = arcs_[nodes_[n].parent].to) {
        poll_();
        visit(n, nodes_[n].tree == Terminal::kSource ? arcs_[nodes_[n].parent].reverse
                                                     : nodes_[n].parent);
      }
    };
    const Index ends[] = {from(bridge), arcs_[bridge].to};
    for (const Index end : ends) {
      for_each_on_way(end, [&](Index, Index a) { least = std::min(least, arcs_[a].residual); });
    }
    const auto send = [&](Index a) {
      arcs_[a].residual -= least;
      arcs_[arcs_[a].reverse].residual += least;
    };
    send(bridge);
    for (const Index end : ends) {
      const std::size_t before = orphans_.size();
      for_each_on_way(end, [&](Index n, Index a) {
        send(a);
        if (arcs_[a].residual == 0) orphans_.push_back(n);
      });
      for (std::size_t i = before; i < orphans_.size(); ++i) nodes_[orphans_[i]].parent = kOrphan;
    }
  }

  /// Finds new parents in their trees, or sets free.
  void adopt_orphans() {
    for (std::size_t i = 0; i < orphans_.size(); ++i) {
      poll_();
      const Index n = orphans_[i];
      const Terminal tree = nodes_[n].tree;
      Index best = kNone, least = 0;
      for (Index a = start_[n]; a < start_[n + 1]; ++a) {
        const Index other = arcs_[a].to;
        if (inwards(a, tree) == 0 || nodes_[other].tree != tree) continue;
        const Index steps = steps_to_root(other);
        if (steps != kNone && (best == kNone || steps < least)) {
          best = a;
          least = steps;
        }
      }
      if (best != kNone) {
        nodes_[n] = {tree, best, time_, least + 1};
        continue;
      }
      for (Index a = start_[n]; a < start_[n + 1]; ++a) {
        const Index other = arcs_[a].to;
        if (nodes_[other].tree != tree) continue;
        if (inwards(a, tree) > 0) active_.push_back(other);
        if (nodes_[other].parent == arcs_[a].reverse) {
          nodes_[other].parent = kOrphan;
          orphans_.push_back(other);
        }
      }
      nodes_[n] = {};
    }
    orphans_.clear();
  }

  /// kNone where the way ends at an orphan.
  Index steps_to_root(Index start) {
    Index steps = 0, n = start;
    for (; nodes_[n].checked != time_ || nodes_[n].parent == kOrphan; ++steps) {
      if (nodes_[n].parent == kOrphan) return kNone;
      if (nodes_[n].parent == kRoot) break;
      n = arcs_[nodes_[n].parent].to;
    }
    steps += nodes_[n].parent == kRoot ? 0 : nodes_[n].steps;
    const Index all = steps;
    for (n = start; nodes_[n].checked != time_ && nodes_[n].parent != kRoot; --steps) {
      nodes_[n].checked = time_;
      nodes_[n].steps = steps;
      n = arcs_[nodes_[n].parent].to;
    }
    return all;
  }

  const std::vector<Terminal>& terminals_;
  std::vector<Index> start_;  // per node its first arc, and one more
  std::vector<Arc> arcs_;
  std::vector<Node> nodes_;
  std::vector<Index> active_, orphans_;
  Index time_ = 0;
  PollSometimes poll_;
};

}  // namespace

std::vector<bool> least_cut(const std::vector<Terminal>& terminals,
                            const std::vector<FlowEdge>& edges) {
  return Flow(terminals, edges).cut();
}

}  // namespace beltrami
