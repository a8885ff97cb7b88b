// Turning, scaling and shifting in the plane: what takes a map to where it is to lie.
#pragma once

#include <utility>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"

namespace beltrami {

/// w = turn * (z - from) + to, a motion that mirrors nothing, scaled by |turn|.
struct Similarity {
  Complex turn = 1;
  Vec2 from = Vec2::Zero(), to = Vec2::Zero();

  double scale() const { return modulus(turn); }
  Vec2 operator()(const Vec2& z) const;
  Vec2 back(const Vec2& w) const;            ///< the z that is taken to w
  Vec2 direction_back(const Vec2& w) const;  ///< the same of a direction, as long as it is
};

/// That takes the first of each pair nearest to the second in the least squares, but that the scale
/// is the ratio of their spreads; `rigid`: without scale. The identity of one pair or none is a
/// shift.
Similarity fit_similarity(const std::vector<std::pair<Vec2, Vec2>>& pairs, bool rigid);

}  // namespace beltrami
