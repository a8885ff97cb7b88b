// A small software rasteriser: triangles with a depth buffer, lines, rectangles.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace beltrami::cli {

/// Components in [0, 1], in the colour space of the screen.
using Color = std::array<float, 3>;

inline Color mix(const Color& a, const Color& b, float t) {
  return {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])};
}

/// A point on the canvas in samples, x right, y down; greater depth is nearer to the eye.
struct Point {
  double x = 0, y = 0, depth = 0;
};

/// Weights of the three corners at a sample.
using Weights = std::array<double, 3>;

/// Calls visit(column, row, weights) for the samples of triangle abc whose centres it covers, edges
/// included, so that neighbours leave no gaps.
template <class Visit>
void visit_triangle(const Point& a, const Point& b, const Point& c, int width, int height,
                    Visit visit) {
  const double twice_area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  if (!(std::abs(twice_area) > 0)) return;
  const auto first = [](double low, int) { return std::max(0, static_cast<int>(std::ceil(low))); };
  const auto last = [](double high, int limit) {
    return std::min(limit - 1, static_cast<int>(std::floor(high)));
  };
  const int row_end = last(std::max({a.y, b.y, c.y}) - 0.5, height);
  const int column_begin = first(std::min({a.x, b.x, c.x}) - 0.5, width);
  const int column_end = last(std::max({a.x, b.x, c.x}) - 0.5, width);
  const double scale = 1 / twice_area;
  for (int row = first(std::min({a.y, b.y, c.y}) - 0.5, height); row <= row_end; ++row) {
    const double y = row + 0.5;
    for (int column = column_begin; column <= column_end; ++column) {
      const double x = column + 0.5;
      const double wa = ((b.x - x) * (c.y - y) - (b.y - y) * (c.x - x)) * scale;
      const double wb = ((c.x - x) * (a.y - y) - (c.y - y) * (a.x - x)) * scale;
      const double wc = 1 - wa - wb;
      // A hair outside counts as inside: rounding must not open a seam between neighbours.
      constexpr double kHair = -1e-9;
      if (wa >= kHair && wb >= kHair && wc >= kHair) visit(column, row, Weights{wa, wb, wc});
    }
  }
}

/// Samples of colour and depth; white and infinitely far at first.
class Canvas {
 public:
  Canvas(int width, int height)
      : width_(width),
        height_(height),
        colors_(3 * static_cast<std::size_t>(width) * height, 255),
        depths_(static_cast<std::size_t>(width) * height, -std::numeric_limits<float>::infinity()) {
  }

  int width() const { return width_; }
  int height() const { return height_; }
  const std::uint8_t* sample(int x, int y) const { return &colors_[3 * index(x, y)]; }

  /// shade(weights) is asked for samples that are not behind what is there.
  template <class Shade>
  void fill_triangle(const Point& a, const Point& b, const Point& c, Shade shade) {
    visit_triangle(a, b, c, width_, height_, [&](int x, int y, const Weights& w) {
      const auto depth = static_cast<float>(w[0] * a.depth + w[1] * b.depth + w[2] * c.depth);
      if (depth < depths_[index(x, y)]) return;
      depths_[index(x, y)] = depth;
      set(x, y, shade(w), 1);
    });
  }

  /// A line with round ends, blended over what is there.
  void draw_line(const Point& a, const Point& b, double line_width, const Color& color,
                 float opacity) {
    const double radius = line_width / 2;
    const double dx = b.x - a.x, dy = b.y - a.y, length_sq = dx * dx + dy * dy;
    const int y_begin = std::max(0, static_cast<int>(std::min(a.y, b.y) - radius));
    const int y_end = std::min(height_ - 1, static_cast<int>(std::max(a.y, b.y) + radius));
    for (int y = y_begin; y <= y_end; ++y) {
      // Only the part of the line near this row: long lines would else visit their whole box.
      double low = std::min(a.x, b.x), high = std::max(a.x, b.x);
      if (std::abs(dy) > 1e-9) {
        const double t0 = (y + 0.5 - radius - 1 - a.y) / dy, t1 = (y + 0.5 + radius + 1 - a.y) / dy;
        const double from = std::clamp(std::min(t0, t1), 0.0, 1.0);
        const double to = std::clamp(std::max(t0, t1), 0.0, 1.0);
        low = std::min(a.x + from * dx, a.x + to * dx);
        high = std::max(a.x + from * dx, a.x + to * dx);
      }
      const int x_begin = std::max(0, static_cast<int>(low - radius - 1));
      const int x_end = std::min(width_ - 1, static_cast<int>(high + radius + 1));
      for (int x = x_begin; x <= x_end; ++x) {
        const double px = x + 0.5 - a.x, py = y + 0.5 - a.y;
        const double t = length_sq > 0 ? std::clamp((px * dx + py * dy) / length_sq, 0.0, 1.0) : 0;
        if (std::hypot(px - t * dx, py - t * dy) <= radius) set(x, y, color, opacity);
      }
    }
  }

  void fill_rectangle(double x0, double y0, double x1, double y1, const Color& color) {
    for (int y = std::max(0, int(y0)); y < std::min<double>(height_, y1); ++y) {
      for (int x = std::max(0, int(x0)); x < std::min<double>(width_, x1); ++x) {
        set(x, y, color, 1);
      }
    }
  }

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x);
  }

  void set(int x, int y, const Color& color, float opacity) {
    std::uint8_t* sample = &colors_[3 * index(x, y)];
    for (std::size_t k = 0; k < 3; ++k) {
      const float value = 255 * std::clamp(color[k], 0.0f, 1.0f);
      sample[k] = static_cast<std::uint8_t>(sample[k] + opacity * (value - sample[k]) + 0.5f);
    }
  }

  int width_, height_;
  std::vector<std::uint8_t> colors_;
  std::vector<float> depths_;
};

}  // namespace beltrami::cli
