#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/portable_math.h"
#include "shapes/kinds.h"
#include "shapes/random.h"
#include "shapes/region.h"
#include "shapes/shape.h"

namespace beltrami::shapes {

Region letter_region(Random& random);

namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kUnit = 0x1p-10;  ///< of the grid that outlines are drawn on

Loop outline(Random& random) {
  switch (random.count(0, 3)) {
    case 0: {
      const int wide = random.count(100, 2000), high = random.count(100, 2000);
      return rectangle(0, 0, wide, high);
    }
    case 1:  // an L
      return {{0, 0},
              {1000, 0},
              {1000, 300},
              {random.count(100, 900), 300},
              {random.count(50, 100), 1000},
              {0, 1000}};
    case 2: {  // a star or a gear
      Loop loop;
      const int n = 2 * random.count(3, 24);
      const double inner = random.between(200, 950);
      for (int i = 0; i < n; ++i) {
        const double radius = i % 2 ? inner : 1000, angle = kTurn * i / n;
        loop.push_back({std::llround(radius * portable::cos(angle)),
                        std::llround(radius * portable::sin(angle))});
      }
      return loop;
    }
    default: {
      const double high = random.between(200, 1000);
      return ellipse({0, 0}, 1000, high, random.count(3, 60), 0);
    }
  }
}

Extrusion extrusion(Random& random) {
  Extrusion how;
  how.unit = kUnit;
  how.height = random.chance(0.7) ? random.between(0.1, 2) : random.spread(1e-3, 30);
  how.layers = random.chance(0.7) ? 1 : random.count(2, 6);
  how.quads = random.chance(0.3);
  how.lid = random.chance(0.85);
  if (random.chance(0.2)) how.taper = random.between(0.05, 1.5);
  return how;
}

}  // namespace

Shape prism(Random& random) {
  const Region region = {outline(random), {}};
  const Extrusion how = extrusion(random);
  return extrude(region, how, random);
}

Shape block(Random& random) {
  Region region;
  const int across = random.count(1, 3), up = random.count(1, 2);
  region.outer = rectangle(0, 0, 1000 * across, 1000 * up);
  for (int i = 0; i < across; ++i) {
    for (int j = 0; j < up; ++j) {
      if (i + j > 0 && random.chance(0.2)) continue;
      const double radius = random.between(60, 480);
      const int corners = random.count(3, 32);
      const Point2 centre = {1000 * i + 500, 1000 * j + 500};
      region.holes.push_back(ellipse(centre, radius, radius, corners, random.between(0, 1)));
    }
  }
  Extrusion how = extrusion(random);
  how.taper = 1;
  return extrude(region, how, random);
}

Shape solid_letter(Random& random) {
  const Region region = letter_region(random);
  const Extrusion how = extrusion(random);
  return extrude(region, how, random);
}

Shape blob(Random& random) {
  const int n = random.count(3, 16);
  const double noise = random.chance(0.3) ? 0 : random.spread(0.001, 0.6);
  const bool open = random.chance(0.3);
  Shape shape = grid({n, 2 * n, false, true}, [&](double u, double v) {
    const double low = 0.5 / n, around = kTurn * v;
    const double down = std::numbers::pi * (low + (1 - 2 * low) * u);
    const double radius = 1 + noise * random.between(-1, 1);
    return Point3{radius * portable::sin(down) * portable::cos(around),
                  radius * portable::sin(down) * portable::sin(around),
                  radius * portable::cos(down)};
  });
  if (open) return shape;
  const auto columns = static_cast<Vertex>(2 * n), last = columns * static_cast<Vertex>(n);
  const Vertex top = shape.add({0, 0, 1}), bottom = shape.add({0, 0, -1});
  for (Vertex j = 0; j < columns; ++j) {
    shape.face({top, j, (j + 1) % columns});
    shape.face({bottom, last + (j + 1) % columns, last + j});
  }
  return shape;
}

Shape torus(Random& random) {
  Shape shape;
  const int rings = random.chance(0.7) ? 1 : random.count(2, 4);
  for (int k = 0; k < rings; ++k) {
    const double thick = random.between(0.1, 0.6), noise = random.chance(0.5) ? 0 : 0.1;
    Shape ring =
        grid({random.count(3, 20), random.count(3, 12), true, true, random.chance(0.2)},
             [&](double u, double v) {
               const double small = thick * (1 + noise * random.between(-1, 1));
               const double radius = 1 + small * portable::cos(kTurn * v);
               return Point3{radius * portable::cos(kTurn * u), radius * portable::sin(kTurn * u),
                             small * portable::sin(kTurn * v)};
             });
    shift(ring, {(random.chance(0.5) ? 3.5 : 1.3) * k, 0, 0});
    shape.append(ring);
  }
  return shape;
}

namespace {

/// The outer faces of the cells of a box of nx by ny by nz that are filled.
Shape skin(const std::array<int, 3>& n, const std::vector<char>& filled, bool quads) {
  Shape shape;
  const auto at = [&](std::array<int, 3> c) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (c[k] < 0 || c[k] >= n[k]) return false;
    }
    return filled[static_cast<std::size_t>((c[0] * n[1] + c[1]) * n[2] + c[2])] != 0;
  };
  for (int x = 0; x < n[0]; ++x) {
    for (int y = 0; y < n[1]; ++y) {
      for (int z = 0; z < n[2]; ++z) {
        if (!at({x, y, z})) continue;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          for (const int side : {0, 1}) {
            std::array<int, 3> next = {x, y, z};
            next[axis] += side ? 1 : -1;
            if (at(next)) continue;
            std::vector<Vertex> square;
            for (const auto& [du, dv] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
              std::array<int, 3> corner = {x, y, z};
              corner[axis] += side;
              corner[(axis + 1) % 3] += side ? du : dv;
              corner[(axis + 2) % 3] += side ? dv : du;
              square.push_back(
                  shape.add({static_cast<double>(corner[0]), static_cast<double>(corner[1]),
                             static_cast<double>(corner[2])}));
            }
            shape.face(square);
          }
        }
      }
    }
  }
  shape = joined(shape);
  return quads ? shape : fans(shape);
}

}  // namespace

Shape voxels(Random& random) {
  const std::array<int, 3> n = {random.count(1, 5), random.count(1, 5), random.count(1, 4)};
  const double share = random.between(0.15, 0.95);
  std::vector<char> filled(static_cast<std::size_t>(n[0] * n[1] * n[2]));
  for (char& cell : filled) cell = random.chance(share);
  filled[0] = 1;
  return skin(n, filled, random.chance(0.4));
}

Shape lattice(Random& random) {
  const std::array<int, 3> cells = {random.count(1, 2), random.count(1, 2), random.count(0, 2)};
  const std::array<int, 3> n = {2 * cells[0] + 1, 2 * cells[1] + 1, 2 * cells[2] + 1};
  const double torn = random.chance(0.6) ? 0 : 0.15;
  std::vector<char> filled;
  for (int x = 0; x < n[0]; ++x) {
    for (int y = 0; y < n[1]; ++y) {
      for (int z = 0; z < n[2]; ++z) {
        filled.push_back((x % 2) + (y % 2) + (z % 2) <= 1 && !random.chance(torn));
      }
    }
  }
  filled[0] = 1;
  return skin(n, filled, random.chance(0.4));
}

}  // namespace beltrami::shapes
