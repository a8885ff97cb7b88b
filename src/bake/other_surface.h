// A surface that is looked for from another one of its shape.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "mesh/closest_point.h"
#include "mesh/rays.h"

namespace beltrami {

/// A point of one of the triangles that were given.
struct PointOfTriangle {
  std::size_t triangle = 0;
  std::array<double, 3> weights{};
};

/// From where a surface is looked for.
struct LookFrom {
  Vec3 point;
  Vec3 face_normal;  ///< of any length: what is found looks to the same side
  Vec3 direction;    ///< of length 1, outwards: rays go along it
};

/// Queries are const and may come from several threads.
class OtherSurface {
 public:
  /// Triangles with a corner that is not finite are left out.
  explicit OtherSurface(std::span<const std::array<Vec3, 3>> triangles);
  OtherSurface(const OtherSurface&) = delete;
  OtherSurface& operator=(const OtherSurface&) = delete;

  /// With a `cage`: the first place that a ray meets which comes from as far outside and goes as
  /// far inside, of a face that it comes to from outside. Where there is none, and with a cage of
  /// 0, the nearest place within 2 % of the surface's size, of a face that looks to the same side.
  /// `hint` is what was found last; it changes how long it takes.
  std::optional<PointOfTriangle> find(const LookFrom& from, double cage, std::size_t& hint) const;

  /// The share of the directions `first`, `first + step`, ... that nothing of the surface is in as
  /// seen from a point of it, outside. They are those of sky_directions().
  double open_share(const PointOfTriangle& point, std::span<const Vec3> directions,
                    std::size_t first, std::size_t step) const;

 private:
  std::vector<Vec3> positions_;  // three for each triangle
  std::vector<Triangle> faces_;
  std::vector<std::size_t> numbers_;   // of these triangles among all that were given
  std::vector<Index> face_of_number_;  // kNone for those that are left out
  std::optional<ClosestPoint> closest_;
  std::optional<Rays> rays_;
};

/// `count` directions around the z axis, as many where it is the steeper as a grey sky lights a
/// face by the cosine: the same weight for each.
std::vector<Vec3> sky_directions(std::size_t count);

}  // namespace beltrami
