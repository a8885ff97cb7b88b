// One step of projected Newton over a set of faces, for any density.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "fullspace/assembly.h"
#include "fullspace/line_search.h"
#include "sparse/spd_solver.h"

namespace beltrami {

/// Energies are compared relative to their value, but not to less than this: the least symmetric
/// ARAP energy is 0.
inline constexpr double kLeastEnergy = 0.01;

/// What a decrease of the energy is compared with to tell convergence: the energy, shifted so that
/// an isometry counts 2 as it does for symmetric Dirichlet. All energies then end equally near
/// their minimum.
template <class Density>
constexpr double comparable_energy(double energy) {
  return energy + 2 - Density::kMinimum;
}

/// What a step did.
struct NewtonStep {
  double length = 0;     ///< share of the Newton step taken; 0: no representable decrease
  double energy = 0;     ///< mean energy after it
  double predicted = 0;  ///< -gradient . direction: twice the decrease of the quadratic model
};

/// Newton's method on the weighted mean of a density over `faces`: by rest area, or by `weights`,
/// one per face, divided by the sum of the first `counted` of them. A Density has value(s1, s2),
/// model(s1, s2) and `kBarrier`: whether it is infinite at s2 = 0, so that steps must stop short of
/// singular faces. Keeps references to `faces` and `rest`.
template <class Density>
class NewtonStepper {
 public:
  NewtonStepper(const std::vector<Triangle>& faces, const std::vector<RestTriangle>& rest,
                const std::vector<bool>& fixed, int threads, Density density = {})
      : NewtonStepper(faces, rest, area_weights(rest), size_of(faces), fixed, threads, density) {}

  NewtonStepper(const std::vector<Triangle>& faces, const std::vector<RestTriangle>& rest,
                std::vector<double> weights, Index counted, const std::vector<bool>& fixed,
                int threads, Density density = {})
      : faces_(faces),
        rest_(rest),
        weights_(std::move(weights)),
        threads_(threads),
        density_(density),
        hessian_(static_cast<Index>(fixed.size()), faces, fixed, 2, threads),
        solver_(make_spd_solver({Precision::kDouble, threads})) {
    double total = 0;
    for (Index f = 0; f < counted; ++f) total += weights_[f];
    for (double& w : weights_) w /= total;
  }

  Index free_count() const { return hessian_.free_count(); }
  void set_density(const Density& density) { density_ = density; }
  /// What a step must not break, besides the energy; anything goes by default.
  void set_accept(std::function<bool(const std::vector<Vec2>&)> accept) {
    accept_ = std::move(accept);
  }

  /// Infinite if a face is not positive under a barrier density.
  double mean_energy(const std::vector<Vec2>& uvs) const;

  /// Moves `uvs` along the Newton direction; `energy` is the mean energy of `uvs` as they come in.
  /// A step that is not accepted is halved further, like one that does not lower the energy.
  /// Where no shift makes the system definite there is no step, and no telling what it would gain.
  NewtonStep step(std::vector<Vec2>& uvs, double energy) {
    return step_with(density_, uvs, energy);
  }

  /// The same with the Hessian model of another density that has the same value and gradient.
  template <class Model>
  NewtonStep step_with(const Model& model, std::vector<Vec2>& uvs, double energy);

 private:
  static constexpr std::int64_t kGrain = 8192;
  static constexpr double kSingularShare = 0.8;  // of the way to the first singular face
  static constexpr double kArmijo = 1e-4;        // sufficient share of the predicted decrease
  static constexpr double kNoGain = 1e-14;       // relative predicted decrease within the roundoff
  static constexpr double kShift = 1e-13;        // of the diagonal: see factorize
  static constexpr double kLargestShift = 1e-3;
  static constexpr int kMaxHalvings = 40;

  static std::vector<double> area_weights(const std::vector<RestTriangle>& rest) {
    std::vector<double> weights(rest.size());
    for (std::size_t f = 0; f < rest.size(); ++f) weights[f] = rest[f].area();
    return weights;
  }
  bool factorize();

  const std::vector<Triangle>& faces_;
  const std::vector<RestTriangle>& rest_;
  std::vector<double> weights_;
  const int threads_;
  Density density_;
  MeshMatrix hessian_;
  std::unique_ptr<SpdSolver> solver_;
  bool analyzed_ = false;
  Eigen::VectorXd gradient_;
  std::function<bool(const std::vector<Vec2>&)> accept_;
};

template <class Density>
double NewtonStepper<Density>::mean_energy(const std::vector<Vec2>& uvs) const {
  const auto part = [&](std::int64_t begin, std::int64_t end) {
    double sum = 0;
    for (std::int64_t f = begin; f < end; ++f) {
      const Triangle& t = faces_[f];
      const SingularValues s =
          singular_values(linear_map(rest_[f], uvs[t[0]], uvs[t[1]], uvs[t[2]]));
      if (Density::kBarrier && !(s.s2 > 0)) return std::numeric_limits<double>::infinity();
      sum += weights_[f] * density_.value(s.s1, s.s2);
    }
    return sum;
  };
  return parallel_sum(threads_, size_of(faces_), kGrain, part);
}

/// The projected Hessian is definite once a vertex is fixed, but barely so along nearly free
/// motions; a shift relative to the diagonal covers the roundoff at any scale. False where none
/// does.
template <class Density>
bool NewtonStepper<Density>::factorize() {
  SparseMatrix& matrix = hessian_.matrix();
  const Eigen::VectorXd diagonal = matrix.diagonal();
  for (double shift = kShift; shift <= kLargestShift; shift *= 1e2) {
    for (Eigen::Index c = 0; c < matrix.cols(); ++c) {
      matrix.valuePtr()[matrix.outerIndexPtr()[c]] = diagonal[c] * (1 + shift);
    }
    if (solver_->factorize(matrix)) return true;
  }
  return false;
}

template <class Density>
template <class Model>
NewtonStep NewtonStepper<Density>::step_with(const Model& model, std::vector<Vec2>& uvs,
                                             double energy) {
  assemble(
      faces_, rest_, uvs, model, [&](Index f) { return weights_[f]; }, threads_, hessian_,
      gradient_);
  if (!analyzed_) solver_->analyze(hessian_.matrix(), hessian_.places(uvs));
  analyzed_ = true;
  NewtonStep result;
  result.energy = energy;
  if (!factorize()) {
    result.predicted = std::numeric_limits<double>::infinity();
    return result;
  }
  const Eigen::VectorXd flat = solver_->solve(-gradient_);
  result.predicted = -gradient_.dot(flat);
  if (!(result.predicted > kNoGain * std::max(energy, kLeastEnergy))) return result;

  std::vector<Vec2> direction(uvs.size(), Vec2::Zero());
  for (Index v = 0; v < size_of(uvs); ++v) {
    if (hessian_.row(v) != kNone) direction[v] = flat.segment<2>(2 * hessian_.row(v));
  }
  double length = 1;
  if (Density::kBarrier) {
    length =
        std::min(length, kSingularShare * first_singular_step(faces_, uvs, direction, threads_));
  }
  std::vector<Vec2> trial(uvs.size());
  for (int halving = 0; halving < kMaxHalvings; ++halving, length *= 0.5) {
    for (Index v = 0; v < size_of(uvs); ++v) trial[v] = uvs[v] + length * direction[v];
    const double trial_energy = mean_energy(trial);
    if (trial_energy < energy && trial_energy <= energy - kArmijo * length * result.predicted &&
        (!accept_ || accept_(trial))) {
      uvs.swap(trial);
      result.length = length;
      result.energy = trial_energy;
      break;
    }
  }
  return result;
}

}  // namespace beltrami
