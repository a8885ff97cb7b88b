// Pieces of one shape are found, and are cut alike.
#include "atlas/congruent.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "atlas/open.h"
#include "atlas/types.h"
#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "chart/flattening.h"
#include "cut/seam_target.h"
#include "mesh/surface.h"
#include "pack/types.h"
#include "support/atlases.h"
#include "support/meshes.h"
#include "support/solids.h"
#include "support/surfaces.h"

namespace beltrami {
namespace {

using meshes::TriangleList;

SurfacePiece piece_of(const TriangleList& mesh) {
  SurfacePiece piece;
  piece.surface = build_surface(mesh.positions, mesh.faces, Work(1));
  piece.real_faces = piece.surface.face_count();
  piece.topology = topology_of(piece.surface, Work(1));
  piece.exponent = bring_to_unit(piece.surface, Work(1));
  return piece;
}

/// Turned and shifted, its vertices and faces in another order.
TriangleList copied(const TriangleList& mesh, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  const Eigen::Matrix3d turn = meshes::some_turn();
  TriangleList copy =
      meshes::moved(mesh, [&](const Vec3& p) { return Vec3(turn * p + Vec3(3, -5, 7)); });
  std::vector<Index> place(copy.positions.size());
  for (std::size_t v = 0; v < place.size(); ++v) place[v] = static_cast<Index>(v);
  std::shuffle(place.begin(), place.end(), generator);
  TriangleList shuffled{std::vector<Vec3>(place.size()), copy.faces};
  for (std::size_t v = 0; v < place.size(); ++v) shuffled.positions[place[v]] = copy.positions[v];
  for (Triangle& face : shuffled.faces) {
    face = {place[face[1]], place[face[2]], place[face[0]]};
  }
  std::shuffle(shuffled.faces.begin(), shuffled.faces.end(), generator);
  return shuffled;
}

TriangleList reflected(TriangleList mesh) {
  for (Vec3& p : mesh.positions) p.x() = -p.x();
  for (Triangle& face : mesh.faces) std::swap(face[1], face[2]);
  return mesh;
}

TriangleList blob() {
  return meshes::shaken(meshes::sphere(2), 0.1, 4);
}

TEST(Congruent, PiecesAreInAnyOrderAndPlaceAndReflected) {
  const TriangleList other = meshes::shaken(meshes::sphere(2), 0.1, 5);
  const std::vector<SurfacePiece> pieces = {
      piece_of(blob()),
      piece_of(other),
      piece_of(copied(blob(), 1)),
      piece_of(reflected(blob())),
      piece_of(meshes::moved(blob(), [](const Vec3& p) { return Vec3(1.5 * p); })),
      piece_of(copied(reflected(other), 2))};
  EXPECT_EQ(first_congruent(pieces), (std::vector<Index>{0, 1, 0, 0, 4, 1}));
}

/// A square of two triangles, bent by an angle at its diagonal.
TriangleList leaf(double angle) {
  const double half = std::sqrt(0.5);
  return {{{0, -half, 0},
           {half, 0, 0},
           {0, half, 0},
           {-half * std::cos(angle), 0, half * std::sin(angle)}},
          {{0, 1, 2}, {2, 3, 0}}};
}

TEST(Congruent, EdgesOfTheSameLengthsAreNotEnough) {
  const std::vector<SurfacePiece> pieces = {piece_of(leaf(0)), piece_of(leaf(1)),
                                            piece_of(copied(leaf(1), 1)), piece_of(leaf(-1)),
                                            piece_of(leaf(1.01))};
  // Bent to the other side it would have to be turned inside out.
  EXPECT_EQ(first_congruent(pieces), (std::vector<Index>{0, 1, 1, 3, 4}));
  EXPECT_TRUE(laid_onto(pieces[1], pieces[2], false));
  EXPECT_FALSE(laid_onto(pieces[1], pieces[0], true));
}

TEST(Congruent, LabelsAndLockedEdgesBelongToTheShape) {
  std::vector<SurfacePiece> pieces(3, piece_of(blob()));
  pieces[1].hints.labels.assign(pieces[1].surface.faces.size(), 0);
  pieces[1].hints.labels[5] = 1;
  pieces[2].locked.assign(pieces[2].surface.twin.size(), false);
  EXPECT_EQ(first_congruent(pieces), (std::vector<Index>{0, 1, 0}));
  mark_edge(pieces[2].surface, 7, pieces[2].locked);
  pieces[0].locked.assign(pieces[0].surface.twin.size(), false);
  EXPECT_EQ(first_congruent(pieces), (std::vector<Index>{0, 1, 2}));
}

TEST(Congruent, MarksAreCarriedToEdgesOfTheSameLengths) {
  const SurfacePiece from = piece_of(blob());
  EdgeMarks marks(from.surface.twin.size(), false);
  for (const Index h : {3, 17, 50, 200}) mark_edge(from.surface, h, marks);
  const auto lengths = [](const SurfacePiece& piece, const EdgeMarks& of) {
    std::vector<double> found;
    for (Index h = 0; h < size_of(of); ++h) {
      if (!of[h]) continue;
      EXPECT_TRUE(of[piece.surface.twin[h]]);
      const Vec3 edge = piece.surface.positions[piece.surface.target(h)] -
                        piece.surface.positions[piece.surface.origin(h)];
      found.push_back(edge.norm());
    }
    std::sort(found.begin(), found.end());
    return found;
  };
  for (const TriangleList& mesh : {copied(blob(), 3), copied(reflected(blob()), 4)}) {
    const SurfacePiece to = piece_of(mesh);
    const std::vector<double> own = lengths(from, marks);
    const std::vector<double> carried = lengths(to, carried_marks(from, marks, to));
    ASSERT_EQ(own.size(), carried.size());
    for (std::size_t i = 0; i < own.size(); ++i) EXPECT_NEAR(own[i], carried[i], 1e-9);
  }
}

TEST(Congruent, CopiesHaveSeamsOfOneLengthEach) {
  const TriangleList mesh =
      meshes::together({blob(), copied(blob(), 6), copied(reflected(blob()), 7)});
  AtlasOptions options;
  options.target = SeamTarget{};
  options.pack = PackOptions{};
  const Atlas all = atlases::unwrapped(mesh, options), one = atlases::unwrapped(blob(), options);
  atlases::expect_sound(mesh, all);
  EXPECT_TRUE(all.missed.empty());
  EXPECT_NEAR(all.seam_length, 3 * one.seam_length, 1e-6 * all.seam_length);
  EXPECT_EQ(all.charts.size(), 3 * one.charts.size());
}

using UvTriangle = std::vector<std::pair<double, double>>;

/// The places of the corners of some faces, in any order.
std::vector<UvTriangle> uv_triangles(const Atlas& atlas, Index first, Index end) {
  std::vector<UvTriangle> all;
  for (Index f = first; f < end; ++f) {
    UvTriangle& corners = all.emplace_back();
    for (const Index v : atlas.faces[f]) {
      corners.emplace_back(atlas.uvs[v].x(), atlas.uvs[v].y());
    }
    std::sort(corners.begin(), corners.end());
  }
  std::sort(all.begin(), all.end());
  return all;
}

/// UV vertices are of the vertices of the corners that have them.
void expect_own_vertices(const TriangleList& mesh, const Atlas& atlas) {
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(atlas.input_vertex[atlas.faces[f][k]], mesh.faces[f][k]) << f;
    }
  }
}

TEST(Stack, CopiesLieOnTheFirstOfTheirKindToTheLastBit) {
  const Index n = size_of(blob().faces);
  const TriangleList other = meshes::shaken(meshes::sphere(2), 0.1, 5);
  const TriangleList mesh =
      meshes::together({blob(), copied(blob(), 6), other, copied(reflected(blob()), 7)});
  for (const bool is_searched : {true, false}) {
    AtlasOptions options;
    if (is_searched) options.target = SeamTarget{};
    options.pack = PackOptions{};
    const Atlas apart = atlases::unwrapped(mesh, options);
    EXPECT_EQ(apart.stacked_parts, 0);
    options.stack = Stack::kCopies;
    const Atlas copies = atlases::unwrapped(mesh, options);
    EXPECT_EQ(copies.outcome, Outcome::kOk);
    EXPECT_EQ(copies.stacked_parts, 1);
    EXPECT_EQ(std::count(copies.excepted.begin(), copies.excepted.end(), true), n);
    EXPECT_LT(copies.charts.size(), apart.charts.size());
    EXPECT_EQ(uv_triangles(copies, 0, n), uv_triangles(copies, n, 2 * n));
    EXPECT_NE(uv_triangles(copies, 0, n), uv_triangles(copies, 3 * n, 4 * n));
    expect_own_vertices(mesh, copies);
    options.stack = Stack::kMirrored;
    const Atlas mirrored = atlases::unwrapped(mesh, options);
    EXPECT_EQ(mirrored.outcome, Outcome::kOk);
    EXPECT_EQ(mirrored.stacked_parts, 2);
    EXPECT_EQ(uv_triangles(mirrored, 0, n), uv_triangles(mirrored, 3 * n, 4 * n));
    EXPECT_GT(mirrored.pages->texels_per_unit, copies.pages->texels_per_unit);
    EXPECT_FALSE(mirrored.reversed[n]);
    EXPECT_TRUE(mirrored.reversed[3 * n]);
    expect_own_vertices(mesh, mirrored);
  }
}

/// Of a relief that is symmetric to x = 0, and to nothing else.
Vec3 on_relief(double x, double y) {
  const double off = std::abs(x), height = 0.2 * std::sin(3 * off + 1) * std::cos(4 * y);
  return {x, y * (1 + 0.3 * off), height + 0.1 * off * y};
}

/// A grid on it, of `columns` from x = `first` to 1.
TriangleList relief(double first, int columns) {
  constexpr int kRows = 9;
  TriangleList mesh;
  for (int j = 0; j <= kRows; ++j) {
    for (int i = 0; i <= columns; ++i) {
      mesh.positions.push_back(
          on_relief(first + (1 - first) * double(i) / columns, double(j) / kRows));
    }
  }
  for (Index j = 0; j < kRows; ++j) {
    for (Index i = 0; i < columns; ++i) {
      const Index a = j * (columns + 1) + i, b = a + columns + 1;
      mesh.faces.push_back({a, a + 1, b + 1});
      mesh.faces.push_back({a, b + 1, b});
    }
  }
  return mesh;
}

/// One side of it, and its mirror image, which have their vertices at x = 0 in common.
TriangleList butterfly() {
  TriangleList mesh = relief(0, 9);
  const TriangleList image = reflected(mesh);
  std::vector<Index> number(image.positions.size());
  for (Index v = 0; v < size_of(number); ++v) {
    const bool in_common = image.positions[v].x() == 0;
    number[v] = in_common ? v : size_of(mesh.positions);
    if (!in_common) mesh.positions.push_back(image.positions[v]);
  }
  for (const Triangle& face : image.faces) {
    mesh.faces.push_back({number[face[0]], number[face[1]], number[face[2]]});
  }
  return mesh;
}

TEST(Stack, TheHalvesOfWhatIsSymmetricLieOnEachOther) {
  const TriangleList mesh = butterfly();
  const Index n = size_of(mesh.faces) / 2;
  for (const bool is_searched : {true, false}) {
    AtlasOptions options;
    if (is_searched) options.target = SeamTarget{};
    options.pack = PackOptions{};
    options.stack = Stack::kMirrored;
    const Atlas whole = atlases::unwrapped(mesh, options);
    EXPECT_EQ(whole.stacked_parts, 0) << "it is one component";
    options.stack = Stack::kHalves;
    const Atlas halves = atlases::unwrapped(mesh, options);
    EXPECT_EQ(halves.outcome, Outcome::kOk);
    EXPECT_EQ(halves.stacked_parts, 1);
    EXPECT_EQ(uv_triangles(halves, 0, n), uv_triangles(halves, n, 2 * n));
    EXPECT_GT(halves.pages->texels_per_unit, whole.pages->texels_per_unit);
    expect_own_vertices(mesh, halves);
  }
}

TEST(Stack, WhatHasNoHalvesStaysInOnePiece) {
  // The middle column lies across the plane.
  for (const TriangleList& mesh : {relief(-1, 9), blob()}) {
    AtlasOptions options;
    options.target = SeamTarget{};
    options.stack = Stack::kHalves;
    const Atlas atlas = atlases::unwrapped(mesh, options);
    options.stack = Stack::kMirrored;
    const Atlas mirrored = atlases::unwrapped(mesh, options);
    EXPECT_EQ(atlas.outcome, Outcome::kOk);
    EXPECT_EQ(atlas.stacked_parts, mirrored.stacked_parts);
    EXPECT_EQ(atlas.charts.size(), mirrored.charts.size());
  }
}

TEST(Stack, AFaceLiesOnTheOneThatItIsACopyOf) {
  const TriangleList mesh = meshes::together({blob(), copied(reflected(blob()), 7)});
  AtlasOptions options;
  options.target = SeamTarget{};
  options.stack = Stack::kMirrored;
  const Atlas atlas = atlases::unwrapped(mesh, options);
  const auto lengths = [&](Index f) {
    std::vector<std::pair<double, double>> of;  // in the plane, and on the surface
    for (int k = 0; k < 3; ++k) {
      const Index a = atlas.faces[f][k], b = atlas.faces[f][(k + 1) % 3];
      const Vec3 edge =
          mesh.positions[mesh.faces[f][k]] - mesh.positions[mesh.faces[f][(k + 1) % 3]];
      of.emplace_back((atlas.uvs[a] - atlas.uvs[b]).norm(), edge.norm());
    }
    std::sort(of.begin(), of.end());
    return of;
  };
  const auto all = [&](Index first, Index end) {
    std::vector<std::vector<std::pair<double, double>>> found;
    for (Index f = first; f < end; ++f) found.push_back(lengths(f));
    std::sort(found.begin(), found.end());
    return found;
  };
  const Index n = size_of(blob().faces);
  const auto own = all(0, n), stacked = all(n, 2 * n);
  for (Index f = 0; f < n; ++f) {
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(own[f][k].first, stacked[f][k].first);
      EXPECT_NEAR(own[f][k].second, stacked[f][k].second, 1e-9);
    }
  }
}

}  // namespace
}  // namespace beltrami
