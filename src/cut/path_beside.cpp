#include "cut/path_beside.h"

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <utility>

namespace beltrami {
namespace {

struct Reached {
  double cost = std::numeric_limits<double>::infinity();
  Index by = kNone;  ///< the half-edge of the way there
};

/// The vertices within so many rings, none of them reached.
std::map<Index, Reached> tube_around(const Surface& surface, const std::vector<Index>& vertices,
                                     int rings) {
  std::map<Index, Reached> tube;
  std::vector<Index> last;
  const auto add = [&](Index v, std::vector<Index>& ring) {
    if (tube.try_emplace(v).second) ring.push_back(v);
  };
  for (const Index v : vertices) add(v, last);
  for (int i = 0; i < rings; ++i) {
    std::vector<Index> ring;
    for (const Index v : last) {
      surface.for_each_outgoing(v, [&](Index h) {
        add(surface.target(h), ring);
        add(surface.origin(Surface::previous(h)), ring);
      });
    }
    last.swap(ring);
  }
  return tube;
}

}  // namespace

std::vector<Index> path_beside(const Surface& surface, const std::vector<Index>& vertices,
                               int rings, const std::vector<double>& cost, const PathRules& rules) {
  std::map<Index, Reached> tube = tube_around(surface, vertices, rings);
  const Index start = vertices.front();
  std::set<std::pair<double, Index>> queue = {{0, start}};
  tube[start].cost = 0;
  while (!queue.empty()) {
    const auto [reached, v] = *queue.begin();
    queue.erase(queue.begin());
    if (rules.ends(v)) {
      std::vector<Index> path;
      for (Index at = v; at != start; at = surface.origin(path.back())) {
        path.push_back(tube[at].by);
      }
      std::reverse(path.begin(), path.end());
      return path;
    }
    if (v != start && !rules.passes(v)) continue;
    surface.for_each_outgoing(v, [&, reached = reached](Index h) {
      const Index other = surface.target(h);
      const auto place = tube.find(other);
      const double through = reached + cost[h];
      if (surface.twin[h] == kNone || place == tube.end() || !(through < place->second.cost)) {
        return;
      }
      queue.erase({place->second.cost, other});
      place->second = {through, h};
      queue.emplace(through, other);
    });
  }
  return {};
}

}  // namespace beltrami
