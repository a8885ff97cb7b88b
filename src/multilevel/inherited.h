// What is known of a disk that was cut out of a larger surface.
#pragma once

#include <optional>
#include <vector>

#include "base/vectors.h"
#include "simplify/coarse.h"

namespace beltrami {

/// Each may be missing: then it is made.
struct Inherited {
  /// The disk in part simplified, from which its coarse mesh goes on.
  std::optional<CoarseDisk> level = {};
  /// A map to start from where the disk is its own coarse mesh: one UV per vertex, or none. Taken
  /// if every face is positive in it and, where the boundary is to be simple, that is so.
  std::vector<Vec2> start = {};
};

}  // namespace beltrami
