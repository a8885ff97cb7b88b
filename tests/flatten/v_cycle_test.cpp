// The smoother and the V-cycle against the matrices that they stand for.
#include "flatten/v_cycle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "energy/energy.h"
#include "flatten/laplacian.h"
#include "flatten/metric.h"
#include "prolong/interpolation.h"
#include "simplify/coarse.h"
#include "simplify/simplify.h"
#include "support/disks.h"
#include "support/meshes.h"

namespace beltrami {
namespace {

SingleField random_field(Index count, std::uint64_t seed) {
  disks::Random random(seed);
  SingleField field;
  Eigen::Vector2f sum(0, 0);
  for (Index i = 0; i < count; ++i) {
    field.emplace_back(static_cast<float>(random.between(-1, 1)),
                       static_cast<float>(random.between(-1, 1)));
    sum += field.back();
  }
  for (Eigen::Vector2f& x : field) x -= sum / static_cast<float>(count);
  return field;
}

double dot(const SingleField& a, const SingleField& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += double{a[i].dot(b[i])};
  return sum;
}

std::vector<SingleWeights> single(const std::vector<EdgeWeights>& weights) {
  std::vector<SingleWeights> result;
  for (const EdgeWeights& w : weights) {
    result.emplace_back(static_cast<float>(w[0]), static_cast<float>(w[1]),
                        static_cast<float>(w[2]));
  }
  return result;
}

/// Bumps with the stiffness of its flat map, on levels of about 9,000, 1,100 and 150 faces, the
/// Hessian of it on some of them.
struct Cycle {
  enum class Hessian { kNone, kOfCoarsest, kOfMiddle, kOfBoth };
  static constexpr Index kMostForHessian = 5000;

  explicit Cycle(int threads, Hessian hessian = Hessian::kNone)
      : work(threads),
        fine(disks::disk(meshes::bumps(67, 67))),
        middle(simplify(fine, 1100, work)),
        coarse(simplify(middle.mesh, 150, work)),
        cycle(coarse.mesh, stiffness(coarse.mesh), kMostForHessian, work) {
    if (hessian == Hessian::kOfCoarsest || hessian == Hessian::kOfBoth) take_hessian(coarse.mesh);
    add(coarse, middle.mesh);
    cycle.set(single(stiffness(middle.mesh)), {});
    if (hessian == Hessian::kOfMiddle || hessian == Hessian::kOfBoth) take_hessian(middle.mesh);
    add(middle, fine);
    cycle.set(single(stiffness(fine)), {});
  }

  std::vector<EdgeWeights> stiffness(const DiskMesh& mesh) const {
    return energy_stiffness(Energy::kSymmetricDirichlet, mesh.faces, disks::rest_of(mesh),
                            disks::flat_uvs(mesh), work);
  }
  bool take_hessian(const DiskMesh& mesh) {
    return cycle.take_hessian(Energy::kSymmetricDirichlet, disks::rest_of(mesh),
                              disks::flat_uvs(mesh));
  }
  void add(const CoarseDisk& below, const DiskMesh& mesh) {
    cycle.add(mesh, footpoints(below.mesh, below.fine_vertex, below.nearby, mesh, work));
  }

  Work work;
  DiskMesh fine;
  CoarseDisk middle, coarse;
  VCycle cycle;
};

std::vector<Vec2> doubled(const SingleField& field) {
  std::vector<Vec2> result;
  for (const Eigen::Vector2f& x : field) result.push_back(x.cast<double>());
  return result;
}

double dot(const std::vector<Vec2>& a, const std::vector<Vec2>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i].dot(b[i]);
  return sum;
}

TEST(Smoother, MultipliesAsTheSumOverTheFaces) {
  const DiskMesh mesh = disks::disk(meshes::bumps(9, 9));
  std::vector<SingleWeights> weights;
  disks::Random random(3);
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const auto first = static_cast<float>(random.unit()),
               second = static_cast<float>(random.unit());
    weights.emplace_back(first, second, static_cast<float>(random.unit()));
  }
  std::vector<float> springs(mesh.positions.size(), 0.25F);
  Smoother smoother(mesh, Work(1));
  smoother.set(mesh, weights, springs);
  const SingleField x = random_field(mesh.vertex_count(), 5);
  SingleField product, expected(x.size(), Eigen::Vector2f(0, 0));
  smoother.multiply(x, product);
  for (Index f = 0; f < mesh.face_count(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const Index a = mesh.faces[f][next_corner(k)], b = mesh.faces[f][previous_corner(k)];
      expected[a] += weights[f][k] * (x[a] - x[b]);
      expected[b] += weights[f][k] * (x[b] - x[a]);
    }
  }
  for (std::size_t v = 0; v < x.size(); ++v) {
    EXPECT_LE((product[v] - expected[v] - 0.25F * x[v]).norm(), 1e-5F) << v;
  }
}

TEST(Smoother, SweepsAreAdjointAndLeaveTheResidualThatTheySay) {
  const Cycle levels(1);
  Smoother smoother(levels.fine, Work(1));
  smoother.set(levels.fine, single(levels.stiffness(levels.fine)), {});
  const SingleField a = random_field(levels.fine.vertex_count(), 1);
  const SingleField b = random_field(levels.fine.vertex_count(), 2);
  SingleField forward, residual, product, backward(b.size(), Eigen::Vector2f(0, 0)), spare;
  smoother.sweep_forward(a, forward);
  smoother.sweep_backward(b, backward, spare);
  const double left = dot(forward, b), right = dot(a, backward);
  EXPECT_NEAR(left, right, 1e-4 * std::abs(left));
  smoother.residual_after_forward(forward, residual);
  smoother.multiply(forward, product);
  for (std::size_t v = 0; v < a.size(); ++v) {
    EXPECT_LE((a[v] - product[v] - residual[v]).norm(), 1e-4F) << v;
  }
}

TEST(VCycle, IsSymmetricAndDefinite) {
  Cycle levels(1);
  const auto a = doubled(random_field(levels.fine.vertex_count(), 1));
  const auto b = doubled(random_field(levels.fine.vertex_count(), 2));
  std::vector<Vec2> of_a, of_b;
  levels.cycle.precondition(a, of_a);
  levels.cycle.precondition(b, of_b);
  EXPECT_GT(dot(a, of_a), 0);
  EXPECT_GT(dot(b, of_b), 0);
  EXPECT_NEAR(dot(of_a, b), dot(a, of_b), 1e-3 * std::sqrt(dot(a, of_a) * dot(b, of_b)));
}

TEST(VCycle, ASmoothSolutionIsFoundInAFewSteps) {
  Cycle levels(1);
  Smoother smoother(levels.fine, Work(1));
  smoother.set(levels.fine, single(levels.stiffness(levels.fine)), {});
  SingleField wanted, residual;
  for (const Vec3& p : levels.fine.positions) {
    wanted.emplace_back(static_cast<float>(std::sin(3 * p.x())), static_cast<float>(p.y()));
  }
  smoother.multiply(wanted, residual);
  const double before = dot(residual, wanted);
  std::vector<Vec2> found(wanted.size(), Vec2::Zero());
  levels.cycle.improve(
      4, [](int) { return false; }, residual, found);
  SingleField error;
  for (std::size_t v = 0; v < found.size(); ++v)
    error.push_back(wanted[v] - found[v].cast<float>());
  SingleField product;
  smoother.multiply(error, product);
  EXPECT_LE(dot(error, product), 1e-3 * before);
}

TEST(VCycle, HasTheSameBitsAtAnyNumberOfThreads) {
  Cycle one(1), two(2);
  const auto rhs = doubled(random_field(one.fine.vertex_count(), 7));
  std::vector<Vec2> x, y;
  one.cycle.precondition(rhs, x);
  two.cycle.precondition(rhs, y);
  EXPECT_EQ(x, y);
}

TEST(VCycle, IsSymmetricAndDefiniteWithTheHessianOfALevelToo) {
  Cycle plain(1);
  const auto a = doubled(random_field(plain.fine.vertex_count(), 1));
  const auto b = doubled(random_field(plain.fine.vertex_count(), 2));
  std::vector<Vec2> without;
  plain.cycle.precondition(a, without);
  for (const auto hessian : {Cycle::Hessian::kOfCoarsest, Cycle::Hessian::kOfMiddle}) {
    Cycle levels(1, hessian);
    std::vector<Vec2> of_a, of_b;
    levels.cycle.precondition(a, of_a);
    levels.cycle.precondition(b, of_b);
    EXPECT_NE(of_a, without);
    EXPECT_GT(dot(a, of_a), 0);
    EXPECT_GT(dot(b, of_b), 0);
    EXPECT_NEAR(dot(of_a, b), dot(a, of_b), 1e-3 * std::sqrt(dot(a, of_a) * dot(b, of_b)));
  }
}

TEST(VCycle, TheHessianOfAFinerLevelTakesThePlaceOfThatOfACoarserOne) {
  Cycle both(1, Cycle::Hessian::kOfBoth), middle(1, Cycle::Hessian::kOfMiddle);
  const auto rhs = doubled(random_field(both.fine.vertex_count(), 4));
  std::vector<Vec2> x, y;
  both.cycle.precondition(rhs, x);
  middle.cycle.precondition(rhs, y);
  EXPECT_EQ(x, y);
}

TEST(VCycle, TakesNoHessianOfALevelOfMoreFacesThanItMay) {
  Cycle levels(1);
  ASSERT_GT(levels.fine.face_count(), Cycle::kMostForHessian);
  const auto rhs = doubled(random_field(levels.fine.vertex_count(), 4));
  std::vector<Vec2> before, after;
  levels.cycle.precondition(rhs, before);
  EXPECT_FALSE(levels.take_hessian(levels.fine));
  levels.cycle.precondition(rhs, after);
  EXPECT_EQ(before, after);
}

// As at the edge of what double precision holds.
TEST(VCycle, KeepsTheHessianOfACoarserLevelWhereOneOfItsOwnHasNoFactor) {
  const Cycle levels(1);
  const CoarseDisk& below = levels.coarse;
  const DiskMesh& middle = levels.middle.mesh;
  VCycle cycle(below.mesh, levels.stiffness(below.mesh), middle.face_count(), Work(1));
  ASSERT_TRUE(cycle.take_hessian(Energy::kSymmetricDirichlet, disks::rest_of(below.mesh),
                                 disks::flat_uvs(below.mesh)));
  cycle.add(middle, footpoints(below.mesh, below.fine_vertex, below.nearby, middle, Work(1)));
  cycle.set(single(levels.stiffness(middle)), {});
  const auto rhs = doubled(random_field(middle.vertex_count(), 4));
  std::vector<Vec2> before, after;
  cycle.precondition(rhs, before);
  std::vector<Vec2> uvs = disks::flat_uvs(middle);
  for (Vec2& uv : uvs) uv *= 1e-200;
  EXPECT_FALSE(cycle.take_hessian(Energy::kSymmetricDirichlet, disks::rest_of(middle), uvs));
  cycle.precondition(rhs, after);
  EXPECT_EQ(before, after);
}

TEST(VCycle, GivesTheHessianUpForSprings) {
  Cycle with(1, Cycle::Hessian::kOfCoarsest), without(1);
  std::vector<double> springs(with.fine.positions.size(), 0);
  springs[with.fine.boundary.front()] = 1e6;
  const auto rhs = doubled(random_field(with.fine.vertex_count(), 9));
  std::vector<Vec2> x, y;
  for (Cycle* levels : {&with, &without}) {
    levels->cycle.set(single(levels->stiffness(levels->fine)), springs);
    levels->cycle.precondition(rhs, levels == &with ? x : y);
  }
  EXPECT_EQ(x, y);
}

TEST(VCycle, SpringsAreTakenOffOnEveryLevel) {
  Cycle with(1), without(1);
  std::vector<double> springs(with.fine.positions.size(), 1e6);
  const auto rhs = doubled(random_field(with.fine.vertex_count(), 9));
  std::vector<Vec2> x, y;
  with.cycle.set(single(with.stiffness(with.fine)), springs);
  for (Cycle* levels : {&with, &without}) {
    levels->cycle.set(single(levels->stiffness(levels->fine)), {});
    levels->cycle.precondition(rhs, levels == &with ? x : y);
  }
  EXPECT_EQ(x, y);
}

TEST(VCycle, SpringsHoldOnEveryLevel) {
  Cycle levels(1);
  std::vector<double> springs(levels.fine.positions.size(), 0);
  const Index held = levels.fine.boundary.front();
  springs[held] = 1e6;
  levels.cycle.set(single(levels.stiffness(levels.fine)), springs);
  const auto rhs = doubled(random_field(levels.fine.vertex_count(), 9));
  std::vector<Vec2> x;
  levels.cycle.precondition(rhs, x);
  double most = 0;
  for (const Vec2& v : x) most = std::max(most, v.norm());
  EXPECT_LE(x[held].norm(), 1e-3 * most);
}

}  // namespace
}  // namespace beltrami
