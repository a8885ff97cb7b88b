#include "local/untangle.h"

#include <algorithm>
#include <cmath>

#include "base/portable_math.h"
#include "descend/newton.h"
#include "descend/newton_loop.h"
#include "descend/newton_step.h"
#include "energy/density.h"
#include "exact/certificate.h"

namespace beltrami {
namespace {

constexpr int kUntangleSteps = 100;
/// The regularisation, of the determinant of the worst face: with half as much steps are short, and
/// it takes two and a half times as many; with twice as much many patches end as they were.
constexpr double kSoftness = 0.4;
/// At least, so that the barrier of a nearly mended face does not overflow: with a tenth of it the
/// last steps only take that face's energy down, by a factor of 0.6 each. Faces can come to rest
/// flipped by little beside it: from the third step on after which the worst one is as bad it is
/// lowered with each. (Of 18,000 small patches that mends 37 more, and loses none; earlier or
/// faster it loses up to 400.)
constexpr double kLeastSoftness = 0.01, kLowered = 0.7;
constexpr int kAtRest = 3;
/// Steps after which the worst face is as bad as before, by this share: of 131 patches that were
/// untangled one took longer.
constexpr int kPatience = 15;
constexpr double kAsBad = 0.95;
constexpr int kPolishSteps = 5;  // what follows polishes too

/// 1/2 (s1^2 + s2^2) (1 + chi^-2) with chi = (d + sqrt(eps^2 + d^2)) / 2 for the determinant
/// d = s1 s2: for eps -> 0 the symmetric Dirichlet energy where d > 0 and a barrier elsewhere.
struct RegularisedDirichlet {
  static constexpr bool kBarrier = false;

  double epsilon = 1;

  double value(double s1, double s2) const {
    const double d = s1 * s2, x = chi(d, portable::hypot(epsilon, d));
    return 0.5 * (s1 * s1 + s2 * s2) * (1 + 1 / (x * x));
  }

  DensityModel model(double s1, double s2) const {
    const double d = s1 * s2, n = s1 * s1 + s2 * s2;
    const double root = portable::hypot(epsilon, d), x = chi(d, root);
    const double x1 = x / root, x2 = epsilon * epsilon / (2 * root * root * root);
    // g(d) = (1 + chi^-2) / 2, so that the density is n g(d).
    const double g = 0.5 * (1 + 1 / (x * x));
    const double g1 = -x1 / (x * x * x);
    const double g2 = (3 * x1 * x1 / x - x2) / (x * x * x);
    DensityModel m;
    m.value = n * g;
    m.d1 = 2 * s1 * g + n * g1 * s2;
    m.d2 = 2 * s2 * g + n * g1 * s1;
    m.h11 = 2 * g + 4 * d * g1 + n * g2 * s2 * s2;
    m.h22 = 2 * g + 4 * d * g1 + n * g2 * s1 * s1;
    m.h12 = 3 * n * g1 + n * g2 * d;
    project(m);
    m.twist = std::max(0.0, 2 * (2 * g + n * g1));
    m.flip = std::max(0.0, 2 * (2 * g - n * g1));
    return m;
  }

 private:
  /// `root`: of eps^2 + d^2. For negative d the sum would cancel.
  double chi(double d, double root) const {
    return d >= 0 ? 0.5 * (d + root) : 0.5 * epsilon * epsilon / (root - d);
  }

  /// Replaces the radial block by its nearest positive semi-definite one.
  static void project(DensityModel& m) {
    const double mean = 0.5 * (m.h11 + m.h22), half = 0.5 * (m.h11 - m.h22);
    const double radius = portable::hypot(half, m.h12);
    const double low = mean - radius, high = mean + radius;
    if (low >= 0) return;
    const double c = radius > 0 ? half / radius : 1, s = radius > 0 ? m.h12 / radius : 0;
    const double top = std::max(high, 0.0);  // top times the projector on its eigenvector
    m.h11 = 0.5 * top * (1 + c);
    m.h22 = 0.5 * top * (1 - c);
    m.h12 = 0.5 * top * s;
  }
};

double smallest_determinant(const std::vector<Triangle>& faces,
                            const std::vector<RestTriangle>& rest, const std::vector<Vec2>& uvs) {
  double least = std::numeric_limits<double>::infinity();
  for (Index f = 0; f < size_of(faces); ++f) {
    const LinearMap map = linear_map(rest[f], uvs[faces[f][0]], uvs[faces[f][1]], uvs[faces[f][2]]);
    least = std::min(least, std::norm(map.fz) - std::norm(map.fzbar));
  }
  return least;
}

}  // namespace

bool untangle(const std::vector<Triangle>& faces, const std::vector<RestTriangle>& rest,
              const std::vector<bool>& fixed, std::vector<Vec2>& uvs, const Work& work) {
  std::vector<Vec2> trial = uvs;
  NewtonStepper<RegularisedDirichlet> stepper(faces, rest, fixed, work);
  if (stepper.free_count() == 0) return false;
  double least = smallest_determinant(faces, rest, trial);
  double best = least;
  int best_at = 0;
  double least_softness = kLeastSoftness;
  for (int i = 0; i < kUntangleSteps && !(least > 0) && i < best_at + kPatience; ++i) {
    // Of the size of the worst face, as Garanzha et al. choose it.
    stepper.set_density({portable::hypot(least_softness, kSoftness * least)});
    const NewtonStep step = stepper.step(trial, stepper.mean_energy(trial));
    if (step.length == 0) break;
    least = smallest_determinant(faces, rest, trial);
    if (least < kAsBad * best) {
      const bool is_little = kSoftness * -least < least_softness;
      if (is_little && i + 1 >= best_at + kAtRest) least_softness *= kLowered;
      continue;
    }
    best = least;
    best_at = i + 1;
  }
  if (!(least > 0)) return false;
  NewtonOptions polish;
  polish.max_iterations = kPolishSteps;
  minimise_energy(faces, rest, fixed, trial, polish, work);
  if (!non_positive_faces(faces, trial, work).empty()) return false;
  uvs.swap(trial);
  return true;
}

}  // namespace beltrami
