#include "files/triangulate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <queue>
#include <span>

#include "files/polygons.h"
#include "files/vector3.h"
#include "process/failure.h"
#include "process/interrupt.h"

namespace beltrami::cli {
namespace {

/// Pairs of vertices: a hash table with open addressing.
class EdgeSet {
 public:
  void insert(std::uint32_t a, std::uint32_t b) {
    if (2 * (size_ + 1) > slots_.size()) grow();
    size_ += place(key(a, b));
  }
  bool contains(std::uint32_t a, std::uint32_t b) const { return slots_[find(key(a, b))] != 0; }

 private:
  /// Never 0: no edge joins vertex 0 to itself.
  static std::uint64_t key(std::uint32_t a, std::uint32_t b) {
    return std::uint64_t{std::max(a, b)} << 32 | std::min(a, b);
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
    for (const std::uint64_t key : old) {
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

/// Of a triangle: greatest, 0.29, for an equilateral one; below 0 for one that is turned over.
double quality(const Point& a, const Point& b, const Point& c) {
  const auto length_sq = [](const Point& p, const Point& q) {
    return (p[0] - q[0]) * (p[0] - q[0]) + (p[1] - q[1]) * (p[1] - q[1]);
  };
  const double found = turn(a, b, c) / (length_sq(a, b) + length_sq(b, c) + length_sq(c, a));
  return std::isfinite(found) ? found : 0;
}

/// Whether `p` is in the closed triangle, but not at one of its corners.
bool blocks(const Point& p, const Point& a, const Point& b, const Point& c) {
  if (p == a || p == b || p == c) return false;
  return turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0;
}

/// The polygon seen along its normal, at most of unit size.
std::vector<Point> project(const MeshFile& mesh, std::span<const std::uint32_t> polygon) {
  const double* origin = &mesh.positions[3 * std::size_t{polygon[0]}];
  std::vector<Vector3> points;
  double size = 0;
  for (const std::uint32_t vertex : polygon) {
    const double* p = &mesh.positions[3 * std::size_t{vertex}];
    points.push_back({p[0] - origin[0], p[1] - origin[1], p[2] - origin[2]});
    for (const double x : points.back()) size = std::max(size, std::abs(x));
  }
  Vector3 normal{};
  for (Vector3& p : points) {
    for (double& x : p) x = size > 0 ? x / size : 0;
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    normal = normal + cross(points[i], points[(i + 1) % points.size()]);
  }
  const Vector3 up = normalized(normal, {0, 0, 1});
  // Across the axis that is furthest from it.
  Vector3 axis{};
  axis[std::abs(up[0]) < std::abs(up[1]) ? (std::abs(up[0]) < std::abs(up[2]) ? 0 : 2)
                                         : (std::abs(up[1]) < std::abs(up[2]) ? 1 : 2)] = 1;
  const Vector3 right = normalized(cross(axis, up), {1, 0, 0}), forward = cross(up, right);
  std::vector<Point> flat;
  for (const Vector3& p : points) flat.push_back({dot(right, p), dot(forward, p)});
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
  EarClipper(std::span<const std::uint32_t> polygon, std::vector<Point> points, EdgeSet& edges,
             std::vector<std::uint32_t>& faces)
      : polygon_(polygon),
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

  /// False if every way on would repeat an edge.
  bool cut() {
    std::vector<std::uint32_t> reflex;
    for (std::uint32_t i = 0; i < left_; ++i) {
      if (!(turn_at(i) > 0)) reflex.push_back(i);
    }
    reflex_.emplace(points_, reflex);
    // A round looks at every ear that there is; corners that blocked one may be gone in the next.
    while (left_ > 3 && clip_all(true)) {
    }
    if (left_ > 3) clip_all(false);
    if (left_ > 3) return false;
    add_face(some_corner_);
    return true;
  }

 private:
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

  void offer(std::uint32_t i, bool proper) {
    const double q = quality(point(previous_[i]), point(i), point(next_[i]));
    if (q > 0 || !proper) ears_.push({q, i, changes_[i]});
  }

  /// Whether cutting the corner off makes no edge that is there already.
  bool is_free(std::uint32_t i) const {
    return !edges_.contains(polygon_[previous_[i]], polygon_[next_[i]]);
  }

  /// Whether no other corner is in the ear; only reflex ones can be.
  bool is_empty(std::uint32_t i) const {
    const Point &a = point(previous_[i]), &b = point(i), &c = point(next_[i]);
    const Point low = {std::min({a[0], b[0], c[0]}), std::min({a[1], b[1], c[1]})};
    const Point high = {std::max({a[0], b[0], c[0]}), std::max({a[1], b[1], c[1]})};
    return !reflex_->any(low, high, [&](std::uint32_t k) {
      return !is_cut(k) && k != previous_[i] && k != i && k != next_[i] &&
             blocks(point(k), a, b, c);
    });
  }

  bool is_cut(std::uint32_t i) const { return next_[previous_[i]] != i; }

  /// Cuts off what can be, the best first: proper ears only, or whatever repeats no edge. Returns
  /// whether a corner went.
  bool clip_all(bool proper) {
    const std::uint32_t before = left_;
    ears_ = {};
    std::uint32_t i = some_corner_;
    for (std::uint32_t count = 0; count < left_; ++count, i = next_[i]) offer(i, proper);
    while (left_ > 3 && !ears_.empty()) {
      const Ear ear = ears_.top();
      ears_.pop();
      if (is_cut(ear.corner) || ear.change != changes_[ear.corner]) continue;
      throw_if_interrupted();
      if (!is_free(ear.corner) || (proper && !is_empty(ear.corner))) continue;
      clip(ear.corner);
      for (const std::uint32_t k : {previous_[ear.corner], next_[ear.corner]}) {
        ++changes_[k];
        offer(k, proper);
      }
    }
    return left_ < before;
  }

  void clip(std::uint32_t i) {
    add_face(i);
    edges_.insert(polygon_[previous_[i]], polygon_[next_[i]]);
    next_[previous_[i]] = next_[i];
    previous_[next_[i]] = previous_[i];
    some_corner_ = next_[i];
    --left_;
  }

  void add_face(std::uint32_t i) {
    faces_.insert(faces_.end(), {polygon_[previous_[i]], polygon_[i], polygon_[next_[i]]});
  }

  std::span<const std::uint32_t> polygon_;
  std::vector<Point> points_;
  EdgeSet& edges_;
  std::vector<std::uint32_t>& faces_;
  std::vector<std::uint32_t> previous_, next_;  ///< of the corners that are left, a ring
  std::vector<std::uint32_t> changes_;          ///< of the neighbours of a corner
  std::uint32_t left_, some_corner_ = 0;        ///< how many, and one of them
  std::optional<CornerGrid> reflex_;
  std::priority_queue<Ear> ears_;
};

/// Cuts along the diagonal with the better of the worse triangles, if its edge is free.
bool cut_quad(std::span<const std::uint32_t> quad, const std::vector<Point>& points, EdgeSet& edges,
              std::vector<std::uint32_t>& faces) {
  double best = -std::numeric_limits<double>::infinity();
  std::size_t from = 4;
  for (std::size_t i = 0; i < 2; ++i) {
    if (edges.contains(quad[i], quad[i + 2])) continue;
    const double worse = std::min(quality(points[i], points[i + 1], points[i + 2]),
                                  quality(points[i + 2], points[(i + 3) % 4], points[i]));
    if (worse > best) {
      best = worse;
      from = i;
    }
  }
  if (from == 4) return false;
  const std::size_t to = from + 2;
  faces.insert(faces.end(), {quad[from], quad[from + 1], quad[to]});
  faces.insert(faces.end(), {quad[to], quad[(to + 1) % 4], quad[from]});
  edges.insert(quad[from], quad[to]);
  return true;
}

/// "path: face 3 (counted from 0)".
std::string name_of_face(const MeshFile& mesh, std::uint64_t face) {
  return mesh.path + ": face " + std::to_string(face) + " (counted from 0)";
}

void require_distinct_corners(const MeshFile& mesh, std::uint64_t face) {
  const auto polygon = mesh.polygons[face];
  std::vector<std::uint32_t> sorted(polygon.begin(), polygon.end());
  std::sort(sorted.begin(), sorted.end());
  if (std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end()) return;
  throw Failure(BELTRAMI_E_REPEATED_VERTEX,
                name_of_face(mesh, face) + " names one vertex twice: split the face",
                BELTRAMI_ELEMENT_FACE, face);
}

}  // namespace

std::vector<std::uint32_t> triangulate(const MeshFile& mesh) {
  const Polygons& polygons = mesh.polygons;
  if (polygons.all_triangles()) return polygons.corners();
  EdgeSet edges;
  for (std::uint64_t i = 0; i < polygons.size(); ++i) {
    const auto polygon = polygons[i];
    if (polygon.size() > 3) require_distinct_corners(mesh, i);
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const std::uint32_t a = polygon[k], b = polygon[k + 1 < polygon.size() ? k + 1 : 0];
      if (a != b) edges.insert(a, b);
    }
  }
  std::vector<std::uint32_t> faces;
  faces.reserve(3 * (polygons.corners().size() - 2 * polygons.size()));
  for (std::uint64_t i = 0; i < polygons.size(); ++i) {
    const auto polygon = polygons[i];
    bool done = true;
    if (polygon.size() == 3) {
      faces.insert(faces.end(), polygon.begin(), polygon.end());
    } else if (polygon.size() == 4) {
      done = cut_quad(polygon, project(mesh, polygon), edges, faces);
    } else {
      done = EarClipper(polygon, project(mesh, polygon), edges, faces).cut();
    }
    if (!done) {
      throw Failure(name_of_face(mesh, i) +
                        " cannot be cut into triangles without repeating an edge of the mesh: "
                        "triangulate it first",
                    BELTRAMI_ELEMENT_FACE, i);
    }
  }
  return faces;
}

}  // namespace beltrami::cli
