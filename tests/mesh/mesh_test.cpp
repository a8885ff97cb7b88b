// Validation, adjacency and normalisation of the disk mesh.
#include "mesh/disk_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <utility>

#include "base/error.h"
#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "support/meshes.h"

namespace beltrami {
namespace {

using meshes::TriangleList;

DiskMesh built(const TriangleList& mesh) {
  return build_disk(mesh.positions, mesh.faces, Work(1));
}

/// Builds the mesh and expects this fault and element.
void expect_refused(const TriangleList& mesh, Fault fault, Element element, int threads = 1) {
  try {
    build_disk(mesh.positions, mesh.faces, Work(threads));
    FAIL() << "was accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), fault) << error.what();
    EXPECT_EQ(error.element().kind, element.kind) << error.what();
    EXPECT_EQ(error.element().index, element.index) << error.what();
    EXPECT_GT(std::string(error.what()).size(), 20u);
  }
}

TEST(BuildDisk, RefusesAnEmptyMesh) {
  expect_refused({}, Fault::kEmpty, {});
  expect_refused({meshes::triangle().positions, {}}, Fault::kEmpty, {});
  expect_refused({{}, meshes::triangle().faces}, Fault::kEmpty, {});
}

TEST(BuildDisk, RefusesIndicesOutOfRange) {
  for (const Index bad : {4, -1, std::numeric_limits<Index>::max()}) {
    TriangleList mesh = meshes::quad();
    mesh.faces[1][2] = bad;
    expect_refused(mesh, Fault::kIndexOutOfRange, Element::face(1));
  }
}

TEST(BuildDisk, RefusesNonFinitePositions) {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
        -std::numeric_limits<double>::infinity()}) {
    TriangleList mesh = meshes::quad();
    mesh.positions[2].z() = bad;
    expect_refused(mesh, Fault::kNonFinite, Element::vertex(2));
  }
}

TEST(BuildDisk, RefusesAFaceThatNamesAVertexTwice) {
  for (const Triangle bad : {Triangle{0, 0, 2}, Triangle{0, 2, 2}, Triangle{2, 0, 2}}) {
    TriangleList mesh = meshes::quad();
    mesh.faces.push_back(bad);
    expect_refused(mesh, Fault::kRepeatedVertex, Element::face(2));
  }
}

TEST(BuildDisk, RefusesThreeFacesOnAnEdgeWhicheverWayTheyRun) {
  expect_refused(meshes::three_on_an_edge(), Fault::kNonManifoldEdge, Element::face(2));
  TriangleList same_way = meshes::three_on_an_edge();
  std::swap(same_way.faces[1][0], same_way.faces[1][1]);
  expect_refused(same_way, Fault::kNonManifoldEdge, Element::face(1));
}

TEST(BuildDisk, RefusesAVertexWithTwoFans) {
  expect_refused(meshes::bowtie(), Fault::kNonManifoldVertex, Element::vertex(0));
}

TEST(BuildDisk, RefusesAnInteriorFanBesideABoundaryFan) {
  // A closed fan around vertex 0 and, at the same vertex, a loose face.
  TriangleList mesh = meshes::fan(5);
  mesh.positions.push_back({0, 0, 1});
  mesh.positions.push_back({0, 1, 1});
  mesh.faces.push_back({0, 6, 7});
  expect_refused(mesh, Fault::kNonManifoldVertex, Element::vertex(0));
}

/// The mesh with the faces of `other` at `kept`, so that no face names `other`.
TriangleList with_one_for_two(TriangleList mesh, Index kept, Index other) {
  for (Triangle& face : mesh.faces) std::replace(face.begin(), face.end(), other, kept);
  return mesh;
}

/// The mesh with its last vertex in the place of one that no face names.
TriangleList without_unused(TriangleList mesh, Index unused) {
  const Index last = size_of(mesh.positions) - 1;
  mesh = with_one_for_two(std::move(mesh), unused, last);
  mesh.positions[unused] = mesh.positions[last];
  mesh.positions.pop_back();
  return mesh;
}

TEST(BuildDisk, RefusesTwoFansOfOneSheetWhereverTheyLie) {
  const TriangleList grid = meshes::grid(9, 9);  // 10 vertices in a row
  const Index inside = 22, inside_too = 67, corner = 0, side = 5, other_side = 94;
  for (const auto& [kept, other] :
       {std::pair(inside, inside_too), std::pair(corner, inside_too), std::pair(side, inside),
        std::pair(side, other_side), std::pair(corner, other_side)}) {
    const TriangleList pinched = with_one_for_two(grid, kept, other);
    expect_refused(without_unused(pinched, other), Fault::kNonManifoldVertex,
                   Element::vertex(kept));
    // The vertex that no face names makes up for the lost one in Euler's characteristic.
    expect_refused(pinched, Fault::kNonManifoldVertex, Element::vertex(kept));
  }
}

TEST(BuildDisk, RefusesFacesThatRunAgainstEachOther) {
  expect_refused(meshes::against_each_other(), Fault::kOrientation, Element::face(1));
}

TEST(BuildDisk, RefusesADuplicateFace) {
  TriangleList mesh = meshes::triangle();
  mesh.faces.push_back({1, 2, 0});
  expect_refused(mesh, Fault::kOrientation, Element::face(1));
}

TEST(BuildDisk, RefusesASecondComponent) {
  expect_refused(meshes::two_components(), Fault::kComponents, Element::face(1));
}

/// A grid of 60,000 faces, which several threads share, with one face more.
TriangleList large_with_face(const Triangle& face) {
  TriangleList mesh = meshes::grid(200, 150);
  mesh.faces.push_back(face);
  for (const Index v : face) {
    while (v >= size_of(mesh.positions)) mesh.positions.push_back({9, 9, double(v)});
  }
  return mesh;
}

TEST(BuildDisk, NamesTheFirstDefectOfALargeMeshAtAnyThreadCount) {
  const Index vertices = size_of(meshes::grid(200, 150).positions), faces = 60'000;
  for (const int threads : {1, 2, 5}) {
    expect_refused(large_with_face({vertices, vertices + 1, vertices + 2}), Fault::kComponents,
                   Element::face(faces), threads);
    // Only a corner in common: two fans there.
    expect_refused(large_with_face({0, vertices, vertices + 1}), Fault::kNonManifoldVertex,
                   Element::vertex(0), threads);
    TriangleList mesh = large_with_face({7, 7, 8});
    mesh.faces[40'000] = {3, -1, 4};
    expect_refused(mesh, Fault::kIndexOutOfRange, Element::face(40'000), threads);
    mesh.faces[30'000] = {5, 6, 5};
    expect_refused(mesh, Fault::kRepeatedVertex, Element::face(30'000), threads);
    mesh = meshes::grid(200, 150);
    mesh.positions[30'000].y() = mesh.positions[20'000].x() =
        std::numeric_limits<double>::quiet_NaN();
    expect_refused(mesh, Fault::kNonFinite, Element::vertex(20'000), threads);
  }
}

TEST(BuildDisk, IsTheSameAtAnyThreadCount) {
  TriangleList mesh = meshes::grid(200, 150);
  // In an order that says nothing about the surface.
  for (std::size_t f = mesh.faces.size(); f-- > 1;) {
    std::swap(mesh.faces[f], mesh.faces[f * 7919 % (f + 1)]);
  }
  const DiskMesh one = build_disk(mesh.positions, mesh.faces, Work(1));
  for (const int threads : {2, 5}) {
    const DiskMesh other = build_disk(mesh.positions, mesh.faces, Work(threads));
    EXPECT_EQ(one.twin, other.twin);
    EXPECT_EQ(one.outgoing, other.outgoing);
    EXPECT_EQ(one.boundary, other.boundary);
    EXPECT_EQ(one.on_boundary, other.on_boundary);
  }
}

TEST(BuildDisk, RefusesClosedSurfaces) {
  expect_refused(meshes::tetrahedron(), Fault::kClosed, {});
  expect_refused(meshes::octahedron(), Fault::kClosed, {});
}

TEST(BuildDisk, RefusesASecondBoundaryWithAVertexOnIt) {
  try {
    built(meshes::annulus(7));
    FAIL() << "was accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::kBoundaries);
    EXPECT_EQ(error.element().kind, ElementKind::kVertex);
    EXPECT_LT(error.element().index, 14u);
  }
}

TEST(BuildDisk, RefusesAHandle) {
  expect_refused(meshes::torus_with_hole(4), Fault::kGenus, {});
}

void expect_invariants(const DiskMesh& mesh) {
  std::set<Index> on_loop(mesh.boundary.begin(), mesh.boundary.end());
  EXPECT_EQ(on_loop.size(), mesh.boundary.size()) << "the loop passes a vertex twice";
  Index boundary_edges = 0;
  for (Index h = 0; h < 3 * mesh.face_count(); ++h) {
    const Index twin = mesh.twin[h];
    EXPECT_EQ(DiskMesh::next(DiskMesh::next(DiskMesh::next(h))), h);
    EXPECT_EQ(DiskMesh::previous(DiskMesh::next(h)), h);
    EXPECT_EQ(mesh.target(h), mesh.origin(DiskMesh::next(h)));
    if (twin == kNone) {
      ++boundary_edges;
      continue;
    }
    EXPECT_EQ(mesh.twin[twin], h);
    EXPECT_EQ(mesh.origin(twin), mesh.target(h));
    EXPECT_EQ(mesh.target(twin), mesh.origin(h));
  }
  EXPECT_EQ(boundary_edges, size_of(mesh.boundary));

  Index corners = 0;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    EXPECT_EQ(mesh.on_boundary[v], on_loop.count(v) == 1);
    EXPECT_EQ(mesh.on_boundary[v], mesh.twin[mesh.outgoing[v]] == kNone);
    mesh.for_each_outgoing(v, [&](Index h) {
      EXPECT_EQ(mesh.origin(h), v);
      ++corners;
    });
  }
  EXPECT_EQ(corners, 3 * mesh.face_count()) << "each corner is met once";
}

TEST(BuildDisk, KeepsItsInvariants) {
  expect_invariants(built(meshes::triangle()));
  expect_invariants(built(meshes::quad()));
  expect_invariants(built(meshes::fan(3)));
  expect_invariants(built(meshes::fan(9)));
  expect_invariants(built(meshes::strip(6)));
  expect_invariants(built(meshes::grid(5, 3)));
  expect_invariants(built(meshes::cap(4, 7, 2.5)));
}

TEST(BuildDisk, WalksTheBoundaryWithTheSurfaceOnItsLeft) {
  const DiskMesh mesh = built(meshes::grid(4, 3));
  ASSERT_EQ(mesh.boundary.size(), 14u);
  double doubled_area = 0;
  for (std::size_t i = 0; i < mesh.boundary.size(); ++i) {
    const Index from = mesh.boundary[i], to = mesh.boundary[(i + 1) % mesh.boundary.size()];
    EXPECT_EQ(mesh.target(mesh.outgoing[from]), to);
    const Vec3 &p = mesh.positions[from], &q = mesh.positions[to];
    doubled_area += p.x() * q.y() - p.y() * q.x();
  }
  EXPECT_NEAR(doubled_area, 2, 1e-12);
}

TEST(BuildDisk, VisitsTheFacesOfAVertexCounterClockwise) {
  const DiskMesh mesh = built(meshes::fan(6));
  std::vector<Index> targets;
  mesh.for_each_outgoing(0, [&](Index h) { targets.push_back(mesh.target(h)); });
  ASSERT_EQ(targets.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(targets[(i + 1) % 6], targets[i] % 6 + 1);
}

TEST(DropUnreferenced, KeepsTheOrderOfTheRest) {
  std::vector<Triangle> faces = {{5, 2, 7}, {7, 2, 3}};
  EXPECT_EQ(drop_unreferenced(9, faces, Work(1)), (std::vector<Index>{2, 3, 5, 7}));
  EXPECT_EQ(faces, (std::vector<Triangle>{{2, 0, 3}, {3, 0, 1}}));
}

/// Area of the triangle list.
double area_of(const TriangleList& mesh) {
  double area = 0;
  for (const Triangle& f : mesh.faces) {
    area += triangle_area(mesh.positions[f[0]], mesh.positions[f[1]], mesh.positions[f[2]]);
  }
  return area;
}

TEST(Normalise, GivesTheSameBitsAtEveryPowerOfTwo) {
  TriangleList unit = meshes::bumps(6, 5);
  const TriangleList original = unit;
  const Normalisation frame = normalise(unit.positions, unit.faces, Work(1));
  for (const int exponent : {-1000, -900, -500, -60, -1, 1, 60, 500, 900, 1020}) {
    TriangleList scaled = original;
    for (Vec3& p : scaled.positions) p *= std::ldexp(1.0, exponent);
    const Normalisation scaled_frame = normalise(scaled.positions, scaled.faces, Work(1));
    EXPECT_EQ(scaled.positions, unit.positions) << "scaled by 2^" << exponent;
    EXPECT_EQ(scaled_frame.exponent, frame.exponent - exponent);
  }
}

TEST(Normalise, BringsTheAreaNearOne) {
  for (const double size : {1e-310, 1e-200, 3e-7, 1.0, 1.9, 77.0, 1e150, 1e300}) {
    TriangleList mesh = meshes::bumps(6, 5);
    for (Vec3& p : mesh.positions) p *= size;
    normalise(mesh.positions, mesh.faces, Work(1));
    const double area = area_of(mesh);
    EXPECT_GE(area, 0.5) << size;
    EXPECT_LE(area, 2.0) << size;
  }
}

TEST(Normalise, KeepsWhatAnOffsetLeavesOfTheShape) {
  // Coordinates on a binary grid survive the offset, so the result must not depend on it.
  TriangleList near = meshes::grid(8, 4);
  TriangleList far = near;
  for (Vec3& p : far.positions) p += Vec3(1 << 30, -(1 << 29), 1 << 20);
  normalise(near.positions, near.faces, Work(1));
  normalise(far.positions, far.faces, Work(1));
  EXPECT_EQ(near.positions, far.positions);
}

TEST(Normalise, RecoversTheInput) {
  const TriangleList original = meshes::bumps(3, 3);
  TriangleList mesh = original;
  const Normalisation frame = normalise(mesh.positions, mesh.faces, Work(1));
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const Vec3 back = mesh.positions[i] * std::ldexp(1.0, -frame.exponent) + frame.centre;
    EXPECT_LT((back - original.positions[i]).norm(), 1e-15);
  }
}

void expect_zero_area(TriangleList mesh) {
  try {
    normalise(mesh.positions, mesh.faces, Work(1));
    FAIL() << "was accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::kZeroArea);
  }
}

TEST(Normalise, RefusesASurfaceWithoutArea) {
  TriangleList point = meshes::quad();
  for (Vec3& p : point.positions) p = {3, 4, 5};
  expect_zero_area(point);
  TriangleList line = meshes::quad();
  for (Vec3& p : line.positions) p = {p.x() + 2 * p.y(), 0, 0};
  expect_zero_area(line);
}

}  // namespace
}  // namespace beltrami
