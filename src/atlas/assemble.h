// What was mapped and placed, as an atlas of the input's corners, and the verdict on it.
#pragma once

#include <vector>

#include "admit/admit.h"
#include "atlas/map_charts.h"
#include "atlas/open_and_map.h"
#include "atlas/types.h"
#include "base/types.h"
#include "base/work.h"
#include "repair/rounding.h"

namespace beltrami {

/// The maps of a surface as they lie on their pages: scaled by `scales`, one per chart, and by
/// `page_scale`.
struct PlacedMaps {
  const MappedSurface& surface;
  const std::vector<MappedChart>& maps;
  const std::vector<double>& scales;
  double page_scale = 1;
};

/// The charts' outcomes, energies and counts, and the UVs of all corners.
void assemble(const AtlasInput& input, const AtlasOptions& options, const Admitted& admitted,
              const PlacedMaps& placed, const Work& work, Atlas& atlas);

/// Judges the faces but for those excepted, and sets certificates and outcome: of the UVs as they
/// are, and rounded to single precision, where x stands for x * 2^-exponent. unwrap has done so.
void judge_atlas(int exponent, bool float32, const Work& work, Atlas& atlas);

/// The faces as they are to be judged: turned over where they were reversed.
std::vector<Triangle> oriented_faces(const Atlas& atlas);

/// Into the unit that is delivered, by a power of two; `exponent`: of the surface.
void deliver(const Numbers& numbers, int exponent, Atlas& atlas);

}  // namespace beltrami
