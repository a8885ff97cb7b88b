#include "pins/similarity.h"

#include <cmath>

namespace beltrami {

namespace {

Vec2 times(Complex factor, const Vec2& z) {
  return {factor.real() * z.x() - factor.imag() * z.y(),
          factor.real() * z.y() + factor.imag() * z.x()};
}

}  // namespace

Vec2 Similarity::operator()(const Vec2& z) const {
  return times(turn, z - from) + to;
}

Vec2 Similarity::back(const Vec2& w) const {
  return times(quotient(1, turn), w - to) + from;
}

Vec2 Similarity::direction_back(const Vec2& w) const {
  return times(std::conj(turn) / modulus(turn), w);
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
