// Any triangles as an atlas: certified, every corner kept, the same whatever the threads and the
// unit.
#include "atlas/atlas.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/interrupt.h"
#include "chart/flattening.h"
#include "mesh/disk_mesh.h"
#include "mesh/locality.h"
#include "support/cuts.h"
#include "support/disks.h"
#include "support/meshes.h"
#include "support/run.h"
#include "support/solids.h"
#include "support/surfaces.h"

namespace beltrami {
namespace {

using meshes::TriangleList;

Atlas unwrapped(const TriangleList& mesh, const AtlasOptions& options = {}, int threads = 1) {
  return unwrap({mesh.positions, mesh.faces}, options, Work(threads));
}

double area_in_space(const TriangleList& mesh) {
  double area = 0;
  for (const auto& [a, b, c] : mesh.faces) {
    area += triangle_area(mesh.positions[a], mesh.positions[b], mesh.positions[c]);
  }
  return area;
}

/// Every corner has a UV vertex of its place, every face a chart or none, and the very numbers
/// delivered are injective.
void expect_sound(const TriangleList& mesh, const Atlas& atlas) {
  EXPECT_EQ(atlas.outcome, Outcome::kOk);
  EXPECT_TRUE(atlas.certificate.injective());
  EXPECT_EQ(atlas.certificate.touching_places, 0);
  EXPECT_TRUE(atlas.single_certificate.injective());
  ASSERT_EQ(atlas.faces.size(), mesh.faces.size());
  AtlasRules rules;
  std::vector<Triangle> oriented = atlas.faces;
  std::vector<Index> in_chart(atlas.charts.size(), 0);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const Index uv = atlas.faces[f][k];
      ASSERT_TRUE(uv >= 0 && uv < size_of(atlas.uvs));
      EXPECT_EQ(mesh.positions[atlas.input_vertex[uv]], mesh.positions[mesh.faces[f][k]]);
      EXPECT_TRUE(atlas.uvs[uv].allFinite());
    }
    if (atlas.reversed[f]) std::swap(oriented[f][1], oriented[f][2]);
    const Index chart = atlas.chart_of_face[f];
    rules.excepted.push_back(chart == kNone);
    if (chart != kNone) ++in_chart[chart];
  }
  EXPECT_TRUE(certify_atlas(oriented, atlas.uvs, rules, Work(1)).injective());
  for (std::size_t c = 0; c < atlas.charts.size(); ++c) {
    EXPECT_EQ(atlas.charts[c].faces, in_chart[c]);
    EXPECT_EQ(atlas.charts[c].outcome, Outcome::kOk);
  }
  EXPECT_NEAR(atlas.area, area_in_space(mesh), 1e-9 * atlas.area);
  EXPECT_GE(atlas.energy.symmetric_dirichlet, 2 - 1e-9);
  EXPECT_LE(atlas.energy.symmetric_dirichlet, atlas.energy.max);
  EXPECT_LE(atlas.energy.p99, atlas.energy.max);
}

void expect_same_bits(const Atlas& a, const Atlas& b) {
  EXPECT_EQ(a.uvs, b.uvs);
  EXPECT_EQ(a.faces, b.faces);
  EXPECT_EQ(a.input_vertex, b.input_vertex);
  EXPECT_EQ(a.chart_of_face, b.chart_of_face);
  EXPECT_EQ(a.energy.symmetric_dirichlet, b.energy.symmetric_dirichlet);
  EXPECT_EQ(a.energy.p99, b.energy.p99);
  EXPECT_EQ(a.seam_over_root_area, b.seam_over_root_area);
}

/// What flattening gives where the mesh is one disk, numbered by where its vertices are: one place
/// per vertex.
std::vector<Vec2> bits_of_the_disk_pipeline(const TriangleList& mesh) {
  std::vector<Triangle> faces = mesh.faces;
  const std::vector<Index> order = arrange(mesh.positions, faces, Work()).vertices;
  const Flattening flattened = disks::run({in_order(mesh.positions, order, Work()), faces});
  std::vector<Vec2> uvs(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) uvs[order[i]] = flattened.uvs[i];
  return uvs;
}

/// A bit of everything: closed, with handles, one-sided, a disk, single triangles.
TriangleList zoo() {
  TriangleList mesh = meshes::together({disks::blob(2), meshes::torus(6), meshes::moebius(8),
                                        meshes::grid(4, 3), meshes::soup(meshes::octahedron())});
  // Each part in a place of its own, so that nothing is welded across.
  Index next = 0;
  for (const Index parts : {size_of(disks::blob(2).positions), Index{36}, Index{16}}) {
    for (Index v = 0; v < parts; ++v) mesh.positions[next + v].z() += 10 + next;
    next += parts;
  }
  return mesh;
}

TEST(Unwrap, OpensATetrahedron) {
  const TriangleList mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
  const Atlas atlas = unwrapped(mesh);
  expect_sound(mesh, atlas);
  EXPECT_EQ(atlas.charts.size(), 1);
  EXPECT_EQ(atlas.admitted.closed_components, 1);
}

TEST(Unwrap, OpensACubeAlongItsSeamOnce) {
  const TriangleList mesh = meshes::cube();
  const Atlas atlas = unwrapped(mesh);
  expect_sound(mesh, atlas);
  EXPECT_EQ(atlas.charts.size(), 1);
  // Cut along a path, a disk has twice the edges of the path on its boundary.
  EXPECT_GE(atlas.seam_over_root_area, 2 / std::sqrt(6.0) - 1e-12);
}

TEST(Unwrap, OpensATorus) {
  const TriangleList mesh = meshes::torus(8);
  const Atlas atlas = unwrapped(mesh);
  expect_sound(mesh, atlas);
  EXPECT_EQ(atlas.charts.size(), 1);
  EXPECT_GT(atlas.seam_over_root_area, 0);
}

TEST(Unwrap, PartsAMoebiusStripOnce) {
  const TriangleList mesh = meshes::moebius(12);
  const Atlas atlas = unwrapped(mesh);
  expect_sound(mesh, atlas);
  EXPECT_EQ(atlas.charts.size(), 1);
  EXPECT_EQ(atlas.admitted.one_sided_edges, 1);
}

TEST(Unwrap, PartsCubesThatTouchAlongAnEdge) {
  TriangleList mesh = meshes::together({meshes::cube(), meshes::cube()});
  for (std::size_t v = 8; v < mesh.positions.size(); ++v) mesh.positions[v] += Vec3(1, 1, 0);
  const Atlas atlas = unwrapped(mesh);
  expect_sound(mesh, atlas);
  EXPECT_EQ(atlas.charts.size(), 2);
  EXPECT_EQ(atlas.admitted.crowded_edges, 1);
}

TEST(Unwrap, WeldsASoupUnlessToldNotTo) {
  const TriangleList mesh = meshes::soup(meshes::cube());
  const Atlas welded = unwrapped(mesh);
  expect_sound(mesh, welded);
  EXPECT_EQ(welded.charts.size(), 1);
  const Atlas apart = unwrapped(mesh, {.admit = {.weld_distance = {}}});
  expect_sound(mesh, apart);
  EXPECT_EQ(apart.charts.size(), 12);
  EXPECT_NEAR(apart.energy.max, 2, 1e-12);  // single triangles are isometric
}

TEST(Unwrap, LaysComponentsSideBySideAtTheirScale) {
  TriangleList mesh = meshes::together({meshes::grid(6, 6), meshes::grid(3, 3)});
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    if (v >= meshes::grid(6, 6).positions.size()) mesh.positions[v] += Vec3(5, 0, 0);
  }
  const Atlas atlas = unwrapped(mesh);
  expect_sound(mesh, atlas);
  EXPECT_EQ(atlas.charts.size(), 2);
  EXPECT_NEAR(atlas.energy.max, 2, 1e-6);  // flat parts keep their size
  EXPECT_EQ(atlas.seam_over_root_area, 0);
}

TEST(Unwrap, LeavesADiskAsItStands) {
  // Its seam runs between vertices at one place.
  const TriangleList mesh = disks::opened(disks::blob(2), disks::seams_through(disks::blob(2), 3));
  const Atlas atlas = unwrapped(mesh);
  expect_sound(mesh, atlas);
  EXPECT_EQ(atlas.admitted.welded_vertices, 0);
  EXPECT_EQ(atlas.uvs.size(), mesh.positions.size());
  const Atlas welded = unwrapped(mesh, {.keep_disk = false});
  expect_sound(mesh, welded);
  EXPECT_GT(welded.admitted.welded_vertices, 0);
}

TEST(Unwrap, GivesOneDiskTheBitsOfTheDiskPipeline) {
  const TriangleList mesh = disks::opened(disks::blob(3), disks::seams_through(disks::blob(3), 3));
  const Atlas atlas = unwrapped(mesh);
  expect_sound(mesh, atlas);

  const std::vector<Vec2> uvs = bits_of_the_disk_pipeline(mesh);
  ASSERT_EQ(atlas.uvs.size(), uvs.size());
  for (std::size_t uv = 0; uv < uvs.size(); ++uv) {
    EXPECT_EQ(atlas.uvs[uv], uvs[atlas.input_vertex[uv]]);
  }
}

TEST(Unwrap, GivesTheSameBitsOnAnyNumberOfThreads) {
  const TriangleList mesh = zoo();
  const Atlas one = unwrapped(mesh);
  expect_sound(mesh, one);
  EXPECT_EQ(one.charts.size(), 5);
  expect_same_bits(one, unwrapped(mesh, {}, 2));
}

TEST(Unwrap, ScalesWithPowersOfTwo) {
  const TriangleList mesh = zoo();
  const Atlas atlas = unwrapped(mesh);
  for (const int exponent : {-1000, -3, 4, 900}) {
    TriangleList scaled = mesh;
    for (Vec3& p : scaled.positions) {
      for (double& x : p) x = std::ldexp(x, exponent);
    }
    Atlas same = unwrapped(scaled);
    for (Vec2& w : same.uvs) {
      for (double& x : w) x = std::ldexp(x, -exponent);
    }
    expect_same_bits(atlas, same);
  }
}

TEST(Unwrap, StaysInjectiveInSinglePrecision) {
  const TriangleList mesh = zoo();
  const Atlas atlas = unwrapped(mesh, {.float32 = true});
  expect_sound(mesh, atlas);
  for (const Vec2& w : atlas.uvs) EXPECT_EQ(w, w.cast<float>().cast<double>());
}

TEST(Unwrap, StaysInjectiveWhereItsDoublesAreRounded) {
  // Thin faces amid large ones: the floats nearest to their corners fold them.
  TriangleList mesh = meshes::grid(8, 8);
  for (Vec3& p : mesh.positions) {
    if (p.x() > 0 && p.x() < 1 && p.y() > 0 && p.y() < 1) p.y() = 0.9 + 1e-8 * p.y();
  }
  const auto rounded_injective = [&](const std::vector<Vec2>& uvs) {
    std::vector<Vec2> rounded = uvs;
    for (Vec2& w : rounded) w = w.cast<float>().cast<double>();
    return certify_atlas(mesh.faces, rounded, {}, Work(1)).injective();
  };
  EXPECT_FALSE(rounded_injective(bits_of_the_disk_pipeline(mesh)));
  const Atlas atlas = unwrapped(mesh);
  expect_sound(mesh, atlas);
  EXPECT_TRUE(rounded_injective(atlas.uvs));
}

TEST(Unwrap, PutsFacesWithoutAreaAtAPoint) {
  TriangleList mesh = meshes::grid(3, 3);
  mesh.faces.push_back({0, 1, 1});
  mesh.positions.push_back(0.5 * (mesh.positions[0] + mesh.positions[1]));
  mesh.faces.push_back({0, size_of(mesh.positions) - 1, 1});
  const Atlas atlas = unwrapped(mesh);
  expect_sound(mesh, atlas);
  EXPECT_EQ(atlas.admitted.repeated_faces, 1);
  EXPECT_EQ(atlas.admitted.faces_without_area, 1);
  EXPECT_EQ(atlas.certificate.excepted_faces, 2);
  for (const std::size_t f : {mesh.faces.size() - 2, mesh.faces.size() - 1}) {
    EXPECT_EQ(atlas.chart_of_face[f], kNone);
    // Where the grid has its corner.
    const Vec2& place = atlas.uvs[atlas.faces[f][0]];
    for (int k = 0; k < 3; ++k) EXPECT_EQ(atlas.uvs[atlas.faces[f][k]], place);
    EXPECT_NE(std::find(atlas.uvs.begin(), atlas.uvs.end() - 6, place), atlas.uvs.end() - 6);
  }
}

TEST(Unwrap, GivesCopiesOfFacesALayerOfTheirOwn) {
  TriangleList mesh = meshes::grid(3, 3);
  const std::vector<Triangle> front = mesh.faces;
  for (const auto& [a, b, c] : front) mesh.faces.push_back({a, c, b});
  const Atlas atlas = unwrapped(mesh);
  expect_sound(mesh, atlas);
  EXPECT_EQ(atlas.admitted.copies, size_of(front));
  EXPECT_EQ(atlas.charts.size(), 2);
}

TEST(Unwrap, RefusesWhatHasNoArea) {
  const TriangleList mesh{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}};
  try {
    unwrapped(mesh);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::kZeroArea);
  }
}

TEST(Unwrap, EndsOnRequestWithProgressThatNeverFalls) {
  const TriangleList mesh = zoo();
  double last = 0;
  int reports = 0;
  const auto watch = [&](double fraction, const char*) {
    EXPECT_GE(fraction, last);
    last = fraction;
    ++reports;
    return false;
  };
  unwrap({mesh.positions, mesh.faces}, {}, Work(Limits{}, watch));
  EXPECT_GT(reports, 5);
  const auto stop = [](double fraction, const char*) { return fraction > 0.3; };
  EXPECT_THROW(unwrap({mesh.positions, mesh.faces}, {}, Work(Limits{}, stop)), Cancelled);
}

/// A sphere of octahedra split often, with a few small holes.
TriangleList perforated() {
  TriangleList mesh = disks::blob(4);
  for (const Index f : {900, 500, 100}) mesh.faces.erase(mesh.faces.begin() + f);
  return mesh;
}

TEST(Unwrap, HolesCostNoSeam) {
  const TriangleList mesh = perforated();
  const Atlas atlas = unwrapped(mesh);
  expect_sound(mesh, atlas);
  EXPECT_EQ(atlas.charts.size(), 1);
  EXPECT_EQ(atlas.filled_holes, 3);
  EXPECT_EQ(atlas.admitted.components, 1);
  const Atlas joined = unwrapped(mesh, {.fill_limit = 0});
  expect_sound(mesh, joined);
  EXPECT_EQ(joined.filled_holes, 0);
  EXPECT_GT(joined.seam_length, 0);
}

TEST(Unwrap, CutsWhereItIsTold) {
  AtlasInput input{meshes::cube().positions, meshes::cube().faces};
  input.cuts.hard_angle = 1;
  const Atlas atlas = unwrap(input, {}, Work(1));
  expect_sound(meshes::cube(), atlas);
  EXPECT_EQ(atlas.charts.size(), 6);
  EXPECT_NEAR(atlas.energy.max, 2, 1e-9);
  EXPECT_NEAR(atlas.seam_length, 12, 1e-9);
}

TEST(Unwrap, OpensWhatTheGivenCutsLeaveClosed) {
  // A ring of faces around the cube parts it into two disks; a single edge parts nothing.
  AtlasInput input{meshes::cube().positions, meshes::cube().faces};
  for (Index f = 0; f < 12; ++f) input.cuts.labels.push_back(f < 2 ? 1 : 0);
  const Atlas two = unwrap(input, {}, Work(1));
  expect_sound(meshes::cube(), two);
  EXPECT_EQ(two.charts.size(), 2);
  input.cuts = {};
  input.cuts.edges = {{0, 1}};
  const Atlas one = unwrap(input, {}, Work(1));
  expect_sound(meshes::cube(), one);
  EXPECT_EQ(one.charts.size(), 1);
}

TEST(Unwrap, DensitiesScaleChartsAndAreNoDistortion) {
  const TriangleList mesh = meshes::soup(meshes::cube());
  AtlasInput input{mesh.positions, mesh.faces};
  input.cuts.hard_angle = 1;
  for (Index f = 0; f < 12; ++f) input.densities.push_back(f < 2 ? 3 : 1);
  const Atlas atlas = unwrap(input, {}, Work(1));
  expect_sound(mesh, atlas);
  EXPECT_NEAR(atlas.energy.max, 2, 1e-9);
  for (const ChartInfo& chart : atlas.charts) {
    const double width = chart.box.sizes().maxCoeff();
    EXPECT_EQ(chart.density, chart.first_face < 2 ? 3 : 1);
    EXPECT_GE(width, chart.density * (1 - 1e-9));
    EXPECT_LE(width, chart.density * (std::sqrt(2.0) + 1e-9));
  }
}

TEST(Unwrap, CopiesShareUvsOnDemand) {
  TriangleList mesh = meshes::grid(4, 4);
  const std::vector<Triangle> front = mesh.faces;
  for (const auto& [a, b, c] : front) mesh.faces.push_back({a, c, b});
  const Atlas apart = unwrapped(mesh);
  expect_sound(mesh, apart);
  EXPECT_EQ(apart.charts.size(), 2);
  AtlasOptions options;
  options.admit.share_copies = true;
  const Atlas shared = unwrapped(mesh, options);
  EXPECT_EQ(shared.outcome, Outcome::kOk);
  EXPECT_EQ(shared.charts.size(), 1);
  EXPECT_EQ(shared.admitted.copies, size_of(front));
  for (std::size_t f = 0; f < front.size(); ++f) {
    const Triangle &first = shared.faces[f], &copy = shared.faces[f + front.size()];
    EXPECT_EQ(copy, (Triangle{first[0], first[2], first[1]}));
    EXPECT_TRUE(shared.excepted[f + front.size()]);
  }
}

TEST(Unwrap, APolygonWithACopyStaysInOnePiece) {
  // Two quads that share a triangle, and one that has nothing to do with them.
  const TriangleList mesh{
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {-1, 1, 1}, {2, 0, 0}, {2, 1, 0}},
      {{0, 1, 2}, {0, 2, 3}, {0, 1, 2}, {0, 2, 4}, {1, 5, 6}, {1, 6, 2}}};
  const std::vector<Index> polygons = {0, 0, 1, 1, 2, 2};
  AtlasOptions options;
  options.admit.polygons = polygons;
  for (const bool share : {false, true}) {
    options.admit.share_copies = share;
    const Atlas atlas = unwrapped(mesh, options);
    EXPECT_EQ(atlas.outcome, Outcome::kOk);
    EXPECT_EQ(atlas.admitted.copies, 1);
    for (const std::size_t f : {0, 2, 4}) {
      EXPECT_EQ(atlas.chart_of_face[f], atlas.chart_of_face[f + 1]);
      EXPECT_FALSE(atlas.excepted[f]);
      EXPECT_FALSE(atlas.excepted[f + 1]);
    }
  }
}

TEST(Unwrap, FitsTheUnitSquareByAPowerOfTwo) {
  const TriangleList mesh = zoo();
  const Atlas atlas = unwrapped(mesh, {.unit_square = true});
  const Atlas usual = unwrapped(mesh);
  EXPECT_TRUE(atlas.certificate.injective());
  double greatest = 0;
  for (const Vec2& w : atlas.uvs) {
    EXPECT_GE(w.minCoeff(), 0);
    greatest = std::max(greatest, w.maxCoeff());
  }
  EXPECT_LE(greatest, 1);
  EXPECT_GT(greatest, 0.5);
  EXPECT_EQ(atlas.charts.size(), usual.charts.size());
  EXPECT_NEAR(atlas.energy.symmetric_dirichlet, usual.energy.symmetric_dirichlet, 1e-6);
}

TEST(Unwrap, NoSeamRunsThroughAPolygon) {
  // Grids and cubes are quads cut in two: faces 2 i and 2 i + 1 are one polygon.
  for (const TriangleList& mesh :
       {meshes::cube(), meshes::torus(8), meshes::moebius(9), meshes::soup(meshes::cube())}) {
    std::vector<Index> polygons;
    for (Index f = 0; f < size_of(mesh.faces); ++f) polygons.push_back(f / 2);
    AtlasOptions options;
    options.admit.polygons = polygons;
    const Atlas atlas = unwrapped(mesh, options);
    expect_sound(mesh, atlas);
    for (std::size_t f = 0; f + 1 < mesh.faces.size(); f += 2) {
      std::vector<Index> common;
      for (const Index a : atlas.faces[f]) {
        for (const Index b : atlas.faces[f + 1]) {
          if (a == b) common.push_back(a);
        }
      }
      EXPECT_EQ(common.size(), 2) << f;
    }
  }
}

// ---- With a target --------------------------------------------------------------------------

AtlasOptions aiming_at(double energy) {
  AtlasOptions options;
  options.target = SeamTarget{.energy = energy};
  return options;
}

/// The length of edges whose ends are both in the list and that are seams of the atlas: whose two
/// sides have different UV vertices.
double seam_length_among(const TriangleList& mesh, const Atlas& atlas,
                         const std::vector<bool>& is_listed) {
  std::map<std::pair<Index, Index>, std::pair<Index, Index>> sides;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const int l = next_corner(k);
      sides[{mesh.faces[f][k], mesh.faces[f][l]}] = {atlas.faces[f][k], atlas.faces[f][l]};
    }
  }
  double sum = 0;
  for (const auto& [edge, uvs] : sides) {
    const auto [a, b] = edge;
    if (a > b || !is_listed[a] || !is_listed[b]) continue;
    const auto& [c, d] = sides.at({b, a});
    if (uvs != std::pair(d, c)) sum += (mesh.positions[a] - mesh.positions[b]).norm();
  }
  return sum;
}

TEST(UnwrapToATarget, MeetsIt) {
  for (const TriangleList& mesh :
       {meshes::sphere(4), meshes::torus(20), disks::refined(meshes::cube(), 3)}) {
    double shorter = 0;
    for (const double energy : {2.05, 2.01}) {
      const Atlas atlas = unwrapped(mesh, aiming_at(energy));
      expect_sound(mesh, atlas);
      EXPECT_LE(atlas.energy.symmetric_dirichlet, energy + 1e-4);
      EXPECT_EQ(atlas.charts.size(), 1);
      EXPECT_GE(atlas.seam_over_root_area, 0.99 * shorter);
      shorter = atlas.seam_over_root_area;
    }
  }
}

TEST(UnwrapToATarget, AnythingIsUnwrapped) {
  const TriangleList mesh = zoo();
  for (const double energy : {2.02, 3.0, 100.0}) {
    const Atlas atlas = unwrapped(mesh, aiming_at(energy));
    expect_sound(mesh, atlas);
    EXPECT_LE(atlas.energy.symmetric_dirichlet, energy + 1e-4);
    EXPECT_EQ(atlas.admitted.components, 5);
  }
}

TEST(UnwrapToATarget, ATetrahedronIsOpenedForAnyEnergy) {
  const TriangleList mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
  for (const double energy : {2.0001, 2.5, 10.0, 1000.0}) {
    expect_sound(mesh, unwrapped(mesh, aiming_at(energy)));
  }
}

TEST(UnwrapToATarget, GivenCutsStayCut) {
  const TriangleList mesh = disks::refined(meshes::cube(), 2);
  AtlasInput input{mesh.positions, mesh.faces};
  input.cuts.hard_angle = 1;
  const Atlas sides = unwrap(input, aiming_at(2.05), Work(1));
  expect_sound(mesh, sides);
  EXPECT_EQ(sides.charts.size(), 6);
  EXPECT_NEAR(sides.seam_length, 12, 1e-9);
  input.cuts = {};
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) input.cuts.labels.push_back(f < 32 ? 1 : 0);
  const Atlas two = unwrap(input, aiming_at(2.05), Work(1));
  expect_sound(mesh, two);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    EXPECT_NE(two.chart_of_face[f], two.chart_of_face[f < 32 ? 32 : 0]);
  }
}

TEST(UnwrapToATarget, HolesCostNoSeamAndPolygonsStayWhole) {
  const TriangleList holes = perforated();
  const Atlas atlas = unwrapped(holes, aiming_at(2.05));
  expect_sound(holes, atlas);
  EXPECT_EQ(atlas.filled_holes, 3);
  EXPECT_LE(atlas.energy.symmetric_dirichlet, 2.05 + 1e-4);
  const TriangleList mesh = meshes::torus(10);
  std::vector<Index> polygons;
  for (Index f = 0; f < size_of(mesh.faces); ++f) polygons.push_back(f / 2);
  AtlasOptions options = aiming_at(2.05);
  options.admit.polygons = polygons;
  const Atlas quads = unwrapped(mesh, options);
  expect_sound(mesh, quads);
  for (std::size_t f = 0; f < mesh.faces.size(); f += 2) {
    // The diagonal runs from the first corner to the third.
    EXPECT_EQ(quads.faces[f][0], quads.faces[f + 1][0]);
    EXPECT_EQ(quads.faces[f][2], quads.faces[f + 1][1]);
  }
}

TEST(UnwrapToATarget, PaintKeepsSeamsAway) {
  // From where they are by far the most without.
  const TriangleList mesh = meshes::sphere(3);
  const Atlas usual = unwrapped(mesh, aiming_at(2.1));
  const std::vector<bool> all(mesh.positions.size(), true);
  EXPECT_NEAR(seam_length_among(mesh, usual, all), usual.seam_length, 1e-9);
  std::vector<bool> half, other;
  for (const Vec3& p : mesh.positions) {
    half.push_back(p.dot(Vec3(1, 2, 3)) > 0.1);
    other.push_back(p.dot(Vec3(1, 2, 3)) < -0.1);
  }
  if (seam_length_among(mesh, usual, half) < seam_length_among(mesh, usual, other)) half = other;
  AtlasInput input{mesh.positions, mesh.faces};
  for (const bool is_dear : half) input.hints.vertex_paint.push_back(is_dear ? kMostPaint : 1);
  const Atlas painted = unwrap(input, aiming_at(2.1), Work(1));
  expect_sound(mesh, painted);
  EXPECT_LT(seam_length_among(mesh, painted, half), 0.5 * seam_length_among(mesh, usual, half));
}

TEST(UnwrapToATarget, PaintDrawsSeams) {
  // A ring around a torus, by vertices or by edges, where no seam would be without.
  const Index n = 16, at = 3;
  const TriangleList mesh = meshes::torus(n);
  const Atlas usual = unwrapped(mesh, aiming_at(2.5));
  for (const bool is_across : {false, true}) {
    std::vector<bool> ring;
    for (Index v = 0; v < n * n; ++v) ring.push_back((is_across ? v % n : v / n) == at);
    AtlasInput input{mesh.positions, mesh.faces};
    for (const bool is_there : ring) input.hints.vertex_paint.push_back(is_there ? kLeastPaint : 1);
    const Atlas by_vertices = unwrap(input, aiming_at(2.5), Work(1));
    input.hints = {};
    for (const auto& [a, b, c] : mesh.faces) {
      for (const auto& [from, to] : {std::pair(a, b), {b, c}, {c, a}}) {
        if (ring[from] && ring[to]) input.hints.edge_paint.push_back({{to, from}, kLeastPaint});
      }
    }
    const Atlas by_edges = unwrap(input, aiming_at(2.5), Work(1));
    EXPECT_LT(seam_length_among(mesh, usual, ring), 1);
    for (const Atlas& painted : {by_vertices, by_edges}) {
      expect_sound(mesh, painted);
      EXPECT_GT(seam_length_among(mesh, painted, ring), 5);
    }
  }
}

TEST(UnwrapToATarget, TheSameBitsAtOneThreadAndAtTwoAndInAnyUnit) {
  const TriangleList mesh = meshes::together({disks::blob(3), meshes::torus(9)});
  const AtlasOptions options = aiming_at(2.05);
  const Atlas one = unwrapped(mesh, options);
  expect_same_bits(one, unwrapped(mesh, options, 2));
  TriangleList large = mesh;
  for (Vec3& p : large.positions) p *= 0x1p20;
  Atlas scaled = unwrapped(large, options);
  for (Vec2& w : scaled.uvs) w *= 0x1p-20;
  expect_same_bits(one, scaled);
}

}  // namespace
}  // namespace beltrami
