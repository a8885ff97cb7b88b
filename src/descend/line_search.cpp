#include "descend/line_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/interrupt.h"
#include "base/parallel.h"
#include "mesh/face_chunks.h"

namespace beltrami {
namespace {

constexpr std::int64_t kGrain = 2048;  // of some faces

double cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Smallest root of c0 + c1 t + c2 t^2 that is not negative, for c0 >= 0.
double smallest_positive_root(double c0, double c1, double c2) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const double discriminant = c1 * c1 - 4 * c0 * c2;
  if (discriminant < 0) return kNever;
  const double root = std::sqrt(discriminant);
  if (c1 < 0) return 2 * c0 / (root - c1);
  return c2 < 0 ? (c1 + root) / (-2 * c2) : kNever;
}

/// Twice the area of a positive face along the way: c0 + c1 t + c2 t^2. Of a face so thin that
/// roundoff makes its area negative c0 is 0: it may grow only.
struct AreaPolynomial {
  double c0, c1, c2;
};

AreaPolynomial area_along(const Triangle& t, const std::vector<Vec2>& uvs,
                          const std::vector<Vec2>& direction) {
  const Vec2 e1 = uvs[t[1]] - uvs[t[0]], e2 = uvs[t[2]] - uvs[t[0]];
  const Vec2 p1 = direction[t[1]] - direction[t[0]], p2 = direction[t[2]] - direction[t[0]];
  return {std::max(cross(e1, e2), 0.0), cross(e1, p2) + cross(p1, e2), cross(p1, p2)};
}

/// Where the face becomes singular, if that is before `limit`.
std::optional<double> singular_before(double limit, const Triangle& face,
                                      const std::vector<Vec2>& uvs,
                                      const std::vector<Vec2>& direction) {
  const auto [c0, c1, c2] = area_along(face, uvs, direction);
  // Most faces are far from it, and need no root.
  if (c0 > limit * (std::max(0.0, -c1) + limit * std::max(0.0, -c2))) return {};
  const double root = smallest_positive_root(c0, c1, c2);
  return root < limit ? std::optional(root) : std::nullopt;
}

/// Of the faces face_at(0 .. count - 1), in their order.
template <class FaceAt>
std::vector<SingularStep> singular_among(std::int64_t count, std::int64_t grain,
                                         const FaceAt& face_at, const std::vector<Triangle>& faces,
                                         const std::vector<Vec2>& uvs,
                                         const std::vector<Vec2>& direction, double limit,
                                         const Work& work) {
  std::vector<std::vector<SingularStep>> found(count / grain + 1);
  parallel_for(work, count, grain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i) {
      const Index f = face_at(i);
      const auto length = singular_before(limit, faces[f], uvs, direction);
      if (length) found[begin / grain].push_back({f, *length});
    }
  });
  std::size_t total = 0;
  for (const auto& chunk : found) total += chunk.size();
  std::vector<SingularStep> all;
  all.reserve(total);
  for (const auto& chunk : found) {
    poll_interrupt();
    all.insert(all.end(), chunk.begin(), chunk.end());
  }
  return all;
}

}  // namespace

double first_singular_step(const std::vector<Triangle>& faces, const std::vector<Vec2>& uvs,
                           const std::vector<Vec2>& direction, const Work& work) {
  const std::int64_t grain = FaceChunks::grain_of(size_of(faces));
  std::vector<double> smallest(faces.size() / grain + 1, std::numeric_limits<double>::infinity());
  parallel_for(work, size_of(faces), grain, [&](std::int64_t begin, std::int64_t end) {
    double& least = smallest[begin / grain];
    for (std::int64_t f = begin; f < end; ++f) {
      const auto [c0, c1, c2] = area_along(faces[f], uvs, direction);
      least = std::min(least, smallest_positive_root(c0, c1, c2));
    }
  });
  return *std::min_element(smallest.begin(), smallest.end());
}

std::vector<SingularStep> singular_steps(const std::vector<Triangle>& faces,
                                         const std::vector<Vec2>& uvs,
                                         const std::vector<Vec2>& direction, double limit,
                                         const Work& work) {
  return singular_among(
      size_of(faces), FaceChunks::grain_of(size_of(faces)),
      [](std::int64_t f) { return static_cast<Index>(f); }, faces, uvs, direction, limit, work);
}

std::vector<SingularStep> singular_steps_of(const std::vector<Index>& some,
                                            const std::vector<Triangle>& faces,
                                            const std::vector<Vec2>& uvs,
                                            const std::vector<Vec2>& direction, double limit,
                                            const Work& work) {
  std::vector<SingularStep> found = singular_among(
      size_of(some), kGrain, [&](std::int64_t i) { return some[i]; }, faces, uvs, direction, limit,
      work);
  sort_interruptibly(
      found.begin(), found.end(),
      [](const SingularStep& one, const SingularStep& other) { return one.face < other.face; });
  return found;
}

}  // namespace beltrami
