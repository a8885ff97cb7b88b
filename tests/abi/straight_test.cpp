// Straight borders through the C ABI: grids of quads, rectangles, edges, pins that slide, and
// borders on the edges of texels.
#include <beltrami/beltrami.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "abi/host.h"
#include "base/portable_math.h"
#include "base/vectors.h"
#include "support/meshes.h"

namespace beltrami::host {
namespace {

using Uv = std::array<double, 2>;

/// Columns and rows of quads, or of their halves; `closed`: the last column meets the first.
struct Sheet {
  std::uint32_t columns, rows;
  bool closed = false;
  std::vector<Vec3> positions = {};
  std::vector<std::uint32_t> corners = {}, sizes = {};
  std::vector<std::uint32_t> seams = {};

  std::uint32_t across() const { return closed ? columns : columns + 1; }
  std::uint32_t vertex(std::uint32_t i, std::uint32_t j) const {
    return j * across() + i % across();
  }

  beltrami_surface view() const {
    beltrami_surface surface = polygon_view(positions, corners, sizes);
    if (!seams.empty()) surface.seams = {seams.data(), 0, BELTRAMI_U32, 0};
    surface.seam_count = seams.size() / 2;
    return surface;
  }
};

Sheet sheet(std::uint32_t columns, std::uint32_t rows, bool closed, bool halves,
            const std::function<Vec3(double, double)>& place) {
  Sheet made{.columns = columns, .rows = rows, .closed = closed};
  for (std::uint32_t j = 0; j <= rows; ++j) {
    for (std::uint32_t i = 0; i < made.across(); ++i) {
      made.positions.push_back(
          place(static_cast<double>(i) / columns, static_cast<double>(j) / rows));
    }
    if (closed && j < rows) {
      made.seams.insert(made.seams.end(), {made.vertex(0, j), made.vertex(0, j + 1)});
    }
  }
  for (std::uint32_t j = 0; j < rows; ++j) {
    for (std::uint32_t i = 0; i < columns; ++i) {
      const std::uint32_t a = made.vertex(i, j), b = made.vertex(i + 1, j);
      const std::uint32_t c = made.vertex(i + 1, j + 1), d = made.vertex(i, j + 1);
      if (halves) {
        made.corners.insert(made.corners.end(), {a, b, c, a, c, d});
        made.sizes.insert(made.sizes.end(), {3, 3});
      } else {
        made.corners.insert(made.corners.end(), {a, b, c, d});
        made.sizes.push_back(4);
      }
    }
  }
  return made;
}

double sine(double x) {
  return portable::sin(x);
}
double cosine(double x) {
  return portable::cos(x);
}

Sheet road(bool halves, std::uint32_t columns = 40) {
  return sheet(columns, 4, false, halves, [](double u, double v) {
    const double radius = 4 + 0.9 * (v - 0.5), angle = 2.4 * u;
    return Vec3(radius * cosine(angle), radius * sine(angle), 0.5 * sine(5 * u));
  });
}

Sheet leg() {
  return sheet(16, 25, true, false, [](double u, double v) {
    const double radius = 0.5 + 0.35 * v + 0.12 * sine(6 * v), angle = 2 * std::numbers::pi * u;
    return Vec3(radius * cosine(angle) + 0.5 * sine(2 * v), radius * sine(angle), 3 * v);
  });
}

Sheet cable() {
  return sheet(8, 60, true, false, [](double u, double v) {
    const double angle = 2 * std::numbers::pi * u, radius = 1 + 0.1 * cosine(angle);
    return Vec3(radius * cosine(6 * v), radius * sine(6 * v), 0.1 * sine(angle) + 0.4 * v);
  });
}

Sheet curtain() {
  return sheet(36, 12, false, false, [](double u, double v) {
    return Vec3(3 * u, (0.15 + 0.1 * v) * sine(24 * u), 2 * v);
  });
}

struct Atlas {
  beltrami_status status = BELTRAMI_OK;
  std::string message;
  std::uint64_t element = 0;
  std::int32_t element_kind = 0;
  std::vector<Uv> uvs = {};  // per corner
  double energy = 0;
  bool injective = false;
};

using Settings = std::vector<std::pair<std::int32_t, double>>;

Atlas unwrap(const beltrami_surface& surface, const Settings& settings) {
  const Context context = create();
  for (const auto& [key, value] : settings) {
    const bool is_real = key == BELTRAMI_OPTION_MARGIN || key == BELTRAMI_OPTION_TARGET_ENERGY ||
                         key == BELTRAMI_OPTION_TEXELS_PER_UNIT;
    const beltrami_status set =
        is_real ? beltrami_set_float(context.get(), key, value)
                : beltrami_set_int(context.get(), key, static_cast<std::int64_t>(value));
    EXPECT_EQ(set, BELTRAMI_OK) << message(context);
  }
  Atlas atlas;
  atlas.status = beltrami_unwrap(context.get(), &surface, nullptr, nullptr);
  atlas.message = message(context);
  atlas.element = beltrami_error_element(context.get());
  atlas.element_kind = beltrami_error_element_kind(context.get());
  if (atlas.status < 0) return atlas;
  atlas.uvs.resize(surface.corner_count);
  EXPECT_EQ(beltrami_get_corner_uvs(context.get(), atlas.uvs.data(), BELTRAMI_F64, 0), BELTRAMI_OK);
  auto certificate = sized<beltrami_atlas_certificate>();
  EXPECT_EQ(beltrami_get_atlas_certificate(context.get(), BELTRAMI_F64, &certificate), BELTRAMI_OK);
  atlas.injective = certificate.injective == 1;
  auto report = sized<beltrami_atlas>();
  EXPECT_EQ(beltrami_get_atlas(context.get(), &report), BELTRAMI_OK);
  atlas.energy = report.symmetric_dirichlet;
  return atlas;
}

/// The numbers that the UVs of some vertices have of one coordinate, in the whole atlas.
std::set<double> numbers_of(const Sheet& sheet, const Atlas& atlas,
                            const std::vector<std::uint32_t>& vertices, int k) {
  std::set<double> numbers;
  for (std::size_t c = 0; c < sheet.corners.size(); ++c) {
    if (std::find(vertices.begin(), vertices.end(), sheet.corners[c]) == vertices.end()) continue;
    numbers.insert(atlas.uvs[c][k]);
  }
  return numbers;
}

std::vector<std::uint32_t> row_of(const Sheet& sheet, std::uint32_t j) {
  std::vector<std::uint32_t> vertices;
  for (std::uint32_t i = 0; i < sheet.across(); ++i) vertices.push_back(sheet.vertex(i, j));
  return vertices;
}

std::vector<std::uint32_t> column_of(const Sheet& sheet, std::uint32_t i) {
  std::vector<std::uint32_t> vertices;
  for (std::uint32_t j = 0; j <= sheet.rows; ++j) vertices.push_back(sheet.vertex(i, j));
  return vertices;
}

/// Whether the chart lies along v, as it may after a quarter of a turn: the coordinate of rows.
int along_rows(const Sheet& sheet, const Atlas& atlas) {
  return numbers_of(sheet, atlas, row_of(sheet, 0), 0).size() == 1 ? 1 : 0;
}

class StraightGrids : public testing::TestWithParam<Sheet (*)()> {};

TEST_P(StraightGrids, HaveRowsAndColumnsToTheBit) {
  const Sheet sheet = GetParam()();
  const std::int32_t cut = sheet.closed ? BELTRAMI_CUT_GIVEN : BELTRAMI_CUT_MINIMAL;
  const Atlas atlas = unwrap(sheet.view(), {{BELTRAMI_OPTION_CUT, cut},
                                            {BELTRAMI_OPTION_RECTIFY, BELTRAMI_RECTIFY_GRIDS}});
  ASSERT_EQ(atlas.status, BELTRAMI_OK) << atlas.message;
  EXPECT_TRUE(atlas.injective);
  EXPECT_LT(atlas.energy, 2.1);
  const int u = along_rows(sheet, atlas);
  for (std::uint32_t j = 0; j <= sheet.rows; ++j) {
    EXPECT_EQ(numbers_of(sheet, atlas, row_of(sheet, j), 1 - u).size(), 1U) << "row " << j;
  }
  for (std::uint32_t i = 0; i < sheet.columns; ++i) {
    // What is cut open has two sides.
    const std::size_t sides = sheet.closed && i == 0 ? 2 : 1;
    EXPECT_EQ(numbers_of(sheet, atlas, column_of(sheet, i), u).size(), sides) << "column " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Sheets, StraightGrids,
                         testing::Values(
                             &leg, &cable, &curtain, +[] { return road(false); }));

TEST(StraightParts, KeepTheMapThatTheyHad) {
  const Sheet mesh = road(false);
  Settings settings = {{BELTRAMI_OPTION_CUT, BELTRAMI_CUT_MINIMAL},
                       {BELTRAMI_OPTION_RECTIFY, BELTRAMI_RECTIFY_GRIDS},
                       {BELTRAMI_OPTION_RESOLUTION, 256}};
  const Atlas whole = unwrap(mesh.view(), settings);
  settings.emplace_back(BELTRAMI_OPTION_TEXELS_PER_UNIT, 60);  // twice as long as a page
  const Atlas parts = unwrap(mesh.view(), settings);
  ASSERT_EQ(parts.status, BELTRAMI_OK) << parts.message;
  EXPECT_TRUE(parts.injective);
  EXPECT_NEAR(parts.energy, whole.energy, 1e-9);
  double longest = 0;
  for (std::size_t c = 0; c < parts.uvs.size(); ++c) {
    const Uv &a = parts.uvs[c], &b = parts.uvs[c % 4 == 3 ? c - 3 : c + 1];
    EXPECT_LT(std::min(std::abs(a[0] - b[0]), std::abs(a[1] - b[1])), 1e-9) << c;
    longest = std::max({longest, std::abs(a[0] - b[0]), std::abs(a[1] - b[1])});
  }
  EXPECT_GT(longest * mesh.columns, 1.5) << "there is more than one part";
}

TEST(StraightCharts, OfNoGridStayFree) {
  Sheet bent = road(true);
  const Atlas atlas = unwrap(bent.view(), {{BELTRAMI_OPTION_CUT, BELTRAMI_CUT_MINIMAL},
                                           {BELTRAMI_OPTION_RECTIFY, BELTRAMI_RECTIFY_GRIDS}});
  ASSERT_EQ(atlas.status, BELTRAMI_OK);
  EXPECT_GT(numbers_of(bent, atlas, row_of(bent, 0), 0).size(), 10U);
}

/// That all sides of the sheet lie along the axes.
void expect_rectangle(const Sheet& sheet, const Atlas& atlas) {
  ASSERT_EQ(atlas.status, BELTRAMI_OK) << atlas.message;
  EXPECT_TRUE(atlas.injective);
  const int u = along_rows(sheet, atlas);
  for (const std::uint32_t j : {0U, sheet.rows}) {
    EXPECT_EQ(numbers_of(sheet, atlas, row_of(sheet, j), 1 - u).size(), 1U);
  }
  for (const std::uint32_t i : {0U, sheet.columns}) {
    EXPECT_EQ(numbers_of(sheet, atlas, column_of(sheet, i), u).size(), 1U);
  }
}

TEST(StraightRectangles, HaveTheCornersOfTheirBorder) {
  const Sheet bent = road(true);
  beltrami_surface surface = bent.view();
  const std::uint32_t face = 7;
  surface.rectangles = {&face, 0, BELTRAMI_U32, 0};
  surface.rectangle_count = 1;
  const Settings settings = {{BELTRAMI_OPTION_CUT, BELTRAMI_CUT_MINIMAL}};
  const Atlas atlas = unwrap(surface, settings);
  expect_rectangle(bent, atlas);
  EXPECT_LT(atlas.energy, 2.05);
  // Inside, vertices slide: columns are no lines.
  EXPECT_GT(numbers_of(bent, atlas, column_of(bent, 3), 0).size(), 1U);
  Settings threads = settings;
  threads.emplace_back(BELTRAMI_OPTION_THREADS, 2);
  EXPECT_EQ(unwrap(surface, threads).uvs, atlas.uvs);
}

TEST(StraightRectangles, HaveTheCornersThatAreNamed) {
  const Sheet bent = road(true, 12);
  beltrami_surface surface = bent.view();
  const std::uint32_t face = 0;
  std::array<std::uint32_t, 4> corners = {bent.vertex(12, 4), bent.vertex(0, 0), bent.vertex(12, 0),
                                          bent.vertex(0, 4)};
  surface.rectangles = {&face, 0, BELTRAMI_U32, 0};
  surface.rectangle_corners = {corners.data(), 0, BELTRAMI_U32, 0};
  surface.rectangle_count = 1;
  const Settings settings = {{BELTRAMI_OPTION_CUT, BELTRAMI_CUT_MINIMAL}};
  expect_rectangle(bent, unwrap(surface, settings));
  corners[2] = bent.vertex(5, 2);
  const Atlas refused = unwrap(surface, settings);
  EXPECT_EQ(refused.status, BELTRAMI_E_PINS);
  EXPECT_EQ(refused.element_kind, BELTRAMI_ELEMENT_FACE);
  EXPECT_EQ(refused.element, 0U);
  EXPECT_NE(refused.message.find("is not on its border"), std::string::npos) << refused.message;
}

TEST(StraightRectangles, LeaveOutWhatWouldHaveNoArea) {
  Sheet flat = sheet(6, 3, false, true, [](double u, double v) { return Vec3(2 * u, v, 0); });
  // A face beyond the lower side, whose corners are all of it.
  const auto tip = static_cast<std::uint32_t>(flat.positions.size());
  flat.positions.emplace_back(2.5 / 6 * 2, -0.1, 0);
  flat.corners.insert(flat.corners.end(), {flat.vertex(3, 0), flat.vertex(2, 0), tip});
  flat.sizes.push_back(3);
  beltrami_surface surface = flat.view();
  const std::uint32_t face = 0;
  const std::array<std::uint32_t, 4> corners = {flat.vertex(0, 0), flat.vertex(6, 0),
                                                flat.vertex(6, 3), flat.vertex(0, 3)};
  surface.rectangles = {&face, 0, BELTRAMI_U32, 0};
  surface.rectangle_corners = {corners.data(), 0, BELTRAMI_U32, 0};
  surface.rectangle_count = 1;
  const Atlas atlas = unwrap(surface, {{BELTRAMI_OPTION_CUT, BELTRAMI_CUT_MINIMAL}});
  expect_rectangle(flat, atlas);
  const int v = 1 - along_rows(flat, atlas);
  EXPECT_NE(numbers_of(flat, atlas, {tip}, v), numbers_of(flat, atlas, row_of(flat, 0), v));
}

TEST(StraightRectangles, AreRefusedWithoutFourCorners) {
  const meshes::TriangleList round = meshes::fan(40);
  auto surface = sized<beltrami_surface>();
  surface.vertex_count = round.positions.size();
  surface.face_count = round.faces.size();
  surface.positions = {round.positions.data(), 0, BELTRAMI_F64, 0};
  surface.indices = {round.faces.data(), 0, BELTRAMI_U32, 0};
  const std::uint32_t face = 3;
  surface.rectangles = {&face, 0, BELTRAMI_U32, 0};
  surface.rectangle_count = 1;
  const Atlas refused = unwrap(surface, {});
  EXPECT_EQ(refused.status, BELTRAMI_E_PINS);
  EXPECT_EQ(refused.element, 3U);
  EXPECT_NE(refused.message.find("four clear corners"), std::string::npos) << refused.message;
}

/// Edges between neighbours of a list.
struct Edges {
  std::vector<std::array<std::uint32_t, 2>> ends = {};
  std::vector<std::uint32_t> kinds = {};

  void add(const std::vector<std::uint32_t>& vertices, std::uint32_t kind) {
    for (std::size_t i = 1; i < vertices.size(); ++i) {
      ends.push_back({vertices[i - 1], vertices[i]});
      kinds.push_back(kind);
    }
  }
  void give(beltrami_surface& surface) const {
    surface.straight_edges = {ends.data(), 0, BELTRAMI_U32, 0};
    surface.straight_kinds = {kinds.data(), 0, BELTRAMI_U32, 0};
    surface.straight_edge_count = ends.size();
  }
};

const Settings kFree = {{BELTRAMI_OPTION_CUT, BELTRAMI_CUT_MINIMAL},
                        {BELTRAMI_OPTION_PACK, BELTRAMI_PACK_NONE}};

TEST(StraightEdges, UnbendASideOfARoad) {
  const Sheet bent = road(true);
  beltrami_surface surface = bent.view();
  Edges edges;
  edges.add(row_of(bent, 0), BELTRAMI_PIN_V);
  edges.give(surface);
  const Atlas atlas = unwrap(surface, kFree);
  ASSERT_EQ(atlas.status, BELTRAMI_OK) << atlas.message;
  EXPECT_TRUE(atlas.injective);
  EXPECT_LT(atlas.energy, 2.05);
  EXPECT_EQ(numbers_of(bent, atlas, row_of(bent, 0), 1).size(), 1U);
  EXPECT_GT(numbers_of(bent, atlas, row_of(bent, 4), 1).size(), 1U);
}

TEST(StraightEdges, OfSeveralKindsGoTogether) {
  const Sheet bent = road(true);
  beltrami_surface surface = bent.view();
  Edges edges;
  edges.add(row_of(bent, 0), BELTRAMI_PIN_LINE);
  edges.add(column_of(bent, 0), BELTRAMI_PIN_U);
  edges.give(surface);
  const Atlas atlas = unwrap(surface, kFree);
  ASSERT_EQ(atlas.status, BELTRAMI_OK) << atlas.message;
  EXPECT_TRUE(atlas.injective);
  EXPECT_LT(atlas.energy, 2.05);
  EXPECT_EQ(numbers_of(bent, atlas, column_of(bent, 0), 0).size(), 1U);
  // The row is on a line, whatever its direction.
  std::vector<Vec2> row;
  for (const std::uint32_t v : row_of(bent, 0)) {
    row.emplace_back(*numbers_of(bent, atlas, {v}, 0).begin(),
                     *numbers_of(bent, atlas, {v}, 1).begin());
  }
  const Vec2 chord = row.back() - row.front();
  for (const Vec2& w : row) {
    const Vec2 d = w - row.front();
    EXPECT_NEAR(chord.x() * d.y() - chord.y() * d.x(), 0, 1e-9 * chord.squaredNorm());
  }
}

TEST(StraightEdges, KeepTheirAxisOnAPage) {
  const Sheet bent = road(true);
  for (const std::int32_t kind : {BELTRAMI_PIN_U, BELTRAMI_PIN_V}) {
    beltrami_surface surface = bent.view();
    Edges edges;
    edges.add(row_of(bent, 0), kind);
    edges.give(surface);
    const Atlas atlas = unwrap(surface, {{BELTRAMI_OPTION_CUT, BELTRAMI_CUT_MINIMAL}});
    ASSERT_EQ(atlas.status, BELTRAMI_OK) << atlas.message;
    EXPECT_TRUE(atlas.injective);
    const int axis = kind == BELTRAMI_PIN_U ? 0 : 1;
    EXPECT_EQ(numbers_of(bent, atlas, row_of(bent, 0), axis).size(), 1U);
    EXPECT_GT(numbers_of(bent, atlas, row_of(bent, 0), 1 - axis).size(), 1U);
  }
}

void expect_refused(const Sheet& sheet, const Edges& edges, std::uint64_t vertex,
                    const std::string& why) {
  beltrami_surface surface = sheet.view();
  edges.give(surface);
  const Atlas refused = unwrap(surface, kFree);
  EXPECT_EQ(refused.status, BELTRAMI_E_INVALID_ARGUMENT);
  EXPECT_NE(refused.message.find(why), std::string::npos) << refused.message;
  EXPECT_EQ(refused.element, vertex) << refused.message;
}

TEST(StraightEdges, AreRefusedWhereNoLineGoes) {
  const Sheet bent = road(true, 8);
  Edges branch, loop, both, none, point;
  branch.add(row_of(bent, 0), BELTRAMI_PIN_V);
  branch.add({bent.vertex(3, 0), bent.vertex(3, 1)}, BELTRAMI_PIN_V);
  expect_refused(bent, branch, bent.vertex(3, 0), "branch at vertex 3");
  loop.add({bent.vertex(1, 1), bent.vertex(2, 1), bent.vertex(2, 2), bent.vertex(1, 1)},
           BELTRAMI_PIN_LINE);
  expect_refused(bent, loop, bent.vertex(1, 1), "form a loop");
  both.add({0, 1}, BELTRAMI_PIN_U);
  both.add({1, 0}, BELTRAMI_PIN_V);
  expect_refused(bent, both, 1, "straight edges 0 and 1 are the same edge");
  none.add({0, 5}, BELTRAMI_PIN_U);
  expect_refused(bent, none, 0, "straight edge 0 joins vertices 0 and 5");
  point.add({0, 1}, BELTRAMI_PIN_POINT);
  expect_refused(bent, point, BELTRAMI_NO_ELEMENT, "give U, V or LINE");
  point.kinds[0] = 4;
  expect_refused(bent, point, BELTRAMI_NO_ELEMENT, "from 0 to 3");
}

TEST(SlidingPins, HoldWhatTheyHold) {
  const Sheet bent = road(true, 10);
  const Atlas free = unwrap(bent.view(), kFree);
  ASSERT_EQ(free.status, BELTRAMI_OK);
  // One corner of each of some vertices; what they hold is near to where they lie.
  const std::array<std::uint32_t, 6> corners = {0, 60, 120, 24, 36, 57};
  const double u = free.uvs[60][0], v = free.uvs[36][1];
  const Uv on_line = {free.uvs[57][0] + 0.25, free.uvs[57][1]};
  const std::array<Uv, 6> uvs = {{{u, 9}, {u, 9}, {u, 9}, {9, v}, {9, v}, on_line}};
  const std::array<std::uint32_t, 6> kinds = {BELTRAMI_PIN_U, BELTRAMI_PIN_U, BELTRAMI_PIN_U,
                                              BELTRAMI_PIN_V, BELTRAMI_PIN_V, BELTRAMI_PIN_LINE};
  std::array<Uv, 6> directions = {};
  directions[5] = {1, -1};
  beltrami_surface surface = bent.view();
  surface.pins = {corners.data(), 0, BELTRAMI_U32, 0};
  surface.pin_uvs = {uvs.data(), 0, BELTRAMI_F64, 0};
  surface.pin_kinds = {kinds.data(), 0, BELTRAMI_U32, 0};
  surface.pin_directions = {directions.data(), 0, BELTRAMI_F64, 0};
  surface.pin_count = corners.size();
  const Settings settings = {{BELTRAMI_OPTION_CUT, BELTRAMI_CUT_MINIMAL}};
  const Atlas atlas = unwrap(surface, settings);
  ASSERT_EQ(atlas.status, BELTRAMI_OK) << atlas.message;
  EXPECT_TRUE(atlas.injective);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(atlas.uvs[corners[i]][0], u);
  for (std::size_t i = 3; i < 5; ++i) EXPECT_EQ(atlas.uvs[corners[i]][1], v);
  EXPECT_NEAR(atlas.uvs[57][0] + atlas.uvs[57][1], on_line[0] + on_line[1], 1e-5);
  directions[5] = {0, 0};
  const Atlas refused = unwrap(surface, settings);
  EXPECT_EQ(refused.status, BELTRAMI_E_INVALID_ARGUMENT);
  EXPECT_EQ(refused.element, 57U);
}

TEST(SlidingPins, AloneKeepTheScale) {
  const Sheet bent = road(true, 10);
  beltrami_surface surface = bent.view();
  std::vector<std::uint32_t> corners;
  for (std::uint32_t c = 0; c < bent.corners.size(); ++c) {
    if (bent.corners[c] % bent.across() == 0) corners.push_back(c);
  }
  const std::vector<Uv> uvs(corners.size(), Uv{2, 0});
  const std::vector<std::uint32_t> kinds(corners.size(), BELTRAMI_PIN_U);
  surface.pins = {corners.data(), 0, BELTRAMI_U32, 0};
  surface.pin_uvs = {uvs.data(), 0, BELTRAMI_F64, 0};
  surface.pin_kinds = {kinds.data(), 0, BELTRAMI_U32, 0};
  surface.pin_count = corners.size();
  const Atlas atlas = unwrap(surface, {{BELTRAMI_OPTION_CUT, BELTRAMI_CUT_MINIMAL}});
  ASSERT_EQ(atlas.status, BELTRAMI_OK) << atlas.message;
  EXPECT_TRUE(atlas.injective);
  EXPECT_LT(atlas.energy, 2.05);
  EXPECT_EQ(numbers_of(bent, atlas, column_of(bent, 0), 0), std::set<double>{2});
}

/// A box of 2 x 3 x 5 as six quads.
Sheet box() {
  Sheet made{.columns = 0, .rows = 0};
  for (int v = 0; v < 8; ++v) {
    made.positions.emplace_back((v & 1) != 0 ? 2 : 0, (v & 2) != 0 ? 3 : 0, (v & 4) != 0 ? 5 : 0);
  }
  made.corners = {0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5};
  made.sizes.assign(6, 4);
  return made;
}

TEST(SnappedCharts, HaveTheirBordersOnTexels) {
  constexpr int kResolution = 256;
  const Sheet made = box();
  for (const bool single : {false, true}) {
    const Atlas atlas = unwrap(made.view(), {{BELTRAMI_OPTION_PRESET, BELTRAMI_PRESET_HARD_SURFACE},
                                             {BELTRAMI_OPTION_RESOLUTION, kResolution},
                                             {BELTRAMI_OPTION_FLOAT32, single ? 1 : 0},
                                             {BELTRAMI_OPTION_SNAP_TEXELS, 1}});
    ASSERT_EQ(atlas.status, BELTRAMI_OK) << atlas.message;
    EXPECT_TRUE(atlas.injective);
    EXPECT_LT(atlas.energy, 2.001);
    for (const Uv& uv : atlas.uvs) {
      for (const double x : uv) EXPECT_NEAR(kResolution * x, std::round(kResolution * x), 1e-9);
    }
  }
}

TEST(SnappedCharts, WantPages) {
  const Atlas refused = unwrap(
      box().view(), {{BELTRAMI_OPTION_PACK, BELTRAMI_PACK_NONE}, {BELTRAMI_OPTION_SNAP_TEXELS, 1}});
  EXPECT_EQ(refused.status, BELTRAMI_E_INVALID_ARGUMENT);
  EXPECT_NE(refused.message.find("snap-texels"), std::string::npos) << refused.message;
}

}  // namespace
}  // namespace beltrami::host
