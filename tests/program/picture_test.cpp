// The picture: what must be seen on it, whatever it looks like.
#include "picture/picture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "files/mesh_file.h"
#include "picture/raster.h"
#include "picture/view.h"
#include "tiny_meshes.h"

namespace beltrami::cli {
namespace {

std::array<int, 3> pixel(const Image& image, int x, int y) {
  const std::uint8_t* p = &image.rgb[3 * (static_cast<std::size_t>(y) * image.width + x)];
  return {p[0], p[1], p[2]};
}

bool is_white(const std::array<int, 3>& color) {
  return color[0] > 250 && color[1] > 250 && color[2] > 250;
}

/// Of a mesh of triangles.
TriangleView view(const MeshFile& mesh) {
  return {mesh.positions, mesh.polygons.corners(), mesh.uvs};
}

TEST(Picture, ShowsLayoutAndModelOnWhite) {
  const MeshFile mesh = read_obj(kSquareWithUvs, "a.obj", Content::kUvs);
  const Image image = render_picture(view(mesh), {2.0, 2.0});
  ASSERT_EQ(image.width, 1600);
  ASSERT_EQ(image.height, 800);
  EXPECT_TRUE(is_white(pixel(image, 2, 2)));
  EXPECT_TRUE(is_white(pixel(image, 1597, 797)));
  EXPECT_FALSE(is_white(pixel(image, 300, 400)));
  EXPECT_FALSE(is_white(pixel(image, 1200, 400)));
}

TEST(Picture, MarksFlippedFacesRed) {
  const MeshFile mesh = read_obj(kSquareWithFlip, "a.obj", Content::kUvs);
  const Image image = render_picture(view(mesh), {2.0, std::numeric_limits<double>::infinity()});
  int red = 0;
  for (int y = 0; y < 700; ++y) {
    for (int x = 0; x < 800; ++x) {
      const auto color = pixel(image, x, y);
      red += color[0] > 200 && color[1] < 60 && color[2] < 70;
    }
  }
  EXPECT_GT(red, 10000);
}

TEST(Picture, SurvivesMapsWithoutExtent) {
  MeshFile mesh = read_obj(kSquareWithUvs, "a.obj", Content::kUvs);
  mesh.uvs.assign(8, 0.5);
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(render_picture(view(mesh), {infinity, infinity}).width, 1600);
  mesh.positions.assign(12, 1.0);
  EXPECT_EQ(render_picture(view(mesh), {infinity, infinity}).width, 1600);
}

TEST(Picture, IsAPng) {
  Image image;
  image.width = 2;
  image.height = 1;
  image.rgb = {255, 0, 0, 0, 255, 0};
  EXPECT_EQ(encode_png(image).substr(1, 3), "PNG");
}

TEST(View, LooksAtTheFrontOfAnOpenSurface) {
  for (const double side : {1.0, -1.0}) {
    MeshFile mesh = read_obj(grid(6), "a.obj", Content::kSurface);
    for (std::size_t i = 0; i < mesh.positions.size(); i += 3) mesh.positions[i] *= side;
    // Mirrored, the grid faces -z.
    EXPECT_GT(side * choose_view(view(mesh), {}).toward[2], 0.5);
  }
}

TEST(Raster, NeighboursLeaveNoGapAndDepthDecides) {
  int covered = 0;
  const Point a{0.3, 0.2}, b{9.7, 0.9}, c{8.8, 9.6}, d{0.1, 9.9};
  std::vector<int> hits(100, 0);
  const auto count = [&](int x, int y, const Weights&) { ++hits[10 * y + x]; };
  visit_triangle(a, b, c, 10, 10, count);
  visit_triangle(a, c, d, 10, 10, count);
  for (int y = 2; y < 8; ++y) {
    for (int x = 2; x < 8; ++x) covered += hits[10 * y + x] > 0;
  }
  EXPECT_EQ(covered, 36);

  Canvas canvas(4, 4);
  const auto fill = [&](double depth, Color color) {
    canvas.fill_triangle({-9, -9, depth}, {20, -9, depth}, {-9, 20, depth},
                         [&](const Weights&) { return color; });
  };
  fill(2, {1, 0, 0});
  fill(1, {0, 1, 0});
  EXPECT_EQ(canvas.sample(1, 1)[0], 255);
  EXPECT_EQ(canvas.sample(1, 1)[1], 0);
}

}  // namespace
}  // namespace beltrami::cli
