#include "linear/cholesky/vertex_separator.h"

#include <algorithm>

namespace beltrami {

const std::vector<std::uint8_t>& VertexSeparator::cut(std::int64_t source_weight,
                                                      std::int64_t sink_weight) {
  count_ = static_cast<int>(terminal.size());
  previous_.assign(count_, kNone);
  next_.assign(count_, kNone);
  for (bool found = true; found;) {
    found = false;
    tried_.assign(2 * static_cast<std::size_t>(count_), 0);
    cursor_.assign(start.begin(), start.end() - 1);
    for (int v = 0; v < count_; ++v) {
      if ((terminal[v] & kSource) == 0 || previous_[v] == kTerminal || tried_[in(v)] != 0) continue;
      found = augment(v) || found;
    }
  }
  side_.resize(count_);
  other_side_.resize(count_);
  reach_from_sources();
  reach_from_sinks();
  const auto imbalance = [&](const std::vector<std::uint8_t>& side) {
    std::int64_t difference = source_weight - sink_weight;
    for (const std::uint8_t s : side) difference += s == kSourceSide ? 1 : s == kSinkSide ? -1 : 0;
    return difference < 0 ? -difference : difference;
  };
  return imbalance(side_) <= imbalance(other_side_) ? side_ : other_side_;
}

/// Searches depth first for a path to a sink in the residual graph. A node that was tried, with or
/// without success, is not tried again before all sources had their turn: each node carries one
/// unit at most.
bool VertexSeparator::augment(int source) {
  path_.assign(1, in(source));
  tried_[in(source)] = 1;
  while (!path_.empty()) {
    const int node = path_.back(), v = node / 2;
    int onward = kNone;
    if (node == in(v)) {
      const int target = previous_[v] == kNone ? out(v)
                         : previous_[v] >= 0   ? out(previous_[v])
                                               : kNone;
      if (target != kNone && tried_[target] == 0) onward = target;
    } else {
      if ((terminal[v] & kSink) != 0 && next_[v] != kTerminal) {
        apply_path();
        return true;
      }
      for (int& e = cursor_[v]; e < start[v + 1]; ++e) {
        if (neighbour[e] != next_[v] && tried_[in(neighbour[e])] == 0) {
          onward = in(neighbour[e]);
          break;
        }
      }
      if (onward == kNone && previous_[v] != kNone && tried_[in(v)] == 0) onward = in(v);
    }
    if (onward != kNone) {
      tried_[onward] = 1;
      path_.push_back(onward);
    } else {
      path_.pop_back();
    }
  }
  return false;
}

/// Follows the path; steps against the flow take it back.
void VertexSeparator::apply_path() {
  int came_from = kTerminal;  // the vertex whose flow enters the node at hand
  for (std::size_t i = 0; i < path_.size(); ++i) {
    const int node = path_[i], v = node / 2;
    const bool last = i + 1 == path_.size();
    if (node == in(v)) {
      previous_[v] = came_from;  // for a used vertex, its old predecessor is the next node
    } else if (last) {
      next_[v] = kTerminal;
    } else if (path_[i + 1] == in(v)) {  // v leaves the flow; its predecessor finds another way
      previous_[v] = next_[v] = kNone;
      ++i;  // in(v) is passed on the way back
    } else {
      next_[v] = path_[i + 1] / 2;
      came_from = v;
    }
  }
}

/// Marks what the sources reach in the residual graph; or, against the edges, what can still reach
/// a sink.
template <bool kFromSources>
void VertexSeparator::flood() {
  const auto near = [](int v) { return kFromSources ? in(v) : out(v); };
  const auto far = [](int v) { return kFromSources ? out(v) : in(v); };
  const std::vector<int>& flow = kFromSources ? previous_ : next_;
  reached_.assign(2 * static_cast<std::size_t>(count_), 0);
  queue_.clear();
  const auto visit = [&](int node) {
    if (reached_[node] != 0) return;
    reached_[node] = 1;
    queue_.push_back(node);
  };
  for (int v = 0; v < count_; ++v) {
    if ((terminal[v] & (kFromSources ? kSource : kSink)) != 0) visit(near(v));
  }
  while (!queue_.empty()) {
    const int node = queue_.back(), v = node / 2;
    queue_.pop_back();
    if (node == near(v)) {
      // Through v where it is free, or taking back its flow.
      if (flow[v] == kNone) {
        visit(far(v));
      } else if (flow[v] >= 0) {
        visit(far(flow[v]));
      }
    } else {
      for (int e = start[v]; e < start[v + 1]; ++e) visit(near(neighbour[e]));
      visit(near(v));
    }
  }
}

/// The cut is where "in" is reached and "out" is not.
void VertexSeparator::reach_from_sources() {
  flood<true>();
  for (int v = 0; v < count_; ++v) {
    side_[v] = reached_[out(v)] != 0 ? kSourceSide : reached_[in(v)] != 0 ? kSeparator : kSinkSide;
  }
}

void VertexSeparator::reach_from_sinks() {
  flood<false>();
  for (int v = 0; v < count_; ++v) {
    other_side_[v] = reached_[in(v)] != 0    ? kSinkSide
                     : reached_[out(v)] != 0 ? kSeparator
                                             : kSourceSide;
  }
}

}  // namespace beltrami
