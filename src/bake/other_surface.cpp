#include "bake/other_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/interrupt.h"
#include "base/portable_math.h"

namespace beltrami {
namespace {

/// Of the size of the surface: how far what a texel shows may be from it.
constexpr double kReach = 0.02;
/// Of the size of the surface: how far above it a look at the sky begins, lest a face hides it from
/// itself. Single precision of coordinates is coarser.
constexpr double kAbove = 1e-7;
constexpr double kPi = 3.14159265358979323846;

/// Two directions across `normal`, of length 1 all three (Duff et al., Building an Orthonormal
/// Basis, Revisited, 2017).
std::array<Vec3, 2> across(const Vec3& normal) {
  const double sign = std::copysign(1.0, normal.z());
  const double a = -1 / (sign + normal.z()), b = normal.x() * normal.y() * a;
  return {Vec3(1 + sign * normal.x() * normal.x() * a, sign * b, -sign * normal.x()),
          Vec3(b, sign + normal.y() * normal.y() * a, -normal.y())};
}

}  // namespace

OtherSurface::OtherSurface(std::span<const std::array<Vec3, 3>> triangles)
    : face_of_number_(triangles.size(), kNone) {
  PollSometimes poll;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    poll();
    const std::array<Vec3, 3>& places = triangles[t];
    const auto is_finite = [](const Vec3& place) { return place.allFinite(); };
    if (!std::all_of(places.begin(), places.end(), is_finite)) continue;
    const Index first = size_of(positions_);
    positions_.insert(positions_.end(), places.begin(), places.end());
    face_of_number_[t] = size_of(faces_);
    faces_.push_back({first, first + 1, first + 2});
    numbers_.push_back(t);
  }
  if (faces_.empty()) return;
  closest_.emplace(positions_, faces_);
  rays_.emplace(positions_, faces_, closest_->tree());
}

std::optional<PointOfTriangle> OtherSurface::find(const LookFrom& from, double cage,
                                                  std::size_t& hint) const {
  if (!closest_) return std::nullopt;
  SurfacePoint at;
  if (cage > 0) {
    at = rays_->first_from_outside({from.point + cage * from.direction, -from.direction, 2 * cage});
  }
  if (at.face == kNone) {
    const Index seed = hint < faces_.size() ? static_cast<Index>(hint) : kNone;
    at = closest_->find_within(from.point, from.face_normal, kReach * closest_->size(), seed);
  }
  if (at.face == kNone) return std::nullopt;
  hint = static_cast<std::size_t>(at.face);
  return PointOfTriangle{numbers_[hint], at.barycentric};
}

double OtherSurface::open_share(const PointOfTriangle& point, std::span<const Vec3> directions,
                                std::size_t first, std::size_t step) const {
  const Index face = face_of_number_[point.triangle];
  if (face == kNone || first >= directions.size()) return 1;
  std::array<Vec3, 3> corners;
  Vec3 place(0, 0, 0);
  for (std::size_t k = 0; k < 3; ++k) {
    corners[k] = positions_[faces_[face][k]];
    place += point.weights[k] * corners[k];
  }
  const Vec3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
  const double size = closest_->size();
  const auto [x, y] = across(normal);
  std::size_t open = 0, all = 0;
  for (std::size_t i = first; i < directions.size(); i += step) {
    poll_interrupt();
    const Vec3& d = directions[i];
    const Vec3 direction = d.x() * x + d.y() * y + d.z() * normal;
    ++all;
    if (!rays_->is_stopped({place + kAbove * size * normal, direction, 2 * size})) ++open;
  }
  return double(open) / double(all);
}

std::vector<Vec3> sky_directions(std::size_t count) {
  std::vector<Vec3> directions;
  directions.reserve(count);
  const double golden = kPi * (3 - std::sqrt(5.0));  // the angle of a sunflower's seeds
  for (std::size_t i = 0; i < count; ++i) {
    const double share = (double(i) + 0.5) / double(count), radius = std::sqrt(share);
    const double angle = std::fmod(golden * double(i), 2 * kPi);
    directions.emplace_back(radius * portable::cos(angle), radius * portable::sin(angle),
                            std::sqrt(1 - share));
  }
  return directions;
}

}  // namespace beltrami
