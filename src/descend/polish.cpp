#include "descend/polish.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "base/interrupt.h"
#include "base/parallel.h"
#include "base/types.h"
#include "descend/line_search.h"
#include "energy/density.h"
#include "mesh/disk_mesh.h"
#include "mesh/face_block.h"
#include "mesh/vertex_sums.h"

namespace beltrami {
namespace {

using Field = std::vector<Vec2>;  // one entry per vertex

constexpr std::int64_t kGrain = 2048;
constexpr int kPatience = 3;     // steps with contact that gain next to nothing
constexpr int kHoldRounds = 16;  // after which a few faces hold back the whole map
/// More than that do, too, where a round leaves so many times those before it: they push each
/// other, and more rounds do not end that.
constexpr std::size_t kManyHeld = 100;
constexpr double kAsMany = 0.9;
constexpr double kMostContinued = 0.9;  // of the step of the call before
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Calls body(i) for every entry, and adds up what it returns in fixed chunks.
template <class Body>
double sum_over(const Work& work, const Field& field, const Body& body) {
  return parallel_sum(work, size_of(field), kGrain, [&](std::int64_t begin, std::int64_t end) {
    double sum = 0;
    for (std::int64_t i = begin; i < end; ++i) sum += body(static_cast<std::size_t>(i));
    return sum;
  });
}

double dot(const Field& a, const Field& b, const Work& work) {
  return sum_over(work, a, [&](std::size_t i) { return a[i].dot(b[i]); });
}

void add_multiple(double factor, const Field& a, Field& sum, const Work& work) {
  parallel_for(work, size_of(sum), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i) sum[i] += factor * a[i];
  });
}

/// The mean energy with the barrier of the contact, and its gradient.
template <class Density>
class Objective {
 public:
  Objective(Index vertex_count, const std::vector<Triangle>& faces,
            const std::vector<RestTriangle>& rest, const Work& work)
      : faces_(faces), rest_(rest), work_(work), sums_(vertex_count, faces, work) {
    const auto area = [&](std::int64_t begin, std::int64_t end) {
      double sum = 0;
      for (std::int64_t f = begin; f < end; ++f) sum += rest[f].area();
      return sum;
    };
    inverse_area_ = 1 / parallel_sum(work, size_of(rest), kGrain, area);
  }

  /// From now on with contact. Keeps the pointer.
  void set_contact(const BoundaryContact* contact) { contact_ = contact; }

  /// Infinite where a face is not positive or the boundary touches itself; the gradient is of no
  /// use then.
  double evaluate(const Field& uvs, Field& gradient) {
    const auto give = [&](std::int64_t first, std::int64_t end, VertexSums::BlockTerms& terms) {
      give_block(uvs, first, end, terms);
    };
    const double sum = sums_.add_up_blocks(give, gradient);
    if (!contact_ || !std::isfinite(sum)) return sum;
    const double strength = contact_->strength() * inverse_area_;
    return sum + strength * contact_->add_gradient(uvs, strength, gradient);
  }

  /// The same bits without contact and gradient, for half the time.
  double measure(const Field& uvs) const {
    const auto sum = [&](std::int64_t begin, std::int64_t end) {
      double total = 0;
      FaceBlock block;
      FaceBlock::Numbers values, det;
      for (std::int64_t first = begin; first < end; first += FaceBlock::kFaces) {
        block.load(faces_, rest_, uvs, first, end);
        for (int i = 0; i < FaceBlock::kFaces; ++i) {
          const LinearMap map = block.map(i);
          values[i] = weight_of(block.rest(i)) * Density::slopes(map).value;
          det[i] = determinant(map);
        }
        refuse_folded(det, values);
        const auto count = std::min<std::int64_t>(FaceBlock::kFaces, end - first);
        for (std::int64_t i = 0; i < count; ++i) total += values[i];
      }
      return total;
    };
    return parallel_sum(work_, size_of(faces_), sums_.grain(), sum);
  }

 private:
  double weight_of(const RestTriangle& rest) const { return rest.area() * inverse_area_; }

  static double determinant(const LinearMap& map) {
    return std::norm(map.fz) - std::norm(map.fzbar);
  }

  /// Apart from what gives these numbers, so that its loop has no branch.
  static void refuse_folded(const FaceBlock::Numbers& det, FaceBlock::Numbers& values) {
    for (int i = 0; i < FaceBlock::kFaces; ++i) {
      if (!(det[i] > 0)) values[i] = std::numeric_limits<double>::infinity();
    }
  }

  /// The energies of some faces and their gradients.
  void give_block(const Field& uvs, std::int64_t first, std::int64_t end,
                  VertexSums::BlockTerms& terms) const {
    FaceBlock block;
    block.load(faces_, rest_, uvs, first, end);
    FaceBlock::Numbers det;
    for (int i = 0; i < FaceBlock::kFaces; ++i) {
      const RestTriangle r = block.rest(i);
      const LinearMap map = block.map(i);
      const double weight = weight_of(r);
      const DensitySlopes slopes = Density::slopes(map);
      // Through the derivatives f_x = fz + fzbar and f_y = i (fz - fzbar).
      const Complex by_z = 0.5 * weight * slopes.by_fz * map.fz;
      const Complex by_zbar = 0.5 * weight * slopes.by_fzbar * map.fzbar;
      const Complex by_x = by_z + by_zbar, i_by_y = by_zbar - by_z;
      const double inverse_x1 = 1 / r.x1, inverse_y2 = 1 / r.y2, shear = r.x2 * inverse_x1;
      terms.x[2][i] = inverse_y2 * i_by_y.imag();
      terms.y[2][i] = inverse_y2 * -i_by_y.real();
      terms.x[1][i] = inverse_x1 * by_x.real() - shear * terms.x[2][i];
      terms.y[1][i] = inverse_x1 * by_x.imag() - shear * terms.y[2][i];
      terms.x[0][i] = -terms.x[1][i] - terms.x[2][i];
      terms.y[0][i] = -terms.y[1][i] - terms.y[2][i];
      terms.value[i] = weight * slopes.value;
      det[i] = determinant(map);
    }
    refuse_folded(det, terms.value);
  }

  const std::vector<Triangle>& faces_;
  const std::vector<RestTriangle>& rest_;
  const Work work_;
  const BoundaryContact* contact_ = nullptr;
  double inverse_area_;
  VertexSums sums_;
};

/// The last steps with the changes of the gradient over them, and the two-loop recursion.
class History {
 public:
  History(std::size_t most, const Work& work) : most_(most), work_(work) {}

  /// Takes over the step of some length along the direction, and what it changed the gradient by;
  /// what is left in the first two fields is of no use.
  void add(double length, Field& direction, Field& gradient, const Field& next_gradient) {
    if (most_ == 0) return;
    parallel_for(work_, size_of(direction), kGrain, [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t i = begin; i < end; ++i) {
        direction[i] *= length;
        gradient[i] = next_gradient[i] - gradient[i];
      }
    });
    Field &step = direction, &change = gradient;
    const double curvature = dot(step, change, work_);
    if (!(curvature > 0)) return;  // would make the model indefinite
    if (pairs_.size() < most_) {
      pairs_.emplace_back();
    } else {
      std::rotate(pairs_.begin(), pairs_.begin() + 1, pairs_.end());
    }
    Pair& pair = pairs_.back();
    pair.step.swap(step);
    pair.change.swap(change);
    pair.inverse_curvature = 1 / curvature;
  }
  void clear() { pairs_.clear(); }
  bool empty() const { return pairs_.empty(); }

  /// Writes the direction of descent; `q` is for its own use, where there are steps.
  void find_direction(const Field& gradient, const Precondition& precondition, Field& q,
                      Field& direction) const {
    if (pairs_.empty()) {
      poll_interrupt();
      if (most_ == 0) parallel_free(work_, direction);  // the last one, beside what finds the next
      precondition(gradient, direction);
      set_negative(direction, direction);
      return;
    }
    parallel_assign(work_, q, gradient.size());
    set_negative(gradient, q);
    std::vector<double> alpha(pairs_.size());
    for (std::size_t i = pairs_.size(); i-- > 0;) {
      alpha[i] = pairs_[i].inverse_curvature * dot(pairs_[i].step, q, work_);
      add_multiple(-alpha[i], pairs_[i].change, q, work_);
    }
    poll_interrupt();
    precondition(q, direction);
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      const double beta = pairs_[i].inverse_curvature * dot(pairs_[i].change, direction, work_);
      add_multiple(alpha[i] - beta, pairs_[i].step, direction, work_);
    }
  }

 private:
  void set_negative(const Field& of, Field& negative) const {
    parallel_for(work_, size_of(of), kGrain, [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t i = begin; i < end; ++i) negative[i] = -of[i];
    });
  }

  struct Pair {
    Field step, change;
    double inverse_curvature = 0;
  };
  std::vector<Pair> pairs_;
  const std::size_t most_;
  const Work work_;
};

/// Turns the preconditioned direction into a conjugate one, unless the last step leads uphill now.
/// Returns what it predicts without: that a step before goes on is no sign of how far the minimum
/// is. Infinite where it stays as it is.
double continue_step(const Field& gradient, Field& direction, LastStep& last, const Work& work) {
  const double before = std::exchange(last.predicted, -dot(gradient, direction, work));
  const bool is_there = last.step.size() == direction.size() && before > 0;
  if (!is_there || !(last.predicted > 0)) return kInfinity;
  const double slope = sum_over(
      work, gradient, [&](std::size_t i) { return gradient[i].dot(last.step[i].cast<double>()); });
  if (!(slope < 0)) return kInfinity;
  const double share = std::min(kMostContinued, last.predicted / before);
  parallel_for(work, size_of(direction), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i) {
      direction[i] += share * last.step[i].cast<double>();
    }
  });
  return last.predicted;
}

void keep_step(double length, const Field& direction, LastStep& last, const Work& work) {
  parallel_assign(work, last.step, direction.size());
  parallel_for(work, size_of(direction), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i) {
      last.step[i] = (length * direction[i]).cast<float>();
    }
  });
}

/// What moves along more rigidly than the direction had it.
class Rigid {
 public:
  explicit Rigid(const DiskMesh& mesh) : mesh_(mesh) {}

  /// Moves the vertices of the faces so, one face after the other, that none becomes singular where
  /// it now does. Vertices that do not move, because they are held, still do not.
  void move(const std::vector<SingularStep>& steps, Field& direction) {
    changed_.resize(direction.size());
    added_.resize(mesh_.faces.size());
    ++round_;
    faces_.clear();
    PollSometimes poll;
    for (const SingularStep& s : steps) {
      const Triangle& face = mesh_.faces[s.face];
      const Vec2 mean = (direction[face[0]] + direction[face[1]] + direction[face[2]]) / 3;
      for (const Index v : face) {
        if (direction[v] == Vec2::Zero()) continue;
        direction[v] = mean + kSingularShare * s.length * (direction[v] - mean);
        if (std::exchange(changed_[v], round_) == round_) continue;
        mesh_.for_each_outgoing(v, [&](Index h) {
          poll();
          if (std::exchange(added_[h / 3], round_) != round_) faces_.push_back(h / 3);
        });
      }
    }
  }

  /// All faces with a vertex that the last call has moved, in no order.
  const std::vector<Index>& faces() const { return faces_; }

 private:
  const DiskMesh& mesh_;
  std::uint8_t round_ = 0;
  std::vector<std::uint8_t> changed_, added_;  ///< the round in which each vertex, face was, or 0
  std::vector<Index> faces_;
};

/// Lets the faces that a full step would bring too near to being singular move along more rigidly,
/// and then those of their neighbours that get there by it. Returns how far the whole map may go
/// along what is left, and with the result the faces found at first. Without `rigidly` the
/// direction stays as it is.
double hold_back(const DiskMesh& mesh, const Field& uvs, bool rigidly, double near,
                 Field& direction, PolishResult& result, const Work& work) {
  constexpr double kLimit = 1 / kSingularShare;
  result.blocking = singular_steps(mesh.faces, uvs, direction, std::max(kLimit, near), work);
  if (near > 0) {
    result.near = result.blocking;
    std::erase_if(result.blocking, [](const SingularStep& s) { return !(s.length < kLimit); });
  }
  std::vector<SingularStep> left;
  const std::vector<SingularStep>* singular = &result.blocking;
  Rigid rigid(mesh);
  for (int round = 0; rigidly && round < kHoldRounds && !singular->empty(); ++round) {
    rigid.move(*singular, direction);
    const double before = static_cast<double>(singular->size());
    // The others go as they went when they were looked at last.
    left = singular_steps_of(rigid.faces(), mesh.faces, uvs, direction, kLimit, work);
    singular = &left;
    if (left.size() > kManyHeld && static_cast<double>(left.size()) > kAsMany * before) break;
  }
  double length = 1;
  for (const SingularStep& s : *singular) length = std::min(length, kSingularShare * s.length);
  return length;
}

/// A step of that length, or shorter where parts of the boundary would touch; `contact` may be
/// null.
double before_touch(const BoundaryContact* contact, const Field& uvs, const Field& direction,
                    double length) {
  if (!contact) return length;
  return kSingularShare * contact->first_touch(uvs, direction, length / kSingularShare);
}

/// The buffers of a descent.
struct Fields {
  Field gradient, direction;
  Field next_gradient;  ///< only where steps are remembered
  Field trial;          ///< and what else is needed between two trials
};

/// Writes into `trial` the point along the direction, from `length` on downwards, where the energy
/// is low enough for its slope and the boundary simple, its gradient into `gradient`, and shortens
/// `length` accordingly. Infinite if there is none. Where `gradient` is null, none is needed from
/// now on.
template <class Density>
double search_line(Objective<Density>& objective, const Field& uvs, double before, double slope,
                   const PolishOptions& options, Fields& fields, Field* gradient, double& length,
                   const Work& work) {
  if (!gradient && options.history == 0) parallel_free(work, fields.gradient);
  double after = kInfinity;
  const auto takes_step = [&](double step) {
    fields.trial.resize(uvs.size());
    parallel_for(work, size_of(uvs), kGrain, [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t i = begin; i < end; ++i) {
        fields.trial[i] = uvs[i] + step * fields.direction[i];
      }
    });
    after =
        gradient ? objective.evaluate(fields.trial, *gradient) : objective.measure(fields.trial);
    return falls_enough(before, after, step, slope) &&
           (!options.contact || options.contact->is_simple(fields.trial));
  };
  return slope < 0 && backtrack(length, takes_step) ? after : kInfinity;
}

/// Whether the gains tell of an end: the last step was a full one with little gain, or the last
/// ones had next to none, since what touches shortens nearly all of them.
struct Settling {
  bool settled = false;
  int little_gains = 0;

  /// `scale`: what gains are compared with.
  void see(double gain, double length, double scale, const PolishOptions& options) {
    const bool next_to_nothing = gain <= options.stationary * scale;
    little_gains = options.contact && next_to_nothing ? little_gains + 1 : 0;
    settled =
        (length >= kFullStep && gain <= options.tolerance * scale) || little_gains >= kPatience;
  }
};

/// Of the map at the start; with contact, where it is asked for and the map has no infinite energy.
template <class Density>
double evaluate_start(Objective<Density>& objective, const Field& uvs, const PolishOptions& options,
                      Field& gradient) {
  const double start = objective.evaluate(uvs, gradient);
  if (!options.contact || !std::isfinite(start)) return start;
  objective.set_contact(options.contact);
  return objective.evaluate(uvs, gradient);
}

template <class Density>
PolishResult descend(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                     const Precondition& precondition, Field& uvs, const PolishOptions& options,
                     Fields& fields, const Work& work) {
  Objective<Density> objective(size_of(uvs), mesh.faces, rest, work);
  PolishResult result;
  // Not structured bindings, which clang does not let lambdas capture.
  const bool remembers = options.history > 0;
  Field &gradient = fields.gradient, &direction = fields.direction, &trial = fields.trial;
  Field& next_gradient = remembers ? fields.next_gradient : gradient;
  result.energies.push_back(evaluate_start(objective, uvs, options, gradient));
  if (!std::isfinite(result.energies.back())) return result;
  History history(options.history, work);
  bool rigidly = true;  // whether faces may be held back alone
  Settling settling;
  while (result.iterations() < options.max_iterations && !work.out_of_time()) {
    work.report(static_cast<double>(result.iterations()) / options.max_iterations);
    const double before = result.energies.back(), scale = comparable_energy<Density>(before);
    history.find_direction(gradient, precondition, trial, direction);
    const double alone =
        options.last ? continue_step(gradient, direction, *options.last, work) : kInfinity;
    const bool continues = alone < kInfinity;
    if (options.enough > 0) {
      result.predicted = std::min(alone, -dot(gradient, direction, work));
      result.converged = result.predicted >= 0 && 0.5 * result.predicted < options.enough * scale;
      if (result.converged) break;
    }
    double length = hold_back(mesh, uvs, rigidly, options.near, direction, result, work);
    const double slope = dot(gradient, direction, work);
    result.predicted = std::min(alone, -slope);
    result.converged = settling.settled && result.predicted >= 0 &&
                       0.5 * result.predicted <= options.stationary * scale;
    if (result.converged) break;
    if (length < (result.iterations() > 0 ? kFullStep : options.shortest_first)) {
      if (continues) {
        options.last->step.clear();
        continue;
      }
      result.blocked = true;
      break;
    }
    length = before_touch(options.contact, uvs, direction, length);
    // The only step needs no other gradient, unless it is tried again.
    const bool is_only = options.max_iterations == 1 && !options.contact;
    const double after = search_line(objective, uvs, before, slope, options, fields,
                                     is_only ? nullptr : &next_gradient, length, work);
    if (!(after < before)) {
      const bool plain = history.empty() && !continues && (!rigidly || result.blocking.empty());
      result.blocked = plain;
      if (plain) break;
      history.clear();
      if (continues) options.last->step.clear();
      rigidly = false;
      if (!remembers) objective.evaluate(uvs, gradient);  // that of the last trial is there
      continue;
    }
    rigidly = true;
    uvs.swap(trial);
    result.energies.push_back(after);
    if (options.last) keep_step(length, direction, *options.last, work);
    if (is_only) break;
    // What nearly singular faces do to the gradient says nothing about other steps.
    if (length >= kFullStep && result.blocking.empty()) {
      history.add(length, direction, gradient, next_gradient);
    }
    if (remembers) gradient.swap(next_gradient);
    settling.see(before - after, length, scale, options);
  }
  return result;
}

}  // namespace

PolishResult polish(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                    const Precondition& precondition, std::vector<Vec2>& uvs,
                    const PolishOptions& options, const Work& work) {
  Fields fields;
  PolishResult result = with_density(options.energy, [&]<class Density>(Density) {
    return descend<Density>(mesh, rest, precondition, uvs, options, fields, work);
  });
  // What the allocator kept of them would be there beside what the caller needs next.
  for (Field* field : {&fields.gradient, &fields.next_gradient, &fields.direction, &fields.trial}) {
    parallel_free(work, *field);
  }
  return result;
}

}  // namespace beltrami
