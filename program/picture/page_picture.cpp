#include "picture/page_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "picture/raster.h"

namespace beltrami::cli {
namespace {

constexpr std::uint64_t kPagesInARow = 10;
constexpr int kLargestPage = 1024, kSmallestPage = 128;  // pixels
constexpr int kLargestImage = 4096;
constexpr double kFrame = 2;  // pixels
constexpr Color kFree = {0.16f, 0.17f, 0.20f}, kEdge = {0.45f, 0.46f, 0.50f};

/// Hues a golden angle apart: neighbours in number are far apart in colour.
Color color_of(std::uint64_t chart) {
  const double hue = std::fmod(0.61803398874989 * static_cast<double>(chart), 1.0);
  const double value = 0.72 + 0.22 * (static_cast<double>(chart % 3) / 2);
  Color color{};
  for (std::size_t k = 0; k < 3; ++k) {
    const double phase = std::fmod(hue + static_cast<double>(k) / 3, 1.0);
    const double ramp = std::clamp(std::abs(6 * phase - 3) - 1, 0.0, 1.0);
    color[k] = static_cast<float>(value * (0.4 + 0.6 * ramp));
  }
  return color;
}

}  // namespace

Image render_pages(const PageTriangles& triangles, std::uint64_t pages) {
  const auto columns = static_cast<int>(std::clamp<std::uint64_t>(pages, 1, kPagesInARow));
  const auto rows =
      static_cast<int>(std::max<std::uint64_t>((pages + kPagesInARow - 1) / kPagesInARow, 1));
  const int side = std::clamp(kLargestImage / std::max(columns, rows), kSmallestPage, kLargestPage);
  Canvas canvas(columns * side, rows * side);
  canvas.fill_rectangle(0, 0, canvas.width(), canvas.height(), kFree);
  const auto point = [&](std::size_t corner) {
    return Point{side * triangles.uvs[2 * corner],
                 canvas.height() - side * triangles.uvs[2 * corner + 1], 0};
  };
  for (std::size_t t = 0; t < triangles.charts.size(); ++t) {
    const Color color = color_of(triangles.charts[t]);
    canvas.fill_triangle(point(3 * t), point(3 * t + 1), point(3 * t + 2),
                         [&](const Weights&) { return color; });
  }
  for (int column = 0; column <= columns; ++column) {
    const double x = column * side;
    canvas.fill_rectangle(x - kFrame / 2, 0, x + kFrame / 2, canvas.height(), kEdge);
  }
  for (int row = 0; row <= rows; ++row) {
    const double y = row * side;
    canvas.fill_rectangle(0, y - kFrame / 2, canvas.width(), y + kFrame / 2, kEdge);
  }
  Image image;
  image.width = canvas.width();
  image.height = canvas.height();
  const std::uint8_t* samples = canvas.sample(0, 0);
  image.rgb.assign(samples, samples + 3 * std::size_t(image.width) * std::size_t(image.height));
  return image;
}

}  // namespace beltrami::cli
