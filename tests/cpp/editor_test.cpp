// Editors: what edits do, whose session it is, and what is refused.
#include <gtest/gtest.h>
#include <beltrami/beltrami.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <vector>

#include "cpp/meshes.h"

namespace beltrami::host {
namespace {

using Edges = std::vector<std::array<std::uint32_t, 2>>;
using Numbers = std::vector<std::uint32_t>;

Surface view(const Triangles& mesh) {
  return Surface(mesh.positions, mesh.faces);
}

std::vector<std::uint64_t> ids_of(const Editor& editor) {
  std::vector<std::uint64_t> ids;
  for (const EditorChart& chart : editor.charts()) ids.push_back(chart.id);
  return ids;
}

TEST(CppEditor, OpensAndClosesSeamsAndGoesBack) {
  const Triangles mesh = hump(8);
  Context context;
  Editor editor(context, view(mesh));
  EXPECT_EQ(editor.update(), Status::kOk);
  const std::vector<Uv> before = editor.corner_uvs();
  const std::uint64_t mark = editor.save();
  const Edges across = {{4, 13},  {13, 22}, {22, 31}, {31, 40},
                        {40, 49}, {49, 58}, {58, 67}, {67, 76}};
  editor.open_seams(across);
  EXPECT_EQ(editor.update(), Status::kOk);
  EXPECT_EQ(editor.charts().size(), 2u);
  const std::vector<std::uint32_t> charts = editor.face_charts();
  EXPECT_EQ(std::set<std::uint32_t>(charts.begin(), charts.end()).size(), 2u);
  EXPECT_EQ(editor.pack(), Status::kOk);  // else charts that part may lie on each other
  EXPECT_NE(editor.check().injective, 0);
  editor.close_seams(across);
  editor.update();
  EXPECT_EQ(editor.info().charts, 1u);
  EXPECT_TRUE(editor.opened().empty());
  editor.restore(mark);
  EXPECT_EQ(editor.corner_uvs(), before);
  editor.forget(mark);
  EXPECT_EQ(editor.try_restore(mark).status(), Status::kInvalidArgument);
}

TEST(CppEditor, ChangesAreWhatMoved) {
  const Triangles mesh = hump(6);
  Context context;
  Editor editor(context, view(mesh));
  editor.update();
  std::vector<Uv> uvs = editor.corner_uvs();
  EXPECT_EQ(editor.changes().corners.size(), uvs.size());
  const std::array<std::uint32_t, 1> corner = {0};
  const std::array<Uv, 1> place = {Uv{uvs[0][0] + 0.25, uvs[0][1] - 0.5}};
  editor.set_pins(corner, place);
  editor.update();
  const Changes<> changes = editor.changes();
  ASSERT_FALSE(changes.corners.empty());
  for (std::size_t i = 0; i < changes.corners.size(); ++i) uvs[changes.corners[i]] = changes.uvs[i];
  EXPECT_EQ(editor.corner_uvs(), uvs);
  EXPECT_EQ(uvs[0], place[0]);
  editor.update();
  EXPECT_TRUE(editor.changes<Uv32>().corners.empty());
}

TEST(CppEditor, PinsSlide) {
  const Triangles mesh = hump(6);
  Context context;
  Editor editor(context, view(mesh));
  editor.update();
  const Numbers corner = {0}, kinds = {BELTRAMI_PIN_V}, line = {BELTRAMI_PIN_LINE};
  const std::vector<Uv> place = {{7, 3}}, along = {{1, 1}};
  editor.set_pins(corner, place);
  editor.set_pin_kinds(kinds);
  editor.update();
  EXPECT_EQ(editor.corner_uvs()[0][1], 3);
  EXPECT_LT(editor.corner_uvs()[0][0], 6);  // it goes no way that nothing asks for
  EXPECT_EQ(editor.try_set_pin_kinds(line).status(), Status::kInvalidArgument);
  editor.set_pins(corner, place);
  editor.set_pin_kinds(line, along);
  editor.update();
  EXPECT_NEAR(editor.corner_uvs()[0][0] - editor.corner_uvs()[0][1], 4, 1e-9);
  EXPECT_NE(editor.check().injective, 0);
}

TEST(CppEditor, StepsAndSelectionsGoOn) {
  const Triangles mesh = hump(10);
  Context context;
  Editor editor(context, view(mesh));
  editor.update();
  const std::vector<Uv> before = editor.corner_uvs();
  const Numbers two = {0, 1};
  editor.select(two);
  editor.update(0, 1);
  const std::vector<Uv> after = editor.corner_uvs();
  for (std::size_t c = 6; c < after.size(); ++c) {
    bool of_selected = false;
    const std::uint32_t vertex = mesh.faces[c / 3][c % 3];
    for (std::size_t f = 0; f < 2; ++f) {
      for (const std::uint32_t own : mesh.faces[f]) of_selected = of_selected || own == vertex;
    }
    if (!of_selected) {
      EXPECT_EQ(after[c], before[c]) << c;
    }
  }
  editor.select(Indices<1>());
  const std::vector<std::uint64_t> ids = ids_of(editor);
  editor.lock(ids);
  EXPECT_NE(editor.charts()[0].locked, 0);
  editor.set_flags(ids, BELTRAMI_CHART_KEEP_FRAME | BELTRAMI_CHART_STACK);
  EXPECT_EQ(editor.charts()[0].flags, 9U);
  editor.renew(ids, true);
  editor.update();
  EXPECT_EQ(editor.corner_uvs(), after);
  editor.lock(ids, false);
  EXPECT_EQ(editor.charts()[0].locked, 0);
}

TEST(CppEditor, PacksAllOrSome) {
  const Triangles mesh = triangulated_cube();
  Context context;
  context.set(option::kResolution, 256);
  Editor editor(context, view(mesh));
  editor.update();
  EXPECT_EQ(editor.pack(), Status::kOk);
  for (const Uv& uv : editor.corner_uvs()) {
    for (const double x : uv) EXPECT_TRUE(x >= 0 && x <= 1) << x;
  }
  const std::vector<std::uint64_t> ids = ids_of(editor);
  EXPECT_EQ(editor.pack_charts(ids), Status::kOk);
  EXPECT_NE(editor.check().injective, 0);
  EXPECT_EQ(editor.try_pack_charts(Indices<1>()).status(), Status::kInvalidArgument);
}

TEST(CppEditor, PolygonsHaveTheirCorners) {
  const Polygons mesh = cube();
  Context context;
  Editor editor(context, Surface(mesh.positions, mesh.corners, mesh.sizes));
  editor.update();
  EXPECT_EQ(editor.corner_uvs<float>().size(), 2 * mesh.corners.size());
  EXPECT_EQ(editor.face_charts<std::uint64_t>().size(), mesh.sizes.size());
  std::vector<Uv> written(mesh.corners.size());
  editor.write_corner_uvs(span_of(written));
  EXPECT_EQ(written, editor.corner_uvs());
}

TEST(CppEditor, HasTheContextsNewestSession) {
  const Triangles mesh = bent_quad();
  Context context;
  Editor first(context, view(mesh));
  first.update();
  std::optional<Editor> second(std::in_place, context, view(mesh));
  EXPECT_EQ(first.try_update().status(), Status::kInvalidState);
  EXPECT_TRUE(second->try_update());
  { const Editor gone = std::move(first); }  // ends no session that is not its own
  EXPECT_TRUE(second->try_update());
  second.reset();
  auto info = EditorInfo{};
  info.struct_size = sizeof info;
  EXPECT_EQ(beltrami_get_session(context.c(), &info), BELTRAMI_E_INVALID_STATE);
}

TEST(CppEditor, OutlivesItsContextAndMoves) {
  static_assert(!std::is_copy_constructible_v<Editor> && std::is_nothrow_move_assignable_v<Editor>);
  const Triangles mesh = bent_quad();
  std::optional<Editor> editor;
  {
    Context context;
    editor.emplace(context, view(mesh));
  }
  editor->update();
  Editor moved = std::move(*editor);
  EXPECT_EQ(editor->try_corner_uvs().status(), Status::kInvalidState);
  EXPECT_EQ(moved.corner_uvs().size(), 6u);
  Context other;
  moved = Editor(other, view(mesh));
  EXPECT_EQ(moved.update(), Status::kOk);
}

TEST(CppEditor, RefusesWithASentence) {
  const Triangles mesh = hump(4);
  Context context;
  Editor editor(context, view(mesh));
  EXPECT_EQ(editor.try_pack().status(), Status::kInvalidState);
  editor.update();
  const Edges no_edge = {{0, 24}}, no_vertex = {{0, 99}};
  EXPECT_EQ(editor.try_open_seams(no_edge).status(), Status::kInvalidArgument);
  EXPECT_EQ(editor.try_open_seams(no_vertex).status(), Status::kIndexOutOfRange);
  const Numbers one = {5}, three = {0, 1, 2}, beyond = {99};
  EXPECT_EQ(editor.try_select(beyond).status(), Status::kIndexOutOfRange);
  EXPECT_EQ(editor.try_lock(one).status(), Status::kInvalidArgument);
  EXPECT_EQ(editor.try_set_pins(one, Reals<2>()).status(), Status::kInvalidArgument);
  EXPECT_EQ(editor.try_open_seams(three).status(), Status::kInvalidArgument);
  const std::vector<Uv> nowhere = {{std::numeric_limits<double>::quiet_NaN(), 0}};
  const Result<void> pinned = editor.try_set_pins(one, nowhere);
  EXPECT_EQ(pinned.status(), Status::kNonFinite);
  EXPECT_STRNE(pinned.error().what(), "");
}

TEST(CppEditor, EndsByACallableOrACanceller) {
  const Triangles mesh = hump(12);
  Context context;
  Editor editor(context, view(mesh));
  EXPECT_EQ(editor.try_update(0, 0, [](double) { return false; }).status(), Status::kCancelled);
  EXPECT_THROW(editor.update(0, 0, [](double) { throw std::runtime_error("enough"); }),
               std::runtime_error);
  const Canceller canceller = editor.canceller();
  editor.update();
  const std::vector<std::uint64_t> ids = ids_of(editor);
  editor.renew(ids, true);
  EXPECT_EQ(editor.try_update(0, 0, [&](double) { canceller.cancel(); }).status(),
            Status::kCancelled);
  EXPECT_EQ(editor.update(), Status::kOk);
}

}  // namespace
}  // namespace beltrami::host
