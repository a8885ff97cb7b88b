// Seams that are searched for a distortion.
#include "cut/search_seams.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "admit/fill.h"
#include "cut/cut_into_charts.h"
#include "cut/mirror.h"
#include "cut/mirrored_seams.h"
#include "cut/open_minimal.h"
#include "cut/search_effort.h"
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
const SearchEffort kNormal = search_effort(Effort::kNormal);
constexpr SeamWeights kLengths{.concavity = 0, .visibility = 0, .hard_edges = 1, .materials = 1};

/// A surface of about unit area, as a search is to be given one.
Surface built(TriangleList mesh) {
  normalise(mesh.positions, mesh.faces, Work(1));
  return build_surface(std::move(mesh.positions), std::move(mesh.faces), Work(1));
}

SearchedSeams searched(const Surface& surface, double energy, const EdgeMarks& locked = {},
                       int threads = 1, const SeamWeights& weights = {},
                       const SearchEffort& effort = kNormal) {
  return search_seams(surface, surface.face_count(), topology_of(surface, Work(1)), locked,
                      {.energy = energy}, effort, weights, {}, {}, Work(threads));
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
  // The last one is searched on a coarser surface.
  for (const TriangleList& mesh :
       {meshes::grid(6, 5), meshes::cap(6, 12, 0.3), meshes::cap(70, 120, 0.3)}) {
    const Surface surface = built(mesh);
    const SearchedSeams found = searched(surface, 2.05);
    EXPECT_EQ(length(surface, found.seams), 0);
    EXPECT_TRUE(found.maps.empty());  // it is mapped as any disk
  }
}

TEST(Search, PartsWhatLiesOnItselfInTheMap) {
  const Surface surface = built(disks::ramp(48, 6));
  const SearchedSeams found = searched(surface, 2.005);
  const CutSurface cut = cut_into_charts(surface, found.seams, Work(1));
  ASSERT_EQ(cut.charts.size(), found.maps.size());
  for (std::size_t c = 0; c < cut.charts.size(); ++c) {
    const DiskMesh& mesh = cut.charts[c].mesh;
    EXPECT_TRUE(certify(mesh.faces, mesh.boundary, found.maps[c], Work(1)).injective());
  }
  EXPECT_GT(length(surface, found.seams), 0);
  EXPECT_LE(found.energy, 2.005);
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
  ASSERT_EQ(filled.filled_loops, 2);  // the longest stays open
  const SearchedSeams found =
      search_seams(filled.surface, filled.real_faces, topology_of(filled.surface, Work(1)), {},
                   {.energy = 2.05}, kNormal, {}, {}, {}, Work(1));
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
  const SearchedSeams quick = searched(surface, 2.05, {}, 1, {}, search_effort(Effort::kQuick));
  EXPECT_EQ(charts(surface, quick.seams), 1);
  EXPECT_TRUE(quick.maps.empty());
  // And finishes them there.
  const SearchedSeams found = searched(surface, 2.05, {}, 1, {}, search_effort(Effort::kHigh));
  EXPECT_EQ(charts(surface, found.seams), 1);
  EXPECT_LE(found.energy, 2.05);
  ASSERT_EQ(found.maps.size(), 1);
  const CutSurface cut = cut_into_charts(surface, found.seams, Work(1));
  const DiskMesh& mesh = cut.charts[0].mesh;
  EXPECT_TRUE(certify(mesh.faces, mesh.boundary, found.maps[0], Work(1)).injective());
  EXPECT_GE(found.energy, 2.045);
}

TEST(Search, GoesOnFromWhatWasFoundForAnotherTarget) {
  const Surface surface = built(meshes::torus(82));
  const auto go_on = [&](double energy, const BegunSearch& begun) {
    return search_seams(surface, surface.face_count(), topology_of(surface, Work(1)), {},
                        {.energy = energy}, kNormal, kLengths, {}, begun, Work(1));
  };
  const SearchedSeams found = go_on(2.05, {});
  ASSERT_FALSE(found.search.seams.seams.empty());
  for (const double energy : {2.03, 2.08}) {
    const SearchedSeams other = go_on(energy, found.search);
    EXPECT_EQ(other.search.coarse, found.search.coarse);  // not simplified again
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

// ---- Symmetry. ----------------------------------------------------------------------------------

/// Lengths, and symmetry at twice the length.
constexpr SeamWeights kSymmetric{
    .concavity = 0, .visibility = 0, .hard_edges = 1, .materials = 1, .symmetry = 1};

/// Symmetric to x = 0 alone where nothing skews it, with faces that are not.
TriangleList creature(int times, double skew = 0) {
  return meshes::moved(meshes::shaken(meshes::sphere(times), 0.004, 3), [&](const Vec3& p) {
    return Vec3(p.x() * (1 + 0.4 * p.z()) + skew * p.z() * p.z(),
                1.5 * p.y() + 0.5 * p.z() * p.z() + 0.3 * p.x() * p.x(),
                2 * p.z() + 0.4 * p.y() * p.y() * p.y() + skew * p.x() * p.y());
  });
}

/// The share of the seams' length that is mirrored by x to where no seam is within so many of its
/// edges.
double asymmetry(const Surface& surface, const EdgeMarks& seams, double edges) {
  std::vector<Vec3> middles;
  std::vector<double> lengths;
  double sum = 0, off = 0;
  for (Index h = 0; h < size_of(seams); ++h) {
    if (!seams[h] || surface.edge(h) != h) continue;
    const Vec3 &a = surface.positions[surface.origin(h)], &b = surface.positions[surface.target(h)];
    middles.emplace_back((a + b) / 2);
    lengths.push_back((a - b).norm());
    sum += lengths.back();
  }
  const double near = edges * sum / static_cast<double>(lengths.size());
  for (std::size_t i = 0; i < middles.size(); ++i) {
    const Vec3 image(-middles[i].x(), middles[i].y(), middles[i].z());
    const bool is_near = std::any_of(middles.begin(), middles.end(),
                                     [&](const Vec3& p) { return (p - image).norm() <= near; });
    if (!is_near) off += lengths[i];
  }
  return off / sum;
}

/// With the plane of its symmetry at x = 0.
Surface built_about_x(TriangleList mesh) {
  normalise(mesh.positions, mesh.faces, Work(1));
  double least = 0, most = 0;
  for (const Vec3& p : mesh.positions) {
    least = std::min(least, p.x());
    most = std::max(most, p.x());
  }
  for (Vec3& p : mesh.positions) p.x() -= (least + most) / 2;
  return build_surface(std::move(mesh.positions), std::move(mesh.faces), Work(1));
}

TEST(Search, SeamsAreSymmetricWhereTheSurfaceIs) {
  for (const int times : {4, 6}) {  // itself searched, and a coarser one for it
    const Surface surface = built_about_x(creature(times));
    for (const double energy : {2.05, 2.01}) {
      const SearchedSeams any = searched(surface, energy, {}, 2, kLengths);
      const SearchedSeams found = searched(surface, energy, {}, 2, kSymmetric);
      EXPECT_GE(charts(surface, found.seams), 1);
      EXPECT_LE(found.energy, energy);
      EXPECT_LT(asymmetry(surface, found.seams, 3), 0.05);
      EXPECT_LT(length(surface, found.seams), 1.5 * length(surface, any.seams));
      EXPECT_TRUE(found.search.mirror);
    }
  }
}

TEST(Search, SymmetricSeamsAreTheSameBitsAtOneThreadAndAtTwo) {
  const Surface surface = built(meshes::together({creature(3), meshes::torus(9)}));
  const Surface alone = built(creature(3));
  for (const Surface* each : {&surface, &alone}) {
    const SearchedSeams one = searched(*each, 2.01, {}, 1, kSymmetric);
    const SearchedSeams two = searched(*each, 2.01, {}, 2, kSymmetric);
    EXPECT_EQ(one.seams, two.seams);
    EXPECT_EQ(one.energy, two.energy);
  }
}

/// A ball with bumps, mirrored by x, of n by n cells on each side of a cube, split either way.
TriangleList bumpy_cube(int n) {
  TriangleList mesh;
  disks::Random random(n);
  std::map<std::array<int, 3>, Index> known;
  const auto vertex = [&](const std::array<int, 3>& at) {
    const auto [place, is_new] = known.try_emplace(at, size_of(mesh.positions));
    if (is_new) {
      const Vec3 d = Vec3(at[0], at[1], at[2]).normalized();
      const double x = std::abs(d.x());
      const double bump =
          std::cos(5 * x) * std::sin(4 * d.y() + 1) + 0.5 * std::sin(6 * d.z() + 2 * x);
      mesh.positions.push_back(d * (1 + 0.4 * bump));
    }
    return place->second;
  };
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {-n, n}) {
      for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
          std::array<Index, 4> q{};
          for (int k = 0; k < 4; ++k) {
            std::array<int, 3> at{};
            at[axis] = side;
            at[(axis + 1) % 3] = 2 * (i + (k == 1 || k == 2 ? 1 : 0)) - n;
            at[(axis + 2) % 3] = 2 * (j + (k >= 2 ? 1 : 0)) - n;
            q[side > 0 ? k : 3 - k] = vertex(at);
          }
          const auto first = q.begin() + random.below(4);
          std::rotate(q.begin(), first, q.end());
          mesh.faces.push_back({q[0], q[1], q[2]});
          mesh.faces.push_back({q[0], q[2], q[3]});
        }
      }
    }
  }
  return mesh;
}

TEST(Search, LockedEdgesStayUncutForSymmetry) {
  for (const int n : {8, 10}) {
    const Surface surface = built_about_x(bumpy_cube(n));
    const EdgeMarks locked = diagonals(surface);
    for (const double energy : {2.02, 2.005}) {
      const EdgeMarks seams = searched(surface, energy, locked, 2, kSymmetric).seams;
      charts(surface, seams);
      for (std::size_t h = 0; h < seams.size(); ++h) EXPECT_FALSE(locked[h] && seams[h]);
    }
  }
}

TEST(Search, WhatHasNoMirrorIsSearchedAsItWouldBe) {
  const Surface surface = built(creature(3, 0.5));
  EXPECT_EQ(searched(surface, 2.02, {}, 1, kSymmetric).seams,
            searched(surface, 2.02, {}, 1, kLengths).seams);
}

TEST(Search, SymmetryIsNotHadAtAnyPrice) {
  SeamWeights weights = kSymmetric;
  for (const double price : {0.0, 0.05, 1.0}) {
    weights.symmetry = price;
    for (const TriangleList& mesh : {creature(3), meshes::torus(14), meshes::double_torus(8)}) {
      const Surface surface = built(mesh);
      const double shortest = length(surface, searched(surface, 2.02, {}, 1, kLengths).seams);
      const SearchedSeams found = searched(surface, 2.02, {}, 1, weights);
      charts(surface, found.seams);
      EXPECT_LE(found.energy, 2.02);
      // What they are compared with has been drawn to the plane.
      EXPECT_LT(length(surface, found.seams), (1.1 + price) * shortest);
    }
  }
}

TEST(Search, GoesOnSymmetricallyForAnotherTarget) {
  const Surface surface = built_about_x(creature(6));
  const auto go_on = [&](double energy, const BegunSearch& begun) {
    return search_seams(surface, surface.face_count(), topology_of(surface, Work(1)), {},
                        {.energy = energy}, kNormal, kSymmetric, {}, begun, Work(1));
  };
  const SearchedSeams found = go_on(2.04, {});
  ASSERT_TRUE(found.search.mirror);
  for (const double energy : {2.03, 2.05}) {
    const SearchedSeams other = go_on(energy, found.search);
    // Of the surface that they were found on, too.
    charts(other.search.coarse->surface, other.search.seams.seams);
    charts(surface, other.seams);
    EXPECT_LE(other.energy, energy);
    EXPECT_LT(asymmetry(surface, other.seams, 3), 0.05);
  }
}

/// Seams that join no other one and no border.
Index edges_alone(const Surface& surface, const EdgeMarks& seams) {
  std::vector<Index> joined(surface.positions.size(), 0);
  for (Index h = 0; h < size_of(seams); ++h) {
    if (seams[h]) ++joined[surface.origin(h)];
    if (seams[h] && surface.twin[h] == kNone) ++joined[surface.target(h)];
  }
  const auto is_loose = [&](Index v) { return joined[v] == 1 && !surface.on_boundary[v]; };
  Index count = 0;
  for (Index h = 0; h < size_of(seams); ++h) {
    if (seams[h] && is_loose(surface.origin(h)) && is_loose(surface.target(h))) ++count;
  }
  return count;
}

TEST(MirroredSeams, LeaveDisksOfWhateverThereIs) {
  for (const TriangleList& mesh :
       {creature(2), creature(3), meshes::torus(12), meshes::double_torus(10),
        meshes::together({meshes::sphere(2), meshes::torus(7)}), meshes::grid(12, 9)}) {
    const Surface surface = built(mesh);
    const std::optional<Mirror> mirror = find_mirror(surface, 0.01, Work(1));
    if (!mirror) continue;
    const std::vector<double> cost = edge_lengths(surface, Work(1));
    const std::vector<bool> anchors(surface.positions.size(), false);
    std::mt19937_64 generator(1);
    for (int round = 0; round < 30; ++round) {
      EdgeMarks seams = open_minimal(surface, topology_of(surface, Work(1)), {}, Work(1));
      for (Index h = meshes::random_below(generator, 40); h < size_of(seams);
           h += 1 + meshes::random_below(generator, 40)) {
        mark_edge(surface, h, seams);
      }
      for (const int side : {1, -1}) {
        const AnchoredSeams both =
            mirrored_seams(surface, *mirror, {seams, anchors}, side, cost, {}, Work(1));
        EXPECT_GE(charts(surface, both.seams), 1);
        EXPECT_EQ(edges_alone(surface, both.seams), 0);
        if (testing::Test::HasFailure()) return;
      }
    }
  }
}

}  // namespace
}  // namespace beltrami
