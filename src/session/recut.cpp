#include "session/recut.h"

#include <cstdint>
#include <map>
#include <utility>

#include "base/disjoint_sets.h"
#include "mesh/surface.h"

namespace beltrami {
namespace {

/// The faces as a piece of the ground, whose boundary is their border.
SurfacePiece piece_of(const Ground& ground, const std::vector<Index>& faces) {
  const Surface& whole = ground.admitted.surface;
  std::vector<Index> local_face(whole.faces.size(), kNone);
  std::vector<Index> local_vertex(whole.positions.size(), kNone);
  SurfacePiece piece;
  piece.real_faces = size_of(faces);
  piece.face = faces;
  for (Index i = 0; i < size_of(faces); ++i) local_face[faces[i]] = i;
  for (const Index f : faces) {
    Triangle face{};
    for (int k = 0; k < 3; ++k) {
      const Index v = whole.faces[f][k];
      if (local_vertex[v] == kNone) {
        local_vertex[v] = size_of(piece.vertex);
        piece.vertex.push_back(v);
        piece.surface.positions.push_back(whole.positions[v]);
      }
      face[k] = local_vertex[v];
      const Index twin = whole.twin[3 * f + k];
      const Index beyond = twin == kNone ? kNone : local_face[twin / 3];
      piece.surface.twin.push_back(beyond == kNone ? kNone : 3 * beyond + twin % 3);
      if (!ground.inside.empty()) piece.locked.push_back(ground.inside[3 * f + k]);
    }
    piece.surface.faces.push_back(face);
  }
  return piece;
}

/// The half-edges of a piece that are marked on the ground.
EdgeMarks marks_on(const SurfacePiece& piece, const EdgeMarks& marks) {
  EdgeMarks own(piece.surface.twin.size(), false);
  for (Index f = 0; f < piece.real_faces; ++f) {
    for (int k = 0; k < 3; ++k) own[3 * f + k] = marks[3 * piece.face[f] + k];
  }
  return own;
}

/// Unmarks seams that open nothing yet, which would only make holes of no area.
class Waiting {
 public:
  Waiting(const SurfacePiece& piece, const EdgeMarks& opened, const EdgeMarks& standing,
          EdgeMarks& marks)
      : surface_(piece.surface),
        opened_(opened),
        standing_(standing),
        marks_(marks),
        trees_(piece.surface.vertex_count()),
        sheets_(piece.surface.face_count()),
        edges_(piece.surface.positions.size(), 0),
        is_anchored_(piece.surface.positions.size(), false) {
    for (Index v = 0; v < piece.surface.vertex_count(); ++v) trees_.make(v);
    for (Index f = 0; f < piece.surface.face_count(); ++f) sheets_.make(f);
  }

  void unmark() {
    join();
    anchor();
    const std::vector<Index> kept = longest_trees();
    for (Index h = 0; h < size_of(marks_); ++h) {
      if (!marks_[h] || surface_.twin[h] == kNone) continue;
      const Index tree = trees_.root(surface_.origin(h));
      if (!is_anchored_[tree] && kept[sheets_.root(h / 3)] != tree) marks_[h] = false;
    }
  }

 private:
  /// Vertices over seams, and faces over all edges; an edge that closes a loop anchors its seam,
  /// and so does one that had to be opened.
  void join() {
    for (Index h = 0; h < size_of(marks_); ++h) {
      const Index twin = surface_.twin[h];
      if (twin == kNone || h > twin) continue;
      sheets_.unite(h / 3, twin / 3);
      if (!marks_[h]) continue;
      const Index a = trees_.root(surface_.origin(h)), b = trees_.root(surface_.target(h));
      const bool anchored = a == b || opened_[h] || is_anchored_[a] || is_anchored_[b];
      const Index own = standing_[h] ? surface_.face_count() : 1;  // outweighs new ones
      const std::int64_t edges = edges_[a] + (a == b ? 0 : edges_[b]) + own;
      trees_.unite(a, b);
      is_anchored_[trees_.root(a)] = anchored;
      edges_[trees_.root(a)] = edges;
    }
  }

  void anchor() {
    has_border_.assign(surface_.faces.size(), false);
    for (Index h = 0; h < size_of(marks_); ++h) {
      if (surface_.twin[h] != kNone) continue;
      has_border_[sheets_.root(h / 3)] = true;
      is_anchored_[trees_.root(surface_.origin(h))] = true;
      is_anchored_[trees_.root(surface_.target(h))] = true;
    }
    for (Index h = 0; h < size_of(marks_); ++h) {
      if (marks_[h] && is_anchored_[trees_.root(surface_.origin(h))]) {
        has_border_[sheets_.root(h / 3)] = true;
      }
    }
  }

  /// Per sheet without another border the seam of most edges, by which it may open: two at least.
  std::vector<Index> longest_trees() {
    std::vector<Index> longest(surface_.faces.size(), kNone);
    for (Index h = 0; h < size_of(marks_); ++h) {
      if (!marks_[h]) continue;
      const Index tree = trees_.root(surface_.origin(h)), sheet = sheets_.root(h / 3);
      if (has_border_[sheet] || edges_[tree] < 2) continue;
      if (longest[sheet] == kNone || edges_[tree] > edges_[longest[sheet]]) longest[sheet] = tree;
    }
    return longest;
  }

  const Surface& surface_;
  const EdgeMarks &opened_, &standing_;
  EdgeMarks& marks_;
  DisjointSets trees_, sheets_;
  std::vector<std::int64_t> edges_;  // per tree
  std::vector<bool> is_anchored_, has_border_;
};

/// Adds the charts of one component.
void open(const SurfacePiece& piece, const Work& work, Recut& result) {
  OpenedSurface made = piece.topology.components[0].is_disk()
                           ? open_along(piece, EdgeMarks(piece.surface.twin.size(), false), work)
                           : open_short(piece, work);
  for (Index h = 0; h < 3 * piece.real_faces; ++h) {
    if (made.seams[h] && piece.surface.twin[h] != kNone) {
      result.opened.push_back(3 * piece.face[h / 3] + h % 3);
    }
  }
  for (AtlasChart& chart : made.charts) {
    scale_by_power(-piece.exponent, chart.chart.mesh.positions);
    result.charts.push_back(std::move(chart));
  }
}

}  // namespace

Recut recut(const Ground& ground, const std::vector<Index>& faces, const EdgeMarks& seams,
            const EdgeMarks& opened, const EdgeMarks& standing, const Work& work) {
  SurfacePiece piece = piece_of(ground, faces);
  EdgeMarks marks = marks_on(piece, seams);
  const EdgeMarks given = marks, before = marks_on(piece, opened);
  for (std::size_t h = 0; h < marks.size(); ++h) {
    if (before[h]) marks[h] = true;
  }
  Waiting(piece, before, marks_on(piece, standing), marks).unmark();
  Recut result;
  for (Index h = 0; h < size_of(marks); ++h) {
    if (marks[h] && !given[h] && piece.surface.twin[h] != kNone) {
      result.opened.push_back(3 * piece.face[h / 3] + h % 3);
    }
  }
  SurfacePiece parted = parted_along(piece, marks, ground.fill_limit, work);
  for (const SurfacePiece& component : components_of(std::move(parted), work)) {
    open(component, work, result);
  }
  std::map<Index, AtlasChart> by_first_face;
  for (AtlasChart& chart : result.charts) {
    by_first_face.emplace(first_input_face(chart, ground.admitted), std::move(chart));
  }
  result.charts.clear();
  for (auto& [first, chart] : by_first_face) result.charts.push_back(std::move(chart));
  return result;
}

}  // namespace beltrami
