#include "atlas/congruent.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "base/interrupt.h"
#include "base/vectors.h"
#include "mesh/disk_mesh.h"
#include "mesh/surface.h"

namespace beltrami {
namespace {

/// Lengths nearer than that are the same, in roots of a piece's area: places in single precision at
/// a hundred times its size are off by a tenth of it.
constexpr double kSameLength = 1e-4;
/// Half-edges that a comparison may look at for each of a piece: of what has many symmetries, or
/// nearly so, a few starts are tried.
constexpr std::int64_t kLooks = 16;

double length(const Surface& surface, Index h) {
  return (surface.positions[surface.target(h)] - surface.positions[surface.origin(h)]).norm();
}

/// Numbers by which pieces are told apart at once.
struct Measures {
  std::tuple<Index, Index, Index, std::size_t> counts;  ///< faces, real ones, vertices, borders
  double area = 0, edges = 0;                           ///< in the unit of the whole
};

/// A piece that is congruent to none before it.
struct First {
  Index piece;
  double edges;
};

Measures measures_of(const SurfacePiece& piece) {
  const Surface& surface = piece.surface;
  const double unit = std::ldexp(1.0, -piece.exponent);
  Measures measures;
  std::size_t borders = 0;
  PollSometimes poll;
  for (Index h = 0; h < size_of(surface.twin); ++h) {
    poll();
    measures.edges += unit * length(surface, h);
    if (surface.twin[h] == kNone) ++borders;
  }
  for (const auto& [a, b, c] : surface.faces) {
    poll();
    const std::vector<Vec3>& p = surface.positions;
    measures.area += unit * unit * triangle_area(p[a], p[b], p[c]);
  }
  measures.counts = {surface.face_count(), piece.real_faces, surface.vertex_count(), borders};
  return measures;
}

/// One piece laid onto another, half-edge by half-edge.
class Laying {
 public:
  Laying(const SurfacePiece& from, const SurfacePiece& to)
      : from_(from), to_(to), unit_(std::ldexp(1.0, from.exponent - to.exponent)) {}

  /// By a motion with a reflection or by one without.
  std::optional<Laid> run(bool reflected) {
    const std::int64_t most = looks_ + kLooks * size_of(from_.surface.twin);
    for (Index start = 0; start < size_of(to_.surface.twin) && looks_ <= most; ++start) {
      if (lies(start, reflected) && moves_rigidly(reflected)) {
        return Laid{std::move(onto_), reflected};
      }
    }
    return std::nullopt;
  }

 private:
  using Around = Index (*)(Index);

  static bool is_locked(const SurfacePiece& piece, Index h) {
    return !piece.locked.empty() && piece.locked[h];
  }

  static bool is_label_border(const SurfacePiece& piece, Index h) {
    const std::vector<Index>& labels = piece.hints.labels;
    const Index twin = piece.surface.twin[h];
    return !labels.empty() && twin != kNone && labels[h / 3] != labels[twin / 3];
  }

  bool is_alike(Index h, Index g) {
    ++looks_;
    const double longer = length(from_.surface, h) - unit_ * length(to_.surface, g);
    if (!(std::abs(longer) <= kSameLength)) return false;  // a piece has about unit area
    if ((from_.surface.twin[h] == kNone) != (to_.surface.twin[g] == kNone)) return false;
    if ((h / 3 < from_.real_faces) != (g / 3 < to_.real_faces)) return false;
    // Of the spokes of a fan over a hole any one may be open.
    const bool is_real = h / 3 < from_.real_faces;
    if (is_real && is_locked(from_, h) != is_locked(to_, g)) return false;
    return is_label_border(from_, h) == is_label_border(to_, g);
  }

  /// Whether all of it lies where the first half-edge is laid onto `start`.
  bool lies(Index start, bool reflected) {
    const Around after = reflected ? Surface::previous : Surface::next;
    Index of_first = start;
    for (Index h = 0; h < 3; ++h, of_first = after(of_first)) {
      if (!is_alike(h, of_first)) return false;
    }
    looks_ += size_of(onto_);
    onto_.assign(from_.surface.twin.size(), kNone);
    std::vector<bool> is_taken(to_.surface.faces.size(), false);
    std::vector<std::pair<Index, Index>> faces = {{0, start}};  // by a half-edge of each
    while (!faces.empty()) {
      auto [h, g] = faces.back();
      faces.pop_back();
      if (onto_[h] != kNone) {
        if (onto_[h] != g) return false;
        continue;
      }
      if (is_taken[g / 3]) return false;
      is_taken[g / 3] = true;
      for (int k = 0; k < 3; ++k, h = Surface::next(h), g = after(g)) {
        poll_();
        if (!is_alike(h, g)) return false;
        onto_[h] = g;
        const Index twin = from_.surface.twin[h];
        if (twin != kNone) faces.emplace_back(twin, to_.surface.twin[g]);
      }
    }
    return true;
  }

  /// Whether one motion brings all vertices to where they are laid: edges of the same lengths may
  /// be bent otherwise (Umeyama 1991).
  bool moves_rigidly(bool reflected) {
    const Surface &from = from_.surface, &to = to_.surface;
    Eigen::Matrix3Xd places = Eigen::Matrix3Xd::Zero(3, size_of(from.positions)), onto = places;
    for (Index h = 0; h < size_of(onto_); ++h) {
      poll_();
      const Index v = from.origin(h), w = reflected ? to.target(onto_[h]) : to.origin(onto_[h]);
      places.col(v) = from.positions[v];
      onto.col(v) = unit_ * to.positions[w];
    }
    if (reflected) places.row(0) *= -1;
    const Eigen::Matrix4d motion = Eigen::umeyama(places, onto, false);
    const Eigen::Matrix3d turn = motion.topLeftCorner<3, 3>();
    const Vec3 shift = motion.topRightCorner<3, 1>();
    for (Index v = 0; v < places.cols(); ++v) {
      poll_();
      if (!((turn * places.col(v) + shift - onto.col(v)).norm() <= kSameLength)) return false;
    }
    return true;
  }

  const SurfacePiece& from_;
  const SurfacePiece& to_;
  const double unit_;  ///< of `to`, in that of `from`
  std::int64_t looks_ = 0;
  std::vector<Index> onto_;
  PollSometimes poll_;
};

bool has_paint(const SurfacePiece& piece) {
  return !piece.hints.vertex_paint.empty() || !piece.hints.edge_paint.empty();
}

bool is_near(double a, double b) {
  return std::abs(a - b) <= kSameLength * std::max(a, b);
}

}  // namespace

std::optional<Laid> laid_onto(const SurfacePiece& from, const SurfacePiece& to, bool mirrored) {
  Laying laying(from, to);
  std::optional<Laid> laid = laying.run(false);
  return laid || !mirrored ? std::move(laid) : laying.run(true);
}

std::vector<Index> first_congruent(const std::vector<SurfacePiece>& pieces) {
  std::vector<Index> first(pieces.size());
  std::map<std::tuple<Index, Index, Index, std::size_t>, std::multimap<double, First>> kinds;
  for (Index p = 0; p < size_of(pieces); ++p) {
    poll_interrupt();
    first[p] = p;
    if (pieces.size() == 1 || has_paint(pieces[p])) continue;
    const Measures own = measures_of(pieces[p]);
    std::multimap<double, First>& kind = kinds[own.counts];  // by their areas
    std::vector<Index> alike;
    // A little further on either side than is near.
    auto at = kind.lower_bound(own.area * (1 - 2 * kSameLength));
    for (; at != kind.end() && at->first <= own.area * (1 + 2 * kSameLength); ++at) {
      const bool is_alike = is_near(own.area, at->first) && is_near(own.edges, at->second.edges);
      if (is_alike) alike.push_back(at->second.piece);
    }
    std::sort(alike.begin(), alike.end());
    for (const Index other : alike) {
      if (!laid_onto(pieces[other], pieces[p], true)) continue;
      first[p] = other;
      break;
    }
    if (first[p] == p) kind.emplace(own.area, First{p, own.edges});
  }
  return first;
}

EdgeMarks carried_marks(const SurfacePiece& from, const EdgeMarks& marks, const SurfacePiece& to) {
  EdgeMarks carried(to.surface.twin.size(), false);
  const std::optional<Laid> laid = laid_onto(from, to, true);
  if (!laid) return carried;
  for (std::size_t h = 0; h < marks.size(); ++h) carried[laid->onto[h]] = marks[h];
  return carried;
}

}  // namespace beltrami
