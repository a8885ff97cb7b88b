#include "atlas/straighten_charts.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "atlas/open.h"
#include "atlas/quad_grid.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "base/types.h"
#include "base/vectors.h"
#include "chart/flattening.h"
#include "exact/certificate.h"
#include "mesh/disk_mesh.h"
#include "pins/hold.h"
#include "pins/straight.h"

namespace beltrami {
namespace {

using Ends = std::pair<Index, Index>;

Ends in_order(Index a, Index b) {
  return {std::min(a, b), std::max(a, b)};
}

Element vertex(Index v) {
  return Element::vertex(static_cast<std::uint64_t>(v));
}

/// The vertex of the input that a vertex of a chart is.
Index input_vertex(const AtlasChart& part, const Admitted& admitted, Index v) {
  return admitted.input_vertex[part.chart.input_vertex[v]];
}

/// The edges of one kind in a chart, as paths.
class PathFinder {
 public:
  PathFinder(const AtlasChart& part, const Admitted& admitted) : part_(part), admitted_(admitted) {}

  void add(Index a, Index b) {
    beside_[a].push_back(b);
    beside_[b].push_back(a);
  }

  /// From their ends with the lesser number.
  void take_paths(PinKind kind, std::vector<StraightPath>& paths) {
    for (const auto& [v, others] : beside_) {
      if (others.size() > 2) refuse(v, "branch");
    }
    std::size_t visited = 0;
    std::map<Index, bool> done;
    for (const auto& [v, others] : beside_) {
      if (others.size() != 1 || done[v]) continue;
      StraightPath path{kind, {v}};
      Index before = kNone, at = v;
      for (bool more = true; more;) {
        done[at] = true;
        more = false;
        for (const Index next : beside_.at(at)) {
          if (next == before || more) continue;
          path.vertices.push_back(next);
          more = true;
        }
        before = at;
        at = path.vertices.back();
      }
      visited += path.vertices.size();
      paths.push_back(std::move(path));
    }
    if (visited == beside_.size()) return;
    for (const auto& [v, others] : beside_) {
      if (!done[v]) refuse(v, "form a loop");
    }
  }

 private:
  [[noreturn]] void refuse(Index v, const std::string& what) const {
    const Index input = input_vertex(part_, admitted_, v);
    throw Error(Fault::kInvalidArgument,
                "the straight edges " + what + " at vertex " + std::to_string(input) +
                    ", where a line does not: leave one of them out",
                vertex(input));
  }

  const AtlasChart& part_;
  const Admitted& admitted_;
  std::map<Index, std::vector<Index>> beside_;
};

class Straightening {
 public:
  Straightening(const AtlasInput& input, const Admitted& admitted, const AtlasOptions& options,
                const Work& work, MappedSurface& mapped)
      : input_(input), admitted_(admitted), options_(options), work_(work), mapped_(mapped) {
    for (Index i = 0; i < size_of(input.straight); ++i) {
      const StraightEdge& edge = input.straight[i];
      std::vector<Index>& same =
          asked_[in_order(admitted.welded(edge.from), admitted.welded(edge.to))];
      if (!same.empty() && input.straight[same.front()].kind != edge.kind) {
        throw Error(Fault::kInvalidArgument,
                    "straight edges " + std::to_string(same.front()) + " and " + std::to_string(i) +
                        " are the same edge, and it is to lie along two directions: leave one out",
                    vertex(edge.from));
      }
      same.push_back(i);
    }
    found_.assign(input.straight.size(), false);
    rectangle_of_.assign(mapped.charts.size(), kNone);
  }

  void run() {
    find_rectangles();
    for (Index c = 0; c < size_of(mapped_.charts); ++c) straighten_chart(c);
    for (Index i = 0; i < size_of(found_); ++i) {
      if (found_[i]) continue;
      const auto& [from, to, kind] = input_.straight[i];
      throw Error(Fault::kInvalidArgument,
                  "straight edge " + std::to_string(i) + " joins vertices " + std::to_string(from) +
                      " and " + std::to_string(to) +
                      ", which no face has side by side: leave it out",
                  vertex(from));
    }
  }

 private:
  /// The first rectangle that is asked of each chart.
  void find_rectangles() {
    if (input_.rectangles.empty()) return;
    std::vector<Index> chart_of(input_.faces.size(), kNone);
    for (Index c = 0; c < size_of(mapped_.charts); ++c) {
      const AtlasChart& part = mapped_.charts[c];
      for (Index f = 0; f < part.real_faces; ++f) {
        chart_of[admitted_.input_face[part.chart.input_face[f]]] = c;
      }
    }
    for (Index r = 0; r < size_of(input_.rectangles); ++r) {
      const Index chart = chart_of[input_.rectangles[r].face];
      if (chart == kNone) {
        refuse(input_.rectangles[r],
               "no chart has it, since it has no area or lies on another: name one beside it");
      }
      if (rectangle_of_[chart] == kNone) rectangle_of_[chart] = r;
    }
  }

  [[noreturn]] static void refuse(const ChartRectangle& rectangle, const std::string& why) {
    throw Error(Fault::kPins,
                "the chart of face " + std::to_string(rectangle.of_caller) +
                    " cannot become a rectangle: " + why,
                Element::face(static_cast<std::uint64_t>(rectangle.of_caller)));
  }

  void straighten_chart(Index c) {
    const AtlasChart& part = mapped_.charts[c];
    const std::vector<StraightPath> paths = paths_of(part);
    const Index rectangle = rectangle_of_[c];
    if (mapped_.maps[c].error) return;  // it is named as it is
    if (rectangle != kNone) {
      make_rectangle(c, input_.rectangles[rectangle]);
    } else if (!paths.empty()) {
      make_straight(c, paths);
    } else if (options_.rectify_grids && !mapped_.maps[c].pinned()) {
      if (auto grid = grid_map(part, admitted_, options_.admit.polygons.polygon))
        take(c, *std::move(grid));
    }
  }

  std::vector<StraightPath> paths_of(const AtlasChart& part) {
    std::vector<StraightPath> paths;
    if (asked_.empty()) return paths;
    const DiskMesh& mesh = part.chart.mesh;
    std::map<PinKind, PathFinder> finders;
    PollSometimes poll;
    for (Index h = 0; h < 3 * part.real_faces; ++h) {
      poll();
      const Index a = mesh.origin(h), b = mesh.target(h);
      const auto asked =
          asked_.find(in_order(input_vertex(part, admitted_, a), input_vertex(part, admitted_, b)));
      if (asked == asked_.end()) continue;
      for (const Index i : asked->second) found_[i] = true;
      if (mesh.edge(h) != h) continue;
      const PinKind kind = input_.straight[asked->second.front()].kind;
      finders.try_emplace(kind, part, admitted_).first->second.add(a, b);
    }
    for (auto& [kind, finder] : finders) finder.take_paths(kind, paths);
    return paths;
  }

  /// The chart, in the unit that its maps are made in.
  std::pair<DiskMesh, int> normalised(const AtlasChart& part) const {
    DiskMesh mesh = part.chart.mesh;
    const int exponent = normalise(mesh.positions, mesh.faces, work_).exponent;
    return {std::move(mesh), exponent};
  }

  std::array<Index, 4> corners_of(Index c, const ChartRectangle& rectangle) const {
    const AtlasChart& part = mapped_.charts[c];
    const DiskMesh& mesh = part.chart.mesh;
    if (!rectangle.corners) {
      const auto found = four_corners(mesh, mapped_.maps[c].uvs);
      if (!found) refuse(rectangle, "its border has no four clear corners: name them");
      return *found;
    }
    std::vector<std::size_t> places;
    for (const Index corner : *rectangle.corners) {
      std::size_t at = mesh.boundary.size();
      for (std::size_t i = 0; i < mesh.boundary.size(); ++i) {
        if (input_vertex(part, admitted_, mesh.boundary[i]) != admitted_.welded(corner)) continue;
        if (at != mesh.boundary.size()) {
          refuse(rectangle, "its border passes vertex " + std::to_string(corner) +
                                " twice: name another corner");
        }
        at = i;
      }
      if (at == mesh.boundary.size()) {
        refuse(rectangle,
               "vertex " + std::to_string(corner) + " is not on its border: name one that is");
      }
      places.push_back(at);
    }
    std::sort(places.begin(), places.end());
    if (std::adjacent_find(places.begin(), places.end()) != places.end()) {
      refuse(rectangle, "a corner is named twice: name four");
    }
    std::array<Index, 4> corners{};
    for (int k = 0; k < 4; ++k) corners[k] = mesh.boundary[places[k]];
    return corners;
  }

  void make_rectangle(Index c, const ChartRectangle& rectangle) {
    require_no_pins(c, "a rectangle");
    const AtlasChart& part = mapped_.charts[c];
    if (!rectangle.corners) {
      if (auto grid = grid_map(part, admitted_, options_.admit.polygons.polygon)) {
        take(c, *std::move(grid));
        return;
      }
    }
    const std::array<Index, 4> corners = corners_of(c, rectangle);
    const auto [mesh, exponent] = normalised(part);
    StraightMap map = to_rectangle(mesh, corners, options_.chart, work_);
    if (!take(c, exponent, std::move(map))) {
      refuse(rectangle, "no way was found without folding a face: name other corners");
    }
  }

  void make_straight(Index c, const std::vector<StraightPath>& paths) {
    require_no_pins(c, "straight edges");
    const auto [mesh, exponent] = normalised(mapped_.charts[c]);
    std::vector<Vec2> start = mapped_.maps[c].uvs;
    scale_by_power(exponent, start);
    StraightMap map = straighten(mesh, start, paths, options_.chart, work_);
    const auto is_along_axis = [](const StraightPath& path) {
      return path.kind == PinKind::kU || path.kind == PinKind::kV;
    };
    // A quarter turn would make one V of one U.
    const bool is_any = std::any_of(paths.begin(), paths.end(), is_along_axis);
    if (take(c, exponent, std::move(map), is_any ? 2 : 4)) return;
    const Index input = input_vertex(mapped_.charts[c], admitted_, paths.front().vertices.front());
    throw Error(Fault::kPins,
                "the straight edges at vertex " + std::to_string(input) +
                    " cannot be straight together with the others of their chart: no way was "
                    "found without folding a face, so leave some out",
                vertex(input));
  }

  void require_no_pins(Index c, const std::string& what) const {
    if (!mapped_.maps[c].pinned()) return;
    throw Error(Fault::kInvalidArgument, "a chart that has pins is to have " + what +
                                             " as well: give that chart one of both");
  }

  /// Whether the map is injective.
  bool take(Index c, int exponent, StraightMap map, int own_turns = 4) {
    if (map.uvs.empty()) return false;
    scale_by_power(-exponent, map.uvs);
    if (!take(c, std::move(map.uvs), own_turns)) return false;
    if (!map.converged) mapped_.maps[c].outcome = Outcome::kNotConverged;
    return true;
  }

  bool take(Index c, std::vector<Vec2> uvs, int own_turns = 4) {
    const DiskMesh& mesh = mapped_.charts[c].chart.mesh;
    if (!certify(mesh.faces, mesh.boundary, uvs, work_).injective()) return false;
    mapped_.maps[c].uvs = std::move(uvs);
    mapped_.maps[c].outcome = Outcome::kOk;
    mapped_.maps[c].own_turns = own_turns;
    return true;
  }

  const AtlasInput& input_;
  const Admitted& admitted_;
  const AtlasOptions& options_;
  const Work& work_;
  MappedSurface& mapped_;
  std::map<Ends, std::vector<Index>> asked_;  // by welded vertices
  std::vector<bool> found_;                   // per straight edge
  std::vector<Index> rectangle_of_;           // per chart, or kNone
};

}  // namespace

bool asks_for_straight(const AtlasInput& input, const AtlasOptions& options) {
  return !input.straight.empty() || !input.rectangles.empty() || options.rectify_grids;
}

void straighten_charts(const AtlasInput& input, const Admitted& admitted,
                       const AtlasOptions& options, const Work& work, MappedSurface& mapped) {
  Straightening(input, admitted, options, work, mapped).run();
}

}  // namespace beltrami
