#include "baselines/reduced/reduced_newton.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/parallel.h"
#include "base/types.h"
#include "baselines/reduced/reduced_system.h"
#include "descend/assembly.h"
#include "descend/line_search.h"
#include "descend/newton_loop.h"
#include "exact/crossings.h"
#include "ring/ring_faces.h"

namespace beltrami {
namespace {

/// Of a sample that is left out, as symmetric Dirichlet energy: a bad face, not an infinite one.
constexpr double kFlippedEnergy = 100;

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

NewtonStep Descent::step(bool proxy) {
  const LooseFaces loose = gather();
  const double before = energy(loose, loose.points);
  const std::vector<FaceModel> models =
      with_density(problem_.energy, [&]<class Density>(Density density) {
        return proxy ? model_faces(loose, typename Density::Proxy{}) : model_faces(loose, density);
      });
  ReducedSystem system =
      assemble_reduced(problem_.edges, active_list_, loose.faces, models, metas_, work_);
  const std::vector<Vec2> direction = newton_direction(system);
  NewtonStep result;
  if (direction.empty()) {
    result.predicted = std::numeric_limits<double>::infinity();
    return result;
  }
  for (Index m = 0; m < metas_; ++m) {
    result.predicted -=
        system.gradient[m] * direction[m].x() + system.gradient[metas_ + m] * direction[m].y();
  }
  if (!(result.predicted > newton::kNoGain * before)) return result;

  const DenseMatrix edge_direction = edges_of(direction);
  std::vector<Vec2> point_direction(loose.points.size(), Vec2::Zero());
  for (Index e = 0; e < 2 * sample_count(); ++e) {
    point_direction[1 + e] = edge_direction.row(e).transpose();
  }
  std::copy(direction.begin(), direction.end(), point_direction.begin() + first_meta());
  double length = std::min(
      1.0, kSingularShare * first_singular_step(loose.faces, loose.points, point_direction, work_));
  std::vector<Vec2> trial(loose.points.size()), places(metas_);
  backtrack(length, [&](double step) {
    for (std::size_t p = 0; p < trial.size(); ++p) {
      trial[p] = loose.points[p] + step * point_direction[p];
    }
    if (!falls_enough(before, energy(loose, trial), step, -result.predicted)) return false;
    for (Index m = 0; m < metas_; ++m) places[m] = trial[first_meta() + m];
    if (scaffold_ && !is_simple(loop_, places)) return false;
    x_ = places;
    edges_ += step * edge_direction;
    result.gain = sample_energy_;
    activate();
    result.gain -= sample_energy_;
    result.energy = sample_energy_;
    result.length = step;
    return true;
  });
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
