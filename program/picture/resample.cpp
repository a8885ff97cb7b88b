#include "picture/resample.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "picture/raster.h"
#include "process/interrupt.h"

namespace beltrami::cli {
namespace {

/// The texel of a row of `count` at this place of it, which may be beyond its edges.
int texel_at(double place, int count, Beyond beyond) {
  const double size = count;
  if (beyond == Beyond::kClamp) return static_cast<int>(std::clamp(place, 0.0, size - 1));
  const double period = beyond == Beyond::kRepeat ? size : 2 * size;
  const double first = place - period * std::floor(place / period);
  // Rounding of a great number may leave the period.
  const auto texel = static_cast<int>(std::clamp(first, 0.0, period - 1));
  return texel < count ? texel : 2 * count - 1 - texel;
}

/// A component of a page at a place, between the centres of texels.
double sample(const Pixels& page, double u, double v, int component, Beyond beyond) {
  const double x = u * page.width - 0.5, y = (1 - v) * page.height - 0.5;
  const double left = std::floor(x), top = std::floor(y);
  const auto at = [&](double column, double row) {
    const int i = texel_at(column, page.width, beyond), j = texel_at(row, page.height, beyond);
    const std::size_t texel = static_cast<std::size_t>(j) * page.row_size() +
                              static_cast<std::size_t>(i * page.components + component);
    return static_cast<double>(page.values[texel]);
  };
  const double s = x - left, t = y - top;
  return (1 - t) * ((1 - s) * at(left, top) + s * at(left + 1, top)) +
         t * ((1 - s) * at(left, top + 1) + s * at(left + 1, top + 1));
}

/// A step of the gutters: texels beside those that are filled become the mean of these.
void grow(Pixels& page, std::vector<bool>& filled) {
  const int side = page.width;
  const std::vector<bool> before = filled;
  const auto index = [&](int column, int row) {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(side) +
           static_cast<std::size_t>(column);
  };
  const auto components = static_cast<std::size_t>(page.components);
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      if (before[index(column, row)]) continue;
      int count = 0;
      std::array<int, 4> sum = {0, 0, 0, 0};
      for (int y = std::max(row - 1, 0); y <= std::min(row + 1, side - 1); ++y) {
        for (int x = std::max(column - 1, 0); x <= std::min(column + 1, side - 1); ++x) {
          if (!before[index(x, y)]) continue;
          ++count;
          for (std::size_t k = 0; k < components; ++k) {
            sum[k] += page.values[components * index(x, y) + k];
          }
        }
      }
      if (count == 0) continue;
      filled[index(column, row)] = true;
      for (std::size_t k = 0; k < components; ++k) {
        page.values[components * index(column, row) + k] =
            static_cast<std::uint8_t>((sum[k] + count / 2) / count);
      }
    }
  }
}

}  // namespace

Baked bake(const std::vector<BakedTriangle>& triangles, const SourceOf& source_of,
           const std::vector<Pixels>& pages, Beyond beyond, int side, int margin) {
  Baked baked;
  Pixels& page = baked.image;
  page.width = page.height = side;
  page.components = pages.front().components;
  page.values.assign(page.row_size() * static_cast<std::size_t>(side), 0);
  std::vector<bool> filled(static_cast<std::size_t>(side) * static_cast<std::size_t>(side), false);
  std::vector<bool> covered = filled;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    throw_if_interrupted();
    std::array<Point, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = {triangles[t][k][0], side - triangles[t][k][1], 0};
    }
    visit_triangle(
        corners[0], corners[1], corners[2], side, side, [&](int column, int row, const Weights& w) {
          const std::size_t texel = static_cast<std::size_t>(row) * static_cast<std::size_t>(side) +
                                    static_cast<std::size_t>(column);
          covered[texel] = true;
          const std::optional<Source> source = source_of(t, w);
          if (!source) return;
          filled[texel] = true;
          for (int k = 0; k < page.components; ++k) {
            page.values[texel * static_cast<std::size_t>(page.components) +
                        static_cast<std::size_t>(k)] =
                static_cast<std::uint8_t>(
                    sample(pages[source->page], source->u, source->v, k, beyond) + 0.5);
          }
        });
  }
  for (std::size_t texel = 0; texel < filled.size(); ++texel) {
    baked.covered += covered[texel] ? 1 : 0;
    baked.without_source += covered[texel] && !filled[texel] ? 1 : 0;
  }
  for (int step = 0; step < margin; ++step) grow(page, filled);
  return baked;
}

}  // namespace beltrami::cli
