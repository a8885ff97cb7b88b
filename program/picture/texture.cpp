#include "picture/texture.h"

#include <algorithm>
#include <cmath>

#include "process/interrupt.h"

namespace beltrami::cli {
namespace {

constexpr double kMost = 65535;
/// From 8 bits to 16, exactly.
constexpr int kPerByte = 257;

double linear_of(double s) {
  return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

double srgb_of(double light) {
  return light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
}

/// IEC 61966-2-1 as tables: powers would take longer than all else.
struct Tables {
  std::array<std::uint16_t, 256> linear{};
  std::array<std::uint8_t, 65536> srgb{};
  Tables() {
    for (std::size_t i = 0; i < linear.size(); ++i) {
      linear[i] = static_cast<std::uint16_t>(kMost * linear_of(double(i) / 255) + 0.5);
    }
    for (std::size_t i = 0; i < srgb.size(); ++i) {
      srgb[i] = static_cast<std::uint8_t>(255 * srgb_of(double(i) / kMost) + 0.5);
    }
  }
};

const Tables& tables() {
  static const Tables made;
  return made;
}

bool is_colour(Meaning meaning) {
  return meaning == Meaning::kColours || meaning == Meaning::kTransparent;
}

/// How many components come before the alpha, where there is one.
int before_alpha(int components) {
  return components == 2 || components == 4 ? components - 1 : components;
}

/// std::floor, which is a call where the processor's own rounding may not be assumed.
inline double floor_of(double x) {
  constexpr double kInInt = 1e9;
  if (!(std::abs(x) < kInInt)) return std::floor(x);
  const int towards_zero = static_cast<int>(x);
  return towards_zero - (x < towards_zero ? 1 : 0);
}

/// The texel of a row of `count` at this place of it, which may be beyond its edges.
inline int texel_at(double place, int count, Beyond beyond) {
  const double size = count;
  if (place >= 0 && place < size) return static_cast<int>(place);
  if (beyond == Beyond::kClamp) return static_cast<int>(std::clamp(place, 0.0, size - 1));
  const double period = beyond == Beyond::kRepeat ? size : 2 * size;
  const double first = place - period * std::floor(place / period);
  // Rounding of a great number may leave the period.
  const auto texel = static_cast<int>(std::clamp(first, 0.0, period - 1));
  return texel < count ? texel : 2 * count - 1 - texel;
}

/// A part of the old texels of a row that a new one covers.
struct Share {
  int first = 0, count = 0;
  std::array<float, 4> weights{};  ///< their sum is 1
};

/// Where each of `count` texels gets what it shows, of `old_count` that are no more than three
/// times as many.
std::vector<Share> shares(int old_count, int count) {
  std::vector<Share> found(static_cast<std::size_t>(count));
  const double ratio = double(old_count) / count;
  for (int i = 0; i < count; ++i) {
    Share& share = found[static_cast<std::size_t>(i)];
    const double begin = i * ratio, end = (i + 1) * ratio;
    share.first = static_cast<int>(begin);
    for (int k = share.first; k < old_count && k < end && share.count < 4; ++k) {
      const double covered = std::min<double>(k + 1, end) - std::max<double>(k, begin);
      share.weights[static_cast<std::size_t>(share.count++)] = static_cast<float>(covered / ratio);
    }
  }
  return found;
}

}  // namespace

Texture::Texture(const Pixels& image, Meaning meaning)
    : components_(image.components), meaning_(meaning) {
  Level& level = levels_.emplace_back();
  level.width = image.width;
  level.height = image.height;
  level.values.resize(image.values.size());
  const int colours = is_colour(meaning) ? before_alpha(components_) : 0;
  // Where all is transparent, colours still have a mean.
  const int least_alpha = meaning == Meaning::kTransparent ? 1 : 0;
  const Tables& table = tables();
  for (std::size_t i = 0; i < image.values.size(); i += static_cast<std::size_t>(components_)) {
    for (int k = 0; k < components_; ++k) {
      const std::size_t at = i + static_cast<std::size_t>(k);
      const std::uint8_t value = image.values[at];
      level.values[at] = k < colours
                             ? table.linear[value]
                             : static_cast<std::uint16_t>(std::max(kPerByte * value, least_alpha));
    }
  }
}

Texture::Level Texture::half_of(const Level& level) const {
  Level half;
  half.width = std::max(level.width / 2, 1);
  half.height = std::max(level.height / 2, 1);
  const auto components = static_cast<std::size_t>(components_);
  half.values.resize(static_cast<std::size_t>(half.width) * static_cast<std::size_t>(half.height) *
                     components);
  const std::vector<Share> columns = shares(level.width, half.width);
  std::size_t out = 0;
  for (const Share& rows : shares(level.height, half.height)) {
    throw_if_interrupted();
    for (const Share& column : columns) {
      Sums sums{};
      float total = 0;
      for (int j = 0; j < rows.count; ++j) {
        for (int i = 0; i < column.count; ++i) {
          const std::size_t texel =
              static_cast<std::size_t>(rows.first + j) * static_cast<std::size_t>(level.width) +
              static_cast<std::size_t>(column.first + i);
          const std::uint16_t* values = &level.values[components * texel];
          float weight = rows.weights[static_cast<std::size_t>(j)] *
                         column.weights[static_cast<std::size_t>(i)];
          if (meaning_ == Meaning::kTransparent && components_ % 2 == 0) {
            sums[components - 1] += weight * values[components - 1];
            weight *= values[components - 1];
          }
          total += weight;
          const auto end = static_cast<std::size_t>(
              meaning_ == Meaning::kTransparent ? before_alpha(components_) : components_);
          for (std::size_t k = 0; k < end; ++k) sums[k] += weight * values[k];
        }
      }
      const bool weighted = meaning_ == Meaning::kTransparent && components_ % 2 == 0;
      for (std::size_t k = 0; k < components; ++k) {
        const float value = weighted && k + 1 == components ? sums[k] : sums[k] / total;
        half.values[out++] = static_cast<std::uint16_t>(value + 0.5f);
      }
    }
  }
  return half;
}

void Texture::make_levels(int count) {
  while (static_cast<int>(levels_.size()) <= count &&
         std::max(levels_.back().width, levels_.back().height) > 1) {
    levels_.push_back(half_of(levels_.back()));
  }
}

template <int kComponents, bool kWeighted>
void Texture::gather(const Level& level, double u, double v, const Reading& reading, Sums& sums) {
  const double shift = reading.nearest ? 0.0 : 0.5;
  const double x = u * level.width - shift, y = (1 - v) * level.height - shift;
  const double left = floor_of(x), top = floor_of(y);
  const float s = reading.nearest ? 0.0f : static_cast<float>(x - left);
  const float t = reading.nearest ? 0.0f : static_cast<float>(y - top);
  std::array<std::size_t, 2> columns, rows;
  const bool within = left >= 0 && left + 1 < level.width && top >= 0 && top + 1 < level.height;
  if (within) {
    columns = {static_cast<std::size_t>(static_cast<int>(left)),
               static_cast<std::size_t>(static_cast<int>(left)) + 1};
    rows = {static_cast<std::size_t>(static_cast<int>(top)),
            static_cast<std::size_t>(static_cast<int>(top)) + 1};
  } else {
    for (std::size_t k = 0; k < 2; ++k) {
      columns[k] =
          static_cast<std::size_t>(texel_at(left + double(k), level.width, reading.along_u));
      rows[k] = static_cast<std::size_t>(texel_at(top + double(k), level.height, reading.along_v));
    }
  }
  const auto width = static_cast<std::size_t>(level.width);
  const std::uint16_t* values = level.values.data();
  const std::array<const std::uint16_t*, 4> texels = {
      values + (rows[0] * width + columns[0]) * kComponents,
      values + (rows[0] * width + columns[1]) * kComponents,
      values + (rows[1] * width + columns[0]) * kComponents,
      values + (rows[1] * width + columns[1]) * kComponents};
  std::array<float, 4> weights = {(1 - s) * (1 - t), s * (1 - t), (1 - s) * t, s * t};
  if constexpr (kWeighted) {
    for (std::size_t i = 0; i < 4; ++i) {
      weights[i] *= texels[i][kComponents - 1];
      sums[kComponents - 1] += weights[i];
    }
  }
  for (std::size_t k = 0; k < kComponents - (kWeighted ? 1 : 0); ++k) {
    sums[k] += weights[0] * texels[0][k] + weights[1] * texels[1][k] + weights[2] * texels[2][k] +
               weights[3] * texels[3][k];
  }
}

void Texture::add(double u, double v, const Reading& reading, int level, Sums& sums) const {
  const Level& of = levels_[std::min(static_cast<std::size_t>(level), levels_.size() - 1)];
  const bool weighted = meaning_ == Meaning::kTransparent;
  switch (components_) {
    case 1:
      return gather<1, false>(of, u, v, reading, sums);
    case 2:
      return weighted ? gather<2, true>(of, u, v, reading, sums)
                      : gather<2, false>(of, u, v, reading, sums);
    case 3:
      return gather<3, false>(of, u, v, reading, sums);
    default:
      return weighted ? gather<4, true>(of, u, v, reading, sums)
                      : gather<4, false>(of, u, v, reading, sums);
  }
}

void Texture::finish(const Sums& sums, float count, std::uint8_t* texel) const {
  const auto components = static_cast<std::size_t>(components_);
  const auto colours =
      static_cast<std::size_t>(is_colour(meaning_) ? before_alpha(components_) : 0);
  const bool weighted = meaning_ == Meaning::kTransparent && components_ % 2 == 0;
  const Tables& table = tables();
  for (std::size_t k = 0; k < components; ++k) {
    const bool counts_by_alpha = weighted && k + 1 < components;
    const float mean = sums[k] / (counts_by_alpha ? sums[components - 1] : count);
    const auto value = static_cast<std::size_t>(std::clamp(mean, 0.0f, 65535.0f) + 0.5f);
    texel[k] = k < colours ? table.srgb[value]
                           : static_cast<std::uint8_t>((value + kPerByte / 2) / kPerByte);
  }
}

}  // namespace beltrami::cli
