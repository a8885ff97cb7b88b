// The caller's straight edges and rectangles.
#pragma once

#include <beltrami/beltrami.h>

#include "abi/surface.h"
#include "atlas/types.h"
#include "base/work.h"

namespace beltrami {

/// Reads them into the input. Throws Error INVALID_ARGUMENT for a kind that is none, or
/// INDEX_OUT_OF_RANGE.
void read_straight(const beltrami_surface& header, const LoadedSurface& surface, const Work& work,
                   AtlasInput& input);

}  // namespace beltrami
