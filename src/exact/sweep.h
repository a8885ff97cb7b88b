// A line that sweeps over a closed polygon and takes out edges until no two meet (after Shamos &
// Hoey 1976, "Geometric intersection problems").
#pragma once

#include <array>
#include <vector>

#include "base/types.h"
#include "exact/polygon.h"

namespace beltrami {

/// An edge that was taken out, and one that it meets and that was still there.
struct TakenOut {
  Index edge, because_of;
};

/// The edges whose removal leaves no two that meet illegally (see ClosedPolygon::meet), each once;
/// none if and only if the polygon is simple. Stops after `most` of them. Exact, and in
/// O(n log n) whatever the polygon: long edges side by side, nested boxes, vertices that coincide.
std::vector<TakenOut> take_out_meeting_edges(const ClosedPolygon& polygon, Index most);

}  // namespace beltrami
