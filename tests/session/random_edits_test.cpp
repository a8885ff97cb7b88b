// Any edits in any order: no verdict is wrong, nothing is lost by a failure or a cancel, what was
// saved comes back to the bit, and the same edits give the same bits.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "atlas/pins.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "chart/flattening.h"
#include "exact/atlas_certificate.h"
#include "pack/types.h"
#include "session/ground.h"
#include "session/session.h"
#include "session/state.h"
#include "support/meshes.h"
#include "support/polls.h"
#include "support/surfaces.h"

namespace beltrami {
namespace {

using meshes::TriangleList;

constexpr int kMeshes = 10;

TriangleList mesh_of(int number) {
  switch (number) {
    case 0:
      return meshes::bumps(12, 12);
    case 1:
      return meshes::octahedron();
    case 2:
      return meshes::tetrahedron();
    case 3:
      return meshes::annulus(12);
    case 4:
      return meshes::torus_with_hole(6);
    case 5:
      return meshes::two_components();
    case 6:
      return meshes::cap(8, 12, 2.5);
    case 7:
      return meshes::cube();
    case 8:
      return meshes::torus(8);
    default:
      return meshes::double_torus(6);
  }
}

/// Random edits of one session, the same for the same seed.
class Player {
 public:
  Player(TriangleList mesh, unsigned seed)
      : mesh_(std::move(mesh)),
        random_(seed),
        session_({.positions = mesh_.positions,
                  .faces = mesh_.faces,
                  .seams = {},
                  .corner_uvs = {},
                  .pins = {}},
                 {}, {}, seed % 3 == 2, Work()) {
    session_.update(0, Work());
  }

  std::vector<Vec2> uvs() const {
    std::vector<Vec2> uvs;
    for (Index c = 0; c < 3 * session_.ground().face_count(); ++c) uvs.push_back(session_.uv(c));
    return uvs;
  }

  /// One edit and what follows, with its promises.
  void play() {
    const std::uint64_t mark = session_.save();
    const std::vector<Vec2> before = uvs();
    edit();
    EXPECT_EQ(uvs(), before);  // edits are only noted
    if (chance(8)) cancel_somewhere(before);
    update(before);
    expect_true_verdicts();
    if (chance(6)) pack();
    if (chance(5)) {
      session_.restore(mark);
      EXPECT_EQ(uvs(), before);
      if (chance(2)) {
        session_.update(0, Work());
        session_.restore(mark);
        EXPECT_EQ(uvs(), before);
      }
    }
    session_.forget(mark);
  }

  const Session& session() const { return session_; }

 private:
  bool chance(unsigned one_in) { return random_() % one_in == 0; }
  int below(std::size_t end) { return static_cast<int>(random_() % end); }

  void edit() {
    switch (random_() % 9) {
      case 0:
      case 1:
      case 2:
        return session_.set_seams(path(1 + below(4)), true);
      case 3:
        return session_.set_seams(path(1 + below(4)), false);
      case 4:
        return set_pins();
      case 5:
        return select();
      case 6:
        return lock();
      case 7:
        return session_.set_flags(some_charts(), static_cast<std::uint8_t>(random_() % 16));
      default:
        return session_.renew(some_charts(), chance(3));
    }
  }

  /// A path of edges from a random vertex.
  std::vector<std::array<Index, 2>> path(int edges) {
    std::vector<std::array<Index, 2>> found;
    Index at = mesh_.faces[random_() % mesh_.faces.size()][0];
    while (static_cast<int>(found.size()) < edges) {
      const Triangle& face = mesh_.faces[random_() % mesh_.faces.size()];
      for (int k = 0; k < 3; ++k) {
        if (face[k] != at) continue;
        found.push_back({at, face[next_corner(k)]});
        at = face[next_corner(k)];
        break;
      }
    }
    return found;
  }

  std::vector<Index> some_charts() {
    std::vector<Index> ids;
    for (const SessionChart& chart : session_.state().charts) {
      if (chance(2)) ids.push_back(chart.id);
    }
    return ids;
  }

  /// Corners near where they are, or anywhere, or none.
  void set_pins() {
    std::vector<Pin> pins;
    const Ground& ground = session_.ground();
    for (int left = below(4); left > 0; --left) {
      const Index corner = below(3 * static_cast<std::size_t>(ground.face_count()));
      const Index input = ground.input_corner(corner / 3, corner % 3);
      const double far = chance(4) ? 2.0 : 0.02;
      const auto off = [&] { return far * (static_cast<double>(random_() % 1001) / 500 - 1); };
      const Vec2 at = session_.uv(corner);
      const auto place = [](double x) { return static_cast<double>(static_cast<float>(x)); };
      const double u = place(at.x() + off()), v = place(at.y() + off());
      pins.push_back({input / 3, input % 3, {u, v}, size_of(pins), input});
    }
    session_.set_pins(std::move(pins));
  }

  void select() {
    std::vector<Index> faces;
    if (!chance(3)) {
      const std::size_t first = random_() % mesh_.faces.size();
      for (std::size_t f = first; f < std::min(first + 20, mesh_.faces.size()); ++f) {
        faces.push_back(static_cast<Index>(f));
      }
    }
    session_.select(faces);
  }

  void lock() {
    const std::vector<Index> ids = some_charts();
    session_.lock(ids, chance(2));
    if (!chance(3)) return;
    for (const SessionChart& chart : session_.state().charts) {
      session_.lock(std::vector<Index>{chart.id}, false);
    }
  }

  /// A failure leaves the maps as they were; then what cannot be met is taken back.
  void update(const std::vector<Vec2>& before) {
    const int steps = below(3);
    try {
      session_.update(steps, Work());
    } catch (const Error& error) {
      const bool is_expected =
          error.fault() == Fault::kPins || error.fault() == Fault::kInvalidState;
      EXPECT_TRUE(is_expected) << error.what();
      EXPECT_EQ(uvs(), before);
      session_.set_pins({});
      session_.select({});
      for (const SessionChart& chart : session_.state().charts) {
        session_.lock(std::vector<Index>{chart.id}, false);
      }
      session_.update(steps, Work());
    }
  }

  void cancel_somewhere(const std::vector<Vec2>& before) {
    try {
      count_polls([&] { session_.update(1, Work()); }, 1 + below(400));
      // It was over before that poll.
    } catch (const Cancelled&) {
      EXPECT_EQ(uvs(), before);
    } catch (const Error&) {
      EXPECT_EQ(uvs(), before);
    }
  }

  void pack() {
    const std::vector<Vec2> before = uvs();
    PackOptions options;
    options.resolution = 128;
    options.effort = 0;  // layouts are not what is tested
    const std::vector<Index> ids = chance(2) ? some_charts() : std::vector<Index>();
    try {
      if (session_.pack(ids, options, Work()) == Outcome::kOk) {
        EXPECT_TRUE(session_.check(Work()).injective());
      }
      expect_true_verdicts();
    } catch (const Error& error) {
      const bool is_expected = error.fault() == Fault::kNoRoom ||
                               error.fault() == Fault::kInvalidArgument ||
                               error.fault() == Fault::kInvalidState;
      EXPECT_TRUE(is_expected) << error.what();
      EXPECT_EQ(uvs(), before);
    }
  }

  /// What is said to be injective is so, and what is not said to be is not; edges are cut on both
  /// sides.
  void expect_true_verdicts() const {
    const SessionState& state = session_.state();
    const std::vector<Index>& twin = session_.ground().admitted.surface.twin;
    for (std::size_t h = 0; h < twin.size(); ++h) {
      if (twin[h] == kNone) continue;
      EXPECT_EQ(state.opened[h], state.opened[twin[h]]) << h;
      EXPECT_EQ(state.seams[h], state.seams[twin[h]]) << h;
    }
    for (const SessionChart& chart : session_.state().charts) {
      const auto& all = chart.mesh().faces;
      const std::vector<Triangle> faces(all.begin(), all.begin() + chart.faces());
      const bool is_injective = certify_atlas(faces, *chart.uvs, {}, Work()).injective();
      EXPECT_EQ(is_injective, chart.outcome != Outcome::kNotInjective) << chart.id;
    }
  }

  TriangleList mesh_;
  std::mt19937 random_;
  Session session_;
};

/// Plays twice, and compares what comes out on the way.
void play_twice(int mesh, unsigned seed, int edits) {
  Player first(mesh_of(mesh), seed), second(mesh_of(mesh), seed);
  for (int edit = 0; edit < edits && !::testing::Test::HasFailure(); ++edit) {
    SCOPED_TRACE(::testing::Message() << "mesh " << mesh << " edit " << edit);
    first.play();
    second.play();
    EXPECT_EQ(first.uvs(), second.uvs());
  }
}

TEST(SessionEdits, AreJudgedRightRepeatAndAreUndone) {
  for (int mesh = 0; mesh < kMeshes; ++mesh) play_twice(mesh, static_cast<unsigned>(mesh), 20);
}

class RandomEdits : public ::testing::TestWithParam<int> {};

TEST_P(RandomEdits, AreJudgedRightRepeatAndAreUndone) {
  play_twice(GetParam(), 100 + static_cast<unsigned>(GetParam()), 1000);
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomEdits, ::testing::Range(0, kMeshes));

TEST(SessionEdits, MapsThatNothingAsksToMoveDoNotDrift) {
  const TriangleList mesh = meshes::bumps(12, 12);
  Session session(
      {.positions = mesh.positions, .faces = mesh.faces, .seams = {}, .corner_uvs = {}, .pins = {}},
      {}, {}, false, Work());
  session.update(0, Work());
  const SessionChart before = session.state().charts[0];
  for (int update = 0; update < 200; ++update) {
    session.renew(std::vector<Index>{before.id}, false);
    session.update(1, Work());
  }
  const SessionChart& after = session.state().charts[0];
  double size = 0, farthest = 0;
  for (std::size_t v = 0; v < before.uvs->size(); ++v) {
    size = std::max(size, (*before.uvs)[v].norm());
    farthest = std::max(farthest, ((*after.uvs)[v] - (*before.uvs)[v]).norm());
  }
  EXPECT_LE(farthest, 0.02 * size);
  EXPECT_EQ(after.scale, before.scale);
  EXPECT_LE(after.energy, before.energy * (1 + 1e-9));
  // All together they have not wandered.
  Vec2 shift = Vec2::Zero();
  for (std::size_t v = 0; v < before.uvs->size(); ++v) {
    shift += ((*after.uvs)[v] - (*before.uvs)[v]) / static_cast<double>(before.uvs->size());
  }
  EXPECT_LE(shift.norm(), 1e-9 * size);
}

}  // namespace
}  // namespace beltrami
