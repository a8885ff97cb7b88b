#include "shapes/shape.h"

#include <cmath>
#include <map>

namespace beltrami::shapes {

Vertex Shape::add(const Point3& position) {
  positions.push_back(position);
  return static_cast<Vertex>(positions.size() - 1);
}

void Shape::face(const std::vector<Vertex>& vertices) {
  corners.insert(corners.end(), vertices.begin(), vertices.end());
  sizes.push_back(static_cast<std::uint32_t>(vertices.size()));
}

void Shape::append(const Shape& other) {
  const auto first = static_cast<Vertex>(positions.size());
  positions.insert(positions.end(), other.positions.begin(), other.positions.end());
  for (const Vertex v : other.corners) corners.push_back(first + v);
  sizes.insert(sizes.end(), other.sizes.begin(), other.sizes.end());
}

std::vector<std::size_t> Shape::first_corners() const {
  std::vector<std::size_t> firsts = {0};
  for (const std::uint32_t size : sizes) firsts.push_back(firsts.back() + size);
  return firsts;
}

Shape grid(const GridSize& size, const std::function<Point3(double, double)>& place) {
  Shape shape;
  const int rows = size.wrap_u ? size.nu : size.nu + 1;
  const int columns = size.wrap_v ? size.nv : size.nv + 1;
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) {
      shape.add(place(static_cast<double>(i) / size.nu, static_cast<double>(j) / size.nv));
    }
  }
  const auto at = [&](int i, int j) {
    return static_cast<Vertex>((i % rows) * columns + j % columns);
  };
  for (int i = 0; i < size.nu; ++i) {
    for (int j = 0; j < size.nv; ++j) {
      const Vertex a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
      if (size.quads) {
        shape.face({a, b, c, d});
      } else {
        shape.face({a, b, c});
        shape.face({a, c, d});
      }
    }
  }
  return shape;
}

namespace {

/// The same but for its vertices and faces.
Shape like(const Shape& shape) {
  Shape other = shape;
  other.positions.clear();
  other.corners.clear();
  other.sizes.clear();
  return other;
}

}  // namespace

Shape fans(const Shape& shape) {
  Shape out = like(shape);
  out.positions = shape.positions;
  const auto firsts = shape.first_corners();
  const auto normal = [&](const Vertex* corner, std::uint32_t k) {
    const Point3 &a = shape.positions[corner[0]], &b = shape.positions[corner[k - 1]],
                 &c = shape.positions[corner[k]];
    Point3 n;
    for (int d = 0; d < 3; ++d) {
      const int e = (d + 1) % 3, f = (d + 2) % 3;
      n[d] = (b[e] - a[e]) * (c[f] - a[f]) - (b[f] - a[f]) * (c[e] - a[e]);
    }
    return n;
  };
  for (std::size_t f = 0; f < shape.faces(); ++f) {
    const Vertex* corner = &shape.corners[firsts[f]];
    const Point3 first = normal(corner, 2);
    for (std::uint32_t k = 2; k < shape.sizes[f]; ++k) {
      out.face({corner[0], corner[k - 1], corner[k]});
      // The fan of a polygon that is not convex lies on itself.
      const Point3 other = normal(corner, k);
      if (first[0] * other[0] + first[1] * other[1] + first[2] * other[2] < 0) out.flat = false;
    }
  }
  return out;
}

Shape exploded(const Shape& shape) {
  Shape out = like(shape);
  out.sizes = shape.sizes;
  for (const Vertex v : shape.corners) out.corners.push_back(out.add(shape.positions[v]));
  return out;
}

Shape only(const Shape& shape, const std::vector<char>& keep) {
  Shape out = like(shape);
  std::map<Vertex, Vertex> names;
  const auto firsts = shape.first_corners();
  for (std::size_t f = 0; f < shape.faces(); ++f) {
    if (!keep[f]) continue;
    for (std::size_t c = firsts[f]; c < firsts[f + 1]; ++c) {
      const Vertex v = shape.corners[c];
      const auto [name, is_new] = names.try_emplace(v, static_cast<Vertex>(out.positions.size()));
      if (is_new) out.add(shape.positions[v]);
      out.corners.push_back(name->second);
    }
    out.sizes.push_back(shape.sizes[f]);
  }
  return out;
}

Shape joined(const Shape& shape) {
  Shape out = like(shape);
  out.sizes = shape.sizes;
  std::map<Point3, Vertex> names;
  for (const Vertex v : shape.corners) {
    const Point3& place = shape.positions[v];
    const auto [name, is_new] = names.try_emplace(place, static_cast<Vertex>(out.positions.size()));
    if (is_new) out.add(place);
    out.corners.push_back(name->second);
  }
  return out;
}

void scale(Shape& shape, const Point3& factors) {
  for (Point3& p : shape.positions) {
    for (std::size_t k = 0; k < 3; ++k) p[k] *= factors[k];
  }
}

void shift(Shape& shape, const Point3& by) {
  for (Point3& p : shape.positions) {
    for (std::size_t k = 0; k < 3; ++k) p[k] += by[k];
  }
}

void turn(Shape& shape, Random& random) {
  // A unit quaternion, from the ball of dimension four.
  double q[4], norm = 0;
  do {
    norm = 0;
    for (double& x : q) {
      x = random.between(-1, 1);
      norm += x * x;
    }
  } while (norm > 1 || norm < 0.01);
  const double length = std::sqrt(norm);
  for (double& x : q) x /= length;
  const auto [w, x, y, z] = q;
  const double rows[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
                             {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
                             {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}};
  for (Point3& p : shape.positions) {
    const Point3 old = p;
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = rows[k][0] * old[0] + rows[k][1] * old[1] + rows[k][2] * old[2];
    }
  }
}

void round_to_float(Shape& shape) {
  for (Point3& p : shape.positions) {
    for (double& x : p) x = static_cast<double>(static_cast<float>(x));
  }
}

}  // namespace beltrami::shapes
