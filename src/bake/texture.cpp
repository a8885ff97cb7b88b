#include "bake/texture.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/parallel.h"
#include "base/portable_math.h"

namespace beltrami {
namespace {

constexpr float kMost = 65535;
/// From 8 bits to 16, exactly.
constexpr int kPerByte = 257;
/// Rows of an image that a thread takes at once.
constexpr std::int64_t kRows = 8;

double power(double x, double exponent) {
  return x > 0 ? portable::exp(exponent * portable::log(x)) : 0;
}

double linear_of(double s) {
  return s <= 0.04045 ? s / 12.92 : power((s + 0.055) / 1.055, 2.4);
}

double srgb_of(double light) {
  return light <= 0.0031308 ? 12.92 * light : 1.055 * power(light, 1 / 2.4) - 0.055;
}

/// Where all is transparent, colours still have a mean: the alpha that they count by at least. It
/// is less than half a step of any type.
float least_alpha(PixelType type) {
  return type == PixelType::kFloat ? 1e-9f : 1e-3f;
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
  if (beyond == Beyond::kClamp) return place > 0 ? count - 1 : 0;
  const double period = beyond == Beyond::kRepeat ? size : 2 * size;
  const double first = place - period * std::floor(place / period);
  if (!(first >= 0)) return 0;  // it is no number: the place is too great for a double
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

template <PixelType>
struct Stored;
template <>
struct Stored<PixelType::kByte> {
  using Number = std::uint8_t;
};
template <>
struct Stored<PixelType::kShort> {
  using Number = std::uint16_t;
};
template <>
struct Stored<PixelType::kFloat> {
  using Number = float;
};

template <PixelType kType>
using NumberOf = typename Stored<kType>::Number;

template <class Number>
Number number_at(const unsigned char* bytes) {
  Number number;
  std::memcpy(&number, bytes, sizeof number);
  return number;
}

/// The four texels around a place, and how much of each is shown there.
template <PixelType kType, int kComponents>
struct FourTexels {
  std::array<const unsigned char*, 4> at;
  std::array<float, 4> weights;

  template <class Level>
  FourTexels(const Level& level, const Place& place, const ImageReading& reading) {
    const double shift = reading.nearest ? 0.0 : 0.5;
    const double x = place.u * level.width - shift, y = (1 - place.v) * level.height - shift;
    const double left = floor_of(x), top = floor_of(y);
    const float s = reading.nearest ? 0.0f : static_cast<float>(x - left);
    const float t = reading.nearest ? 0.0f : static_cast<float>(y - top);
    weights = {(1 - s) * (1 - t), s * (1 - t), (1 - s) * t, s * t};
    std::array<std::size_t, 2> columns, rows;
    if (left >= 0 && left + 1 < level.width && top >= 0 && top + 1 < level.height) {
      const auto column = static_cast<std::size_t>(static_cast<int>(left));
      const auto row = static_cast<std::size_t>(static_cast<int>(top));
      columns = {column, column + 1};
      rows = {row, row + 1};
    } else {
      for (std::size_t k = 0; k < 2; ++k) {
        columns[k] =
            static_cast<std::size_t>(texel_at(left + double(k), level.width, reading.along_u));
        rows[k] =
            static_cast<std::size_t>(texel_at(top + double(k), level.height, reading.along_v));
      }
    }
    for (std::size_t i = 0; i < 4; ++i) {
      at[i] = level.pixels + rows[i / 2] * level.row_bytes +
              columns[i % 2] * (kComponents * sizeof(NumberOf<kType>));
    }
  }
};

/// Adds what texels show together; of colours with an alpha each counts by that, too.
template <PixelType kType, int kComponents, int kColours, bool kWeighted>
void add_mean(const FourTexels<kType, kComponents>& texels, const ColourTables& tables,
              TexelSums& sums) {
  using Number = NumberOf<kType>;
  const auto value = [&](std::size_t i, std::size_t k) -> float {
    const auto number = number_at<Number>(texels.at[i] + k * sizeof(Number));
    if constexpr (kType == PixelType::kByte) {
      return k < kColours ? tables.linear_of_byte[number]
                          : static_cast<float>(kPerByte * static_cast<int>(number));
    } else {
      return static_cast<float>(number);
    }
  };
  std::array<float, 4> weights = texels.weights;
  if constexpr (kWeighted) {
    const float least = least_alpha(kType);
    for (std::size_t i = 0; i < 4; ++i) {
      weights[i] *= std::max(value(i, kComponents - 1), least);
      sums[kComponents - 1] += weights[i];
    }
  }
  for (std::size_t k = 0; k < kComponents - (kWeighted ? 1 : 0); ++k) {
    // A neighbour that has no part in it may be no number.
    float sum = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      if (kType != PixelType::kFloat || weights[i] != 0) sum += weights[i] * value(i, k);
    }
    sums[k] += sum;
  }
}

}  // namespace

ColourTables::ColourTables() : byte_of_linear(65536) {
  for (std::size_t i = 0; i < 256; ++i) {
    // Whole numbers, so that a sum of the same ones is exact.
    linear_of_byte[i] = static_cast<float>(std::floor(kMost * linear_of(double(i) / 255) + 0.5));
    number_of_byte[i] = static_cast<float>(kPerByte * static_cast<int>(i));
  }
  for (std::size_t i = 0; i < byte_of_linear.size(); ++i) {
    byte_of_linear[i] = static_cast<std::uint8_t>(255 * srgb_of(double(i) / double(kMost)) + 0.5);
  }
}

Texture::Texture(const ImageView& image, ImageKind kind, const ColourTables& tables,
                 const Work& work)
    : tables_(&tables), components_(image.components), kind_(kind), type_(image.type) {
  Level level;
  level.width = image.width;
  level.height = image.height;
  if (colours() > 0 && image.type != PixelType::kByte) {
    own_linear(image, level, work);
  } else {
    level.type = image.type;
    level.row_bytes = image.row_bytes;
    level.pixels = image.pixels;
    level.colours = image.type == PixelType::kByte ? colours() : 0;
  }
  level.gather = gather_for(level.type, level.colours > 0);
  levels_.push_back(std::move(level));
  finish_ = type_ == PixelType::kByte    ? finish_of<PixelType::kByte>(is_colour())
            : type_ == PixelType::kShort ? finish_of<PixelType::kShort>(is_colour())
                                         : finish_of<PixelType::kFloat>(is_colour());
}

void Texture::own_linear(const ImageView& image, Level& level, const Work& work) const {
  const auto components = static_cast<std::size_t>(components_);
  const std::size_t row = static_cast<std::size_t>(image.width) * components;
  level.type = PixelType::kFloat;
  level.row_bytes = row * sizeof(float);
  level.own.resize(level.row_bytes * static_cast<std::size_t>(image.height));
  level.pixels = level.own.data();
  const auto end = static_cast<std::size_t>(colours());
  std::vector<float> of_short;
  if (image.type == PixelType::kShort) {
    for (int i = 0; i < 65536; ++i) {
      of_short.push_back(static_cast<float>(double(kMost) * linear_of(i / double(kMost))));
    }
  }
  parallel_for(work, image.height, kRows, [&](std::int64_t first, std::int64_t last) {
    for (auto y = static_cast<std::size_t>(first); y < static_cast<std::size_t>(last); ++y) {
      const unsigned char* in = image.pixels + y * image.row_bytes;
      unsigned char* out = level.own.data() + y * level.row_bytes;
      for (std::size_t i = 0; i < row; ++i) {
        const bool colour = i % components < end;
        float value = 0;
        if (image.type == PixelType::kShort) {
          const auto number = number_at<std::uint16_t>(in + 2 * i);
          value = colour ? of_short[number] : number;
        } else {
          value = number_at<float>(in + 4 * i);
          if (colour) value = static_cast<float>(linear_of(double(value)));
        }
        std::memcpy(out + 4 * i, &value, sizeof value);
      }
    }
  });
}

template <PixelType kType, bool kColours>
Texture::Gather Texture::gather_of(int components, bool weighted) {
  constexpr int kOne = kColours ? 1 : 0, kThree = kColours ? 3 : 0;
  switch (components) {
    case 1:
      return &gather<kType, 1, kOne, false>;
    case 2:
      return weighted ? &gather<kType, 2, kOne, true> : &gather<kType, 2, kOne, false>;
    case 3:
      return &gather<kType, 3, kThree, false>;
    default:
      return weighted ? &gather<kType, 4, kThree, true> : &gather<kType, 4, kThree, false>;
  }
}

Texture::Gather Texture::gather_for(PixelType type, bool colours) const {
  switch (type) {
    case PixelType::kByte:
      return colours ? gather_of<PixelType::kByte, true>(components_, weighted())
                     : gather_of<PixelType::kByte, false>(components_, weighted());
    case PixelType::kShort:
      return gather_of<PixelType::kShort, false>(components_, weighted());
    case PixelType::kFloat:
      break;
  }
  return gather_of<PixelType::kFloat, false>(components_, weighted());
}

template <PixelType kType, bool kColours>
Texture::Finish Texture::finish_of(int components, bool weighted) {
  constexpr int kOne = kColours ? 1 : 0, kThree = kColours ? 3 : 0;
  switch (components) {
    case 1:
      return &finish_as<kType, 1, kOne, false>;
    case 2:
      return weighted ? &finish_as<kType, 2, kOne, true> : &finish_as<kType, 2, kOne, false>;
    case 3:
      return &finish_as<kType, 3, kThree, false>;
    default:
      return weighted ? &finish_as<kType, 4, kThree, true> : &finish_as<kType, 4, kThree, false>;
  }
}

template <PixelType kType>
Texture::Finish Texture::finish_of(bool colours) const {
  return colours ? finish_of<kType, true>(components_, weighted())
                 : finish_of<kType, false>(components_, weighted());
}

template <PixelType kType>
void Texture::read_texel(const Level& level, int row, int column, TexelSums& texel) const {
  using Number = NumberOf<kType>;
  const auto components = static_cast<std::size_t>(components_);
  const std::size_t first = static_cast<std::size_t>(column) * components;
  const unsigned char* bytes = level.pixels + static_cast<std::size_t>(row) * level.row_bytes;
  for (std::size_t k = 0; k < components; ++k) {
    const auto number = number_at<Number>(bytes + sizeof(Number) * (first + k));
    if constexpr (kType == PixelType::kByte) {
      const bool colour = static_cast<int>(k) < level.colours;
      texel[k] = (colour ? tables_->linear_of_byte : tables_->number_of_byte)[number];
    } else {
      texel[k] = static_cast<float>(number);
    }
  }
}

Texture::Level Texture::half_of(const Level& level, const Work& work) const {
  Level half;
  half.width = std::max(level.width / 2, 1);
  half.height = std::max(level.height / 2, 1);
  half.type = level.type == PixelType::kFloat ? PixelType::kFloat : PixelType::kShort;
  const auto components = static_cast<std::size_t>(components_);
  half.row_bytes = static_cast<std::size_t>(half.width) * components * bytes_of(half.type);
  half.own.resize(half.row_bytes * static_cast<std::size_t>(half.height));
  half.pixels = half.own.data();
  half.gather = gather_for(half.type, false);
  switch (level.type) {
    case PixelType::kByte:
      halve_rows<PixelType::kByte>(level, half, work);
      break;
    case PixelType::kShort:
      halve_rows<PixelType::kShort>(level, half, work);
      break;
    case PixelType::kFloat:
      halve_rows<PixelType::kFloat>(level, half, work);
      break;
  }
  return half;
}

/// A row of an image, from two rows of one that has twice its width, from row `row` on.
template <PixelType kType, int kComponents>
void Texture::halve_evenly(const Level& level, const ColourTables& tables, std::size_t row,
                           int width, unsigned char* out) {
  using Number = NumberOf<kType>;
  constexpr std::size_t kTexel = kComponents * sizeof(Number);
  const unsigned char* upper = level.pixels + row * level.row_bytes;
  const unsigned char* lower = upper + level.row_bytes;
  for (int i = 0; i < width; ++i, upper += 2 * kTexel, lower += 2 * kTexel) {
    for (int k = 0; k < kComponents; ++k) {
      const auto value = [&](const unsigned char* texel) -> float {
        const auto number = number_at<Number>(texel + static_cast<std::size_t>(k) * sizeof(Number));
        if constexpr (kType == PixelType::kByte) {
          return (k < level.colours ? tables.linear_of_byte : tables.number_of_byte)[number];
        } else {
          return static_cast<float>(number);
        }
      };
      const float mean = 0.25f * value(upper) + 0.25f * value(upper + kTexel) +
                         0.25f * value(lower) + 0.25f * value(lower + kTexel);
      if constexpr (kType == PixelType::kFloat) {
        std::memcpy(out, &mean, sizeof mean);
        out += sizeof mean;
      } else {
        const auto rounded = static_cast<std::uint16_t>(static_cast<std::int32_t>(mean + 0.5f));
        std::memcpy(out, &rounded, sizeof rounded);
        out += sizeof rounded;
      }
    }
  }
}

template <PixelType kType>
Texture::EvenHalving Texture::even_halving_of(int components) {
  switch (components) {
    case 1:
      return &halve_evenly<kType, 1>;
    case 2:
      return &halve_evenly<kType, 2>;
    case 3:
      return &halve_evenly<kType, 3>;
    default:
      return &halve_evenly<kType, 4>;
  }
}

template <PixelType kType>
void Texture::halve_rows(const Level& level, Level& half, const Work& work) const {
  const auto components = static_cast<std::size_t>(components_);
  const std::vector<Share> columns = shares(level.width, half.width);
  const std::vector<Share> rows = shares(level.height, half.height);
  const bool by_alpha = weighted();
  const float least = least_alpha(type_);
  const auto make_texel = [&](const Share& row, const Share& column, unsigned char* out) {
    TexelSums sums{}, texel{};
    float total = 0;
    for (int j = 0; j < row.count; ++j) {
      for (int i = 0; i < column.count; ++i) {
        read_texel<kType>(level, row.first + j, column.first + i, texel);
        float weight =
            row.weights[static_cast<std::size_t>(j)] * column.weights[static_cast<std::size_t>(i)];
        if (by_alpha) {
          sums[components - 1] += weight * texel[components - 1];
          weight *= std::max(texel[components - 1], least);
        }
        total += weight;
        for (std::size_t k = 0; k < components - (by_alpha ? 1 : 0); ++k) {
          sums[k] += weight * texel[k];
        }
      }
    }
    for (std::size_t k = 0; k < components; ++k) {
      const float value = by_alpha && k + 1 == components ? sums[k] : sums[k] / total;
      if (half.type == PixelType::kFloat) {
        std::memcpy(out + 4 * k, &value, sizeof value);
      } else {
        const auto rounded = static_cast<std::uint16_t>(value + 0.5f);
        std::memcpy(out + 2 * k, &rounded, sizeof rounded);
      }
    }
  };
  const bool even = level.width == 2 * half.width && level.height == 2 * half.height;
  const auto halve_evenly = even && !by_alpha ? even_halving_of<kType>(components_) : nullptr;
  parallel_for(work, half.height, kRows, [&](std::int64_t first, std::int64_t last) {
    for (auto y = static_cast<std::size_t>(first); y < static_cast<std::size_t>(last); ++y) {
      unsigned char* out = half.own.data() + y * half.row_bytes;
      if (halve_evenly != nullptr) {
        halve_evenly(level, *tables_, 2 * y, half.width, out);
        continue;
      }
      for (const Share& column : columns) {
        make_texel(rows[y], column, out);
        out += components * bytes_of(half.type);
      }
    }
  });
}

void Texture::make_levels(int count, const Work& work) {
  while (static_cast<int>(levels_.size()) <= count &&
         std::max(levels_.back().width, levels_.back().height) > 1) {
    levels_.push_back(half_of(levels_.back(), work));
  }
}

template <PixelType kType, int kComponents, int kColours, bool kWeighted>
void Texture::gather(const Level& level, const ColourTables& tables, std::span<const Place> places,
                     const ImageReading& reading, std::span<TexelSums> sums) {
  for (std::size_t i = 0; i < places.size(); ++i) {
    const FourTexels<kType, kComponents> texels(level, places[i], reading);
    add_mean<kType, kComponents, kColours, kWeighted>(texels, tables, sums[i]);
  }
}

template <PixelType kType, int kComponents, int kColours, bool kWeighted>
void Texture::finish_as(const ColourTables& tables, std::span<const TexelSums> all, float count,
                        unsigned char* texels) {
  constexpr std::size_t kBytes = sizeof(NumberOf<kType>);
  for (const TexelSums& sums : all) {
    for (int k = 0; k < kComponents; ++k, texels += kBytes) {
      const bool is_alpha = kWeighted && k + 1 == kComponents;
      const float of = kWeighted && !is_alpha ? sums[kComponents - 1] : count;
      const float sum = sums[static_cast<std::size_t>(k)];
      // Most texels are read once, and a division takes as long as half the rest.
      float mean = of == 1 ? sum : sum / of;
      if constexpr (kType == PixelType::kFloat) {
        if (is_alpha && mean <= 2 * least_alpha(kType)) mean = 0;
        if (k < kColours) mean = static_cast<float>(srgb_of(double(mean)));
        std::memcpy(texels, &mean, sizeof mean);
      } else {
        const float within = std::clamp(mean, 0.0f, kMost);
        if constexpr (kType == PixelType::kShort) {
          const double value = k < kColours
                                   ? double(kMost) * srgb_of(double(within) / double(kMost))
                                   : double(within);
          const auto rounded = static_cast<std::uint16_t>(value + 0.5);
          std::memcpy(texels, &rounded, sizeof rounded);
        } else {
          const auto value = static_cast<std::uint32_t>(static_cast<std::int32_t>(within + 0.5f));
          *texels = k < kColours ? tables.byte_of_linear[value]
                                 : static_cast<std::uint8_t>((value + kPerByte / 2) / kPerByte);
        }
      }
    }
  }
}

}  // namespace beltrami
