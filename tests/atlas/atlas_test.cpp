// Any triangles as an atlas: certified, every corner kept, the same whatever the threads and the
// unit.
#include "atlas/atlas.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/interrupt.h"
#include "base/types.h"
#include "base/vectors.h"
#include "chart/flattening.h"
#include "exact/atlas_certificate.h"
#include "mesh/locality.h"
#include "support/atlases.h"
#include "support/cuts.h"
#include "support/disks.h"
#include "support/meshes.h"
#include "support/run.h"
#include "support/surfaces.h"

namespace beltrami {
namespace {

using atlases::expect_same_bits;
using atlases::expect_sound;
using atlases::perforated;
using atlases::unwrapped;
using atlases::zoo;
using meshes::TriangleList;

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

TEST(Unwrap, HolesCostNoSeam) {
  const TriangleList mesh = perforated();
  const Atlas atlas = unwrapped(mesh);
  expect_sound(mesh, atlas);
  EXPECT_EQ(atlas.charts.size(), 1);
  EXPECT_EQ(atlas.filled_holes, 2) << "the longest stays";
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
  options.admit.polygons.polygon = polygons;
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

/// Unwraps faces 2 i and 2 i + 1 as one polygon each, and expects them to share two places.
void expect_polygons_whole(const TriangleList& mesh) {
  std::vector<Index> polygons;
  for (Index f = 0; f < size_of(mesh.faces); ++f) polygons.push_back(f / 2);
  AtlasOptions options;
  options.admit.polygons.polygon = polygons;
  const Atlas atlas = unwrapped(mesh, options);
  EXPECT_EQ(atlas.outcome, Outcome::kOk);
  EXPECT_TRUE(atlas.certificate.injective());
  for (std::size_t f = 0; f < mesh.faces.size(); f += 2) {
    int common = 0;
    for (const Index a : atlas.faces[f]) {
      for (const Index b : atlas.faces[f + 1]) common += atlas.uvs[a] == atlas.uvs[b] ? 1 : 0;
    }
    EXPECT_GE(common, 2) << f;
  }
}

TEST(Unwrap, APolygonThatLiesOnItselfIsUnfolded) {
  // A quad whose last corner is welded to its second one, beside another that meets its sides.
  expect_polygons_whole({{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}},
                         {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}}});
}

TEST(Unwrap, PolygonsThatCopyEachOtherInTurnStayInOnePiece) {
  // The first and the last one have a corner twice; the second has the triangles of both.
  expect_polygons_whole({{{0, 0, 0}, {1, 0, 0}, {1, -1, 0}, {0, 1, 0}},
                         {{0, 0, 1}, {0, 1, 2}, {3, 0, 1}, {0, 2, 1}, {3, 1, 0}, {3, 1, 1}}});
}

TEST(Unwrap, ACornerOfNoAreaLiesWithItsPolygon) {
  // The corner on the second quad's side is one of the first quad, which is another chart.
  expect_polygons_whole(
      {{{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}, {-1, 0, 0}, {1, 9, 0}, {-1, 9, 0}},
       {{0, 1, 2}, {0, 2, 3}, {4, 0, 1}, {4, 1, 5}, {4, 1, 5}, {4, 5, 6}}});
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
    options.admit.polygons.polygon = polygons;
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

}  // namespace
}  // namespace beltrami
