// Polygons into triangles, and vertices that are welded.
#include "files/surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>

#include "files/triangulate.h"
#include "process/failure.h"
#include "tiny_meshes.h"

namespace beltrami::cli {
namespace {

using Faces = std::vector<std::uint32_t>;

MeshFile polygon(const std::vector<std::array<double, 2>>& corners) {
  MeshFile mesh;
  for (const auto& [x, y] : corners) {
    // In a plane that is not one of the axes'.
    mesh.positions.insert(mesh.positions.end(), {x, y, 0.5 * x - 2 * y + 3});
    mesh.polygons.add_corner(static_cast<std::uint32_t>(mesh.positions.size() / 3 - 1));
  }
  mesh.polygons.end_polygon();
  return mesh;
}

double area(const MeshFile& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  const double* p = mesh.positions.data();
  const double x = p[3 * b] - p[3 * a], y = p[3 * b + 1] - p[3 * a + 1];
  return (x * (p[3 * c + 1] - p[3 * a + 1]) - y * (p[3 * c] - p[3 * a])) / 2;
}

/// n - 2 triangles that turn the same way and make up the polygon's area cover it once.
void expect_covered_once(const MeshFile& mesh) {
  const Faces faces = triangulate(mesh);
  const auto corners = mesh.polygons[0];
  ASSERT_EQ(faces.size(), 3 * (corners.size() - 2));
  double whole = 0, sum = 0;
  for (std::size_t i = 2; i < corners.size(); ++i) {
    whole += area(mesh, corners[0], corners[i - 1], corners[i]);
  }
  for (std::size_t i = 0; i < faces.size(); i += 3) {
    const double part = area(mesh, faces[i], faces[i + 1], faces[i + 2]);
    EXPECT_GT(part * whole, 0) << "triangle " << i / 3 << " is turned over";
    sum += part;
  }
  EXPECT_NEAR(sum, whole, 1e-9 * std::abs(whole));
}

TEST(Triangulate, LeavesTrianglesAlone) {
  const MeshFile mesh = read_obj(kSquare, "a.obj", Content::kSurface);
  EXPECT_EQ(triangulate(mesh), mesh.polygons.corners());
}

TEST(Triangulate, CutsADartInside) {
  for (int turn = 0; turn < 4; ++turn) {
    std::vector<std::array<double, 2>> dart = {{0, 0}, {4, 0}, {1, 1}, {0, 4}};
    std::rotate(dart.begin(), dart.begin() + turn, dart.end());
    expect_covered_once(polygon(dart));
  }
}

TEST(Triangulate, CutsCombsStarsAndSpirals) {
  std::vector<std::array<double, 2>> comb = {{0, -1}}, star, spiral;
  for (int i = 0; i < 50; ++i) {
    comb.push_back({i + 0.5, -1.0});
    comb.push_back({i + 0.6, 3.0});
    comb.push_back({i + 0.7, -1.0});
  }
  comb.insert(comb.end(), {{60, -1}, {60, -2}, {0, -2}});
  for (int i = 0; i < 40; ++i) {
    const double radius = i % 2 ? 1 : 5, angle = 2 * 3.14159265358979 * i / 40;
    star.push_back({radius * std::cos(angle), radius * std::sin(angle)});
  }
  for (int i = 0; i < 120; ++i) spiral.push_back({i * std::cos(i / 8.0), i * std::sin(i / 8.0)});
  for (int i = 120; i-- > 0;) {
    spiral.push_back({(i + 20) * std::cos(i / 8.0), (i + 20) * std::sin(i / 8.0)});
  }
  for (auto& shape : {comb, star, spiral}) {
    SCOPED_TRACE(shape.size());
    expect_covered_once(polygon(shape));
    expect_covered_once(polygon({shape.rbegin(), shape.rend()}));
  }
}

TEST(Triangulate, CutsPolygonsWithCornersOnStraightSides) {
  expect_covered_once(polygon({{0, 0}, {1, 0}, {2, 0}, {3, 0}, {3, 1}, {3, 2}, {0, 2}}));
}

TEST(Triangulate, CutsLargePolygons) {
  std::vector<std::array<double, 2>> wheel;
  for (int i = 0; i < 20000; ++i) {
    const double radius = 1 + 0.01 * (i % 2), angle = 2 * 3.14159265358979 * i / 20000;
    wheel.push_back({radius * std::cos(angle), radius * std::sin(angle)});
  }
  expect_covered_once(polygon(wheel));
}

TEST(Triangulate, EndsWhateverTheShape) {
  // All corners at one place, on a line, not finite, too great to subtract, crossing itself.
  std::mt19937 random(3);
  std::vector<MeshFile> meshes;
  for (const double x : {0.0, 1.0, std::nan(""), 1e308, 1e-310}) {
    std::vector<std::array<double, 2>> corners;
    for (int i = 0; i < 30; ++i) {
      corners.push_back({x * (x > 0 ? i % 7 - 3 : 1), 0});
    }
    meshes.push_back(polygon(corners));
    for (auto& corner : corners) {
      corner = {x * (static_cast<double>(random() % 100) - 50),
                x * (static_cast<double>(random() % 100) - 50)};
    }
    meshes.push_back(polygon(corners));
  }
  for (const MeshFile& mesh : meshes) {
    const Faces faces = triangulate(mesh);
    EXPECT_EQ(faces.size(), 3 * 28u);
    EXPECT_EQ(std::set<std::uint32_t>(faces.begin(), faces.end()).size(), 30u);
  }
}

TEST(Triangulate, NeverRepeatsAnEdge) {
  // Quads that meet in two sides, with a vertex between them that has no other: a diagonal from
  // 0 to 2 is free in one of them alone, and better in both.
  const std::string text = "v 0 0 0\nv 1 -2 0\nv 2 0 0\nv 1 0.1 0\nv 1 2 0\nf 1 2 3 4\nf 1 4 3 5\n";
  const Faces faces = triangulate(read_obj(text, "a.obj", Content::kSurface));
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    ++edges[{faces[i], faces[i % 3 == 2 ? i - 2 : i + 1]}];
  }
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1) << edge.first << " " << edge.second;
  }
}

TEST(Triangulate, RefusesWhatHasNoTriangles) {
  const auto status_of = [](const std::string& text) -> std::string {
    try {
      triangulate(read_obj(text, "a.obj", Content::kSurface));
    } catch (const Failure& failure) {
      EXPECT_EQ(failure.element, 1u);
      return failure.status;
    }
    return "cut";
  };
  const std::string four = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 2 0\n";
  EXPECT_EQ(status_of(four + "f 1 2 3\nf 1 3 4 3\n"), "BELTRAMI_E_REPEATED_VERTEX");
  // A pillow of two quads: the second has no free diagonal but the one that the first has not.
  EXPECT_EQ(status_of(four + "f 1 2 3 4\nf 4 3 2 1\n"), "cut");
  EXPECT_EQ(status_of(four + "f 1 2 3 4\nf 4 3 2 1\nf 1 3 5\n"), "FILE_ERROR");
}

TEST(Surface, NamesFacesOfTheFile) {
  const MeshFile mesh = read_obj(
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv -1 1 0\nv 2 0 0\nv 3 1 0\n"
      "f 1 2 3 4\nf 1 4 5\nf 2 6 7 3\n",
      "a.obj", Content::kSurface);
  const Surface surface(mesh, false);
  ASSERT_EQ(surface.view().face_count(), 5u);
  const std::vector<std::uint64_t> expected = {0, 0, 1, 2, 2};
  for (std::uint64_t i = 0; i < 5; ++i) EXPECT_EQ(surface.face_of(i), expected[i]) << i;
}

TEST(Surface, WeldsWhatIsAtOnePlace) {
  MeshFile mesh =
      read_obj("v 0 0 0\nv 1 0 0\nv 1 1 0\nv -0 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 4 5 6\n", "a.obj",
               Content::kSurface);
  EXPECT_EQ(component_count(Surface(mesh, false).view()), 2u);
  EXPECT_TRUE(welding_connects(mesh));
  const Surface surface(mesh, true);
  EXPECT_EQ(surface.welded_vertices(), 2u);
  const auto faces = surface.view().faces;
  EXPECT_EQ(Faces(faces.begin(), faces.end()), (Faces{0, 1, 2, 0, 2, 5}));
  std::vector<double> uvs = {1, 2, 3, 4, 5, 6, 0, 0, 0, 0, 7, 8};
  surface.spread_uvs(uvs);
  EXPECT_EQ(uvs, (std::vector<double>{1, 2, 3, 4, 5, 6, 1, 2, 5, 6, 7, 8}));
  // With UVs, only vertices that agree in them.
  mesh.uvs = {1, 2, 3, 4, 5, 6, 1, 2, 9, 9, 7, 8};
  EXPECT_EQ(Surface(mesh, true).welded_vertices(), 1u);
}

}  // namespace
}  // namespace beltrami::cli
