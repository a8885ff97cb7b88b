// The options as the rooms below take them, and which of them have no effect.
#pragma once

#include "abi/options.h"
#include "atlas/types.h"
#include "base/work.h"
#include "multilevel/options.h"
#include "pack/types.h"

namespace beltrami {

/// How a disk is to be flattened.
ChartOptions chart_options(const Options& options);

/// How charts are to be packed. Throws Error INVALID_ARGUMENT where the margin or the blocks are
/// too large for the pages.
PackOptions pack_options(const Options& options);

/// How a surface is to be unwrapped.
AtlasOptions atlas_options(const Options& options);

/// What a run may use.
Limits limits(const Options& options);

/// Throws Error INVALID_ARGUMENT, with a sentence that says what to do, where flatten, delaunay,
/// injectivity or refine-iterations is set to another value than its default and another option
/// leaves it without effect. Asked at the start of a run: options are set in any order. The numbers
/// coarse-faces, tolerance and max-iterations go with any method: those without such a stage have
/// nothing to bound.
void require_effect(const Options& options);

/// What comes with surfaces.
struct AtlasGivens {
  bool pins = false, labels = false;
};

/// The same for what an atlas takes no notice of: delaunay, weld-distance where nothing is welded,
/// what a search for seams is told where none is made, label-pages without labels, and what is said
/// of pages where nothing is packed, as with pins.
void require_effect_on_atlas(const Options& options, const AtlasGivens& given);

}  // namespace beltrami
