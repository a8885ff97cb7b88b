#include "admit/continue_sheets.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include "base/interrupt.h"
#include "base/parallel.h"
#include "mesh/edges.h"

namespace beltrami {
namespace {

constexpr std::int64_t kGrain = 1024;
/// Faces of an edge among which pairs are sought, as there are as many pairs as its square has: the
/// cards of a bush that share an axis are some ten, and no sheets meet in more.
constexpr std::size_t kMostFaces = 32;
// What follows is in lengths of chords of the unit circle; a pair that is bent by an angle costs
// that of the angle, 0 where it is flat and 2 where it folds back.
/// Of a pair that runs the same way, so that one of its faces is to be turned over: some ten
/// degrees. Sheets in scans and in solids bend by less from one side to the other.
constexpr double kTurned = 0.2;
/// Of a pair with the greater angle behind it: one degree, above what rounding to single precision
/// makes of equal angles.
constexpr double kHollow = 0.02;

/// In the order of places.
bool lies_before(const Vec3& a, const Vec3& b) {
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
}

/// The unit vector square to the edge that leads into the face, and the edge's own; zero where
/// rounding leaves none. Any coordinates will do.
struct Frame {
  Vec3 along, into;
};
Frame frame_at(std::array<Vec3, 3> points) {
  double greatest = 0;
  for (const Vec3& p : points) greatest = std::max(greatest, p.cwiseAbs().maxCoeff());
  const int exponent = greatest > 0 ? -std::ilogb(greatest) : 0;
  for (Vec3& p : points) {
    for (double& x : p) x = std::ldexp(x, exponent);
  }
  const auto unit = [](const Vec3& a) -> Vec3 {
    const double longest = a.cwiseAbs().maxCoeff();
    if (!(longest > 0)) return Vec3::Zero();
    const Vec3 scaled = a / longest;
    return scaled / std::sqrt(scaled.squaredNorm());
  };
  const Vec3 along = unit(points[1] - points[0]);
  const Vec3 side = points[2] - points[0];
  return {along, unit(side - along * along.dot(side))};
}

/// Two half-edges of a crowd that may become one edge.
struct Join {
  double cost;
  Index one, other;
};

class Candidates {
 public:
  Candidates(const std::vector<Vec3>& positions, const std::vector<Triangle>& faces)
      : positions_(positions), faces_(faces) {}

  void add(const Crowd& crowd, std::vector<Join>& joins) const {
    if (crowd.size() > kMostFaces) return;
    std::array<Side, kMostFaces> sides;
    std::size_t forward = 0;
    for (std::size_t i = 0; i < crowd.size(); ++i) {
      sides[i] = side_of(crowd[i]);
      forward += sides[i].is_forward ? 1 : 0;
    }
    std::sort(sides.begin(), sides.begin() + static_cast<std::ptrdiff_t>(crowd.size()),
              [&](const Side& a, const Side& b) { return comes_before(a.halfedge, b.halfedge); });
    const bool is_even = 2 * forward == crowd.size();
    for (std::size_t i = 0; i < crowd.size(); ++i) {
      for (std::size_t j = i + 1; j < crowd.size(); ++j) {
        if (is_even && sides[i].is_forward == sides[j].is_forward) continue;
        joins.push_back({cost_of(sides[i], sides[j]), sides[i].halfedge, sides[j].halfedge});
      }
    }
  }

  bool operator()(const Join& a, const Join& b) const {
    if (a.cost != b.cost) return a.cost < b.cost;
    if (a.one != b.one) return comes_before(a.one, b.one);
    return a.other != b.other && comes_before(a.other, b.other);
  }

 private:
  struct Side {
    Index halfedge;
    Frame frame;
    bool is_forward;  ///< from the end that lies before the other
  };

  /// The ends of the edge in the order of places, and the corner opposite.
  std::array<Index, 3> corners_of(Index h) const {
    auto [from, to] = ends_of(faces_, h);
    if (lies_before(positions_[to], positions_[from])) std::swap(from, to);
    return {from, to, faces_[h / 3][previous_corner(h % 3)]};
  }

  Side side_of(Index h) const {
    const auto [from, to, opposite] = corners_of(h);
    return {h, frame_at({positions_[from], positions_[to], positions_[opposite]}),
            ends_of(faces_, h)[0] == from};
  }

  /// By where their corners are: the same whatever their numbers.
  bool comes_before(Index one, Index other) const {
    const auto mine = corners_of(one), theirs = corners_of(other);
    for (const std::size_t k : {2, 0, 1}) {
      const Vec3 &a = positions_[mine[k]], &b = positions_[theirs[k]];
      if (a != b) return lies_before(a, b);
    }
    return one < other;
  }

  static double cost_of(const Side& a, const Side& b) {
    const double bend = std::sqrt((a.frame.into + b.frame.into).squaredNorm());
    if (a.is_forward == b.is_forward) return bend + kTurned;
    const Vec3 normal = a.frame.along.cross(a.frame.into) * (a.is_forward ? 1.0 : -1.0);
    return normal.dot(b.frame.into) > 0 ? bend + kHollow : bend;
  }

  const std::vector<Vec3>& positions_;
  const std::vector<Triangle>& faces_;
};

/// Which faces are to be turned over for their pieces to be oriented.
class Pieces {
 public:
  Pieces(const std::vector<Triangle>& faces, const std::vector<Index>& twin)
      : faces_(faces), piece_(faces.size(), kNone), turned_(faces.size(), false) {
    std::vector<Index> stack;
    PollSometimes poll;
    for (Index seed = 0; seed < size_of(faces); ++seed) {
      if (piece_[seed] != kNone) continue;
      const Index piece = size_of(parent_);
      parent_.push_back({piece, false});
      piece_[seed] = piece;
      stack.assign(1, seed);
      while (!stack.empty()) {
        poll();
        const Index face = stack.back();
        stack.pop_back();
        for (Index h = 3 * face; h < 3 * face + 3; ++h) {
          const Index other = twin[h] == kNone ? kNone : twin[h] / 3;
          if (other == kNone || piece_[other] != kNone) continue;
          piece_[other] = piece;
          turned_[other] = turned_[face] != run_alike(h, twin[h]);
          stack.push_back(other);
        }
      }
    }
  }

  /// Makes the pieces of two half-edges one, and returns whether it is oriented.
  bool unite(Index one, Index other) {
    const Link a = root(piece_[one / 3]), b = root(piece_[other / 3]);
    const bool is_turned = (turned_[one / 3] != a.turned) !=
                           ((turned_[other / 3] != b.turned) != run_alike(one, other));
    if (a.piece == b.piece) return !is_turned;
    parent_[std::max(a.piece, b.piece)] = {std::min(a.piece, b.piece), is_turned};
    return true;
  }

 private:
  /// A piece, and whether it is turned over for that one.
  struct Link {
    Index piece;
    bool turned;
  };

  bool run_alike(Index one, Index other) const {
    return ends_of(faces_, one)[0] == ends_of(faces_, other)[0];
  }

  Link root(Index piece) {
    bool turned = false;
    while (parent_[piece].piece != piece) {
      Link& link = parent_[piece];
      const Link& above = parent_[link.piece];
      link = {above.piece, link.turned != above.turned};
      turned = turned != link.turned;
      piece = link.piece;
    }
    return {piece, turned};
  }

  const std::vector<Triangle>& faces_;
  std::vector<Index> piece_;  // per face
  std::vector<bool> turned_;  // per face, for its piece
  std::vector<Link> parent_;  // per piece
};

}  // namespace

void continue_sheets(const std::vector<Vec3>& positions, const std::vector<Triangle>& faces,
                     const std::vector<Crowd>& crowds, std::vector<Index>& twin, const Work& work) {
  const Candidates candidates(positions, faces);
  std::vector<std::vector<Join>> of_chunk(crowds.size() / kGrain + 1);
  parallel_for(work, size_of(crowds), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i) candidates.add(crowds[i], of_chunk[begin / kGrain]);
  });
  std::vector<Join> joins;
  for (std::vector<Join>& some : of_chunk) {
    joins.insert(joins.end(), some.begin(), some.end());
    std::vector<Join>().swap(some);
  }
  if (joins.empty()) return;
  sort_interruptibly(joins.begin(), joins.end(), candidates);
  Pieces pieces(faces, twin);
  PollSometimes poll;
  for (const Join& join : joins) {
    poll();
    if (twin[join.one] != kNone || twin[join.other] != kNone) continue;
    if (!pieces.unite(join.one, join.other)) continue;
    twin[join.one] = join.other;
    twin[join.other] = join.one;
  }
}

}  // namespace beltrami
