// Charts whose real faces do not hang together: parted where every part is a disk, each with the
// map that it had.
#include "atlas/chart_parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

#include "admit/admit.h"
#include "atlas/map_charts.h"
#include "atlas/open.h"
#include "base/vectors.h"
#include "base/work.h"
#include "mesh/disk_mesh.h"

namespace beltrami {
namespace {

/// A plane of squares with two triangles each, the real ones first, mapped onto itself.
struct Plane {
  Admitted admitted;
  std::vector<AtlasChart> charts;
  std::vector<MappedChart> maps;
};

template <class IsReal>
Plane plane(Index columns, Index rows, const IsReal& is_real) {
  Plane plane;
  AtlasChart& chart = plane.charts.emplace_back();
  MappedChart& map = plane.maps.emplace_back();
  std::vector<Vec3> positions;
  for (Index y = 0; y <= rows; ++y) {
    for (Index x = 0; x <= columns; ++x) {
      positions.emplace_back(x, y, 0);
      map.uvs.emplace_back(x, y);
    }
  }
  std::vector<Triangle> faces;
  for (const bool real : {true, false}) {
    for (Index y = 0; y < rows; ++y) {
      for (Index x = 0; x < columns; ++x) {
        if (is_real(x, y) != real) continue;
        const Index a = y * (columns + 1) + x, d = a + columns + 1;
        faces.push_back({a, a + 1, d + 1});
        faces.push_back({a, d + 1, d});
      }
    }
    if (real) chart.real_faces = size_of(faces);
  }
  chart.chart.input_vertex.resize(positions.size());
  chart.chart.input_face.resize(faces.size());
  plane.admitted.input_face.resize(faces.size());
  std::iota(chart.chart.input_vertex.begin(), chart.chart.input_vertex.end(), 0);
  std::iota(chart.chart.input_face.begin(), chart.chart.input_face.end(), 0);
  plane.admitted.input_face = chart.chart.input_face;
  chart.chart.mesh = build_disk(std::move(positions), std::move(faces), Work(1));
  return plane;
}

void separate(Plane& plane, Index most_charts) {
  separate_pieces(plane.admitted, most_charts, plane.charts, plane.maps, Work(1));
}

TEST(ChartParts, AreThePiecesThatVirtualFacesJoined) {
  const auto is_real = [](Index x, Index) { return x != 1 && x != 4; };
  const Plane whole = plane(6, 3, is_real);
  Plane parted = whole;
  separate(parted, 0);
  ASSERT_EQ(parted.charts.size(), 3u);
  Index real = 0, faces = 0;
  for (std::size_t c = 0; c < parted.charts.size(); ++c) {
    const AtlasChart& chart = parted.charts[c];
    const std::vector<Index> pieces = real_pieces(chart);
    EXPECT_EQ(std::count(pieces.begin(), pieces.end(), 0), chart.real_faces);
    real += chart.real_faces;
    faces += size_of(chart.chart.mesh.faces);
    ASSERT_EQ(parted.maps[c].uvs.size(), chart.chart.input_vertex.size());
    for (std::size_t v = 0; v < parted.maps[c].uvs.size(); ++v) {
      EXPECT_EQ(parted.maps[c].uvs[v], whole.maps[0].uvs[chart.chart.input_vertex[v]]);
    }
    if (c > 0) {
      EXPECT_LT(first_input_face(parted.charts[c - 1], parted.admitted),
                first_input_face(chart, parted.admitted));
    }
  }
  EXPECT_EQ(real, whole.charts[0].real_faces);
  EXPECT_EQ(faces, size_of(whole.charts[0].chart.mesh.faces));
}

TEST(ChartParts, ArePartedAtAVertex) {
  Plane parted = plane(2, 2, [](Index x, Index y) { return x == y; });
  separate(parted, 0);
  ASSERT_EQ(parted.charts.size(), 2u);
  EXPECT_EQ(parted.charts[0].real_faces, 2);
  EXPECT_EQ(parted.charts[1].real_faces, 2);
}

TEST(ChartParts, StayTogetherWhereOneWouldBeNoDisk) {
  Plane island = plane(5, 5, [](Index x, Index y) {
    return x == 0 || y == 0 || x == 4 || y == 4 || (x == 2 && y == 2);
  });
  separate(island, 0);
  EXPECT_EQ(island.charts.size(), 1u);
}

TEST(ChartParts, AreNoMoreThanThereMayBe) {
  Plane parted = plane(6, 3, [](Index x, Index) { return x != 1 && x != 4; });
  separate(parted, 2);
  EXPECT_EQ(parted.charts.size(), 1u);
  separate(parted, 3);
  EXPECT_EQ(parted.charts.size(), 3u);
}

TEST(ChartParts, LeaveChartsWithPins) {
  Plane parted = plane(3, 1, [](Index x, Index) { return x != 1; });
  parted.maps[0].held.assign(parted.maps[0].uvs.size(), false);
  separate(parted, 0);
  EXPECT_EQ(parted.charts.size(), 1u);
}

}  // namespace
}  // namespace beltrami
