// Maps of MTL, each an image of its own, in the channels that glTF has for them.
#pragma once

#include <optional>

#include "picture/stb_in_one_place.h"

namespace beltrami::cli {

/// One number for each texel, of 8 bits: the channel that `-imfchan` names (r, g, b, m for alpha),
/// or else the brightness. `matte`: without a name an alpha that varies comes first.
Pixels channel_of(const Pixels& image, char channel, bool matte);

/// Green and blue are roughness and metal, each as large as the larger one; 255 where there is
/// none. Precondition: one is there.
Pixels roughness_and_metal(const std::optional<Pixels>& roughness,
                           const std::optional<Pixels>& metal);

/// Colours, white without an image, with this alpha.
Pixels colour_and_alpha(const std::optional<Pixels>& colour, const Pixels& alpha);

/// Whether all but a few texels of an image of one channel are 0 or 255: a cut-out.
bool is_cut_out(const Pixels& alpha);

}  // namespace beltrami::cli
