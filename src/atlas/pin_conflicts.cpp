#include "atlas/pin_conflicts.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <tuple>
#include <utility>

#include "base/interrupt.h"
#include "base/vectors.h"
#include "exact/box_tree.h"
#include "exact/crossings.h"
#include "exact/orientation.h"
#include "mesh/disk_mesh.h"
#include "pins/hold.h"

namespace beltrami {
namespace {

constexpr Index kUnpinned = -1;

/// A boundary edge with two pinned ends; `pin`: the later one.
struct PinnedEdge {
  Index from, to, pin;
};

class Conflicts {
 public:
  Conflicts(const AtlasChart& part, const std::vector<ChartPin>& pins, const std::vector<Pin>& all)
      : part_(part),
        mesh_(part.chart.mesh),
        pins_(pins),
        all_(all),
        pin_of_(mesh_.positions.size(), kUnpinned),
        places_(mesh_.positions.size(), Vec2::Zero()),
        inside_(mesh_.positions.size()) {
    for (std::size_t v = 0; v < inside_.size(); ++v) inside_[v] = !mesh_.on_boundary[v];
    for (Index f = part.real_faces; f < mesh_.face_count(); ++f) {
      for (const Index v : mesh_.faces[f]) inside_[v] = false;
    }
    for (const ChartPin& pin : pins) {
      pin_of_[pin.vertex] = pin.pin;
      places_[pin.vertex] = pin.place;
    }
  }

  std::optional<PinConflict> find() {
    coinciding_vertices();
    faces();
    boundary();
    return first_;
  }

 private:
  bool pinned(Index v) const { return pin_of_[v] != kUnpinned; }
  Index later(Index v, Index w) const { return std::max(pin_of_[v], pin_of_[w]); }
  std::string name(Index v) const { return name_of(all_[pin_of_[v]]); }

  void add(Index pin, const std::string& why) {
    if (!first_ || pin < first_->pin) first_ = {pin, why};
  }

  /// Vertices of the boundary may touch, but not along an edge.
  void coinciding_vertices() {
    std::vector<ChartPin> sorted = pins_;
    const auto key = [](const ChartPin& pin) {
      return std::tuple(pin.place.x(), pin.place.y(), pin.pin);
    };
    sort_interruptibly(sorted.begin(), sorted.end(),
                       [&](const ChartPin& a, const ChartPin& b) { return key(a) < key(b); });
    for (std::size_t i = 0, next = 0; i < sorted.size(); i = next) {
      Index inside = kNone;  // the last one that is
      for (next = i; next < sorted.size() && sorted[next].place == sorted[i].place; ++next) {
        const Index v = sorted[next].vertex, first = sorted[i].vertex;
        if (next > i && inside_[v]) coincide(first, v);
        if (next > i && !inside_[v] && inside != kNone) coincide(inside, v);
        if (inside_[v]) inside = v;
      }
    }
    for (Index h = 0; h < 3 * part_.real_faces; ++h) {
      const Index v = mesh_.origin(h), w = mesh_.target(h);
      if (pinned(v) && pinned(w) && places_[v] == places_[w]) coincide(v, w);
    }
  }

  void coincide(Index v, Index w) {
    if (pin_of_[v] > pin_of_[w]) std::swap(v, w);
    add(pin_of_[w], "cannot be met together with those before it: it has the place of " + name(v) +
                        ", which is of another vertex");
  }

  void faces() {
    PollSometimes poll;
    for (Index f = 0; f < part_.real_faces; ++f) {
      poll();
      const auto [a, b, c] = mesh_.faces[f];
      if (!pinned(a) || !pinned(b) || !pinned(c)) continue;
      const int sign = orientation(places_[a], places_[b], places_[c]);
      if (sign > 0) continue;
      std::array<Index, 3> corners = {a, b, c};
      std::sort(corners.begin(), corners.end(),
                [&](Index v, Index w) { return pin_of_[v] < pin_of_[w]; });
      add(pin_of_[corners[2]], "cannot be met together with those before it: with " +
                                   name(corners[0]) + " and " + name(corners[1]) +
                                   " it leaves a face " + (sign < 0 ? "turned over" : "no area"));
    }
  }

  void boundary() {
    const std::vector<Index>& loop = mesh_.boundary;
    std::vector<PinnedEdge> edges;
    Index last = kUnpinned;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Index v = loop[i], w = loop[i + 1 == loop.size() ? 0 : i + 1];
      if (pinned(v) && pinned(w)) edges.push_back({v, w, later(v, w)});
      last = std::max(last, pin_of_[v]);
    }
    crossing_edges(edges);
    if (edges.size() < loop.size() || (first_ && first_->pin <= last)) return;
    if (!is_simple(loop, places_)) return;
    const auto low = std::min_element(loop.begin(), loop.end(), [&](Index v, Index w) {
      return std::pair(places_[v].x(), places_[v].y()) < std::pair(places_[w].x(), places_[w].y());
    });
    const std::size_t at = static_cast<std::size_t>(low - loop.begin()), n = loop.size();
    if (orientation(places_[loop[(at + n - 1) % n]], places_[*low], places_[loop[(at + 1) % n]]) <
        0) {
      add(last,
          "cannot be met together with those before it: they have the boundary run clockwise "
          "around the surface, mirrored");
    }
  }

  /// Whether they cross in their insides: then the faces beside them overlap.
  bool cross(const PinnedEdge& e, const PinnedEdge& f) const {
    const Vec2 &a = places_[e.from], &b = places_[e.to], &c = places_[f.from], &d = places_[f.to];
    return orientation(a, b, c) * orientation(a, b, d) < 0 &&
           orientation(c, d, a) * orientation(c, d, b) < 0;
  }

  /// Two of them that cross, if they are found in n log n steps.
  std::optional<std::array<PinnedEdge, 2>> crossing(const std::vector<PinnedEdge>& edges) const {
    if (edges.size() < 2) return std::nullopt;
    std::vector<Box2> boxes;
    for (const PinnedEdge& e : edges) {
      Box2 box(places_[e.from]);
      boxes.push_back(box.extend(places_[e.to]));
    }
    BoxTree tree(boxes);
    ListingBounds bounds(size_of(edges));
    std::optional<std::array<PinnedEdge, 2>> found;
    for (std::size_t i = 0; i < edges.size() && !found; ++i) {
      const bool complete = tree.for_each_near(
          boxes[i], [&] { return bounds.look(); },
          [&](Index j) {
            if (cross(edges[i], edges[j])) found = {edges[i], edges[j]};
            return !found;
          });
      if (!complete) break;
    }
    return found;
  }

  /// The least pin up to which edges cross, by bisection.
  void crossing_edges(const std::vector<PinnedEdge>& edges) {
    const auto up_to = [&](Index pin) {
      std::vector<PinnedEdge> among;
      for (const PinnedEdge& e : edges) {
        if (e.pin <= pin) among.push_back(e);
      }
      return crossing(among);
    };
    auto found = crossing(edges);
    if (!found) return;
    Index low = kUnpinned;
    const auto last = [&] { return std::max((*found)[0].pin, (*found)[1].pin); };
    for (Index high = last(); high - low > 1; high = std::min(high, last())) {
      const Index middle = low + (high - low) / 2;
      if (auto earlier = up_to(middle)) {
        found = earlier;
      } else {
        low = middle;
      }
    }
    const auto& [e, f] = *found;
    const PinnedEdge& other = e.pin == last() ? f : e;
    add(last(),
        "cannot be met together with those before it: an edge of the boundary there would "
        "cross that between " +
            name(other.from) + " and " + name(other.to));
  }

  const AtlasChart& part_;
  const DiskMesh& mesh_;
  const std::vector<ChartPin>& pins_;
  const std::vector<Pin>& all_;
  std::vector<Index> pin_of_;  // per vertex
  std::vector<Vec2> places_;   // per vertex, of those pinned
  std::vector<bool> inside_;   // per vertex: faces of the surface all around it
  std::optional<PinConflict> first_;
};

}  // namespace

std::optional<PinConflict> find_conflict(const AtlasChart& part, const std::vector<ChartPin>& pins,
                                         const std::vector<Pin>& all) {
  std::vector<ChartPin> points;  // where others will lie is not known yet
  for (const ChartPin& pin : pins) {
    if (pin.kind == PinKind::kPoint) points.push_back(pin);
  }
  if (points.size() < 2) return std::nullopt;
  return Conflicts(part, points, all).find();
}

}  // namespace beltrami
