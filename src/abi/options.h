// The options of a context in their public values, and what the rooms below know them as.
#pragma once

#include <beltrami/beltrami.h>

#include <cstdint>

#include "atlas/atlas.h"
#include "base/work.h"
#include "chart/options.h"
#include "cut/seam_costs.h"
#include "cut/search.h"
#include "pack/pack.h"

namespace beltrami {

/// Values of the BELTRAMI_OPTION_ keys; the option table holds their ranges and words.
struct Options {
  std::int32_t method = BELTRAMI_METHOD_BELTRAMI;
  std::int32_t energy = BELTRAMI_ENERGY_SYMMETRIC_DIRICHLET;
  std::int64_t coarse_faces = 0;
  double tolerance = 1e-4;
  int max_iterations = 500;
  int threads = 1;
  bool unit_square = false;
  std::int32_t flatten = BELTRAMI_FLATTEN_METRIC;
  std::int32_t injectivity = BELTRAMI_INJECTIVITY_AUTO;
  bool refine = false;
  int refine_iterations = 0;
  double time_limit = 0;
  bool float32 = false;
  bool delaunay = false;
  std::int64_t memory_limit = 0;
  std::int32_t cut = BELTRAMI_CUT_AUTO;
  double hard_angle = 180;
  std::int32_t weld = BELTRAMI_WELD_AUTO;
  double weld_distance = 0;
  double fill_holes = 0.5;
  bool share_copies = false;
  std::int32_t stack = BELTRAMI_STACK_NONE;
  std::int32_t rectify = BELTRAMI_RECTIFY_NONE;
  std::int32_t preset = BELTRAMI_PRESET_NONE;
  SeamTarget target = {};
  SeamWeights weights = {};
  std::int32_t pack = BELTRAMI_PACK_PAGES;
  int resolution = 1024;
  double margin = 2;
  double texels_per_unit = 0;
  int max_pages = 0;
  std::int32_t pack_turns = BELTRAMI_PACK_TURNS_ANY;
  int pack_block = 1;
  double pack_splits = 0;
  bool snap_texels = false;
  std::int32_t effort = BELTRAMI_EFFORT_NORMAL;
};

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

/// The same for what an atlas takes no notice of: delaunay, weld-distance where nothing is welded,
/// what a search for seams is told where none is made, and what is said of pages where nothing is
/// packed, as with `pins`.
void require_effect_on_atlas(const Options& options, bool pins);

/// Sets the preset, and the options of the search for seams as it has them.
void apply_preset(Options& options, std::int32_t preset);

}  // namespace beltrami
