#include "cut/bridges.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "base/types.h"

namespace beltrami {
namespace {

/// A seam or a border, as it is gone along.
struct Step {
  Index halfedge, target;
};

/// The vertices are numbered in the order in which a search in depth comes to them. A seam to one
/// that lies behind it is a bridge where nothing from there on leads back before it.
class Search {
 public:
  Search(const Surface& surface, const EdgeMarks& seams)
      : surface_(surface),
        seams_(seams),
        number_(surface.outgoing.size(), kNone),
        back_(surface.outgoing.size(), kNone),
        bridges_(surface.twin.size(), false) {}

  std::vector<bool> run() && {
    for (Index v = 0; v < surface_.vertex_count(); ++v) {
      if (surface_.outgoing[v] != kNone && number_[v] == kNone) visit_all(v);
    }
    return std::move(bridges_);
  }

 private:
  /// A vertex on the way from the first one.
  struct Visit {
    Index vertex;
    Index came_by;  ///< the half-edge, or kNone
    std::vector<Step> steps;
    std::size_t next = 0;
  };

  bool is_same_edge(Index a, Index b) const { return a == b || surface_.twin[a] == b; }

  Visit begin(Index vertex, Index came_by) {
    number_[vertex] = back_[vertex] = count_++;
    Visit visit{vertex, came_by, {}, 0};
    surface_.for_each_outgoing(vertex, [&](Index h) {
      if (seams_[h] || surface_.twin[h] == kNone) visit.steps.push_back({h, surface_.target(h)});
      const Index in = Surface::previous(h);
      if (surface_.twin[in] == kNone) visit.steps.push_back({in, surface_.origin(in)});
    });
    return visit;
  }

  void visit_all(Index first) {
    std::vector<Visit> way = {begin(first, kNone)};
    while (!way.empty()) {
      Visit& at = way.back();
      if (at.next < at.steps.size()) {
        const Step step = at.steps[at.next++];
        if (at.came_by != kNone && is_same_edge(step.halfedge, at.came_by)) continue;
        if (number_[step.target] == kNone) {
          way.push_back(begin(step.target, step.halfedge));
        } else {
          back_[at.vertex] = std::min(back_[at.vertex], number_[step.target]);
        }
        continue;
      }
      const Visit done = std::move(way.back());
      way.pop_back();
      if (way.empty()) continue;
      const Index before = way.back().vertex;
      back_[before] = std::min(back_[before], back_[done.vertex]);
      if (back_[done.vertex] > number_[before] && seams_[done.came_by]) mark(done.came_by);
    }
  }

  void mark(Index halfedge) {
    bridges_[halfedge] = true;
    if (surface_.twin[halfedge] != kNone) bridges_[surface_.twin[halfedge]] = true;
  }

  const Surface& surface_;
  const EdgeMarks& seams_;
  std::vector<Index> number_;  ///< per vertex: when it was come to
  std::vector<Index> back_;    ///< per vertex: the least number that is reached from behind it
  std::vector<bool> bridges_;
  Index count_ = 0;
};

}  // namespace

std::vector<bool> bridges(const Surface& surface, const EdgeMarks& seams) {
  return Search(surface, seams).run();
}

}  // namespace beltrami
