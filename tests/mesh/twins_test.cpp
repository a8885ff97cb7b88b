// Opposite half-edges, against those of a map.
#include "mesh/twins.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <vector>

#include "base/types.h"
#include "base/work.h"
#include "mesh/locality.h"
#include "support/meshes.h"
#include "support/surfaces.h"

namespace beltrami {
namespace {

using meshes::TriangleList;

std::vector<Index> twins_by_a_map(const std::vector<Triangle>& faces) {
  std::map<std::array<Index, 2>, Index> halfedges;
  const auto for_each = [&](const auto& visit) {
    for (Index h = 0; h < 3 * size_of(faces); ++h) {
      visit(h, faces[h / 3][h % 3], faces[h / 3][next_corner(h % 3)]);
    }
  };
  for_each([&](Index h, Index from, Index to) { halfedges[{from, to}] = h; });
  std::vector<Index> twins;
  for_each([&](Index, Index from, Index to) {
    const auto twin = halfedges.find({to, from});
    twins.push_back(twin == halfedges.end() ? kNone : twin->second);
  });
  return twins;
}

void expect_twins(Index vertex_count, const std::vector<Triangle>& faces) {
  const std::vector<Index> expected = twins_by_a_map(faces);
  for (const int threads : {1, 2, 7}) {
    EXPECT_EQ(pair_halfedges(vertex_count, faces, Work(threads)), expected);
  }
}

TEST(PairHalfedges, FindsThemWhateverTheOrderOfTheFaces) {
  for (const TriangleList& mesh : {meshes::triangle(), meshes::tetrahedron(), meshes::torus(4),
                                   meshes::annulus(7), meshes::bumps(80, 80)}) {
    const Index vertices = size_of(mesh.positions);
    std::vector<Triangle> faces = mesh.faces;
    expect_twins(vertices, faces);
    std::reverse(faces.begin(), faces.end());
    expect_twins(vertices, faces);
    arrange(mesh.positions, faces, Work(1));
    expect_twins(vertices, faces);
  }
}

TEST(PairHalfedges, FindsThoseOfHubs) {
  TriangleList fan = meshes::fan(300);
  const Index vertices = size_of(fan.positions);
  expect_twins(vertices, fan.faces);
  // The hub last.
  for (Triangle& face : fan.faces) {
    for (Index& v : face) v = vertices - 1 - v;
  }
  expect_twins(vertices, fan.faces);
}

TEST(PairHalfedges, TellsNumbersApartThatAgreeInTheirLastBits) {
  const TriangleList grid = meshes::grid(12, 12);
  for (const Index stride : {16, 256, 4096}) {
    std::vector<Triangle> faces = grid.faces;
    for (Triangle& face : faces) {
      for (Index& v : face) v *= stride;
    }
    expect_twins(size_of(grid.positions) * stride, faces);
  }
}

}  // namespace
}  // namespace beltrami
