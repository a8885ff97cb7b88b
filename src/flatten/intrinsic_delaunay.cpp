#include "flatten/intrinsic_delaunay.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/interrupt.h"

namespace beltrami {
namespace {

/// An opposite pair of cotangents counts as Delaunay down to this sum, relative to their size: a
/// flip of four points on a circle could go back and forth for ever.
constexpr double kCocircular = 1e-12;
/// Flips per edge after which rounding must have led around in circles; 0.08 to 0.53 are usual.
constexpr std::int64_t kMostFlipsPerEdge = 100;
constexpr std::int64_t kBetweenReports = 1 << 16;

class Flipper {
 public:
  Flipper(const Surface& surface, std::vector<Cotangents> cotangents)
      : faces_(surface.faces), twin_(surface.twin), cotangents_(std::move(cotangents)) {
    for (Index h = size_of(twin_) - 1; h >= 0; --h) {
      if (twin_[h] > h) pending_.push_back(h);
    }
  }

  DelaunayTriangulation run(const Work& work) {
    DelaunayTriangulation result;
    const std::int64_t most = kMostFlipsPerEdge * static_cast<std::int64_t>(pending_.size());
    const auto at_first = static_cast<double>(pending_.size());
    for (std::int64_t visits = 0; !pending_.empty(); ++visits) {
      if (visits % kBetweenReports == 0) {
        work.report(1 - std::min(1.0, static_cast<double>(pending_.size()) / at_first));
      }
      const Index h = pending_.back();
      pending_.pop_back();
      // A flip nearby may have made another edge of it; that one is waiting by its own.
      if (twin_[h] == kNone || is_delaunay(h) || joined_already(h)) continue;
      if (result.flips >= most) break;
      flip(h);
      ++result.flips;
    }
    for (Index h = 0; h < size_of(twin_); ++h) {
      if (twin_[h] > h && !is_delaunay(h)) ++result.refused;
    }
    result.faces = std::move(faces_);
    result.cotangents = std::move(cotangents_);
    return result;
  }

 private:
  Index origin(Index h) const { return faces_[h / 3][h % 3]; }
  double& cotangent(Index corner) { return cotangents_[corner / 3][corner % 3]; }
  double cotangent(Index corner) const { return cotangents_[corner / 3][corner % 3]; }

  bool is_delaunay(Index h) const {
    const double here = cotangent(Surface::previous(h));
    const double there = cotangent(Surface::previous(twin_[h]));
    return here + there >= -kCocircular * (std::abs(here) + std::abs(there) + 1);
  }

  /// The faces at a vertex, by the half-edges that leave it: counter-clockwise from the first, and
  /// where that ends at the boundary clockwise from it.
  struct Fan {
    Index first, out;
    bool clockwise = false;
  };

  /// False after the last face.
  bool advance(Fan& fan) const {
    if (!fan.clockwise) {
      const Index onward = twin_[Surface::previous(fan.out)];
      if (onward == fan.first) return false;
      if (onward != kNone) {
        fan.out = onward;
        return true;
      }
      fan.clockwise = true;
      fan.out = fan.first;
    }
    const Index back = twin_[fan.out];
    if (back == kNone) return false;
    fan.out = Surface::next(back);
    return true;
  }

  bool at_face(const Fan& fan, Index vertex) const {
    return origin(Surface::next(fan.out)) == vertex || origin(Surface::previous(fan.out)) == vertex;
  }

  /// Whether the two vertices opposite to an edge are neighbours. Goes around both side by side,
  /// since one may be a hub; either fan has the answer.
  bool joined_already(Index h) {
    Fan one{Surface::previous(h), Surface::previous(h)};
    Fan other{Surface::previous(twin_[h]), Surface::previous(twin_[h])};
    const Index r = origin(one.first), s = origin(other.first);
    while (true) {
      poll_();
      if (at_face(one, s) || at_face(other, r)) return true;
      if (!advance(one) || !advance(other)) return false;
    }
  }

  /// Replaces the edge P-Q between the faces PQR and QPS by R-S.
  void flip(Index h) {
    const Index t = twin_[h], f = h / 3, g = t / 3;
    const Index qr = Surface::next(h), rp = Surface::previous(h);
    const Index ps = Surface::next(t), sq = Surface::previous(t);
    const Index p = origin(h), q = origin(t), r = origin(rp), s = origin(sq);
    const double ap = cotangent(h), aq = cotangent(qr), bp = cotangent(ps), bq = cotangent(t);
    const Index twin_qr = twin_[qr], twin_rp = twin_[rp], twin_ps = twin_[ps], twin_sq = twin_[sq];

    // At P, then opposite to it at S and R; likewise at Q.
    const double ratio = (bp + bq) / (ap + aq);  // of the heights of R and S above P-Q
    const auto corners = [](double a, double b, double scale) {
      const double sum = a + b, product = a * b - 1;
      return std::array<double, 3>{product / sum, ((b * b + 1) / scale - product) / sum,
                                   ((a * a + 1) * scale - product) / sum};
    };
    const auto [at_p, p_at_s, p_at_r] = corners(ap, bp, ratio);
    const auto [at_q, q_at_s, q_at_r] = corners(aq, bq, ratio);

    faces_[f] = {p, s, r};
    cotangents_[f] = {at_p, p_at_s, p_at_r};
    faces_[g] = {q, r, s};
    cotangents_[g] = {at_q, q_at_r, q_at_s};
    join(3 * f, twin_ps);
    join(3 * f + 2, twin_rp);
    join(3 * g, twin_qr);
    join(3 * g + 2, twin_sq);
    twin_[3 * f + 1] = 3 * g + 1;
    twin_[3 * g + 1] = 3 * f + 1;
    for (const Index edge : {3 * f, 3 * f + 2, 3 * g, 3 * g + 2}) {
      if (twin_[edge] != kNone) pending_.push_back(edge);
    }
  }

  void join(Index h, Index twin) {
    twin_[h] = twin;
    if (twin != kNone) twin_[twin] = h;
  }

  std::vector<Triangle> faces_;
  std::vector<Index> twin_;
  std::vector<Cotangents> cotangents_;
  std::vector<Index> pending_;
  PollSometimes poll_;
};

}  // namespace

DelaunayTriangulation intrinsic_delaunay(const Surface& surface, std::vector<Cotangents> cotangents,
                                         const Work& work) {
  return Flipper(surface, std::move(cotangents)).run(work);
}

}  // namespace beltrami
