// Numbering by place, and sums at vertices that take the faces in chunks.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "descend/line_search.h"
#include "mesh/disk_mesh.h"
#include "mesh/locality.h"
#include "mesh/vertex_sums.h"
#include "support/disks.h"
#include "support/meshes.h"

namespace beltrami {
namespace {

using disks::Random;
using meshes::TriangleList;

bool is_permutation_of_indices(std::vector<Index> order) {
  std::sort(order.begin(), order.end());
  for (Index i = 0; i < size_of(order); ++i) {
    if (order[i] != i) return false;
  }
  return true;
}

TEST(HilbertCurve, VisitsEveryPointAndStaysNear) {
  const TriangleList grid = meshes::grid(63, 63);
  Random random(1);
  std::vector<Vec3> points = disks::disk(grid).positions;
  for (std::size_t i = points.size(); i-- > 1;) {
    std::swap(points[i], points[random.below(static_cast<int>(i + 1))]);
  }
  const std::vector<Index> order = along_hilbert_curve(points, Work(1));
  ASSERT_TRUE(is_permutation_of_indices(order));
  double way = 0;
  for (std::size_t i = 1; i < order.size(); ++i) {
    way += (points[order[i]] - points[order[i - 1]]).norm();
  }
  const double step = (points[order[1]] - points[order[0]]).norm();
  EXPECT_LT(way, 2.0 * static_cast<double>(points.size()) * std::max(step, 1.0 / 63));
}

TEST(HilbertCurve, DoesNotDependOnTheOrderOfThePoints) {
  const std::vector<Vec3> points = disks::disk(meshes::bumps(20, 20)).positions;
  std::vector<Vec3> reversed(points.rbegin(), points.rend());
  const auto order = along_hilbert_curve(points, Work(1));
  const auto other = along_hilbert_curve(reversed, Work(1));
  for (std::size_t i = 0; i < order.size(); ++i) {
    EXPECT_EQ(points[order[i]], reversed[other[i]]);
  }
}

TEST(HilbertCurve, TakesPointsThatCoincideAndTheEndsOfTheRange) {
  EXPECT_TRUE(along_hilbert_curve({}, Work(1)).empty());
  EXPECT_EQ(along_hilbert_curve({{1, 2, 3}, {1, 2, 3}, {1, 2, 3}}, Work(1)),
            (std::vector<Index>{0, 1, 2}));
  constexpr double kMost = std::numeric_limits<double>::max();
  EXPECT_TRUE(is_permutation_of_indices(along_hilbert_curve(
      {{-kMost, 0, 0}, {kMost, 0, 0}, {0, kMost, -kMost}, {0, 0, 5e-324}}, Work(1))));
}

TEST(ByLeastVertex, SortsAndKeepsTheOrderOfTies) {
  const std::vector<Triangle> faces = {{5, 3, 4}, {2, 0, 1}, {3, 1, 2}, {0, 4, 1}};
  EXPECT_EQ(by_least_vertex(6, faces, Work(1)), (std::vector<Index>{1, 3, 2, 0}));
  EXPECT_EQ(in_order(faces, {3, 0}, Work(1)), (std::vector<Triangle>{faces[3], faces[0]}));
}

TEST(Arrange, NumbersNeighboursNextToEachOtherWhateverTheThreads) {
  const TriangleList mesh = meshes::grid(40, 40);
  std::vector<Triangle> faces = mesh.faces;
  const Arrangement arranged = arrange(mesh.positions, faces, Work(1));
  EXPECT_TRUE(is_permutation_of_indices(arranged.vertices));
  EXPECT_TRUE(is_permutation_of_indices(arranged.faces));
  for (std::size_t f = 0; f < faces.size(); ++f) {
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(arranged.vertices[faces[f][k]], mesh.faces[arranged.faces[f]][k]);
    }
  }
  std::vector<Triangle> same = mesh.faces;
  EXPECT_EQ(arrange(mesh.positions, same, Work(3)).faces, arranged.faces);
  EXPECT_EQ(same, faces);
}

TEST(VertexSums, AreThoseOfALoopWhateverTheOrderAndTheThreads) {
  Random random(2);
  TriangleList list = meshes::grid(150, 150);  // three chunks of faces
  for (int shuffled = 0; shuffled < 2; ++shuffled) {
    const DiskMesh mesh = disks::disk(list);
    std::vector<VertexSums::Terms> terms(mesh.faces.size());
    for (auto& face : terms) face = {random.vec2(), random.vec2(), random.vec2()};
    std::vector<Vec2> expected(mesh.positions.size(), Vec2::Zero());
    for (std::size_t f = 0; f < terms.size(); ++f) {
      for (int k = 0; k < 3; ++k) expected[mesh.faces[f][k]] += terms[f][k];
    }
    const auto give = [&](Index f, VertexSums::Terms& corners) {
      corners = terms[f];
      return 0.5;
    };
    std::vector<Vec2> one, two(3, Vec2(7, 7));
    EXPECT_EQ(VertexSums(mesh.vertex_count(), mesh.faces, Work(1)).add_up(give, one),
              0.5 * mesh.face_count());
    EXPECT_EQ(VertexSums(mesh.vertex_count(), mesh.faces, Work(2)).add_up(give, two),
              0.5 * mesh.face_count());
    EXPECT_EQ(one, two);
    for (std::size_t v = 0; v < one.size(); ++v) EXPECT_LT((one[v] - expected[v]).norm(), 1e-12);
    for (std::size_t i = list.faces.size(); i-- > 1;) {
      std::swap(list.faces[i], list.faces[random.below(static_cast<int>(i + 1))]);
    }
  }
}

TEST(SingularSteps, AreThoseThatTheFirstOneComesFrom) {
  Random random(3);
  const DiskMesh mesh = disks::disk(meshes::grid(80, 80));
  const std::vector<Vec2> uvs = disks::flat_uvs(mesh);
  std::vector<Vec2> direction(uvs.size());
  for (Vec2& d : direction) d = 0.4 * random.vec2();
  const double first = first_singular_step(mesh.faces, uvs, direction, Work(1));
  ASSERT_TRUE(std::isfinite(first));
  EXPECT_TRUE(singular_steps(mesh.faces, uvs, direction, first, Work(1)).empty());
  const auto steps = singular_steps(mesh.faces, uvs, direction, 3 * first, Work(2));
  ASSERT_FALSE(steps.empty());
  double least = steps.front().length;
  for (const SingularStep& s : steps) {
    EXPECT_LT(s.length, 3 * first);
    least = std::min(least, s.length);
  }
  EXPECT_EQ(least, first);
  EXPECT_TRUE(std::is_sorted(steps.begin(), steps.end(),
                             [](const auto& a, const auto& b) { return a.face < b.face; }));

  // Of some faces: theirs, and no others.
  std::vector<Index> some;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    if (random.below(3) == 0) some.push_back(f);
  }
  auto expected = steps;
  std::erase_if(expected, [&](const SingularStep& s) {
    return !std::binary_search(some.begin(), some.end(), s.face);
  });
  std::reverse(some.begin(), some.end());
  const auto found = singular_steps_of(some, mesh.faces, uvs, direction, 3 * first, Work(2));
  ASSERT_LT(found.size(), steps.size());
  EXPECT_TRUE(std::equal(
      found.begin(), found.end(), expected.begin(), expected.end(),
      [](const auto& a, const auto& b) { return a.face == b.face && a.length == b.length; }));
}

}  // namespace
}  // namespace beltrami
