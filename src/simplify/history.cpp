#include "simplify/history.h"

#include <algorithm>
#include <utility>

#include "base/interrupt.h"

namespace beltrami {
namespace {

/// Edges by their ends: few vertices have any.
class EdgesByVertex {
 public:
  explicit EdgesByVertex(std::size_t vertices) : slot_(vertices, kNone) {}

  std::vector<Index>* ends_at(Index v) { return slot_[v] == kNone ? nullptr : &ends_[slot_[v]]; }
  bool any(Index v) const { return slot_[v] != kNone && !ends_[slot_[v]].empty(); }
  void add(Index a, Index b) {
    list(a).push_back(b);
    list(b).push_back(a);
  }
  void remove(Index a, Index b) {
    std::erase(list(a), b);
    std::erase(list(b), a);
  }

 private:
  std::vector<Index>& list(Index v) {
    if (slot_[v] == kNone) {
      slot_[v] = size_of(ends_);
      ends_.emplace_back();
    }
    return ends_[slot_[v]];
  }

  std::vector<Index> slot_;
  std::vector<std::vector<Index>> ends_;
};

}  // namespace

void CollapseHistory::append(const CollapseHistory& next) {
  const Index offset = size_of(renamed);
  for (const Step& step : next.steps) {
    steps.push_back({step.vertex, step.target, step.apexes, step.first + offset});
  }
  renamed.insert(renamed.end(), next.renamed.begin(), next.renamed.end());
}

std::vector<std::array<Index, 2>> carry_edges(const CollapseHistory& history,
                                              const std::vector<std::array<Index, 2>>& edges,
                                              const std::vector<bool>& on_border,
                                              const std::vector<bool>& kept) {
  EdgesByVertex seams(on_border.size());
  for (const auto& [a, b] : edges) seams.add(a, b);
  PollSometimes poll;
  Index end = size_of(history.renamed);
  for (auto step = history.steps.rbegin(); step != history.steps.rend(); ++step) {
    poll();
    const auto [v, w, apexes, first] = *step;
    const Index last = std::exchange(end, first);
    if (!seams.any(w)) continue;
    bool moved = false;
    for (Index i = first; i < last; ++i) {
      const Index a = history.renamed[i];
      const std::vector<Index>& ends = *seams.ends_at(w);
      if (std::find(ends.begin(), ends.end(), a) == ends.end()) continue;
      seams.remove(w, a);
      seams.add(v, a);
      moved = true;
    }
    // Else a spur; and an edge of the border is none to cut.
    const bool needed = seams.any(w) || on_border[w] || (!kept.empty() && kept[w]);
    if (moved && needed && !on_border[v]) seams.add(v, w);
  }
  std::vector<std::array<Index, 2>> carried;
  for (Index v = 0; v < static_cast<Index>(on_border.size()); ++v) {
    if (!seams.any(v)) continue;
    for (const Index u : *seams.ends_at(v)) {
      if (v < u) carried.push_back({v, u});
    }
  }
  std::sort(carried.begin(), carried.end());
  return carried;
}

}  // namespace beltrami
