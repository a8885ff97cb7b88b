// What we use of the stb headers: PNG and a small pixel font.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace beltrami::cli {

std::string png_bytes(int width, int height, const std::uint8_t* rgb);

/// Rectangles that make up a line of ASCII text, y down; a line is about 10 units high.
struct TextQuad {
  float x0, y0, x1, y1;
};
std::vector<TextQuad> text_quads(const std::string& text);
double text_width(const std::string& text);

}  // namespace beltrami::cli
