// Several surfaces as one: what beltrami_unwrap_surfaces unwraps.
#pragma once

#include <beltrami/beltrami.h>

#include <cstdint>
#include <vector>

#include "abi/surface.h"
#include "atlas/types.h"
#include "base/types.h"
#include "base/work.h"

namespace beltrami {

/// Polygons and what comes with them, of one surface or several, one after another.
struct AtlasProblem {
  LoadedSurface surface;
  AtlasInput input;
  std::vector<Index> bodies;  ///< the first vertex of each surface
};

/// Copies the counts with the caller's sizes checked, also of all together. Throws Error
/// INVALID_ARGUMENT or EMPTY.
std::vector<beltrami_surface> read_surface_headers(const beltrami_surface* const* surfaces,
                                                   std::uint64_t count);

/// Reads surfaces whose headers have been checked. `islands`: corner UVs count; `hard_angle` in
/// degrees. Of several, vertices, faces and corners count through all, in errors too. Throws Error
/// INVALID_ARGUMENT, INDEX_OUT_OF_RANGE or NON_FINITE with the element.
AtlasProblem read_problem(const std::vector<beltrami_surface>& headers, const AtlasOptions& options,
                          bool islands, double hard_angle, const Work& work);

}  // namespace beltrami
