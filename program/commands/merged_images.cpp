#include "commands/merged_images.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <string>

#include "process/failure.h"

namespace beltrami::cli {
namespace {

/// Sides of an image that its clamped edges may add to it at most: what is beyond is one colour
/// anyway, and few models read so far.
constexpr double kMostPadding = 3;

double linear_of(double s) {
  return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

double srgb_of(double light) {
  return light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
}

std::size_t texels_of(const Pixels& image) {
  return static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
}

/// Component `i` of all, one after another, and back.
std::uint32_t value_at(const Pixels& image, std::size_t i) {
  if (image.bytes == 1) return image.values[i];
  std::uint16_t value = 0;
  std::memcpy(&value, &image.values[2 * i], sizeof value);
  return value;
}

void set_value(Pixels& image, std::size_t i, std::uint32_t value) {
  if (image.bytes == 1) {
    image.values[i] = static_cast<std::uint8_t>(value);
  } else {
    const auto number = static_cast<std::uint16_t>(value);
    std::memcpy(&image.values[2 * i], &number, sizeof number);
  }
}

std::uint32_t most_of(const Pixels& image) {
  return image.bytes == 1 ? 255 : 65535;
}

/// Grey becomes three of a colour; a missing alpha is opaque.
Pixels with_components(const Pixels& image, int components) {
  if (image.components == components) return image;
  Pixels made{image.width, image.height, components, {}, image.bytes};
  const auto count = static_cast<std::size_t>(components);
  const auto old_count = static_cast<std::size_t>(image.components);
  made.values.resize(texels_of(image) * count * image.bytes);
  for (std::size_t i = 0; i < texels_of(image); ++i) {
    for (std::size_t k = 0; k < count; ++k) {
      const bool grey = old_count < 3;
      std::size_t from = grey ? 0 : k;
      if (k == 3) from = old_count % 2 == 0 ? old_count - 1 : old_count;
      set_value(made, count * i + k,
                from < old_count ? value_at(image, old_count * i + from) : most_of(image));
    }
  }
  return made;
}

/// Maps the values of one component.
void map_component(Pixels& image, std::size_t k, const std::function<double(double)>& to) {
  const double most = most_of(image);
  std::vector<std::uint32_t> table(most_of(image) + std::size_t{1});
  for (std::size_t i = 0; i < table.size(); ++i) {
    table[i] = static_cast<std::uint32_t>(most * std::clamp(to(double(i) / most), 0.0, 1.0) + 0.5);
  }
  const auto count = static_cast<std::size_t>(image.components);
  for (std::size_t i = 0; i < texels_of(image); ++i) {
    set_value(image, count * i + k, table[value_at(image, count * i + k)]);
  }
}

void scale_directions(Pixels& image, double scale) {
  const auto count = static_cast<std::size_t>(image.components);
  const double most = most_of(image);
  for (std::size_t i = 0; i < texels_of(image); ++i) {
    std::array<double, 3> direction{};
    double square = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      direction[k] = 2 * value_at(image, count * i + k) / most - 1;
      if (k < 2) direction[k] *= scale;
      square += direction[k] * direction[k];
    }
    const double length = square > 0 ? std::sqrt(square) : 1;
    for (std::size_t k = 0; k < 3; ++k) {
      const double value = std::clamp(direction[k] / length / 2 + 0.5, 0.0, 1.0);
      set_value(image, count * i + k, static_cast<std::uint32_t>(most * value + 0.5));
    }
  }
}

/// Which texel of an image a place of a larger one shows, along one axis, and how a UV is scaled.
struct Axis {
  std::vector<int> texels;
  double scale = 1, offset = 0;
};

/// `up`: the first texel of the axis is the last of the image's rows.
Axis axis_of(int count, Beyond beyond, const std::vector<double>& uvs, std::size_t first, bool up,
             const std::string& name) {
  Axis axis;
  double low = 0, high = 1;
  for (std::size_t i = first; i < uvs.size(); i += 2) {
    if (!std::isfinite(uvs[i])) continue;
    low = std::min(low, uvs[i]);
    high = std::max(high, uvs[i]);
  }
  if (beyond == Beyond::kMirror) {
    for (int i = 0; i < 2 * count; ++i) axis.texels.push_back(i < count ? i : 2 * count - 1 - i);
    axis.scale = 0.5;
  } else if (beyond == Beyond::kClamp) {
    if (high - low - 1 > kMostPadding) {
      throw Failure(name +
                    ": one of its images is clamped at its edges, and UVs are far beyond "
                    "these: do without --merge-materials");
    }
    // Bilinear reading has half a texel more.
    const int before = static_cast<int>(std::ceil(-low * count)) + 1;
    const int behind = static_cast<int>(std::ceil((high - 1) * count)) + 1;
    for (int i = -before; i < count + behind; ++i) {
      axis.texels.push_back(std::clamp(i, 0, count - 1));
    }
    axis.scale = double(count) / double(axis.texels.size());
    axis.offset = double(before) / double(axis.texels.size());
  } else {
    for (int i = 0; i < count; ++i) axis.texels.push_back(i);
  }
  if (up) {
    std::reverse(axis.texels.begin(), axis.texels.end());
    for (int& texel : axis.texels) texel = count - 1 - texel;
  }
  return axis;
}

void show_beyond(MergedImage& image, const std::string& name) {
  const Pixels& old = image.pixels;
  const Axis u = axis_of(old.width, image.reading.along_u, image.uvs, 0, false, name);
  const Axis v = axis_of(old.height, image.reading.along_v, image.uvs, 1, true, name);
  Pixels made{static_cast<int>(u.texels.size()),
              static_cast<int>(v.texels.size()),
              old.components,
              {},
              old.bytes};
  const std::size_t texel = old.bytes * static_cast<std::size_t>(old.components);
  made.values.reserve(texels_of(made) * texel);
  for (const int row : v.texels) {
    for (const int column : u.texels) {
      const auto at = old.values.begin() +
                      static_cast<std::ptrdiff_t>(static_cast<std::size_t>(row) * old.row_size() +
                                                  static_cast<std::size_t>(column) * texel);
      made.values.insert(made.values.end(), at, at + static_cast<std::ptrdiff_t>(texel));
    }
  }
  for (std::size_t i = 0; i < image.uvs.size(); ++i) {
    const Axis& axis = i % 2 == 0 ? u : v;
    image.uvs[i] = axis.scale * image.uvs[i] + axis.offset;
  }
  image.pixels = std::move(made);
}

void make_16_bit(Pixels& image) {
  constexpr std::uint32_t kPerByte = 257;  // from 8 bits to 16, exactly
  Pixels made{image.width, image.height, image.components, {}, 2};
  made.values.resize(2 * image.values.size());
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    set_value(made, i, kPerByte * image.values[i]);
  }
  image = std::move(made);
}

}  // namespace

Pixels plain_image(Meaning meaning) {
  if (meaning == Meaning::kDirections) return {1, 1, 3, {128, 128, 255}};
  return {1, 1, 3, {255, 255, 255}};
}

void apply_factors(Pixels& image, Meaning meaning, const MergedPart& part) {
  image = with_components(image, meaning == Meaning::kTransparent ? 4 : 3);
  const std::array<double, 4>& factors = part.factors;
  if (meaning == Meaning::kDirections) {
    if (factors[0] != 1) scale_directions(image, factors[0]);
    return;
  }
  for (std::size_t k = 0; k < static_cast<std::size_t>(image.components); ++k) {
    const double factor = k == 3 && part.opaque ? 1 : factors[k];
    if (k == 3 && part.opaque) {
      map_component(image, k, [](double) { return 1.0; });
    } else if (factor == 1) {
      continue;
    } else if (meaning == Meaning::kNumbers && k == 0) {
      map_component(image, k, [&](double value) { return 1 + factor * (value - 1); });
    } else if (meaning == Meaning::kNumbers || k == 3) {
      map_component(image, k, [&](double value) { return factor * value; });
    } else {
      map_component(image, k, [&](double value) { return srgb_of(factor * linear_of(value)); });
    }
  }
}

Reading unite(std::vector<MergedImage>& images, const std::string& name) {
  const auto is_plain = [](const MergedImage& image) { return texels_of(image.pixels) == 1; };
  const auto first = std::find_if_not(images.begin(), images.end(), is_plain);
  const Reading like = first == images.end() ? Reading{} : first->reading;
  bool same = true, nearest = true;
  for (const MergedImage& image : images) {
    if (is_plain(image)) continue;
    same = same && image.reading.along_u == like.along_u && image.reading.along_v == like.along_v;
    nearest = nearest && image.reading.nearest;
  }
  for (MergedImage& image : images) {
    if (!same && !is_plain(image)) show_beyond(image, name);
  }
  const auto is_deep = [](const MergedImage& image) { return image.pixels.bytes == 2; };
  if (std::any_of(images.begin(), images.end(), is_deep)) {
    for (MergedImage& image : images) {
      if (!is_deep(image)) make_16_bit(image.pixels);
    }
  }
  Reading reading = same ? like : Reading{};
  reading.nearest = nearest && first != images.end();
  return reading;
}

}  // namespace beltrami::cli
