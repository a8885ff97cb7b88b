// A polygon mesh under construction, and what all kinds of shapes are made with.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "shapes/random.h"

namespace beltrami::shapes {

using Point3 = std::array<double, 3>;
using Vertex = std::uint32_t;

struct Shape {
  std::string kind;
  std::uint64_t seed = 0;
  std::vector<Point3> positions;
  std::vector<Vertex> corners;       ///< of all faces, one after another
  std::vector<std::uint32_t> sizes;  ///< corners of each face, 3 or more
  /// Whether every component lies in a plane of its own, so that it is its own best map.
  bool flat = false;
  /// Whether a single precision page holds its shape: energies of one that is too thin say nothing.
  bool fits_single = true;
  int resolution = 1024;  ///< texels to the side of the page that it is to be packed on
  double margin = 2;      ///< texels to be kept between charts

  Vertex add(const Point3& position);
  void face(const std::vector<Vertex>& vertices);
  /// Faces of another shape, with vertices of their own.
  void append(const Shape& other);
  std::size_t faces() const { return sizes.size(); }
  /// Index of the first corner of each face, and the number of corners at the end.
  std::vector<std::size_t> first_corners() const;
};

/// nu by nv cells with vertices at `place`(u, v), u and v in [0, 1]; in a direction that wraps the
/// last cells end at the first vertices. Cells are quads, or two triangles.
struct GridSize {
  int nu, nv;
  bool wrap_u = false, wrap_v = false;
  bool quads = false;
};
Shape grid(const GridSize& size, const std::function<Point3(double, double)>& place);

/// Every polygon as a fan of triangles; no longer flat where one is not convex.
Shape fans(const Shape& shape);
/// Every face with vertices of its own, as in STL.
Shape exploded(const Shape& shape);
/// Only the faces of which `keep` says so, and their vertices.
Shape only(const Shape& shape, const std::vector<char>& keep);
/// Vertices at one place as one.
Shape joined(const Shape& shape);
void scale(Shape& shape, const Point3& factors);
void shift(Shape& shape, const Point3& by);
/// Turns it by a random rotation.
void turn(Shape& shape, Random& random);
/// Rounds the positions to single precision.
void round_to_float(Shape& shape);

}  // namespace beltrami::shapes
