// One step of projected Newton over a set of faces, for any density, with or without contact of the
// boundary.
#pragma once

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "descend/assembly.h"
#include "descend/contact.h"
#include "descend/line_search.h"
#include "descend/newton_loop.h"
#include "linear/elimination.h"
#include "linear/mesh_matrix.h"
#include "linear/spd_solver.h"
#include "mesh/face_chunks.h"
#include "mesh/rest_shape.h"

namespace beltrami {

/// Energies are compared relative to their value, but not to less than this: the least symmetric
/// ARAP energy is 0.
inline constexpr double kLeastEnergy = 0.01;

/// What the length of a step goes by.
namespace newton {

/// A full step that gains more than this share of the predicted decrease, of which the model has a
/// half, is doubled: the model is a majorizer, and a face that is nearly singular, of energy s^-2,
/// goes from s to 4 s / 3 only. And again while each time the energy falls below a share of what it
/// was.
inline constexpr double kUnderrated = 0.58, kFallsFast = 0.7;

}  // namespace newton

/// Newton's method on the mean of a density over `faces`, weighted by rest area, and on demand on a
/// barrier that keeps the boundary from touching itself. A Density has value(s1, s2), model(s1, s2)
/// and `kBarrier`: whether it is infinite at s2 = 0, so that steps must stop short of singular
/// faces. Keeps references to `faces` and `rest`.
template <class Density>
class NewtonStepper {
 public:
  NewtonStepper(const std::vector<Triangle>& faces, const std::vector<RestTriangle>& rest,
                const std::vector<bool>& fixed, const Work& work, Density density = {})
      : faces_(faces),
        rest_(rest),
        fixed_(fixed),
        weights_(rest.size()),
        work_(work),
        density_(density),
        hessian_(size_of(fixed), faces, fixed, 2, work),
        solver_(make_spd_solver({Precision::kDouble}, work)) {
    for (const RestTriangle& r : rest) area_ += r.area();
    for (std::size_t f = 0; f < rest.size(); ++f) weights_[f] = rest[f].area() / area_;
  }

  Index free_count() const { return hessian_.free_count(); }
  void set_density(const Density& density) { density_ = density; }
  /// From now on the contact's energy joins the objective, no step lets the boundary touch itself,
  /// and each begins where the last one ended.
  void set_contact(const BoundaryContact& contact) { contact_.emplace(contact); }
  /// From now on vertices move along the lines of these unit normals, where they are not zero.
  /// Keeps the reference.
  void set_slides(const std::vector<Vec2>& normals) { slides_ = &normals; }
  /// From now on unknowns are eliminated in the order of these ranks of their vertices, unless
  /// there are none.
  void set_ranks(std::span<const Index> ranks) { ranks_ = ranks; }
  /// See BoundaryContact::fit; for the steps from `uvs` on. `distortion`: as symmetric Dirichlet
  /// energy; `comparable`: what gains are compared with. Precondition: set_contact.
  void fit_contact(const std::vector<Vec2>& uvs, double distortion, double comparable) {
    contact_->fit(uvs, distortion, neighbours_);
    loose_share_ = std::min(kLooseShare, last_gain_ / comparable);
  }

  /// Infinite if a face is not positive under a barrier density.
  double mean_energy(const std::vector<Vec2>& uvs) const;

  /// Moves `uvs` along the Newton direction; `energy` is the mean energy of `uvs` as they come in.
  /// Where no shift makes the system definite there is no step, and no telling what it would gain.
  NewtonStep step(std::vector<Vec2>& uvs, double energy) {
    return step_with(density_, uvs, energy);
  }

  /// The same with the Hessian model of another density that has the same value and gradient.
  template <class Model>
  NewtonStep step_with(const Model& model, std::vector<Vec2>& uvs, double energy);

 private:
  static constexpr double kJammed = 0.25;  // of a step, below which what touches first is stuck
  static constexpr double kFreed = 0.2;    // of the reach, beyond which it is no more
  static constexpr double kPatternMargin = 1.3;  // of the reach, up to which pairs have entries
  static constexpr double kLooseShare = 0.05;    // of all stiffness, of pairs that lack them; and
                                                 // no more than what the last step gained
  /// Across its line a vertex that slides is so many times as stiff as it is by itself: what the
  /// others feel of it differs from a line's pull by the inverse, and pivots keep half of their
  /// digits.
  static constexpr double kRail = 1e8;

  double strength() const { return contact_->strength() / area_; }
  std::vector<Contact> meet_contacts(const std::vector<Vec2>& uvs);
  void add_loose(const std::vector<Vec2>& uvs);
  void hold_to_lines();
  double stop_before_touch(const std::vector<Vec2>& uvs, const std::vector<Vec2>& direction,
                           double length);
  template <class Model>
  void assemble_model(const Model& model, const std::vector<Vec2>& uvs);
  bool factorize();
  void go_further(const std::vector<Vec2>& uvs, const std::vector<Vec2>& direction, double longest,
                  NewtonStep& made, std::vector<Vec2>& reached, Neighbours& neighbours);

  const std::vector<Triangle>& faces_;
  const std::vector<RestTriangle>& rest_;
  const std::vector<bool>& fixed_;
  double area_ = 0;
  std::vector<double> weights_;  // of the faces in the mean
  const Work work_;
  Density density_;
  std::optional<BoundaryContact> contact_;
  Neighbours neighbours_;          // in the map that the last step left; none before the first
  std::vector<Contact> contacts_;  // that the matrix has entries for
  std::vector<Contact> loose_;     // without
  double last_gain_ = std::numeric_limits<double>::infinity();
  double loose_share_ = kLooseShare;
  std::set<std::pair<Index, Index>> stuck_;  // kept together, by vertex and first of the edge
  std::vector<Triangle> with_contacts_;  // the faces, then the vertices of each contact; or empty
  MeshMatrix hessian_;
  std::unique_ptr<SpdSolver> solver_;
  bool analyzed_ = false;
  Eigen::VectorXd gradient_;
  const std::vector<Vec2>* slides_ = nullptr;
  std::span<const Index> ranks_;
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
  return parallel_sum(work_, size_of(faces_), FaceChunks::grain_of(size_of(faces_)), part);
}

/// The projected Hessian is definite once a vertex is fixed, but barely so along nearly free
/// motions; a shift relative to the diagonal covers the roundoff at any scale. False where none
/// does.
template <class Density>
bool NewtonStepper<Density>::factorize() {
  SparseMatrix& matrix = hessian_.matrix();
  const int* const first = matrix.outerIndexPtr();  // of each column: the diagonal
  Eigen::VectorXd diagonal(matrix.cols());
  for (Eigen::Index c = 0; c < matrix.cols(); ++c) diagonal[c] = matrix.valuePtr()[first[c]];
  for (double shift = newton::kShift; shift <= newton::kLargestShift; shift *= 1e2) {
    for (Eigen::Index c = 0; c < matrix.cols(); ++c) {
      matrix.valuePtr()[first[c]] = diagonal[c] * (1 + shift);
    }
    if (solver_->factorize(matrix)) return true;
  }
  return false;
}

/// Gives the matrix entries for the pairs in contact, which are returned. Pairs a little beyond
/// their reach get them too, so that the pattern, and with it the ordering, serves for several
/// steps; and it serves on where those that lack entries are weak.
template <class Density>
std::vector<Contact> NewtonStepper<Density>::meet_contacts(const std::vector<Vec2>& uvs) {
  const auto less = [](const Contact& a, const Contact& b) {
    return std::pair(a.vertex, a.from) < std::pair(b.vertex, b.from);
  };
  const std::vector<Contact> found = contact_->find(uvs, neighbours_);
  std::vector<Contact> now = found;
  std::sort(now.begin(), now.end(), less);
  loose_.clear();
  std::set_difference(now.begin(), now.end(), contacts_.begin(), contacts_.end(),
                      std::back_inserter(loose_), less);
  const auto stiffness = [&](const std::vector<Contact>& pairs) {
    double sum = 0;
    for (const Contact& c : pairs) sum += contact_stiffness(c, uvs);
    return sum;
  };
  if (loose_.empty() || stiffness(loose_) <= loose_share_ * stiffness(now)) return found;
  loose_.clear();
  contacts_ = contact_->find(uvs, kPatternMargin);
  std::sort(contacts_.begin(), contacts_.end(), less);
  with_contacts_ = faces_;
  for (const Contact& c : contacts_) with_contacts_.push_back({c.vertex, c.from, c.to});
  hessian_ = MeshMatrix(size_of(fixed_), with_contacts_, fixed_, 2, work_);
  analyzed_ = false;
  return found;
}

/// How far of `length` the map may go. Where that is next to nothing, because parts that all but
/// touch turn against each other, which the model does not see, the next step keeps these together:
/// the barrier then parts them.
template <class Density>
double NewtonStepper<Density>::stop_before_touch(const std::vector<Vec2>& uvs,
                                                 const std::vector<Vec2>& direction,
                                                 double length) {
  double limit = length / kSingularShare;
  const std::vector<Touch> touches = contact_->touches(uvs, direction, limit, kJammed * length);
  for (const Contact& c : contacts_) {
    if (share_of_reach(c, uvs) > kFreed) stuck_.erase({c.vertex, c.from});
  }
  for (const Touch& touch : touches) limit = std::min(limit, touch.time);
  for (const Touch& touch : touches) {
    if (touch.time < kJammed * length) stuck_.insert({touch.vertex, touch.from});
  }
  return kSingularShare * limit;
}

template <class Density>
template <class Model>
void NewtonStepper<Density>::assemble_model(const Model& model, const std::vector<Vec2>& uvs) {
  const std::int64_t face_count = size_of(faces_);
  const auto weight = [&](std::int64_t f) { return weights_[f]; };
  const auto give = [&](std::int64_t first, std::int64_t end, FaceModels& models) {
    if (first < face_count) {
      give_face_models(faces_, rest_, uvs, first, std::min(end, face_count), model, weight, models);
    }
    for (std::int64_t f = std::max(first, face_count); f < end; ++f) {
      const Contact& contact = contacts_[f - face_count];
      FaceModel pair = contact_model(contact, uvs, stuck_.contains({contact.vertex, contact.from}));
      pair.gradient *= strength();
      pair.hessian *= strength();
      models.set(static_cast<int>(f - first), pair);
    }
  };
  assemble(with_contacts_.empty() ? faces_ : with_contacts_, give, hessian_, gradient_, work_);
  add_loose(uvs);
  hold_to_lines();
}

/// Takes what pulls vertices off their lines from the gradient, and makes them stiff across these.
template <class Density>
void NewtonStepper<Density>::hold_to_lines() {
  if (slides_ == nullptr) return;
  const SparseMatrix& matrix = hessian_.matrix();
  for (Index v = 0; v < size_of(*slides_); ++v) {
    const Vec2& normal = (*slides_)[v];
    const Index row = hessian_.row(v);
    if (row == kNone || normal.isZero(0)) continue;
    auto pull = gradient_.segment<2>(2 * row);
    pull -= normal.dot(pull) * normal;
    const double stiffness = kRail * (matrix.valuePtr()[matrix.outerIndexPtr()[2 * row]] +
                                      matrix.valuePtr()[matrix.outerIndexPtr()[2 * row + 1]]);
    hessian_.add_diagonal(row, [&](int r, int c) { return stiffness * normal[r] * normal[c]; });
  }
}

/// Pairs without entries hold their vertices to their places: of a term k (sum_i c_i n . x_i)^2 the
/// blocks on the diagonal, times sum_j |c_j| / |c_i|, are a bound from above.
template <class Density>
void NewtonStepper<Density>::add_loose(const std::vector<Vec2>& uvs) {
  for (const Contact& contact : loose_) {
    const FaceModel pair =
        contact_model(contact, uvs, stuck_.contains({contact.vertex, contact.from}));
    const Triangle corners = {contact.vertex, contact.from, contact.to};
    Eigen::Vector3d weight;
    for (int k = 0; k < 3; ++k) {
      weight[k] = std::sqrt(std::max(0.0, pair.hessian.block<2, 2>(2 * k, 2 * k).trace()));
    }
    for (int k = 0; k < 3; ++k) {
      const Index row = hessian_.row(corners[k]);
      if (row == kNone || !(weight[k] > 0)) continue;
      gradient_.segment<2>(2 * row) += strength() * pair.gradient.segment<2>(2 * k);
      const double bound = strength() * weight.sum() / weight[k];
      hessian_.add_diagonal(
          row, [&](int r, int c) { return bound * pair.hessian(2 * k + r, 2 * k + c); });
    }
  }
}

/// Doubles the step that leads from `uvs` to `reached`, where that lowers the energy and brings
/// nothing into contact, and on as long as the energy falls fast.
template <class Density>
void NewtonStepper<Density>::go_further(const std::vector<Vec2>& uvs,
                                        const std::vector<Vec2>& direction, double longest,
                                        NewtonStep& made, std::vector<Vec2>& reached,
                                        Neighbours& neighbours) {
  std::vector<Vec2> trial(uvs.size());
  for (double falls = 0; falls < newton::kFallsFast && 2 * made.length <= longest;) {
    const double length = 2 * made.length;
    for (Index v = 0; v < size_of(uvs); ++v) trial[v] = uvs[v] + length * direction[v];
    const double energy = mean_energy(trial);
    if (!(energy < made.energy)) return;
    if (contact_) {
      Neighbours near = contact_->neighbours(trial);
      if (!contact_->find(trial, near).empty() || !contact_->is_simple(trial)) return;
      neighbours = std::move(near);
    }
    falls = energy / made.energy;
    made.gain = last_gain_ = made.gain + (made.energy - energy);
    made.energy = energy;
    made.length = length;
    reached.swap(trial);
  }
}

template <class Density>
template <class Model>
NewtonStep NewtonStepper<Density>::step_with(const Model& model, std::vector<Vec2>& uvs,
                                             double energy) {
  std::vector<Contact> touching;
  if (contact_) touching = meet_contacts(uvs);
  assemble_model(model, uvs);
  if (!analyzed_) {
    solver_->analyze(hessian_.matrix(), hessian_.places(uvs), in_order(ranks_, hessian_.rows()));
  }
  analyzed_ = true;
  NewtonStep result;
  result.energy = energy;
  if (!factorize()) {
    result.predicted = std::numeric_limits<double>::infinity();
    return result;
  }
  const Eigen::VectorXd flat = solver_->solve(-gradient_);
  result.predicted = -gradient_.dot(flat);
  if (!(result.predicted > newton::kNoGain * std::max(energy, kLeastEnergy))) return result;

  std::vector<Vec2> direction(uvs.size(), Vec2::Zero());
  for (Index v = 0; v < size_of(uvs); ++v) {
    if (hessian_.row(v) == kNone) continue;
    direction[v] = flat.segment<2>(2 * hessian_.row(v));
    if (slides_ != nullptr) direction[v] -= (*slides_)[v].dot(direction[v]) * (*slides_)[v];
  }
  double longest = std::numeric_limits<double>::infinity();
  if (Density::kBarrier) {
    longest = kSingularShare * first_singular_step(faces_, uvs, direction, work_);
  }
  double length = std::min(1.0, longest);
  const auto pressure = [&](const std::vector<Vec2>& map, const std::vector<Contact>& contacts) {
    return contact_ ? strength() * contact_energy(contacts, map) : 0.0;
  };
  if (contact_) length = stop_before_touch(uvs, direction, length);
  if (!(length > 0)) return result;
  const double before = energy + pressure(uvs, touching);
  std::vector<Vec2> trial(uvs.size());
  backtrack(length, [&](double step) {
    for (Index v = 0; v < size_of(uvs); ++v) trial[v] = uvs[v] + step * direction[v];
    const double trial_energy = mean_energy(trial);
    if (!(trial_energy < before)) return false;
    Neighbours neighbours;
    if (contact_) {
      neighbours = contact_->neighbours(trial);
      touching = contact_->find(trial, neighbours);
    }
    const double after = trial_energy + pressure(trial, touching);
    if (!falls_enough(before, after, step, -result.predicted)) return false;
    if (contact_ && !contact_->is_simple(trial)) return false;
    result.length = step;
    result.energy = trial_energy;
    result.gain = last_gain_ = before - after;
    const bool apart = before == energy && touching.empty();
    if (step == 1 && apart && result.gain > newton::kUnderrated * result.predicted) {
      go_further(uvs, direction, longest, result, trial, neighbours);
    }
    uvs.swap(trial);
    neighbours_ = std::move(neighbours);
    return true;
  });
  return result;
}

}  // namespace beltrami
