#include "atlas/open.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "admit/fill.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "base/parallel.h"
#include "cut/cut_into_charts.h"
#include "cut/edge_marks.h"
#include "cut/open_minimal.h"
#include "cut/seam_surface.h"
#include "cut/seam_target.h"
#include "cut/search_effort.h"
#include "mesh/disk_mesh.h"
#include "mesh/split_fans.h"
#include "mesh/surface.h"
#include "multilevel/policy.h"
#include "simplify/history.h"
#include "simplify/replay.h"

namespace beltrami {
namespace {

// Where the stages end in the progress.
constexpr double kParted = 0.7, kSearched = 0.95;

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

/// Locks the spokes of fans over holes but for one each, by which a path may reach the centre.
void lock_spokes(const FilledSurface& filled, EdgeMarks& locked) {
  const Surface& surface = filled.surface;
  for (Index v = filled.real_vertices; v < surface.vertex_count(); ++v) {
    const Index first = surface.outgoing[v];
    surface.for_each_outgoing(v, [&](Index h) {
      if (h != first) mark_edge(surface, h, locked);
    });
  }
}

/// The edges that are not to be cut: inside polygons, and most spokes of fans over holes.
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
  lock_spokes(filled, locked);
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
  PollSometimes poll;
  for (Index h = 0; h < 3 * filled.real_faces; ++h) {
    poll();
    if (surface.edge(h) != h) continue;
    const Index a = surface.origin(h), b = surface.target(h);
    const auto found = painted.find(ordered(input[a], input[b]));
    if (found != painted.end()) hints.edge_paint.push_back({{a, b}, found->second});
  }
  return hints;
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

/// What a cut makes of a piece; `coarse`: on which its seams were found, or null; `maps`: by which
/// they were judged, or none.
OpenedSurface charts_of(const SurfacePiece& piece, CutSurface cut, const SeamSurface* coarse,
                        std::vector<std::vector<Vec2>> maps) {
  if (!cut.non_disks.empty()) {
    throw Error(Fault::kInternal, "a chart of the cut surface is no disk, please report it");
  }
  OpenedSurface opened;
  std::vector<std::vector<Index>> collapsed;
  if (coarse != nullptr) {
    collapsed = inherited_collapses(piece.surface, cut.charts, coarse->history);
  }
  for (std::size_t c = 0; c < cut.charts.size(); ++c) {
    Chart& chart = cut.charts[c];
    const auto first_virtual =
        std::lower_bound(chart.input_face.begin(), chart.input_face.end(), piece.real_faces);
    const auto real_faces = static_cast<Index>(first_virtual - chart.input_face.begin());
    for (Index& v : chart.input_vertex) v = piece.vertex[v];
    for (Index& f : chart.input_face) f = piece.face[f];
    opened.charts.push_back({std::move(chart), real_faces});
    if (!collapsed.empty()) opened.charts.back().collapsed_into = std::move(collapsed[c]);
    if (!maps.empty()) opened.charts.back().local_map = std::move(maps[c]);
  }
  return opened;
}

/// The numbers that vertices and faces of a whole have in its components.
class Numbering {
 public:
  explicit Numbering(const SurfacePiece& whole)
      : whole_(whole),
        vertex_(whole.surface.positions.size(), kNone),
        face_(whole.surface.faces.size(), kNone) {}

  Index vertex(Index of_whole) const { return vertex_[of_whole]; }

  void add_face(Index f, SurfacePiece& piece) {
    face_[f] = size_of(piece.face);
    if (f < whole_.real_faces) ++piece.real_faces;
    piece.face.push_back(whole_.face[f]);
    piece.surface.faces.push_back(whole_.surface.faces[f]);
    for (int k = 0; k < 3; ++k) {
      piece.surface.twin.push_back(whole_.surface.twin[3 * f + k]);
      if (!whole_.locked.empty()) piece.locked.push_back(whole_.locked[3 * f + k]);
    }
    if (!whole_.hints.labels.empty()) piece.hints.labels.push_back(whole_.hints.labels[f]);
  }

  void add_vertex(Index v, SurfacePiece& piece) {
    vertex_[v] = size_of(piece.vertex);
    piece.vertex.push_back(whole_.vertex[v]);
    piece.surface.positions.push_back(whole_.surface.positions[v]);
    piece.surface.outgoing.push_back(whole_.surface.outgoing[v]);
    piece.surface.on_boundary.push_back(whole_.surface.on_boundary[v]);
    if (whole_.hints.vertex_paint.empty()) return;
    piece.hints.vertex_paint.push_back(whole_.hints.vertex_paint[v]);
  }

  /// Once all of its vertices and faces have been added.
  void connect(SurfacePiece& piece) const {
    for (Triangle& face : piece.surface.faces) {
      for (Index& v : face) v = vertex_[v];
    }
    const auto own = [&](Index h) { return h == kNone ? kNone : 3 * face_[h / 3] + h % 3; };
    for (Index& h : piece.surface.twin) h = own(h);
    for (Index& h : piece.surface.outgoing) h = own(h);
  }

 private:
  const SurfacePiece& whole_;
  std::vector<Index> vertex_, face_;
};

}  // namespace

Index first_input_face(const AtlasChart& chart, const Admitted& admitted) {
  Index first = admitted.input_face[chart.chart.input_face[0]];
  for (Index f = 1; f < chart.real_faces; ++f) {
    first = std::min(first, admitted.input_face[chart.chart.input_face[f]]);
  }
  return first;
}

int bring_to_unit(Surface& surface, const Work& work) {
  std::vector<Vec3> moved = surface.positions;
  const int exponent = normalise(moved, surface.faces, work).exponent;
  scale_by_power(exponent, surface.positions);
  return exponent;
}

ReadySurface make_ready(const Admitted& admitted, const GivenCuts& cuts, double fill_limit,
                        const PolygonParts& polygons, const InputHints& hints, const Work& work) {
  SplitSurface parted;
  Topology topology;
  if (cuts.none()) {
    parted.surface = admitted.surface;
    topology = admitted.topology;
  } else {
    parted = part(admitted, cuts, polygons, work.part(0, kParted));
    topology = topology_of(parted.surface, work);
  }
  FilledSurface filled =
      fill_holes(std::move(parted.surface), topology, fill_limit, work.part(kParted, 1));
  if (filled.filled_loops > 0) topology = topology_of(filled.surface, work);
  ReadySurface ready;
  ready.filled_holes = filled.filled_loops;
  SurfacePiece& whole = ready.whole;
  whole.real_faces = filled.real_faces;
  whole.topology = std::move(topology);
  whole.locked = locked_edges(filled, admitted, polygons);
  std::vector<Index> input(filled.real_vertices);
  whole.vertex.assign(filled.surface.positions.size(), kNone);
  for (Index v = 0; v < filled.real_vertices; ++v) {
    whole.vertex[v] = parted.vertex.empty() ? v : parted.vertex[v];
    input[v] = admitted.input_vertex[whole.vertex[v]];
  }
  whole.face.resize(filled.surface.faces.size());
  std::iota(whole.face.begin(), whole.face.end(), 0);
  whole.hints = hints_for(filled, input, admitted, hints);
  whole.surface = std::move(filled.surface);
  return ready;
}

std::vector<SurfacePiece> components_of(SurfacePiece whole, const Work& work) {
  const auto count = size_of(whole.topology.components);
  std::vector<SurfacePiece> pieces(count);
  if (count == 1) {
    pieces[0] = std::move(whole);
    return pieces;
  }
  Numbering numbering(whole);
  PollSometimes poll;
  for (Index f = 0; f < whole.surface.face_count(); ++f) {
    poll();
    numbering.add_face(f, pieces[whole.topology.component_of_face[f]]);
  }
  for (Index v = 0; v < whole.surface.vertex_count(); ++v) {
    poll();
    const Index h = whole.surface.outgoing[v];
    if (h != kNone) numbering.add_vertex(v, pieces[whole.topology.component_of_face[h / 3]]);
  }
  for (const PaintedEdge& edge : whole.hints.edge_paint) {
    const Index face = whole.surface.outgoing[edge.ends[0]] / 3;
    pieces[whole.topology.component_of_face[face]].hints.edge_paint.push_back(
        {{numbering.vertex(edge.ends[0]), numbering.vertex(edge.ends[1])}, edge.factor});
  }
  parallel_for(work, count, 1, [&](std::int64_t c, std::int64_t) {
    SurfacePiece& piece = pieces[c];
    numbering.connect(piece);
    piece.topology = topology_of(piece.surface, work.aside());
    piece.hints.hard_angle = whole.hints.hard_angle;
    piece.exponent = whole.exponent + bring_to_unit(piece.surface, work.aside());
  });
  return pieces;
}

OpenedSurface open_searched(const SurfacePiece& piece, const SeamTarget& target,
                            const SearchEffort& effort, const SeamWeights& weights,
                            const BegunSearch& begun, const Work& work) {
  const Surface& surface = piece.surface;
  SearchedSeams found =
      search_seams(surface, piece.real_faces, piece.topology, piece.locked, target, effort, weights,
                   piece.hints, begun, work.part(0, kSearched));
  CutSurface cut = cut_into_charts(surface, found.seams, work.part(kSearched, 1));
  if (!cut.non_disks.empty()) {
    found.maps.clear();
    found.seams = opened_further(surface, found.seams, piece.locked, work);
    cut = cut_into_charts(surface, found.seams, work);
  }
  OpenedSurface opened = charts_of(piece, std::move(cut), found.search.coarse.get(), found.maps);
  opened.predicted_energy = found.energy;
  opened.search = std::move(found.search);
  opened.seams = std::move(found.seams);
  return opened;
}

OpenedSurface open_along(const SurfacePiece& piece, EdgeMarks seams, const Work& work) {
  OpenedSurface opened = charts_of(piece, cut_into_charts(piece.surface, seams, work), nullptr, {});
  opened.seams = std::move(seams);
  return opened;
}

SurfacePiece parted_along(const SurfacePiece& piece, const EdgeMarks& marks, double fill_limit,
                          const Work& work) {
  const Surface& surface = piece.surface;
  const Index real = 3 * piece.real_faces;
  std::vector<Index> twin(surface.twin.begin(), surface.twin.begin() + real);
  for (Index h = 0; h < real; ++h) {
    if (twin[h] >= real || (!marks.empty() && marks[h])) twin[h] = kNone;
  }
  const std::vector<Triangle> faces(surface.faces.begin(),
                                    surface.faces.begin() + piece.real_faces);
  SplitSurface split = split_fans(surface.positions, faces, twin, work);
  Topology topology = topology_of(split.surface, work);
  FilledSurface filled = fill_holes(std::move(split.surface), topology, fill_limit, work);
  if (filled.filled_loops > 0) topology = topology_of(filled.surface, work);
  SurfacePiece parted;
  parted.real_faces = piece.real_faces;
  parted.topology = std::move(topology);
  if (!piece.locked.empty() || filled.filled_loops > 0) {
    parted.locked.assign(filled.surface.twin.size(), false);
    for (Index h = 0; h < real && !piece.locked.empty(); ++h) parted.locked[h] = piece.locked[h];
    lock_spokes(filled, parted.locked);
  }
  parted.vertex.assign(filled.surface.positions.size(), kNone);
  for (Index v = 0; v < filled.real_vertices; ++v) parted.vertex[v] = piece.vertex[split.vertex[v]];
  parted.face.assign(piece.face.begin(), piece.face.begin() + piece.real_faces);
  for (Index f = piece.real_faces; f < filled.surface.face_count(); ++f) {
    parted.face.push_back(parted.face.back() + 1);
  }
  parted.exponent = piece.exponent;
  parted.surface = std::move(filled.surface);
  return parted;
}

OpenedSurface open_short(const SurfacePiece& piece, const Work& work) {
  EdgeMarks seams =
      open_minimal(piece.surface, piece.topology, piece.locked, work.part(0, kSearched));
  return open_along(piece, std::move(seams), work.part(kSearched, 1));
}

}  // namespace beltrami
