// Newton with contact of the boundary, on disks that cover themselves at their free minimum.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "descend/assembly.h"
#include "descend/contact.h"
#include "descend/newton.h"
#include "descend/tutte.h"
#include "energy/energy.h"
#include "exact/certificate.h"
#include "mesh/boundary.h"
#include "mesh/disk_mesh.h"
#include "mesh/rest_shape.h"
#include "support/cuts.h"
#include "support/disks.h"
#include "support/meshes.h"

namespace beltrami {
namespace {

constexpr Energy kEnergies[] = {Energy::kSymmetricDirichlet, Energy::kSymmetricArap,
                                Energy::kExponentialDirichlet};

struct NamedDisk {
  std::string name;
  DiskMesh mesh;
};

std::vector<NamedDisk> overlapping_disks() {
  const meshes::TriangleList blob = disks::blob(4);
  return {{"slit saddle", disks::disk(disks::slit_saddle(10, 0.25))},
          {"steep slit saddle", disks::disk(disks::slit_saddle(12, 0.5))},
          {"opened blob", disks::disk(disks::opened(blob, disks::seams_through(blob, 24)))},
          {"blob of many seams", disks::disk(disks::opened(blob, disks::seams_through(blob, 60)))}};
}

struct Minimum {
  NewtonResult result;
  std::vector<Vec2> uvs;
};

Minimum minimise(const DiskMesh& mesh, std::vector<Vec2> uvs, const NewtonOptions& options,
                 int threads = 1) {
  Minimum minimum{{}, std::move(uvs)};
  minimum.result = minimise_energy(mesh.faces, disks::rest_of(mesh), only_first_of_boundary(mesh),
                                   minimum.uvs, options, Work(threads));
  return minimum;
}

std::vector<Vec2> start_of(const DiskMesh& mesh, Energy energy) {
  std::vector<Vec2> uvs = tutte_embedding(mesh, Work(1));
  const double scale = best_scale(energy, mesh.faces, disks::rest_of(mesh), uvs, Work(1));
  for (Vec2& w : uvs) w *= scale;
  return uvs;
}

/// The last simple map on the way to the free minimum, and that minimum.
struct Way {
  std::vector<Vec2> start;
  double free_energy;
};

Way way_to_the_free_minimum(const DiskMesh& mesh, const BoundaryContact& contact,
                            NewtonOptions options) {
  const std::vector<Vec2> tutte = start_of(mesh, options.energy);
  const double free_energy = minimise(mesh, tutte, options).result.energies.back();
  options.admissible = [&](const std::vector<Vec2>& map) { return contact.is_simple(map); };
  const Minimum refused = minimise(mesh, tutte, options);
  EXPECT_TRUE(refused.result.refused) << "does not cover itself";
  EXPECT_TRUE(contact.is_simple(refused.result.admitted));
  return {refused.result.admitted, free_energy};
}

/// Calls test(name, mesh, contact, options, way) for every disk and energy.
template <class Test>
void for_each_overlap(const Test& test) {
  for (const auto& [name, mesh] : overlapping_disks()) {
    const std::vector<double> lengths = boundary_lengths(mesh);
    const BoundaryContact contact(mesh.boundary, lengths, lengths);
    for (const Energy energy : kEnergies) {
      NewtonOptions options;
      options.energy = energy;
      const Way way = way_to_the_free_minimum(mesh, contact, options);
      options.contact = &contact;
      test(name + ", energy " + std::to_string(static_cast<int>(energy)), mesh, contact, options,
           way);
    }
  }
}

TEST(MinimiseEnergyWithContact, KeepsTheBoundarySimpleAndEndsNearTheFreeMinimum) {
  for_each_overlap([](const std::string& where, const DiskMesh& mesh,
                      const BoundaryContact& contact, NewtonOptions options, const Way& way) {
    int judged = 0, crossing = 0;
    options.admissible = [&](const std::vector<Vec2>& map) {
      ++judged;
      crossing += !contact.is_simple(map);
      return true;
    };
    for (const auto& start : {way.start, start_of(mesh, options.energy)}) {
      const Minimum minimum = minimise(mesh, start, options);
      const double energy = to_dirichlet(options.energy, minimum.result.energies.back());
      EXPECT_TRUE(minimum.result.converged) << where;
      EXPECT_TRUE(certify(mesh.faces, mesh.boundary, minimum.uvs, Work(1)).injective()) << where;
      EXPECT_LE(energy, 1.05 * to_dirichlet(options.energy, way.free_energy)) << where;
      EXPECT_LE(energy, to_dirichlet(options.energy, minimum.result.energies.front())) << where;
    }
    EXPECT_GT(judged, 2) << where;
    EXPECT_EQ(crossing, 0) << where;
  });
}

TEST(MinimiseEnergyWithContact, LowersTheEnergyWithItsBarrierInEveryStep) {
  for_each_overlap([](const std::string& where, const DiskMesh& mesh,
                      const BoundaryContact& contact, NewtonOptions options, const Way& way) {
    std::vector<std::vector<Vec2>> maps;
    options.admissible = [&](const std::vector<Vec2>& map) {
      maps.push_back(map);
      return true;
    };
    const NewtonResult result = minimise(mesh, way.start, options).result;
    ASSERT_EQ(maps.size(), result.energies.size()) << where;
    BoundaryContact fitted = contact;
    const double area = surface_area(mesh, Work(1));
    for (std::size_t k = 0; k + 1 < maps.size(); ++k) {
      fitted.fit(maps[k], to_dirichlet(options.energy, result.energies[k]));
      const auto objective = [&](std::size_t i) {
        return result.energies[i] + fitted.strength() / area * fitted.energy(maps[i]);
      };
      EXPECT_LT(objective(k + 1), objective(k)) << where << ", step " << k;
    }
  });
}

/// But for what the barrier presses.
TEST(MinimiseEnergyWithContact, EndsNearTheBestScale) {
  for_each_overlap([](const std::string& where, const DiskMesh& mesh, const BoundaryContact&,
                      const NewtonOptions& options, const Way& way) {
    const Minimum minimum = minimise(mesh, way.start, options);
    const auto rest = disks::rest_of(mesh);
    EXPECT_NEAR(best_scale(options.energy, mesh.faces, rest, minimum.uvs, Work(1)), 1, 2e-3)
        << where;
  });
}

/// Per vertex: by how much a Newton step of it alone would lower the mean energy, without contact.
std::vector<double> gains_alone(Energy energy, const DiskMesh& mesh, const std::vector<Vec2>& uvs) {
  const auto rest = disks::rest_of(mesh);
  std::vector<Vec2> gradient(uvs.size(), Vec2::Zero());
  std::vector<Eigen::Matrix2d> hessian(uvs.size(), Eigen::Matrix2d::Zero());
  with_density(energy, [&](const auto& density) {
    for (Index f = 0; f < mesh.face_count(); ++f) {
      const Triangle& t = mesh.faces[f];
      FaceModels models;
      give_face_models(
          mesh.faces, rest, uvs, f, f + 1, density, [](auto) { return 1.0; }, models);
      const FaceModel model = models.at(0);
      for (int k = 0; k < 3; ++k) {
        gradient[t[k]] += rest[f].area() * model.gradient.segment<2>(2 * k);
        hessian[t[k]] += rest[f].area() * model.hessian.block<2, 2>(2 * k, 2 * k);
      }
    }
  });
  std::vector<double> gains;
  for (std::size_t v = 0; v < uvs.size(); ++v) {
    gains.push_back(0.5 * gradient[v].dot(hessian[v].inverse() * gradient[v]) /
                    surface_area(mesh, Work(1)));
  }
  return gains;
}

TEST(MinimiseEnergyWithContact, HoldsNoVertexThatNothingPressesOn) {
  for_each_overlap([](const std::string& where, const DiskMesh& mesh,
                      const BoundaryContact& contact, NewtonOptions options, const Way& way) {
    if (options.energy == Energy::kSymmetricArap) return;  // not smooth
    options.tolerance = 1e-12;
    const Minimum minimum = minimise(mesh, way.start, options);
    std::vector<bool> pressed(minimum.uvs.size(), false);
    const std::vector<Contact> contacts = contact.find(minimum.uvs);
    EXPECT_FALSE(contacts.empty()) << where;
    for (const Contact& c : contacts) pressed[c.vertex] = pressed[c.from] = pressed[c.to] = true;
    const std::vector<double> gains = gains_alone(options.energy, mesh, minimum.uvs);
    double held = 0, free = 0;
    int free_on_boundary = 0;
    for (std::size_t v = 0; v < gains.size(); ++v) {
      (pressed[v] ? held : free) += gains[v];
      free_on_boundary += mesh.on_boundary[v] && !pressed[v];
    }
    EXPECT_GT(free_on_boundary, size_of(mesh.boundary) / 5) << where;
    EXPECT_LE(free, 1e-9) << where;
    EXPECT_GT(held, 1e3 * free) << where;
  });
}

TEST(MinimiseEnergyWithContact, HasTheSameBitsOnTwoAndThreeThreads) {
  for_each_overlap([](const std::string& where, const DiskMesh& mesh, const BoundaryContact&,
                      const NewtonOptions& options, const Way& way) {
    const Minimum one = minimise(mesh, way.start, options);
    for (const int threads : {2, 3}) {
      const Minimum more = minimise(mesh, way.start, options, threads);
      EXPECT_EQ(more.uvs, one.uvs) << where;
      EXPECT_EQ(more.result.energies, one.result.energies) << where;
    }
  });
}

TEST(MinimiseEnergyWithContact, ChangesNothingWhereNothingIsNear) {
  for (const auto& list : {meshes::cap(6, 16, 2.0), meshes::bumps(8, 8)}) {
    const DiskMesh mesh = disks::disk(list);
    const std::vector<double> lengths = boundary_lengths(mesh);
    const BoundaryContact contact(mesh.boundary, lengths, lengths);
    NewtonOptions options;
    options.proxy_steps = 0;  // contact does without
    const Minimum without = minimise(mesh, start_of(mesh, options.energy), options);
    options.contact = &contact;
    const Minimum with = minimise(mesh, start_of(mesh, options.energy), options);
    EXPECT_EQ(with.uvs, without.uvs);
    EXPECT_EQ(with.result.energies, without.result.energies);
  }
}

}  // namespace
}  // namespace beltrami
