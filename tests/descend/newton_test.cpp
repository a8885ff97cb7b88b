// Tutte's start and projected Newton: injective, monotone, and no early stop.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "descend/assembly.h"
#include "descend/line_search.h"
#include "descend/newton.h"
#include "descend/tutte.h"
#include "energy/energy.h"
#include "exact/certificate.h"
#include "mesh/disk_mesh.h"
#include "support/disks.h"
#include "support/meshes.h"

namespace beltrami {
namespace {

using disks::Random;

constexpr Energy kEnergies[] = {Energy::kSymmetricDirichlet, Energy::kSymmetricArap,
                                Energy::kExponentialDirichlet};

/// Disks of every kind that is small.
std::vector<meshes::TriangleList> small_disks() {
  return {meshes::triangle(),      meshes::quad(),       meshes::fan(3),
          meshes::fan(12),         meshes::grid(6, 5),   meshes::bumps(8, 8),
          meshes::cap(5, 12, 2.5), meshes::strip(20),    disks::dumbbell(4),
          disks::spike(8),         disks::slivers(6, 6), disks::degenerate_faces(8),
          disks::slit(3),          disks::punctured(2)};
}

bool all_positive(const DiskMesh& mesh, const std::vector<Vec2>& uvs) {
  return non_positive_faces(mesh.faces, uvs, Work(1)).empty();
}

double signed_area(const Vec2& a, const Vec2& b, const Vec2& c) {
  return 0.5 * ((b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x()));
}

double mean_energy(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                   const std::vector<Vec2>& uvs, Energy energy = Energy::kSymmetricDirichlet) {
  return with_density(energy, [&](const auto& density) {
    double sum = 0, area = 0;
    for (Index f = 0; f < mesh.face_count(); ++f) {
      const Triangle& t = mesh.faces[f];
      const SingularValues s =
          singular_values(linear_map(rest[f], uvs[t[0]], uvs[t[1]], uvs[t[2]]));
      sum += rest[f].area() * density.value(s.s1, s.s2);
      area += rest[f].area();
    }
    return sum / area;
  });
}

std::vector<Vec2> scaled(std::vector<Vec2> uvs, double factor) {
  for (Vec2& w : uvs) w *= factor;
  return uvs;
}

double scale_of(const DiskMesh& mesh, const std::vector<Vec2>& uvs,
                Energy energy = Energy::kSymmetricDirichlet) {
  return best_scale(energy, mesh.faces, disks::rest_of(mesh), uvs, Work(1));
}

/// Tutte's embedding at its best scale.
std::vector<Vec2> start_of(const DiskMesh& mesh, Energy energy = Energy::kSymmetricDirichlet) {
  const std::vector<Vec2> uvs = tutte_embedding(mesh, Work(1));
  return scaled(uvs, scale_of(mesh, uvs, energy));
}

struct Minimum {
  NewtonResult result;
  std::vector<Vec2> uvs;
};

Minimum minimise(const DiskMesh& mesh, std::vector<Vec2> uvs, const NewtonOptions& options = {},
                 int threads = 1) {
  Minimum minimum{{}, std::move(uvs)};
  minimum.result = minimise_energy(mesh.faces, disks::rest_of(mesh),
                                   disks::only_fixed(mesh, mesh.boundary.front()), minimum.uvs,
                                   options, Work(threads));
  return minimum;
}

// ---- Tutte ----------------------------------------------------------------------------------

TEST(Tutte, IsExactlyInjectiveOnEveryKindOfDisk) {
  for (const auto& list : small_disks()) {
    const DiskMesh mesh = disks::disk(list);
    const std::vector<Vec2> uvs = tutte_embedding(mesh, Work(1));
    EXPECT_TRUE(certify(mesh.faces, mesh.boundary, uvs, Work(1)).injective())
        << mesh.face_count() << " faces";
  }
}

TEST(Tutte, PutsTheBoundaryOnACircleInItsOrderByArcLength) {
  const DiskMesh mesh = disks::disk(disks::slivers(4, 4));
  const std::vector<Vec2> uvs = tutte_embedding(mesh, Work(1));
  const double radius = std::sqrt(surface_area(mesh, Work(1)) / std::numbers::pi);
  double perimeter = 0, angle_sum = 0;
  const std::size_t count = mesh.boundary.size();
  std::vector<double> lengths, angles;
  for (std::size_t i = 0; i < count; ++i) {
    const Index a = mesh.boundary[i], b = mesh.boundary[(i + 1) % count];
    EXPECT_NEAR(uvs[a].norm(), radius, 1e-12 * radius);
    lengths.push_back((mesh.positions[b] - mesh.positions[a]).norm());
    angles.push_back(std::atan2(signed_area({0, 0}, uvs[a], uvs[b]) * 2, uvs[a].dot(uvs[b])));
    perimeter += lengths.back();
    angle_sum += angles.back();
  }
  EXPECT_NEAR(angle_sum, 2 * std::numbers::pi, 1e-12);  // once around, counter-clockwise
  for (std::size_t i = 0; i < count; ++i) {
    // Edges shorter than 1e-3 of the mean are lengthened, all others in proportion.
    EXPECT_NEAR(angles[i] / angle_sum, lengths[i] / perimeter, 1e-3 * lengths[i] / perimeter);
  }
}

TEST(Tutte, SeparatesBoundaryVerticesThatCoincide) {
  meshes::TriangleList list = meshes::grid(3, 3);
  list.positions[1] = list.positions[0];
  const DiskMesh mesh = disks::disk(list);
  const std::vector<Vec2> uvs = tutte_embedding(mesh, Work(1));
  EXPECT_GT((uvs[1] - uvs[0]).norm(), 0);
  EXPECT_TRUE(all_positive(mesh, uvs));
}

TEST(Tutte, PutsEveryInteriorVertexAtTheMeanOfItsNeighbours) {
  const DiskMesh mesh = disks::disk(meshes::cap(4, 9, 2.0));
  const std::vector<Vec2> uvs = tutte_embedding(mesh, Work(1));
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (mesh.on_boundary[v]) continue;
    Vec2 sum = Vec2::Zero();
    int valence = 0;
    mesh.for_each_outgoing(v, [&](Index h) {
      sum += uvs[mesh.target(h)];
      ++valence;
    });
    EXPECT_LE((uvs[v] - sum / valence).norm(), 1e-13);
  }
}

TEST(Tutte, FillsADiskOfTheAreaOfTheMesh) {
  const DiskMesh mesh = disks::disk(meshes::cap(20, 200, 1.2));
  const std::vector<Vec2> uvs = tutte_embedding(mesh, Work(1));
  double area = 0;
  for (const Triangle& t : mesh.faces) area += signed_area(uvs[t[0]], uvs[t[1]], uvs[t[2]]);
  EXPECT_NEAR(area, surface_area(mesh, Work(1)),
              1e-3 * area);  // a polygon of 200 corners, not the disk
}

TEST(BestScale, HasTheLeastEnergyOfAllScales) {
  for (const Energy energy : kEnergies) {
    for (const auto& list : small_disks()) {
      const DiskMesh mesh = disks::disk(list);
      const auto rest = disks::rest_of(mesh);
      const std::vector<Vec2> uvs = start_of(mesh, energy);
      const double least = mean_energy(mesh, rest, uvs, energy);
      EXPECT_LT(least, mean_energy(mesh, rest, scaled(uvs, 1.01), energy)) << mesh.face_count();
      EXPECT_LT(least, mean_energy(mesh, rest, scaled(uvs, 0.99), energy)) << mesh.face_count();
    }
  }
}

TEST(BestScale, UndoesAScale) {
  const DiskMesh mesh = disks::disk(meshes::grid(4, 4));
  for (const double s : {1e-6, 0.3, 1e5}) {
    const std::vector<Vec2> uvs = scaled(disks::flat_uvs(mesh), s);
    EXPECT_NEAR(
        best_scale(Energy::kSymmetricDirichlet, mesh.faces, disks::rest_of(mesh), uvs, Work(1)) * s,
        1, 1e-12);
  }
}

TEST(BestScale, IsOneWhereAFaceIsFlipped) {
  const DiskMesh mesh = disks::disk(meshes::quad());
  const std::vector<Vec2> uvs = {{0, 0}, {3, 0}, {3, 3}, {2, 1}};
  EXPECT_EQ(best_scale(Energy::kSymmetricDirichlet, mesh.faces, disks::rest_of(mesh), uvs, Work(1)),
            1);
}

// ---- Line search ----------------------------------------------------------------------------

double area_at(const Triangle& t, const std::vector<Vec2>& uvs, const std::vector<Vec2>& direction,
               double step) {
  return signed_area(uvs[t[0]] + step * direction[t[0]], uvs[t[1]] + step * direction[t[1]],
                     uvs[t[2]] + step * direction[t[2]]);
}

/// The first sign change of the area up to `end`, by scanning and bisecting; infinity if none.
double first_sign_change(const std::vector<Vec2>& uvs, const std::vector<Vec2>& direction,
                         double end) {
  constexpr int kSamples = 4000;
  const Triangle t{0, 1, 2};
  for (int i = 1; i <= kSamples; ++i) {
    double high = end * i / kSamples;
    if (area_at(t, uvs, direction, high) > 0) continue;
    double low = end * (i - 1) / kSamples;
    for (int k = 0; k < 200; ++k) {
      const double middle = 0.5 * (low + high);
      (area_at(t, uvs, direction, middle) > 0 ? low : high) = middle;
    }
    return high;
  }
  return std::numeric_limits<double>::infinity();
}

TEST(FirstSingularStep, IsWhereBisectionFindsItAtAnyScale) {
  Random random(1);
  int singular = 0;
  for (int i = 0; i < 300; ++i) {
    std::vector<Vec2> uvs = {random.vec2(), random.vec2(), random.vec2()};
    if (signed_area(uvs[0], uvs[1], uvs[2]) < 0) std::swap(uvs[1], uvs[2]);
    if (signed_area(uvs[0], uvs[1], uvs[2]) < 1e-3) continue;
    const std::vector<Vec2> direction = {random.vec2(), random.vec2(), random.vec2()};
    const double expected = first_sign_change(uvs, direction, 4);
    for (const double scale : {1.0, 1e-8, 1e8}) {
      const double step =
          first_singular_step({{0, 1, 2}}, scaled(uvs, scale), scaled(direction, scale), Work(1));
      if (std::isfinite(expected)) {
        EXPECT_NEAR(step, expected, 1e-9 * expected) << i << ' ' << scale;
      } else {
        // The scan can miss two roots next to each other, but no long negative stretch.
        const bool beyond = step > 3.99;
        EXPECT_TRUE(beyond || area_at({0, 1, 2}, uvs, direction, step) < 1e-6) << i;
      }
    }
    singular += std::isfinite(expected);
  }
  EXPECT_GT(singular, 100);
}

TEST(FirstSingularStep, IsInfiniteWhereNothingMovesOrEverythingGrows) {
  const std::vector<Vec2> uvs = {{0, 0}, {1, 0}, {0, 1}};
  constexpr double kNever = std::numeric_limits<double>::infinity();
  EXPECT_EQ(first_singular_step({{0, 1, 2}}, uvs, {{0, 0}, {0, 0}, {0, 0}}, Work(1)), kNever);
  EXPECT_EQ(first_singular_step({{0, 1, 2}}, uvs, {{5, 3}, {5, 3}, {5, 3}}, Work(1)), kNever);
  EXPECT_EQ(first_singular_step({{0, 1, 2}}, uvs, uvs, Work(1)), kNever);
}

TEST(FirstSingularStep, IsTheLeastOfAllFaces) {
  const std::vector<Vec2> uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  const std::vector<Vec2> direction = {{0, 0}, {0, 0}, {0, -4}, {0, -2}};
  // Vertex 2 reaches the height of the bottom at 1/4, vertex 3 that of face (0, 2, 3) later or
  // never.
  EXPECT_NEAR(first_singular_step({{0, 1, 2}, {0, 2, 3}}, uvs, direction, Work(1)), 0.25, 1e-15);
  EXPECT_NEAR(first_singular_step({{0, 2, 3}, {0, 1, 2}}, uvs, direction, Work(2)), 0.25, 1e-15);
}

TEST(FirstSingularStep, FindsADoubleRoot) {
  // Collapses to a point at 1 and unfolds on the other side with the same orientation.
  const std::vector<Vec2> uvs = {{0, 0}, {1, 0}, {0, 1}};
  EXPECT_NEAR(first_singular_step({{0, 1, 2}}, uvs, scaled(uvs, -1), Work(1)), 1, 1e-7);
}

TEST(FirstSingularStep, IsNeverNegative) {
  // Roundoff turns thin faces over that are positive by their singular values.
  const std::vector<Vec2> uvs = {{0, 0}, {1, 0}, {0.5, -1e-20}};
  const std::vector<Vec2> up = {{0, 0}, {0, 0}, {0, 1}};
  EXPECT_EQ(first_singular_step({{0, 1, 2}}, uvs, up, Work(1)),
            std::numeric_limits<double>::infinity());
  EXPECT_EQ(first_singular_step({{0, 1, 2}}, uvs, scaled(up, -1), Work(1)), 0);
}

// ---- Newton ---------------------------------------------------------------------------------

TEST(MinimiseEnergy, NeverRaisesAnEnergyAndNeverFlips) {
  for (const Energy energy : kEnergies) {
    for (const auto& list : small_disks()) {
      const DiskMesh mesh = disks::disk(list);
      for (const int proxy_steps : {0, 5}) {
        NewtonOptions options;
        options.energy = energy;
        options.proxy_steps = proxy_steps;
        const Minimum minimum = minimise(mesh, start_of(mesh, energy), options);
        const auto& energies = minimum.result.energies;
        const auto where = testing::Message()
                           << mesh.face_count() << " faces, energy " << static_cast<int>(energy)
                           << ", proxy steps " << proxy_steps;
        EXPECT_TRUE(std::is_sorted(energies.rbegin(), energies.rend())) << where;
        EXPECT_TRUE(all_positive(mesh, minimum.uvs)) << where;
        EXPECT_TRUE(minimum.result.converged) << where;
        const double measured = mean_energy(mesh, disks::rest_of(mesh), minimum.uvs, energy);
        EXPECT_NEAR(energies.back(), measured, 1e-9 * (1 + measured)) << where;
      }
    }
  }
}

TEST(MinimiseEnergy, StopsAtTheMinimumOfSymmetricArap) {
  for (const auto& list : {meshes::fan(12), meshes::grid(6, 5), meshes::cap(5, 12, 2.5)}) {
    const DiskMesh mesh = disks::disk(list);
    NewtonOptions options;
    options.energy = Energy::kSymmetricArap;
    const NewtonResult result = minimise(mesh, start_of(mesh, options.energy), options).result;
    EXPECT_TRUE(result.converged) << mesh.face_count();
    EXPECT_LT(result.iterations(), 100) << mesh.face_count();
  }
}

TEST(MinimiseEnergy, GivesTheLastAdmissibleMapWhereItIsRefusedAtTheEnd) {
  const DiskMesh mesh = disks::disk(meshes::cap(6, 16, 2.5));
  NewtonOptions two, guarded;
  two.max_iterations = 2;
  int judged = 0;
  guarded.admissible = [&](const std::vector<Vec2>&) { return ++judged <= 3; };
  const Minimum expected = minimise(mesh, start_of(mesh), two);
  const Minimum refused = minimise(mesh, start_of(mesh), guarded);
  EXPECT_TRUE(refused.result.refused);
  EXPECT_FALSE(refused.result.converged);
  EXPECT_EQ(refused.result.admitted, expected.uvs);
  // It ends once there is little hope, not at the first map that is not admissible.
  EXPECT_GT(refused.result.iterations(), 3);
  EXPECT_LT(refused.result.iterations(), minimise(mesh, start_of(mesh)).result.iterations());
  EXPECT_EQ(judged, 1 + refused.result.iterations());
}

TEST(MinimiseEnergy, GoesThroughMapsThatAreNotAdmissible) {
  const DiskMesh mesh = disks::disk(meshes::cap(6, 16, 2.5));
  NewtonOptions guarded;
  int judged = 0;
  guarded.admissible = [&](const std::vector<Vec2>&) { return ++judged > 3; };
  const Minimum expected = minimise(mesh, start_of(mesh));
  const Minimum admitted = minimise(mesh, start_of(mesh), guarded);
  EXPECT_FALSE(admitted.result.refused);
  EXPECT_TRUE(admitted.result.converged);
  EXPECT_TRUE(admitted.result.admitted.empty());
  EXPECT_EQ(admitted.uvs, expected.uvs);
}

TEST(MinimiseEnergy, AdmitsNothingWhereNothingIsAdmissible) {
  const DiskMesh mesh = disks::disk(meshes::cap(6, 16, 2.5));
  NewtonOptions guarded;
  guarded.admissible = [](const std::vector<Vec2>&) { return false; };
  const NewtonResult result = minimise(mesh, start_of(mesh), guarded).result;
  EXPECT_TRUE(result.refused);
  EXPECT_TRUE(result.admitted.empty());
}

TEST(MinimiseEnergy, EndsAtAnIsometryWhereThereIsOne) {
  for (const auto& list : {meshes::triangle(), meshes::quad(), meshes::fan(7), meshes::grid(8, 6),
                           meshes::strip(12), disks::slit(3)}) {
    const DiskMesh mesh = disks::disk(list);
    NewtonOptions options;
    options.tolerance = 1e-12;
    const Minimum minimum = minimise(mesh, start_of(mesh), options);
    EXPECT_NEAR(minimum.result.energies.back(), 2, 1e-9) << mesh.face_count();
    for (const Triangle& t : mesh.faces) {
      for (int k = 0; k < 3; ++k) {
        const Index a = t[k], b = t[next_corner(k)];
        const double length = (mesh.positions[b] - mesh.positions[a]).norm();
        EXPECT_NEAR((minimum.uvs[b] - minimum.uvs[a]).norm(), length, 1e-4 * length);
      }
    }
  }
}

TEST(MinimiseEnergy, ReachesTheSameMinimumWithAndWithoutProxySteps) {
  const DiskMesh mesh = disks::disk(meshes::cap(8, 24, 2.4));
  NewtonOptions with, without;
  with.tolerance = without.tolerance = 1e-10;
  without.proxy_steps = 0;
  const double e = minimise(mesh, start_of(mesh), with).result.energies.back();
  EXPECT_NEAR(minimise(mesh, start_of(mesh), without).result.energies.back(), e, 1e-6 * e);
}

TEST(MinimiseEnergy, EndsWhereTheEnergyIsStationary) {
  const DiskMesh mesh = disks::disk(meshes::bumps(8, 8));
  const auto rest = disks::rest_of(mesh);
  NewtonOptions options;
  options.tolerance = 1e-14;
  std::vector<Vec2> uvs = minimise(mesh, start_of(mesh), options).uvs;
  for (const Index v : {10, 40, 72}) {
    for (const Vec2& step : {Vec2(1e-5, 0), Vec2(0, 1e-5)}) {
      const Vec2 place = uvs[v];
      uvs[v] = place + step;
      const double ahead = mean_energy(mesh, rest, uvs);
      uvs[v] = place - step;
      const double behind = mean_energy(mesh, rest, uvs);
      uvs[v] = place;
      EXPECT_NEAR((ahead - behind) / 2e-5, 0, 1e-6);
    }
  }
}

// A tiny map has E ~ s^-2, where Newton's step multiplies s by 4/3, so that E falls by (3/4)^2: a
// step goes on as long as that pays, and E falls by (3/5)^2 at least.
TEST(MinimiseEnergy, LengthensStepsWhereTheModelPromisesTooLittle) {
  const DiskMesh mesh = disks::disk(meshes::grid(6, 6));
  NewtonOptions options;
  options.proxy_steps = 0;
  const Minimum minimum = minimise(mesh, scaled(disks::flat_uvs(mesh), 0.01), options);
  const auto& energies = minimum.result.energies;
  EXPECT_NEAR(energies.front(), 1e4, 1);
  for (std::size_t i = 0; energies[i] > 100; ++i) {
    ASSERT_LT(energies[i + 1] / energies[i], 0.37) << i;
  }
  EXPECT_NEAR(energies.back(), 2, 1e-3);
  EXPECT_TRUE(minimum.result.converged);
}

TEST(MinimiseEnergy, JumpsFromATinyMapToTheSurfaceInOneProxyStep) {
  const DiskMesh mesh = disks::disk(meshes::grid(6, 6));
  const Minimum minimum = minimise(mesh, scaled(disks::flat_uvs(mesh), 0.01));
  ASSERT_GT(minimum.result.energies.size(), 1u);
  EXPECT_NEAR(minimum.result.energies[1], 2, 1e-6);
}

// From E = 4e8: for dozens of steps hardly anything is gained, since nearly singular faces block
// them.
TEST(MinimiseEnergy, DoesNotStopOnTheTinyStepsOfABlockedStart) {
  const DiskMesh mesh = disks::disk(disks::tube(25, 6, 1));
  for (const int proxy_steps : {0, 5}) {
    NewtonOptions options;
    options.proxy_steps = proxy_steps;
    const NewtonResult result = minimise(mesh, start_of(mesh), options).result;
    EXPECT_GT(result.energies.front(), 1e8);
    EXPECT_LT(result.energies.back(), 40) << proxy_steps;
  }
}

// Without proxy steps five blocked steps in a row, at E = 1.8e16, once passed for convergence.
TEST(MinimiseEnergy, DoesNotTakeBlockedStepsForConvergence) {
  const DiskMesh mesh = disks::disk(disks::tube(60, 8, 0.7));
  NewtonOptions options;
  options.proxy_steps = 0;
  const NewtonResult result = minimise(mesh, start_of(mesh), options).result;
  EXPECT_TRUE(!result.converged || result.energies.back() < 1e3) << result.energies.back();
}

TEST(MinimiseEnergy, DoesNotMoveFixedVertices) {
  Random random(2);
  const DiskMesh mesh = disks::disk(meshes::bumps(8, 8));
  std::vector<bool> fixed(mesh.positions.size());
  for (std::size_t v = 0; v < fixed.size(); ++v) fixed[v] = random.below(4) == 0;
  const std::vector<Vec2> before = start_of(mesh);
  std::vector<Vec2> after = before;
  minimise_energy(mesh.faces, disks::rest_of(mesh), fixed, after, {}, Work(1));
  int moved = 0;
  for (std::size_t v = 0; v < fixed.size(); ++v) {
    if (fixed[v]) {
      EXPECT_EQ(after[v], before[v]);
    }
    moved += after[v] != before[v];
  }
  EXPECT_GT(moved, 0);
}

TEST(MinimiseEnergy, HasNothingToDoWhereAllVerticesAreFixed) {
  const DiskMesh mesh = disks::disk(meshes::quad());
  std::vector<Vec2> uvs = scaled(disks::flat_uvs(mesh), 2);
  const auto result = minimise_energy(mesh.faces, disks::rest_of(mesh), std::vector<bool>(4, true),
                                      uvs, {}, Work(1));
  EXPECT_TRUE(result.converged);
  EXPECT_EQ(result.iterations(), 0);
  EXPECT_EQ(uvs, scaled(disks::flat_uvs(mesh), 2));
}

TEST(MinimiseEnergy, KeepsToItsLimitOfSteps) {
  const DiskMesh mesh = disks::disk(meshes::cap(6, 16, 2.5));
  NewtonOptions options;
  options.max_iterations = 2;
  const NewtonResult result = minimise(mesh, start_of(mesh), options).result;
  EXPECT_EQ(result.iterations(), 2);
  EXPECT_FALSE(result.converged);
}

TEST(MinimiseEnergy, HasTheSameBitsOnTwoThreads) {
  const DiskMesh mesh = disks::disk(meshes::bumps(70, 70));
  NewtonOptions options;
  options.max_iterations = 8;
  const Minimum a = minimise(mesh, start_of(mesh), options, 1);
  const Minimum b = minimise(mesh, start_of(mesh), options, 2);
  EXPECT_EQ(a.uvs, b.uvs);
  EXPECT_EQ(a.result.energies, b.result.energies);
}

TEST(MinimiseEnergy, EndsWithAMapWhereTheTimeIsUp) {
  const DiskMesh mesh = disks::disk(meshes::cap(6, 16, 2.5));
  std::vector<Vec2> uvs = start_of(mesh);
  const NewtonResult result =
      minimise_energy(mesh.faces, disks::rest_of(mesh), disks::only_fixed(mesh, 0), uvs, {},
                      Work({.seconds = 1e-9}, nullptr));
  EXPECT_EQ(result.iterations(), 0);
  EXPECT_FALSE(result.converged);
  EXPECT_EQ(uvs, start_of(mesh));
}

TEST(MinimiseEnergy, IsCancelledByProgressThatThrows) {
  const DiskMesh mesh = disks::disk(meshes::cap(6, 16, 2.5));
  std::vector<Vec2> uvs = start_of(mesh);
  int calls = 0;
  const Work work({}, [&](double, const char*) {
    if (++calls == 3) throw std::runtime_error("stop");
    return false;
  });
  EXPECT_THROW(
      minimise_energy(mesh.faces, disks::rest_of(mesh), disks::only_fixed(mesh, 0), uvs, {}, work),
      std::runtime_error);
  EXPECT_EQ(calls, 3);
  EXPECT_TRUE(all_positive(mesh, uvs));
}

TEST(MinimiseEnergy, ReportsProgressThatNeverFalls) {
  const DiskMesh mesh = disks::disk(meshes::cap(6, 16, 2.5));
  std::vector<Vec2> uvs = start_of(mesh);
  std::vector<double> fractions;
  minimise_energy(mesh.faces, disks::rest_of(mesh), disks::only_fixed(mesh, 0), uvs, {},
                  Work({}, [&](double fraction, const char*) {
                    fractions.push_back(fraction);
                    return false;
                  }));
  ASSERT_FALSE(fractions.empty());
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  EXPECT_GE(fractions.front(), 0);
  EXPECT_LE(fractions.back(), 1);
}

}  // namespace
}  // namespace beltrami
