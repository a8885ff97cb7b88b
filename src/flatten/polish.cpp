#include "flatten/polish.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>

#include "base/interrupt.h"
#include "base/parallel.h"
#include "fullspace/assembly.h"
#include "fullspace/line_search.h"
#include "fullspace/newton_step.h"

namespace beltrami {
namespace {

constexpr std::int64_t kGrain = 8192;
constexpr std::size_t kHistory = 6;
constexpr double kSingularShare = 0.8;
constexpr double kArmijo = 1e-4;
constexpr int kMaxHalvings = 30;
constexpr double kFullStep = 0.5;  // shorter steps say nothing about convergence
constexpr double kBlockedStep = 0.1;

template <class Density>
class Polish {
 public:
  Polish(const std::vector<Triangle>& faces, const std::vector<RestTriangle>& rest, int threads)
      : faces_(faces), rest_(rest), threads_(threads), corner_gradients_(faces.size()) {
    for (const RestTriangle& r : rest) total_area_ += r.area();
  }

  double energy(const std::vector<Vec2>& uvs) const {
    const auto part = [&](std::int64_t begin, std::int64_t end) {
      double sum = 0;
      for (std::int64_t f = begin; f < end; ++f) {
        const Triangle& t = faces_[f];
        const LinearMap map = linear_map(rest_[f], uvs[t[0]], uvs[t[1]], uvs[t[2]]);
        if (!(std::norm(map.fz) > std::norm(map.fzbar))) {
          return std::numeric_limits<double>::infinity();
        }
        sum += rest_[f].area() * Density::slopes(map).value;
      }
      return sum;
    };
    return parallel_sum(threads_, size_of(faces_), kGrain, part) / total_area_;
  }

  /// Gradient of the mean energy, one row per vertex.
  DenseMatrix gradient(const std::vector<Vec2>& uvs) {
    parallel_for(threads_, size_of(faces_), kGrain, [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t f = begin; f < end; ++f) {
        corner_gradients_[f] = face_gradient(static_cast<Index>(f), uvs);
      }
    });
    poll_interrupt();
    DenseMatrix sum = DenseMatrix::Zero(static_cast<Eigen::Index>(uvs.size()), 2);
    for (Index f = 0; f < size_of(faces_); ++f) {
      for (int k = 0; k < 3; ++k) {
        sum(faces_[f][k], 0) += corner_gradients_[f][k].x();
        sum(faces_[f][k], 1) += corner_gradients_[f][k].y();
      }
    }
    return sum;
  }

 private:
  /// Through fz = sum conj(G_k) w_k / 2 and fzbar = sum G_k w_k / 2.
  std::array<Vec2, 3> face_gradient(Index f, const std::vector<Vec2>& uvs) const {
    const Triangle& t = faces_[f];
    const LinearMap map = linear_map(rest_[f], uvs[t[0]], uvs[t[1]], uvs[t[2]]);
    const DensitySlopes slopes = Density::slopes(map);
    const double weight = 0.5 * rest_[f].area() / total_area_;
    const Complex dx = weight * slopes.by_fz * map.fz;
    const Complex dy = weight * slopes.by_fzbar * map.fzbar;
    std::array<Vec2, 3> result;
    for (int k = 0; k < 3; ++k) {
      const Complex hat = rest_[f].hat_gradient(k);
      const Complex g = dx * hat + dy * std::conj(hat);
      result[k] = {g.real(), g.imag()};
    }
    return result;
  }

  const std::vector<Triangle>& faces_;
  const std::vector<RestTriangle>& rest_;
  const int threads_;
  double total_area_ = 0;
  std::vector<std::array<Vec2, 3>> corner_gradients_;
};

double dot(const DenseMatrix& a, const DenseMatrix& b) {
  return a.cwiseProduct(b).sum();
}

/// The pairs of the last steps, and the two-loop recursion over them.
class History {
 public:
  void add(DenseMatrix step, DenseMatrix change) {
    const double curvature = dot(step, change);
    if (!(curvature > 0)) return;  // would make the model indefinite
    if (pairs_.size() == kHistory) pairs_.pop_front();
    pairs_.push_back({std::move(step), std::move(change), 1 / curvature});
  }
  void clear() { pairs_.clear(); }
  bool empty() const { return pairs_.empty(); }

  DenseMatrix direction(const DenseMatrix& gradient,
                        const std::function<DenseMatrix(const DenseMatrix&)>& precondition) const {
    DenseMatrix q = -gradient;
    std::vector<double> alpha(pairs_.size());
    for (std::size_t i = pairs_.size(); i-- > 0;) {
      poll_interrupt();
      alpha[i] = pairs_[i].inverse_curvature * dot(pairs_[i].step, q);
      q -= alpha[i] * pairs_[i].change;
    }
    q = precondition(q);
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      poll_interrupt();
      const double beta = pairs_[i].inverse_curvature * dot(pairs_[i].change, q);
      q += (alpha[i] - beta) * pairs_[i].step;
    }
    return q;
  }

 private:
  struct Pair {
    DenseMatrix step, change;
    double inverse_curvature;
  };
  std::deque<Pair> pairs_;
};

template <class Density>
PolishResult descend(const std::vector<Triangle>& faces, const std::vector<RestTriangle>& rest,
                     const std::function<DenseMatrix(const DenseMatrix&)>& precondition,
                     std::vector<Vec2>& uvs, const PolishOptions& options,
                     const Checkpoint& checkpoint) {
  Polish<Density> problem(faces, rest, options.threads);
  PolishResult result;
  result.energies.push_back(problem.energy(uvs));
  if (!std::isfinite(result.energies.front())) return result;
  DenseMatrix gradient = problem.gradient(uvs);
  History history;
  std::vector<Vec2> direction(uvs.size()), trial(uvs.size());
  while (result.iterations() < options.max_iterations) {
    checkpoint(static_cast<double>(result.iterations()) / options.max_iterations);
    const double before = result.energies.back();
    DenseMatrix flat = history.direction(gradient, precondition);
    double slope = dot(gradient, flat);
    if (!(slope < 0) && !history.empty()) {
      history.clear();
      flat = history.direction(gradient, precondition);
      slope = dot(gradient, flat);
    }
    if (!(slope < 0)) break;
    for (Index v = 0; v < size_of(uvs); ++v) direction[v] = flat.row(v).transpose();
    double length =
        std::min(1.0, kSingularShare * first_singular_step(faces, uvs, direction, options.threads));
    double after = std::numeric_limits<double>::infinity();
    for (int halving = 0; halving < kMaxHalvings; ++halving, length *= 0.5) {
      for (Index v = 0; v < size_of(uvs); ++v) trial[v] = uvs[v] + length * direction[v];
      after = problem.energy(trial);
      if (after <= before + kArmijo * length * slope) break;
    }
    if (!(after < before)) {
      result.blocked = true;
      break;
    }
    uvs.swap(trial);
    result.energies.push_back(after);
    DenseMatrix next = problem.gradient(uvs);
    history.add(length * flat, next - gradient);
    gradient.swap(next);
    result.blocked = length < kBlockedStep;
    result.converged = length >= kFullStep &&
                       before - after <= options.tolerance * comparable_energy<Density>(before);
    if (result.blocked || result.converged) break;
  }
  return result;
}

}  // namespace

PolishResult polish(const std::vector<Triangle>& faces, const std::vector<RestTriangle>& rest,
                    const std::function<DenseMatrix(const DenseMatrix&)>& precondition,
                    std::vector<Vec2>& uvs, const PolishOptions& options,
                    const Checkpoint& checkpoint) {
  return with_density(options.energy, [&]<class Density>(Density) {
    return descend<Density>(faces, rest, precondition, uvs, options, checkpoint);
  });
}

}  // namespace beltrami
