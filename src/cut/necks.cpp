#include "cut/necks.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>
#include <queue>
#include <tuple>
#include <utility>

#include "base/interrupt.h"
#include "base/portable_math.h"

namespace beltrami {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

/// Points of the border between which chords are tried.
constexpr Index kMostPoints = 320;
/// Sides of the hulls that stand for convex ones: these have up to 2% more area.
constexpr int kSides = 16;
/// Cells to the longer side of the raster that tells what lies inside.
constexpr int kCells = 256;
/// Cells at the ends of a chord that may lie outside, as the border is between cells.
constexpr double kEnds = 1.5;
/// Of the border, between the ends of two chords together: those closer are one neck.
constexpr double kApart = 0.08;
/// Of the root of the area: how far along the border a path may end from the end of its chord.
constexpr double kWindow = 0.04;
/// Of a chord's length: how far from it a path is looked for.
constexpr double kCorridor = 0.35;

double cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Which cells an injective map covers.
class Raster {
 public:
  enum Cover : std::uint8_t { kOutside, kVirtual, kReal };

  Raster(const DiskMesh& disk, const std::vector<Vec2>& uvs, Index real_faces) {
    Eigen::AlignedBox2d box;
    for (const Vec2& p : uvs) box.extend(p);
    origin_ = box.min();
    cell_ = box.sizes().maxCoeff() / kCells;
    cells_.assign(static_cast<std::size_t>(kCells) * kCells, kOutside);
    std::vector<Vec2> border;
    for (const Index v : disk.boundary) border.push_back(in_cells(uvs[v]));
    fill(border, kReal);
    PollSometimes poll;
    for (Index f = real_faces; f < disk.face_count(); ++f) {
      poll();
      const auto& [a, b, c] = disk.faces[f];
      fill({in_cells(uvs[a]), in_cells(uvs[b]), in_cells(uvs[c])}, kVirtual);
    }
  }

  double cell() const { return cell_; }

  /// The length of a chord that lies on real faces; kFar where it leaves the map.
  double length_inside(const Vec2& from, const Vec2& to) const {
    const Vec2 p = in_cells(from), q = in_cells(to);
    const double length = (q - p).norm();
    const int steps = static_cast<int>(2 * (length - 2 * kEnds));
    if (steps < 1) return (to - from).norm();
    int real = 0;
    for (int i = 0; i <= steps; ++i) {
      const double at = kEnds + (length - 2 * kEnds) * i / steps;
      const Vec2 place = p + at / length * (q - p);
      const auto x = std::clamp(static_cast<int>(place.x()), 0, kCells - 1);
      const auto y = std::clamp(static_cast<int>(place.y()), 0, kCells - 1);
      const std::uint8_t cover = cells_[static_cast<std::size_t>(y) * kCells + x];
      if (cover == kOutside) return kFar;
      real += cover == kReal ? 1 : 0;
    }
    return (to - from).norm() * real / (steps + 1);
  }

 private:
  Vec2 in_cells(const Vec2& p) const { return (p - origin_) / cell_; }

  /// Those whose centers lie inside a polygon.
  void fill(const std::vector<Vec2>& corners, Cover cover) {
    std::vector<std::pair<int, double>> crossings;  // rows, and where their middles are crossed
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Vec2 &p = corners[i], &q = corners[i + 1 < corners.size() ? i + 1 : 0];
      const auto [low, high] = std::minmax(p.y(), q.y());
      const int first = std::max(0, static_cast<int>(std::ceil(low - 0.5)));
      for (int y = first; y < kCells && y + 0.5 < high; ++y) {
        const double t = (y + 0.5 - p.y()) / (q.y() - p.y());
        crossings.emplace_back(y, p.x() + t * (q.x() - p.x()));
      }
    }
    std::sort(crossings.begin(), crossings.end());
    for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
      const int begin = std::max(0, static_cast<int>(std::ceil(crossings[i].second - 0.5)));
      const int end =
          std::min(kCells - 1, static_cast<int>(std::floor(crossings[i + 1].second - 0.5)));
      const auto row = cells_.begin() + static_cast<std::ptrdiff_t>(crossings[i].first) * kCells;
      if (begin <= end) std::fill(row + begin, row + end + 1, cover);
    }
  }

  Vec2 origin_{0, 0};
  double cell_ = 1;
  std::vector<std::uint8_t> cells_;
};

/// How far something reaches in the directions of the hulls' sides.
using Reach = std::array<double, kSides>;

/// The hulls of what has given reaches.
class Hulls {
 public:
  Hulls() {
    const double angle = 2 * std::numbers::pi / kSides;
    for (int k = 0; k < kSides; ++k) {
      directions_[k] = {portable::cos(k * angle), portable::sin(k * angle)};
    }
    cosine_ = portable::cos(angle);
    sine_ = portable::sin(angle);
  }

  static Reach nothing() {
    Reach reach;
    reach.fill(-kFar);
    return reach;
  }
  void extend(Reach& reach, const Vec2& p) const {
    for (int k = 0; k < kSides; ++k) reach[k] = std::max(reach[k], directions_[k].dot(p));
  }
  static Reach together(const Reach& a, const Reach& b) {
    Reach reach;
    for (int k = 0; k < kSides; ++k) reach[k] = std::max(a[k], b[k]);
    return reach;
  }
  /// See NeckOptions.
  double room(const Reach& reach, double page) const {
    return area(reach) + std::max(0.0, square(reach) - page);
  }

 private:
  double area(const Reach& reach) const {
    double sum = 0;
    for (int k = 0; k < kSides; ++k) {
      const double before = reach[(k + kSides - 1) % kSides], after = reach[(k + 1) % kSides];
      sum += reach[k] * (before + after - 2 * reach[k] * cosine_);
    }
    return sum / (2 * sine_);
  }

  /// The area of the least square around it that has sides in some of the directions.
  static double square(const Reach& reach) {
    constexpr int kQuarter = kSides / 4;
    double least = kFar;
    for (int k = 0; k < kQuarter; ++k) {
      const double width = reach[k] + reach[k + 2 * kQuarter];
      const double height = reach[k + kQuarter] + reach[k + 3 * kQuarter];
      least = std::min(least, std::max(width, height));
    }
    return least * least;
  }

  std::array<Vec2, kSides> directions_;
  double cosine_, sine_;
};

/// A chord between two of the points of the border.
struct Chord {
  Index from = 0, to = 0;  // of the points, the lesser first
  double saved = 0, gain = 0;
};

/// A search for necks of one disk.
class Search {
 public:
  Search(const DiskMesh& disk, const std::vector<Vec2>& uvs, const std::vector<double>& cost,
         Index real_faces, const NeckOptions& options)
      : disk_(disk),
        uvs_(uvs),
        cost_(cost),
        options_(options),
        raster_(disk, uvs, real_faces),
        swept_(disk.boundary.size() + 1, 0),
        along_(disk.boundary.size() + 1, 0) {
    const std::size_t size = disk.boundary.size();
    for (std::size_t i = 0; i < size; ++i) {
      const Vec2 &p = border(i), &q = border((i + 1) % size);
      swept_[i + 1] = swept_[i] + cross(p, q) / 2;
      along_[i + 1] = along_[i] + (q - p).norm();
    }
    area_ = swept_.back();
    choose_points();
  }

  std::vector<Neck> run() const {
    std::vector<Neck> necks;
    if (!(area_ > 0)) return necks;
    std::vector<Chord> tried;
    for (const Chord& chord : chords_by_gain()) {
      const auto is_apart = [&](const Chord& other) { return are_apart(chord, other); };
      if (!std::all_of(tried.begin(), tried.end(), is_apart)) continue;
      tried.push_back(chord);
      // Where faces are large no path may follow the chord, or only a long one.
      Neck neck = path_near(chord);
      if (neck.halfedges.empty() || !(gain_of(neck) > 0)) continue;
      necks.push_back(std::move(neck));
      if (size_of(necks) == options_.most) break;
    }
    std::stable_sort(necks.begin(), necks.end(),
                     [&](const Neck& a, const Neck& b) { return gain_of(a) > gain_of(b); });
    return necks;
  }

 private:
  const Vec2& border(std::size_t i) const { return uvs_[disk_.boundary[i]]; }

  /// Evenly spaced ones.
  void choose_points() {
    const Index size = size_of(disk_.boundary);
    const double spacing = along_.back() / kMostPoints;
    double next = 0;
    for (Index i = 0; i < size; ++i) {
      if (size > kMostPoints && along_[i] < next) continue;
      points_.push_back(i);
      next += spacing * std::max(1.0, std::floor((along_[i] - next) / spacing) + 1);
    }
  }

  /// All chords that promise a gain.
  std::vector<Chord> chords() const {
    std::vector<Reach> after(points_.size() + 1, Hulls::nothing());
    for (std::size_t i = points_.size(); i-- > 0;) {
      after[i] = after[i + 1];
      hulls_.extend(after[i], border(points_[i]));
    }
    const double whole = hulls_.room(after[0], options_.page);
    std::vector<Chord> found;
    Reach before = Hulls::nothing();
    for (Index i = 0; i < size_of(points_); ++i) {
      poll_interrupt();
      const Vec2& p = border(points_[i]);
      hulls_.extend(before, p);
      Reach between = Hulls::nothing();
      hulls_.extend(between, p);
      for (Index j = i + 1; j < size_of(points_); ++j) {
        const Vec2& q = border(points_[j]);
        hulls_.extend(between, q);
        const double area = swept_[points_[j]] - swept_[points_[i]] + cross(q, p) / 2;
        if (std::min(area, area_ - area) < options_.least_share * area_) continue;
        const double saved = whole - hulls_.room(between, options_.page) -
                             hulls_.room(Hulls::together(before, after[j]), options_.page);
        if (!(options_.worth * saved > 0)) continue;
        const double length = raster_.length_inside(p, q);
        const double gain = options_.worth * saved - length;
        if (gain > 0) found.push_back({i, j, saved, gain});
      }
    }
    return found;
  }

  std::vector<Chord> chords_by_gain() const {
    std::vector<Chord> all = chords();
    sort_interruptibly(all.begin(), all.end(), [](const Chord& a, const Chord& b) {
      return std::tie(b.gain, a.from, a.to) < std::tie(a.gain, b.from, b.to);
    });
    return all;
  }

  /// Whether two chords are no one neck.
  bool are_apart(const Chord& a, const Chord& b) const {
    const auto distance = [&](Index i, Index j) {
      const double between = std::abs(along_[points_[i]] - along_[points_[j]]);
      return std::min(between, along_.back() - between);
    };
    return std::min(distance(a.from, b.from) + distance(a.to, b.to),
                    distance(a.from, b.to) + distance(a.to, b.from)) > kApart * along_.back();
  }

  double gain_of(const Neck& neck) const { return options_.worth * neck.saved - neck.cost; }

  /// Marks vertices of the border around a point, but for the other end's half of the way there.
  void mark_window(Index point, Index other, std::int8_t mark, std::vector<std::int8_t>& marks,
                   std::vector<Index>& vertices) const {
    const Index size = size_of(disk_.boundary), middle = points_[point];
    const double whole = along_.back();
    const auto distance = [&](Index i, Index j) {
      const double between = std::abs(along_[i] - along_[j]);
      return std::min(between, whole - between);
    };
    const double reach = std::min(std::max(kWindow * std::sqrt(area_), whole / kMostPoints),
                                  distance(middle, points_[other]) / 4);
    for (const Index step : {1, size - 1}) {
      for (Index i = step == 1 ? middle : (middle + step) % size; distance(i, middle) <= reach;
           i = (i + step) % size) {
        const Index v = disk_.boundary[i];
        if (marks[v] != 0) break;
        marks[v] = mark;
        vertices.push_back(v);
      }
    }
  }

  /// The cheapest path near a chord (Dijkstra 1959).
  Neck path_near(const Chord& chord) const {
    std::vector<std::int8_t> marks(disk_.positions.size(), 0);
    std::vector<Index> starts, ends;
    mark_window(chord.from, chord.to, 1, marks, starts);
    mark_window(chord.to, chord.from, 2, marks, ends);
    const Vec2 &p = border(points_[chord.from]), &q = border(points_[chord.to]);
    const double length = (q - p).norm();
    const double width = kCorridor * length + 2 * kWindow * std::sqrt(area_);
    const auto is_near = [&](Index v) {
      const double t = std::clamp((uvs_[v] - p).dot(q - p) / (length * length), 0.0, 1.0);
      return (uvs_[v] - p - t * (q - p)).norm() <= width;
    };
    std::vector<double> reached(disk_.positions.size(), kFar);
    std::vector<Index> by(disk_.positions.size(), kNone);
    using Entry = std::pair<double, Index>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    for (const Index v : starts) {
      reached[v] = 0;
      queue.emplace(0, v);
    }
    PollSometimes poll;
    const auto try_edge = [&](Index v, Index other, Index h) {
      const double through = reached[v] + cost_[h];
      const bool may_be = !disk_.on_boundary[other] || marks[other] == 2;
      if (!may_be || !(through < reached[other]) || !is_near(other)) return;
      reached[other] = through;
      by[other] = h;
      queue.emplace(through, other);
    };
    while (!queue.empty()) {
      poll();
      const auto [distance, v] = queue.top();
      queue.pop();
      if (distance > reached[v]) continue;
      if (marks[v] == 2) return traced(v, by, chord.saved);
      // An edge of the border is no cut: those inside have a face on either side.
      disk_.for_each_outgoing(v, [&](Index h) {
        if (disk_.twin[h] != kNone) try_edge(v, disk_.target(h), h);
      });
    }
    return {};
  }

  Neck traced(Index end, const std::vector<Index>& by, double saved) const {
    Neck neck;
    neck.saved = saved;
    for (Index v = end; by[v] != kNone; v = disk_.origin(by[v])) {
      neck.halfedges.push_back(by[v]);
      neck.cost += cost_[by[v]];
    }
    std::reverse(neck.halfedges.begin(), neck.halfedges.end());
    return neck;
  }

  const DiskMesh& disk_;
  const std::vector<Vec2>& uvs_;
  const std::vector<double>& cost_;
  const NeckOptions& options_;
  Raster raster_;
  Hulls hulls_;
  std::vector<double> swept_, along_;  // per vertex of the border up to it: area, length
  double area_ = 0;
  std::vector<Index> points_;  // of the border
};

}  // namespace

std::vector<Neck> find_necks(const DiskMesh& disk, const std::vector<Vec2>& uvs,
                             const std::vector<double>& cost, Index real_faces,
                             const NeckOptions& options) {
  return Search(disk, uvs, cost, real_faces, options).run();
}

}  // namespace beltrami
