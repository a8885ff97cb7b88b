// What materials show through UVs, and how it is read.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
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
  char channel = 0;                ///< of MTL: the one that -imfchan names, or 0
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

/// The material of a texture that all materials share.
inline constexpr std::uint64_t kEveryMaterial = std::numeric_limits<std::uint64_t>::max();

/// What a picture of several materials has of one of them.
struct MergedPart {
  std::uint64_t material = 0;  ///< whose faces show it
  /// Nothing: it is white all over; of directions, flat.
  std::optional<TextureUse> texture;
  /// Of red, green, blue and alpha. Colours are multiplied by them, in linear light; of directions
  /// the first one is the scale. Of numbers green and blue are multiplied, and red goes towards 1
  /// as far as the first one is below it: it is occlusion.
  std::array<double, 4> factors = {1, 1, 1, 1};
  bool opaque = false;  ///< its alpha says nothing
};

/// One picture for several materials. Those of the `use` are the slots that it is put in.
struct MergedTexture {
  TextureUse use;
  std::vector<MergedPart> parts;
};

/// A texture for new UVs.
struct BakedTexture {
  TextureUse use;
  std::string png;   ///< the bytes of the file
  std::string path;  ///< of the file, or "" where the output holds it
  std::string uri;   ///< by which the output names it, or ""
};

}  // namespace beltrami::cli
