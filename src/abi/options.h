// The options of a context in their public values.
#pragma once

#include <beltrami/beltrami.h>

#include <cstdint>

#include "cut/seam_costs.h"
#include "cut/seam_target.h"

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
  double fill_weight = 10;
  bool snap_texels = false;
  bool label_pages = false;
  std::int32_t effort = BELTRAMI_EFFORT_NORMAL;
};

/// Sets the preset, and the options of the search for seams as it has them.
void apply_preset(Options& options, std::int32_t preset);

}  // namespace beltrami
