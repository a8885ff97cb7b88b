// Editing sessions through the door: lifetimes, what is refused, strides and types, failures and
// cancels that change nothing.
#include <beltrami/beltrami.h>
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "abi/host.h"
#include "base/vectors.h"
#include "support/meshes.h"
#include "support/surfaces.h"

namespace beltrami::host {
namespace {

using meshes::TriangleList;
using Numbers = std::vector<std::uint32_t>;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

beltrami_buffer numbers_of(const Numbers& numbers) {
  return {numbers.data(), 0, BELTRAMI_U32, 0};
}

beltrami_status update(const Context& context, std::int32_t steps = 0) {
  return beltrami_session_update(context.get(), 0, steps, nullptr, nullptr);
}

/// A context with a session whose charts are mapped.
Context begun(const TriangleList& mesh) {
  Context context = create();
  const beltrami_surface surface = surface_view(mesh);
  EXPECT_EQ(beltrami_session_begin(context.get(), &surface, nullptr, nullptr), BELTRAMI_OK)
      << message(context);
  EXPECT_EQ(update(context), BELTRAMI_OK) << message(context);
  return context;
}

beltrami_session info(const Context& context) {
  auto session = sized<beltrami_session>();
  EXPECT_EQ(beltrami_get_session(context.get(), &session), BELTRAMI_OK) << message(context);
  return session;
}

std::vector<std::array<double, 2>> session_uvs(const Context& context) {
  std::vector<std::array<double, 2>> uvs(info(context).corners);
  EXPECT_EQ(beltrami_get_session_uvs(context.get(), uvs.data(), BELTRAMI_F64, 0), BELTRAMI_OK);
  return uvs;
}

std::uint64_t first_chart(const Context& context) {
  auto chart = sized<beltrami_session_chart>();
  EXPECT_EQ(beltrami_get_session_chart(context.get(), 0, &chart), BELTRAMI_OK);
  return chart.id;
}

beltrami_status set_seams(const Context& context, const Numbers& ends, bool open) {
  const beltrami_buffer edges = numbers_of(ends);
  return beltrami_session_set_seams(context.get(), &edges, ends.size() / 2, open ? 1 : 0);
}

beltrami_status renew(const Context& context, bool cold) {
  const std::uint64_t id = first_chart(context);
  const beltrami_buffer charts = {&id, 0, BELTRAMI_U64, 0};
  return beltrami_session_renew(context.get(), &charts, 1, cold ? 1 : 0);
}

using Call = std::function<beltrami_status(beltrami_context*)>;

/// Every function of a session, with arguments that are in order for any.
std::vector<std::pair<std::string, Call>> all_calls() {
  static double uvs[1024];
  static std::uint64_t numbers[1024];
  static beltrami_session session;
  static beltrami_session_chart chart;
  static beltrami_atlas_certificate certificate;
  session = sized<beltrami_session>();
  chart = sized<beltrami_session_chart>();
  certificate = sized<beltrami_atlas_certificate>();
  using Context = beltrami_context*;
  return {
      {"set_seams", [](Context c) { return beltrami_session_set_seams(c, nullptr, 0, 1); }},
      {"set_pins", [](Context c) { return beltrami_session_set_pins(c, nullptr, nullptr, 0); }},
      {"select", [](Context c) { return beltrami_session_select(c, nullptr, 0); }},
      {"lock", [](Context c) { return beltrami_session_lock(c, nullptr, 0, 1); }},
      {"set_flags", [](Context c) { return beltrami_session_set_flags(c, nullptr, 0, 0); }},
      {"renew", [](Context c) { return beltrami_session_renew(c, nullptr, 0, 0); }},
      {"update", [](Context c) { return beltrami_session_update(c, 0, 0, nullptr, nullptr); }},
      {"pack", [](Context c) { return beltrami_session_pack(c, nullptr, 0, nullptr, nullptr); }},
      {"check", [](Context c) { return beltrami_session_check(c, &certificate); }},
      {"save", [](Context c) { return beltrami_session_save(c, numbers); }},
      {"restore", [](Context c) { return beltrami_session_restore(c, 1); }},
      {"forget", [](Context c) { return beltrami_session_forget(c, 1); }},
      {"get_session", [](Context c) { return beltrami_get_session(c, &session); }},
      {"get_chart", [](Context c) { return beltrami_get_session_chart(c, 0, &chart); }},
      {"get_uvs", [](Context c) { return beltrami_get_session_uvs(c, uvs, BELTRAMI_F64, 0); }},
      {"get_changes",
       [](Context c) {
         return beltrami_get_session_changes(c, numbers, BELTRAMI_U64, uvs, BELTRAMI_F64);
       }},
      {"get_face_charts",
       [](Context c) { return beltrami_get_session_face_charts(c, numbers, BELTRAMI_U64, 0); }},
      {"get_opened",
       [](Context c) { return beltrami_get_session_opened(c, numbers, BELTRAMI_U64, 0); }},
  };
}

TEST(Sessions, WithoutOneEveryCallSaysSo) {
  const Context context = create();
  for (const auto& [name, call] : all_calls()) {
    EXPECT_EQ(call(context.get()), BELTRAMI_E_INVALID_STATE) << name;
    EXPECT_NE(message(context), "") << name;
    EXPECT_EQ(call(nullptr), BELTRAMI_E_INVALID_ARGUMENT) << name;
  }
  EXPECT_EQ(beltrami_session_end(context.get()), BELTRAMI_OK);
  EXPECT_EQ(beltrami_session_end(nullptr), BELTRAMI_E_INVALID_ARGUMENT);
}

TEST(Sessions, WithOneEveryCallGoesWell) {
  const Context context = begun(meshes::grid(3, 3));
  for (const auto& [name, call] : all_calls()) {
    EXPECT_EQ(call(context.get()), BELTRAMI_OK) << name << ": " << message(context);
  }
  EXPECT_EQ(beltrami_session_end(context.get()), BELTRAMI_OK);
  for (const auto& [name, call] : all_calls()) {
    EXPECT_EQ(call(context.get()), BELTRAMI_E_INVALID_STATE) << name;
  }
}

struct Inside {
  beltrami_context* context;
  std::vector<beltrami_status> statuses;
};

std::int32_t call_all(void* user, double, const char*) {
  auto& inside = *static_cast<Inside*>(user);
  for (const auto& [name, call] : all_calls()) inside.statuses.push_back(call(inside.context));
  inside.statuses.push_back(beltrami_session_end(inside.context));
  return 0;
}

TEST(Sessions, NoCallComesDuringAnother) {
  const Context context = begun(meshes::bumps(8, 8));
  ASSERT_EQ(renew(context, true), BELTRAMI_OK);
  Inside inside{context.get(), {}};
  EXPECT_EQ(beltrami_session_update(context.get(), 0, 0, call_all, &inside), BELTRAMI_OK);
  EXPECT_FALSE(inside.statuses.empty());
  for (const beltrami_status status : inside.statuses) EXPECT_EQ(status, BELTRAMI_E_INVALID_STATE);
}

TEST(Sessions, OneFollowsTheOtherAndAFailureKeepsTheFirst) {
  const TriangleList bumps = meshes::bumps(4, 4), cube = meshes::cube();
  const Context context = begun(bumps);
  const auto uvs = session_uvs(context);
  beltrami_surface surface = surface_view(bumps);
  surface.vertex_count = 3;
  EXPECT_EQ(beltrami_session_begin(context.get(), &surface, nullptr, nullptr),
            BELTRAMI_E_INDEX_OUT_OF_RANGE);
  EXPECT_EQ(beltrami_session_begin(context.get(), nullptr, nullptr, nullptr),
            BELTRAMI_E_INVALID_ARGUMENT);
  std::vector<std::uint32_t> labels(bumps.faces.size(), 0);
  surface = surface_view(bumps);
  surface.face_labels = numbers_of(labels);
  EXPECT_EQ(beltrami_session_begin(context.get(), &surface, nullptr, nullptr),
            BELTRAMI_E_INVALID_ARGUMENT);
  EXPECT_NE(message(context).find("face_labels"), std::string::npos);
  EXPECT_TRUE(same_bits(session_uvs(context), uvs));
  const beltrami_surface other = surface_view(cube);
  ASSERT_EQ(beltrami_session_begin(context.get(), &other, nullptr, nullptr), BELTRAMI_OK);
  EXPECT_EQ(info(context).corners, 3 * cube.faces.size());
  EXPECT_EQ(update(context), BELTRAMI_OK);
}

TEST(Sessions, OtherCallsOfTheContextLeaveItAlone) {
  const TriangleList mesh = meshes::bumps(5, 5);
  const Context context = begun(mesh);
  const auto uvs = session_uvs(context);
  const beltrami_surface surface = surface_view(mesh);
  EXPECT_EQ(beltrami_unwrap(context.get(), &surface, nullptr, nullptr), BELTRAMI_OK);
  EXPECT_EQ(set_mesh(context, mesh), BELTRAMI_OK);
  EXPECT_EQ(run(context), BELTRAMI_OK);
  EXPECT_TRUE(same_bits(session_uvs(context), uvs));
}

// Its corners were once in three places of the border, a triangle of an area that covered others.
TEST(Sessions, FacesWithoutAreaArePoints) {
  TriangleList mesh = meshes::grid(3, 3);
  mesh.faces.push_back({0, 2, 1});
  mesh.positions[1] = 0.5 * (mesh.positions[0] + mesh.positions[2]);
  for (Vec3& p : mesh.positions) p.z() = 0.1 * p.x() * p.y();
  const Context context = begun(mesh);
  const auto uvs = session_uvs(context);
  const std::size_t first = uvs.size() - 3;
  EXPECT_EQ(uvs[first], uvs[first + 1]);
  EXPECT_EQ(uvs[first], uvs[first + 2]);
  bool is_shared = false;
  for (std::size_t c = 0; c < first; ++c) is_shared = is_shared || uvs[c] == uvs[first];
  EXPECT_TRUE(is_shared);
  auto certificate = sized<beltrami_atlas_certificate>();
  EXPECT_EQ(beltrami_session_check(context.get(), &certificate), BELTRAMI_OK);
  EXPECT_NE(certificate.injective, 0);
}

TEST(Sessions, TheSurfaceIsCopied) {
  TriangleList mesh = meshes::bumps(6, 6);
  const Context context = begun(mesh), other = begun(mesh);
  mesh.positions.assign(mesh.positions.size(), Vec3::Constant(kNan));
  mesh.faces.assign(mesh.faces.size(), {0, 0, 0});
  for (const Context* c : {&context, &other}) {
    EXPECT_EQ(set_seams(*c, {3, 10, 10, 17}, true), BELTRAMI_OK) << message(*c);
    EXPECT_EQ(update(*c), BELTRAMI_OK);
  }
  EXPECT_TRUE(same_bits(session_uvs(context), session_uvs(other)));
}

TEST(Sessions, RefuseNullsAndOddBuffers) {
  const Context context = begun(meshes::grid(3, 3));
  const auto refused = [&](beltrami_status status) {
    EXPECT_EQ(status, BELTRAMI_E_INVALID_ARGUMENT);
    EXPECT_NE(message(context), "");
  };
  beltrami_context* const c = context.get();
  const Numbers some = {0, 1};
  const beltrami_buffer good = numbers_of(some);
  const double place[2] = {0, 0};
  const beltrami_buffer uv = {place, 0, BELTRAMI_F64, 0};
  beltrami_buffer none = good, odd = good, real = good, reserved = good;
  none.data = nullptr;
  odd.type = 77;
  real.type = BELTRAMI_F32;
  reserved.reserved = 1;
  const beltrami_buffer* bad[] = {nullptr, &none, &odd, &real, &reserved};
  for (const beltrami_buffer* buffer : bad) {
    refused(beltrami_session_set_seams(c, buffer, 1, 1));
    refused(beltrami_session_select(c, buffer, 1));
    refused(beltrami_session_lock(c, buffer, 1, 1));
    refused(beltrami_session_renew(c, buffer, 1, 1));
    refused(beltrami_session_pack(c, buffer, 1, nullptr, nullptr));
    refused(beltrami_session_set_pins(c, buffer, &uv, 1));
  }
  refused(beltrami_session_set_pins(c, &good, nullptr, 1));
  refused(beltrami_session_set_pins(c, &good, &good, 1));
  refused(beltrami_session_set_seams(c, &good, std::numeric_limits<std::uint64_t>::max(), 1));
  refused(beltrami_session_update(c, -1, 0, nullptr, nullptr));
  refused(beltrami_session_update(c, kNan, 0, nullptr, nullptr));
  refused(beltrami_session_update(c, 0, -1, nullptr, nullptr));
  refused(beltrami_session_save(c, nullptr));
  refused(beltrami_session_restore(c, 12345));
  refused(beltrami_session_forget(c, 0));
  refused(beltrami_session_check(c, nullptr));
  refused(beltrami_get_session(c, nullptr));
  refused(beltrami_get_session_chart(c, 0, nullptr));
  auto chart = sized<beltrami_session_chart>();
  refused(beltrami_get_session_chart(c, 1, &chart));
  auto session = beltrami_session{};
  refused(beltrami_get_session(c, &session));  // of no size
  double room[64];
  refused(beltrami_get_session_uvs(c, nullptr, BELTRAMI_F64, 0));
  refused(beltrami_get_session_uvs(c, room, BELTRAMI_U32, 0));
  refused(beltrami_get_session_uvs(c, room, BELTRAMI_F64, 4));
  refused(beltrami_get_session_face_charts(c, room, BELTRAMI_F64, 0));
  refused(beltrami_get_session_face_charts(c, nullptr, BELTRAMI_U32, 0));
  refused(beltrami_get_session_changes(c, nullptr, BELTRAMI_U32, room, BELTRAMI_F64));
  refused(beltrami_get_session_changes(c, room, BELTRAMI_F32, room, BELTRAMI_F64));
  EXPECT_EQ(update(context), BELTRAMI_OK);
  EXPECT_EQ(info(context).due, 0u);
}

TEST(Sessions, RefuseWhatThereIsNot) {
  const Context context = begun(meshes::grid(3, 3));
  EXPECT_EQ(set_seams(context, {0, 99}, true), BELTRAMI_E_INDEX_OUT_OF_RANGE);
  EXPECT_EQ(set_seams(context, {0, 15}, true), BELTRAMI_E_INVALID_ARGUMENT);  // no edge
  // Nothing is noted where one of several is refused.
  EXPECT_EQ(set_seams(context, {1, 5, 5, 9, 9, 13, 0, 15}, true), BELTRAMI_E_INVALID_ARGUMENT);
  EXPECT_EQ(update(context), BELTRAMI_OK);
  EXPECT_EQ(info(context).charts, 1u);
  const Numbers far = {1000};
  const beltrami_buffer buffer = numbers_of(far);
  EXPECT_EQ(beltrami_session_select(context.get(), &buffer, 1), BELTRAMI_E_INDEX_OUT_OF_RANGE);
  EXPECT_EQ(beltrami_session_lock(context.get(), &buffer, 1, 1), BELTRAMI_E_INVALID_ARGUMENT);
  EXPECT_EQ(beltrami_session_renew(context.get(), &buffer, 1, 1), BELTRAMI_E_INVALID_ARGUMENT);
  const double places[2] = {kNan, 0};
  const beltrami_buffer nowhere = {places, 0, BELTRAMI_F64, 0};
  const Numbers corner = {4};
  const beltrami_buffer corners = numbers_of(corner);
  EXPECT_EQ(beltrami_session_set_pins(context.get(), &corners, &nowhere, 1), BELTRAMI_E_NON_FINITE);
  EXPECT_EQ(beltrami_error_element_kind(context.get()), BELTRAMI_ELEMENT_CORNER);
  EXPECT_EQ(beltrami_error_element(context.get()), 4u);
}

TEST(Sessions, NumbersOfNoChartAreRefusedAsSuch) {
  const Context context = begun(meshes::grid(3, 3));
  for (const std::uint64_t id : {std::uint64_t{0x7FFFFFFF}, std::uint64_t{BELTRAMI_NO_ELEMENT}}) {
    const beltrami_buffer charts = {&id, 0, BELTRAMI_U64, 0};
    EXPECT_EQ(beltrami_session_lock(context.get(), &charts, 1, 1), BELTRAMI_E_INVALID_ARGUMENT);
    EXPECT_NE(message(context).find("there is no chart"), std::string::npos) << message(context);
  }
}

TEST(Sessions, PinsKeepTheirPlacesWhateverTheirKind) {
  const Context context = begun(meshes::grid(3, 3));
  const Numbers corner = {4};
  const double place[2] = {0.3, 0.7};
  const beltrami_buffer corners = numbers_of(corner), uv = {place, 0, BELTRAMI_F64, 0};
  ASSERT_EQ(beltrami_session_set_pins(context.get(), &corners, &uv, 1), BELTRAMI_OK);
  for (const std::uint32_t kind : {BELTRAMI_PIN_U, BELTRAMI_PIN_V, BELTRAMI_PIN_POINT}) {
    const Numbers kinds = {kind};
    const beltrami_buffer given = numbers_of(kinds);
    ASSERT_EQ(beltrami_session_set_pin_kinds(context.get(), &given, nullptr, 1), BELTRAMI_OK)
        << message(context);
  }
  ASSERT_EQ(update(context), BELTRAMI_OK) << message(context);
  EXPECT_EQ(session_uvs(context)[4], (std::array<double, 2>{0.3, 0.7}));
}

TEST(Sessions, TakeNothingOfTheSurfaceThatTheyDoNotKeep) {
  const TriangleList mesh = meshes::grid(3, 3);
  const Numbers some = {0, 1, 2, 3};
  for (beltrami_buffer beltrami_surface::*member :
       {&beltrami_surface::pin_kinds, &beltrami_surface::pin_directions,
        &beltrami_surface::straight_edges, &beltrami_surface::rectangles}) {
    const Context context = create();
    beltrami_surface surface = surface_view(mesh);
    surface.*member = numbers_of(some);
    EXPECT_EQ(beltrami_session_begin(context.get(), &surface, nullptr, nullptr),
              BELTRAMI_E_INVALID_ARGUMENT);
    EXPECT_NE(message(context).find("a session takes no"), std::string::npos);
  }
}

TEST(Sessions, FlagsAreThoseThatWereGivenLast) {
  const Context context = begun(meshes::grid(3, 3));
  const std::uint64_t id = first_chart(context);
  const beltrami_buffer charts = {&id, 0, BELTRAMI_U64, 0};
  const auto flags = [&] {
    auto chart = sized<beltrami_session_chart>();
    EXPECT_EQ(beltrami_get_session_chart(context.get(), 0, &chart), BELTRAMI_OK);
    EXPECT_EQ(chart.stacked_on, UINT64_MAX);
    return chart.flags;
  };
  EXPECT_EQ(flags(), 0U);
  for (const std::uint32_t given : {6U, 9U, 0U}) {
    EXPECT_EQ(beltrami_session_set_flags(context.get(), &charts, 1, given), BELTRAMI_OK);
    EXPECT_EQ(flags(), given);
  }
  EXPECT_EQ(beltrami_session_set_flags(context.get(), &charts, 1, 16), BELTRAMI_E_INVALID_ARGUMENT);
  EXPECT_NE(message(context).find("16"), std::string::npos);
}

TEST(Sessions, ReadAndWriteAtAnyStrideInEveryType) {
  const TriangleList mesh = meshes::bumps(4, 4);
  const Context packed = begun(mesh), strided = begun(mesh);
  ASSERT_EQ(set_seams(packed, {2, 7, 7, 12}, true), BELTRAMI_OK);
  // The same edges, 8 bytes wide, among other numbers.
  const std::uint64_t edges[] = {2, 7, 999, 7, 12, 999};
  const beltrami_buffer view = {edges, 3 * sizeof edges[0], BELTRAMI_U64, 0};
  ASSERT_EQ(beltrami_session_set_seams(strided.get(), &view, 2, 1), BELTRAMI_OK);
  // Pins in single precision, 20 bytes apart.
  const auto uvs = session_uvs(packed);
  const float u = static_cast<float>(uvs[0][0]) + 0.25F, v = static_cast<float>(uvs[0][1]);
  const double wide[2] = {u, v};
  const float narrow[5] = {u, v, 9, 9, 9};
  const Numbers corner = {0};
  const beltrami_buffer corners = numbers_of(corner);
  const beltrami_buffer doubles = {wide, 0, BELTRAMI_F64, 0};
  const beltrami_buffer floats = {narrow, sizeof narrow, BELTRAMI_F32, 0};
  ASSERT_EQ(beltrami_session_set_pins(packed.get(), &corners, &doubles, 1), BELTRAMI_OK);
  ASSERT_EQ(beltrami_session_set_pins(strided.get(), &corners, &floats, 1), BELTRAMI_OK);
  ASSERT_EQ(update(packed), BELTRAMI_OK) << message(packed);
  ASSERT_EQ(update(strided), BELTRAMI_OK);
  const auto expected = session_uvs(packed);
  EXPECT_TRUE(same_bits(session_uvs(strided), expected));
  EXPECT_EQ(expected[0][0], wide[0]);

  const std::size_t count = expected.size();
  std::vector<float> room(5 * count, -1);
  ASSERT_EQ(beltrami_get_session_uvs(packed.get(), room.data(), BELTRAMI_F32, 20), BELTRAMI_OK);
  for (std::size_t c = 0; c < count; ++c) {
    EXPECT_EQ(room[5 * c], static_cast<float>(expected[c][0]));
    EXPECT_EQ(room[5 * c + 2], -1.0F);
  }
  const std::uint64_t moved = info(packed).changes;
  std::vector<std::uint64_t> wide_corners(moved);
  std::vector<std::uint32_t> narrow_corners(moved);
  std::vector<float> places(2 * moved);
  std::vector<double> places64(2 * moved);
  ASSERT_EQ(beltrami_get_session_changes(packed.get(), wide_corners.data(), BELTRAMI_U64,
                                         places.data(), BELTRAMI_F32),
            BELTRAMI_OK);
  ASSERT_EQ(beltrami_get_session_changes(packed.get(), narrow_corners.data(), BELTRAMI_U32,
                                         places64.data(), BELTRAMI_F64),
            BELTRAMI_OK);
  for (std::size_t i = 0; i < moved; ++i) {
    EXPECT_EQ(wide_corners[i], narrow_corners[i]);
    EXPECT_EQ(places64[2 * i], expected[wide_corners[i]][0]);
    EXPECT_EQ(places[2 * i + 1], static_cast<float>(expected[wide_corners[i]][1]));
    EXPECT_TRUE(i == 0 || wide_corners[i - 1] < wide_corners[i]);
  }
}

TEST(Sessions, ChangesNameWhatMovedAndNothingElse) {
  const Context context = begun(meshes::bumps(6, 6));
  EXPECT_EQ(info(context).changes, info(context).corners);
  const auto before = session_uvs(context);
  ASSERT_EQ(update(context), BELTRAMI_OK);
  EXPECT_EQ(info(context).changes, 0u);
  ASSERT_EQ(set_seams(context, {3, 10, 10, 17, 17, 24}, true), BELTRAMI_OK);
  ASSERT_EQ(update(context), BELTRAMI_OK);
  const auto after = session_uvs(context);
  std::uint64_t moved = 0;
  for (std::size_t c = 0; c < after.size(); ++c) moved += after[c] != before[c];
  EXPECT_EQ(info(context).changes, moved);
}

TEST(Sessions, AFailureLeavesTheMapsAndIsTakenBack) {
  const Context context = begun(meshes::bumps(6, 6));
  const auto before = session_uvs(context);
  // A face turned over: its corners cannot be there.
  const Numbers corners = {0, 1, 2};
  const std::vector<std::array<double, 2>> places = {before[0], before[2], before[1]};
  const beltrami_buffer at = numbers_of(corners), uv = view(places);
  ASSERT_EQ(beltrami_session_set_pins(context.get(), &at, &uv, 3), BELTRAMI_OK);
  for (int again = 0; again < 2; ++again) {
    EXPECT_EQ(update(context), BELTRAMI_E_PINS);
    EXPECT_EQ(beltrami_error_element_kind(context.get()), BELTRAMI_ELEMENT_CORNER);
    EXPECT_LT(beltrami_error_element(context.get()), 3u);
    EXPECT_TRUE(same_bits(session_uvs(context), before));
  }
  ASSERT_EQ(beltrami_session_set_pins(context.get(), nullptr, nullptr, 0), BELTRAMI_OK);
  EXPECT_EQ(update(context), BELTRAMI_OK);
}

struct Countdown {
  int left;
};

std::int32_t end_at(void* user, double, const char*) {
  return --static_cast<Countdown*>(user)->left < 0 ? 1 : 0;
}

TEST(Sessions, CancelledAnywhereTheyAreAsBefore) {
  const TriangleList mesh = meshes::bumps(12, 12);
  const Context context = begun(mesh);
  const auto before = session_uvs(context);
  std::uint64_t mark = 0;
  ASSERT_EQ(beltrami_session_save(context.get(), &mark), BELTRAMI_OK);
  int cancels = 0;
  for (int after = 0; after < 10000; after += 1 + after / 4) {
    ASSERT_EQ(beltrami_session_restore(context.get(), mark), BELTRAMI_OK);
    ASSERT_EQ(set_seams(context, {6, 19, 19, 32, 32, 45}, true), BELTRAMI_OK);
    ASSERT_EQ(renew(context, true), BELTRAMI_OK);
    Countdown countdown{after};
    const beltrami_status status = beltrami_session_update(context.get(), 0, 0, end_at, &countdown);
    if (status == BELTRAMI_OK) break;
    ASSERT_EQ(status, BELTRAMI_E_CANCELLED);
    EXPECT_TRUE(same_bits(session_uvs(context), before)) << after;
    ++cancels;
  }
  EXPECT_GE(cancels, 2);
  EXPECT_EQ(update(context), BELTRAMI_OK);
}

TEST(Sessions, AnotherThreadCancels) {
  const Context context = begun(meshes::bumps(40, 40));
  const auto before = session_uvs(context);
  ASSERT_EQ(renew(context, true), BELTRAMI_OK);
  // The first report waits until the other thread has asked for the end.
  struct Meeting {
    std::atomic<bool> under_way{false}, asked{false};
  } meeting;
  std::thread other([&] {
    while (!meeting.under_way) std::this_thread::yield();
    beltrami_cancel(context.get());
    meeting.asked = true;
  });
  const auto wait = [](void* user, double, const char*) -> std::int32_t {
    auto& own = *static_cast<Meeting*>(user);
    own.under_way = true;
    while (!own.asked) std::this_thread::yield();
    return 0;
  };
  EXPECT_EQ(beltrami_session_update(context.get(), 0, 0, wait, &meeting), BELTRAMI_E_CANCELLED);
  other.join();
  EXPECT_TRUE(same_bits(session_uvs(context), before));
  EXPECT_EQ(update(context), BELTRAMI_OK);
}

TEST(Sessions, SavedStatesComeBackInAnyOrder) {
  const Context context = begun(meshes::bumps(8, 8));
  std::vector<std::uint64_t> marks;
  std::vector<std::vector<std::array<double, 2>>> uvs;
  for (std::uint32_t step = 0; step < 4; ++step) {
    marks.push_back(0);
    ASSERT_EQ(beltrami_session_save(context.get(), &marks.back()), BELTRAMI_OK);
    uvs.push_back(session_uvs(context));
    ASSERT_EQ(set_seams(context, {4 + 9 * step, 13 + 9 * step}, true), BELTRAMI_OK);
    ASSERT_EQ(update(context), BELTRAMI_OK);
  }
  for (const std::size_t step : {2, 0, 3, 1, 1}) {
    ASSERT_EQ(beltrami_session_restore(context.get(), marks[step]), BELTRAMI_OK);
    EXPECT_TRUE(same_bits(session_uvs(context), uvs[step])) << step;
  }
  for (const std::uint64_t mark : marks) {
    EXPECT_EQ(beltrami_session_forget(context.get(), mark), BELTRAMI_OK);
    EXPECT_EQ(beltrami_session_forget(context.get(), mark), BELTRAMI_E_INVALID_ARGUMENT);
  }
  EXPECT_TRUE(same_bits(session_uvs(context), uvs[1]));
}

TEST(Sessions, HaveTheSameBitsAtOneThreadAndAtThree) {
  const TriangleList mesh = meshes::torus(12);
  std::vector<std::vector<std::array<double, 2>>> uvs;
  for (const std::uint64_t threads : {1, 3}) {
    const Context context = create();
    set_option(context, BELTRAMI_OPTION_THREADS, threads);
    const beltrami_surface surface = surface_view(mesh);
    ASSERT_EQ(beltrami_session_begin(context.get(), &surface, nullptr, nullptr), BELTRAMI_OK);
    ASSERT_EQ(update(context), BELTRAMI_OK);
    ASSERT_EQ(set_seams(context, {0, 1, 1, 2, 2, 3}, true), BELTRAMI_OK) << message(context);
    ASSERT_GE(update(context, 1), BELTRAMI_OK);
    ASSERT_EQ(beltrami_session_pack(context.get(), nullptr, 0, nullptr, nullptr), BELTRAMI_OK);
    uvs.push_back(session_uvs(context));
  }
  EXPECT_TRUE(same_bits(uvs[0], uvs[1]));
}

}  // namespace
}  // namespace beltrami::host
