#include "cut/visibility.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include "base/interrupt.h"
#include "base/parallel.h"
#include "base/portable_math.h"
#include "base/types.h"
#include "base/vectors.h"

namespace beltrami {
namespace {

/// Each axis is looked along from both of its ends. With these many, and these many pixels along a
/// side of the buffers, what is found is off by 0.02 on average; more axes or pixels take as much
/// longer and halve that at best, with half the pixels what is thin hides nothing.
constexpr int kAxes = 24;
constexpr int kPixels = 128;

/// How far points are lifted off the surface, in pixels: on a plane at any angle, the depth of a
/// pixel is that of a place up to 0.71 pixels away, which the lift has to outdo.
constexpr double kLift = 1.25;

/// How far along an axis there is surface in each pixel.
struct DepthBuffer {
  std::vector<float> low = std::vector<float>(kPixels * kPixels);
  std::vector<float> high = std::vector<float>(kPixels * kPixels);

  void clear() {
    std::fill(low.begin(), low.end(), std::numeric_limits<float>::infinity());
    std::fill(high.begin(), high.end(), -std::numeric_limits<float>::infinity());
  }
  /// The number of a pixel; kNone outside.
  static Index at(float x, float y) {
    if (!(x >= 0 && y >= 0 && x < kPixels && y < kPixels)) return kNone;
    return static_cast<Index>(y) * kPixels + static_cast<Index>(x);
  }
  void draw(const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c);
};

/// Numbers of pixels.
struct Span {
  float from, to;

  /// Keeps those x where slope * x >= least.
  void keep_where(float slope, float least) {
    if (slope > 0) {
      from = std::max(from, least / slope);
    } else if (slope < 0) {
      to = std::min(to, least / slope);
    } else if (least > 0) {
      to = from - 1;
    }
  }
};

/// Sets the pixels whose centres the triangle covers. Precondition: it lies inside the buffer.
void DepthBuffer::draw(const Eigen::Vector3f& a, const Eigen::Vector3f& b,
                       const Eigen::Vector3f& c) {
  // Of the centres, at halves, the first one beyond a place inside the buffer, and the last before.
  const auto first = [](float x) { return static_cast<int>(x + 0.5F); };
  const auto last = [](float x) { return static_cast<int>(x + 0.5F) - 1; };
  const int left = first(std::min({a.x(), b.x(), c.x()}));
  const int right = last(std::max({a.x(), b.x(), c.x()}));
  const int bottom = first(std::min({a.y(), b.y(), c.y()}));
  const int top = last(std::max({a.y(), b.y(), c.y()}));
  if (left > right || bottom > top) return;
  const Eigen::Vector3f ab = b - a, ac = c - a;
  const float twice = ab.x() * ac.y() - ab.y() * ac.x();
  if (!(std::abs(twice) > 1e-6F)) return;  // seen edge-on
  // Barycentric coordinates of b and c, and their change from a pixel to the next.
  const float b_x = ac.y() / twice, b_y = -ac.x() / twice;
  const float c_x = -ab.y() / twice, c_y = ab.x() / twice;
  const float slope = b_x * ab.z() + c_x * ac.z();
  const float offset = 0.5F - a.x();  // of a pixel's centre from the corner, at its number 0
  for (int y = bottom; y <= top; ++y) {
    const float dy = static_cast<float>(y) + 0.5F - a.y();
    const float at_b = b_x * offset + b_y * dy, at_c = c_x * offset + c_y * dy;  // of the number 0
    Span span{static_cast<float>(left), static_cast<float>(right)};
    span.keep_where(b_x, -at_b);
    span.keep_where(c_x, -at_c);
    span.keep_where(-b_x - c_x, at_b + at_c - 1);
    if (span.from > span.to) continue;
    const int before = static_cast<int>(span.from), end = static_cast<int>(span.to) + 1;
    const int begin = before + (static_cast<float>(before) < span.from ? 1 : 0);
    const float depth = a.z() + at_b * ab.z() + at_c * ac.z();
    float* lows = low.data() + static_cast<std::ptrdiff_t>(y) * kPixels;
    float* highs = high.data() + static_cast<std::ptrdiff_t>(y) * kPixels;
    for (int x = begin; x < end; ++x) {
      const float here = depth + slope * static_cast<float>(x);
      lows[x] = std::min(lows[x], here);
      highs[x] = std::max(highs[x], here);
    }
  }
}

/// An axis with two others across it, right-handed.
struct View {
  Vec3 right, up, along;
};

/// Spread evenly over half a sphere, along a spiral of the golden angle (Swinbank & Purser 2006).
View view_of(int axis) {
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  const double z = (axis + 0.5) / kAxes, radius = std::sqrt(1 - z * z);
  View view;
  view.along = {radius * portable::cos(golden * axis), radius * portable::sin(golden * axis), z};
  view.right = view.along.cross(std::abs(z) < 0.5 ? Vec3(Vec3::UnitZ()) : Vec3(Vec3::UnitX()));
  view.right /= view.right.norm();
  view.up = view.along.cross(view.right);
  return view;
}

/// Where the buffers look: a ball around the surface.
struct Ball {
  Vec3 centre = Vec3::Zero();
  double radius = 0;

  double pixel() const { return 2 * radius / kPixels; }
};

Ball ball_around(const SurfaceSketch& sketch) {
  Ball ball;
  for (Index c = 0; c < sketch.cluster_count(); ++c) {
    ball.centre += sketch.areas[c] / sketch.area * sketch.positions[c];
  }
  for (const Vec3& p : sketch.positions) {
    ball.radius = std::max(ball.radius, (p - ball.centre).norm());
  }
  ball.radius *= 1 + 2.0 / kPixels;
  return ball;
}

/// What a cluster sees along one axis, on either side.
struct Sight {
  bool front = false, back = false;
};

/// The clusters as the buffers see them: in pixels, around the middle of the ball.
struct Points {
  std::vector<Eigen::Vector3f> places, lifts;

  Points(const SurfaceSketch& sketch, const Ball& ball) {
    for (Index c = 0; c < sketch.cluster_count(); ++c) {
      places.push_back(((sketch.positions[c] - ball.centre) / ball.pixel()).cast<float>());
      lifts.push_back((kLift * sketch.outwards(c)).cast<float>());
    }
  }
};

class Look {
 public:
  Look(const SurfaceSketch& sketch, const Points& points)
      : sketch_(sketch), points_(points), seen_(points.places.size()) {}

  /// Writes one for each cluster.
  void along(const View& view, Sight* sights) {
    buffer_.clear();
    Eigen::Matrix3f turn;
    turn << view.right.transpose().cast<float>(), view.up.transpose().cast<float>(),
        view.along.transpose().cast<float>();
    const Eigen::Vector3f middle(kPixels / 2.0F, kPixels / 2.0F, 0);
    for (Index c = 0; c < sketch_.cluster_count(); ++c) {
      seen_[c] = turn * points_.places[c] + middle;
    }
    for (const auto& [a, b, c] : sketch_.faces) {
      poll_();
      buffer_.draw(seen_[a], seen_[b], seen_[c]);
    }
    for (Index c = 0; c < sketch_.cluster_count(); ++c) {
      const Eigen::Vector3f lift = turn * points_.lifts[c];
      const bool is_up = lift.z() >= 0;
      sights[c].front = is_free(seen_[c] + lift, is_up);
      sights[c].back = sketch_.on_open_piece[c] && is_free(seen_[c] - lift, !is_up);
    }
  }

 private:
  bool is_free(const Eigen::Vector3f& point, bool upwards) const {
    const Index pixel = DepthBuffer::at(point.x(), point.y());
    if (pixel == kNone) return true;
    return upwards ? point.z() >= buffer_.high[pixel] : point.z() <= buffer_.low[pixel];
  }

  const SurfaceSketch& sketch_;
  const Points& points_;
  std::vector<Eigen::Vector3f> seen_;
  DepthBuffer buffer_;
  PollSometimes poll_;
};

}  // namespace

std::vector<double> visibility(const SurfaceSketch& sketch, const Work& work) {
  const Index count = sketch.cluster_count();
  std::vector<double> seen(count, 1);
  if (!(sketch.area > 0)) return seen;
  const Ball ball = ball_around(sketch);
  if (!(ball.radius > 0)) return seen;
  const Points points(sketch, ball);
  std::array<View, kAxes> views;
  for (int axis = 0; axis < kAxes; ++axis) views[axis] = view_of(axis);
  std::vector<Sight> sights(static_cast<std::size_t>(kAxes) * count);
  constexpr std::int64_t kAxesAtOnce = 4;  // with the memory of one
  parallel_for(work, kAxes, kAxesAtOnce, [&](std::int64_t begin, std::int64_t end) {
    Look look(sketch, points);
    for (std::int64_t axis = begin; axis < end; ++axis) {
      look.along(views[axis], sights.data() + axis * count);
    }
  });
  constexpr std::int64_t kGrain = 4096;
  parallel_for(work, count, kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t c = begin; c < end; ++c) {
      double front = 0, back = 0, all = 0;
      for (int axis = 0; axis < kAxes; ++axis) {
        const Sight sight = sights[static_cast<std::size_t>(axis) * count + c];
        const double weight = std::abs(sketch.normals[c].dot(views[axis].along));
        all += weight;
        if (sight.front) front += weight;
        if (sight.back) back += weight;
      }
      if (all > 0) seen[c] = std::max(front, back) / all;
    }
  });
  return seen;
}

}  // namespace beltrami
