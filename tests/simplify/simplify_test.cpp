// The coarse disk: a subset of the fine vertices, the boundary in its order, and what must stay.
// Every simplifier that this build has keeps the same contract.
#include "simplify/simplify.h"
#include "base/interrupt.h"
#include "base/portable_math.h"
#include "base/vectors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

#include "simplify/back_ends.h"
#include "support/simplifiers.h"

namespace beltrami {
namespace {

using Lift = std::function<Vec3(double x, double y)>;
using KeepsCell = std::function<bool(int x, int y)>;

Vec3 flat(double x, double y) {
  return {x, y, 0};
}

Vec3 wavy(double x, double y) {
  return {x, y, 2 * portable::sin(0.3 * x) * portable::cos(0.4 * y)};
}

bool every_cell(int, int) {
  return true;
}

/// The kept unit cells of a grid, two triangles each; the diagonals run up from the left, so that
/// the lower right and the upper left corner of a full grid are ears.
DiskMesh grid(int width, int height, const Lift& lift = flat, const KeepsCell& keeps = every_cell) {
  std::vector<Vec3> positions;
  for (int y = 0; y <= height; ++y) {
    for (int x = 0; x <= width; ++x) positions.push_back(lift(x, y));
  }
  std::vector<Triangle> faces;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (!keeps(x, y)) continue;
      const Index v = y * (width + 1) + x;
      faces.push_back({v, v + 1, v + width + 2});
      faces.push_back({v, v + width + 2, v + width + 1});
    }
  }
  std::vector<Vec3> kept;
  for (const Index v : drop_unreferenced(size_of(positions), faces, Work(1)))
    kept.push_back(positions[v]);
  return build_disk(std::move(kept), std::move(faces), Work(1));
}

/// Two squares joined by a corridor one cell wide, so that its interior edges are bridges.
DiskMesh dumbbell() {
  return grid(40, 15, wavy, [](int x, int y) { return x < 15 || x >= 25 || y == 7; });
}

/// A cap of the unit sphere of the given rings around its pole.
DiskMesh spherical_cap(int rings, int spokes, double angle) {
  std::vector<Vec3> positions{{0, 0, 1}};
  for (int r = 1; r <= rings; ++r) {
    const double polar = angle * r / rings;
    for (int s = 0; s < spokes; ++s) {
      const double turn = 2 * 3.14159265358979 * s / spokes;
      positions.push_back({portable::sin(polar) * portable::cos(turn),
                           portable::sin(polar) * portable::sin(turn), portable::cos(polar)});
    }
  }
  std::vector<Triangle> faces;
  const auto at = [&](int r, int s) { return 1 + (r - 1) * spokes + s % spokes; };
  for (int s = 0; s < spokes; ++s) {
    faces.push_back({0, at(1, s), at(1, s + 1)});
    for (int r = 1; r < rings; ++r) {
      faces.push_back({at(r, s), at(r + 1, s), at(r + 1, s + 1)});
      faces.push_back({at(r, s), at(r + 1, s + 1), at(r, s + 1)});
    }
  }
  return build_disk(std::move(positions), std::move(faces), Work(1));
}

DiskMesh fan(int rim) {
  std::vector<Vec3> positions{{0, 0, 0}};
  std::vector<Triangle> faces;
  for (int i = 0; i < rim; ++i) {
    const double turn = 2 * 3.14159265358979 * i / rim;
    positions.push_back({portable::cos(turn), portable::sin(turn), 0});
    faces.push_back({0, 1 + i, 1 + (i + 1) % rim});
  }
  return build_disk(std::move(positions), std::move(faces), Work(1));
}

using Edges = std::set<std::pair<Index, Index>>;

/// Interior edges between boundary vertices, in the numbering that `name` gives.
Edges bridges(const DiskMesh& mesh, const std::function<Index(Index)>& name) {
  Edges found;
  for (Index h = 0; h < size_of(mesh.twin); ++h) {
    const Index a = mesh.origin(h), b = mesh.target(h);
    if (mesh.twin[h] == kNone || !mesh.on_boundary[a] || !mesh.on_boundary[b]) continue;
    found.insert(std::minmax({name(a), name(b)}));
  }
  return found;
}

Edges fine_bridges(const DiskMesh& fine) {
  return bridges(fine, [](Index v) { return v; });
}

Edges coarse_bridges(const CoarseDisk& coarse) {
  return bridges(coarse.mesh, [&](Index v) { return coarse.fine_vertex[v]; });
}

void expect_subset(const DiskMesh& fine, const CoarseDisk& coarse) {
  ASSERT_EQ(size_of(coarse.fine_vertex), coarse.mesh.vertex_count());
  EXPECT_TRUE(std::is_sorted(coarse.fine_vertex.begin(), coarse.fine_vertex.end(),
                             [](Index a, Index b) { return a <= b; }));
  for (Index v = 0; v < coarse.mesh.vertex_count(); ++v) {
    const Index original = coarse.fine_vertex[v];
    EXPECT_EQ(coarse.mesh.positions[v], fine.positions[original]);
    EXPECT_EQ(coarse.mesh.on_boundary[v], fine.on_boundary[original]);
  }
}

void expect_boundary_in_order(const DiskMesh& fine, const CoarseDisk& coarse) {
  EXPECT_GE(size_of(coarse.mesh.boundary), std::min<Index>(8, size_of(fine.boundary)));
  std::vector<Index> place(fine.vertex_count(), kNone);
  for (Index i = 0; i < size_of(fine.boundary); ++i) place[fine.boundary[i]] = i;
  std::vector<Index> places;
  for (const Index v : coarse.mesh.boundary) places.push_back(place[coarse.fine_vertex[v]]);
  std::rotate(places.begin(), std::min_element(places.begin(), places.end()), places.end());
  EXPECT_TRUE(std::adjacent_find(places.begin(), places.end(), std::greater_equal<>()) ==
              places.end());
}

void expect_fixed_vertices_kept(const DiskMesh& fine, const CoarseDisk& coarse) {
  const auto kept = [&](Index v) {
    return std::binary_search(coarse.fine_vertex.begin(), coarse.fine_vertex.end(), v);
  };
  for (const Index v : fine.boundary) {
    const bool ear_tip = fine.rotate(fine.outgoing[v]) == kNone;
    EXPECT_TRUE(!ear_tip || kept(v)) << "ear tip " << v;
  }
  for (const auto& [a, b] : fine_bridges(fine)) {
    EXPECT_TRUE(kept(a) && kept(b)) << "bridge " << a << "-" << b;
  }
  const Edges old_bridges = fine_bridges(fine);
  for (const auto& bridge : coarse_bridges(coarse)) {
    EXPECT_TRUE(old_bridges.count(bridge)) << bridge.first << "-" << bridge.second;
  }
}

void expect_valences(const DiskMesh& fine, const CoarseDisk& coarse) {
  const auto valence = [](const DiskMesh& mesh, Index v) {
    Index count = 0;
    mesh.for_each_outgoing(v, [&](Index) { ++count; });
    return count;
  };
  for (Index v = 0; v < coarse.mesh.vertex_count(); ++v) {
    const Index before = valence(fine, coarse.fine_vertex[v]);
    const Index least = std::min<Index>(before, coarse.mesh.on_boundary[v] ? 2 : 3);
    EXPECT_GE(valence(coarse.mesh, v), least) << "vertex " << v;
  }
}

/// All that holds for every result, whatever the mesh. build_disk has proved the disk.
void expect_sound(const DiskMesh& fine, const CoarseDisk& coarse) {
  expect_subset(fine, coarse);
  expect_boundary_in_order(fine, coarse);
  expect_fixed_vertices_kept(fine, coarse);
  expect_valences(fine, coarse);
}

double smallest_angle(const DiskMesh& mesh) {
  double smallest = 180;
  for (const Triangle& face : mesh.faces) {
    for (int k = 0; k < 3; ++k) {
      const Vec3& corner = mesh.positions[face[k]];
      const Vec3 a = mesh.positions[face[next_corner(k)]] - corner;
      const Vec3 b = mesh.positions[face[previous_corner(k)]] - corner;
      smallest = std::min(smallest, std::acos(a.dot(b) / (a.norm() * b.norm())) * 57.29577951);
    }
  }
  return smallest;
}

std::vector<Index> identity(Index count) {
  std::vector<Index> all(count);
  std::iota(all.begin(), all.end(), 0);
  return all;
}

class Simplify : public testing::TestWithParam<Simplifier> {
 protected:
  static CoarseDisk simplify(const DiskMesh& fine, Index target_faces, const Work& work = Work(1)) {
    return GetParam().simplify(fine, target_faces, work);
  }
};

INSTANTIATE_TEST_SUITE_P(BackEnds, Simplify, testing::ValuesIn(simplifiers()),
                         testing::PrintToStringParamName());

TEST_P(Simplify, FlatGridReachesTheTargetWithEvenTriangles) {
  const DiskMesh fine = grid(60, 60);
  const CoarseDisk coarse = simplify(fine, 500);
  expect_sound(fine, coarse);
  EXPECT_LE(coarse.mesh.face_count(), 500);
  EXPECT_GE(coarse.mesh.face_count(), 499);
  EXPECT_NEAR(surface_area(coarse.mesh, Work(1)), 3600, 1e-9);
  EXPECT_GT(smallest_angle(coarse.mesh), 5);
}

TEST_P(Simplify, SphericalCapStaysCloseToTheSphere) {
  const DiskMesh fine = spherical_cap(60, 64, 1.5);
  const CoarseDisk coarse = simplify(fine, 700);
  expect_sound(fine, coarse);
  EXPECT_LE(coarse.mesh.face_count(), 700);
  for (const Triangle& face : coarse.mesh.faces) {
    Vec3 centroid = Vec3::Zero();
    for (const Index v : face) centroid += coarse.mesh.positions[v] / 3;
    EXPECT_GT(centroid.norm(), 0.985);
  }
  EXPECT_GT(surface_area(coarse.mesh, Work(1)), 0.98 * surface_area(fine, Work(1)));
}

TEST_P(Simplify, LongStripKeepsItsEndsAndReachesTheTarget) {
  const DiskMesh fine =
      grid(400, 4, [](double x, double y) { return Vec3(x, y, 5 * portable::sin(0.05 * x)); });
  const CoarseDisk coarse = simplify(fine, 300);
  expect_sound(fine, coarse);
  EXPECT_LE(coarse.mesh.face_count(), 300);
}

TEST_P(Simplify, DumbbellKeepsItsCorridor) {
  const DiskMesh fine = dumbbell();
  const CoarseDisk coarse = simplify(fine, 150);
  expect_sound(fine, coarse);
  EXPECT_LE(coarse.mesh.face_count(), 150);
  EXPECT_EQ(coarse_bridges(coarse), fine_bridges(fine));
}

TEST_P(Simplify, KeepsAVertexBetweenSuccessiveBridgeEnds) {
  // The two bridges across the only cell of the neck are all there is; the squares on both sides
  // would otherwise be free to lose every other boundary vertex of theirs.
  const DiskMesh fine = grid(21, 10, flat, [](int x, int y) { return x != 10 || y == 5; });
  const CoarseDisk coarse = simplify(fine, 1);
  expect_sound(fine, coarse);
  std::set<Index> ends;
  for (const auto& [a, b] : fine_bridges(fine)) ends.insert({a, b});
  const Index count = size_of(fine.boundary);
  for (Index i = 0; i < count; ++i) {
    if (!ends.count(fine.boundary[i])) continue;
    Index between = 0, kept = 0, j = i + 1;
    for (; !ends.count(fine.boundary[j % count]); ++j) {
      ++between;
      kept += std::binary_search(coarse.fine_vertex.begin(), coarse.fine_vertex.end(),
                                 fine.boundary[j % count]);
    }
    EXPECT_GE(kept, std::min<Index>(between, 1));
  }
}

TEST_P(Simplify, StopsAboveTheTargetWhereEveryVertexIsFixed) {
  // One cell wide: every vertex ends a bridge.
  const DiskMesh fine = grid(30, 1);
  const CoarseDisk coarse = simplify(fine, 10);
  EXPECT_EQ(coarse.mesh.faces, fine.faces);
  EXPECT_EQ(coarse.fine_vertex, identity(fine.vertex_count()));
}

TEST_P(Simplify, ShrinksAMeshWhoseVerticesAllTouchTheBoundary) {
  const DiskMesh fine = grid(200, 2, wavy);
  const CoarseDisk coarse = simplify(fine, 200);
  expect_sound(fine, coarse);
  EXPECT_LT(coarse.mesh.face_count(), 400);
}

TEST_P(Simplify, ShrinksALargeFan) {
  const DiskMesh fine = fan(2000);
  const CoarseDisk coarse = simplify(fine, 20);
  expect_sound(fine, coarse);
  EXPECT_LE(coarse.mesh.face_count(), 20);
}

TEST_P(Simplify, KeepsEightBoundaryVerticesWhateverTheTarget) {
  const DiskMesh fine = spherical_cap(10, 20, 1.0);
  const CoarseDisk coarse = simplify(fine, 1);
  expect_sound(fine, coarse);
  EXPECT_EQ(size_of(coarse.mesh.boundary), 8);
}

TEST_P(Simplify, KeepsABoundaryOfThreeVertices) {
  // A cap whose rim has 3 vertices only: almost a closed surface.
  const DiskMesh fine = spherical_cap(30, 3, 3.0);
  const CoarseDisk coarse = simplify(fine, 60);
  expect_sound(fine, coarse);
  EXPECT_EQ(size_of(coarse.mesh.boundary), 3);
}

TEST_P(Simplify, ScalesByPowersOfTwoToTheSameResult) {
  const DiskMesh fine = grid(50, 40, wavy);
  const CoarseDisk expected = simplify(fine, 400);
  for (const double scale : {std::ldexp(1.0, 20), std::ldexp(1.0, -20)}) {
    DiskMesh scaled = fine;
    for (Vec3& p : scaled.positions) p *= scale;
    const CoarseDisk coarse = simplify(scaled, 400);
    EXPECT_EQ(coarse.fine_vertex, expected.fine_vertex);
    EXPECT_EQ(coarse.mesh.faces, expected.mesh.faces);
  }
}

TEST_P(Simplify, WorksAtExtremeScalesAndFarFromTheOrigin) {
  const DiskMesh fine = grid(50, 40, wavy);
  for (const double scale : {1e6, 1e-6}) {
    DiskMesh moved = fine;
    for (Vec3& p : moved.positions) p = scale * (p + Vec3(1e4, -1e4, 1e4));
    const CoarseDisk coarse = simplify(moved, 400);
    expect_sound(moved, coarse);
    EXPECT_LE(coarse.mesh.face_count(), 400);
    EXPECT_GT(smallest_angle(coarse.mesh), 2);
  }
}

TEST_P(Simplify, IsDeterministic) {
  const DiskMesh fine = grid(40, 40, wavy);
  const CoarseDisk first = simplify(fine, 300), second = simplify(fine, 300);
  EXPECT_EQ(first.fine_vertex, second.fine_vertex);
  EXPECT_EQ(first.mesh.faces, second.mesh.faces);
}

TEST_P(Simplify, SurvivesZeroAreaFacesAndDuplicatePositions) {
  // Every third column of the grid coincides with the one before it, and one row is a point.
  const DiskMesh fine = grid(45, 45, [](double x, double y) {
    const double snapped = 3 * std::floor(x / 3) + std::min(std::fmod(x, 3), 1.0);
    return y == 20 ? Vec3(22, 20, 0) : Vec3(snapped, y, 0.1 * portable::sin(0.5 * y));
  });
  const CoarseDisk coarse = simplify(fine, 400);
  expect_sound(fine, coarse);
  EXPECT_LE(coarse.mesh.face_count(), 400);
}

TEST_P(Simplify, SurvivesAMeshWithoutAnyArea) {
  for (const Lift& lift : {Lift([](double, double) { return Vec3(1, 2, 3); }),
                           Lift([](double x, double y) { return Vec3(x + 0.01 * y, 0, 0); })}) {
    const DiskMesh fine = grid(20, 20, lift);
    const CoarseDisk coarse = simplify(fine, 100);
    expect_sound(fine, coarse);
    EXPECT_LE(coarse.mesh.face_count(), 100);
  }
}

TEST_P(Simplify, KeepsTheOutlineWhereTheBoundaryFacesHaveNoArea) {
  // A flower whose outermost ring lies on the one inside it.
  const DiskMesh cap = spherical_cap(30, 120, 0.3);
  std::vector<Vec3> positions = cap.positions;
  for (Index i = 1; i < size_of(positions); ++i) {
    const Index spoke = (i - 1) % 120, ring = std::min<Index>((i - 1) / 120, 28);
    const double turn = 0.05235987755983 * spoke;
    const double radius = ring * (1 + 0.4 * portable::cos(5 * turn));
    positions[i] = {radius * portable::cos(turn), radius * portable::sin(turn), 0};
  }
  const DiskMesh fine = build_disk(std::move(positions), cap.faces, Work(1));
  const CoarseDisk coarse = simplify(fine, 400);
  expect_sound(fine, coarse);
  EXPECT_NEAR(surface_area(coarse.mesh, Work(1)) / surface_area(fine, Work(1)), 1, 0.002);
  EXPECT_GE(size_of(coarse.mesh.boundary), 30);
}

TEST_P(Simplify, PutsDegenerateVerticesOnTheirDuplicatesFirst) {
  // All vertices lie on every fifth grid point: collapsing elsewhere would fold the plane.
  const DiskMesh fine = grid(100, 100, [](double x, double y) {
    return Vec3(5 * std::floor(x / 5), 5 * std::floor(y / 5), 0);
  });
  const CoarseDisk coarse = simplify(fine, 1200);
  expect_sound(fine, coarse);
  EXPECT_NEAR(surface_area(coarse.mesh, Work(1)), surface_area(fine, Work(1)), 1e-9);
}

TEST_P(Simplify, ReducesAMeshOfSlivers) {
  const DiskMesh fine = grid(40, 40, [](double x, double y) { return Vec3(200 * x, y, 0); });
  const CoarseDisk coarse = simplify(fine, 300);
  expect_sound(fine, coarse);
  EXPECT_LE(coarse.mesh.face_count(), 300);
}

TEST_P(Simplify, ReturnsTheMeshItselfAtOrAboveItsFaceCount) {
  const DiskMesh fine = grid(5, 5, wavy);
  for (const Index target : {fine.face_count(), fine.face_count() + 1, 1000000}) {
    const CoarseDisk coarse = simplify(fine, target);
    EXPECT_EQ(coarse.mesh.faces, fine.faces);
    EXPECT_EQ(coarse.mesh.positions, fine.positions);
    EXPECT_EQ(coarse.mesh.boundary, fine.boundary);
    EXPECT_EQ(coarse.fine_vertex, identity(fine.vertex_count()));
  }
}

TEST_P(Simplify, LeavesTinyMeshesAlone) {
  const DiskMesh triangle = build_disk({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, Work(1));
  EXPECT_EQ(simplify(triangle, 1).mesh.faces, triangle.faces);
  EXPECT_EQ(simplify(triangle, 0).mesh.faces, triangle.faces);
  const DiskMesh quad = grid(1, 1);
  EXPECT_EQ(simplify(quad, 1).mesh.faces, quad.faces);
  const DiskMesh hexagon = fan(6);
  EXPECT_EQ(simplify(hexagon, 1).mesh.faces, hexagon.faces);
}

TEST(SimplifyInPasses, HasTheSameBitsOnTwoThreadsInBlocks) {
  const DiskMesh fine = grid(220, 220, wavy);  // three blocks of vertices
  const CoarseDisk one = simplify_in_passes(fine, 3000, Work(1));
  const CoarseDisk two = simplify_in_passes(fine, 3000, Work(2));
  EXPECT_EQ(one.mesh.faces, two.mesh.faces);
  EXPECT_EQ(one.fine_vertex, two.fine_vertex);
  EXPECT_EQ(one.nearby, two.nearby);
  EXPECT_LE(one.mesh.face_count(), 3000);
  expect_subset(fine, one);
  expect_boundary_in_order(fine, one);
}

TEST_P(Simplify, SaysWhereEveryVertexWent) {
  const DiskMesh fine = grid(60, 60, wavy);
  const CoarseDisk coarse = simplify(fine, 500);
  ASSERT_EQ(size_of(coarse.nearby), fine.vertex_count());
  for (Index c = 0; c < coarse.mesh.vertex_count(); ++c) {
    EXPECT_EQ(coarse.nearby[coarse.fine_vertex[c]], c);
  }
  double mean = 0;
  for (Index v = 0; v < fine.vertex_count(); ++v) {
    mean +=
        (fine.positions[v] - coarse.mesh.positions[coarse.nearby[v]]).norm() / fine.vertex_count();
  }
  const double coarse_edge = std::sqrt(surface_area(fine, Work(1)) / coarse.mesh.vertex_count());
  EXPECT_LT(mean, 2 * coarse_edge);
}

TEST_P(Simplify, ReportsGrowingFractionsFromZeroToOne) {
  std::vector<double> fractions;
  simplify(grid(60, 60, wavy), 300, Work({}, [&](double fraction, const char*) {
             fractions.push_back(fraction);
             return false;
           }));
  ASSERT_GE(fractions.size(), 5u);
  EXPECT_EQ(fractions.front(), 0);
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  EXPECT_LE(fractions.back(), 1);
}

TEST_P(Simplify, IsCancelledByItsProgress) {
  const DiskMesh fine = grid(40, 40, wavy);
  const DiskMesh copy = grid(40, 40, wavy);
  for (int allowed = 0; allowed < 8; ++allowed) {
    int calls = 0;
    const Work work({}, [&](double, const char*) { return calls++ == allowed; });
    EXPECT_THROW(simplify(fine, 100, work), Cancelled);
  }
  EXPECT_EQ(fine.faces, copy.faces);
  EXPECT_EQ(fine.positions, copy.positions);
  expect_sound(fine, simplify(fine, 100));
}

}  // namespace
}  // namespace beltrami
