// What materials show through UVs, and how it is read.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace beltrami::cli {

/// What a texture shows beyond its edges: its outermost texels, itself again, or itself mirrored at
/// every other time.
enum class Beyond { kClamp, kRepeat, kMirror };

/// How the texels of a texture are read.
struct Reading {
  Beyond along_u = Beyond::kRepeat, along_v = Beyond::kRepeat;
  bool nearest = false;  ///< each place shows its texel, without those beside it
};

/// What the components of a texture are, which says how a mean of them is taken.
enum class Meaning {
  kNumbers,      ///< roughness, heights: as they are
  kColours,      ///< of sRGB: in linear light; an alpha is a number
  kTransparent,  ///< the same, and a colour counts as much as its alpha
  kRelief,       ///< heights, or else directions: the colours of the image say which
  kDirections    ///< two coordinates along the axes of the UVs, 0.5 being 0, and numbers
};

/// A texture of a material, with all that says what the model shows of it.
struct TextureUse {
  std::string name;                ///< for people: "baseColorTexture of materials[2] 'wood'"
  std::string stem;                ///< for files: "wood_baseColor"
  std::string keyword;             ///< of MTL, in small letters: "map_kd"
  std::uint64_t material = 0;      ///< by its number in the file that has it
  std::vector<std::string> slots;  ///< where the material names it: JSON pointers, or keywords
  std::string image;               ///< for people: "images[3] 'wood.jpg'"
  std::uint64_t number = 0;        ///< of that image in the file that has it
  std::uint64_t uv_set = 0;
  /// From UVs, whose V axis points up, to places on the image: a u + b v + c, and d u + e v + f.
  std::array<double, 6> transform = {1, 0, 0, 0, 1, 0};
  Reading reading;
  Meaning meaning = Meaning::kNumbers;
};

/// A texture for new UVs.
struct BakedTexture {
  TextureUse use;
  std::string png;   ///< the bytes of the file
  std::string path;  ///< of the file, or "" where the output holds it
  std::string uri;   ///< by which the output names it, or ""
};

}  // namespace beltrami::cli
