// The nearest place on a surface that faces the same way.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace beltrami {

/// A point or a direction in space.
using SpacePoint = std::array<double, 3>;
using SpaceTriangle = std::array<SpacePoint, 3>;

/// The direction in which a triangle looks, its corners counter-clockwise; not of length one.
SpacePoint normal_of(const SpaceTriangle& triangle);

/// A place on a triangle of a surface.
struct OnFace {
  std::size_t face = 0;
  std::array<double, 3> weights = {1, 0, 0};  ///< of its corners, not negative, 1 together
};

/// Finds nearest places by a tree of boxes over the triangles, which it keeps. Those with a corner
/// that is not finite, or without area, are never found.
class NearestFace {
 public:
  explicit NearestFace(std::vector<SpaceTriangle> triangles);

  /// The diagonal of the box around all that can be found.
  double size() const { return size_; }

  /// The place nearest to a point, no further than `reach` from it, on the triangles that look to
  /// the same side as `normal`: the other side of a thin wall is not taken. Of equally near ones
  /// that with the smaller number. `hint`, a triangle, makes the search shorter and no different.
  std::optional<OnFace> find(const SpacePoint& point, const SpacePoint& normal, double reach,
                             std::size_t hint) const;

 private:
  struct Node {
    SpacePoint low, high;
    std::uint32_t first = 0;  ///< of a leaf in order_; the left child of others, the right is next
    std::uint32_t count = 0;  ///< triangles of a leaf; 0 for others
  };
  struct Best {
    std::optional<OnFace> place;
    double distance_sq;
  };

  void build(std::size_t node, std::size_t begin, std::size_t end,
             const std::vector<SpacePoint>& middles);
  void consider(const SpacePoint& point, const SpacePoint& normal, std::size_t face,
                Best& best) const;

  std::vector<SpaceTriangle> triangles_;
  std::vector<SpacePoint> normals_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
  double size_ = 0;
};

}  // namespace beltrami
