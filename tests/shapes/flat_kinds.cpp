#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>
#include <vector>

#include "base/portable_math.h"
#include "shapes/kinds.h"
#include "shapes/random.h"
#include "shapes/region.h"
#include "shapes/shape.h"

namespace beltrami::shapes {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr std::int64_t kSide = 1 << 12;  ///< of the grid that regions are drawn on

}  // namespace

Shape flat_ring(Random& random) {
  const int n = random.chance(0.7) ? random.count(4, 24) : random.count(4, 100);
  const double width = random.chance(0.2) ? random.spread(1e-4, 0.5) : random.between(0.05, 0.9);
  const double crooked = random.chance(0.4) ? 0 : random.between(0, 0.4);
  const double squeeze = random.chance(0.5) ? 1 : random.between(0.2, 1);
  std::vector<double> outer, inner;
  for (auto* angles : {&inner, &outer}) {
    for (int i = 0; i < n; ++i) {
      angles->push_back(kTurn * (i + crooked * random.between(-1, 1)) / n);
    }
  }
  // The corners of a narrow hole would stand out between those of the rim.
  const bool is_narrow = 1 - width >= portable::cos(0.5 * kTurn * (1 + 2 * crooked) / n);
  if (is_narrow) inner = outer;
  Shape shape;
  shape.flat = true;
  const auto add = [&](double radius, const std::vector<double>& angles) {
    for (const double angle : angles) {
      shape.add({radius * portable::cos(angle), squeeze * radius * portable::sin(angle), 0});
    }
  };
  add(1 - width, inner);
  add(1, outer);
  const auto size = static_cast<Vertex>(n);
  const double way = random.unit();  // of cutting it into faces
  if (way < 0.1) {
    std::vector<Vertex> all;
    for (Vertex i = 0; i <= size; ++i) all.push_back(size + i % size);
    for (Vertex i = 0; i <= size; ++i) all.push_back((size - i) % size);
    shape.face(all);
    return shape;
  }
  for (Vertex i = 0; i < size; ++i) {
    const Vertex j = (i + 1) % size;
    if (way < 0.25) {
      shape.face({i, size + i, size + j, j});
    } else if (way < 0.7 || random.chance(0.5)) {
      shape.face({i, size + i, size + j});
      shape.face({i, size + j, j});
    } else {
      shape.face({i, size + i, j});
      shape.face({size + i, size + j, j});
    }
  }
  return shape;
}

Shape frame(Random& random) {
  Shape shape;
  shape.flat = true;
  const int frames = random.chance(0.7) ? 1 : random.count(2, 3);
  const bool quads = random.chance(0.3);
  for (int f = 0; f < frames; ++f) {
    const double wide = random.spread(0.2, 5), high = random.spread(0.2, 5);
    std::vector<double> xs = {0, wide * random.between(0.02, 0.45),
                              wide * random.between(0.55, 0.98), wide};
    std::vector<double> ys = {0, high * random.between(0.02, 0.45),
                              high * random.between(0.55, 0.98), high};
    if (random.chance(0.2)) {  // a window with bars
      xs.insert(xs.begin() + 2,
                {0.5 * (xs[1] + xs[2]) - 0.01 * wide, 0.5 * (xs[1] + xs[2]) + 0.01 * wide});
      std::sort(xs.begin(), xs.end());
    }
    const auto columns = static_cast<int>(xs.size()) - 1, rows = static_cast<int>(ys.size()) - 1;
    Shape whole = grid({columns, rows, false, false, true}, [&](double u, double v) {
      return Point3{xs[static_cast<std::size_t>(std::lround(u * columns))] + 6.0 * f,
                    ys[static_cast<std::size_t>(std::lround(v * rows))], 0};
    });
    std::vector<char> keep;
    for (int i = 0; i < columns; ++i) {
      for (int j = 0; j < rows; ++j) keep.push_back(i % 2 == 0 || j % 2 == 0);
    }
    whole = only(whole, keep);
    if (random.chance(0.4) && frames == 1 && columns == 3) {
      // Four trapezoids, as a carpenter does it.
      Shape mitred;
      for (const auto& [x, y] :
           {std::pair{0, 0}, {3, 0}, {3, 3}, {0, 3}, {1, 1}, {2, 1}, {2, 2}, {1, 2}}) {
        mitred.add({xs[static_cast<std::size_t>(x)], ys[static_cast<std::size_t>(y)], 0});
      }
      for (Vertex i = 0; i < 4; ++i) mitred.face({i, (i + 1) % 4, 4 + (i + 1) % 4, 4 + i});
      whole = mitred;
    }
    shape.append(quads ? whole : fans(whole));
  }
  return shape;
}

Shape plate(Random& random) {
  Region region;
  const int across = random.count(1, 3), up = random.count(1, 3);
  const std::int64_t cell = kSide / 4;
  region.outer =
      random.chance(0.2)
          ? ellipse({across * cell / 2, up * cell / 2}, 0.75 * static_cast<double>(cell * across),
                    0.75 * static_cast<double>(cell * up), random.count(8, 40), 0)
          : rectangle(0, 0, across * cell, up * cell);
  for (int i = 0; i < across; ++i) {
    for (int j = 0; j < up; ++j) {
      if (random.chance(0.15)) continue;
      const Point2 centre = {i * cell + cell / 2, j * cell + cell / 2};
      const double radius = random.between(0.05, 0.48) * static_cast<double>(cell);
      const int corners = random.chance(0.3) ? 4 : random.count(3, 24);
      const double phase = corners == 4 && random.chance(0.7) ? kTurn / 8 : random.between(0, 1);
      region.holes.push_back(ellipse(centre, radius, radius, corners, phase));
    }
  }
  return flat_shape(region, 1.0 / kSide, random);
}

namespace {

/// A letter of straight lines on a board of 8 by 10 squares: its outline, then its holes.
struct Glyph {
  Loop outer;
  std::vector<Loop> holes;
};

Glyph glyph(char name) {
  switch (name) {
    case 'A':
      return {{{0, 0}, {2, 0}, {3, 3}, {5, 3}, {6, 0}, {8, 0}, {5, 10}, {3, 10}},
              {{{3, 4}, {5, 4}, {4, 8}}}};
    case 'B':
      return {{{0, 0}, {6, 0}, {8, 2}, {8, 4}, {7, 5}, {8, 6}, {8, 8}, {6, 10}, {0, 10}},
              {{{2, 2}, {6, 2}, {6, 4}, {2, 4}}, {{2, 6}, {6, 6}, {6, 8}, {2, 8}}}};
    case 'C':
      return {{{0, 2},
               {2, 0},
               {8, 0},
               {8, 2},
               {3, 2},
               {2, 3},
               {2, 7},
               {3, 8},
               {8, 8},
               {8, 10},
               {2, 10},
               {0, 8}},
              {}};
    case 'E':
      return {{{0, 0},
               {7, 0},
               {7, 2},
               {2, 2},
               {2, 4},
               {6, 4},
               {6, 6},
               {2, 6},
               {2, 8},
               {7, 8},
               {7, 10},
               {0, 10}},
              {}};
    case 'P':
      return {{{0, 0}, {2, 0}, {2, 4}, {7, 4}, {8, 5}, {8, 9}, {7, 10}, {0, 10}},
              {{{2, 6}, {6, 6}, {6, 8}, {2, 8}}}};
    case 'S':
      return {{{0, 0},
               {7, 0},
               {8, 1},
               {8, 5},
               {7, 6},
               {2, 6},
               {2, 8},
               {8, 8},
               {8, 10},
               {1, 10},
               {0, 9},
               {0, 5},
               {1, 4},
               {6, 4},
               {6, 2},
               {0, 2}},
              {}};
    default:
      return {{{0, 0}, {8, 0}, {8, 10}, {0, 10}}, {{{2, 2}, {6, 2}, {6, 8}, {2, 8}}}};
  }
}

}  // namespace

/// Declared where solids need it.
Region letter_region(Random& random);
Region letter_region(Random& random) {
  constexpr std::string_view kNames = "ABCEPSOo8";
  const char name = kNames[random.bits() % kNames.size()];
  if (name == 'o' || name == '8') {
    const int n = random.count(6, 30);
    Region round = {ellipse({0, 0}, 300, name == 'o' ? 400 : 700, n, 0), {}};
    const double width = random.between(60, 150);
    if (name == 'o') {
      round.holes.push_back(ellipse({0, 0}, 300 - width, 400 - width, n, 0));
    } else {
      round.holes.push_back(ellipse({0, 320}, 120, 200, n, 0.1));
      round.holes.push_back(ellipse({0, -300}, 150, 220, n, 0));
    }
    return round;
  }
  const auto bigger = [](Loop loop) {
    for (Point2& p : loop) p = {100 * p[0], 100 * p[1]};
    return loop;
  };
  const Glyph drawn = glyph(name);
  Region region = {bigger(drawn.outer), {}};
  for (const Loop& hole : drawn.holes) region.holes.push_back(bigger(hole));
  return region;
}

Shape letter(Random& random) {
  Shape word;
  word.flat = true;
  const int letters = random.chance(0.7) ? 1 : random.count(2, 5);
  for (int i = 0; i < letters; ++i) {
    Shape next = flat_shape(letter_region(random), 0.001, random);
    shift(next, {1.6 * i, 0, 0});
    word.append(next);
  }
  return word;
}

Shape disc(Random& random) {
  const int n = random.chance(0.8) ? random.count(3, 40) : random.count(40, 400);
  Shape shape;
  shape.flat = true;
  const int way = random.count(0, 3);
  std::vector<Vertex> outline;
  if (way == 3) {  // a comb
    for (int i = 0; i < n; ++i) {
      outline.push_back(shape.add({static_cast<double>(i), i % 2 ? random.between(2, 20) : 1, 0}));
    }
    outline.push_back(shape.add({n - 0.5, -1, 0}));
    outline.push_back(shape.add({0, -1, 0}));
    std::reverse(outline.begin(), outline.end());
    shape.face(outline);
    return shape;
  }
  const double star = random.chance(0.5) ? 1 : random.between(0.1, 1);
  for (int i = 0; i < n; ++i) {
    const double radius = i % 2 ? star : 1, angle = kTurn * i / n;
    outline.push_back(shape.add({radius * portable::cos(angle), radius * portable::sin(angle), 0}));
  }
  if (way == 0) {
    shape.face(outline);
    return shape;
  }
  const Vertex middle = shape.add({0, 0, 0});
  for (std::size_t i = 0; i < outline.size(); ++i) {
    shape.face({middle, outline[i], outline[(i + 1) % outline.size()]});
  }
  return shape;
}

namespace {

void split_rectangle(Shape& shape, std::array<double, 4> box, int depth, bool quads,
                     Random& random) {
  const auto [x0, y0, x1, y1] = box;
  if (depth > 0 && random.chance(0.85)) {
    const double t = random.chance(0.6) ? 0.5 : random.between(0.1, 0.9);
    const double x = x0 + t * (x1 - x0), y = y0 + t * (y1 - y0);
    const bool upright = random.chance(0.5);
    split_rectangle(shape, upright ? std::array{x0, y0, x, y1} : std::array{x0, y0, x1, y},
                    depth - 1, quads, random);
    split_rectangle(shape, upright ? std::array{x, y0, x1, y1} : std::array{x0, y, x1, y1},
                    depth - 1, quads, random);
    return;
  }
  const Vertex a = shape.add({x0, y0, 0}), b = shape.add({x1, y0, 0});
  const Vertex c = shape.add({x1, y1, 0}), d = shape.add({x0, y1, 0});
  if (quads) {
    shape.face({a, b, c, d});
  } else {
    shape.face({a, b, c});
    shape.face({a, c, d});
  }
}

}  // namespace

Shape t_vertices(Random& random) {
  Shape shape;
  shape.flat = true;
  const int depth = random.count(1, 6);
  const double wide = random.spread(0.5, 2);
  const bool quads = random.chance(0.3);
  split_rectangle(shape, {0, 0, wide, 1}, depth, quads, random);
  return joined(shape);
}

Shape spiral(Random& random) {
  const int n = random.count(4, 200);
  const double turns = random.between(0.3, 6), width = random.between(0.02, 0.95);
  Shape shape = grid({n, 1, false, false, random.chance(0.3)}, [&](double u, double v) {
    const double angle = kTurn * turns * u;
    const double radius = 1 + turns * u + width * v;
    return Point3{radius * portable::cos(angle), -radius * portable::sin(angle), 0};
  });
  shape.flat = n > 24 * turns;  // else its sides may cross
  return shape;
}

}  // namespace beltrami::shapes
