// The exact predicate on which every verdict rests.
#pragma once

#include "base/types.h"

namespace beltrami {

/// Exact sign of the area of (a, b, c): 1 counter-clockwise, 0 collinear, -1 clockwise; 0 where a
/// coordinate is not finite.
int orientation(const Vec2& a, const Vec2& b, const Vec2& c);

}  // namespace beltrami
