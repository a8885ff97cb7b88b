// The embedding in integers.
#include "descend/grid_drawing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/work.h"
#include "exact/certificate.h"
#include "support/disks.h"
#include "support/meshes.h"

namespace beltrami {
namespace {

/// Disks with inner vertices only, none at all, chords, bridges, hubs and a boundary of three.
std::vector<meshes::TriangleList> all_disks() {
  return {meshes::triangle(),
          meshes::quad(),
          meshes::fan(3),
          meshes::fan(40),
          meshes::strip(1),
          meshes::strip(61),
          meshes::bumps(20, 7),
          disks::dumbbell(5),
          disks::tube(25, 5, 0.3),
          disks::slit(6),
          disks::degenerate_faces(9),
          disks::punctured(4)};
}

TEST(GridDrawing, IsInjectiveForEveryDisk) {
  for (const meshes::TriangleList& list : all_disks()) {
    const DiskMesh mesh = disks::disk(list);
    const std::vector<Vec2> uvs = grid_drawing(mesh);
    EXPECT_TRUE(certify(mesh.faces, mesh.boundary, uvs, Work(1)).injective()) << mesh.face_count();
  }
}

TEST(GridDrawing, IsOnAGridOfTwiceAsManyLinesAsVertices) {
  for (const meshes::TriangleList& list : all_disks()) {
    const DiskMesh mesh = disks::disk(list);
    const double lines = mesh.vertex_count();
    const int exponent = static_cast<int>(std::lround(std::log2(lines)));
    for (const Vec2& w : grid_drawing(mesh)) {
      const Vec2 place(std::ldexp(w.x(), exponent), std::ldexp(w.y(), exponent));
      EXPECT_EQ(place, Vec2(place.array().round()));
      EXPECT_TRUE(place.x() >= 0 && place.x() <= 2 * lines - 4) << place.x();
      EXPECT_TRUE(place.y() >= 0 && place.y() <= lines - 2) << place.y();
    }
  }
}

}  // namespace
}  // namespace beltrami
