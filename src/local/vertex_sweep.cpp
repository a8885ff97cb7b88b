#include "local/vertex_sweep.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "base/interrupt.h"
#include "descend/line_search.h"
#include "energy/density.h"
#include "mesh/hub.h"

namespace beltrami {
namespace {

constexpr int kMostTrials = 9;    // of a step of one vertex: there will be another sweep
constexpr double kLittle = 1e-7;  // of the energy of its faces: less is not worth a move
constexpr double kFlat = 1e-6;    // eigenvalues of the Hessian, of the other one

double det_of(const LinearMap& map) {
  return std::norm(map.fz) - std::norm(map.fzbar);
}

/// A face as a function of where one of its corners goes, by p from where that is: the derivatives
/// become fz + p conj(G) / 2 and fzbar + p G / 2, with the hat gradient G of the corner.
struct FaceAtVertex {
  RestTriangle rest;
  LinearMap map;
  Complex hat;

  /// The gradients by p of s1^2 + s2^2 and s1 s2. The former's Hessian is 2 |G|^2.
  Complex norm_slope() const { return 2.0 * (map.fz * hat + map.fzbar * std::conj(hat)); }
  Complex det_slope() const { return map.fz * hat - map.fzbar * std::conj(hat); }
};

/// Energy, gradient and Hessian of some faces by p.
struct LocalModel {
  double energy = 0;
  Complex gradient = 0;
  double xx = 0, xy = 0, yy = 0;

  template <class Density>
  void add(const FaceAtVertex& face) {
    const double area = face.rest.area();
    const DensitySlopes slopes = Density::slopes(face.map);
    const double norm = 2 * (std::norm(face.map.fz) + std::norm(face.map.fzbar));
    const DensityBends bends = Density::bends(norm, det_of(face.map));
    const double by_norm = 0.125 * (slopes.by_fz + slopes.by_fzbar);
    const double by_det = 0.25 * (slopes.by_fz - slopes.by_fzbar);
    const Complex n = face.norm_slope(), d = face.det_slope();
    energy += area * slopes.value;
    gradient += area * (by_norm * n + by_det * d);
    const Complex along_n = bends.norm_norm * n + bends.norm_det * d;
    const Complex along_d = bends.norm_det * n + bends.det_det * d;
    const double even = 2 * by_norm * std::norm(face.hat);
    xx += area * (even + along_n.real() * n.real() + along_d.real() * d.real());
    xy += area * (along_n.real() * n.imag() + along_d.real() * d.imag());
    yy += area * (even + along_n.imag() * n.imag() + along_d.imag() * d.imag());
  }

  /// Newton's step; where the model is not convex, one along the gradient.
  Complex step() const {
    const double mean = 0.5 * (xx + yy);
    const double spread = std::sqrt(0.25 * (xx - yy) * (xx - yy) + xy * xy);
    const double least = mean - spread, most = std::max(mean + spread, spread - mean);
    if (!(least > kFlat * most)) return -gradient / most;
    const double det = xx * yy - xy * xy;
    return Complex(xy * gradient.imag() - yy * gradient.real(),
                   xy * gradient.real() - xx * gradient.imag()) /
           det;
  }
};

template <class Density>
class VertexSweep {
 public:
  VertexSweep(const DiskMesh& mesh, const std::vector<RestTriangle>& rest, std::vector<Vec2>& uvs)
      : mesh_(mesh), rest_(rest), uvs_(uvs) {}

  /// Moves a vertex that is inside and no hub.
  void move(Index v) {
    if (mesh_.on_boundary[v] || is_hub(mesh_, v, kLargeHubFaces)) return;
    corners_.clear();
    const Index first = mesh_.outgoing[v];
    Index h = first;
    do {
      corners_.push_back(h);
      h = mesh_.rotate(h);
    } while (h != first);
    move_inside(v);
  }

 private:
  void move_inside(Index v) {
    LocalModel model;
    double singular = std::numeric_limits<double>::infinity();
    faces_.clear();
    for (const Index corner : corners_) {
      const RestTriangle& rest = rest_[corner / 3];
      const FaceAtVertex face{rest, map_of(corner / 3), rest.hat_gradient(corner % 3)};
      if (!(det_of(face.map) > 0)) return;
      model.add<Density>(face);
      faces_.push_back(face);
    }
    const Complex step = model.step();
    const double slope = dot(model.gradient, step);
    if (!(-slope > kLittle * model.energy)) return;
    for (const FaceAtVertex& face : faces_) {
      const double change = dot(face.det_slope(), step);
      if (change < 0) singular = std::min(singular, -det_of(face.map) / change);
    }
    const Vec2 before = uvs_[v];
    double length = std::min(1.0, kSingularShare * singular);
    const auto takes_step = [&](double share) {
      uvs_[v] = before + share * Vec2(step.real(), step.imag());
      return falls_enough(model.energy, energy_here(), share, slope);
    };
    if (!backtrack(length, takes_step, kMostTrials)) uvs_[v] = before;
  }

  /// Of the places as they are rounded, as all others see them.
  double energy_here() const {
    double sum = 0;
    for (const Index corner : corners_) {
      const LinearMap map = map_of(corner / 3);
      if (!(det_of(map) > 0)) return std::numeric_limits<double>::infinity();
      sum += rest_[corner / 3].area() * Density::slopes(map).value;
    }
    return sum;
  }

  LinearMap map_of(Index face) const {
    const Triangle& t = mesh_.faces[face];
    return linear_map(rest_[face], uvs_[t[0]], uvs_[t[1]], uvs_[t[2]]);
  }

  static double dot(Complex a, Complex b) { return a.real() * b.real() + a.imag() * b.imag(); }

  const DiskMesh& mesh_;
  const std::vector<RestTriangle>& rest_;
  std::vector<Vec2>& uvs_;
  std::vector<Index> corners_;  ///< at the vertex, as the half-edges that leave it there
  std::vector<FaceAtVertex> faces_;
};

}  // namespace

void sweep_vertices(Energy energy, const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                    std::vector<Vec2>& uvs, const std::vector<Index>& vertices) {
  with_density(energy, [&]<class Density>(Density) {
    VertexSweep<Density> sweep(mesh, rest, uvs);
    PollSometimes poll;
    for (const Index v : vertices) {
      poll();
      sweep.move(v);
    }
  });
}

}  // namespace beltrami
