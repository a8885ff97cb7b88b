#include "simplify/replay.h"

#include <utility>

#include "base/interrupt.h"
#include "simplify/back_ends.h"
#include "simplify/simplify.h"

namespace beltrami {

std::vector<Index> repeatable_steps(const CollapseHistory& history, const std::vector<bool>& kept) {
  std::vector<Index> step_of(kept.size(), kNone);
  // Per vertex, whether the faces around it are others than at that step.
  std::vector<bool> differs = kept;
  const auto is_as_then = [&](Index v) { return v == kNone || !differs[v]; };
  PollSometimes poll;
  Index next = 0;
  for (Index s = 0; s < size_of(history.steps); ++s) {
    poll();
    const auto& [v, w, apexes, first] = history.steps[s];
    const bool is_last = s + 1 == size_of(history.steps);
    next = is_last ? size_of(history.renamed) : history.steps[s + 1].first;
    if (is_as_then(v) && is_as_then(w) && is_as_then(apexes[0]) && is_as_then(apexes[1])) {
      step_of[v] = s;
      continue;
    }
    for (const Index u : {w, apexes[0], apexes[1]}) {
      if (u != kNone) differs[u] = true;
    }
    for (Index i = first; i < next; ++i) differs[history.renamed[i]] = true;
  }
  return step_of;
}

CoarseDisk collapsed_disk(const DiskMesh& fine, std::vector<Index> into, const Work& work) {
  std::vector<Index> kept, number(into.size(), kNone);
  for (Index v = 0; v < size_of(into); ++v) {
    if (into[v] == v) {
      number[v] = size_of(kept);
      kept.push_back(v);
      continue;
    }
    Index end = v;
    while (into[end] != end) end = into[end];
    for (Index on_the_way = v; on_the_way != end;) {
      on_the_way = std::exchange(into[on_the_way], end);
    }
  }
  std::vector<Triangle> faces;
  for (const auto& [a, b, c] : fine.faces) {
    const Triangle face{number[into[a]], number[into[b]], number[into[c]]};
    if (face[0] != face[1] && face[1] != face[2] && face[2] != face[0]) faces.push_back(face);
  }
  return coarse_disk(fine, std::move(kept), std::move(faces), std::move(into), work);
}

CoarseDisk simplify_further(const CoarseDisk& level, Index target_faces, const Work& work) {
  CoarseDisk coarse = simplify(level.mesh, target_faces, work);
  for (Index& v : coarse.fine_vertex) v = level.fine_vertex[v];
  std::vector<Index> nearby;
  nearby.reserve(level.nearby.size());
  for (const Index v : level.nearby) nearby.push_back(coarse.nearby[v]);
  coarse.nearby.swap(nearby);
  return coarse;
}

}  // namespace beltrami
