// The model of a map: nothing is strained where nothing has to be, real maps have about its energy,
// and candidates are judged as if they were taken.
#include "cut/elastic_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "base/portable_math.h"
#include "base/vectors.h"
#include "cut/edge_marks.h"
#include "cut/known_maps.h"
#include "cut/local_maps.h"
#include "cut/open_minimal.h"
#include "cut/seam_costs.h"
#include "cut/seam_tree.h"
#include "support/cuts.h"
#include "support/meshes.h"
#include "support/solids.h"
#include "support/surfaces.h"

namespace beltrami {
namespace {

using meshes::random_below;
using meshes::TriangleList;

Surface built(const TriangleList& mesh) {
  return build_surface(mesh.positions, mesh.faces, Work(1));
}

/// Per vertex, false but for these.
std::vector<bool> only(const Surface& surface, const std::vector<Index>& vertices) {
  std::vector<bool> is(surface.positions.size(), false);
  for (const Index v : vertices) is[v] = true;
  return is;
}

/// Closed and open, with handles, in pieces.
std::vector<TriangleList> surfaces() {
  return {disks::blob(3),
          meshes::torus(10),
          meshes::shaken(meshes::double_torus(8), 0.05, 1),
          meshes::bumps(14, 12),
          meshes::torus_with_hole(9),
          meshes::together({disks::blob(2), meshes::torus(8), meshes::bumps(8, 8)})};
}

/// A vertex inside of every component, and more of them at random.
std::vector<bool> random_pins(const Surface& surface, Index chance, std::mt19937_64& generator) {
  const Topology topology = topology_of(surface, Work(1));
  std::vector<bool> pinned(surface.positions.size(), false);
  for (const Component& component : topology.components) {
    pinned[surface.faces[component.first_face][0]] = true;
  }
  for (Index v = 0; v < surface.vertex_count(); ++v) {
    if (random_below(generator, chance) == 0) pinned[v] = true;
  }
  return pinned;
}

std::vector<Index> picked(const Surface& surface, const std::vector<bool>& is_wanted,
                          const std::vector<bool>& pinned, bool of_pinned, Index most,
                          std::mt19937_64& generator) {
  std::vector<Index> found;
  for (const Index v : meshes::shuffled(surface.vertex_count(), generator())) {
    if (size_of(found) == most) break;
    if (is_wanted[v] && pinned[v] == of_pinned && !surface.on_boundary[v]) found.push_back(v);
  }
  return found;
}

/// Of about such a mean.
std::vector<double> random_excess(const Surface& surface, double mean, std::mt19937_64& generator) {
  std::vector<double> excess;
  for (std::size_t v = 0; v < surface.positions.size(); ++v) {
    const double share = 2 * mean / static_cast<double>(surface.positions.size());
    excess.push_back(share * random_below(generator, 1000) / 1000);
  }
  return excess;
}

TEST(ElasticModel, NothingIsStressedAtPins) {
  std::mt19937_64 generator(1);
  for (const TriangleList& mesh : surfaces()) {
    const Surface surface = built(mesh);
    ElasticModel model(surface, surface.face_count(), Work(1));
    const std::vector<bool> pinned = random_pins(surface, 10, generator);
    model.pin(pinned);
    double greatest = 0;
    for (const double x : model.stress()) greatest = std::max(greatest, std::abs(x));
    for (Index v = 0; v < surface.vertex_count(); ++v) {
      if (!pinned[v] && !surface.on_boundary[v]) continue;
      EXPECT_LE(std::abs(model.stress()[v]), 1e-5 * greatest);
    }
    EXPECT_GT(greatest, 1e-5);
    EXPECT_GT(model.energy(), 2 + 1e-5);
  }
}

/// With a vertex in every fourth face, next to a corner or to an edge of it.
TriangleList with_slivers(TriangleList mesh, double near) {
  const Index count = size_of(mesh.faces);
  for (Index f = 0; f < count; f += 4) {
    const auto [a, b, c] = mesh.faces[f];
    const std::vector<Vec3>& p = mesh.positions;
    const double of_b = f % 8 == 0 ? near : 0.5;
    const Vec3 place = (1 - near - of_b) * p[a] + of_b * p[b] + near * p[c];
    const Index v = size_of(mesh.positions);
    mesh.positions.push_back(place);
    mesh.faces[f] = {a, b, v};
    mesh.faces.push_back({b, c, v});
    mesh.faces.push_back({c, a, v});
  }
  return mesh;
}

TEST(ElasticModel, SliversDoNotStiffenIt) {
  const TriangleList mesh = disks::blob(4);
  const auto energy = [](const TriangleList& of) {
    const Surface surface = built(of);
    ElasticModel model(surface, surface.face_count(), Work(1));
    model.pin(only(surface, {0, surface.faces[0][1]}));
    return model.energy();
  };
  const double excess = energy(mesh) - 2;
  ASSERT_GT(excess, 0.1);
  for (const double near : {1e-3, 1e-5, 1e-7}) {
    EXPECT_NEAR((energy(with_slivers(mesh, near)) - 2) / excess, 1, 0.1) << near;
  }
}

TEST(ElasticModel, WhatIsFlatOrDevelopableIsNotDistorted) {
  const TriangleList cylinder = meshes::moved(meshes::grid(12, 9), [](const Vec3& p) {
    return Vec3(portable::cos(4 * p.x()), portable::sin(4 * p.x()), p.y());
  });
  for (const TriangleList& mesh : {meshes::fan(9), meshes::grid(12, 9), cylinder}) {
    const Surface surface = built(mesh);
    ElasticModel model(surface, surface.face_count(), Work(1));
    model.pin(only(surface, {}));
    EXPECT_NEAR(model.energy(), 2, 1e-9);
  }
}

TEST(ElasticModel, AConeIsDistortedUnlessItsTipIsPinned) {
  TriangleList mesh = meshes::fan(8);
  mesh.positions[0].z() = 1;
  const Surface surface = built(disks::refined(mesh, 3));
  ElasticModel model(surface, surface.face_count(), Work(1));
  model.pin(only(surface, {}));
  EXPECT_GT(model.energy(), 2.01);
  EXPECT_EQ(*std::max_element(model.stress().begin(), model.stress().end()), model.stress()[0]);
  model.pin(only(surface, {0}));
  EXPECT_NEAR(model.energy(), 2, 1e-6);
}

/// The energy of a cone, and the greatest stress.
std::pair<double, double> of_cone(Index spokes) {
  TriangleList mesh = meshes::fan(spokes);
  mesh.positions[0].z() = 1;
  const Surface surface = built(disks::refined(mesh, 2));
  ElasticModel model(surface, surface.face_count(), Work(1));
  model.pin(only(surface, {}));
  return {model.energy(), *std::max_element(model.stress().begin(), model.stress().end())};
}

// With dense rows the largest would take minutes.
TEST(ElasticModel, AHubIsJudgedAsIsAVertexOfLessNeighbours) {
  const auto [energy, stress] = of_cone(100);
  for (const Index spokes : {200, 8000}) {
    const auto [of_hub, at_hub] = of_cone(spokes);
    EXPECT_NEAR(of_hub - 2, energy - 2, 0.01 * (energy - 2));
    EXPECT_NEAR(at_hub, stress, 0.01 * stress);
  }
}

TEST(ElasticModel, MorePinsAreJudgedAsIfTheyWereThere) {
  std::mt19937_64 generator(2);
  for (const TriangleList& mesh : surfaces()) {
    const Surface surface = built(mesh);
    ElasticModel model(surface, surface.face_count(), Work(1));
    for (int trial = 0; trial < 4; ++trial) {
      std::vector<bool> pinned = random_pins(surface, 30, generator);
      model.pin(pinned);
      if (trial > 1) model.calibrate(random_excess(surface, 0.1, generator));
      const std::vector<bool> all(pinned.size(), true);
      const auto more = picked(surface, all, pinned, false, 1 + 3 * trial, generator);
      const ModelChange with = model.with(more);
      const std::size_t half = more.size() / 2;
      for (std::size_t i = half; i < more.size(); ++i) pinned[more[i]] = true;
      model.pin(pinned);
      EXPECT_NEAR(with.energy_of(half, more.size() - half), model.energy(), 1e-6);
      for (const Index v : more) pinned[v] = true;
      model.pin(pinned);
      EXPECT_NEAR(with.energy(), model.energy(), 1e-6);
    }
  }
}

TEST(ElasticModel, FewerPinsAreJudgedAsIfTheyWereGone) {
  std::mt19937_64 generator(3);
  for (const TriangleList& mesh : surfaces()) {
    const Surface surface = built(mesh);
    ElasticModel model(surface, surface.face_count(), Work(1));
    for (int trial = 0; trial < 4; ++trial) {
      // Neighbours among them, and some that stay.
      std::vector<bool> pinned = random_pins(surface, 3, generator);
      std::vector<bool> wanted(pinned.size(), true);
      for (const Component& component : topology_of(surface, Work(1)).components) {
        wanted[surface.faces[component.first_face][0]] = false;
      }
      model.pin(pinned);
      if (trial > 1) model.calibrate(random_excess(surface, 0.1, generator));
      const auto gone = picked(surface, wanted, pinned, true, 1 + 5 * trial, generator);
      const ModelChange without = model.without(gone);
      const std::size_t half = gone.size() / 2;
      for (std::size_t i = 0; i < half; ++i) pinned[gone[i]] = false;
      model.pin(pinned);
      EXPECT_NEAR(without.energy_of(0, half), model.energy(), 1e-6);
      for (const Index v : gone) pinned[v] = false;
      model.pin(pinned);
      EXPECT_NEAR(without.energy(), model.energy(), 1e-6);
    }
  }
}

TEST(ElasticModel, AChangeThatRoundingHasSpoiltPromisesNothing) {
  const Eigen::VectorXd load = Eigen::VectorXd::Constant(2, 0.1);
  DenseMatrix spoilt(2, 2);
  spoilt << 1, 2, 2, 1;
  EXPECT_EQ(ModelChange(2.5, load, spoilt, -1).energy(), 2.5);
  EXPECT_EQ(ModelChange(2.5, load, spoilt, 1).energy(), std::numeric_limits<double>::infinity());
  const double sound = 2 * 0.1 * 0.1;
  EXPECT_DOUBLE_EQ(ModelChange(2.5, load, spoilt, -1).energy_of(1, 1), 2.5 - sound);
  EXPECT_DOUBLE_EQ(ModelChange(2.5, load, spoilt, 1).energy_of(1, 1), 2.5 + sound);
}

TEST(ElasticModel, PinsThatAreTakenBackLeaveNoTrace) {
  std::mt19937_64 generator(4);
  for (const TriangleList& mesh : surfaces()) {
    const Surface surface = built(mesh);
    ElasticModel model(surface, surface.face_count(), Work(1));
    const std::vector<bool> one = random_pins(surface, 20, generator);
    const std::vector<bool> other = random_pins(surface, 30, generator);
    model.pin(one);
    const std::vector<double> stress = model.stress();
    const double energy = model.energy();
    using Pins = std::vector<std::vector<bool>>;
    for (const Pins& tried : {Pins{other}, Pins{one}, Pins{other, one, other},
                              Pins{other, random_pins(surface, 5, generator)}}) {
      for (const std::vector<bool>& pinned : tried) model.pin(pinned);
      model.pin(one);
      EXPECT_EQ(model.stress(), stress);
      EXPECT_EQ(model.energy(), energy);
    }
  }
}

TEST(ElasticModel, RealMapsHaveAboutItsEnergy) {
  const TriangleList mesh = disks::blob(4);
  const Surface surface = built(mesh);
  EdgeMarks seams = open_minimal(surface, topology_of(surface, Work(1)), {}, Work(1));
  const std::vector<double> cost = edge_lengths(surface, Work(1));
  SeamTree search(surface, surface.face_count(), cost, std::move(seams), 0, 0.02, Work(1));
  KnownMaps known;
  for (const double energy : {2.1, 2.05, 2.02}) {
    search.extend(energy);
    const LocalMaps maps =
        map_locally(surface, surface.face_count(), search.seams(), 1e-4, nullptr, known, Work(1));
    EXPECT_NEAR((maps.energy - 2) / (search.energy() - 2), 1, 0.2) << energy;
  }
}

TEST(ElasticModel, LearnsWhereMapsCostMore) {
  TriangleList cone = meshes::fan(8);
  cone.positions[0].z() = 1;
  cone = disks::refined(cone, 3);
  const TriangleList other =
      meshes::moved(cone, [](const Vec3& p) { return Vec3(p + Vec3(9, 0, 0)); });
  const Surface surface = built(meshes::together({cone, other}));
  const Index tips[] = {0, size_of(cone.positions)};
  ElasticModel model(surface, surface.face_count(), Work(1));
  model.pin(only(surface, {}));
  const auto gain = [&](int i) {
    return model.energy() - model.with(std::vector(1, tips[i])).energy();
  };
  const double before = gain(0);
  EXPECT_NEAR(gain(1), before, 1e-6);
  // Three times as much at the one as at the other.
  std::vector<double> excess(surface.positions.size());
  for (Index v = 0; v < surface.vertex_count(); ++v) {
    excess[v] = (v < tips[1] ? 1.5 : 0.5) * (model.energy() - 2) / surface.vertex_count();
  }
  model.calibrate(excess);
  EXPECT_GT(gain(0), 1.4 * gain(1));
  EXPECT_GT(gain(0), 0.5 * before);
}

TEST(ElasticModel, LearnsNothingFromNothing) {
  // As of maps without distortion, or without a face that has area.
  const Surface surface = built(disks::blob(2));
  ElasticModel model(surface, surface.face_count(), Work(1));
  model.pin(only(surface, {0}));
  const std::vector<double> nothing(surface.positions.size(), 0);
  for (int i = 0; i < 30; ++i) {
    model.calibrate(nothing);
    EXPECT_TRUE(std::isfinite(model.energy()));
    EXPECT_GE(model.energy(), 2);
  }
}

TEST(ElasticModel, SizeDoesNotMatter) {
  for (const TriangleList& mesh : surfaces()) {
    const auto energy = [&](double scale) {
      const Surface surface =
          built(meshes::moved(mesh, [&](const Vec3& p) { return Vec3(scale * p); }));
      std::mt19937_64 generator(4);
      ElasticModel model(surface, surface.face_count(), Work(1));
      model.pin(random_pins(surface, 20, generator));
      model.calibrate(random_excess(surface, 0.1, generator));
      return model.energy();
    };
    EXPECT_NEAR(energy(1), energy(1000), 1e-9);
    EXPECT_EQ(energy(1), energy(0x1p-30));
  }
}

TEST(ElasticModel, VirtualFacesWeighNothing) {
  // A flat grid with a spike, the foot of which is pinned. The faces of the spike are the last.
  TriangleList mesh = meshes::grid(16, 16);
  const auto from_spike = [&](Index v) {
    const Vec3 way = mesh.positions[v] - Vec3(0.75, 0.75, 0);
    return std::max(std::abs(way.x()), std::abs(way.y()));
  };
  const auto is_flat = [&](const Triangle& face) {
    return std::all_of(face.begin(), face.end(), [&](Index v) { return from_spike(v) > 0.12; });
  };
  const auto spike = std::stable_partition(mesh.faces.begin(), mesh.faces.end(), is_flat);
  const auto real_faces = static_cast<Index>(spike - mesh.faces.begin());
  std::vector<bool> foot(mesh.positions.size(), false);
  for (Index v = 0; v < size_of(mesh.positions); ++v) {
    foot[v] = from_spike(v) > 0.12 && from_spike(v) < 0.13;
    if (from_spike(v) < 0.12) mesh.positions[v].z() = from_spike(v) < 0.01 ? 0.6 : 0.3;
  }
  const Surface surface = built(mesh);
  const auto energy = [&](Index faces) {
    ElasticModel model(surface, faces, Work(1));
    model.pin(foot);
    return model.energy();
  };
  EXPECT_GT(energy(surface.face_count()), 2 + 1e-3);
  EXPECT_LT(energy(real_faces) - 2, 0.01 * (energy(surface.face_count()) - 2));
}

TEST(ElasticModel, VerticesWithoutFacesDoNothing) {
  const TriangleList mesh = disks::blob(2);
  const auto energy = [](const TriangleList& of, Index pin) {
    const Surface surface = built(of);
    ElasticModel model(surface, surface.face_count(), Work(1));
    model.pin(only(surface, {pin}));
    return model.energy();
  };
  EXPECT_NEAR(energy(meshes::with_unused_in_front(mesh, 3), 3), energy(mesh, 0), 1e-6);
}

}  // namespace
}  // namespace beltrami
