#include "pins/straight.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <tuple>
#include <utility>

#include "base/portable_math.h"
#include "exact/certificate.h"
#include "mesh/boundary.h"
#include "mesh/rest_shape.h"
#include "pins/pin_field.h"

namespace beltrami {
namespace {

/// How far the sides of a rectangle first stand out, of the shorter one: Tutte's embedding cannot
/// fold where no three places of the border are on a line.
constexpr double kBulge = 0.05;
/// The sides of a rectangle are fitted to its map, and the map to them, until they change by no
/// more than this share, but so often at most.
constexpr double kSameSides = 1e-3;
constexpr int kMostFits = 6;
/// What edges of a path keep of their length, at the least, where they go to the nearest places of
/// their line: the cosine of how much the path may turn away from it, 45 degrees.
constexpr double kLeastShadow = 0.7;
/// The sine of the angle below which lines have no crossing worth its name.
constexpr double kParallel = 1e-3;
/// The length of border on each side of a vertex that its turn is measured by, of all of it;
/// corners are further apart than twice that.
constexpr double kWindow = 1.0 / 48;
/// 1 minus the cosine of a turn: of the least corner (some 40 degrees), and the share of that of
/// the fourth corner which a fifth would have, for the four to be clear.
constexpr double kLeastCorner = 0.23, kClear = 0.75;

Vec2 turned(const Vec2& turn, const Vec2& w) {
  return {turn.x() * w.x() - turn.y() * w.y(), turn.y() * w.x() + turn.x() * w.y()};
}

/// The turn (cosine, sine) that brings the paths next to their axes, each counted by its length.
/// Directions are doubled: either way along an axis is right.
Vec2 turn_to_axes(const std::vector<Vec2>& uvs, const std::vector<StraightPath>& paths) {
  Vec2 sum = Vec2::Zero();
  for (const StraightPath& path : paths) {
    if (path.kind == PinKind::kLine) continue;
    const Vec2 chord = uvs[path.vertices.back()] - uvs[path.vertices.front()];
    const double length = chord.norm();
    if (!(length > 0)) continue;
    const Vec2 twice = turned(chord, chord) / length;  // its angle doubled, by its length
    sum += path.kind == PinKind::kV ? twice : Vec2(-twice);
  }
  const double length = portable::hypot(sum.x(), sum.y());
  if (!(length > 0)) return {1, 0};
  // Half of the angle, turned back.
  const double cosine = std::sqrt(std::max(0.0, 0.5 * (1 + sum.x() / length)));
  const double sine = std::sqrt(std::max(0.0, 0.5 * (1 - sum.x() / length)));
  return {cosine, sum.y() > 0 ? -sine : sine};
}

struct Line {
  PinKind kind;
  Vec2 place, along;

  Vec2 normal() const { return HeldVertex{0, place, kind, along}.normal(); }
  Vec2 direction() const { return {normal().y(), -normal().x()}; }
};

/// The line of a path: through its middle, by its lengths, and of kLine along its longer axis.
Line line_of(const std::vector<Vec2>& uvs, const StraightPath& path) {
  Vec2 middle = Vec2::Zero();
  double length = 0;
  for (std::size_t i = 1; i < path.vertices.size(); ++i) {
    const Vec2 &a = uvs[path.vertices[i - 1]], &b = uvs[path.vertices[i]];
    const double own = (b - a).norm();
    length += own;
    middle += 0.5 * own * (a + b);
  }
  middle = length > 0 ? Vec2(middle / length) : uvs[path.vertices.front()];
  double xx = 0, xy = 0, yy = 0;
  for (const Index v : path.vertices) {
    const Vec2 d = uvs[v] - middle;
    xx += d.x() * d.x();
    xy += d.x() * d.y();
    yy += d.y() * d.y();
  }
  // Half of the angle of (xx - yy, 2 xy).
  const double x = xx - yy, y = 2 * xy, size = portable::hypot(x, y);
  Vec2 along = uvs[path.vertices.back()] - uvs[path.vertices.front()];
  if (size > 0)
    along = {std::sqrt(0.5 * (1 + x / size)), std::sqrt(std::max(0.0, 0.5 * (1 - x / size)))};
  if (size > 0 && y < 0) along.y() = -along.y();
  if (along.isZero(0)) along = {1, 0};
  return {path.kind, middle, along};
}

/// Where two lines cross; nothing where they hardly do.
std::optional<Vec2> crossing(const Line& a, const Line& b) {
  const Vec2 m = a.normal(), n = b.normal();
  const double det = m.x() * n.y() - m.y() * n.x();
  if (std::abs(det) < kParallel) return std::nullopt;
  const double p = m.dot(a.place), q = n.dot(b.place);
  Vec2 place((p * n.y() - q * m.y()) / det, (m.x() * q - n.x() * p) / det);
  for (const Line* line : {&a, &b}) {  // to the bit
    if (line->kind == PinKind::kU) place.x() = line->place.x();
    if (line->kind == PinKind::kV) place.y() = line->place.y();
  }
  return place;
}

/// Per vertex of a path whether it is released.
std::vector<bool> released_of(const DiskMesh& mesh, const StraightPath& path) {
  std::vector<Index> rank(mesh.positions.size(), kNone);
  for (std::size_t i = 0; i < path.vertices.size(); ++i) {
    rank[path.vertices[i]] = static_cast<Index>(i);
  }
  std::vector<bool> released(path.vertices.size(), false);
  for (Index h = 0; h < size_of(mesh.twin); ++h) {
    const Index from = rank[mesh.origin(h)], to = rank[mesh.target(h)];
    if (from == kNone || to == kNone) continue;
    for (Index i = std::min(from, to) + 1; i < std::max(from, to); ++i) released[i] = true;
  }
  return released;
}

/// The pins of vertices that slide along their lines, one of each path.
class Rails {
 public:
  explicit Rails(const DiskMesh& mesh) : mesh_(mesh), pin_of_(mesh.positions.size(), kNone) {}

  /// Whether the line crosses those that its vertices have been put on.
  bool add(const StraightPath& path, const Line& line) {
    lines_.push_back({path, line});
    const std::vector<bool> released = released_of(mesh_, path);
    for (std::size_t i = 0; i < path.vertices.size(); ++i) {
      const Index v = path.vertices[i];
      if (released[i]) {
        ++released_;
        continue;
      }
      if (pin_of_[v] == kNone) {
        pin_of_[v] = size_of(pins_);
        pins_.push_back({v, line.place, line.kind, line.along});
        continue;
      }
      HeldVertex& pin = pins_[pin_of_[v]];
      if (pin.kind == PinKind::kPoint) return false;  // on three lines
      const std::optional<Vec2> place = crossing({pin.kind, pin.place, pin.along}, line);
      if (!place) return false;
      pin = {v, *place};
    }
    return true;
  }

  const std::vector<HeldVertex>& pins() const { return pins_; }
  /// Whether the places nearest on the lines are in order, and no edge of a path is shortened much
  /// by going there: where paths bend more, ends would be rolled up.
  bool are_near(const std::vector<Vec2>& uvs) const;
  /// The same as points: along each line, around its middle, in the order and at the distances that
  /// the vertices of its path have along it in a map.
  std::vector<HeldVertex> points_in_order(const std::vector<Vec2>& uvs) const;

  Index released() const { return released_; }

 private:
  const DiskMesh& mesh_;
  std::vector<Index> pin_of_;  // per vertex
  std::vector<HeldVertex> pins_;
  std::vector<std::pair<StraightPath, Line>> lines_;
  Index released_ = 0;
};

bool Rails::are_near(const std::vector<Vec2>& uvs) const {
  for (const auto& [path, line] : lines_) {
    Vec2 direction = line.direction();
    const Vec2 chord = uvs[path.vertices.back()] - uvs[path.vertices.front()];
    if (direction.dot(chord) < 0) direction = -direction;
    for (std::size_t i = 1; i < path.vertices.size(); ++i) {
      const Vec2 edge = uvs[path.vertices[i]] - uvs[path.vertices[i - 1]];
      if (direction.dot(edge) < kLeastShadow * edge.norm()) return false;
    }
  }
  return true;
}

std::vector<HeldVertex> Rails::points_in_order(const std::vector<Vec2>& uvs) const {
  std::vector<HeldVertex> points = pins_;
  for (const auto& [path, line] : lines_) {
    std::vector<double> along{0};
    for (std::size_t i = 1; i < path.vertices.size(); ++i) {
      along.push_back(along.back() + (uvs[path.vertices[i]] - uvs[path.vertices[i - 1]]).norm());
    }
    Vec2 direction = line.direction();
    if (direction.dot(uvs[path.vertices.back()] - uvs[path.vertices.front()]) < 0) {
      direction = -direction;
    }
    // Where other lines cross, vertices have their places already: the first and the last.
    std::vector<std::pair<double, double>> known;
    for (std::size_t i = 0; i < path.vertices.size(); ++i) {
      const Index pin = pin_of_[path.vertices[i]];
      if (pin == kNone || pins_[pin].kind != PinKind::kPoint) continue;
      known.emplace_back(along[i], direction.dot(pins_[pin].place - line.place));
    }
    double slope = 1, from = 0.5 * along.back(), to = 0;
    if (!known.empty()) std::tie(from, to) = known.front();
    if (known.size() > 1 && known.back().first > from) {
      slope = (known.back().second - to) / (known.back().first - from);
    }
    for (std::size_t i = 0; i < path.vertices.size(); ++i) {
      const Index pin = pin_of_[path.vertices[i]];
      if (pin == kNone || pins_[pin].kind == PinKind::kPoint) continue;
      points[pin] = {path.vertices[i], line.place + (to + slope * (along[i] - from)) * direction};
    }
  }
  return points;
}

/// The factors of u and v with which a map has the least symmetric Dirichlet energy: of
/// a^2 A + C / a^2 + b^2 B + D / b^2.
Vec2 best_factors(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                  const std::vector<Vec2>& uvs) {
  double grow_u = 0, grow_v = 0, shrink_u = 0, shrink_v = 0;
  for (std::size_t f = 0; f < rest.size(); ++f) {
    const auto [i, j, k] = mesh.faces[f];
    const RestTriangle& r = rest[f];
    const Vec2 by_x = (uvs[j] - uvs[i]) / r.x1;
    const Vec2 by_y = (uvs[k] - uvs[i] - r.x2 * by_x) / r.y2;
    const double det = by_x.x() * by_y.y() - by_x.y() * by_y.x(), area = r.area();
    if (!(det > 0)) continue;
    const double u = by_x.x() * by_x.x() + by_y.x() * by_y.x();
    const double v = by_x.y() * by_x.y() + by_y.y() * by_y.y();
    grow_u += area * u;
    grow_v += area * v;
    shrink_u += area * v / (det * det);
    shrink_v += area * u / (det * det);
  }
  if (!(grow_u > 0 && grow_v > 0)) return {1, 1};
  return {std::sqrt(std::sqrt(shrink_u / grow_u)), std::sqrt(std::sqrt(shrink_v / grow_v))};
}

/// The sides of a rectangle: from corner to corner along the boundary.
class Sides {
 public:
  Sides(const DiskMesh& mesh, const std::array<Index, 4>& corners) {
    const std::vector<Index>& loop = mesh.boundary;
    const std::vector<double> lengths = boundary_lengths(mesh);
    std::size_t at = std::find(loop.begin(), loop.end(), corners[0]) - loop.begin();
    for (int k = 0; k < 4; ++k) {
      std::vector<Index>& side = path_[k];
      side.push_back(loop[at]);
      do {
        along_[k].push_back(length_[k]);
        length_[k] += lengths[at];
        at = at + 1 == loop.size() ? 0 : at + 1;
        side.push_back(loop[at]);
      } while (loop[at] != corners[(k + 1) % 4]);
    }
  }

  Vec2 sizes() const { return 0.5 * Vec2(length_[0] + length_[2], length_[1] + length_[3]); }
  StraightPath path(int k) const { return {k % 2 == 0 ? PinKind::kV : PinKind::kU, path_[k]}; }
  static Line line(int k, const Vec2& sizes) {
    const Vec2 place = k == 1 || k == 2 ? sizes : Vec2::Zero();
    return {k % 2 == 0 ? PinKind::kV : PinKind::kU, place, Vec2::Zero()};
  }

  /// Places of all of the boundary by arc length, the sides bent outwards by `bulge`.
  void place(const Vec2& sizes, double bulge, std::vector<Index>& vertices,
             std::vector<Vec2>& places) const {
    const std::array<Vec2, 4> corner{Vec2(0, 0), Vec2(sizes.x(), 0), sizes, Vec2(0, sizes.y())};
    for (int k = 0; k < 4; ++k) {
      const Vec2 chord = corner[(k + 1) % 4] - corner[k];
      const Vec2 outwards = Vec2(chord.y(), -chord.x()) / chord.norm();
      for (std::size_t i = 0; i + 1 < path_[k].size(); ++i) {
        const double t = along_[k][i] / length_[k];
        vertices.push_back(path_[k][i]);
        places.push_back(corner[k] + t * chord + 4 * t * (1 - t) * bulge * outwards);
      }
    }
  }

 private:
  std::array<std::vector<Index>, 4> path_;
  std::array<std::vector<double>, 4> along_;  // per vertex but the last, the length up to it
  std::array<double, 4> length_{};
};

/// Tutte's embedding, the border by arc length.
std::vector<Vec2> embedded(const DiskMesh& mesh, const Sides& sides, const Vec2& sizes,
                           double bulge, const Work& work) {
  std::vector<Index> vertices;
  std::vector<Vec2> places;
  sides.place(sizes, bulge, vertices, places);
  PinField field(mesh, vertices, work);
  return field.harmonic(places);
}

/// Tutte's embedding into a circle that a path of the boundary cuts off a part of, by a chord that
/// lies on its line; a path within the boundary alone, and its released vertices, stay on the
/// circle.
std::vector<Vec2> embedded(const DiskMesh& mesh, const StraightPath& path, const Line& line,
                           const Work& work) {
  std::vector<Vec2> places = boundary_on_circle(mesh, work);
  const std::vector<Index>& loop = mesh.boundary;
  const std::vector<bool> released = released_of(mesh, path);
  std::vector<bool> on_path(mesh.positions.size(), false);
  for (std::size_t i = 0; i < released.size(); ++i) on_path[path.vertices[i]] = !released[i];
  std::vector<Index> at(mesh.positions.size(), kNone);
  for (std::size_t i = 0; i < loop.size(); ++i) at[loop[i]] = static_cast<Index>(i);
  const Index first = at[path.vertices.front()], last = at[path.vertices.back()];
  if (first != kNone && last != kNone) {
    const Vec2 from = places[first], chord = places[last] - from;
    // Of the circle to the line, the border running counter-clockwise.
    for (std::size_t i = 0; i < loop.size(); ++i) {
      if (!on_path[loop[i]]) continue;
      const double t = (places[i] - from).dot(chord) / chord.squaredNorm();
      places[i] = from + t * chord;
    }
    const Vec2 unit = chord / chord.norm(), along = line.direction();
    // The turn that brings the chord onto the line, and the shift to its middle.
    const Vec2 turn(unit.dot(along), unit.x() * along.y() - unit.y() * along.x());
    const Vec2 shift = line.place - turned(turn, from + 0.5 * chord);
    for (Vec2& w : places) w = turned(turn, w) + shift;
  }
  PinField field(mesh, loop, work);
  return field.harmonic(places);
}

/// The length of a path in a map.
double length_of(const std::vector<Vec2>& uvs, const StraightPath& path) {
  double length = 0;
  for (std::size_t i = 1; i < path.vertices.size(); ++i) {
    length += (uvs[path.vertices[i]] - uvs[path.vertices[i - 1]]).norm();
  }
  return length;
}

/// All of some paths at once, from a map in which the first ones are straight. Nothing where
/// several others are far from it: one is to be unbent first. A first one alone also from an
/// embedding.
StraightMap straighten_at_once(const DiskMesh& mesh, const std::vector<Vec2>& uvs,
                               const std::vector<StraightPath>& paths, std::size_t paths_straight,
                               const ChartOptions& options, const Work& work) {
  const Vec2 turn = turn_to_axes(uvs, paths);
  std::vector<Vec2> start;
  start.reserve(uvs.size());
  for (const Vec2& w : uvs) start.push_back(turned(turn, w));
  Rails rails(mesh);
  for (const StraightPath& path : paths) {
    if (!rails.add(path, line_of(start, path))) return {};
  }
  HeldMap held;
  held.failed = 0;
  const bool near = rails.are_near(start);
  if (!near && paths.size() > paths_straight + 1) return {};
  if (near) {
    held = drag_pins(mesh, start, rails.pins(), Touching::kRefused, options, work.part(0, 0.3));
  }
  if (held.failed != kNone) {
    const HeldMap ordered = drag_pins(mesh, start, rails.points_in_order(start), Touching::kRefused,
                                      options, work.part(0.3, 0.6));
    if (ordered.failed == kNone) {
      held = drag_pins(mesh, ordered.uvs, rails.pins(), Touching::kRefused, options,
                       work.part(0.6, 0.8));
    }
  }
  if (held.failed != kNone && paths.size() == 1) {
    const Line line = line_of(start, paths.front());
    held = drag_pins(mesh, embedded(mesh, paths.front(), line, work.aside()), rails.pins(),
                     Touching::kRefused, options, work.part(0.8, 1));
  }
  if (held.failed != kNone) return {};
  return {std::move(held.uvs), held.converged, rails.released()};
}

}  // namespace

StraightMap straighten(const DiskMesh& mesh, const std::vector<Vec2>& uvs,
                       const std::vector<StraightPath>& paths, const ChartOptions& options,
                       const Work& work) {
  StraightMap map = straighten_at_once(mesh, uvs, paths, 0, options, work.part(0, 0.5));
  if (!map.uvs.empty() || paths.size() == 1) return map;
  // One after the other, the longest first: it unbends what the others are of.
  std::vector<StraightPath> sorted = paths;
  std::stable_sort(sorted.begin(), sorted.end(), [&](const auto& a, const auto& b) {
    return length_of(uvs, a) > length_of(uvs, b);
  });
  map.uvs = uvs;
  for (std::size_t count = 1; count <= sorted.size() && !map.uvs.empty(); ++count) {
    const std::vector<StraightPath> first(sorted.begin(), sorted.begin() + count);
    map = straighten_at_once(mesh, map.uvs, first, count - 1, options, work.part(0.5, 1));
  }
  return map;
}

StraightMap to_rectangle(const DiskMesh& mesh, const std::array<Index, 4>& corners,
                         const ChartOptions& options, const Work& work) {
  const Sides sides(mesh, corners);
  const std::vector<RestTriangle> rest = rest_triangles(mesh.positions, mesh.faces, work);
  Vec2 sizes = sides.sizes();
  std::vector<Vec2> uvs = embedded(mesh, sides, sizes, 0, work.aside());
  const bool folded = !non_positive_faces(mesh.faces, uvs, work).empty();
  if (folded) uvs = embedded(mesh, sides, sizes, kBulge * sizes.minCoeff(), work.aside());
  StraightMap map;
  for (int fit = 0; fit < kMostFits; ++fit) {
    Rails rails(mesh);
    for (int k = 0; k < 4; ++k) {
      if (!rails.add(sides.path(k), Sides::line(k, sizes))) return {};
    }
    const double part = 1.0 / kMostFits;
    HeldMap held = drag_pins(mesh, uvs, rails.pins(), Touching::kRefused, options,
                             work.part(part * fit, part * (fit + 1)));
    if (held.failed != kNone) return {};
    map = {std::move(held.uvs), held.converged, rails.released()};
    const Vec2 factors = best_factors(mesh, rest, map.uvs);
    if ((factors - Vec2::Ones()).cwiseAbs().maxCoeff() < kSameSides || work.out_of_time()) break;
    if (fit + 1 == kMostFits) break;
    sizes = sizes.cwiseProduct(factors);
    uvs = map.uvs;
    for (Vec2& w : uvs) w = w.cwiseProduct(factors);
  }
  return map;
}

std::optional<std::array<Index, 4>> four_corners(const DiskMesh& mesh,
                                                 const std::vector<Vec2>& uvs) {
  const std::vector<Vec2> polygon = boundary_polygon(mesh, uvs);
  const std::size_t count = polygon.size();
  std::vector<double> upto(2 * count + 1, 0.0);  // twice around
  for (std::size_t i = 0; i < 2 * count; ++i) {
    upto[i + 1] = upto[i] + (polygon[(i + 1) % count] - polygon[i % count]).norm();
  }
  const double all = upto[count], window = kWindow * all;
  if (!(all > 0) || count < 4) return std::nullopt;
  const auto place_at = [&](double length) {
    if (length < 0) length += all;
    const auto next = std::upper_bound(upto.begin(), upto.end() - 1, length);
    const std::size_t i = std::max<std::ptrdiff_t>(next - upto.begin(), 1) - 1;
    const double own = upto[i + 1] - upto[i];
    const Vec2 &a = polygon[i % count], &b = polygon[(i + 1) % count];
    return own > 0 ? Vec2(a + (length - upto[i]) / own * (b - a)) : a;
  };
  std::vector<double> score(count, 0.0);
  for (std::size_t i = 0; i < count; ++i) {
    const Vec2 a = polygon[i] - place_at(upto[i] - window);
    const Vec2 b = place_at(upto[i] + window) - polygon[i];
    const double cross = a.x() * b.y() - a.y() * b.x(), norms = a.norm() * b.norm();
    if (cross > 0 && norms > 0) score[i] = 1 - a.dot(b) / norms;
  }
  std::vector<std::size_t> found;
  std::vector<double> turns;
  while (found.size() < 5) {
    const std::size_t best = std::max_element(score.begin(), score.end()) - score.begin();
    found.push_back(best);
    turns.push_back(score[best]);
    for (std::size_t i = 0; i < count; ++i) {
      const double apart = std::abs(upto[i] - upto[best]);
      if (std::min(apart, all - apart) <= 2 * window) score[i] = 0;
    }
  }
  if (turns[3] < kLeastCorner || turns[4] > kClear * turns[3]) return std::nullopt;
  std::sort(found.begin(), found.begin() + 4);
  std::array<Index, 4> corners{};
  for (int k = 0; k < 4; ++k) corners[k] = mesh.boundary[found[k]];
  return corners;
}

}  // namespace beltrami
