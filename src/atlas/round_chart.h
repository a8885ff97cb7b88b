// A placed map of one chart -> the numbers that are delivered, without a fold that it had not.
#pragma once

#include <vector>

#include "atlas/map_charts.h"
#include "atlas/open.h"
#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "mesh/disk_mesh.h"

namespace beltrami {

/// In which numbers a chart beside the others is delivered: x stands for x * 2^-exponent of the
/// type.
struct NumberFormat {
  int exponent = 0;
  bool float32 = false;  ///< in single precision
};

/// Rounds a map that was moved to `placed` (one per vertex), to doubles that rounded to nearest
/// stay injective in single precision; or to single-precision numbers at once. The outcome of the
/// map says where it does not stay injective.
void round_chart(const DiskMesh& mesh, const std::vector<Vec2>& placed, const NumberFormat& format,
                 const Work& work, MappedChart& map);

/// The same for a map that was moved onto a page: also where v is stored as 1 - v, as files and
/// hosts do whose V axis points down. To doubles on the first page where both roundings of them
/// stay injective, else to multiples of step_of(page), which no storing rounds. A chart that is too
/// small for these is drawn larger.
void round_on_page(const DiskMesh& mesh, const std::vector<Vec2>& placed, Index page, bool float32,
                   const Work& work, MappedChart& map);

/// The same for a map with pins, which is and stays where they put it; its outcome is judged anew,
/// as its boundary may touch itself.
void round_pinned(const AtlasChart& part, const NumberFormat& format, const Work& work,
                  MappedChart& map);

/// The single-precision numbers that a host stores whose V axis points down, turned over and moved
/// back exactly: u, and -(1 - v), each rounded to nearest.
std::vector<Vec2> stored_downwards(std::vector<Vec2> uvs, const Work& work);

}  // namespace beltrami
