#include "abi/options.h"

namespace beltrami {

void apply_preset(Options& options, std::int32_t preset) {
  options.preset = preset;
  options.target = {};
  options.weights = {};
  switch (preset) {
    case BELTRAMI_PRESET_LIGHTMAP:
      options.target.energy = 2.1;
      options.weights.visibility = 0;
      options.weights.hard_edges = 0.5;
      options.target.flat_seams = 2;
      break;
    case BELTRAMI_PRESET_HARD_SURFACE:
      options.weights.hard_edges = 0.5;
      options.target.flat_seams = 6;
      break;
    case BELTRAMI_PRESET_TEXTURING:
      options.weights.concavity = 0.6;
      options.weights.visibility = 2;
      break;
    case BELTRAMI_PRESET_ONE_CHART:
      options.target.max_charts = 1;
      break;
    default:
      break;
  }
}

}  // namespace beltrami
