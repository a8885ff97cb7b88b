// Incremental Delaunay triangulation of all points, then the polygon's missing edges one by one.
//
// The convex outer polygon is triangulated first, so that every other point lands inside a
// triangle and no super-triangle or vertex at infinity is needed. Points are inserted by splitting
// and Lawson's flips (Lawson 1977, "Software for C1 surface interpolation") in the biased random
// order of Amenta, Choi and Rote 2003, "Incremental constructions con BRIO", and located by the
// visibility walk (Devillers, Pion, Teillaud 2002, "Walking in a triangulation"). All predicates
// are exact, so the walk ends and no flip inverts a face. A missing edge is inserted by emptying
// and refilling the faces it crosses; the missing edges are taken in random order too, which bounds
// the expected work (Shewchuk, Brown 2015, "Fast segment insertion and incremental construction of
// constrained Delaunay triangulations").
#include "ring/triangulate_ring.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>

#include "exact/orientation.h"
#include "ring/ring_predicates.h"

namespace beltrami {
namespace {

/// Cells of the Hilbert curve per axis: 2^31, so that a cell's number fits 62 bits.
constexpr int kHilbertBits = 31;

/// The finaliser of splitmix64 (Steele, Lea, Flood 2014): random bits that are the same everywhere.
std::uint64_t random_bits(Index seed) {
  std::uint64_t x = (static_cast<std::uint64_t>(seed) + 1) * 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/// The number of a cell along the Hilbert curve (Hilbert 1891).
std::uint64_t hilbert_number(std::uint32_t x, std::uint32_t y) {
  constexpr std::uint32_t kAll = (std::uint32_t{1} << kHilbertBits) - 1;
  std::uint64_t number = 0;
  for (int bit = kHilbertBits - 1; bit >= 0; --bit) {
    const std::uint32_t right = (x >> bit) & 1;
    const std::uint32_t upper = (y >> bit) & 1;
    number = 4 * number + ((3 * right) ^ upper);
    if (upper != 0) continue;
    if (right != 0) {
      x = kAll - x;
      y = kAll - y;
    }
    std::swap(x, y);
  }
  return number;
}

/// `chosen` points, or the edges that start there, in rounds that double in size, each round along
/// a Hilbert curve: random enough for few flips, local enough for short walks.
std::vector<Index> insertion_order(const std::vector<Vec2>& points,
                                   const std::vector<Index>& chosen) {
  struct Place {
    int round;
    std::uint64_t number;
    Index point;
    auto operator<=>(const Place&) const = default;
  };
  Eigen::AlignedBox2d box;
  for (const Vec2& p : points) box.extend(p);
  // Halves, so that the difference of the largest numbers is finite.
  const Vec2 corner = 0.5 * box.min();
  const double extent = (0.5 * box.max() - corner).maxCoeff();
  const auto cell = [&](double half, double low) -> std::uint32_t {
    if (!(extent > 0)) return 0;
    const double cells = static_cast<double>(std::uint32_t{1} << kHilbertBits);
    return static_cast<std::uint32_t>(std::min((half - low) / extent * cells, cells - 1));
  };
  std::vector<Place> places;
  places.reserve(chosen.size());
  for (const Index p : chosen) {
    const Vec2 half = 0.5 * points[p];
    const auto number = hilbert_number(cell(half.x(), corner.x()), cell(half.y(), corner.y()));
    places.push_back({-std::countr_zero(random_bits(p)), number, p});
  }
  std::sort(places.begin(), places.end());
  std::vector<Index> order;
  order.reserve(chosen.size());
  for (const Place& place : places) order.push_back(place.point);
  return order;
}

/// A triangulation in half-edges: face f has the half-edges 3f, 3f + 1, 3f + 2, half-edge h leaves
/// tail_[h], and the face is to its left. Half-edges of the outer polygon have no twin.
class RingBuilder {
 public:
  RingBuilder(const std::vector<Vec2>& points, Index inner_count)
      : points_(points), inner_count_(inner_count), leaving_(points.size(), kNone) {
    const std::size_t half_edges = 3 * (2 * points.size());
    tail_.reserve(half_edges);
    twin_.reserve(half_edges);
  }

  void add_convex(const std::vector<Index>& corners) {
    add_between(corners, 0, size_of(corners) - 1);
    restore_all();
  }

  void add_points(const std::vector<Index>& order) {
    for (const Index p : order) add_point(p);
  }

  void add_inner_edges() {
    fixed_.assign(tail_.size(), false);
    moved_.assign(tail_.size(), kNone);
    std::vector<Index> missing;
    for (Index i = 0; i < inner_count_; ++i) {
      if (!fix_if_present(i, after(i))) missing.push_back(i);
    }
    for (const Index i : insertion_order(points_, missing)) {
      // The edges inserted before may have made this one Delaunay.
      if (!fix_if_present(i, after(i))) insert_edge(i, after(i));
    }
  }

  std::vector<Triangle> ring_faces() const {
    const std::vector<bool> in_ring = reached_from_outside();
    for (Index i = 0; i < inner_count_; ++i) {
      const Index h = find_edge(i, after(i));
      if (in_ring[h / 3] || !in_ring[twin_[h] / 3]) fail_ring("the inner polygon is clockwise.");
    }
    std::vector<Triangle> faces;
    faces.reserve(points_.size());
    for (Index f = 0; f < face_count(); ++f) {
      if (in_ring[f]) faces.push_back({tail_[3 * f], tail_[3 * f + 1], tail_[3 * f + 2]});
    }
    return faces;
  }

 private:
  /// A half-edge on the edge of a cavity, as it was before the cavity was emptied.
  struct Rim {
    Index old;
    Index across;  ///< its twin
    Index head;
    bool is_fixed;
  };

  /// A vertex of the part of a rim that is not yet cut off, with the edge that leads to it: either
  /// an edge of the rim, or the half-edge of a new face on its other side.
  struct Pending {
    Index vertex;
    const Rim* rim;
    Index across;
  };

  struct Cavity {
    std::vector<Index> faces;
    std::vector<Rim> left, right;  ///< along the two sides of the new edge, counter-clockwise
  };

  static Index next(Index h) { return h % 3 == 2 ? h - 2 : h + 1; }
  static Index previous(Index h) { return h % 3 == 0 ? h + 2 : h - 1; }
  Index head(Index h) const { return tail_[next(h)]; }
  Index apex(Index h) const { return tail_[previous(h)]; }
  Index face_count() const { return size_of(tail_) / 3; }
  Index after(Index i) const { return i + 1 == inner_count_ ? 0 : i + 1; }
  bool is_fixed(Index h) const { return !fixed_.empty() && fixed_[h]; }

  int side(Index a, Index b, Index p) const {
    return orientation(points_[a], points_[b], points_[p]);
  }

  std::string name(Index p) const {
    return p < inner_count_ ? "inner vertex " + std::to_string(p)
                            : "outer vertex " + std::to_string(p - inner_count_);
  }

  Index new_face() {
    tail_.resize(tail_.size() + 3, kNone);
    twin_.resize(twin_.size() + 3, kNone);
    return face_count() - 1;
  }

  void set_face(Index f, Index a, Index b, Index c) {
    const Triangle corners = {a, b, c};
    for (int k = 0; k < 3; ++k) {
      tail_[3 * f + k] = corners[k];
      leaving_[corners[k]] = 3 * f + k;
    }
  }

  void link(Index h, Index t) {
    twin_[h] = t;
    if (t != kNone) twin_[t] = h;
  }

  void fix(Index h) {
    fixed_[h] = true;
    fixed_[twin_[h]] = true;
  }

  /// Triangulates corners[first..last]; returns the half-edge from the last to the first.
  Index add_between(const std::vector<Index>& corners, Index first, Index last) {
    const Index middle = first + (last - first) / 2;
    const Index f = new_face();
    set_face(f, corners[first], corners[middle], corners[last]);
    if (middle - first > 1) link(3 * f, add_between(corners, first, middle));
    if (last - middle > 1) link(3 * f + 1, add_between(corners, middle, last));
    return 3 * f + 2;
  }

  // --- Points ---------------------------------------------------------------------------------

  void add_point(Index p) {
    const Index h = locate(p);
    if (side(tail_[h], head(h), p) != 0) {
      split_face(h / 3, p);
    } else if (side(head(h), apex(h), p) == 0 || side(apex(h), tail_[h], p) == 0) {
      fail_ring(name(p) + " lies on another vertex.");
    } else if (twin_[h] != kNone) {
      split_edge(h, p);
    } else if (p >= inner_count_) {
      split_outer_edge(h, p);
    } else {
      fail_ring(name(p) + " lies on the outer polygon.");
    }
    last_face_ = leaving_[p] / 3;
    restore(p);
  }

  /// A half-edge of the face that contains p, the one that p is on if p is on one. The walk cannot
  /// go in circles because the triangulation is Delaunay (De Floriani, Falcidieno, Nagy, Pienovi
  /// 1991, "On sorting triangles in a Delaunay tessellation").
  Index locate(Index p) const {
    Index entry = 3 * last_face_;
    bool is_entered = false;
    for (;;) {
      Index on = entry;
      Index exit = kNone;
      Index h = entry;
      for (int k = 0; k < 3 && exit == kNone; ++k, h = next(h)) {
        if (k == 0 && is_entered) continue;  // p is strictly to the left of where the walk came in
        const int s = side(tail_[h], head(h), p);
        if (s < 0) exit = h;
        if (s == 0) on = h;
      }
      if (exit == kNone) return on;
      if (twin_[exit] == kNone) fail_ring(name(p) + " lies outside the outer polygon.");
      entry = twin_[exit];
      is_entered = true;
    }
  }

  void split_face(Index f, Index p) {
    const Index a = tail_[3 * f], b = tail_[3 * f + 1], c = tail_[3 * f + 2];
    const Index across_bc = twin_[3 * f + 1], across_ca = twin_[3 * f + 2];
    const Index g = new_face(), i = new_face();
    set_face(f, a, b, p);
    set_face(g, b, c, p);
    set_face(i, c, a, p);
    link(3 * g, across_bc);
    link(3 * i, across_ca);
    link(3 * f + 1, 3 * g + 2);
    link(3 * g + 1, 3 * i + 2);
    link(3 * i + 1, 3 * f + 2);
    suspects_.insert(suspects_.end(), {3 * f, 3 * g, 3 * i});
  }

  /// Splits the face of h from p on h to the apex; returns the half-edge from p to the head of h.
  Index split_half(Index h, Index p) {
    const Index a = tail_[h], b = head(h), c = apex(h);
    const Index across_bc = twin_[next(h)], across_ca = twin_[previous(h)];
    const Index f = h / 3;
    const Index g = new_face();
    set_face(f, c, a, p);
    set_face(g, b, c, p);
    link(3 * f, across_ca);
    link(3 * g, across_bc);
    link(3 * f + 2, 3 * g + 1);
    suspects_.insert(suspects_.end(), {3 * f, 3 * g});
    return 3 * g + 2;
  }

  void split_edge(Index h, Index p) {
    const Index t = twin_[h];
    const Index p_to_head = split_half(h, p);
    const Index p_to_tail = split_half(t, p);
    link(p_to_head, 3 * (t / 3) + 1);
    link(p_to_tail, 3 * (h / 3) + 1);
  }

  void split_outer_edge(Index h, Index p) {
    const Index p_to_head = split_half(h, p);
    twin_[p_to_head] = kNone;
    twin_[3 * (h / 3) + 1] = kNone;
  }

  // --- Flips ----------------------------------------------------------------------------------

  /// Replaces the edge a-b of the faces (a, b, c) and (b, a, d) by d-c. Afterwards h is a-d,
  /// next(h) is d-c, and the twin t of old is b-c; the other two half-edges stay.
  void flip(Index h) {
    const Index t = twin_[h];
    const Index h1 = next(h), t1 = next(t);
    const Index a = tail_[h], b = tail_[t], c = apex(h), d = apex(t);
    const Index across_bc = twin_[h1], across_ad = twin_[t1];
    tail_[h1] = d;
    tail_[t1] = c;
    link(h, across_ad);
    link(t, across_bc);
    link(h1, t1);
    leaving_[a] = h;
    leaving_[b] = t;
    leaving_[c] = t1;
    leaving_[d] = h1;
    if (fixed_.empty()) return;
    fixed_[h] = fixed_[t1];
    fixed_[t] = fixed_[h1];
    fixed_[h1] = fixed_[t1] = false;
  }

  /// Flips until the suspects and all that their flips touch are locally Delaunay. If `centre` is a
  /// vertex, all suspects are opposite it, and the edges that leave it need no test.
  void restore(Index centre = kNone) {
    while (!suspects_.empty()) {
      const Index h = suspects_.back();
      suspects_.pop_back();
      const Index t = twin_[h];
      if (t == kNone || is_fixed(h)) continue;
      if (!is_in_circle(points_[tail_[h]], points_[head(h)], points_[apex(h)], points_[apex(t)])) {
        continue;
      }
      flip(h);
      suspects_.insert(suspects_.end(), {h, previous(t)});
      if (centre == kNone) suspects_.insert(suspects_.end(), {previous(h), t});
    }
  }

  void restore_all() {
    for (Index h = 0; h < size_of(tail_); ++h) suspects_.push_back(h);
    restore();
  }

  // --- Edges ----------------------------------------------------------------------------------

  /// The half-edge from the inner vertex a to b, or kNone.
  Index find_edge(Index a, Index b) const {
    const Index start = leaving_[a];
    Index h = start;
    do {
      if (head(h) == b) return h;
      h = twin_[previous(h)];
    } while (h != start);
    return kNone;
  }

  bool fix_if_present(Index a, Index b) {
    const Index h = find_edge(a, b);
    if (h != kNone) fix(h);
    return h != kNone;
  }

  std::string edge_name(Index a, Index b) const {
    return "the edge from " + name(a) + " to " + name(b);
  }

  [[noreturn]] void fail_through(Index a, Index b, Index p) const {
    fail_ring(edge_name(a, b) + " passes through " + name(p) + ".");
  }

  /// The half-edge that leaves a in the face that the missing edge a-b enters first.
  Index first_face_towards(Index a, Index b) const {
    const Index start = leaving_[a];
    const bool rises = lexicographically_less(points_[a], points_[b]);
    Index h = start;
    do {
      const int s = side(a, b, head(h));
      if (s == 0 && lexicographically_less(points_[a], points_[head(h)]) == rises) {
        fail_through(a, b, head(h));
      }
      if (s < 0 && side(a, b, apex(h)) > 0) return h;
      h = twin_[previous(h)];
    } while (h != start);
    fail_ring("no face at " + name(a) + " points to its successor.");
  }

  Rim rim(Index h) const { return {h, twin_[h], head(h), is_fixed(h)}; }

  /// The faces that the missing edge a-b crosses.
  Cavity cavity_along(Index a, Index b) const {
    Cavity cavity;
    const Index first = first_face_towards(a, b);
    cavity.faces.push_back(first / 3);
    cavity.right.push_back(rim(first));
    cavity.left.push_back(rim(previous(first)));
    Index crossed = next(first);
    for (;;) {
      if (twin_[crossed] == kNone || fixed_[crossed]) {
        fail_ring(edge_name(a, b) + " crosses the edge from " + name(tail_[crossed]) + " to " +
                  name(head(crossed)) + ".");
      }
      const Index h = twin_[crossed];
      const Index p = apex(h);
      const int s = p == b ? 0 : side(a, b, p);
      if (s == 0 && p != b) fail_through(a, b, p);
      cavity.faces.push_back(h / 3);
      if (s <= 0) cavity.right.push_back(rim(next(h)));
      if (s >= 0) cavity.left.push_back(rim(previous(h)));
      if (p == b) break;
      crossed = s > 0 ? next(h) : previous(h);
    }
    std::reverse(cavity.left.begin(), cavity.left.end());
    return cavity;
  }

  /// Makes h the near side of the edge that leads to `end`.
  void attach(Index h, const Pending& end) {
    fixed_[h] = end.rim != nullptr && end.rim->is_fixed;
    if (end.rim != nullptr) {
      moved_[end.rim->old] = h;
    } else {
      link(h, end.across);
    }
  }

  /// Refills one side of a cavity, whose rim starts at `start` and ends at the other end of the new
  /// edge, with the faces from `slot` on. Every vertex of the rim sees the new edge, and the
  /// polygons with this property are triangulated by cutting off each left turn as soon as it is
  /// met (Toussaint, Avis 1982, "On a convex hull algorithm for polygons and its application to
  /// triangulation problems"). Returns the half-edge along the new edge.
  Index refill(Index start, const std::vector<Rim>& side_rim, const Index*& slot) {
    std::vector<Pending>& chain = chain_;
    chain.assign(1, {start, nullptr, kNone});
    for (const Rim& edge : side_rim) {
      Pending end = {edge.head, &edge, kNone};
      while (chain.size() > 1) {
        const Pending& middle = chain.back();
        const Index before = chain[chain.size() - 2].vertex;
        if (side(before, middle.vertex, end.vertex) <= 0) break;
        const Index f = *slot++;
        set_face(f, before, middle.vertex, end.vertex);
        attach(3 * f, middle);
        attach(3 * f + 1, end);
        suspects_.insert(suspects_.end(), {3 * f, 3 * f + 1});
        fixed_[3 * f + 2] = false;
        end = {end.vertex, nullptr, 3 * f + 2};
        chain.pop_back();
      }
      chain.push_back(end);
    }
    if (chain.size() != 2 || chain.back().across == kNone) fail_ring("a cavity did not close.");
    return chain.back().across;
  }

  void insert_edge(Index a, Index b) {
    const Cavity cavity = cavity_along(a, b);
    const Index* slot = cavity.faces.data();
    const Index back = refill(a, cavity.right, slot);
    const Index forth = refill(b, cavity.left, slot);
    for (const auto* rims : {&cavity.left, &cavity.right}) {
      // Both sides of an edge that dangles into the cavity are rims, and both have moved.
      for (const Rim& edge : *rims) {
        const Index across = edge.across == kNone ? kNone : moved_[edge.across];
        link(moved_[edge.old], across == kNone ? edge.across : across);
      }
    }
    for (const auto* rims : {&cavity.left, &cavity.right}) {
      for (const Rim& edge : *rims) moved_[edge.old] = kNone;
    }
    link(forth, back);
    fix(forth);
    restore();
  }

  std::vector<bool> reached_from_outside() const {
    std::vector<bool> is_reached(face_count(), false);
    std::vector<Index> front;
    const auto reach = [&](Index f) {
      if (is_reached[f]) return;
      is_reached[f] = true;
      front.push_back(f);
    };
    for (Index h = 0; h < size_of(tail_); ++h) {
      if (twin_[h] == kNone) reach(h / 3);
    }
    while (!front.empty()) {
      const Index f = front.back();
      front.pop_back();
      for (Index h = 3 * f; h < 3 * f + 3; ++h) {
        if (twin_[h] != kNone && !fixed_[h]) reach(twin_[h] / 3);
      }
    }
    return is_reached;
  }

  const std::vector<Vec2>& points_;
  Index inner_count_;
  std::vector<Index> tail_, twin_;
  std::vector<Index> leaving_;       ///< one half-edge that leaves each vertex
  std::vector<std::uint8_t> fixed_;  ///< per half-edge, empty until all points are in
  std::vector<Index> moved_;         ///< per half-edge: its place after a refill, kNone otherwise
  std::vector<Index> suspects_;      ///< half-edges that may not be locally Delaunay
  std::vector<Pending> chain_;
  Index last_face_ = 0;
};

}  // namespace

RingTriangulation triangulate_ring(const std::vector<Vec2>& inner, const std::vector<Vec2>& outer) {
  RingTriangulation ring{{}, ring_points(inner, outer)};
  const Index inner_count = size_of(inner);
  std::vector<Index> corners = corners_of_convex(outer);
  std::vector<bool> is_corner(ring.points.size(), false);
  for (Index& corner : corners) {
    corner += inner_count;
    is_corner[corner] = true;
  }
  std::vector<Index> others;
  for (Index p = 0; p < size_of(ring.points); ++p) {
    if (!is_corner[p]) others.push_back(p);
  }
  RingBuilder builder(ring.points, inner_count);
  builder.add_convex(corners);
  builder.add_points(insertion_order(ring.points, others));
  builder.add_inner_edges();
  ring.faces = builder.ring_faces();
  return ring;
}

const char* ring_triangulation_name() {
  return "own";
}

}  // namespace beltrami
