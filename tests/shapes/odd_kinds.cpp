#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/portable_math.h"
#include "shapes/kinds.h"
#include "shapes/random.h"
#include "shapes/shape.h"

namespace beltrami::shapes {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

Point3 random_point(Random& random, double size) {
  return {random.between(-size, size), random.between(-size, size), random.between(-size, size)};
}

Shape box() {
  Shape shape;
  for (int k = 0; k < 8; ++k) {
    shape.add({k & 1 ? 1.0 : 0.0, k & 2 ? 1.0 : 0.0, k & 4 ? 1.0 : 0.0});
  }
  for (const auto& side : std::vector<std::vector<Vertex>>{
           {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) {
    shape.face(side);
  }
  return shape;
}

/// Triangles of one of several plain shapes.
Shape plain(Random& random) {
  switch (random.count(0, 5)) {
    case 0:
      return fans(box());
    case 1:
      return fans(flat_ring(random));
    case 2:
      return fans(prism(random));
    case 3: {
      Shape cloth = grid({random.count(1, 5), random.count(1, 5)}, [&](double u, double v) {
        return Point3{u, v, 0.1 * random.unit()};
      });
      return cloth;
    }
    case 4:
      return fans(torus(random));
    default: {
      Shape square = grid({random.count(1, 4), random.count(1, 4)}, [](double u, double v) {
        return Point3{u, v, 0};
      });
      square.flat = true;
      return square;
    }
  }
}

/// Splits a triangle by a vertex that is near its first edge: `height` of the way to its apex.
void split_near_edge(Shape& shape, std::size_t face, double along, double height, bool leave_gap) {
  std::array<Vertex, 3> c;
  std::copy_n(&shape.corners[3 * face], 3, c.begin());
  Point3 p;
  for (std::size_t k = 0; k < 3; ++k) {
    const double a = shape.positions[c[0]][k], b = shape.positions[c[1]][k];
    const double on_edge = a + along * (b - a);
    p[k] = on_edge + height * (shape.positions[c[2]][k] - on_edge);
  }
  const Vertex v = shape.add(p);
  shape.corners[3 * face] = v;
  shape.face({c[0], v, c[2]});
  if (!leave_gap) shape.face({c[0], c[1], v});
}

}  // namespace

Shape sliver(Random& random) {
  Shape shape = plain(random);
  const int slivers = random.chance(0.5) ? 1 : random.count(2, 12);
  const bool gaps = random.chance(0.15);
  const double height = random.spread(1e-15, 1), along = random.between(0.05, 0.95);
  const bool alike = random.chance(0.5);
  for (int i = 0; i < slivers; ++i) {
    const std::size_t face = random.bits() % shape.faces();
    // Which edge is the first one.
    const auto first = shape.corners.begin() + static_cast<std::ptrdiff_t>(3 * face);
    std::rotate(first, first + random.count(0, 2), first + 3);
    // Numbers are drawn in statements of their own: the order of arguments is the compiler's.
    const double share = alike ? along : random.between(0.01, 0.99);
    const double rise = 0.9 * (alike ? height : random.spread(1e-15, 1));
    split_near_edge(shape, face, share, rise, gaps);
  }
  return shape;
}

Shape needle(Random& random) {
  Shape shape;
  const double thin = random.spread(1e-8, 0.3);
  // Some thirty steps of single precision across what is as long as the page.
  constexpr double kLeastThickness = 2e-6;
  shape.fits_single = thin >= kLeastThickness;
  switch (random.count(0, 4)) {
    case 0:  // lone ones
      for (int i = random.count(1, 12); i > 0; --i) {
        Shape one;
        one.face({one.add({0, 0, 0}), one.add({1, 0, 0}), one.add({random.unit(), thin, 0})});
        turn(one, random);
        shift(one, random_point(random, 2));
        shape.append(one);
      }
      shape.flat = true;
      return shape;
    case 1: {  // a fan of them
      const Vertex middle = shape.add({0, 0, 0});
      const int n = random.count(2, 60);
      const double step = std::min(thin, 6.0 / n);
      for (int i = 0; i <= n; ++i) {
        shape.add({portable::cos(step * i), portable::sin(step * i), 0});
        if (i > 0) shape.face({middle, static_cast<Vertex>(i), static_cast<Vertex>(i + 1)});
      }
      shape.flat = true;
      return shape;
    }
    case 2:  // a long strip
      shape.append(grid({random.count(1, 60), random.count(1, 2)}, [&](double u, double v) {
        return Point3{u, thin * v, 0};
      }));
      shape.flat = true;
      return shape;
    case 3: {  // a spike on a plate
      shape.append(grid({4, 4}, [](double u, double v) { return Point3{u, v, 0}; }));
      shape.fits_single = true;
      shape.positions[12][2] = random.spread(0.1, 1e4);
      return shape;
    }
    default: {  // a rod with a point
      const int n = random.count(3, 12);
      shape.append(grid({random.count(1, 4), n, false, true}, [&](double u, double v) {
        return Point3{thin * portable::cos(kTurn * v), thin * portable::sin(kTurn * v), u};
      }));
      const Vertex tip = shape.add({0, 0, random.between(1, 2)});
      const auto ring = static_cast<Vertex>(n), last = tip - ring;
      for (Vertex j = 0; j < ring; ++j) shape.face({last + j, last + (j + 1) % ring, tip});
      return shape;
    }
  }
}

Shape soup(Random& random) {
  Shape shape;
  const int n = random.chance(0.8) ? random.count(1, 60) : random.count(60, 300);
  const double size = random.spread(1e-3, 1), wide = random.spread(1, 1e3);
  for (int i = 0; i < n; ++i) {
    const Point3 centre = random_point(random, size);
    std::vector<Vertex> face;
    for (int k = 0; k < 3; ++k) {
      Point3 p = random_point(random, size * random.spread(1, wide));
      for (std::size_t x = 0; x < 3; ++x) p[x] += centre[x];
      face.push_back(shape.add(p));
    }
    shape.face(face);
  }
  shape.flat = true;
  return shape;
}

Shape chaos(Random& random) {
  Shape shape;
  const int vertices = random.count(4, 14), faces = random.count(1, 40);
  const bool on_grid = random.chance(0.3);
  for (int i = 0; i < vertices; ++i) {
    shape.add(on_grid ? Point3{1.0 * random.count(0, 2), 1.0 * random.count(0, 2),
                               1.0 * random.count(0, 2)}
                      : random_point(random, 1));
  }
  for (int f = 0; f < faces; ++f) {
    std::vector<Vertex> face;
    while (face.size() < 3) {
      const auto v = static_cast<Vertex>(random.count(0, vertices - 1));
      if (std::find(face.begin(), face.end(), v) == face.end()) face.push_back(v);
    }
    shape.face(face);
  }
  return shape;
}

Shape copies(Random& random) {
  const Shape one = random.chance(0.5) ? plain(random) : box();
  Shape shape = one;
  const int more = random.count(1, 5);
  const bool beside = random.chance(0.3), share_vertices = random.chance(0.3);
  for (int i = 1; i <= more; ++i) {
    Shape copy = one;
    if (beside) shift(copy, {2.5 * i, 0, 0});
    if (!beside && random.chance(0.4)) {  // turned inside out
      const auto firsts = copy.first_corners();
      for (std::size_t f = 0; f < copy.faces(); ++f) {
        std::reverse(copy.corners.begin() + static_cast<std::ptrdiff_t>(firsts[f]),
                     copy.corners.begin() + static_cast<std::ptrdiff_t>(firsts[f + 1]));
      }
    }
    if (!beside && random.chance(0.3)) {  // some of it only
      std::vector<char> keep(copy.faces());
      for (char& k : keep) k = random.chance(0.5);
      copy = only(copy, keep);
    }
    shape.append(copy);
  }
  return share_vertices ? joined(shape) : shape;
}

Shape crumbs(Random& random) {
  Shape shape = plain(random);
  const bool was_flat = shape.flat;
  const int n = random.count(1, 80);
  const double size = random.spread(1e-9, 0.1);
  for (int i = 0; i < n; ++i) {
    Shape crumb;
    if (random.chance(0.6)) {
      crumb.face({crumb.add({0, 0, 0}), crumb.add({1, 0, 0}), crumb.add({0.3, random.unit(), 0})});
    } else {
      crumb = box();
    }
    turn(crumb, random);
    const double crumb_size = size * random.spread(0.1, 1);
    scale(crumb, {crumb_size, crumb_size, crumb_size});
    shift(crumb, random_point(random, 2));
    shape.append(crumb);
  }
  shape.flat = was_flat && size < 1e-5;  // boxes among them have no vote then
  return shape;
}

Shape twisted(Random& random) {
  Shape shape;
  const int n = random.count(5, 60), twists = random.count(0, 5);
  const bool bottle = random.chance(0.2), mirrored = twists % 2 == 1;
  const int m = random.count(bottle ? 3 : 1, bottle ? 8 : 4), columns = bottle ? m : m + 1;
  const double width = random.between(0.02, 0.9);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < columns; ++j) {
      const double along = kTurn * i / n, turned = 0.5 * twists * along;
      // Across a bottle it is a figure of eight.
      const double round = kTurn * j / m;
      const double x = bottle ? width * portable::sin(round) : width * (2.0 * j / m - 1);
      const double y = bottle ? 0.5 * width * portable::sin(2 * round) : 0;
      const double out = x * portable::cos(turned) - y * portable::sin(turned);
      const double up = x * portable::sin(turned) + y * portable::cos(turned);
      shape.add({(1 + out) * portable::cos(along), (1 + out) * portable::sin(along), up});
    }
  }
  const auto at = [&](int i, int j) {
    if (i == n && mirrored) j = m - j;
    return static_cast<Vertex>((i % n) * columns + j % columns);
  };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < m; ++j) {
      shape.face({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      shape.face({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return shape;
}

Shape book(Random& random) {
  Shape shape;
  const int pages = random.count(3, 9), high = random.count(1, 6), wide = random.count(1, 4);
  const double curl = random.chance(0.5) ? 0 : random.between(0, 0.5);
  const int spines = random.chance(0.7) ? 1 : 2;
  for (int p = 0; p < pages; ++p) {
    const double angle = kTurn * (p + 0.3 * random.unit()) / pages, bend = curl * random.unit();
    Shape page = grid({high, wide}, [&](double u, double v) {
      if (v == 0 || (v == 1 && spines == 2)) return Point3{3 * v, 0, u};
      const double a = angle + bend * v;
      return Point3{v * portable::cos(a), v * portable::sin(a), u};
    });
    shape.append(page);
  }
  return joined(shape);
}

Shape hub(Random& random) {
  Shape shape;
  const Vertex middle = shape.add({0, 0, 0});
  for (int fans = random.count(1, 12); fans > 0; --fans) {
    const int n = random.count(1, 20);
    const bool closed = n >= 3 && random.chance(0.5);
    const double steep = random.between(0.05, 3);
    Shape cone;
    for (int i = 0; i < n + (closed ? 0 : 1); ++i) {
      const double angle = (closed ? kTurn : 0.8 * kTurn) * i / n;
      cone.add({portable::cos(angle), portable::sin(angle), steep});
    }
    turn(cone, random);
    const auto first = static_cast<Vertex>(shape.positions.size());
    const auto size = static_cast<Vertex>(cone.positions.size());
    for (const Point3& p : cone.positions) shape.add(p);
    for (Vertex i = 0; i < static_cast<Vertex>(n); ++i) {
      shape.face({middle, first + i, first + (i + 1) % size});
    }
  }
  return shape;
}

Shape ribbon(Random& random) {
  const int n = random.count(2, 80), m = random.count(1, 3);
  const double step = random.spread(0.05, 3);
  Point3 walk = {0, 0, 0};
  return grid({n, m, random.chance(0.2) && n > 3, false}, [&](double, double v) {
    if (v == 0) {
      for (double& x : walk) x += random.between(-step, step);
    }
    Point3 p = walk;
    p[0] += v;
    for (double& x : p) x += 0.3 * step * random.between(-1, 1);
    return p;
  });
}

Shape degenerate(Random& random) {
  Shape shape;
  if (random.chance(0.5)) shape = plain(random);
  const int n = random.count(1, 8);
  const auto old = static_cast<int>(shape.positions.size());
  for (int i = 0; i < n; ++i) {
    const Point3 p = random_point(random, 1);
    const Point3 q = {2 * p[0], 2 * p[1], 2 * p[2]}, r = {3 * p[0], 3 * p[1], 3 * p[2]};
    switch (random.count(0, 4)) {
      case 0:
        shape.face({shape.add(p), shape.add(p), shape.add(p)});
        break;
      case 1:
        shape.face({shape.add(p), shape.add(q), shape.add(r)});
        break;
      case 2: {
        const Vertex a = shape.add(p);
        shape.face({a, a, shape.add(q)});
        break;
      }
      case 3: {
        const Vertex a = shape.add(p), b = shape.add(q);
        shape.face({a, b, a, b});
        break;
      }
      default: {  // that hangs on what is there
        if (old < 2) break;
        const auto any = [&] { return static_cast<Vertex>(random.count(0, old - 1)); };
        const Vertex a = any(), b = any();
        const Point3 &s = shape.positions[a], &t = shape.positions[b];
        const Point3 middle = {0.5 * (s[0] + t[0]), 0.5 * (s[1] + t[1]), 0.5 * (s[2] + t[2])};
        shape.face({a, b, shape.add(middle)});
      }
    }
  }
  if (shape.faces() == 0)
    shape.face({shape.add({0, 0, 0}), shape.add({1, 0, 0}), shape.add({2, 0, 0})});
  shape.flat = false;
  return shape;
}

}  // namespace beltrami::shapes
