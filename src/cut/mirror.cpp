#include "cut/mirror.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "base/interrupt.h"
#include "base/parallel.h"
#include "base/portable_math.h"
#include "mesh/closest_point.h"

namespace beltrami {
namespace {

using Mat3 = Eigen::Matrix3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Points that a plane is judged by: a share of the area to some 0.5%.
constexpr Index kSamples = 4096;
/// Planes are fitted to every kEvery-th of them, and first compared by fewer.
constexpr Index kEvery = 4, kFirstEvery = 32;

/// Axes with moments nearer to each other than this give no direction between them.
constexpr double kDistinct = 0.1;
/// Normals tried between two such axes, 5 degrees apart; and among three, 8 degrees.
constexpr int kAround = 36, kAllOver = 384;
/// How many of the planes tried are fitted.
constexpr Index kFitted = 4;
constexpr int kFitSteps = 12;

struct Plane {
  Vec3 point, normal;

  Vec3 image(const Vec3& p) const { return p - 2 * normal.dot(p - point) * normal; }
  Vec3 turned(const Vec3& direction) const {
    return direction - 2 * normal.dot(direction) * normal;
  }
};

/// The axes of a symmetric matrix by increasing eigenvalue (Jacobi 1846): sums, products and roots
/// alone, so the same bits everywhere.
struct Axes {
  std::array<double, 3> values;
  std::array<Vec3, 3> vectors;
};

Axes axes_of(Mat3 m) {
  Mat3 vectors = Mat3::Identity();
  constexpr int kSweeps = 12;  // it converges quadratically: half as many are enough
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (const auto& [p, q] : {std::pair(0, 1), std::pair(0, 2), std::pair(1, 2)}) {
      if (m(p, q) == 0) continue;
      const double ratio = (m(q, q) - m(p, p)) / (2 * m(p, q));
      const double t = (ratio >= 0 ? 1 : -1) / (std::abs(ratio) + std::sqrt(1 + ratio * ratio));
      const double c = 1 / std::sqrt(1 + t * t), s = t * c;
      Mat3 turn = Mat3::Identity();
      turn(p, p) = turn(q, q) = c;
      turn(p, q) = s;
      turn(q, p) = -s;
      m = (turn.transpose() * m * turn).eval();
      vectors = (vectors * turn).eval();
    }
  }
  std::array<int, 3> order = {0, 1, 2};
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return m(a, a) != m(b, b) ? m(a, a) < m(b, b) : a < b; });
  Axes axes;
  for (int i = 0; i < 3; ++i) {
    axes.values[i] = m(order[i], order[i]);
    axes.vectors[i] = vectors.col(order[i]);
    axes.vectors[i] /= axes.vectors[i].norm();
  }
  return axes;
}

/// A point of the surface and the direction that it faces.
struct Sample {
  Vec3 point, normal;
};

struct Shape {
  double area = 0;
  Vec3 centre = Vec3::Zero();
  Axes axes;
  std::vector<Sample> samples;  ///< of equal areas, in the order of the faces
};

/// Places in a triangle that fill it evenly (Roberts 2018, R2).
Vec3 place_in_triangle(Index i, const Vec3& a, const Vec3& b, const Vec3& c) {
  const auto part = [](double x) { return x - std::floor(x); };
  double s = part(0.5 + 0.7548776662466927 * i), t = part(0.5 + 0.5698402909980532 * i);
  if (s + t > 1) s = 1 - s, t = 1 - t;
  return a + s * (b - a) + t * (c - a);
}

Shape shape_of(const Surface& surface) {
  Shape shape;
  PollSometimes poll;
  const auto corners = [&](Index f) {
    const auto [a, b, c] = surface.faces[f];
    return std::array<Vec3, 3>{surface.positions[a], surface.positions[b], surface.positions[c]};
  };
  const auto twice_normal = [](const std::array<Vec3, 3>& p) {
    return Vec3((p[1] - p[0]).cross(p[2] - p[0]));
  };
  const Vec3 origin = surface.positions[surface.faces[0][0]];  // near, against rounding
  Vec3 first = Vec3::Zero();
  for (Index f = 0; f < surface.face_count(); ++f) {
    poll();
    const auto p = corners(f);
    const double area = twice_normal(p).norm() / 2;
    shape.area += area;
    first += area / 3 * ((p[0] - origin) + (p[1] - origin) + (p[2] - origin));
  }
  if (!(shape.area > 0)) return shape;
  shape.centre = origin + first / shape.area;
  Mat3 second = Mat3::Zero();
  double before = 0;
  for (Index f = 0; f < surface.face_count(); ++f) {
    poll();
    auto p = corners(f);
    const Vec3 normal = twice_normal(p);
    const double area = normal.norm() / 2, after = before + area;
    while (area > 0 && size_of(shape.samples) < kSamples &&
           (size_of(shape.samples) + 0.5) * shape.area <= after * kSamples) {
      shape.samples.push_back(
          {place_in_triangle(size_of(shape.samples), p[0], p[1], p[2]), normal / (2 * area)});
    }
    before = after;
    for (Vec3& q : p) q -= shape.centre;
    const Vec3 sum = p[0] + p[1] + p[2];
    second += area / 12 *
              (sum * sum.transpose() + p[0] * p[0].transpose() + p[1] * p[1].transpose() +
               p[2] * p[2].transpose());
  }
  shape.axes = axes_of(second);
  return shape;
}

/// Normals of planes to be tried, the shortest axis first.
std::vector<Vec3> normals_to_try(const Axes& axes) {
  std::vector<Vec3> normals(axes.vectors.begin(), axes.vectors.end());
  const auto is_near = [&](int i) {
    return axes.values[i + 1] - axes.values[i] < kDistinct * axes.values[i + 1];
  };
  if (is_near(0) && is_near(1)) {
    const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
    for (int i = 0; i < kAllOver; ++i) {
      const double z = (i + 0.5) / kAllOver, radius = std::sqrt(1 - z * z);
      normals.push_back(radius * portable::cos(golden * i) * axes.vectors[0] +
                        radius * portable::sin(golden * i) * axes.vectors[1] + z * axes.vectors[2]);
    }
    return normals;
  }
  for (int i = 0; i < 2; ++i) {
    if (!is_near(i)) continue;
    for (int k = 1; k < kAround; ++k) {
      const double angle = std::numbers::pi * k / kAround;
      normals.push_back(portable::cos(angle) * axes.vectors[i] +
                        portable::sin(angle) * axes.vectors[i + 1]);
    }
  }
  return normals;
}

/// The plane that takes points nearest to their partners, by least squares.
class PlaneFit {
 public:
  void add(const Vec3& one, const Vec3& other) { pairs_.emplace_back(one, other); }
  Index count() const { return size_of(pairs_); }
  /// Precondition: some pairs.
  Plane plane() const {
    Vec3 middle = Vec3::Zero();
    for (const auto& [one, other] : pairs_) middle += one + other;
    middle /= 2.0 * static_cast<double>(pairs_.size());
    Mat3 products = Mat3::Zero();
    for (const auto& [one, other] : pairs_) {
      const Mat3 product = (one - middle) * (other - middle).transpose();
      products += product + product.transpose();
    }
    return {middle, axes_of(products).vectors[0]};
  }

 private:
  std::vector<std::pair<Vec3, Vec3>> pairs_;
};

/// How well a plane mirrors the surface.
struct Fit {
  Plane plane;
  double share = 0;         ///< of the samples: within the tolerance
  double mean = kInfinity;  ///< of the distances, those cut off that are far
};

class Matching {
 public:
  Matching(const Surface& surface, const Shape& shape, double tolerance)
      : surface_(surface),
        shape_(shape),
        tolerance_(tolerance),
        far_(std::max(0.1 * std::sqrt(shape.area), 2 * tolerance)),
        closest_(surface.positions, surface.faces) {}

  Fit judge(const Plane& plane, Index every) const {
    Fit fit{plane, 0, 0};
    Index count = 0;
    for (Index i = every / 2; i < kSamples && i < size_of(shape_.samples); i += every) {
      poll_interrupt();
      const double distance = std::min(far_, find(plane, shape_.samples[i], kNone).distance);
      ++count;
      fit.mean += distance;
      if (distance <= tolerance_) fit.share += 1;
    }
    fit.share /= std::max(count, 1);
    fit.mean /= std::max(count, 1);
    return fit;
  }

  /// Fits the plane to the points that it mirrors near to the surface, nearer from step to step.
  Plane fitted(Plane plane) const {
    std::vector<Index> seeds(shape_.samples.size(), kNone);
    double near = far_;
    for (int step = 0; step < kFitSteps; ++step) {
      PlaneFit fit;
      for (Index i = 0; i < size_of(shape_.samples); i += kEvery) {
        poll_interrupt();
        const Found found = find(plane, shape_.samples[i], seeds[i]);
        seeds[i] = found.face;
        if (found.distance <= near) fit.add(shape_.samples[i].point, found.point);
      }
      if (4 * kEvery * fit.count() < size_of(shape_.samples)) break;  // too few to tell
      plane = fit.plane();
      near = std::max(0.7 * near, 2 * tolerance_);
    }
    return plane;
  }

  /// The vertex that a vertex is mirrored to.
  Index image(const Plane& plane, Index vertex) const {
    Vec3 normal = Vec3::Zero();
    if (surface_.outgoing[vertex] == kNone) return kNone;
    surface_.for_each_outgoing(vertex, [&](Index h) {
      const auto [a, b, c] = surface_.faces[h / 3];
      const Vec3& p = surface_.positions[a];
      normal += (surface_.positions[b] - p).cross(surface_.positions[c] - p);
    });
    if (normal.isZero(0)) return kNone;
    const Sample sample{surface_.positions[vertex], normal};
    const Found found = find(plane, sample, kNone);
    const Vec3 mirrored = plane.image(sample.point);
    Index best = kNone;
    double least = kInfinity;
    for (const Index v : surface_.faces[found.face]) {
      const double distance_sq = (surface_.positions[v] - mirrored).squaredNorm();
      if (distance_sq < least) {
        least = distance_sq;
        best = v;
      }
    }
    return best;
  }

 private:
  struct Found {
    Index face = kNone;
    Vec3 point;
    double distance = kInfinity;  ///< infinite where no face is turned like the mirrored one
  };

  Found find(const Plane& plane, const Sample& sample, Index seed) const {
    const Vec3 point = plane.image(sample.point), normal = plane.turned(sample.normal);
    const SurfacePoint on = closest_.find(point, normal, seed);
    const auto [a, b, c] = surface_.faces[on.face];
    const Vec3 &p = surface_.positions[a], &q = surface_.positions[b], &r = surface_.positions[c];
    const bool is_alike = (q - p).cross(r - p).dot(normal) > 0;
    return {on.face, on.barycentric[0] * p + on.barycentric[1] * q + on.barycentric[2] * r,
            is_alike ? std::sqrt(on.distance_sq) : kInfinity};
  }

  const Surface& surface_;
  const Shape& shape_;
  double tolerance_, far_;
  ClosestPoint closest_;
};

/// Whether a fit is better than one that was tried before it: exact symmetries differ by rounding.
bool is_better(const Fit& fit, const Fit& than, double tolerance) {
  if (std::abs(fit.share - than.share) > 0.01) return fit.share > than.share;
  return fit.mean < than.mean - 0.02 * tolerance;
}

Fit best_plane(const Shape& shape, const Matching& matching, double tolerance, const Work& work) {
  const std::vector<Vec3> normals = normals_to_try(shape.axes);
  std::vector<Fit> tried(normals.size());
  parallel_for(work, size_of(tried), 1, [&](std::int64_t i, std::int64_t) {
    tried[i] = matching.judge({shape.centre, normals[i]}, kFirstEvery);
  });
  std::stable_sort(tried.begin(), tried.end(),
                   [](const Fit& a, const Fit& b) { return a.mean < b.mean; });
  tried.resize(std::min<std::size_t>(tried.size(), kFitted));
  parallel_for(work, size_of(tried), 1, [&](std::int64_t i, std::int64_t) {
    const Fit as_is = matching.judge(tried[i].plane, 1);
    const Fit fitted = matching.judge(matching.fitted(tried[i].plane), 1);
    tried[i] = is_better(fitted, as_is, tolerance) ? fitted : as_is;
  });
  // Of those that fit alike the one across the shortest axis.
  const auto rank = [&](const Fit& fit) { return std::abs(fit.plane.normal.dot(normals[0])); };
  std::stable_sort(tried.begin(), tried.end(),
                   [&](const Fit& a, const Fit& b) { return rank(a) > rank(b); });
  Fit best = tried[0];
  for (const Fit& fit : tried) {
    if (is_better(fit, best, tolerance)) best = fit;
  }
  return best;
}

std::vector<Index> images(const Surface& surface, const Matching& matching, const Plane& plane,
                          const Work& work) {
  constexpr std::int64_t kGrain = 1024;
  std::vector<Index> image(surface.positions.size());
  parallel_for(work, size_of(image), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (auto v = static_cast<Index>(begin); v < end; ++v) image[v] = matching.image(plane, v);
  });
  return image;
}

/// The plane between vertices that are each other's images: exact where the mesh is symmetric
/// itself.
Plane between_pairs(const Surface& surface, const std::vector<Index>& image, const Plane& plane) {
  PlaneFit fit;
  PollSometimes poll;
  for (Index v = 0; v < surface.vertex_count(); ++v) {
    poll();
    if (image[v] == kNone || image[image[v]] != v) continue;
    fit.add(surface.positions[v], surface.positions[image[v]]);
  }
  return 2 * fit.count() > surface.vertex_count() ? fit.plane() : plane;
}

/// Whether a vertex has a partner of its own beyond the plane, however near it is.
bool is_one_of_a_pair(const Surface& surface, const Plane& plane, const std::vector<Index>& image,
                      Index vertex) {
  const Index other = image[vertex];
  if (other == kNone || other == vertex || image[other] != vertex) return false;
  const Vec3& p = surface.positions[vertex];
  const double off = (plane.image(p) - surface.positions[other]).norm();
  return off < std::abs(plane.normal.dot(p - plane.point)) / 2;
}

/// How near the plane is where it cannot be told from it: less than half an edge, so that the ends
/// of an edge that crosses it at right angles are beside it.
double near_by_edges(const Surface& surface, Index vertex) {
  constexpr double kNearEdges = 0.4;
  double sum = 0;
  Index count = 0;
  if (surface.outgoing[vertex] != kNone) {
    surface.for_each_outgoing(vertex, [&](Index h) {
      sum += (surface.positions[surface.target(h)] - surface.positions[vertex]).norm();
      ++count;
    });
  }
  return kNearEdges * sum / std::max(count, 1);
}

std::vector<std::int8_t> sides(const Surface& surface, const Plane& plane,
                               const std::vector<Index>& image, double tolerance) {
  std::vector<std::int8_t> side(surface.positions.size(), 0);
  PollSometimes poll;
  for (Index v = 0; v < surface.vertex_count(); ++v) {
    poll();
    const double height = plane.normal.dot(surface.positions[v] - plane.point);
    const double near = std::min(tolerance, near_by_edges(surface, v));
    if (std::abs(height) > near || is_one_of_a_pair(surface, plane, image, v)) {
      side[v] = height > 0 ? 1 : -1;
    }
  }
  return side;
}

}  // namespace

std::optional<Mirror> find_mirror(const Surface& surface, double tolerance, const Work& work) {
  const Shape shape = shape_of(surface);
  if (!(shape.area > 0)) return {};
  tolerance *= std::sqrt(shape.area);
  const Matching matching(surface, shape, tolerance);
  Fit best = best_plane(shape, matching, tolerance, work);
  if (best.share < kMirroredShare) return {};
  std::vector<Index> image = images(surface, matching, best.plane, work);
  const Fit exact = matching.judge(between_pairs(surface, image, best.plane), 1);
  if (exact.share >= best.share && exact.mean <= best.mean) {
    best = exact;
    image = images(surface, matching, best.plane, work);
  }
  Mirror mirror;
  mirror.point = best.plane.point;
  mirror.normal = best.plane.normal;
  mirror.share = best.share;
  mirror.side = sides(surface, best.plane, image, tolerance);
  mirror.image = std::move(image);
  return mirror;
}

void weigh_mirror(const Surface& surface, const Mirror& mirror, double factor,
                  std::vector<double>& costs, const Work& work) {
  constexpr std::int64_t kGrain = 16384;
  const auto height = [&](Index v) {
    return std::abs(mirror.normal.dot(surface.positions[v] - mirror.point));
  };
  std::vector<char> is_near(surface.positions.size());  // no bits: they are written side by side
  parallel_for(work, size_of(is_near), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (auto v = static_cast<Index>(begin); v < end; ++v) {
      is_near[v] = height(v) <= near_by_edges(surface, v) ? 1 : 0;
    }
  });
  parallel_for(work, size_of(costs), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (auto h = static_cast<Index>(begin); h < end; ++h) {
      const Index a = surface.origin(h), b = surface.target(h);
      if (is_near[a] == 0 || is_near[b] == 0) continue;
      const Vec3 along = surface.positions[b] - surface.positions[a];
      // Not across: within 30 degrees of the plane.
      if (2 * std::abs(mirror.normal.dot(along)) <= along.norm()) costs[h] *= factor;
    }
  });
}

}  // namespace beltrami
