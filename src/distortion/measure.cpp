#include "distortion/measure.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "base/portable_math.h"

namespace beltrami {
namespace {

constexpr std::int64_t kGrain = 8192;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

}  // namespace

FaceDistortion measure_face(const std::array<Vec3, 3>& p, const std::array<Vec2, 3>& w) {
  // The longest edge as x axis keeps the height of slivers accurate.
  int k = 0;
  for (int i = 1; i < 3; ++i) {
    if ((p[next_corner(i)] - p[i]).squaredNorm() > (p[next_corner(k)] - p[k]).squaredNorm()) k = i;
  }
  const int k1 = next_corner(k), k2 = previous_corner(k);
  const Vec3 e1 = p[k1] - p[k], e2 = p[k2] - p[k];
  const double length = e1.norm();
  const double height = e1.cross(e2).norm() / length;
  const double along = e1.dot(e2) / length;
  const double area = 0.5 * length * height;
  if (!(area > 0)) return {0, kNaN, kNaN, kNaN, kNaN};
  const Vec2 du = (w[k1] - w[k]) / length;
  const Vec2 dv = ((w[k2] - w[k]) - along * du) / height;
  const double det = du.x() * dv.y() - du.y() * dv.x();
  const double a = 0.5 * portable::hypot(du.x() + dv.y(), du.y() - dv.x());
  const double b = 0.5 * portable::hypot(du.x() - dv.y(), du.y() + dv.x());
  const double s1 = a + b;
  const double s2 = s1 > 0 ? det / s1 : 0;  // a - b would cancel on stretched faces
  FaceDistortion result{area, s1, s2, kInfinity, kInfinity};
  if (!(det > 0)) return result;
  const double energy = 0.5 * (s1 * s1 + s2 * s2 + 1 / (s1 * s1) + 1 / (s2 * s2));
  if (!std::isfinite(energy)) return result;
  result.symmetric_dirichlet = energy;
  result.symmetric_arap = (s1 - 1) * (s1 - 1) + (1 / s2 - 1) * (1 / s2 - 1);
  return result;
}

Distortion measure_distortion(const std::vector<Vec3>& positions,
                              const std::vector<Triangle>& faces, const std::vector<Vec2>& uvs,
                              int threads, double* face_energies) {
  struct Partial {
    double area = 0;
    Distortion sum;
  };
  std::vector<Partial> partials(faces.size() / kGrain + 1);
  parallel_for(threads, size_of(faces), kGrain, [&](std::int64_t begin, std::int64_t end) {
    Partial& part = partials[begin / kGrain];
    for (std::int64_t f = begin; f < end; ++f) {
      const Triangle& t = faces[f];
      const FaceDistortion d = measure_face({positions[t[0]], positions[t[1]], positions[t[2]]},
                                            {uvs[t[0]], uvs[t[1]], uvs[t[2]]});
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
