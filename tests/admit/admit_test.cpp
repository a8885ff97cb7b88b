// Any triangles as oriented manifold pieces.
#include "admit/admit.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/interrupt.h"
#include "support/meshes.h"
#include "support/polls.h"
#include "support/surfaces.h"

namespace beltrami {
namespace {

using meshes::TriangleList;

Admitted admitted(const TriangleList& mesh, const AdmitOptions& options = {}, int threads = 1) {
  return admit(mesh.positions, mesh.faces, options, Work(threads));
}

/// Every face is on the surface or set aside, and each corner lies where the input has it.
void expect_every_corner(const TriangleList& mesh, const Admitted& result) {
  EXPECT_EQ(result.input_face.size() + result.set_aside.size(), mesh.faces.size());
  std::vector<bool> met(mesh.faces.size(), false);
  for (const Index f : result.set_aside) met[f] = true;
  for (Index f = 0; f < result.surface.face_count(); ++f) {
    const Index input = result.input_face[f];
    EXPECT_FALSE(met[input]);
    met[input] = true;
    for (int k = 0; k < 3; ++k) {
      const Index v = mesh.faces[input][result.input_corner(f, k)];
      const Index own = result.surface.faces[f][k];
      EXPECT_EQ(result.surface.positions[own], mesh.positions[v]);
      EXPECT_LE(result.input_vertex[own], v);
    }
  }
}

/// Corners of the input in sets of those that share a vertex of the surface.
std::set<std::set<Index>> corner_classes(const Admitted& result, const std::vector<Index>& order) {
  std::vector<std::set<Index>> classes(result.surface.positions.size());
  for (Index f = 0; f < result.surface.face_count(); ++f) {
    for (int k = 0; k < 3; ++k) {
      classes[result.surface.faces[f][k]].insert(3 * order[result.input_face[f]] +
                                                 result.input_corner(f, k));
    }
  }
  return {classes.begin(), classes.end()};
}

TEST(Admit, LeavesASoundSurfaceAsItIs) {
  const TriangleList mesh = meshes::torus(5);
  const Admitted result = admitted(mesh);
  EXPECT_EQ(result.surface.faces, mesh.faces);
  EXPECT_EQ(result.surface.positions, mesh.positions);
  EXPECT_EQ(result.counts.components, 1);
  EXPECT_EQ(result.counts.closed_components, 1);
  EXPECT_EQ(result.counts.reversed_faces + result.counts.split_vertices, 0);
}

TEST(Admit, WeldsASoupOfEqualPositions) {
  const TriangleList soup = meshes::soup(meshes::cube());
  const Admitted result = admitted(soup);
  expect_every_corner(soup, result);
  EXPECT_EQ(result.surface.vertex_count(), 8);
  EXPECT_EQ(result.counts.welded_vertices, 28);
  EXPECT_EQ(result.counts.closed_components, 1);
  EXPECT_EQ(admitted(soup, {.weld_distance = std::nullopt}).counts.components, 12);
}

TEST(Admit, WeldsWithinADistance) {
  TriangleList soup = meshes::soup(meshes::cube());
  for (Index v = 0; v < size_of(soup.positions); ++v) soup.positions[v].x() += 1e-6 * (v % 5);
  EXPECT_EQ(admitted(soup).counts.components, 12);
  const Admitted result = admitted(soup, {.weld_distance = 1e-5});
  EXPECT_EQ(result.surface.vertex_count(), 8);
  EXPECT_EQ(result.counts.closed_components, 1);
}

TEST(Admit, SetsFacesWithoutAreaAside) {
  TriangleList mesh = meshes::quad();
  mesh.positions.push_back({0.5, 0, 0});
  mesh.positions.push_back({1, 0, 0});  // at vertex 1
  mesh.faces.push_back({0, 0, 2});
  mesh.faces.push_back({0, 4, 1});
  mesh.faces.push_back({1, 2, 5});
  const Admitted result = admitted(mesh);
  expect_every_corner(mesh, result);
  EXPECT_EQ(result.set_aside, (std::vector<Index>{2, 3, 4}));
  EXPECT_EQ(result.counts.repeated_faces, 2);
  EXPECT_EQ(result.counts.faces_without_area, 1);
  EXPECT_EQ(result.counts.components, 1);
}

TEST(Admit, KnowsAreaAtAnyScale) {
  for (const double scale : {1e-310, 1e-160, 1.0, 1e160, 1e300}) {
    TriangleList mesh = meshes::quad();
    for (Vec3& p : mesh.positions) p *= scale;
    EXPECT_TRUE(admitted(mesh).set_aside.empty()) << scale;
  }
}

TEST(Admit, RefusesWhatIsNoMesh) {
  const auto fault_of = [](const TriangleList& mesh) -> std::optional<Fault> {
    try {
      admitted(mesh);
    } catch (const Error& error) {
      return error.fault();
    }
    return std::nullopt;
  };
  EXPECT_EQ(fault_of({}), Fault::kEmpty);
  TriangleList mesh = meshes::quad();
  mesh.faces[1] = {0, 0, 4};
  EXPECT_EQ(fault_of(mesh), Fault::kIndexOutOfRange);
  mesh.faces = {{0, 0, 1}};
  EXPECT_EQ(fault_of(mesh), Fault::kZeroArea);
  mesh.positions[3].x() = std::numeric_limits<double>::infinity();
  EXPECT_EQ(fault_of(mesh), Fault::kNonFinite);
}

TEST(Admit, TurnsTheFewerFacesOver) {
  TriangleList mesh = meshes::grid(4, 3);
  const auto turn = [&](Index f) { std::swap(mesh.faces[f][1], mesh.faces[f][2]); };
  for (const Index f : {0, 7, 13}) turn(f);
  const Admitted result = admitted(mesh);
  expect_every_corner(mesh, result);
  EXPECT_EQ(result.counts.reversed_faces, 3);
  EXPECT_TRUE(result.reversed[0] && result.reversed[7] && result.reversed[13]);
  EXPECT_TRUE(result.topology.components[0].is_disk());
}

// What the file calls the front of a few faces is the front in the map, at the cost of a short
// seam.
TEST(Admit, PartsFewFacesThatRunAgainstTheirNeighbours) {
  TriangleList mesh = meshes::grid(12, 12);
  const auto turn = [&](Index f) { std::swap(mesh.faces[f][1], mesh.faces[f][2]); };
  for (const Index f : {100, 101}) turn(f);
  const Admitted result = admitted(mesh);
  expect_every_corner(mesh, result);
  EXPECT_EQ(result.counts.reversed_faces, 0);
  ASSERT_EQ(result.counts.components, 2);
  EXPECT_EQ(result.topology.components[0].loops, 2);
  EXPECT_TRUE(result.topology.components[1].is_disk());
}

// Whatever its unit is: lengths are measured by the component's own area.
TEST(Admit, PartsTheSameFacesAtAnyScale) {
  for (const double scale : {1e-200, 1.0, 1e200}) {
    TriangleList mesh = meshes::grid(12, 12);
    std::swap(mesh.faces[100][1], mesh.faces[100][2]);
    for (Vec3& p : mesh.positions) p *= scale;
    EXPECT_EQ(admitted(mesh).counts.components, 2) << scale;
  }
}

TEST(Admit, OpensAMoebiusStripOnce) {
  const TriangleList mesh = meshes::moebius(9);
  const Admitted result = admitted(mesh);
  expect_every_corner(mesh, result);
  EXPECT_EQ(result.counts.one_sided_edges, 1);
  ASSERT_EQ(result.counts.components, 1);
  EXPECT_TRUE(result.topology.components[0].is_disk());
}

TEST(Admit, SplitsAVertexWithTwoFans) {
  const TriangleList mesh = meshes::bowtie();
  const Admitted result = admitted(mesh);
  expect_every_corner(mesh, result);
  EXPECT_EQ(result.counts.components, 2);
  EXPECT_EQ(result.counts.split_vertices, 1);
  EXPECT_EQ(result.input_vertex, (std::vector<Index>{0, 0, 1, 2, 3, 4}));
}

TEST(Admit, ClosedPartsThatTouchAlongAnEdgeStayClosed) {
  TriangleList mesh = meshes::together({meshes::cube(), meshes::cube()});
  for (Index v = 8; v < 16; ++v) mesh.positions[v] += Vec3(1, 1, 0);
  const Admitted result = admitted(mesh);
  expect_every_corner(mesh, result);
  EXPECT_EQ(result.counts.crowded_edges, 1);
  EXPECT_EQ(result.counts.closed_components, 2);
}

TEST(Admit, ATJunctionStaysASeam) {
  TriangleList mesh;
  mesh.positions = {{0, 0, 0}, {2, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, -1, 0}, {2, -1, 0}};
  mesh.faces = {{0, 1, 2}, {0, 4, 3}, {3, 4, 5}, {3, 5, 1}};
  const Admitted result = admitted(mesh);
  expect_every_corner(mesh, result);
  EXPECT_EQ(result.counts.components, 2);
}

TEST(Admit, CopiesLieInLayersOfTheirOwn) {
  TriangleList mesh = meshes::grid(3, 3);
  const Index count = size_of(mesh.faces);
  mesh.faces.push_back({mesh.faces[4][1], mesh.faces[4][2], mesh.faces[4][0]});
  mesh.faces.push_back({mesh.faces[4][1], mesh.faces[4][0], mesh.faces[4][2]});
  const Admitted result = admitted(mesh);
  expect_every_corner(mesh, result);
  EXPECT_EQ(result.counts.copies, 2);
  EXPECT_EQ(result.copies[0].face, count);
  EXPECT_EQ(result.copies[1].first, 4);
  EXPECT_EQ(result.counts.components, 3);
  EXPECT_EQ(result.counts.crowded_edges, 0);
}

TEST(Admit, ADoubleSidedSurfaceIsTwo) {
  for (const TriangleList& front : {meshes::grid(4, 4), meshes::octahedron()}) {
    TriangleList mesh = front;
    for (const auto& [a, b, c] : front.faces) mesh.faces.push_back({a, c, b});
    const Admitted result = admitted(mesh);
    expect_every_corner(mesh, result);
    EXPECT_EQ(result.counts.components, 2);
    EXPECT_EQ(result.counts.reversed_faces, 0);
    EXPECT_EQ(result.surface.vertex_count(), 2 * size_of(front.positions));
  }
}

TEST(Admit, TakesAnySoup) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const TriangleList mesh = meshes::random_soup(5 + static_cast<Index>(seed % 20), 60, seed);
    const Admitted result = admitted(mesh);
    expect_every_corner(mesh, result);
    for (const Component& component : result.topology.components) {
      EXPECT_GE(component.genus(), 0);
      EXPECT_EQ((2 - component.loops - component.euler()) % 2, 0) << "orientable";
    }
  }
}

TEST(Admit, TheOrderOfFacesChangesNoClass) {
  const TriangleList crowded = meshes::together(
      {meshes::cube(), meshes::three_on_an_edge(), meshes::bowtie(), meshes::annulus(6)});
  TriangleList mesh = crowded;
  for (Index v = 0; v < 8; ++v) mesh.positions.push_back(crowded.positions[v] + Vec3(1, 1, 0));
  const Index first = size_of(crowded.positions);
  for (const auto& [a, b, c] : meshes::cube().faces) {
    mesh.faces.push_back({first + a, first + b, first + c});
  }
  std::vector<Index> order(mesh.faces.size());
  for (Index f = 0; f < size_of(order); ++f) order[f] = f;
  const auto expected = corner_classes(admitted(mesh), order);
  for (std::uint64_t seed = 1; seed < 20; ++seed) {
    order = meshes::shuffled(size_of(mesh.faces), seed);
    TriangleList other = mesh;
    for (Index f = 0; f < size_of(order); ++f) other.faces[f] = mesh.faces[order[f]];
    EXPECT_EQ(corner_classes(admitted(other), order), expected);
  }
}

TEST(Admit, CanBeCancelledAnywhere) {
  const TriangleList mesh = meshes::soup(meshes::torus(100));
  const std::int64_t polls = count_polls([&] { admitted(mesh); });
  EXPECT_GT(polls, 50);
  for (const std::int64_t last : {polls / 3, polls / 2, polls}) {
    EXPECT_THROW(count_polls([&] { admitted(mesh); }, last), Cancelled);
  }
}

TEST(Admit, IsTheSameAtAnyThreadCount) {
  TriangleList mesh = meshes::soup(meshes::torus(150));
  mesh = meshes::together({mesh, meshes::random_soup(2000, 20'000, 1)});
  for (const AdmitOptions& options : {AdmitOptions{}, AdmitOptions{.weld_distance = 1e-3}}) {
    const Admitted one = admitted(mesh, options, 1), two = admitted(mesh, options, 2);
    EXPECT_EQ(one.surface.faces, two.surface.faces);
    EXPECT_EQ(one.surface.twin, two.surface.twin);
    EXPECT_EQ(one.input_vertex, two.input_vertex);
    EXPECT_EQ(one.reversed, two.reversed);
  }
}

}  // namespace
}  // namespace beltrami
