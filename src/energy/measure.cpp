#include "energy/measure.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "base/interrupt.h"
#include "base/parallel.h"
#include "base/portable_math.h"

namespace beltrami {
namespace {

constexpr std::int64_t kGrain = 8192;

constexpr double kTopShare = 0.01;  // of the area, beyond the percentile

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// The exponent of a size if its fourth power, or the inverse of that, is near the ends of the
/// range of numbers; else 0: then nothing needs to be scaled.
int unit_of(double size) {
  if (size >= 0x1p-200 && size < 0x1p201) return 0;
  return size > 0 && std::isfinite(size) ? std::ilogb(size) : 0;
}

/// x * 2^exponent, which is nearly always x.
double times_power(double x, int exponent) {
  return exponent == 0 ? x : std::ldexp(x, exponent);
}

/// Times a power of two that need not be a double itself.
template <class Vector>
void scale(Vector& v, int exponent) {
  const int half = exponent / 2;
  v = v * std::ldexp(1.0, half) * std::ldexp(1.0, exponent - half);
}

/// Edge k runs from corner k to corner k + 1, in units of 2^unit: so no product leaves the range of
/// numbers, and the bits are the same in any unit that is a power of two.
template <class Vector>
struct Edges {
  std::array<Vector, 3> edge;
  int unit = 0;

  explicit Edges(std::array<Vector, 3> p) {
    constexpr int kBack = 64;  // from where a difference would overflow
    const auto greatest = [](const std::array<Vector, 3>& v) {
      return std::max(
          {v[0].cwiseAbs().maxCoeff(), v[1].cwiseAbs().maxCoeff(), v[2].cwiseAbs().maxCoeff()});
    };
    if (greatest(p) > 0x1p1000) {
      for (Vector& v : p) scale(v, -kBack);
      unit = kBack;
    }
    for (int k = 0; k < 3; ++k) edge[k] = p[next_corner(k)] - p[k];
    const int by = unit_of(greatest(edge));
    if (by == 0) return;
    for (Vector& v : edge) scale(v, -by);
    unit += by;
  }
};

/// The distortion of a face, its area in units of 2^(2 unit).
FaceDistortion measure(const std::array<Vec3, 3>& p, const std::array<Vec2, 3>& w, int unit) {
  const Edges<Vec3> space(p);
  const Edges<Vec2> plane(w);
  // The longest edge as x axis keeps the height of slivers accurate.
  int k = 0;
  for (int i = 1; i < 3; ++i) {
    if (space.edge[i].squaredNorm() > space.edge[k].squaredNorm()) k = i;
  }
  const Vec3 e1 = space.edge[k], e2 = -space.edge[previous_corner(k)];
  const double length = e1.norm();
  const double height = e1.cross(e2).norm() / length;
  const double along = e1.dot(e2) / length;
  const double area = 0.5 * length * height;
  if (!(area > 0)) return {0, kNaN, kNaN, kNaN, kNaN};
  const Vec2 du = plane.edge[k] / length;
  const Vec2 dv = (-plane.edge[previous_corner(k)] - along * du) / height;
  const double det = du.x() * dv.y() - du.y() * dv.x();
  const double a = 0.5 * portable::hypot(du.x() + dv.y(), du.y() - dv.x());
  const double b = 0.5 * portable::hypot(du.x() - dv.y(), du.y() + dv.x());
  const double sum = a + b;
  // a - b would cancel on stretched faces; the quotient may round to more than the greater one.
  const double quotient = sum > 0 ? std::clamp(det / sum, -sum, sum) : 0;
  const double s1 = times_power(sum, plane.unit - space.unit),
               s2 = times_power(quotient, plane.unit - space.unit);
  FaceDistortion result{times_power(area, 2 * (space.unit - unit)), s1, s2, kInfinity, kInfinity};
  if (!(det > 0)) return result;
  const double energy = 0.5 * (s1 * s1 + s2 * s2 + 1 / (s1 * s1) + 1 / (s2 * s2));
  if (!std::isfinite(energy)) return result;
  result.symmetric_dirichlet = energy;
  result.symmetric_arap = (s1 - 1) * (s1 - 1) + (1 / s2 - 1) * (1 / s2 - 1);
  return result;
}

bool is_worse(const WeighedEnergy& a, const WeighedEnergy& b) {
  return std::tie(a.energy, a.area) > std::tie(b.energy, b.area);
}

/// The worst faces, the worst first: at least those with more than so much area, or all.
std::vector<WeighedEnergy> worst_of(std::vector<WeighedEnergy> faces, double area) {
  constexpr std::size_t kAtFirst = 64, kTimes = 4;  // any will do
  PollSometimes poll;
  const auto before = [&](const WeighedEnergy& a, const WeighedEnergy& b) {
    poll();
    return is_worse(a, b);
  };
  std::size_t sorted = 0;
  double reached = 0;
  for (std::size_t most = faces.size() / kAtFirst + kAtFirst;
       sorted < faces.size() && reached <= area; most *= kTimes) {
    const auto begin = faces.begin() + static_cast<std::ptrdiff_t>(sorted);
    const auto end = faces.begin() + static_cast<std::ptrdiff_t>(std::min(most, faces.size()));
    std::nth_element(begin, end, faces.end(), before);
    std::sort(begin, end, before);
    for (auto face = begin; face != end; ++face) reached += face->area;
    sorted = static_cast<std::size_t>(end - faces.begin());
  }
  faces.resize(sorted);
  return faces;
}

}  // namespace

FaceDistortion measure_face(const std::array<Vec3, 3>& p, const std::array<Vec2, 3>& w) {
  return measure(p, w, 0);
}

EnergySummary summarise(const std::vector<WeighedEnergy>& faces) {
  EnergySummary summary{kNaN, kNaN, kNaN, 0, kNaN, kNaN};
  double area = 0, sum = 0;
  for (const WeighedEnergy& face : faces) {
    area += face.area;
    sum += face.area * face.energy;
  }
  if (!(area > 0)) return summary;
  const std::vector<WeighedEnergy> worst = worst_of(faces, 2 * kTopShare * area);
  summary.mean = summary.mean_of_all = sum / area;
  summary.max_of_all = worst.front().energy;
  std::size_t first = 0;  // that has a say
  double beyond = 0;
  while (first + 1 < worst.size() && beyond + worst[first].area < kSliverShare * area) {
    beyond += worst[first++].area;
  }
  summary.slivers = static_cast<Index>(first);
  if (first > 0) {
    // In the order of the faces: that of the list behind the worst is the library's of C++.
    const WeighedEnergy& last = worst[first - 1];
    std::size_t alike = 0;  // slivers that are as bad as the last one
    while (alike < first && !is_worse(worst[first - 1 - alike], last)) ++alike;
    area = sum = 0;
    for (const WeighedEnergy& face : faces) {
      if (is_worse(face, last)) continue;
      if (alike > 0 && !is_worse(last, face)) {
        --alike;
        continue;
      }
      area += face.area;
      sum += face.area * face.energy;
    }
    summary.mean = sum / area;
  }
  summary.max = worst[first].energy;
  beyond = 0;
  for (std::size_t f = first; f < worst.size() && std::isnan(summary.p99); ++f) {
    beyond += worst[f].area;
    if (beyond > kTopShare * area) summary.p99 = worst[f].energy;
  }
  return summary;
}

Distortion measure_distortion(const std::vector<Vec3>& positions,
                              const std::vector<Triangle>& faces, const std::vector<Vec2>& uvs,
                              double* face_energies, const Work& work) {
  struct Partial {
    double area = 0;
    Distortion sum;
  };
  std::vector<double> sizes(positions.size() / kGrain + 1, 0);
  parallel_for(work, size_of(positions), kGrain, [&](std::int64_t begin, std::int64_t end) {
    double size = 0;
    for (std::int64_t v = begin; v < end; ++v) {
      size = std::max(size, positions[v].cwiseAbs().maxCoeff());
    }
    sizes[begin / kGrain] = size;
  });
  const int unit = unit_of(*std::max_element(
      sizes.begin(), sizes.end()));  // in which areas are neither too small nor too great to add
  std::vector<Partial> partials(faces.size() / kGrain + 1);
  parallel_for(work, size_of(faces), kGrain, [&](std::int64_t begin, std::int64_t end) {
    Partial& part = partials[begin / kGrain];
    for (std::int64_t f = begin; f < end; ++f) {
      const Triangle& t = faces[f];
      const FaceDistortion d = measure({positions[t[0]], positions[t[1]], positions[t[2]]},
                                       {uvs[t[0]], uvs[t[1]], uvs[t[2]]}, unit);
      const bool counts = std::isfinite(d.symmetric_dirichlet);
      if (face_energies) face_energies[f] = counts ? d.symmetric_dirichlet : kInfinity;
      if (!counts) {
        ++part.sum.left_out;
        continue;
      }
      part.area += d.area;
      part.sum.symmetric_dirichlet += d.area * d.symmetric_dirichlet;
      part.sum.symmetric_arap += d.area * d.symmetric_arap;
      if (d.symmetric_dirichlet > part.sum.max) {
        part.sum.max = d.symmetric_dirichlet;
        part.sum.worst_face = static_cast<Index>(f);
      }
    }
  });
  Distortion total;
  double area = 0;
  for (const Partial& part : partials) {
    area += part.area;
    total.symmetric_dirichlet += part.sum.symmetric_dirichlet;
    total.symmetric_arap += part.sum.symmetric_arap;
    total.left_out += part.sum.left_out;
    if (part.sum.max > total.max) {
      total.max = part.sum.max;
      total.worst_face = part.sum.worst_face;
    }
  }
  total.symmetric_dirichlet = area > 0 ? total.symmetric_dirichlet / area : kNaN;
  total.symmetric_arap = area > 0 ? total.symmetric_arap / area : kNaN;
  return total;
}

}  // namespace beltrami
