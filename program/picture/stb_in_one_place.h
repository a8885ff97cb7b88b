// Pictures in files, and what we use of the stb headers: PNG and JPEG to read, a small pixel font.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace beltrami::cli {

/// More than 16384 x 16384 would be gigabytes, which a small file may ask for.
inline constexpr std::int64_t kMostTexels = 268435456;

/// Pixels of 1 to 4 components of one byte or two each, or of single precision, in the order of the
/// machine; rows from the top.
struct Pixels {
  int width = 0, height = 0, components = 0;
  std::vector<std::uint8_t> values;
  std::size_t bytes = 1;  ///< of a component
  bool half = false;      ///< half of single precision is all that they have
  /// Bytes of a row.
  std::size_t row_size() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(components) * bytes;
  }
};

/// The bytes of a PNG file, of as many bits as the pixels.
std::string png_bytes(const Pixels& image);
/// The same of pixels with 8 bits for each component.
std::string png_bytes(int width, int height, int components, const std::uint8_t* pixels);

/// What a PNG, JPEG or WebP file shows, with 8 bits for each component, or 16 where a PNG has them;
/// nothing where it is none. WebP where the program is built with it.
std::optional<Pixels> read_image(std::string_view bytes);

/// Whether read_image may read this, by its first bytes.
bool is_image(std::string_view bytes);

/// A Radiance HDR file, in single precision; nothing where it is damaged.
std::optional<Pixels> read_hdr(std::string_view bytes);
/// The bytes of one. Precondition: three components of single precision.
std::string hdr_bytes(const Pixels& image);

/// Whether an image has the colours of a normal map: mostly blue, and not grey.
bool shows_directions(const Pixels& image);

/// Rectangles that make up a line of ASCII text, y down; a line is about 10 units high.
struct TextQuad {
  float x0, y0, x1, y1;
};
std::vector<TextQuad> text_quads(const std::string& text);
double text_width(const std::string& text);

}  // namespace beltrami::cli
