#include "cut/unfold.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "base/interrupt.h"
#include "base/portable_math.h"
#include "base/types.h"
#include "base/vectors.h"
#include "cut/creases.h"
#include "exact/box_tree.h"

namespace beltrami {
namespace {

/// Between normals, in radians: 30 degrees, where artists and exporters take an edge for sharp.
constexpr double kCrease = std::numbers::pi / 6;
/// The sum of the angles that vertices between creases lack or have in excess of 2 pi, in radians:
/// three quarters of a sphere. It spares other surfaces the maps, which judge what is left. Of 74
/// files as people have them, those that unfold have up to 6.3, and most others 10 and more.
constexpr double kMostCurved = 3 * std::numbers::pi;
/// How far two sides of a crease may be from one another when laid together, over its length. Those
/// of flat faces fit to rounding; an arc of 30 degrees is off by .04 from a straight line as long.
constexpr double kFit = 0.01;
/// How deep two triangles may lie on one another, over the root of the area of the surface, where
/// they only touch: well above rounding, and below what is seen.
constexpr double kTouch = 1e-4;

/// Boxes and faces that may be looked at, per chart and per face of the surface, before no more
/// charts are joined: so joining takes time in proportion to the surface, whatever its shape. A
/// sheet of n charts that grows by one at a time takes n / 2 boxes a chart.
constexpr std::int64_t kLooksOfChart = 500, kLooksOfFace = 20;

/// Turns and shifts the plane.
struct Motion {
  Vec2 turn = {1, 0};  ///< cosine and sine
  Vec2 shift = {0, 0};

  Vec2 rotated(const Vec2& p) const {
    return {turn.x() * p.x() - turn.y() * p.y(), turn.y() * p.x() + turn.x() * p.y()};
  }
  Vec2 operator()(const Vec2& p) const { return rotated(p) + shift; }
  Motion after(const Motion& first) const { return {rotated(first.turn), (*this)(first.shift)}; }
};

/// The motion that brings the second points nearest to the first, in the sense of least squares.
Motion motion_onto(const std::vector<Vec2>& to, const std::vector<Vec2>& from) {
  Vec2 to_centre = Vec2::Zero(), from_centre = Vec2::Zero();
  for (const Vec2& p : to) to_centre += p / static_cast<double>(to.size());
  for (const Vec2& p : from) from_centre += p / static_cast<double>(from.size());
  Vec2 sum = Vec2::Zero();
  for (std::size_t i = 0; i < to.size(); ++i) {
    const Vec2 p = to[i] - to_centre, q = from[i] - from_centre;
    sum += Vec2(q.dot(p), q.x() * p.y() - q.y() * p.x());
  }
  Motion motion;
  const double length = portable::hypot(sum.x(), sum.y());
  if (length > 0) motion.turn = sum / length;
  motion.shift = to_centre - motion.rotated(from_centre);
  return motion;
}

using Corners = std::array<Vec2, 3>;

/// Whether an edge of the first triangle has the second one on its other side, but for a touch.
bool separates(const Corners& one, const Corners& other) {
  for (int k = 0; k < 3; ++k) {
    const Vec2 edge = one[(k + 1) % 3] - one[k];
    const double length = std::sqrt(edge.squaredNorm());
    double deepest = 0;
    for (const Vec2& p : other) {
      const Vec2 to = p - one[k];
      deepest = std::max(deepest, edge.x() * to.y() - edge.y() * to.x());
    }
    if (deepest <= kTouch * length) return true;
  }
  return false;
}

bool overlap(const Corners& one, const Corners& other) {
  return !separates(one, other) && !separates(other, one);
}

Box2 box_of(const Corners& corners) {
  Box2 box;
  for (const Vec2& p : corners) box.extend(p);
  return box;
}

/// A crease between two charts: the half-edges of one side, in their order, and its length.
struct Crease {
  std::vector<Index> side;
  double length = 0;
};

/// The charts between creases, laid out: each in the plane of its sheet.
class Layout {
 public:
  /// Keeps references.
  Layout(const Surface& surface, const EdgeMarks& marks, const std::vector<Corners>& corners)
      : surface_(surface), marks_(marks), corners_(corners) {
    label_charts();
    looks_left_ = kLooksOfChart * size_of(faces_) + kLooksOfFace * surface.face_count();
    place_.resize(faces_.size());
    sheet_of_.resize(faces_.size());
    std::iota(sheet_of_.begin(), sheet_of_.end(), 0);
    for (Index c = 0; c < size_of(faces_); ++c) {
      charts_.push_back({c});
      std::vector<Box2> boxes;
      for (const Index f : faces_[c]) boxes.push_back(box_of(corners_[f]));
      trees_.emplace_back(boxes);
      boxes_.emplace_back();
      for (const Box2& box : boxes) boxes_.back().extend(box);
    }
  }

  /// Every crease between two charts once, the longest first.
  std::vector<Crease> creases() const {
    std::vector<Crease> all;
    PollSometimes poll;
    for (Index h = 0; h < size_of(surface_.twin); ++h) {
      poll();
      if (!marks_[h] || surface_.twin[h] == kNone || is_continued(h)) continue;
      const Index own = chart_of(h), beyond = chart_of(surface_.twin[h]);
      if (own >= beyond) continue;
      Crease crease;
      Index last = h;
      for (Index i = h; last != kNone; i = next_on_border(i)) {
        crease.side.push_back(i);
        crease.length += length_of(i);
        last = continues(i) ? i : kNone;
      }
      all.push_back(std::move(crease));
    }
    std::stable_sort(all.begin(), all.end(),
                     [](const Crease& a, const Crease& b) { return a.length > b.length; });
    return all;
  }

  /// Lays the sheets on both sides of a crease together, if they fit.
  bool join(const Crease& crease) {
    Index one = sheet_at(crease.side.front()), other = sheet_beyond(crease.side.front());
    if (one == other || looks_left_ <= 0) return false;
    const auto [to, from] = sides_of(crease);
    Motion motion = motion_onto(to, from);
    if (!fits(to, from, motion, crease.length)) return false;
    if (charts_[one].size() < charts_[other].size()) {
      std::swap(one, other);
      motion = motion_onto(from, to);
    }
    for (const Index moved : charts_[other]) {
      const Motion place = motion.after(place_[moved]);
      for (const Index still : charts_[one]) {
        if (lie_on_each_other(moved, place, still)) return false;
      }
    }
    for (const Index moved : charts_[other]) {
      place_[moved] = motion.after(place_[moved]);
      sheet_of_[moved] = one;
      charts_[one].push_back(moved);
    }
    charts_[other].clear();
    return true;
  }

  /// Whether the two sides of a crease lie together in one sheet as they are.
  bool is_closed(const Crease& crease) const {
    if (sheet_at(crease.side.front()) != sheet_beyond(crease.side.front())) return false;
    const auto [to, from] = sides_of(crease);
    return fits(to, from, {}, crease.length);
  }

 private:
  void label_charts() {
    chart_of_face_.assign(surface_.faces.size(), kNone);
    PollSometimes poll;
    for (Index seed = 0; seed < surface_.face_count(); ++seed) {
      if (chart_of_face_[seed] != kNone) continue;
      const Index chart = size_of(faces_);
      chart_of_face_[seed] = chart;
      std::vector<Index>& faces = faces_.emplace_back(1, seed);
      for (std::size_t i = 0; i < faces.size(); ++i) {
        poll();
        for (Index h = 3 * faces[i]; h < 3 * faces[i] + 3; ++h) {
          const Index beyond =
              marks_[h] || surface_.twin[h] == kNone ? kNone : surface_.twin[h] / 3;
          if (beyond == kNone || chart_of_face_[beyond] != kNone) continue;
          chart_of_face_[beyond] = chart;
          faces.push_back(beyond);
        }
      }
    }
  }

  Index chart_of(Index h) const { return chart_of_face_[h / 3]; }
  Index sheet_at(Index h) const { return sheet_of_[chart_of(h)]; }
  Index sheet_beyond(Index h) const { return sheet_at(surface_.twin[h]); }
  Vec2 uv(Index h) const { return place_[chart_of(h)](corners_[h / 3][h % 3]); }

  double length_of(Index h) const {
    return std::sqrt(
        (surface_.positions[surface_.target(h)] - surface_.positions[surface_.origin(h)])
            .squaredNorm());
  }

  /// The half-edge of the border of its chart that starts where one of them ends.
  Index next_on_border(Index h) const {
    Index next = Surface::next(h);
    while (!marks_[next] && surface_.twin[next] != kNone) {
      next = Surface::next(surface_.twin[next]);
    }
    return next;
  }

  /// Whether the crease goes on beyond the end of one of its half-edges: no other ends there.
  bool continues(Index h) const {
    const Index next = next_on_border(h);
    return surface_.twin[next] != kNone && next_on_border(surface_.twin[next]) == surface_.twin[h];
  }

  /// Whether the crease came from before the start of one of its half-edges.
  bool is_continued(Index h) const {
    const Index before = surface_.twin[next_on_border(surface_.twin[h])];
    return before != kNone && continues(before);
  }

  /// The points of both sides in the planes of their sheets.
  std::array<std::vector<Vec2>, 2> sides_of(const Crease& crease) const {
    std::array<std::vector<Vec2>, 2> sides;
    for (const Index h : crease.side) {
      sides[0].push_back(uv(h));
      sides[1].push_back(uv(Surface::next(surface_.twin[h])));
    }
    sides[0].push_back(uv(Surface::next(crease.side.back())));
    sides[1].push_back(uv(surface_.twin[crease.side.back()]));
    return sides;
  }

  static bool fits(const std::vector<Vec2>& to, const std::vector<Vec2>& from, const Motion& motion,
                   double length) {
    const double most = kFit * length;
    for (std::size_t i = 0; i < to.size(); ++i) {
      if ((to[i] - motion(from[i])).squaredNorm() > most * most) return false;
    }
    return true;
  }

  bool lie_on_each_other(Index moved, const Motion& place, Index still) {
    poll_();
    --looks_left_;
    // In the frame of the one that stays, where its tree is.
    const Motion& frame = place_[still];
    const Motion back = {{frame.turn.x(), -frame.turn.y()}, {0, 0}};
    const Motion into = Motion{back.turn, -back.rotated(frame.shift)}.after(place);
    const auto moved_box = [&](const Box2& box) {
      Box2 all;
      for (const auto corner :
           {Box2::BottomLeft, Box2::BottomRight, Box2::TopLeft, Box2::TopRight}) {
        all.extend(into(box.corner(corner)));
      }
      return all;
    };
    if (!boxes_[still].intersects(moved_box(boxes_[moved]))) return false;
    looks_left_ -= size_of(faces_[moved]);
    for (const Index f : faces_[moved]) {
      Corners corners;
      for (int k = 0; k < 3; ++k) corners[k] = into(corners_[f][k]);
      const bool is_free = trees_[still].for_each_near(
          box_of(corners), [] { return true; },
          [&](Index item) { return !overlap(corners, corners_[faces_[still][item]]); });
      if (!is_free) return true;
    }
    return false;
  }

  const Surface& surface_;
  const EdgeMarks& marks_;
  const std::vector<Corners>& corners_;
  std::vector<Index> chart_of_face_;
  std::vector<std::vector<Index>> faces_;   // per chart
  std::vector<BoxTree> trees_;              // per chart, over its faces as they were mapped
  std::vector<Box2> boxes_;                 // per chart
  std::vector<Motion> place_;               // per chart
  std::vector<Index> sheet_of_;             // per chart
  std::vector<std::vector<Index>> charts_;  // per sheet
  std::int64_t looks_left_ = 0;
  PollSometimes poll_;
};

/// Creases but for those that part nothing; empty where there are none.
EdgeMarks marked_creases(const Surface& surface, const EdgeMarks& locked) {
  const double cosine = portable::cos(kCrease);
  EdgeMarks marks(surface.twin.size(), false);
  PollSometimes poll;
  bool is_any = false;
  for (Index h = 0; h < size_of(surface.twin); ++h) {
    poll();
    if (surface.twin[h] == kNone || surface.edge(h) != h || (!locked.empty() && locked[h]))
      continue;
    if (!is_crease(surface, h, cosine)) continue;
    mark_edge(surface, h, marks);
    is_any = true;
  }
  if (!is_any) return {};
  const EdgeMarks creases = marks;
  drop_slits(surface, creases, marks);
  return marks;
}

double angle_at(const Surface& surface, Index h) {
  const Vec3& p = surface.positions[surface.origin(h)];
  const Vec3 a = surface.positions[surface.target(h)] - p;
  const Vec3 b = surface.positions[surface.origin(Surface::previous(h))] - p;
  return portable::atan2(std::sqrt(a.cross(b).squaredNorm()), a.dot(b));
}

/// Whether the surface is curved between the marks by more than what developable faces may be.
bool is_curved(const Surface& surface, const EdgeMarks& marks) {
  std::vector<bool> on_mark(surface.positions.size(), false);
  for (Index h = 0; h < size_of(marks); ++h) {
    if (marks[h]) on_mark[surface.origin(h)] = true;
  }
  double curved = 0;
  PollSometimes poll;
  for (Index v = 0; v < surface.vertex_count(); ++v) {
    poll();
    if (on_mark[v] || surface.on_boundary[v] || surface.outgoing[v] == kNone) continue;
    double around = 0;
    surface.for_each_outgoing(v, [&](Index h) { around += angle_at(surface, h); });
    curved += std::abs(2 * std::numbers::pi - around);
    if (curved > kMostCurved) return true;
  }
  return false;
}

void unmark(const Surface& surface, const Crease& crease, EdgeMarks& marks) {
  for (const Index h : crease.side) marks[h] = marks[surface.twin[h]] = false;
}

/// Takes back the marks of creases whose sides lie together, from an end where no other mark is.
void close_slits(const Surface& surface, const Layout& layout, const std::vector<Crease>& creases,
                 EdgeMarks& marks) {
  std::vector<Index> ends(surface.positions.size(), 0);  // half-edges of marks that start there
  for (Index h = 0; h < size_of(marks); ++h) ends[surface.origin(h)] += marks[h] ? 1 : 0;
  const auto is_tip = [&](Index v) { return ends[v] == 1 && !surface.on_boundary[v]; };
  const auto ends_of_crease = [&](const Crease& crease) {
    return std::array{surface.origin(crease.side.front()), surface.target(crease.side.back())};
  };
  std::vector<std::pair<Index, Index>> at;  // vertices, and creases that end there
  std::vector<Index> tips;
  for (Index c = 0; c < size_of(creases); ++c) {
    if (!marks[creases[c].side.front()] || !layout.is_closed(creases[c])) continue;
    for (const Index v : ends_of_crease(creases[c])) {
      at.emplace_back(v, c);
      if (is_tip(v)) tips.push_back(v);
    }
  }
  std::sort(at.begin(), at.end());
  PollSometimes poll;
  while (!tips.empty()) {
    poll();
    const Index tip = tips.back();
    tips.pop_back();
    auto next = std::lower_bound(at.begin(), at.end(), std::pair(tip, Index{0}));
    for (; next != at.end() && next->first == tip; ++next) {
      const Crease& crease = creases[next->second];
      if (!marks[crease.side.front()] || !is_tip(tip)) continue;
      unmark(surface, crease, marks);
      for (const Index h : crease.side) {
        --ends[surface.origin(h)];
        --ends[surface.target(h)];
      }
      for (const Index v : ends_of_crease(crease)) {
        if (is_tip(v)) tips.push_back(v);
      }
    }
  }
}

}  // namespace

EdgeMarks creases_of(const Surface& surface, const EdgeMarks& locked) {
  EdgeMarks marks = marked_creases(surface, locked);
  if (marks.empty() || is_curved(surface, marks)) return {};
  return marks;
}

EdgeMarks unfolded(const Surface& surface, EdgeMarks marks, const EdgeMarks& held,
                   const std::vector<std::array<Vec2, 3>>& corners) {
  const EdgeMarks all = marks;
  Layout layout(surface, all, corners);
  std::vector<Crease> creases = layout.creases();
  std::erase_if(creases, [&](const Crease& crease) { return held[crease.side.front()]; });
  for (const Crease& crease : creases) {
    if (layout.join(crease)) unmark(surface, crease, marks);
  }
  close_slits(surface, layout, creases, marks);
  return marks;
}

}  // namespace beltrami
