// One image of a map: the UV layout coloured by distortion, and the model with a checkerboard.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "files/surface.h"

namespace beltrami::cli {

struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  ///< 3 bytes per pixel, rows from the top
};

/// Draws `mesh` (with finite UVs) and `face_energies`, its symmetric Dirichlet energies per face;
/// faces of infinite energy are red.
Image render_picture(const TriangleView& mesh, const std::vector<double>& face_energies);

/// The bytes of a PNG file.
std::string encode_png(const Image& image);

}  // namespace beltrami::cli
