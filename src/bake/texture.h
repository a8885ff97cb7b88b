// A texture that is read between its texels.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "bake/image.h"
#include "base/work.h"

namespace beltrami {

/// What was read so far: components times what they count, and of colours with an alpha that alone.
using TexelSums = std::array<float, 4>;

/// A place of an image, which is [0, 1]^2.
struct Place {
  double u = 0, v = 0;
};

/// IEC 61966-2-1 as tables: powers would take longer than all else.
struct ColourTables {
  ColourTables();
  std::array<float, 256> linear_of_byte;     ///< in [0, 65535]
  std::array<float, 256> number_of_byte;     ///< the same of what is no colour
  std::vector<std::uint8_t> byte_of_linear;  ///< of 65536 steps of linear light
};

/// An image, and the same made smaller by halves, for what shows many of its texels at once. Whole
/// numbers count in 1/65535, floats as they are.
class Texture {
 public:
  /// The image in the caller's memory is read until the end; `tables` likewise. Of colours in more
  /// than 8 bits a copy in linear light is made.
  Texture(const ImageView& image, ImageKind kind, const ColourTables& tables, const Work& work);

  int width() const { return levels_.front().width; }
  int height() const { return levels_.front().height; }
  int components() const { return components_; }
  PixelType type() const { return type_; }

  /// Makes the image smaller, up to `count` times.
  void make_levels(int count, const Work& work);

  /// Adds what is shown at each place of level `level`, or the last one that there is, to the sums
  /// of the same number. The V axis of the image points up. Precondition: u and v are finite.
  void add(std::span<const Place> places, const ImageReading& reading, int level,
           std::span<TexelSums> sums) const {
    const std::size_t last = levels_.size() - 1;
    const Level& of =
        levels_[static_cast<std::size_t>(level) < last ? static_cast<std::size_t>(level) : last];
    of.gather(of, *tables_, places, reading, sums);
  }
  /// Writes texels that stand side by side, each of which `count` places were added to, of as many
  /// components as the image and of its type.
  void finish(std::span<const TexelSums> sums, float count, unsigned char* texels) const {
    finish_(*tables_, sums, count, texels);
  }

  /// What stands for 0 in a component that goes from -1 to 1, once it is added.
  float zero() const { return type_ == PixelType::kFloat ? 0.5f : 32767.5f; }

 private:
  struct Level;
  using Gather = void (*)(const Level&, const ColourTables&, std::span<const Place>,
                          const ImageReading&, std::span<TexelSums>);
  using Finish = void (*)(const ColourTables&, std::span<const TexelSums>, float count,
                          unsigned char* texels);
  struct Level {
    int width = 0, height = 0;
    PixelType type = PixelType::kByte;
    std::size_t row_bytes = 0;
    const unsigned char* pixels = nullptr;
    std::vector<unsigned char> own;
    int colours = 0;  ///< components that are bytes of sRGB
    Gather gather = nullptr;
  };
  template <PixelType kType, int kComponents, int kColours, bool kWeighted>
  static void gather(const Level& level, const ColourTables& tables, std::span<const Place> places,
                     const ImageReading& reading, std::span<TexelSums> sums);
  template <PixelType kType, int kComponents, int kColours, bool kWeighted>
  static void finish_as(const ColourTables& tables, std::span<const TexelSums> sums, float count,
                        unsigned char* texels);
  template <PixelType kType, bool kColours>
  static Finish finish_of(int components, bool weighted);
  template <PixelType kType>
  Finish finish_of(bool colours) const;
  template <PixelType kType, bool kColours>
  static Gather gather_of(int components, bool weighted);
  Gather gather_for(PixelType type, bool colours) const;
  void own_linear(const ImageView& image, Level& level, const Work& work) const;
  Level half_of(const Level& level, const Work& work) const;
  template <PixelType kType>
  void read_texel(const Level& level, int row, int column, TexelSums& texel) const;
  using EvenHalving = void (*)(const Level&, const ColourTables&, std::size_t row, int width,
                               unsigned char* out);
  template <PixelType kType, int kComponents>
  static void halve_evenly(const Level& level, const ColourTables& tables, std::size_t row,
                           int width, unsigned char* out);
  template <PixelType kType>
  static EvenHalving even_halving_of(int components);
  template <PixelType kType>
  void halve_rows(const Level& level, Level& half, const Work& work) const;
  bool weighted() const { return kind_ == ImageKind::kTransparent && components_ % 2 == 0; }
  bool is_colour() const {
    return kind_ == ImageKind::kColours || kind_ == ImageKind::kTransparent;
  }
  /// How many components are colours.
  int colours() const {
    if (!is_colour()) return 0;
    return components_ % 2 == 0 ? components_ - 1 : components_;
  }

  std::vector<Level> levels_;
  Finish finish_ = nullptr;
  const ColourTables* tables_;
  int components_ = 0;
  ImageKind kind_ = ImageKind::kNumbers;
  PixelType type_ = PixelType::kByte;
};

}  // namespace beltrami
