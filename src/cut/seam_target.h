// What seams are searched for.
#pragma once

#include "base/types.h"

namespace beltrami {

/// What is asked of seams. The shortest are sought that meet all of it; where that cannot be, those
/// that come near.
struct SeamTarget {
  double energy = 2.05;    ///< mean symmetric Dirichlet energy of the maps, above 2
  double p99 = 0;          ///< that exceeded on 1% of the area; 0: any
  Index max_charts = 0;    ///< beyond, no chart is parted for its overlaps; 0: any number
  double seam_budget = 0;  ///< length of the seams over the root of the area; 0: any
  /// How many times as long seams may be that a surface of flat and developable faces unfolds along
  /// without distortion; 0: such are not sought.
  double flat_seams = 1.5;
};

}  // namespace beltrami
