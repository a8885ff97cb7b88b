#include "atlas/seams.h"

#include <algorithm>
#include <cstddef>

#include "base/interrupt.h"
#include "chart/flattening.h"

namespace beltrami {
namespace {

using Edge = std::array<Index, 2>;  // the lesser end first

/// Calls body(from, to) for each side of a face that is judged.
template <class Body>
void for_each_side(const Atlas& atlas, const Body& body) {
  PollSometimes poll;
  for (std::size_t f = 0; f < atlas.faces.size(); ++f) {
    poll();
    if (atlas.excepted[f]) continue;
    const Triangle& face = atlas.faces[f];
    for (int k = 0; k < 3; ++k) body(face[k], face[(k + 1) % 3]);
  }
}

/// Sides whose pair of UV vertices no other side has: where charts end.
std::vector<Edge> chart_borders(const Atlas& atlas) {
  // Sides by their lesser UV vertex, of which each has few.
  std::vector<std::size_t> end(atlas.uvs.size() + 1, 0);
  for_each_side(atlas, [&](Index a, Index b) { ++end[std::min(a, b) + 1]; });
  for (std::size_t v = 1; v < end.size(); ++v) end[v] += end[v - 1];
  std::vector<Index> greater(end.back());
  for_each_side(atlas, [&](Index a, Index b) { greater[end[std::min(a, b)]++] = std::max(a, b); });
  std::vector<Edge> borders;
  std::size_t begin = 0;
  for (std::size_t v = 0; v + 1 < end.size(); ++v) {
    const auto first = greater.begin() + static_cast<std::ptrdiff_t>(begin),
               last = greater.begin() + static_cast<std::ptrdiff_t>(end[v]);
    std::sort(first, last);
    for (auto at = first; at != last;) {
      const auto next = std::upper_bound(at, last, *at);
      if (next - at == 1) borders.push_back({static_cast<Index>(v), *at});
      at = next;
    }
    begin = end[v];
  }
  return borders;
}

}  // namespace

std::vector<Edge> seams_of(const Atlas& atlas) {
  std::vector<Edge> sides = chart_borders(atlas);
  for (auto& [a, b] : sides) {
    const auto [low, high] = std::minmax(atlas.input_vertex[a], atlas.input_vertex[b]);
    a = low;
    b = high;
  }
  sort_interruptibly(sides.begin(), sides.end(), std::less<>());
  std::vector<Edge> seams;
  for (std::size_t i = 0, next = 0; i < sides.size(); i = next) {
    while (next < sides.size() && sides[next] == sides[i]) ++next;
    if (next - i > 1) seams.push_back(sides[i]);
  }
  return seams;
}

bool meets(const Atlas& atlas, const SeamTarget& target) {
  const Index components = atlas.admitted.components;
  return atlas.outcome != Outcome::kNotInjective && atlas.missed.empty() &&
         atlas.energy.symmetric_dirichlet <= target.energy + kEnergyTolerance &&
         (target.p99 == 0 || atlas.energy.p99 <= target.p99) &&
         (target.max_charts == 0 ||
          static_cast<Index>(atlas.charts.size()) <= std::max(target.max_charts, components)) &&
         (target.seam_budget == 0 || atlas.seam_over_root_area <= target.seam_budget);
}

}  // namespace beltrami
