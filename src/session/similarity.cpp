#include "session/similarity.h"

#include <cmath>

namespace beltrami {

Vec2 Similarity::operator()(const Vec2& z) const {
  const Vec2 d = z - from;
  return Vec2(turn.real() * d.x() - turn.imag() * d.y(),
              turn.real() * d.y() + turn.imag() * d.x()) +
         to;
}

Similarity fit_similarity(const std::vector<std::pair<Vec2, Vec2>>& pairs, bool rigid) {
  Similarity best;
  if (pairs.empty()) return best;
  const auto count = static_cast<double>(pairs.size());
  for (const auto& [z, w] : pairs) {
    best.from += z / count;
    best.to += w / count;
  }
  double along = 0, across = 0, spread = 0, places = 0;
  for (const auto& [source, target] : pairs) {
    const Vec2 z = source - best.from, w = target - best.to;
    along += z.dot(w);
    across += z.x() * w.y() - z.y() * w.x();
    spread += z.squaredNorm();
    places += w.squaredNorm();
  }
  const Complex turn(along, across);
  const double length = modulus(turn), scale = std::sqrt(places / spread);
  if (length > 0 && std::isfinite(length)) best.turn = turn / length;
  if (!rigid && scale > 0 && std::isfinite(scale)) best.turn *= scale;
  return best;
}

}  // namespace beltrami
