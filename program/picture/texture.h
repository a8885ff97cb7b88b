// A texture that is read between its texels.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "files/texture_use.h"
#include "picture/stb_in_one_place.h"

namespace beltrami::cli {

/// What was read so far: components times what they count, and of colours with an alpha that alone.
using Sums = std::array<float, 4>;

/// The texels of an image in 16 bits, in which linear light keeps apart what 8 bits of sRGB do, and
/// the image made smaller by halves, for what shows many of its texels at once.
class Texture {
 public:
  Texture() = default;
  Texture(const Pixels& image, Meaning meaning);

  int width() const { return levels_.empty() ? 0 : levels_.front().width; }
  int height() const { return levels_.empty() ? 0 : levels_.front().height; }
  int components() const { return components_; }

  /// Makes the image smaller, up to `count` times.
  void make_levels(int count);

  /// Adds what is shown at a place of level `level`, or the last one that there is. The image is
  /// [0, 1]^2, its V axis points up. Precondition: u and v are finite.
  void add(double u, double v, const Reading& reading, int level, Sums& sums) const;
  /// The texel that `count` times add() make, of as many components as the image.
  void finish(const Sums& sums, float count, std::uint8_t* texel) const;

  /// What stands for 0 in a component that goes from -1 to 1, once it is added.
  static constexpr float kZero = 32767.5f;

 private:
  struct Level {
    int width = 0, height = 0;
    std::vector<std::uint16_t> values;
  };
  template <int kComponents, bool kWeighted>
  static void gather(const Level& level, double u, double v, const Reading& reading, Sums& sums);
  Level half_of(const Level& level) const;

  std::vector<Level> levels_;
  int components_ = 0;
  Meaning meaning_ = Meaning::kNumbers;
};

}  // namespace beltrami::cli
