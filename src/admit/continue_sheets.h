// Sheets that meet: where three faces or more share an edge, those that continue each other.
#pragma once

#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"

namespace beltrami {

/// A half-edge 3 * face + corner of each of the faces that share an edge, more than two.
using Crowd = std::vector<Index>;

/// Glues pairs of each crowd in `twin`, those first that come closest to one flat sheet; of pairs
/// that bend alike, those that run against each other, and of these the ones that enclose the
/// lesser angle behind them, so that solids which touch along an edge come apart. Where as many
/// faces run one way as the other, no others are glued. Left open are the odd one, what would make
/// a piece one-sided, and crowds of more than 32. The order of faces and vertices has no say,
/// unless two vertices lie at one place. Preconditions: all other gluing is done; faces have area.
void continue_sheets(const std::vector<Vec3>& positions, const std::vector<Triangle>& faces,
                     const std::vector<Crowd>& crowds, std::vector<Index>& twin, const Work& work);

}  // namespace beltrami
