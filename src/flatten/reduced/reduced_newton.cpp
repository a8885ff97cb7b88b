#include "flatten/reduced/reduced_newton.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/parallel.h"
#include "base/types.h"
#include "descend/assembly.h"
#include "descend/line_search.h"
#include "descend/newton_loop.h"
#include "exact/crossings.h"
#include "ring/ring_faces.h"

namespace beltrami {
namespace {

/// Of a sample that is left out, as symmetric Dirichlet energy: a bad face, not an infinite one.
constexpr double kFlippedEnergy = 100;
/// Columns of the Hessian that are formed together.
constexpr Eigen::Index kTile = 32;

/// Samples and scaffold as loose faces on one list of points. Point 0 is the origin, where every
/// sample has its corner 0; then come the other corners of the samples, the meta vertices, and the
/// circle of the scaffold. All but the circle are linear in the meta vertices.
struct LooseFaces {
  std::vector<Triangle> faces;
  std::vector<RestTriangle> rest;
  std::vector<double> weights;
  std::vector<Vec2> points;
};

class Descent {
 public:
  Descent(const ReducedProblem& problem, bool scaffold, std::vector<Vec2>& x, const Work& work)
      : problem_(problem),
        scaffold_(scaffold),
        work_(work),
        metas_(size_of(x)),
        x_(x),
        active_(problem.rest.size(), false),
        total_area_(std::accumulate(problem.weights.begin(), problem.weights.end(), 0.0)),
        flipped_energy_(with_density(problem.energy, []<class Density>(Density) {
          return from_dirichlet<Density>(kFlippedEnergy);
        })) {
    loop_.resize(metas_);
    std::iota(loop_.begin(), loop_.end(), 0);
    scale_and_activate();
  }

  double sample_energy() const { return sample_energy_; }
  /// One step, by the model of the energy or of its proxy. Its energies are of the samples alone.
  NewtonStep step(bool proxy);

 private:
  Index sample_count() const { return size_of(problem_.rest); }
  Index first_meta() const { return 1 + 2 * sample_count(); }
  DenseMatrix edges_of(const std::vector<Vec2>& places) const;
  double energy_of_sample(Index s, const DenseMatrix& edges) const;
  void scale_and_activate();
  void activate();
  LooseFaces gather() const;
  double energy(const LooseFaces& loose, const std::vector<Vec2>& points) const;
  template <class Density>
  std::vector<FaceModel> model_faces(const LooseFaces& loose, const Density& density) const;
  void assemble(const LooseFaces& loose, const std::vector<FaceModel>& models);
  std::vector<Vec2> solve();

  const ReducedProblem& problem_;
  const bool scaffold_;
  const Work work_;
  const Index metas_;
  std::vector<Vec2>& x_;
  std::vector<bool> active_;
  std::vector<Index> active_list_;
  const double total_area_;
  const double flipped_energy_;
  std::vector<Index> loop_;
  DenseMatrix edges_;  // of the samples at x_
  double sample_energy_ = 0;
  DenseMatrix hessian_;  // lower triangle; u of all metas, then v
  Eigen::VectorXd gradient_;
};

DenseMatrix Descent::edges_of(const std::vector<Vec2>& places) const {
  DenseMatrix x(metas_, 2);
  for (Index m = 0; m < metas_; ++m) x.row(m) = places[m].transpose();
  return problem_.edges * x;
}

/// Infinite where the sample is not positive.
double Descent::energy_of_sample(Index s, const DenseMatrix& edges) const {
  const SingularValues values =
      singular_values(linear_map(problem_.rest[s], Vec2::Zero(), edges.row(2 * s).transpose(),
                                 edges.row(2 * s + 1).transpose()));
  if (!(values.s2 > 0)) return std::numeric_limits<double>::infinity();
  return with_density(problem_.energy,
                      [&](auto density) { return density.value(values.s1, values.s2); });
}

/// The best global scale of the positive samples for the symmetric Dirichlet energy, a good start
/// for the others too: s^4 = sum(A / sigma^2) / sum(A sigma^2). Samples that are then worse than a
/// flipped one are left out too, else a few that are nearly collinear would decide the scale alone:
/// it is taken twice.
void Descent::scale_and_activate() {
  constexpr double kWorstForScale = 1e4;
  edges_ = edges_of(x_);
  for (int round = 0; round < 2; ++round) {
    double stretch = 0, shrink = 0;
    for (Index s = 0; s < sample_count(); ++s) {
      const LinearMap map =
          linear_map(problem_.rest[s], Vec2::Zero(), edges_.row(2 * s).transpose(),
                     edges_.row(2 * s + 1).transpose());
      const double norm_sq = 2 * (std::norm(map.fz) + std::norm(map.fzbar));
      const double det = std::norm(map.fz) - std::norm(map.fzbar);
      // Free of scale: s1 / s2 + s2 / s1.
      if (!(det > 0) || norm_sq / det > kWorstForScale) continue;
      stretch += problem_.weights[s] * norm_sq;
      shrink += problem_.weights[s] * norm_sq / (det * det);
    }
    const double scale = std::sqrt(std::sqrt(shrink / stretch));
    if (!std::isfinite(scale) || !(scale > 0)) break;
    for (Vec2& place : x_) place *= scale;
    edges_ *= scale;
  }
  for (Index s = 0; s < sample_count(); ++s)
    active_[s] = std::isfinite(energy_of_sample(s, edges_));
  activate();
}

/// Takes in the samples that have become better than a constant, and sums up.
void Descent::activate() {
  active_list_.clear();
  double sum = 0;
  for (Index s = 0; s < sample_count(); ++s) {
    const double value = energy_of_sample(s, edges_);
    if (value < flipped_energy_) active_[s] = true;
    if (active_[s]) active_list_.push_back(s);
    sum += problem_.weights[s] * (active_[s] ? value : flipped_energy_);
  }
  sample_energy_ = sum / total_area_;
}

LooseFaces Descent::gather() const {
  LooseFaces loose;
  loose.points.resize(first_meta(), Vec2::Zero());
  for (Index e = 0; e < 2 * sample_count(); ++e) loose.points[1 + e] = edges_.row(e).transpose();
  loose.points.insert(loose.points.end(), x_.begin(), x_.end());
  for (const Index s : active_list_) {
    loose.faces.push_back({0, 1 + 2 * s, 2 + 2 * s});
    loose.rest.push_back(problem_.rest[s]);
    loose.weights.push_back(problem_.weights[s] / total_area_);
  }
  if (!scaffold_) return loose;
  const RingFaces ring = ring_faces(x_, 1.0);
  std::vector<Index> boundary(metas_);
  std::iota(boundary.begin(), boundary.end(), first_meta());
  glue_ring(ring.faces, boundary, size_of(loose.points), loose.faces);
  loose.points.insert(loose.points.end(), ring.circle.begin(), ring.circle.end());
  loose.rest.insert(loose.rest.end(), ring.rest.begin(), ring.rest.end());
  loose.weights.insert(loose.weights.end(), ring.weights.begin(), ring.weights.end());
  return loose;
}

double Descent::energy(const LooseFaces& loose, const std::vector<Vec2>& points) const {
  double sum = 0;
  for (Index f = 0; f < size_of(loose.faces); ++f) {
    const Triangle& t = loose.faces[f];
    const SingularValues s =
        singular_values(linear_map(loose.rest[f], points[t[0]], points[t[1]], points[t[2]]));
    if (!(s.s2 > 0)) return std::numeric_limits<double>::infinity();
    sum += loose.weights[f] *
           with_density(problem_.energy, [&](auto density) { return density.value(s.s1, s.s2); });
  }
  return sum;
}

template <class Density>
std::vector<FaceModel> Descent::model_faces(const LooseFaces& loose, const Density& density) const {
  std::vector<FaceModel> models(loose.faces.size());
  parallel_for(work_, size_of(loose.faces), 1024, [&](std::int64_t begin, std::int64_t end) {
    const auto weight = [&](std::int64_t f) { return loose.weights[f]; };
    FaceModels block;
    for (std::int64_t f = begin; f < end; ++f) {
      const auto at = static_cast<int>((f - begin) % FaceModels::kFaces);
      if (at == 0) {
        give_face_models(loose.faces, loose.rest, loose.points, f, end, density, weight, block);
      }
      models[f] = block.at(at);
    }
  });
  return models;
}

/// Samples: E^T D E with the edges E and, per sample, the 4 x 4 block D of its corners 1 and 2,
/// since an energy does not see translations. In tiles of columns, so that threads share no sums.
void Descent::assemble(const LooseFaces& loose, const std::vector<FaceModel>& models) {
  const Index samples = size_of(active_list_);
  DenseMatrix edges(2 * samples, metas_), pull(2 * samples, 2);
  parallel_for(work_, metas_, kTile, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t m = begin; m < end; ++m) {
      for (Index i = 0; i < samples; ++i) {
        edges.col(m).segment<2>(2 * i) = problem_.edges.col(m).segment<2>(2 * active_list_[i]);
      }
    }
  });
  for (Index i = 0; i < samples; ++i) {
    for (int corner = 0; corner < 2; ++corner) {
      pull.row(2 * i + corner) = models[i].gradient.segment<2>(2 * corner + 2).transpose();
    }
  }
  gradient_.resize(2 * metas_);
  gradient_.head(metas_).noalias() = edges.transpose() * pull.col(0);
  gradient_.tail(metas_).noalias() = edges.transpose() * pull.col(1);

  hessian_.setZero(2 * metas_, 2 * metas_);
  // (row, column) of D: u with u, v with u, v with v.
  const std::array<std::array<int, 2>, 3> blocks = {{{0, 0}, {1, 0}, {1, 1}}};
  parallel_for(work_, metas_, kTile, [&](std::int64_t begin, std::int64_t end) {
    const Eigen::Index width = end - begin;
    DenseMatrix scaled(2 * samples, width);
    for (const auto& [r, c] : blocks) {
      for (Eigen::Index m = 0; m < width; ++m) {
        for (Index i = 0; i < samples; ++i) {
          const Matrix6& d = models[i].hessian;
          const double e1 = edges(2 * i, begin + m), e2 = edges(2 * i + 1, begin + m);
          scaled(2 * i, m) = d(2 + r, 2 + c) * e1 + d(2 + r, 4 + c) * e2;
          scaled(2 * i + 1, m) = d(4 + r, 2 + c) * e1 + d(4 + r, 4 + c) * e2;
        }
      }
      const Eigen::Index top = r == c ? begin : 0;
      hessian_.block(r * metas_ + top, c * metas_ + begin, metas_ - top, width).noalias() =
          edges.rightCols(metas_ - top).transpose() * scaled;
    }
  });

  const auto place = [&](Index point, int axis) { return axis * metas_ + point - first_meta(); };
  for (Index f = samples; f < size_of(loose.faces); ++f) {
    const Triangle& t = loose.faces[f];
    for (int a = 0; a < 6; ++a) {
      if (t[a / 2] >= first_meta() + metas_) continue;
      const Index row = place(t[a / 2], a % 2);
      gradient_[row] += models[f].gradient[a];
      for (int b = 0; b < 6; ++b) {
        if (t[b / 2] >= first_meta() + metas_) continue;
        const Index column = place(t[b / 2], b % 2);
        if (row >= column) hessian_(row, column) += models[f].hessian(a, b);
      }
    }
  }
}

/// The Newton direction. A shift relative to the diagonal covers what is free or within the
/// roundoff. Empty where none makes the system definite.
std::vector<Vec2> Descent::solve() {
  const Eigen::VectorXd diagonal = hessian_.diagonal();
  const double floor = diagonal.maxCoeff() * newton::kShift;
  std::vector<Vec2> direction;
  for (double shift = newton::kShift; shift <= newton::kLargestShift; shift *= 1e2) {
    hessian_.diagonal() = diagonal * (1 + shift) + Eigen::VectorXd::Constant(2 * metas_, floor);
    const Eigen::LLT<DenseMatrix, Eigen::Lower> factor(hessian_);
    if (factor.info() != Eigen::Success) continue;
    const Eigen::VectorXd flat = factor.solve(-gradient_);
    if (!flat.allFinite()) continue;
    for (Index m = 0; m < metas_; ++m) direction.push_back({flat[m], flat[metas_ + m]});
    break;
  }
  return direction;
}

NewtonStep Descent::step(bool proxy) {
  const LooseFaces loose = gather();
  const double before = energy(loose, loose.points);
  with_density(problem_.energy, [&]<class Density>(Density density) {
    assemble(loose,
             proxy ? model_faces(loose, typename Density::Proxy{}) : model_faces(loose, density));
  });
  const std::vector<Vec2> direction = solve();
  NewtonStep result;
  if (direction.empty()) {
    result.predicted = std::numeric_limits<double>::infinity();
    return result;
  }
  for (Index m = 0; m < metas_; ++m) {
    result.predicted -= gradient_[m] * direction[m].x() + gradient_[metas_ + m] * direction[m].y();
  }
  if (!(result.predicted > newton::kNoGain * before)) return result;

  const DenseMatrix edge_direction = edges_of(direction);
  std::vector<Vec2> point_direction(loose.points.size(), Vec2::Zero());
  for (Index e = 0; e < 2 * sample_count(); ++e) {
    point_direction[1 + e] = edge_direction.row(e).transpose();
  }
  std::copy(direction.begin(), direction.end(), point_direction.begin() + first_meta());
  double length =
      std::min(1.0, newton::kSingularShare *
                        first_singular_step(loose.faces, loose.points, point_direction, work_));
  std::vector<Vec2> trial(loose.points.size()), places(metas_);
  for (int halving = 0; halving < newton::kMaxHalvings; ++halving, length *= 0.5) {
    for (std::size_t p = 0; p < trial.size(); ++p) {
      trial[p] = loose.points[p] + length * point_direction[p];
    }
    if (!(energy(loose, trial) <= before - newton::kArmijo * length * result.predicted)) continue;
    for (Index m = 0; m < metas_; ++m) places[m] = trial[first_meta() + m];
    if (scaffold_ && !is_simple(loop_, places)) continue;
    x_ = places;
    edges_ += length * edge_direction;
    result.gain = sample_energy_;
    activate();
    result.gain -= sample_energy_;
    result.energy = sample_energy_;
    result.length = length;
    break;
  }
  return result;
}

}  // namespace

ReducedDescent minimise_reduced(const ReducedProblem& problem, bool scaffold, double tolerance,
                                int max_iterations, std::vector<Vec2>& x, const Work& work) {
  Descent descent(problem, scaffold, x, work);
  ReducedDescent result;
  result.energies.push_back(descent.sample_energy());
  // The samples stand for the map no better than to some percent: the last 1e-5 is not worth
  // waiting for.
  const NewtonRun run = {.tolerance = tolerance,
                         .max_iterations = max_iterations,
                         .comparable = [](double energy) { return energy; },
                         .impatient = true};
  const auto step = [&](bool proxy, double) { return descent.step(proxy); };
  const auto never = [](const NewtonStep&, double) { return false; };
  result.converged = run_newton(run, work, result.energies, step, never);
  return result;
}

}  // namespace beltrami
