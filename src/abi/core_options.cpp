#include "abi/core_options.h"

#include <charconv>
#include <string>
#include <utility>

#include "abi/option_entry.h"
#include "abi/option_table.h"
#include "base/error.h"
#include "cut/search_effort.h"
#include "energy/energy.h"

namespace beltrami {
namespace {

Method method_of(std::int32_t value) {
  switch (value) {
    case BELTRAMI_METHOD_CM:
      return Method::kCm;
    case BELTRAMI_METHOD_TUTTE:
      return Method::kTutte;
    case BELTRAMI_METHOD_GIF:
      return Method::kGif;
    case BELTRAMI_METHOD_BFF:
      return Method::kBff;
    case BELTRAMI_METHOD_UV_PROLONGATION:
      return Method::kUvProlongation;
    default:
      return Method::kBeltrami;
  }
}

Flatten flatten_of(std::int32_t value) {
  switch (value) {
    case BELTRAMI_FLATTEN_DIRICHLET:
      return Flatten::kDirichlet;
    case BELTRAMI_FLATTEN_GIF:
      return Flatten::kGif;
    case BELTRAMI_FLATTEN_FLIM:
      return Flatten::kFlim;
    case BELTRAMI_FLATTEN_BFF:
      return Flatten::kBff;
    default:
      return Flatten::kMetric;
  }
}

Energy energy_of(std::int32_t value) {
  switch (value) {
    case BELTRAMI_ENERGY_SYMMETRIC_ARAP:
      return Energy::kSymmetricArap;
    case BELTRAMI_ENERGY_EXPONENTIAL_DIRICHLET:
      return Energy::kExponentialDirichlet;
    default:
      return Energy::kSymmetricDirichlet;
  }
}

Injectivity injectivity_of(std::int32_t value) {
  switch (value) {
    case BELTRAMI_INJECTIVITY_GLOBAL:
      return Injectivity::kGlobal;
    case BELTRAMI_INJECTIVITY_LOCAL:
      return Injectivity::kLocal;
    default:
      return Injectivity::kAuto;
  }
}

Stack stack_of(std::int32_t value) {
  switch (value) {
    case BELTRAMI_STACK_COPIES:
      return Stack::kCopies;
    case BELTRAMI_STACK_MIRRORED:
      return Stack::kMirrored;
    case BELTRAMI_STACK_HALVES:
      return Stack::kHalves;
    default:
      return Stack::kNone;
  }
}

/// The preset first: it is what set the others then.
constexpr std::int32_t kOfTheSearch[] = {
    BELTRAMI_OPTION_PRESET,          BELTRAMI_OPTION_TARGET_ENERGY,  BELTRAMI_OPTION_TARGET_P99,
    BELTRAMI_OPTION_MAX_CHARTS,      BELTRAMI_OPTION_SEAM_BUDGET,    BELTRAMI_OPTION_CONCAVE_SEAMS,
    BELTRAMI_OPTION_HIDDEN_SEAMS,    BELTRAMI_OPTION_HARD_SEAMS,     BELTRAMI_OPTION_MATERIAL_SEAMS,
    BELTRAMI_OPTION_SYMMETRIC_SEAMS, BELTRAMI_OPTION_STRAIGHT_SEAMS, BELTRAMI_OPTION_FLAT_SEAMS,
    BELTRAMI_OPTION_FILL_WEIGHT};

constexpr std::int32_t kOfPages[] = {
    BELTRAMI_OPTION_RESOLUTION,  BELTRAMI_OPTION_MARGIN,      BELTRAMI_OPTION_TEXELS_PER_UNIT,
    BELTRAMI_OPTION_MAX_PAGES,   BELTRAMI_OPTION_PACK_TURNS,  BELTRAMI_OPTION_PACK_BLOCK,
    BELTRAMI_OPTION_FILL_WEIGHT, BELTRAMI_OPTION_SNAP_TEXELS, BELTRAMI_OPTION_LABEL_PAGES};

/// Pages that are as many as it takes: as many as the option max-pages allows.
constexpr int kManyPages = 1000;

/// Rotations that the packer tries.
int turns_of(std::int32_t value) {
  switch (value) {
    case BELTRAMI_PACK_TURNS_QUARTER:
      return 4;
    case BELTRAMI_PACK_TURNS_NONE:
      return 1;
    default:
      return PackOptions{}.turns;
  }
}

Effort effort_of(std::int32_t value) {
  switch (value) {
    case BELTRAMI_EFFORT_QUICK:
      return Effort::kQuick;
    case BELTRAMI_EFFORT_HIGH:
      return Effort::kHigh;
    default:
      return Effort::kNormal;
  }
}

/// "flatten=bff": as the program's options, but for the dashes.
std::string written(const OptionEntry& option, const Options& options) {
  const double value = option.get(options);
  const auto index = static_cast<std::size_t>(value);
  char number[32];  // the shortest text that reads back to the value
  const std::string text =
      index < option.choices.size()
          ? option.choices[index]
          : std::string(number, std::to_chars(number, number + sizeof number, value).ptr);
  return std::string(option.name) + "=" + text;
}

/// Refuses `key` where it is not at its default; `where`: beside what; `instead`: what to do.
void refuse_if_set(const Options& options, std::int32_t key, const std::string& where,
                   const char* instead) {
  const OptionEntry& option = *find_option(key);
  const bool asks_for_nothing = key == BELTRAMI_OPTION_FILL_WEIGHT && options.fill_weight == 0;
  if (option.get(options) == option.get(Options{}) || asks_for_nothing) return;
  throw Error(Fault::kInvalidArgument, "the option " + written(option, options) +
                                           " has no effect with " + where + ": leave it out, " +
                                           instead);
}

}  // namespace

ChartOptions chart_options(const Options& options) {
  return {.method = method_of(options.method),
          .flatten = flatten_of(options.flatten),
          .injectivity = injectivity_of(options.injectivity),
          .energy = energy_of(options.energy),
          .coarse_faces = options.coarse_faces,
          .tolerance = options.tolerance,
          .max_iterations = options.max_iterations,
          .refine = options.refine,
          .refine_iterations = options.refine_iterations,
          .delaunay = options.delaunay,
          .unit_square = options.unit_square,
          .float32 = options.float32};
}

PackOptions pack_options(const Options& options) {
  PackOptions pack;
  pack.resolution = options.resolution;
  pack.margin = options.margin;
  pack.texels_per_unit = options.texels_per_unit;
  pack.turns = turns_of(options.pack_turns);
  pack.block = options.pack_block;
  pack.max_pages = options.max_pages > 0         ? options.max_pages
                   : options.texels_per_unit > 0 ? kManyPages
                                                 : 1;
  const bool is_wide = 4 * pack.margin > pack.resolution;
  if (is_wide || 8 * pack.block > pack.resolution) {
    throw Error(Fault::kInvalidArgument,
                is_wide ? "the option margin is more than a quarter of the resolution: lower it, "
                          "or raise resolution"
                        : "the option pack-block is more than an eighth of the resolution: lower "
                          "it, or raise resolution");
  }
  return pack;
}

AtlasOptions atlas_options(const Options& options) {
  AtlasOptions atlas;
  atlas.admit.weld_distance = options.weld_distance;
  if (options.weld == BELTRAMI_WELD_OFF) atlas.admit.weld_distance.reset();
  atlas.admit.share_copies = options.share_copies;
  atlas.keep_disk = options.weld == BELTRAMI_WELD_AUTO && options.weld_distance == 0;
  atlas.fill_limit = options.fill_holes;
  atlas.stack = stack_of(options.stack);
  atlas.rectify_grids = options.rectify == BELTRAMI_RECTIFY_GRIDS;
  if (options.cut == BELTRAMI_CUT_AUTO) atlas.target = options.target;
  atlas.weights = options.weights;
  atlas.effort = search_effort(effort_of(options.effort));
  if (options.pack == BELTRAMI_PACK_PAGES) {
    atlas.pack = pack_options(options);
    atlas.pack->snap = options.snap_texels;
    atlas.label_pages = options.label_pages;
  }
  // Seams that are given or symmetric are to stay so.
  const bool is_free = options.cut == BELTRAMI_CUT_AUTO && options.weights.symmetry == 0;
  if (is_free && options.texels_per_unit == 0) atlas.fill_weight = options.fill_weight;
  atlas.chart = chart_options(options);
  atlas.unit_square = std::exchange(atlas.chart.unit_square, false);
  atlas.float32 = std::exchange(atlas.chart.float32, false);
  return atlas;
}

Limits limits(const Options& options) {
  return {.threads = options.threads,
          .memory_bytes = options.memory_limit,
          .seconds = options.time_limit};
}

void require_effect(const Options& options) {
  const Method method = method_of(options.method);
  const std::string with_method = written(*find_option(BELTRAMI_OPTION_METHOD), options);
  const bool flattens =
      method == Method::kBeltrami || method == Method::kGif || method == Method::kBff;
  const bool optimises = method == Method::kBeltrami || method == Method::kUvProlongation ||
                         method == Method::kCm || options.refine;
  if (method != Method::kBeltrami) {
    refuse_if_set(options, BELTRAMI_OPTION_FLATTEN, with_method, "or take method=beltrami");
  }
  if (!flattens) {
    refuse_if_set(options, BELTRAMI_OPTION_DELAUNAY, with_method,
                  "or take method=beltrami, gif or bff");
  }
  if (!optimises) {
    refuse_if_set(options, BELTRAMI_OPTION_INJECTIVITY, with_method,
                  "or take method=beltrami or cm, or refine");
  }
  if (!options.refine) {
    refuse_if_set(options, BELTRAMI_OPTION_REFINE_ITERATIONS, "refine=0", "or set refine");
  }
}

void require_effect_on_atlas(const Options& options, const AtlasGivens& given) {
  const bool pins = given.pins;
  require_effect(options);
  refuse_if_set(options, BELTRAMI_OPTION_DELAUNAY, "an atlas", "or flatten disks");
  if (options.weld == BELTRAMI_WELD_OFF) {
    refuse_if_set(options, BELTRAMI_OPTION_WELD_DISTANCE, "weld=off", "or weld");
  }
  if (options.cut != BELTRAMI_CUT_AUTO) {
    const std::string with_cut = written(*find_option(BELTRAMI_OPTION_CUT), options);
    for (const std::int32_t key : kOfTheSearch) {
      refuse_if_set(options, key, with_cut, "or take cut=auto");
    }
  }
  const std::pair<bool, const char*> of_the_whole[] = {
      {pins, "pins"},
      {options.target.max_charts > 0, "a number of charts"},
      {options.target.seam_budget > 0, "a budget of seams"},
      {options.weights.symmetry > 0, "symmetric seams"}};
  for (const auto& [is_asked, what] : of_the_whole) {
    if (is_asked) refuse_if_set(options, BELTRAMI_OPTION_STACK, what, "or do without them");
  }
  if (options.weights.symmetry > 0) {
    refuse_if_set(options, BELTRAMI_OPTION_FILL_WEIGHT, "symmetric seams", "or do without them");
  }
  if (!given.labels) {
    refuse_if_set(options, BELTRAMI_OPTION_LABEL_PAGES, "no face labels", "or give them");
  }
  if (options.label_pages) {
    refuse_if_set(options, BELTRAMI_OPTION_STACK, "pages by labels", "or do without them");
  }
  if (options.pack == BELTRAMI_PACK_PAGES && !pins) {
    if (options.texels_per_unit > 0) {
      refuse_if_set(options, BELTRAMI_OPTION_FILL_WEIGHT,
                    written(*find_option(BELTRAMI_OPTION_TEXELS_PER_UNIT), options),
                    "or let charts be as large as they fit");
    }
    return;
  }
  for (const std::int32_t key : kOfPages) {
    refuse_if_set(options, key, pins ? "pins" : "pack=none",
                  pins ? "or do without pins" : "or take pack=pages");
  }
}

}  // namespace beltrami
