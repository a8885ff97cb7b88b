// A disk in levels, from fine to coarse.
#pragma once

#include <optional>
#include <vector>

#include "base/types.h"
#include "base/work.h"
#include "mesh/disk_mesh.h"
#include "simplify/coarse.h"

namespace beltrami {

/// A known coarse disk is of use with this share of the faces, or less.
inline constexpr double kCoarseEnough = 0.3;

/// Each a coarse disk of the one before, the first one of `fine`; each about an eighth of that,
/// down to one of about `coarsest_faces`. Sweeps (sweep.h) as far as they get, then passes. A
/// `known` coarse disk of `fine` is the first one where it is of use. Empty where the disk cannot
/// be simplified so far.
std::vector<CoarseDisk> coarser_levels(const DiskMesh& fine, const std::optional<CoarseDisk>& known,
                                       Index coarsest_faces, const Work& work);

}  // namespace beltrami
