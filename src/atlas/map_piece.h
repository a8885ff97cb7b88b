// A piece of a surface -> charts along seams that bring what is asked for, and their maps.
#pragma once

#include <vector>

#include "admit/admit.h"
#include "atlas/map_charts.h"
#include "atlas/open.h"
#include "atlas/pins.h"
#include "atlas/types.h"
#include "base/types.h"
#include "base/work.h"
#include "multilevel/chart_map.h"

namespace beltrami {

/// Charts of a piece and their maps.
struct Mapped {
  OpenedSurface opened;
  AssignedPins pins;
  std::vector<MappedChart> maps;
  AtlasEnergy energy;
  Index broken = 0;  ///< maps that are not injective
};

/// What all pieces are mapped with.
struct Task {
  const AtlasInput& input;
  const Admitted& admitted;
  const AtlasOptions& options;
  const int exponent;  ///< of the admitted surface
  double area = 0;     ///< of all pieces, in the unit of the whole
};

/// Of all its faces, in the square of the unit of the whole.
double area_of(const SurfacePiece& piece, const Work& work);

/// Whether something is asked that pieces cannot be held to one by one.
bool is_asked_of_whole(const AtlasInput& input, const AtlasOptions& options);

/// Opens a piece along the seams that are searched for the target, along its creases where that
/// leaves its faces flat and is not much longer, or along a short cut graph, and maps its charts.
Mapped map_piece(const Task& task, const SurfacePiece& piece, const Work& work,
                 std::vector<StageStatistics>& stages);

/// A piece that is congruent to another, whose maps are known: along the seams of that, unless they
/// miss the target here alone.
Mapped map_likewise(const Task& task, const SurfacePiece& piece, const SurfacePiece& like,
                    const Mapped& known, const Work& work, std::vector<StageStatistics>& stages);

}  // namespace beltrami
