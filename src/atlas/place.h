// Where charts lie in the plane, in the numbers that are delivered.
#pragma once

#include <vector>

#include "atlas/map_charts.h"
#include "atlas/open.h"
#include "base/work.h"

namespace beltrami {

/// Lays the maps out without overlap, in the numbers to be delivered: x stands for x * 2^-exponent,
/// the exponent being what is returned. That is `exponent`, or with `unit_square` the one that
/// brings all of them into [0, 1]^2. A single map stays where it is, but for that, and so do those
/// with pins; others are turned so that the longer sides of their least boxes lie along x, and
/// stand in rows above those. A map that rounding would fold is mended, but for its pins, and its
/// outcome says where it cannot be; that of a map with pins is judged anew, for its boundary may
/// touch itself. Precondition: no pins with `unit_square`.
int place_maps(const std::vector<AtlasChart>& charts, int exponent, bool unit_square, bool float32,
               std::vector<MappedChart>& maps, const Work& work);

}  // namespace beltrami
