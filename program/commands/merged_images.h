// The images of several materials as the pages of one texture.
#pragma once

#include <vector>

#include "files/texture_use.h"
#include "picture/stb_in_one_place.h"

namespace beltrami::cli {

/// What one of the materials shows: an image, and where the corners of its triangles are on it.
struct MergedImage {
  Pixels pixels;
  Reading reading;
  std::vector<double> uvs;  ///< u v each, V axis up; NaN for those without
};

/// The image of a part without a texture: one texel.
Pixels plain_image(Meaning meaning);

/// Applies the factors of a part to its image, which gets as many components as `meaning` asks for:
/// 4 with an alpha that says something, else 3.
void apply_factors(Pixels& image, Meaning meaning, const MergedPart& part);

/// Has all images be read in one way, which is returned, and of the most bits that one has. Those
/// that are read otherwise are made anew with what they show beyond their edges. Throws Failure,
/// which begins with `name`, where that would be much larger than the image.
Reading unite(std::vector<MergedImage>& images, const std::string& name);

}  // namespace beltrami::cli
