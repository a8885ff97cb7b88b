// Sessions: what edits change and what they leave, and that every verdict is true.
#include "session/session.h"
#include "chart/flattening.h"
#include "cut/edge_marks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/interrupt.h"
#include "support/meshes.h"

namespace beltrami {
namespace {

using meshes::TriangleList;
using Edges = std::vector<std::array<Index, 2>>;

Session session_of(const TriangleList& mesh, Edges seams = {}) {
  return Session({.positions = mesh.positions,
                  .faces = mesh.faces,
                  .seams = std::move(seams),
                  .corner_uvs = {},
                  .pins = {}},
                 {}, {}, false, Work());
}

/// Per corner of the input.
std::vector<Vec2> uvs_of(const Session& session) {
  const Ground& ground = session.ground();
  std::vector<Vec2> uvs(3 * ground.input_faces.size(), Vec2::Zero());
  for (Index f = 0; f < ground.face_count(); ++f) {
    for (int k = 0; k < 3; ++k) uvs[ground.input_corner(f, k)] = session.uv(3 * f + k);
  }
  return uvs;
}

/// A path of edges from a random vertex.
Edges path(const TriangleList& mesh, std::mt19937& random, int edges) {
  Edges found;
  Index at = mesh.faces[random() % mesh.faces.size()][0];
  while (static_cast<int>(found.size()) < edges) {
    const Triangle& face = mesh.faces[random() % mesh.faces.size()];
    for (int k = 0; k < 3; ++k) {
      if (face[k] != at) continue;
      found.push_back({at, face[next_corner(k)]});
      at = face[next_corner(k)];
      break;
    }
  }
  return found;
}

/// No chart that is said to be injective has a face folded, or lies on itself.
void expect_true_verdicts(const Session& session) {
  for (const SessionChart& chart : session.state().charts) {
    if (chart.outcome == Outcome::kNotInjective) continue;
    const auto& all = chart.mesh().faces;
    const std::vector<Triangle> faces(all.begin(), all.begin() + chart.faces());
    EXPECT_TRUE(certify_atlas(faces, *chart.uvs, {}, Work()).injective()) << chart.id;
  }
}

TEST(Session, OpeningASeamNeverCostsAndClosingItComesBack) {
  const TriangleList mesh = meshes::bumps(16, 16);
  Session session = session_of(mesh);
  session.update(0, Work());
  const double before = session.energy();
  const Edges seam = {{8, 25}, {25, 42}, {42, 59}};
  session.set_seams(seam, true);
  session.update(0, Work());
  EXPECT_LE(session.energy(), before * 1.001);
  EXPECT_TRUE(session.check(Work()).injective());
  session.set_seams(seam, false);
  session.update(0, Work());
  EXPECT_NEAR(session.energy(), before, 5e-3 * before);
  EXPECT_TRUE(session.check(Work()).injective());
}

TEST(Session, TwoShortUpdatesComeCloseToAColdOne) {
  const TriangleList mesh = meshes::bumps(24, 24);
  Session session = session_of(mesh);
  session.update(0, Work());
  session.set_seams(Edges{{12, 37}, {37, 62}, {62, 87}}, true);
  session.update(1, Work());
  session.update(1, Work());
  const double warm = session.energy();
  session.renew(std::vector<Index>{0}, true);
  session.update(0, Work());
  EXPECT_LE(warm, 1.005 * session.energy());
}

TEST(Session, ShortUpdatesComeToAnEnd) {
  // A seam that ends inside: its sides would rather lie on each other.
  const TriangleList mesh = meshes::bumps(16, 16);
  Session session = session_of(mesh);
  session.update(0, Work());
  session.set_seams(Edges{{8, 25}, {25, 42}, {42, 59}, {59, 76}, {76, 93}, {93, 110}}, true);
  int updates = 1;
  while (session.update(1, Work()).due > 0 && updates < 100) ++updates;
  EXPECT_LT(updates, 30);
  EXPECT_EQ(session.state().charts[0].outcome, Outcome::kOk);
}

TEST(Session, NothingDueChangesNothing) {
  Session session = session_of(meshes::bumps(10, 10));
  EXPECT_EQ(session.update(0, Work()).mapped, 1);
  const std::vector<Vec2> uvs = uvs_of(session);
  EXPECT_EQ(session.update(0, Work()).mapped, 0);
  EXPECT_TRUE(session.changes().empty());
  EXPECT_EQ(uvs_of(session), uvs);
}

TEST(Session, SeamsThatMeetNothingWait) {
  Session session = session_of(meshes::bumps(10, 10));
  session.update(0, Work());
  session.set_seams(Edges{{60, 61}, {61, 62}}, true);
  session.update(0, Work());
  EXPECT_EQ(session.state().charts.size(), 1U);
  EXPECT_TRUE(std::find(session.state().opened.begin(), session.state().opened.end(), true) ==
              session.state().opened.end());
}

TEST(Session, ClosedSurfacesAreOpenedAndSoTheyStay) {
  const TriangleList mesh = meshes::octahedron();
  Session session = session_of(mesh);
  session.update(0, Work());
  EXPECT_EQ(session.state().charts.size(), 1U);
  EXPECT_TRUE(session.check(Work()).injective());
  const EdgeMarks opened = session.state().opened;
  session.set_seams(Edges{{mesh.faces[0][0], mesh.faces[0][1]}}, true);
  session.update(0, Work());
  for (std::size_t h = 0; h < opened.size(); ++h) {
    EXPECT_TRUE(!opened[h] || session.state().opened[h] || session.state().seams[h]);
  }
}

TEST(Session, AFailureOrACancelLeavesAllAsItWas) {
  const TriangleList mesh = meshes::bumps(10, 10);
  Session session = session_of(mesh);
  session.update(0, Work());
  const std::vector<Vec2> uvs = uvs_of(session);
  session.set_pins({{0, 0, uvs[0], 0, 0}, {0, 1, uvs[2], 1, 1}, {0, 2, uvs[1], 2, 2}});
  EXPECT_THROW(session.update(0, Work()), Error);
  EXPECT_EQ(uvs_of(session), uvs);
  session.set_pins({});
  session.set_seams(Edges{{5, 16}, {16, 27}}, true);
  const std::atomic<bool> request{true};
  {
    const InterruptScope scope(&request);
    EXPECT_THROW(session.update(0, Work()), Cancelled);
  }
  EXPECT_EQ(uvs_of(session), uvs);
  session.update(0, Work());
  EXPECT_TRUE(session.check(Work()).injective());
}

TEST(Session, RandomEditsAreJudgedRightRepeatAndAreUndone) {
  const std::vector<TriangleList> all = {meshes::bumps(12, 12),      meshes::octahedron(),
                                         meshes::tetrahedron(),      meshes::annulus(12),
                                         meshes::torus_with_hole(6), meshes::two_components(),
                                         meshes::cap(8, 12, 2.5)};
  for (std::size_t m = 0; m < all.size(); ++m) {
    const TriangleList& mesh = all[m];
    std::vector<std::vector<Vec2>> first;
    for (int round = 0; round < 2; ++round) {
      std::mt19937 random(static_cast<unsigned>(m));
      Session session = session_of(mesh);
      session.update(0, Work());
      for (int edit = 0; edit < 20; ++edit) {
        const std::uint64_t mark = session.save();
        const std::vector<Vec2> before = uvs_of(session);
        session.set_seams(path(mesh, random, 1 + static_cast<int>(random() % 4)),
                          random() % 3 != 0);
        session.update(static_cast<int>(random() % 3), Work());
        expect_true_verdicts(session);
        if (round == 0) {
          first.push_back(uvs_of(session));
        } else {
          EXPECT_EQ(uvs_of(session), first[edit]) << m << " " << edit;
        }
        if (random() % 4 == 0) {
          session.restore(mark);
          EXPECT_EQ(uvs_of(session), before) << m << " " << edit;
        }
        session.forget(mark);
      }
    }
  }
}

}  // namespace
}  // namespace beltrami
