#include "flatten/v_cycle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/parallel.h"
#include "linear/spd_solver.h"
#include "mesh/boundary.h"

namespace beltrami {
namespace {

constexpr std::int64_t kGrain = 1024;
constexpr std::int64_t kBlock = 64;  // faces whose stiffness is rounded at a time
/// Parts of the fine vertices whose shares of a coarse field are summed apart, then together.
constexpr std::int64_t kParts = 8;

double dot(const SingleField& a, const SingleField& b, const Work& work) {
  return parallel_sum(work, size_of(a), kGrain, [&](std::int64_t begin, std::int64_t end) {
    double sum = 0;
    for (std::int64_t i = begin; i < end; ++i) sum += double{a[i].dot(b[i])};
    return sum;
  });
}

/// Sets coarse = P^T fine, where P interpolates.
template <class Value>
void restrict_to(const std::vector<Footpoint>& points, const std::vector<Triangle>& faces,
                 const std::vector<Value>& fine, const Value& zero, std::vector<Value>& coarse,
                 const Work& work) {
  const auto count = static_cast<std::int64_t>(points.size());
  const std::int64_t grain = (count + kParts - 1) / kParts;
  std::vector<std::vector<Value>> parts(kParts);
  parallel_for(work, count, grain, [&](std::int64_t begin, std::int64_t end) {
    std::vector<Value>& part = parts[begin / grain];
    part.assign(coarse.size(), zero);
    for (std::int64_t v = begin; v < end; ++v) {
      const Footpoint& at = points[v];
      const Triangle corners = at.corners(faces);
      part[corners[0]] += at.first_share() * fine[v];
      part[corners[1]] += at.shares[0] * fine[v];
      part[corners[2]] += at.shares[1] * fine[v];
    }
  });
  parallel_for(work, size_of(coarse), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t c = begin; c < end; ++c) {
      Value sum = zero;
      for (const std::vector<Value>& part : parts) {
        if (!part.empty()) sum += part[c];
      }
      coarse[c] = sum;
    }
  });
}

}  // namespace

struct VCycle::Level {
  Level(const DiskMesh& disk, std::vector<Footpoint> on_coarser, const DiskMesh& coarser_disk,
        const Work& work)
      : mesh(disk),
        coarser(coarser_disk),
        points(std::move(on_coarser)),
        smoother(disk, work),
        coarse_rhs(coarser.vertex_count()),
        coarse_x(coarser.vertex_count()) {}

  const DiskMesh &mesh, &coarser;
  std::vector<Footpoint> points;
  Smoother smoother;
  SingleField spare;
  SingleField coarse_rhs, coarse_x;  ///< of the level below
};

VCycle::VCycle(const DiskMesh& mesh, const std::vector<EdgeWeights>& stiffness,
               Index most_for_hessian, const Work& work)
    : work_(work),
      coarsest_(mesh),
      most_for_hessian_(most_for_hessian),
      coarsest_stiffness_(stiffness),
      factor_(mesh, stiffness, only_first_of_boundary(mesh), {.precision = Precision::kSingle}, {},
              work) {}

VCycle::~VCycle() = default;

const DiskMesh& VCycle::finest() const {
  return levels_.empty() ? coarsest_ : levels_.back()->mesh;
}

bool VCycle::take_hessian(Energy energy, const std::vector<RestTriangle>& rest,
                          const std::vector<Vec2>& uvs) {
  if (finest().face_count() > most_for_hessian_) return false;
  if (hessian_ && hessian_level_ == levels_.size()) {
    if (!hessian_->fit(energy, rest, uvs)) hessian_.reset();
    return hessian_ != nullptr;
  }
  auto own = std::make_unique<HessianFactor>(finest(), work_);
  if (!own->fit(energy, rest, uvs)) return false;
  hessian_ = std::move(own);
  hessian_level_ = levels_.size();
  return true;
}

void VCycle::settle() {
  if (hessian_) hessian_->settle();
}

void VCycle::add(const DiskMesh& mesh, std::vector<Footpoint> points) {
  levels_.push_back(std::make_unique<Level>(mesh, std::move(points), finest(), work_));
}

const std::vector<Footpoint>& VCycle::points() const {
  return levels_.back()->points;
}

void VCycle::set(const std::vector<SingleWeights>& weights, const std::vector<double>& springs) {
  std::vector<float> single;
  for (const double spring : springs) single.push_back(static_cast<float>(spring));
  Level& finest = *levels_.back();
  finest.smoother.set(finest.mesh, weights, single);
  if (single.empty() && !has_springs_) return;
  has_springs_ = !single.empty();
  single.resize(finest.mesh.positions.size(), 0);
  set_springs_below(levels_.size() - 1, single);
}

void VCycle::anchor(const std::vector<bool>& vertices) {
  Smoother& finest = levels_.back()->smoother;
  std::vector<float> springs(vertices.size(), 0);
  for (std::size_t v = 0; v < springs.size(); ++v) {
    if (!vertices[v]) continue;
    springs[v] =
        static_cast<float>(kStiffSpring) * std::abs(finest.stiffness(static_cast<Index>(v)));
  }
  finest.set_springs(springs);
  has_springs_ = true;
  set_springs_below(levels_.size() - 1, springs);
}

/// The springs of a level, and what they are on those below it.
void VCycle::set_springs_below(std::size_t level, const std::vector<float>& springs) {
  std::vector<float> below(levels_[level]->coarse_rhs.size());
  restrict_to(levels_[level]->points, levels_[level]->coarser.faces, springs, 0.0F, below, work_);
  if (level > 0) {
    levels_[level - 1]->smoother.set_springs(below);
    set_springs_below(level - 1, below);
    return;
  }
  factor_.refit(coarsest_stiffness_, {below.begin(), below.end()});
  hessian_.reset();  // it knows nothing of springs
}

void VCycle::refit(const StiffnessOfFaces& stiffness, const std::vector<double>& springs) {
  if (levels_.empty()) return;
  std::vector<SingleWeights> weights;
  parallel_assign(work_, weights, levels_.back()->mesh.faces.size());
  parallel_for(work_, size_of(weights), kGrain, [&](std::int64_t begin, std::int64_t end) {
    std::array<EdgeWeights, kBlock> block;
    for (std::int64_t first = begin; first < end; first += kBlock) {
      const std::int64_t last = std::min(end, first + kBlock);
      stiffness(first, last, block.data());
      for (std::int64_t f = first; f < last; ++f) {
        for (int k = 0; k < 3; ++k) weights[f][k] = static_cast<float>(block[f - first][k]);
      }
    }
  });
  set(weights, springs);
  parallel_free(work_, weights);
}

template <class Factor, class Rhs>
void VCycle::solve_with(Factor& factor, const std::vector<Rhs>& rhs, SingleField& x) {
  solve_rhs_.resize(rhs.size());
  parallel_for(work_, size_of(rhs), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t v = begin; v < end; ++v) solve_rhs_[v] = rhs[v].template cast<double>();
  });
  factor.precondition(solve_rhs_, solve_x_);
  x.resize(rhs.size());
  parallel_for(work_, size_of(rhs), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t v = begin; v < end; ++v) x[v] = solve_x_[v].cast<float>();
  });
}

/// x = about the inverse of a level's Laplacian, or of its Hessian where there is one, times rhs;
/// level 0 is the coarsest.
template <class Rhs>
void VCycle::apply(std::size_t level, const std::vector<Rhs>& rhs, bool by_hessian,
                   SingleField& x) {
  if (by_hessian && hessian_ && level == hessian_level_) return solve_with(*hessian_, rhs, x);
  if (level == 0) return solve_with(factor_, rhs, x);
  Level& l = *levels_[level - 1];
  l.smoother.sweep_forward(rhs, x);
  l.smoother.residual_after_forward(x, l.spare);
  restrict_to(l.points, l.coarser.faces, l.spare, Eigen::Vector2f(0, 0), l.coarse_rhs, work_);
  apply(level - 1, l.coarse_rhs, by_hessian, l.coarse_x);
  parallel_for(work_, size_of(x), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t v = begin; v < end; ++v) {
      x[v] += interpolated(l.points[v], l.coarser.faces, l.coarse_x);
    }
  });
  l.smoother.sweep_backward(rhs, x, l.spare);
}

void VCycle::precondition(const std::vector<Vec2>& rhs, std::vector<Vec2>& x) {
  SingleField result;
  apply(levels_.size(), rhs, true, result);
  if (!levels_.empty()) parallel_free(work_, levels_.back()->spare);
  x.resize(rhs.size());
  parallel_for(work_, size_of(rhs), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t v = begin; v < end; ++v) x[v] = result[v].cast<double>();
  });
}

void VCycle::improve(int most, const std::function<bool(int step)>& enough, SingleField& residual,
                     std::vector<Vec2>& uvs) {
  const Level& finest = *levels_.back();
  const auto add_up = [&](auto&& body) {
    parallel_for(work_, size_of(uvs), kGrain, [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t v = begin; v < end; ++v) body(v);
    });
  };
  SingleField z, direction;
  double before = 0;
  for (int step = 0; step < most; ++step) {
    apply(levels_.size(), residual, false, z);
    const double now = dot(residual, z, work_);
    if (step == 0) {
      parallel_copy(work_, z, direction);
    } else {
      const auto beta = static_cast<float>(now / before);
      add_up([&](std::int64_t v) { direction[v] = z[v] + beta * direction[v]; });
    }
    before = now;
    SingleField& product = z;  // in its place
    finest.smoother.multiply(direction, product);
    const double curvature = dot(direction, product, work_);
    if (!(now > 0) || !(curvature > 0)) return;
    const double length = now / curvature;
    add_up([&](std::int64_t v) {
      uvs[v] += length * direction[v].cast<double>();
      residual[v] -= static_cast<float>(length) * product[v];
    });
    if (enough(step + 1)) return;
  }
}

}  // namespace beltrami
