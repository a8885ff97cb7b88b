#include "atlas/open.h"

#include <algorithm>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "admit/fill.h"
#include "base/error.h"
#include "chart/fine_problem.h"
#include "cut/cut_into_charts.h"
#include "cut/edge_marks.h"
#include "cut/open_minimal.h"
#include "mesh/split_fans.h"
#include "mesh/surface.h"
#include "simplify/history.h"
#include "simplify/replay.h"

namespace beltrami {
namespace {

// Where the stages end in the progress.
constexpr double kParted = 0.2, kFilled = 0.3, kOpened = 0.7;

/// A chart inherits a level of so many times the faces of its coarse mesh: how the surface spread
/// its faces over charts is not how their own meshes will.
constexpr double kLevel = 4;
/// Above this share of the faces of a chart it is simplified from the start.
constexpr double kWorthInheriting = 0.5;

/// The surface with what is given cut, but for the inside of polygons.
SplitSurface part(const Admitted& admitted, const GivenCuts& cuts, const PolygonParts& polygons,
                  const Work& work) {
  const EdgeMarks marks = given_marks(admitted, cuts, work.part(0, 0.5));
  std::vector<Index> twin = admitted.surface.twin;
  for (Index h = 0; h < size_of(twin); ++h) {
    if (!marks[h] || twin[h] == kNone) continue;
    if (polygons.polygon.empty() ||
        !is_inside_polygon(admitted, polygons, h, admitted.surface.twin[h])) {
      twin[h] = kNone;
    }
  }
  return split_fans(admitted.surface.positions, admitted.surface.faces, twin, work.part(0.5, 1));
}

/// The edges that are not to be cut: inside polygons, and the spokes of fans
/// over holes but for one each, by which a path may reach the centre.
EdgeMarks locked_edges(const FilledSurface& filled, const Admitted& admitted,
                       const PolygonParts& polygons) {
  const Surface& surface = filled.surface;
  if (polygons.polygon.empty() && filled.filled_loops == 0) return {};
  EdgeMarks locked(surface.twin.size(), false);
  if (!polygons.polygon.empty()) {
    for (Index h = 0; h < 3 * filled.real_faces; ++h) {
      const Index twin = surface.twin[h];
      if (twin == kNone || twin >= 3 * filled.real_faces) continue;
      if (is_inside_polygon(admitted, polygons, h, twin)) locked[h] = true;
    }
  }
  for (Index v = filled.real_vertices; v < surface.vertex_count(); ++v) {
    const Index first = surface.outgoing[v];
    surface.for_each_outgoing(v, [&](Index h) {
      if (h != first) mark_edge(surface, h, locked);
    });
  }
  return locked;
}

/// The hints for the filled surface; `input`: the input's vertex of each of its real ones.
SeamHints hints_for(const FilledSurface& filled, const std::vector<Index>& input,
                    const Admitted& admitted, const InputHints& given) {
  const Surface& surface = filled.surface;
  SeamHints hints;
  if (!given.vertex_paint.empty()) {
    hints.vertex_paint.assign(surface.positions.size(), 1);
    for (std::size_t v = 0; v < input.size(); ++v) {
      hints.vertex_paint[v] = given.vertex_paint[input[v]];
    }
  }
  if (!given.materials.empty()) {
    hints.labels.assign(surface.faces.size(), kNone);
    for (Index f = 0; f < filled.real_faces; ++f) {
      hints.labels[f] = given.materials[admitted.input_face[f]];
    }
  }
  if (given.edge_paint.empty()) return hints;
  const auto ordered = [](Index a, Index b) { return std::pair(std::min(a, b), std::max(a, b)); };
  std::map<std::pair<Index, Index>, double> painted;
  for (const PaintedEdge& edge : given.edge_paint) {
    painted[ordered(admitted.welded(edge.ends[0]), admitted.welded(edge.ends[1]))] = edge.factor;
  }
  for (Index h = 0; h < 3 * filled.real_faces; ++h) {
    if (surface.edge(h) != h) continue;
    const Index a = surface.origin(h), b = surface.target(h);
    const auto found = painted.find(ordered(input[a], input[b]));
    if (found != painted.end()) hints.edge_paint.push_back({{a, b}, found->second});
  }
  return hints;
}

/// A surface that has been arranged has its faces in another order than the input.
void sort_by_first_face(const Admitted& admitted, std::vector<AtlasChart>& charts) {
  std::vector<std::pair<Index, Index>> order;
  for (Index c = 0; c < size_of(charts); ++c) {
    order.emplace_back(first_input_face(charts[c], admitted), c);
  }
  if (std::is_sorted(order.begin(), order.end())) return;
  std::sort(order.begin(), order.end());
  std::vector<AtlasChart> sorted;
  for (const auto& [face, c] : order) sorted.push_back(std::move(charts[c]));
  charts.swap(sorted);
}

/// Per chart, what collapses of the surface leave to be done: per vertex the next one on its way,
/// or itself. Of each chart so many are done again that it keeps more faces than its coarse mesh is
/// to have. Empty for charts that would gain little, and in all where there is no history.
std::vector<std::vector<Index>> inherited_collapses(const Surface& surface,
                                                    const std::vector<Chart>& charts,
                                                    const CollapseHistory& history) {
  if (history.steps.empty()) return {};
  std::vector<bool> kept(surface.positions.size(), false);
  for (const Chart& chart : charts) {
    for (std::size_t v = 0; v < chart.input_vertex.size(); ++v) {
      if (chart.mesh.on_boundary[v]) kept[chart.input_vertex[v]] = true;
    }
  }
  const std::vector<Index> step_of = repeatable_steps(history, kept);
  std::vector<std::vector<Index>> collapsed(charts.size());
  std::vector<Index> in_chart(kept.size());  // of what is inside, which has one vertex in one chart
  for (std::size_t c = 0; c < charts.size(); ++c) {
    const Chart& chart = charts[c];
    const Index faces = chart.mesh.face_count();
    const double share = kLevel * coarse_faces(faces, 0) / faces;
    if (share > kWorthInheriting) continue;
    // A collapse takes two faces.
    const auto steps = static_cast<Index>((1 - share) * surface.face_count() / 2);
    for (Index v = 0; v < size_of(chart.input_vertex); ++v) in_chart[chart.input_vertex[v]] = v;
    std::vector<Index>& into = collapsed[c];
    into.resize(chart.input_vertex.size());
    for (Index v = 0; v < size_of(into); ++v) {
      const Index step = step_of[chart.input_vertex[v]];
      const bool goes = step != kNone && step < steps;
      into[v] = goes ? in_chart[history.steps[step].target] : v;
    }
  }
  return collapsed;
}

}  // namespace

bool is_inside_polygon(const Admitted& admitted, const PolygonParts& polygons, Index h,
                       Index twin) {
  const auto is_diagonal = [&](Index of) {
    if (polygons.diagonals.empty()) return true;
    const Index face = of / 3;
    const int k = admitted.reversed[face] ? 2 - of % 3 : of % 3;
    return (polygons.diagonals[admitted.input_face[face]] >> k & 1) != 0;
  };
  const auto polygon = [&](Index of) { return polygons.polygon[admitted.input_face[of / 3]]; };
  return polygon(h) == polygon(twin) && is_diagonal(h) && is_diagonal(twin);
}

Index first_input_face(const AtlasChart& chart, const Admitted& admitted) {
  Index first = admitted.input_face[chart.chart.input_face[0]];
  for (Index f = 1; f < chart.real_faces; ++f) {
    first = std::min(first, admitted.input_face[chart.chart.input_face[f]]);
  }
  return first;
}

OpenedSurface open_surface(const Admitted& admitted, const GivenCuts& cuts, double fill_limit,
                           const PolygonParts& polygons, const std::optional<SeamTarget>& target,
                           const SeamWeights& weights, const InputHints& hints,
                           const BegunSearch& begun, const Work& work) {
  SplitSurface parted;
  Topology topology;
  if (cuts.none()) {
    parted.surface = admitted.surface;
    topology = admitted.topology;
  } else {
    parted = part(admitted, cuts, polygons, work.part(0, kParted));
    topology = topology_of(parted.surface, work);
  }
  const auto input = [&](Index v) { return parted.vertex.empty() ? v : parted.vertex[v]; };
  const FilledSurface filled =
      fill_holes(std::move(parted.surface), topology, fill_limit, work.part(kParted, kFilled));
  if (filled.filled_loops > 0) topology = topology_of(filled.surface, work);

  const EdgeMarks locked = locked_edges(filled, admitted, polygons);
  OpenedSurface opened;
  CutSurface cut;
  SearchedSeams found;
  if (target) {
    std::vector<Index> vertices(filled.real_vertices);
    for (Index v = 0; v < filled.real_vertices; ++v) vertices[v] = admitted.input_vertex[input(v)];
    found = search_seams(filled.surface, filled.real_faces, topology, locked, *target, weights,
                         hints_for(filled, vertices, admitted, hints), begun,
                         work.part(kFilled, kOpened));
    opened.predicted_energy = found.energy;
    opened.search = std::move(found.search);
    cut = cut_into_charts(filled.surface, found.seams, work.part(kOpened, 1));
    if (!cut.non_disks.empty()) {
      found.maps.clear();
      cut = cut_into_charts(filled.surface,
                            opened_further(filled.surface, found.seams, locked, work), work);
    }
  } else {
    const EdgeMarks marks =
        open_minimal(filled.surface, topology, locked, work.part(kFilled, kOpened));
    cut = cut_into_charts(filled.surface, marks, work.part(kOpened, 1));
  }
  if (!cut.non_disks.empty()) {
    throw Error(Fault::kInternal, "a chart of the cut surface is no disk, please report it");
  }
  opened.filled_holes = filled.filled_loops;
  std::vector<std::vector<Index>> collapsed;
  if (opened.search.level) {
    collapsed = inherited_collapses(filled.surface, cut.charts, opened.search.level->history);
  }
  for (std::size_t c = 0; c < cut.charts.size(); ++c) {
    Chart& chart = cut.charts[c];
    const auto first_virtual =
        std::lower_bound(chart.input_face.begin(), chart.input_face.end(), filled.real_faces);
    const auto real_faces = static_cast<Index>(first_virtual - chart.input_face.begin());
    for (Index& v : chart.input_vertex) v = v < filled.real_vertices ? input(v) : kNone;
    opened.charts.push_back({std::move(chart), real_faces});
    if (!collapsed.empty()) opened.charts.back().collapsed_into = std::move(collapsed[c]);
    if (!found.maps.empty()) opened.charts.back().local_map = std::move(found.maps[c]);
  }
  sort_by_first_face(admitted, opened.charts);
  return opened;
}

}  // namespace beltrami
