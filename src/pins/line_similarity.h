// Where a map lies best for points that are to lie on lines.
#pragma once

#include <vector>

#include "base/types.h"
#include "base/vectors.h"

namespace beltrami {

/// A point of a map that is to lie on a line: n . w = n . place for where it comes to lie, w.
struct LineFit {
  Vec2 point;
  Vec2 place;
  Vec2 normal;  ///< of unit length
};

/// w = turn * z + shift.
struct LineSimilarity {
  Complex turn = 1;
  Vec2 shift = Vec2::Zero();
};

/// The similarity after which the points are nearest to their lines, in the root of the mean
/// square, measured before it: so no map is shrunk for the sake of that. Where lines leave the
/// scale open, as one line does, it is 1. Keeps the orientation. Precondition: one point at least.
LineSimilarity fit_to_lines(const std::vector<LineFit>& fits);

}  // namespace beltrami
