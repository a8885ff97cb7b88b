#include "cut/mirrored_seams.h"

#include <Eigen/Geometry>
#include <limits>
#include <utility>
#include <vector>

#include "base/interrupt.h"
#include "base/vectors.h"
#include "cut/across.h"
#include "cut/cut_into_charts.h"
#include "cut/open_minimal.h"
#include "cut/path_beside.h"

namespace beltrami {
namespace {

/// Runs of seams are mirrored so many edges at a time: between the ends a shortest path will do.
constexpr std::size_t kRun = 8;
/// Rings around the images of a run that the path may go through; more where there is no way.
constexpr int kNarrow = 1, kWide = 3;
/// A piece whose area is less than its border times so many lengths of edges was to be none.
constexpr double kNarrowPiece = 0.8;
/// A ring is opened beside the plane only where that is cheaper by more than that.
constexpr double kBesidePlane = 3;

class Mirroring {
 public:
  Mirroring(const Surface& surface, const Mirror& mirror, const AnchoredSeams& seams, int side,
            const std::vector<double>& cost)
      : surface_(surface),
        mirror_(mirror),
        before_(seams),
        side_(side),
        cost_(cost),
        degree_(surface.positions.size(), 0),
        marks_(surface.twin.size(), false),
        anchors_(surface.positions.size(), false) {}

  AnchoredSeams run() {
    for (Index h = 0; h < size_of(marks_); ++h) {
      const bool is_kept = on(surface_.origin(h)) >= 0 && on(surface_.target(h)) >= 0;
      if (before_.seams[h] && surface_.edge(h) == h && is_kept) mark(h);
    }
    const std::vector<std::vector<Index>> runs = runs_on_side();
    for (const std::vector<Index>& run : runs) {
      std::vector<Index> beside;
      for (const Index v : run) beside.push_back(mirrored(mirror_, v));
      add_beside(beside);
    }
    for (Index v = 0; v < surface_.vertex_count(); ++v) {
      if (crosses(v)) add_beside({mirrored(mirror_, v), v});
    }
    for (Index v = 0; v < size_of(anchors_); ++v) {
      if (!before_.anchors[v] || on(v) < 0) continue;
      anchors_[v] = anchors_[mirrored(mirror_, v)] = true;
    }
    return {std::move(marks_), std::move(anchors_)};
  }

 private:
  /// 1 on the side that is kept, 0 in the plane, -1 beyond.
  int on(Index v) const { return side_ * mirror_.side[v]; }
  bool is_kept(Index h) const { return marks_[h] && surface_.twin[h] != kNone; }
  void mark(Index h) {
    if (marks_[h]) return;
    mark_edge(surface_, h, marks_);
    ++degree_[surface_.origin(h)];
    ++degree_[surface_.target(h)];
  }

  std::vector<std::vector<Index>> runs_on_side() const;
  bool crosses(Index v) const;
  void add_beside(const std::vector<Index>& vertices);

  const Surface& surface_;
  const Mirror& mirror_;
  const AnchoredSeams& before_;
  int side_;
  const std::vector<double>& cost_;
  std::vector<Index> degree_;  ///< per vertex: seams at it
  EdgeMarks marks_;
  std::vector<bool> anchors_;
};

/// Whether a seam goes from there to beyond the plane at once.
bool Mirroring::crosses(Index v) const {
  if (on(v) <= 0 || surface_.outgoing[v] == kNone) return false;
  bool found = false;
  surface_.for_each_outgoing(
      v, [&](Index h) { found = found || (before_.seams[h] && on(surface_.target(h)) < 0); });
  return found;
}

/// The seams kept but for those in the plane, by vertices in order, no further than kRun edges and
/// the next node.
std::vector<std::vector<Index>> Mirroring::runs_on_side() const {
  std::vector<std::vector<Index>> runs;
  EdgeMarks taken(marks_.size(), false);
  const auto is_node = [&](Index v) {
    return degree_[v] != 2 || on(v) == 0 || surface_.on_boundary[v] || before_.anchors[v];
  };
  const auto is_open = [&](Index h) {
    return is_kept(h) && !taken[h] && (on(surface_.origin(h)) > 0 || on(surface_.target(h)) > 0);
  };
  const auto trace = [&](Index first) {
    std::vector<Index> run = {surface_.origin(first)};
    for (Index h = first; h != kNone;) {
      mark_edge(surface_, h, taken);
      const Index v = surface_.target(h);
      run.push_back(v);
      h = kNone;
      if (is_node(v) || run.size() > kRun) break;
      surface_.for_each_outgoing(v, [&](Index out) {
        if (is_open(out)) h = out;
      });
    }
    runs.push_back(std::move(run));
  };
  for (const bool is_loop : {false, true}) {  // loops without a node come last
    for (Index h = 0; h < size_of(marks_); ++h) {
      if (!is_open(h)) continue;
      Index v = surface_.origin(h);
      if (!is_loop && !is_node(v)) continue;
      for (Index next = h; next != kNone;) {  // the parts that it was broken into
        trace(next);
        v = runs.back().back();
        next = kNone;
        if (is_node(v)) break;
        surface_.for_each_outgoing(v, [&](Index out) {
          if (is_open(out)) next = out;
        });
      }
    }
  }
  return runs;
}

/// Marks a path beside the vertices, from the first to the last.
void Mirroring::add_beside(const std::vector<Index>& vertices) {
  poll_interrupt();
  const Index goal = vertices.back();
  if (vertices.front() == goal) return;
  PathRules rules;
  rules.ends = [&](Index v) { return v == goal; };
  rules.passes = [&](Index v) { return degree_[v] == 0 && !surface_.on_boundary[v] && on(v) <= 0; };
  std::vector<Index> path = path_beside(surface_, vertices, kNarrow, cost_, rules);
  if (path.empty()) {
    rules.passes = [&](Index v) { return !surface_.on_boundary[v]; };
    path = path_beside(surface_, vertices, kWide, cost_, rules);
  }
  for (const Index h : path) mark(h);
}

/// What the marks part the surface into.
struct Pieces {
  std::vector<Index> of_face;
  std::vector<double> area, border;  ///< of each; the border counts seams alone
};

Pieces pieces_of(const Surface& surface, const EdgeMarks& marks, const Work& work) {
  Surface parted = surface;
  for (std::size_t h = 0; h < marks.size(); ++h) {
    if (marks[h]) parted.twin[h] = kNone;
  }
  const std::vector<Index> least = connected_faces(parted, work);
  Pieces pieces;
  std::vector<Index> number(surface.faces.size(), kNone);
  const auto along = [&](Index h) {
    return Vec3(surface.positions[surface.target(h)] - surface.positions[surface.origin(h)]);
  };
  for (Index f = 0; f < surface.face_count(); ++f) {
    if (number[least[f]] == kNone) {
      number[least[f]] = size_of(pieces.area);
      pieces.area.push_back(0);
      pieces.border.push_back(0);
    }
    const Index piece = number[least[f]];
    pieces.of_face.push_back(piece);
    pieces.area[piece] += along(3 * f).cross(along(3 * f + 1)).norm() / 2;
    for (Index h = 3 * f; h < 3 * f + 3; ++h) {
      if (marks[h]) pieces.border[piece] += along(h).norm();
    }
  }
  return pieces;
}

/// The longest run of seams, half-edges in order, along which a piece meets another one.
std::vector<Index> longest_run(const Surface& surface, const EdgeMarks& marks, const Pieces& pieces,
                               Index piece) {
  const auto other = [&](Index h) {
    const Index twin = surface.twin[h];
    const bool parts = marks[h] && twin != kNone && pieces.of_face[h / 3] == piece;
    const Index beyond = parts ? pieces.of_face[twin / 3] : kNone;
    return beyond == piece ? kNone : beyond;
  };
  // Around the piece: the next half-edge of its border after one.
  const auto next = [&](Index h) {
    h = Surface::next(h);
    while (!marks[h] && surface.twin[h] != kNone) h = Surface::next(surface.twin[h]);
    return h;
  };
  std::vector<Index> longest;
  double most = 0;
  for (Index first = 0; first < size_of(marks); ++first) {
    if (other(first) == kNone) continue;
    std::vector<Index> run = {first};
    double length = 0;
    for (Index h = next(first); h != first && other(h) == other(first); h = next(h)) {
      run.push_back(h);
    }
    for (const Index h : run) {
      length +=
          (surface.positions[surface.target(h)] - surface.positions[surface.origin(h)]).norm();
    }
    if (length > most) {
      most = length;
      longest = std::move(run);
    }
  }
  return longest;
}

double mean_edge(const Surface& surface) {
  double sum = 0;
  for (Index h = 0; h < size_of(surface.twin); ++h) {
    sum += (surface.positions[surface.target(h)] - surface.positions[surface.origin(h)]).norm();
  }
  return sum / static_cast<double>(surface.twin.size());
}

/// Joins pieces that are narrower than edges are long to what they meet along most of their border.
void join_narrow(const Surface& surface, EdgeMarks& marks, const Work& work) {
  const double edge = mean_edge(surface);
  for (bool joined = true; joined;) {
    poll_interrupt();
    joined = false;
    const Pieces pieces = pieces_of(surface, marks, work);
    for (Index piece = 0; piece < size_of(pieces.area) && !joined; ++piece) {
      if (pieces.area[piece] > kNarrowPiece * edge * pieces.border[piece]) continue;
      for (const Index h : longest_run(surface, marks, pieces, piece)) {
        marks[h] = marks[surface.twin[h]] = false;
        joined = true;
      }
    }
  }
}

/// Takes back edges that join no other seam and no border: they part nothing, until one joins them.
void drop_alone(const Surface& surface, EdgeMarks& marks) {
  std::vector<Index> joined(surface.positions.size(), 0);
  for (Index h = 0; h < size_of(marks); ++h) {
    if (!marks[h] || surface.edge(h) != h) continue;
    ++joined[surface.origin(h)];
    ++joined[surface.target(h)];
  }
  const auto is_loose = [&](Index v) { return joined[v] == 1 && !surface.on_boundary[v]; };
  for (Index h = 0; h < size_of(marks); ++h) {
    if (is_loose(surface.origin(h)) && is_loose(surface.target(h))) marks[h] = false;
  }
}

/// Rings along the cheapest way across, for preference in the plane.
void open_rings(const Surface& surface, const Mirror& mirror, const std::vector<double>& cost,
                EdgeMarks& marks, const Work& work) {
  std::vector<double> near = cost;
  for (Index h = 0; h < size_of(near); ++h) {
    if (mirror.side[surface.origin(h)] != 0 || mirror.side[surface.target(h)] != 0) {
      near[h] *= kBesidePlane;
    }
  }
  const CutSurface cut = cut_into_charts(surface, marks, work);
  for (const NonDisk& piece : cut.non_disks) {
    if (piece.loops != 2 || piece.genus != 0) continue;
    std::vector<bool> is_on = surface.on_boundary;
    for (Index h = 0; h < size_of(marks); ++h) {
      if (marks[h]) is_on[surface.origin(h)] = is_on[surface.target(h)] = true;
    }
    Index side = 3 * piece.faces[0];
    for (std::size_t i = 1; !marks[side] && surface.twin[side] != kNone; ++i) {
      side = 3 * piece.faces[i / 3] + static_cast<Index>(i % 3);
    }
    constexpr double kAny = std::numeric_limits<double>::infinity();
    PathsAcross across(
        surface, marks, [&](Index v) { return is_on[v]; }, near);
    for (const Index h : across.from_loop(side, kAny)) {
      mark_edge(surface, h, marks);
    }
  }
}

}  // namespace

AnchoredSeams mirrored_seams(const Surface& surface, const Mirror& mirror,
                             const AnchoredSeams& seams, int side, const std::vector<double>& cost,
                             const EdgeMarks& locked, const Work& work) {
  AnchoredSeams mirrored = Mirroring(surface, mirror, seams, side, cost).run();
  join_narrow(surface, mirrored.seams, work);
  drop_alone(surface, mirrored.seams);
  open_rings(surface, mirror, cost, mirrored.seams, work);
  mirrored.seams = opened_further(surface, std::move(mirrored.seams), locked, work);
  return mirrored;
}

}  // namespace beltrami
