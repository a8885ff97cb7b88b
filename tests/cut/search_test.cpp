// Seams that are searched for a distortion.
#include "cut/search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "admit/fill.h"
#include "cut/cut_into_charts.h"
#include "exact/certificate.h"
#include "mesh/disk_mesh.h"
#include "support/cuts.h"
#include "support/disks.h"
#include "support/meshes.h"
#include "support/solids.h"
#include "support/surfaces.h"

namespace beltrami {
namespace {

using meshes::TriangleList;

/// Costs are lengths.
constexpr SeamWeights kLengths{.concavity = 0, .visibility = 0, .hard_edges = 1, .materials = 1};

/// A surface of about unit area, as a search is to be given one.
Surface built(TriangleList mesh) {
  normalise(mesh.positions, mesh.faces, Work(1));
  return build_surface(std::move(mesh.positions), std::move(mesh.faces), Work(1));
}

SearchedSeams searched(const Surface& surface, double energy, const EdgeMarks& locked = {},
                       int threads = 1, const SeamWeights& weights = {}) {
  return search_seams(surface, surface.face_count(), topology_of(surface, Work(1)), locked,
                      {.energy = energy}, weights, {}, {}, Work(threads));
}

double length(const Surface& surface, const EdgeMarks& marks) {
  const std::vector<double> lengths = edge_lengths(surface, Work(1));
  double sum = 0;
  for (Index h = 0; h < size_of(lengths); ++h) {
    if (marks[h] && surface.edge(h) == h) sum += lengths[h];
  }
  return sum;
}

/// How many disks seams leave; nothing else is left.
std::size_t charts(const Surface& surface, const EdgeMarks& seams) {
  EXPECT_EQ(seams.size(), surface.twin.size());
  const CutSurface cut = cut_into_charts(surface, seams, Work(1));
  EXPECT_TRUE(cut.non_disks.empty());
  return cut.charts.size();
}

/// Between faces 2 i and 2 i + 1, which are one cell of a grid.
EdgeMarks diagonals(const Surface& surface) {
  EdgeMarks marks(surface.twin.size(), false);
  for (Index h = 0; h < size_of(marks); ++h) {
    marks[h] = surface.twin[h] != kNone && h / 6 == surface.twin[h] / 6;
  }
  return marks;
}

const TriangleList kTetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};

std::vector<TriangleList> small_surfaces() {
  return {meshes::triangle(),
          kTetrahedron,
          meshes::octahedron(),
          meshes::cube(),
          meshes::sphere(2),
          disks::blob(3),
          meshes::torus(3),
          meshes::torus(8),
          meshes::double_torus(7),
          meshes::annulus(6),
          meshes::torus_with_hole(6),
          meshes::bumps(9, 9),
          disks::spike(6),
          disks::ramp(24, 3),
          meshes::together({meshes::torus(5), disks::blob(2), meshes::grid(4, 4), kTetrahedron})};
}

TEST(Search, LeavesDisksOfWhateverThereIs) {
  for (const TriangleList& mesh : small_surfaces()) {
    const Surface surface = built(mesh);
    const std::size_t least = topology_of(surface, Work(1)).components.size();
    for (const double energy : {2.01, 2.1, 10.0}) {
      SCOPED_TRACE(testing::Message() << surface.face_count() << " faces for " << energy);
      const SearchedSeams found = searched(surface, energy);
      EXPECT_GE(charts(surface, found.seams), least);
      EXPECT_GE(found.energy, 2 - 1e-9);
      if (testing::Test::HasFailure()) return;
    }
  }
}

TEST(Search, TheMapsHaveTheEnergyAskedForAndNotMuchLess) {
  for (const TriangleList& mesh : {meshes::sphere(4), meshes::torus(24), disks::blob(4)}) {
    const Surface surface = built(mesh);
    for (const double energy : {2.05, 2.01}) {
      const SearchedSeams found = searched(surface, energy);
      EXPECT_LE(found.energy, energy);
      EXPECT_GE(found.energy, 2 + 0.5 * (energy - 2));
      EXPECT_EQ(charts(surface, found.seams), 1);
    }
  }
}

TEST(Search, LessDistortionIsNotToBeHadForShorterSeams) {
  for (const TriangleList& mesh : {meshes::sphere(3), meshes::torus(14), meshes::bumps(14, 14)}) {
    const Surface surface = built(mesh);
    double shortest = 0;
    for (const double energy : {3.0, 2.2, 2.05, 2.01}) {
      const double own = length(surface, searched(surface, energy, {}, 1, kLengths).seams);
      EXPECT_GE(own, 0.999 * shortest);
      shortest = std::max(shortest, own);
    }
    EXPECT_GT(shortest, 0.5);
  }
}

TEST(Search, WhatIsADiskAndFlatEnoughStaysWhole) {
  for (const TriangleList& mesh : {meshes::grid(6, 5), meshes::cap(6, 12, 0.3)}) {
    const Surface surface = built(mesh);
    EXPECT_EQ(length(surface, searched(surface, 2.05).seams), 0);
  }
}

TEST(Search, PartsWhatLiesOnItselfInTheMap) {
  const Surface surface = built(disks::ramp(48, 6));
  const SearchedSeams found = searched(surface, 2.01);
  const CutSurface cut = cut_into_charts(surface, found.seams, Work(1));
  ASSERT_EQ(cut.charts.size(), found.maps.size());
  for (std::size_t c = 0; c < cut.charts.size(); ++c) {
    const DiskMesh& mesh = cut.charts[c].mesh;
    EXPECT_TRUE(certify(mesh.faces, mesh.boundary, found.maps[c], Work(1)).injective());
  }
  EXPECT_GT(length(surface, found.seams), 0);
  EXPECT_LE(found.energy, 2.01);
  EXPECT_LT(length(surface, found.seams), 0.5);
}

TEST(Search, LockedEdgesStayUncut) {
  for (const TriangleList& mesh : {meshes::cube(), meshes::torus(9), meshes::torus(46),
                                   meshes::bumps(10, 10), disks::ramp(24, 3)}) {
    const Surface surface = built(mesh);
    const EdgeMarks locked = diagonals(surface);
    for (const double energy : {2.02, 2.5}) {
      const EdgeMarks seams = searched(surface, energy, locked).seams;
      charts(surface, seams);
      for (std::size_t h = 0; h < seams.size(); ++h) EXPECT_FALSE(locked[h] && seams[h]);
    }
  }
}

TEST(Search, FilledHolesWeighNothing) {
  TriangleList mesh = meshes::sphere(4);
  for (const Index f : {1900, 1000, 300}) mesh.faces.erase(mesh.faces.begin() + f);
  Surface open = built(mesh);
  const Topology topology = topology_of(open, Work(1));
  const FilledSurface filled = fill_holes(std::move(open), topology, 0.5, Work(1));
  ASSERT_EQ(filled.filled_loops, 3);
  const SearchedSeams found =
      search_seams(filled.surface, filled.real_faces, topology_of(filled.surface, Work(1)), {},
                   {.energy = 2.05}, {}, {}, {}, Work(1));
  EXPECT_EQ(charts(filled.surface, found.seams), 1);
  EXPECT_LE(found.energy, 2.05);
}

TEST(Search, TheSameBitsAtOneThreadAndAtTwo) {
  const Surface surface = built(meshes::together({disks::blob(3), meshes::torus(9)}));
  for (const double energy : {2.05, 2.005}) {
    const SearchedSeams one = searched(surface, energy);
    for (const int threads : {2, 3}) {
      const SearchedSeams more = searched(surface, energy, {}, threads);
      EXPECT_EQ(one.seams, more.seams);
      EXPECT_EQ(one.energy, more.energy);
    }
  }
}

TEST(Search, CarriesTheSeamsOfACoarseSurfaceToTheFineOne) {
  // Finer than what seams are decided on.
  const Surface surface = built(meshes::torus(82));
  ASSERT_GT(surface.face_count(), 13'000);
  const SearchedSeams found = searched(surface, 2.05);
  EXPECT_EQ(charts(surface, found.seams), 1);
  EXPECT_LE(found.energy, 2.05);
}

TEST(Search, GoesOnFromWhatWasFoundForAnotherTarget) {
  const Surface surface = built(meshes::torus(82));
  const auto go_on = [&](double energy, const BegunSearch& begun) {
    return search_seams(surface, surface.face_count(), topology_of(surface, Work(1)), {},
                        {.energy = energy}, kLengths, {}, begun, Work(1));
  };
  const SearchedSeams found = go_on(2.05, {});
  ASSERT_FALSE(found.search.seams.seams.empty());
  for (const double energy : {2.03, 2.08}) {
    const SearchedSeams other = go_on(energy, found.search);
    EXPECT_EQ(other.search.level, found.search.level);  // not simplified again
    EXPECT_EQ(charts(surface, other.seams), 1);
    EXPECT_LE(other.energy, energy);
    EXPECT_GE(other.energy, 2 + 0.8 * (energy - 2));
    EXPECT_EQ(length(surface, other.seams) > length(surface, found.seams), energy < 2.05);
  }
}

TEST(Search, LockedEdgesStayUncutWhereTheSurfaceIsSimplified) {
  const Surface surface = built(meshes::torus(82));
  const EdgeMarks locked = diagonals(surface);
  const EdgeMarks seams = searched(surface, 2.05, locked).seams;
  EXPECT_EQ(charts(surface, seams), 1);
  for (std::size_t h = 0; h < seams.size(); ++h) EXPECT_FALSE(locked[h] && seams[h]);
}

}  // namespace
}  // namespace beltrami
