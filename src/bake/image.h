// Images in the caller's memory, and how they are read.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace beltrami {

enum class PixelType { kByte, kShort, kFloat };

inline std::size_t bytes_of(PixelType type) {
  return type == PixelType::kByte ? 1 : type == PixelType::kShort ? 2 : 4;
}

/// Rows from the top (v = 1), `row_bytes` from one to the next; numbers are where their type may
/// be read.
struct ImageView {
  const unsigned char* pixels = nullptr;
  int width = 0, height = 0;
  int components = 0;  ///< 1 to 4
  PixelType type = PixelType::kByte;
  std::size_t row_bytes = 0;
};

/// What an image shows beyond its edges: itself again, its outermost texels, or itself mirrored at
/// every other time.
enum class Beyond { kRepeat, kClamp, kMirror };

struct ImageReading {
  Beyond along_u = Beyond::kRepeat, along_v = Beyond::kRepeat;
  bool nearest = false;  ///< each place shows its texel, without those beside it
};

/// What the components of an image are, which says how a mean of them is taken.
enum class ImageKind {
  kNumbers,      ///< roughness, heights, linear light: as they are
  kColours,      ///< of sRGB: in linear light; an alpha is a number
  kTransparent,  ///< the same, and a colour counts as much as its alpha
  kDirections,   ///< two coordinates along the axes of the UVs, one half being 0, and numbers
  kOcclusion     ///< none are read: how much of a grey sky a point sees, from 0 to 1
};

using UvTriangle = std::array<std::array<double, 2>, 3>;

/// The page of a triangle that is on none.
inline constexpr std::uint32_t kNoPage = 0xFFFFFFFF;

}  // namespace beltrami
