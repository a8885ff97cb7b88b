// A placed map of one chart -> the numbers that are delivered, without a fold that it had not.
#pragma once

#include <vector>

#include "atlas/map_charts.h"
#include "atlas/open.h"
#include "base/vectors.h"
#include "base/work.h"
#include "mesh/disk_mesh.h"

namespace beltrami {

/// In which numbers a chart is delivered: x stands for x * 2^-exponent of the type.
struct NumberFormat {
  int exponent = 0;
  bool float32 = false;       ///< in single precision
  bool single_first = false;  ///< in single precision also without, where that stays injective
};

/// Rounds a map that was moved to `placed` (one per vertex), to doubles that rounded to nearest
/// stay injective in single precision; or to single-precision numbers at once. The outcome of the
/// map says where it does not stay injective.
void round_chart(const DiskMesh& mesh, const std::vector<Vec2>& placed, const NumberFormat& format,
                 const Work& work, MappedChart& map);

/// The same for a map with pins, which is and stays where they put it; its outcome is judged anew,
/// as its boundary may touch itself.
void round_pinned(const AtlasChart& part, const NumberFormat& format, const Work& work,
                  MappedChart& map);

}  // namespace beltrami
