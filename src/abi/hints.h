// The caller's paint and materials as hints to the search for seams.
#pragma once

#include <beltrami/beltrami.h>

#include "abi/surface.h"
#include "atlas/open.h"
#include "atlas/types.h"
#include "base/work.h"

namespace beltrami {

/// Reads what draws seams: materials per triangle. Throws Error INVALID_ARGUMENT where none are
/// searched for, or with the vertex where its paint is no finite number of 0 or more, or naming the
/// painted edge; INDEX_OUT_OF_RANGE naming the painted edge.
InputHints read_hints(const beltrami_surface& header, const LoadedSurface& surface,
                      const AtlasOptions& options, const Work& work);

}  // namespace beltrami
