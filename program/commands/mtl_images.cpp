#include "commands/mtl_images.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace beltrami::cli {
namespace {

/// Of all texels: how many of a cut-out may be between 0 and 255, those of its outline.
constexpr double kOutline = 0.1;

std::uint8_t byte_at(const Pixels& image, std::size_t i) {
  if (image.bytes == 1) return image.values[i];
  std::uint16_t value = 0;
  std::memcpy(&value, &image.values[2 * i], sizeof value);
  return static_cast<std::uint8_t>((value + 128) / 257);
}

/// Bilinear, of 8 bits.
Pixels resized(const Pixels& image, int width, int height) {
  Pixels made{width, height, image.components, {}};
  const auto components = static_cast<std::size_t>(image.components);
  const auto place = [](int at, int count, int old_count) {
    const double x = (at + 0.5) * old_count / count - 0.5;
    return std::clamp(x, 0.0, double(old_count - 1));
  };
  for (int row = 0; row < height; ++row) {
    const double y = place(row, height, image.height), top = std::floor(y);
    for (int column = 0; column < width; ++column) {
      const double x = place(column, width, image.width), left = std::floor(x);
      for (std::size_t k = 0; k < components; ++k) {
        double sum = 0;
        for (const int j : {0, 1}) {
          for (const int i : {0, 1}) {
            const double weight = (i ? x - left : 1 - x + left) * (j ? y - top : 1 - y + top);
            const auto from_row = static_cast<std::size_t>(std::min(top + j, image.height - 1.0));
            const auto from = static_cast<std::size_t>(std::min(left + i, image.width - 1.0));
            const std::size_t texel = from_row * static_cast<std::size_t>(image.width) + from;
            sum += weight * byte_at(image, components * texel + k);
          }
        }
        made.values.push_back(static_cast<std::uint8_t>(sum + 0.5));
      }
    }
  }
  return made;
}

std::size_t texels_of(const Pixels& image) {
  return static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
}

}  // namespace

Pixels channel_of(const Pixels& image, char channel, bool matte) {
  const auto components = static_cast<std::size_t>(image.components);
  const bool has_alpha = components % 2 == 0;
  const std::size_t colours = has_alpha ? components - 1 : components;
  const auto picked = [&](std::size_t k) {
    Pixels made{image.width, image.height, 1, {}};
    for (std::size_t i = 0; i < texels_of(image); ++i) {
      made.values.push_back(byte_at(image, components * i + k));
    }
    return made;
  };
  if (has_alpha && (channel == 'm' || (matte && channel == 0))) {
    Pixels alpha = picked(components - 1);
    const auto varies = [&](std::uint8_t value) { return value != alpha.values.front(); };
    if (channel == 'm' || std::any_of(alpha.values.begin(), alpha.values.end(), varies)) {
      return alpha;
    }
  }
  if (colours == 1 || channel == 'r') return picked(0);
  if (channel == 'g') return picked(1);
  if (channel == 'b') return picked(2);
  Pixels made{image.width, image.height, 1, {}};
  for (std::size_t i = 0; i < texels_of(image); ++i) {
    int sum = 0;
    for (std::size_t k = 0; k < 3; ++k) sum += byte_at(image, components * i + k);
    made.values.push_back(static_cast<std::uint8_t>((sum + 1) / 3));
  }
  return made;
}

Pixels roughness_and_metal(const std::optional<Pixels>& roughness,
                           const std::optional<Pixels>& metal) {
  int width = 0, height = 0;
  for (const auto& image : {&roughness, &metal}) {
    if (!*image) continue;
    width = std::max(width, (*image)->width);
    height = std::max(height, (*image)->height);
  }
  Pixels made{width, height, 3, {}};
  made.values.assign(3 * texels_of(made), 255);
  std::size_t channel = 1;
  for (const auto& image : {&roughness, &metal}) {
    if (*image) {
      const Pixels fitted = resized(**image, width, height);
      for (std::size_t i = 0; i < texels_of(made); ++i) {
        made.values[3 * i + channel] = fitted.values[i];
      }
    }
    ++channel;
  }
  return made;
}

Pixels colour_and_alpha(const std::optional<Pixels>& colour, const Pixels& alpha) {
  const int width = std::max(colour ? colour->width : 0, alpha.width);
  const int height = std::max(colour ? colour->height : 0, alpha.height);
  const Pixels fitted = resized(alpha, width, height);
  Pixels made{width, height, 4, {}};
  made.values.assign(4 * texels_of(made), 255);
  if (colour) {
    const Pixels shown = resized(*colour, width, height);
    const auto components = static_cast<std::size_t>(shown.components);
    for (std::size_t i = 0; i < texels_of(made); ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        made.values[4 * i + k] = shown.values[components * i + (components < 3 ? 0 : k)];
      }
    }
  }
  for (std::size_t i = 0; i < texels_of(made); ++i) made.values[4 * i + 3] = fitted.values[i];
  return made;
}

bool is_cut_out(const Pixels& alpha) {
  const auto between = std::count_if(alpha.values.begin(), alpha.values.end(),
                                     [](std::uint8_t value) { return value > 0 && value < 255; });
  return double(between) <= kOutline * double(alpha.values.size());
}

}  // namespace beltrami::cli
