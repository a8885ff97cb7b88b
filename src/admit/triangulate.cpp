#include "admit/triangulate.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <queue>
#include <span>
#include <utility>

#include "base/interrupt.h"
#include "base/parallel.h"

namespace beltrami {
namespace {

/// Pairs of vertices: a hash table with open addressing.
class EdgeSet {
 public:
  void insert(Index a, Index b) {
    if (2 * (size_ + 1) > slots_.size()) grow();
    size_ += place(key(a, b));
  }
  bool contains(Index a, Index b) const { return slots_[find(key(a, b))] != 0; }

 private:
  /// Never 0 for the edges that are inserted: none joins vertex 0 to itself.
  static std::uint64_t key(Index a, Index b) {
    return static_cast<std::uint64_t>(std::max(a, b)) << 32 |
           static_cast<std::uint64_t>(std::min(a, b));
  }
  std::size_t find(std::uint64_t key) const {
    const std::uint64_t mixed = (key ^ key >> 31) * 0x9E3779B97F4A7C15u;
    std::size_t slot = (mixed ^ mixed >> 29) & (slots_.size() - 1);
    while (slots_[slot] != 0 && slots_[slot] != key) slot = (slot + 1) & (slots_.size() - 1);
    return slot;
  }
  bool place(std::uint64_t key) {
    std::uint64_t& slot = slots_[find(key)];
    const bool is_new = slot == 0;
    slot = key;
    return is_new;
  }
  void grow() {
    std::vector<std::uint64_t> old(2 * slots_.size(), 0);
    old.swap(slots_);
    PollSometimes poll;
    for (const std::uint64_t key : old) {
      poll();
      if (key != 0) place(key);
    }
  }

  std::vector<std::uint64_t> slots_ = std::vector<std::uint64_t>(1024, 0);
  std::size_t size_ = 0;
};

using Point = std::array<double, 2>;

/// Twice the signed area.
double turn(const Point& a, const Point& b, const Point& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

double length_sq(const Point& p, const Point& q) {
  return (p[0] - q[0]) * (p[0] - q[0]) + (p[1] - q[1]) * (p[1] - q[1]);
}

/// Of a triangle: greatest, 0.29, for an equilateral one; below 0 for one that is turned over.
double quality(const Point& a, const Point& b, const Point& c) {
  const double found = turn(a, b, c) / (length_sq(a, b) + length_sq(b, c) + length_sq(c, a));
  return std::isfinite(found) ? found : 0;
}

/// Twice the area, of a polygon of unit size, that rounding gives three corners on a line.
constexpr double kOnLine = 1e-12;

/// Whether `p` is in the closed triangle, or beyond its side from `c` to `a` by a triangle of no
/// more than `slack`, but not at one of its corners.
bool blocks(const Point& p, const Point& a, const Point& b, const Point& c, double slack) {
  if (p == a || p == b || p == c) return false;
  return turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= -slack;
}

/// `fallback` for vectors without a direction.
Vec3 normalized(const Vec3& a, const Vec3& fallback) {
  const double length = a.norm();
  return length > 0 && std::isfinite(length) ? Vec3((1 / length) * a) : fallback;
}

/// The polygon seen along its normal, at most of unit size.
std::vector<Point> project(const std::vector<Vec3>& positions, std::span<const Index> polygon) {
  std::vector<Vec3> points;
  double size = 0;
  for (const Index vertex : polygon) {
    points.emplace_back(positions[vertex] - positions[polygon[0]]);
    for (const double x : points.back()) size = std::max(size, std::abs(x));
  }
  for (Vec3& p : points) {
    for (double& x : p) x = size > 0 ? x / size : 0;
  }
  Vec3 normal = Vec3::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    normal += points[i].cross(points[(i + 1) % points.size()]);
  }
  const Vec3 up = normalized(normal, {0, 0, 1});
  // Across the axis that is furthest from it.
  Index axis = 0;
  for (Index k = 1; k < 3; ++k) axis = std::abs(up[k]) <= std::abs(up[axis]) ? k : axis;
  const Vec3 right = normalized(Vec3::Unit(axis).cross(up), {1, 0, 0});
  const Vec3 forward = up.cross(right);
  std::vector<Point> flat;
  for (const Vec3& p : points) flat.push_back({right.dot(p), forward.dot(p)});
  return flat;
}

/// Reflex corners by cells of a grid, to be found within a box.
class CornerGrid {
 public:
  CornerGrid(const std::vector<Point>& points, const std::vector<std::uint32_t>& corners) {
    for (const std::uint32_t i : corners) {
      for (std::size_t k = 0; k < 2; ++k) {
        low_[k] = std::min(low_[k], points[i][k]);
        high_[k] = std::max(high_[k], points[i][k]);
      }
    }
    side_ = static_cast<std::size_t>(std::sqrt(static_cast<double>(corners.size()))) + 1;
    starts_.assign(side_ * side_ + 1, 0);
    for (const std::uint32_t i : corners) ++starts_[cell_of(points[i]) + 1];
    for (std::size_t i = 1; i < starts_.size(); ++i) starts_[i] += starts_[i - 1];
    items_.resize(corners.size());
    std::vector<std::size_t> next = starts_;
    for (const std::uint32_t i : corners) items_[next[cell_of(points[i])]++] = i;
  }

  /// Whether predicate(i) holds for a corner i in a cell that meets the box.
  template <class Predicate>
  bool any(const Point& low, const Point& high, const Predicate& predicate) const {
    const std::size_t left = place(low[0], 0), right = place(high[0], 0);
    for (std::size_t y = place(low[1], 1); y <= place(high[1], 1); ++y) {
      for (std::size_t i = starts_[y * side_ + left]; i < starts_[y * side_ + right + 1]; ++i) {
        if (predicate(items_[i])) return true;
      }
    }
    return false;
  }

 private:
  std::size_t place(double x, std::size_t k) const {
    const double share = (x - low_[k]) / (high_[k] - low_[k]);
    if (!(share > 0)) return 0;  // NaN too, of a grid without extent
    return std::min(side_ - 1, static_cast<std::size_t>(std::min(share, 1.0) * double(side_)));
  }
  std::size_t cell_of(const Point& p) const { return place(p[1], 1) * side_ + place(p[0], 0); }

  Point low_ = {INFINITY, INFINITY}, high_ = {-INFINITY, -INFINITY};
  std::size_t side_ = 1;
  std::vector<std::size_t> starts_;
  std::vector<std::uint32_t> items_;
};

/// Cuts one polygon.
class EarClipper {
 public:
  EarClipper(std::span<const Index> polygon, Index first, std::vector<Point> points, EdgeSet& edges,
             std::vector<Triangle>& faces)
      : polygon_(polygon),
        first_(first),
        points_(std::move(points)),
        edges_(edges),
        faces_(faces),
        previous_(polygon.size()),
        next_(polygon.size()),
        changes_(polygon.size(), 0),
        left_(static_cast<std::uint32_t>(polygon.size())) {
    for (std::uint32_t i = 0; i < left_; ++i) {
      next_[i] = (i + 1) % left_;
      previous_[i] = (i + left_ - 1) % left_;
    }
  }

  /// Whether no edge was repeated: at last every way on may do so.
  bool cut() {
    std::vector<std::uint32_t> reflex;
    for (std::uint32_t i = 0; i < left_; ++i) {
      if (!(turn_at(i) > kOnLine)) reflex.push_back(i);
    }
    reflex_.emplace(points_, reflex);
    // First with no corner on a cut, as far as rounding can tell: beyond it a triangle without area
    // would part the polygon.
    for (const double slack : {kOnLine, 0.0}) {
      slack_ = slack;
      // A round looks at every ear that there is; corners that blocked one may be gone in the next.
      while (left_ > 3 && clip_all(Wish::kProper)) {
      }
    }
    if (left_ > 3) clip_all(Wish::kFree);
    const bool is_free = left_ == 3;
    if (left_ > 3) clip_all(Wish::kAny);
    add_face(some_corner_);
    return is_free;
  }

 private:
  /// What is asked of an ear: to be one, or at least to repeat no edge.
  enum class Wish { kProper, kFree, kAny };

  struct Ear {
    double quality;
    std::uint32_t corner, change;
    /// The best is the last; of equals, the first corner.
    bool operator<(const Ear& other) const {
      return quality < other.quality || (quality == other.quality && corner > other.corner);
    }
  };

  const Point& point(std::uint32_t i) const { return points_[i]; }
  double turn_at(std::uint32_t i) const {
    return turn(point(previous_[i]), point(i), point(next_[i]));
  }

  void offer(std::uint32_t i, Wish wish) {
    const double q = quality(point(previous_[i]), point(i), point(next_[i]));
    if ((q > 0 && turn_at(i) > slack_) || wish != Wish::kProper) ears_.push({q, i, changes_[i]});
  }

  /// Whether cutting the corner off makes no edge that is there already.
  bool is_free(std::uint32_t i) const {
    return !edges_.contains(polygon_[previous_[i]], polygon_[next_[i]]);
  }

  /// Whether no other corner is in the ear or on its cut; only reflex ones can be.
  bool is_empty(std::uint32_t i) const {
    const Point &a = point(previous_[i]), &b = point(i), &c = point(next_[i]);
    // So far beyond the cut a corner is still on it.
    const double beyond = slack_ > 0 ? slack_ / std::sqrt(length_sq(a, c)) : 0;
    const Point low = {std::min({a[0], b[0], c[0]}) - beyond,
                       std::min({a[1], b[1], c[1]}) - beyond};
    const Point high = {std::max({a[0], b[0], c[0]}) + beyond,
                        std::max({a[1], b[1], c[1]}) + beyond};
    return !reflex_->any(low, high, [&](std::uint32_t k) {
      return !is_cut(k) && k != previous_[i] && k != i && k != next_[i] &&
             blocks(point(k), a, b, c, slack_);
    });
  }

  bool is_cut(std::uint32_t i) const { return next_[previous_[i]] != i; }

  /// Cuts off what can be, the best first. Returns whether a corner went.
  bool clip_all(Wish wish) {
    const std::uint32_t before = left_;
    ears_ = {};
    std::uint32_t i = some_corner_;
    for (std::uint32_t count = 0; count < left_; ++count, i = next_[i]) offer(i, wish);
    while (left_ > 3 && !ears_.empty()) {
      const Ear ear = ears_.top();
      ears_.pop();
      if (is_cut(ear.corner) || ear.change != changes_[ear.corner]) continue;
      poll_();
      if (wish != Wish::kAny && !is_free(ear.corner)) continue;
      if (wish == Wish::kProper && !is_empty(ear.corner)) continue;
      clip(ear.corner);
      for (const std::uint32_t k : {previous_[ear.corner], next_[ear.corner]}) {
        ++changes_[k];
        offer(k, wish);
      }
    }
    return left_ < before;
  }

  void clip(std::uint32_t i) {
    add_face(i);
    const Index a = polygon_[previous_[i]], b = polygon_[next_[i]];
    if (a != b) edges_.insert(a, b);
    next_[previous_[i]] = next_[i];
    previous_[next_[i]] = previous_[i];
    some_corner_ = next_[i];
    --left_;
  }

  void add_face(std::uint32_t i) {
    const auto corner = [&](std::uint32_t k) { return first_ + static_cast<Index>(k); };
    faces_.push_back({corner(previous_[i]), corner(i), corner(next_[i])});
  }

  std::span<const Index> polygon_;
  Index first_;  ///< corner of it
  std::vector<Point> points_;
  EdgeSet& edges_;
  std::vector<Triangle>& faces_;
  std::vector<std::uint32_t> previous_, next_;  ///< of the corners that are left, a ring
  std::vector<std::uint32_t> changes_;          ///< of the neighbours of a corner
  std::uint32_t left_, some_corner_ = 0;        ///< how many, and one of them
  double slack_ = 0;                            ///< twice the area of what is on a line
  std::optional<CornerGrid> reflex_;
  std::priority_queue<Ear> ears_;
  PollSometimes poll_;
};

/// Cuts along the diagonal with the better of the worse triangles, if its edge is free.
bool cut_quad(std::span<const Index> quad, Index first, const std::vector<Point>& points,
              EdgeSet& edges, std::vector<Triangle>& faces) {
  double best = -std::numeric_limits<double>::infinity();
  std::size_t from = 0;
  bool is_free = false;
  for (std::size_t i = 0; i < 2; ++i) {
    const bool free = quad[i] != quad[i + 2] && !edges.contains(quad[i], quad[i + 2]);
    const double worse = std::min(quality(points[i], points[i + 1], points[i + 2]),
                                  quality(points[i + 2], points[(i + 3) % 4], points[i]));
    if (free < is_free || (free == is_free && !(worse > best))) continue;
    best = worse;
    from = i;
    is_free = free;
  }
  const auto corner = [&](std::size_t k) { return first + static_cast<Index>(k % 4); };
  faces.push_back({corner(from), corner(from + 1), corner(from + 2)});
  faces.push_back({corner(from + 2), corner(from + 3), corner(from)});
  if (quad[from] != quad[from + 2]) edges.insert(quad[from], quad[from + 2]);
  return is_free;
}

bool names_twice(std::span<const Index> polygon) {
  std::vector<Index> sorted(polygon.begin(), polygon.end());
  std::sort(sorted.begin(), sorted.end());
  return std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end();
}

EdgeSet edges_of(const Polygons& polygons) {
  EdgeSet edges;
  PollSometimes poll;
  for (Index i = 0; i < polygons.count(); ++i) {
    poll();
    for (Index c = polygons.begin(i); c < polygons.end(i); ++c) {
      const Index next = c + 1 < polygons.end(i) ? c + 1 : polygons.begin(i);
      const Index a = polygons.corners[c], b = polygons.corners[next];
      if (a != b) edges.insert(a, b);
    }
  }
  return edges;
}

}  // namespace

Triangulation triangulate(const std::vector<Vec3>& positions, const Polygons& polygons,
                          const Work& work) {
  Triangulation result;
  std::vector<Triangle>& faces = result.triangles;
  if (polygons.all_triangles()) {
    parallel_assign(work, faces, static_cast<std::size_t>(polygons.count()));
    for (Index f = 0; f < polygons.count(); ++f) faces[f] = {3 * f, 3 * f + 1, 3 * f + 2};
    return result;
  }
  EdgeSet edges = edges_of(polygons);
  faces.reserve(polygons.corners.size() - 2 * polygons.ends.size());
  PollSometimes poll;
  for (Index i = 0; i < polygons.count(); ++i) {
    poll();
    const Index first = polygons.begin(i);
    const auto polygon = std::span(polygons.corners).subspan(first, polygons.end(i) - first);
    bool done = true;
    if (polygon.size() == 3) {
      faces.push_back({first, first + 1, first + 2});
      continue;
    }
    if (polygon.size() == 4) {
      done = cut_quad(polygon, first, project(positions, polygon), edges, faces);
    } else {
      done = EarClipper(polygon, first, project(positions, polygon), edges, faces).cut();
    }
    if ((!done || names_twice(polygon)) && result.first_repeating == kNone) {
      result.first_repeating = i;
    }
  }
  return result;
}

}  // namespace beltrami
