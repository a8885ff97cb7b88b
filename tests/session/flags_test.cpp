// What the flags of a chart keep: its turn, its size, its place along the axes or on its twin.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "atlas/pins.h"
#include "base/error.h"
#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "chart/flattening.h"
#include "exact/atlas_certificate.h"
#include "pack/types.h"
#include "session/session.h"
#include "session/state.h"
#include "support/meshes.h"

namespace beltrami {
namespace {

using meshes::TriangleList;

/// A sheet that is bent along one side, and two of them far apart, the second turned in space.
TriangleList sheet() {
  TriangleList mesh = meshes::grid(6, 3);
  for (Vec3& p : mesh.positions) p.z() = 0.02 * p.x() * p.x();
  return mesh;
}

TriangleList two_sheets() {
  TriangleList mesh = sheet();
  const auto count = size_of(mesh.positions);
  const std::vector<Triangle> faces = mesh.faces;
  for (Index v = 0; v < count; ++v) {
    const Vec3 p = mesh.positions[v];
    mesh.positions.emplace_back(20 + p.y(), p.z(), p.x());
  }
  for (const Triangle& face : faces) {
    mesh.faces.push_back({count + face[0], count + face[1], count + face[2]});
  }
  return mesh;
}

/// A session of a mesh whose UVs are its x and y, turned.
Session turned_session(const TriangleList& mesh, double angle) {
  SessionInput input{mesh.positions, mesh.faces, {}, {}, {}};
  for (const Triangle& face : mesh.faces) {
    for (const Index v : face) {
      const Vec3& p = mesh.positions[v];
      input.corner_uvs.emplace_back(std::cos(angle) * p.x() - std::sin(angle) * p.y(),
                                    std::sin(angle) * p.x() + std::cos(angle) * p.y());
    }
  }
  return Session(std::move(input), {}, {}, false, Work());
}

Session session_of(const TriangleList& mesh) {
  Session session(
      {.positions = mesh.positions, .faces = mesh.faces, .seams = {}, .corner_uvs = {}, .pins = {}},
      {}, {}, false, Work());
  session.update(0, Work());
  return session;
}

std::vector<Index> all_charts(const Session& session) {
  std::vector<Index> ids;
  for (const SessionChart& chart : session.state().charts) ids.push_back(chart.id);
  return ids;
}

std::vector<Vec2> uvs_of(const Session& session) {
  std::vector<Vec2> uvs;
  for (Index c = 0; c < 3 * session.ground().face_count(); ++c) uvs.push_back(session.uv(c));
  return uvs;
}

/// The greatest distance of a border edge from the nearer axis, in its length.
double askew(const SessionChart& chart) {
  double worst = 0;
  const std::vector<Index>& loop = chart.mesh().boundary;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vec2 edge = (*chart.uvs)[loop[(i + 1) % loop.size()]] - (*chart.uvs)[loop[i]];
    worst = std::max(worst, std::min(std::abs(edge.x()), std::abs(edge.y())) / edge.norm());
  }
  return worst;
}

TEST(ChartFlags, AlignedChartsLieAlongTheAxesAfterAnUpdateAndInPacks) {
  Session session = turned_session(meshes::grid(6, 3), 0.3);
  EXPECT_GT(askew(session.state().charts[0]), 0.1);
  session.set_flags(all_charts(session), kAlign);
  EXPECT_GT(askew(session.state().charts[0]), 0.1);  // it is noted alone
  session.update(0, Work());
  EXPECT_LT(askew(session.state().charts[0]), 1e-9);
  session.pack({}, {}, Work());
  EXPECT_LT(askew(session.state().charts[0]), 1e-9);
  EXPECT_TRUE(session.check(Work()).injective());
}

TEST(ChartFlags, PinsOverruleTheAxes) {
  Session session = turned_session(meshes::grid(6, 3), 0.3);
  const std::vector<Vec2> before = uvs_of(session);
  session.set_flags(all_charts(session), kAlign);
  std::vector<Pin> pins;
  for (const Index corner : {0, 3 * (session.ground().face_count() - 1)}) {
    const Index input = session.ground().input_corner(corner / 3, corner % 3);
    pins.push_back({input / 3, input % 3, before[corner], size_of(pins), input});
  }
  session.set_pins(pins);
  session.update(0, Work());
  EXPECT_GT(askew(session.state().charts[0]), 0.1);
  EXPECT_EQ(session.uv(0), before[0]);
}

TEST(ChartFlags, WhatKeepsItsFrameIsShiftedAndScaledAloneByPacks) {
  Session session = turned_session(sheet(), 0.3);
  session.set_flags(all_charts(session), kKeepFrame);
  const std::vector<Vec2> before = uvs_of(session);
  session.pack({}, {}, Work());
  const std::vector<Vec2> after = uvs_of(session);
  const Vec2 first = before[1] - before[0], now = after[1] - after[0];
  const double scale = now.norm() / first.norm();
  for (std::size_t c = 0; c < before.size(); ++c) {
    EXPECT_LT((scale * (before[c] - before[0]) - (after[c] - after[0])).norm(), 1e-6) << c;
  }
}

TEST(ChartFlags, WhatKeepsItsScaleIsNotEnlargedByPinsNorByPacks) {
  for (const std::uint8_t flags : {std::uint8_t{0}, std::uint8_t{kKeepScale}}) {
    Session session = turned_session(sheet(), 0);
    const double scale = session.state().charts[0].scale;
    session.set_flags(all_charts(session), flags);
    const Index last = 3 * (session.ground().face_count() - 1);
    std::vector<Pin> pins;
    for (const Index corner : {0, last}) {
      const Index input = session.ground().input_corner(corner / 3, corner % 3);
      pins.push_back({input / 3, input % 3, 1.25 * session.uv(corner), size_of(pins), input});
    }
    session.set_pins(pins);
    session.update(0, Work());
    EXPECT_EQ(session.uv(last), pins[1].uv);
    const double after = session.state().charts[0].scale;
    EXPECT_NEAR(after / scale, flags == 0 ? 1.25 : 1, 1e-9);
    session.set_pins({});
    session.update(0, Work());
    const std::vector<Vec2> before = uvs_of(session);
    PackOptions small;
    small.max_pages = 1000;
    if (flags != 0) {
      EXPECT_THROW(session.pack({}, small, Work()), Error);  // it is larger than a page
    } else {
      session.pack({}, small, Work());
      EXPECT_LT(session.state().charts[0].scale, after);
    }
  }
}

TEST(ChartFlags, PacksKeepTheSizesOfAllWhereOneKeepsItsScale) {
  TriangleList mesh = two_sheets();
  for (Vec3& p : mesh.positions) p *= 0.05;
  Session session = session_of(mesh);
  const std::vector<Vec2> before = uvs_of(session);
  session.set_flags(std::vector<Index>{session.state().charts[0].id}, kKeepScale);
  session.pack({}, {}, Work());
  const std::vector<Vec2> after = uvs_of(session);
  for (std::size_t c = 0; c < before.size(); c += 3) {
    EXPECT_NEAR((before[c + 1] - before[c]).norm(), (after[c + 1] - after[c]).norm(), 1e-6);
  }
}

TEST(ChartFlags, StackedTwinsLieOnEachOtherUntilOneChanges) {
  Session session = session_of(two_sheets());
  ASSERT_EQ(session.state().charts.size(), 2U);
  session.pack({}, {}, Work());
  const double alone = session.state().charts[0].scale;
  EXPECT_EQ(session.state().stacked_on(session.state().charts[1]), kNone);
  session.set_flags(all_charts(session), kStack);
  EXPECT_EQ(session.pack({}, {}, Work()), Outcome::kOk);
  const SessionState& state = session.state();
  EXPECT_EQ(state.stacked_on(state.charts[1]), 0);
  EXPECT_EQ(state.stacked_on(state.charts[0]), kNone);
  EXPECT_GT(state.charts[0].scale, 1.2 * alone);  // one has the page
  EXPECT_TRUE(session.check(Work()).injective());
  std::vector<std::array<double, 2>> places[2];
  for (int c = 0; c < 2; ++c) {
    for (const Vec2& w : *state.charts[c].uvs) places[c].push_back({w.x(), w.y()});
    std::sort(places[c].begin(), places[c].end());
  }
  EXPECT_EQ(places[0], places[1]);

  const std::uint64_t mark = session.save();
  std::vector<Pin> pins = {{0, 0, session.uv(0) + Vec2(0.3, 0), 0, 0}};
  session.set_pins(pins);
  session.update(0, Work());
  EXPECT_EQ(session.state().stacked_on(session.state().charts[1]), kNone);
  EXPECT_FALSE(session.check(Work()).injective());  // they overlap now, and are judged
  session.restore(mark);
  EXPECT_EQ(session.state().stacked_on(session.state().charts[1]), 0);
  EXPECT_TRUE(session.check(Work()).injective());
}

TEST(ChartFlags, OtherShapesAreNotStacked) {
  TriangleList mesh = two_sheets();
  mesh.positions.back().z() += 0.1;
  Session session = session_of(mesh);
  session.set_flags(all_charts(session), kStack);
  session.pack({}, {}, Work());
  EXPECT_EQ(session.state().stacked_on(session.state().charts[1]), kNone);
  EXPECT_TRUE(session.check(Work()).injective());
}

TEST(ChartFlags, AStackGoesOnWithAChartThatStays) {
  Session session = session_of(two_sheets());
  session.pack({}, {}, Work());
  const std::vector<Index> ids = all_charts(session);
  session.set_flags(ids, kStack);
  session.lock(std::vector<Index>{ids[0]}, true);
  const std::vector<Vec2> held = *session.state().charts[0].uvs;
  EXPECT_EQ(session.pack({}, {}, Work()), Outcome::kOk);
  EXPECT_EQ(*session.state().charts[0].uvs, held);
  EXPECT_EQ(session.state().stacked_on(session.state().charts[1]), 0);
}

}  // namespace
}  // namespace beltrami
