// Metrics of maps, transport between tangent planes, closest points and prolongation.
#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "descend/tutte.h"
#include "mesh/closest_point.h"
#include "prolong/frame.h"
#include "prolong/prolongation.h"
#include "prolong/surface_walk.h"
#include "simplify/coarse.h"
#include "simplify/simplify.h"
#include "support/disks.h"
#include "support/meshes.h"

namespace beltrami {
namespace {

using disks::Random;

std::vector<FaceMetric> metrics_of(const DiskMesh& mesh, const std::vector<Vec2>& uvs) {
  return face_metrics(mesh.faces, disks::rest_of(mesh), uvs);
}

Frame frame_of_face(const DiskMesh& mesh, Index face) {
  const Triangle& t = mesh.faces[face];
  bool valid;
  const Frame frame =
      face_frame(mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]], valid);
  EXPECT_TRUE(valid);
  return frame;
}

void expect_near(Complex actual, Complex expected, double tolerance) {
  EXPECT_LE(std::abs(actual - expected), tolerance) << actual << " instead of " << expected;
}

// ---- Metrics of a map -----------------------------------------------------------------------

TEST(FaceMetrics, OfAnAffineMapAreItsCoefficientsInTheFrameOfEachFace) {
  const DiskMesh mesh = disks::disk(meshes::fan(7));
  const Complex k(0.3, -0.4);
  const auto metrics = metrics_of(mesh, disks::affine_uvs(mesh, k));
  for (Index f = 0; f < mesh.face_count(); ++f) {
    // The frame is turned by r against the plane: z = r z'.
    const Frame frame = frame_of_face(mesh, f);
    const Complex r(frame.x.x(), frame.x.y());
    expect_near(metrics[f].mu, k * std::conj(r) * std::conj(r), 1e-13);
    expect_near(metrics[f].phase, r, 1e-13);
    EXPECT_NEAR(metrics[f].log_area, std::log(1 - std::norm(k)), 1e-13);
    expect_near(metrics[f].fz(), r, 1e-13);
  }
}

TEST(FaceMetrics, OfAnIsometryHaveNoCoefficient) {
  const DiskMesh mesh = disks::disk(meshes::grid(3, 3));
  for (const FaceMetric& m : metrics_of(mesh, disks::flat_uvs(mesh))) {
    expect_near(m.mu, 0, 1e-13);
    EXPECT_NEAR(m.log_area, 0, 1e-13);
  }
}

TEST(FaceMetrics, TurnByTheSquareOfTheRotationWhenTheFirstCornerChanges) {
  Random random(1);
  DiskMesh mesh = disks::disk(meshes::cap(3, 9, 1.4));
  std::vector<Vec2> uvs = tutte_embedding(mesh, Work(1));
  const auto before = metrics_of(mesh, uvs);
  std::vector<Frame> frames;
  for (Index f = 0; f < mesh.face_count(); ++f) frames.push_back(frame_of_face(mesh, f));
  for (Triangle& t : mesh.faces) std::rotate(t.begin(), t.begin() + 1 + random.below(2), t.end());
  const auto after = metrics_of(mesh, uvs);
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const Complex r = transport(frames[f], frame_of_face(mesh, f));
    EXPECT_GT(std::abs(r - 1.0), 0.1);
    expect_near(after[f].mu, before[f].mu * r * r, 1e-12);
    expect_near(after[f].phase, before[f].phase * std::conj(r), 1e-12);
    EXPECT_NEAR(after[f].log_area, before[f].log_area, 1e-11);
  }
}

TEST(FaceMetrics, HaveCoefficientsBelowOneOnPositiveMaps) {
  for (const auto& list : {meshes::cap(6, 20, 2.8), disks::spike(8), disks::slivers(8, 8),
                           disks::degenerate_faces(8), disks::punctured(3)}) {
    const DiskMesh mesh = disks::disk(list);
    for (const FaceMetric& m : metrics_of(mesh, tutte_embedding(mesh, Work(1)))) {
      EXPECT_LT(std::abs(m.mu), 1);
      EXPECT_TRUE(std::isfinite(m.log_area));
      EXPECT_NEAR(std::abs(m.phase), 1, 1e-12);
    }
  }
}

TEST(FaceMetrics, AreTheIdentitysWhereAFaceIsNotPositive) {
  const DiskMesh mesh = disks::disk(meshes::quad());
  const std::vector<Vec2> flipped = {{0, 0}, {1, 0}, {1, 1}, {0.9, 0.1}};
  const std::vector<Vec2> collapsed = {{0, 0}, {1, 0}, {1, 1}, {0.5, 0.5}};
  for (const auto& uvs : {flipped, collapsed}) {
    const FaceMetric m = metrics_of(mesh, uvs)[1];
    EXPECT_EQ(m.mu, Complex(0));
    EXPECT_EQ(m.log_area, 0);
    EXPECT_EQ(m.phase, Complex(1));
  }
}

// ---- Transport ------------------------------------------------------------------------------

Frame random_frame(Random& random) {
  const Vec3 n = random.vec3().normalized();
  return {n.cross(random.vec3()).normalized(), n};
}

Complex coordinates(const Vec3& tangent, const Frame& frame) {
  return {tangent.dot(frame.x), tangent.dot(frame.n.cross(frame.x))};
}

TEST(Transport, BetweenFramesOfOnePlaneIsThePlainChangeOfFrame) {
  Random random(2);
  for (int i = 0; i < 100; ++i) {
    const Frame from = random_frame(random);
    const Frame to{from.n.cross(random.vec3()).normalized(), from.n};
    const Vec3 tangent = from.n.cross(random.vec3());
    expect_near(transport(from, to) * coordinates(tangent, from), coordinates(tangent, to), 1e-13);
    expect_near(transport(from, from), 1, 1e-14);
  }
}

TEST(Transport, KeepsTheDirectionOfTheHinge) {
  Random random(3);
  for (int i = 0; i < 200; ++i) {
    const Frame from = random_frame(random), to = random_frame(random);
    const Vec3 hinge = from.n.cross(to.n).normalized();
    expect_near(transport(from, to) * coordinates(hinge, from), coordinates(hinge, to), 1e-9);
  }
}

TEST(Transport, TurnsTheDirectionAcrossTheHingeWithThePlane) {
  Random random(4);
  for (int i = 0; i < 200; ++i) {
    const Frame from = random_frame(random), to = random_frame(random);
    const Vec3 hinge = from.n.cross(to.n).normalized();
    const Complex across = coordinates(hinge.cross(from.n), from);
    expect_near(transport(from, to) * across, coordinates(hinge.cross(to.n), to), 1e-9);
  }
}

TEST(Transport, BackIsTheInverse) {
  Random random(5);
  for (int i = 0; i < 100; ++i) {
    const Frame from = random_frame(random), to = random_frame(random);
    expect_near(transport(from, to) * transport(to, from), 1, 1e-9);
  }
}

TEST(Transport, BetweenNearlyEqualNormalsIsSafe) {
  Random random(6);
  for (int i = 0; i < 100; ++i) {
    const Frame from = random_frame(random);
    const Vec3 n = (from.n + 1e-15 * random.vec3()).normalized();
    const Frame to{(from.x - from.x.dot(n) * n).normalized(), n};
    expect_near(transport(from, to), 1, 1e-13);
  }
}

TEST(Transport, BetweenOppositeNormalsIsAUnit) {
  Random random(7);
  for (int i = 0; i < 100; ++i) {
    const Frame from = random_frame(random);
    const Frame to{from.n.cross(random.vec3()).normalized(), -from.n};
    EXPECT_NEAR(std::abs(transport(from, to)), 1, 1e-13);
    for (const double tilt : {1e-5, 1e-7, 1e-9, 1e-16}) {
      const Vec3 n = (-from.n + tilt * random.vec3()).normalized();
      const Frame near{(to.x - to.x.dot(n) * n).normalized(), n};
      EXPECT_NEAR(std::abs(transport(from, near)), 1, 1e-13) << tilt;
    }
  }
}

TEST(Transport, BetweenOppositeNormalsTurnsAboutTheFirstAxis) {
  const Frame up{Vec3::UnitX(), Vec3::UnitZ()}, down{Vec3::UnitX(), -Vec3::UnitZ()};
  expect_near(transport(up, down), 1, 1e-15);
}

TEST(FrameOfNormal, IsOrthonormal) {
  Random random(8);
  for (int i = 0; i < 100; ++i) {
    const Vec3 n = random.vec3().normalized();
    const Frame frame = frame_of_normal(n);
    EXPECT_NEAR(frame.x.norm(), 1, 1e-14);
    EXPECT_NEAR(frame.x.dot(n), 0, 1e-14);
  }
}

TEST(FaceFrame, IsInvalidWithoutANormal) {
  bool valid = true;
  face_frame({0, 0, 0}, {1, 0, 0}, {2, 0, 0}, valid);
  EXPECT_FALSE(valid);
  valid = true;
  face_frame({1, 1, 1}, {1, 1, 1}, {2, 0, 0}, valid);
  EXPECT_FALSE(valid);
}

// ---- Closest points -------------------------------------------------------------------------

double distance(const Vec3& p, const std::array<double, 3>& w, const Vec3& a, const Vec3& b,
                const Vec3& c) {
  return (w[0] * a + w[1] * b + w[2] * c - p).norm();
}

TEST(ClosestOnTriangle, IsNoFartherThanAnySample) {
  Random random(9);
  constexpr int kSamples = 40;
  for (int i = 0; i < 200; ++i) {
    const Vec3 a = random.vec3(), b = random.vec3(), c = random.vec3(), p = 2 * random.vec3();
    const auto w = closest_on_triangle(p, a, b, c);
    EXPECT_NEAR(w[0] + w[1] + w[2], 1, 1e-14);
    for (const double share : w) EXPECT_GE(share, -1e-15);
    double sampled = std::numeric_limits<double>::infinity();
    for (int s = 0; s <= kSamples; ++s) {
      for (int t = 0; s + t <= kSamples; ++t) {
        const double u = static_cast<double>(s) / kSamples, v = static_cast<double>(t) / kSamples;
        sampled = std::min(sampled, distance(p, {1 - u - v, u, v}, a, b, c));
      }
    }
    const double found = distance(p, w, a, b, c);
    EXPECT_LE(found, sampled + 1e-12);
    EXPECT_GE(found, sampled - 3.0 / kSamples);
  }
}

TEST(ClosestOnTriangle, OfAPointOfTheTriangleIsThatPoint) {
  Random random(10);
  for (int i = 0; i < 100; ++i) {
    const Vec3 a = random.vec3(), b = random.vec3(), c = random.vec3();
    const double u = 0.5 * random.unit(), v = 0.5 * random.unit();
    const Vec3 p = (1 - u - v) * a + u * b + v * c;
    EXPECT_LE(distance(p, closest_on_triangle(p, a, b, c), a, b, c), 1e-13);
  }
}

TEST(ClosestOnTriangle, TakesDegenerateTriangles) {
  const Vec3 p(0.4, 1, 0), a(0, 0, 0), b(1, 0, 0);
  EXPECT_NEAR(distance(p, closest_on_triangle(p, a, b, {0.5, 0, 0}), a, b, {0.5, 0, 0}), 1, 0.02);
  for (const double share : closest_on_triangle(p, a, a, a)) EXPECT_TRUE(std::isfinite(share));
}

struct Soup {
  std::vector<Vec3> positions;
  std::vector<Triangle> faces;
};

Soup random_soup(Random& random, int count) {
  Soup soup;
  for (int f = 0; f < count; ++f) {
    const Vec3 centre = random.vec3();
    for (int k = 0; k < 3; ++k) soup.positions.push_back(centre + 0.2 * random.vec3());
    soup.faces.push_back({3 * f, 3 * f + 1, 3 * f + 2});
  }
  return soup;
}

/// The answer of a plain loop over all faces: the first of the closest.
SurfacePoint closest_by_force(const std::vector<Vec3>& positions,
                              const std::vector<Triangle>& faces, const Vec3& p, const Vec3& n) {
  SurfacePoint best;
  for (const bool filtered : {true, false}) {
    best.distance_sq = std::numeric_limits<double>::infinity();
    for (Index f = 0; f < size_of(faces); ++f) {
      const Vec3 &a = positions[faces[f][0]], &b = positions[faces[f][1]],
                 &c = positions[faces[f][2]];
      if (filtered && !((b - a).cross(c - a).dot(n) > 0)) continue;
      const auto w = closest_on_triangle(p, a, b, c);
      const double distance_sq = (w[0] * a + w[1] * b + w[2] * c - p).squaredNorm();
      if (distance_sq < best.distance_sq) best = {f, w, distance_sq};
    }
    if (best.face != kNone) break;
  }
  return best;
}

TEST(ClosestPoint, IsTheOneThatALoopOverAllFacesFindsWhateverTheSeed) {
  Random random(11);
  for (const int count : {1, 2, 5, 300}) {
    const Soup soup = random_soup(random, count);
    const ClosestPoint tree(soup.positions, soup.faces);
    for (int i = 0; i < 200; ++i) {
      const Vec3 p = 1.5 * random.vec3(), n = random.vec3();
      const SurfacePoint expected = closest_by_force(soup.positions, soup.faces, p, n);
      for (const Index seed : {kNone, random.below(count), expected.face}) {
        const SurfacePoint found = tree.find(p, n, seed);
        ASSERT_EQ(found.face, expected.face);
        ASSERT_EQ(found.barycentric, expected.barycentric);
        ASSERT_EQ(found.distance_sq, expected.distance_sq);
      }
    }
  }
}

// Points beside a flat mesh are closest to edges and vertices, where faces tie.
TEST(ClosestPoint, DoesNotDependOnTheSeedWhereFacesTie) {
  Random random(12);
  const DiskMesh mesh = disks::disk(meshes::grid(7, 7));
  const ClosestPoint tree(mesh.positions, mesh.faces);
  for (int i = 0; i < 500; ++i) {
    Vec3 p = 2 * random.vec3();
    if (i % 2 == 0) p = mesh.positions[random.below(64)] + Vec3(0, 0, random.unit());
    const SurfacePoint plain = tree.find(p, Vec3::UnitZ(), kNone);
    for (Index seed = 0; seed < mesh.face_count(); ++seed) {
      const SurfacePoint seeded = tree.find(p, Vec3::UnitZ(), seed);
      ASSERT_EQ(seeded.face, plain.face) << "point " << i << " seed " << seed;
      ASSERT_EQ(seeded.barycentric, plain.barycentric);
    }
  }
}

/// Squares at z = 0, facing up, and at z = 0.1, facing down.
Soup two_sheets() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0.1}, {1, 0, 0.1}, {0, 1, 0.1}},
          {{0, 1, 2}, {3, 5, 4}}};
}

TEST(ClosestPoint, TakesTheSheetThatFacesTheSameWay) {
  const Soup soup = two_sheets();
  const ClosestPoint tree(soup.positions, soup.faces);
  for (const double z : {-1.0, 0.01, 0.09, 3.0}) {
    EXPECT_EQ(tree.find({0.2, 0.2, z}, Vec3::UnitZ(), 1).face, 0) << z;
    EXPECT_EQ(tree.find({0.2, 0.2, z}, -Vec3::UnitZ(), 0).face, 1) << z;
  }
}

TEST(ClosestPoint, FallsBackToAllFacesWhereNoNormalAgrees) {
  const Soup soup = two_sheets();
  const ClosestPoint tree(soup.positions, soup.faces);
  for (const Index seed : {kNone, 0, 1}) {
    EXPECT_EQ(tree.find({0.2, 0.2, 0.09}, Vec3::UnitX(), seed).face, 1);
    EXPECT_EQ(tree.find({0.2, 0.2, 0.01}, Vec3::UnitX(), seed).face, 0);
  }
}

// ---- Prolongation ---------------------------------------------------------------------------

double greatest_mu(const std::vector<FaceMetric>& metrics) {
  double greatest = 0;
  for (const FaceMetric& m : metrics) greatest = std::max(greatest, std::abs(m.mu));
  return greatest;
}

std::vector<FaceMetric> random_metrics(const DiskMesh& mesh, Random& random) {
  std::vector<FaceMetric> metrics(mesh.faces.size());
  for (FaceMetric& m : metrics) {
    m.mu = std::polar(0.95 * random.unit(), random.between(0, 2 * std::numbers::pi));
    m.log_area = random.between(-3, 2);
    m.phase = std::polar(1.0, random.between(0, 2 * std::numbers::pi));
  }
  return metrics;
}

TEST(ProlongMetric, OfAnAffineMapOntoTheSameFlatMeshIsExact) {
  const DiskMesh mesh = disks::disk(meshes::fan(9));
  const auto metrics = metrics_of(mesh, disks::affine_uvs(mesh, {0.2, 0.5}));
  const auto prolonged = prolong_metric(mesh, metrics, mesh, {}, Work(1));
  for (Index f = 0; f < mesh.face_count(); ++f) {
    expect_near(prolonged[f].mu, metrics[f].mu, 1e-13);
    expect_near(prolonged[f].phase, metrics[f].phase, 1e-13);
    EXPECT_NEAR(prolonged[f].log_area, metrics[f].log_area, 1e-13);
  }
}

TEST(ProlongMetric, OfAnAffineMapOntoAFinerFlatMeshIsExact) {
  const DiskMesh coarse = disks::disk(meshes::grid(2, 3)), fine = disks::disk(meshes::grid(9, 7));
  const Complex k(-0.3, 0.6);
  const auto expected = metrics_of(fine, disks::affine_uvs(fine, k));
  const auto prolonged =
      prolong_metric(coarse, metrics_of(coarse, disks::affine_uvs(coarse, k)), fine, {}, Work(1));
  for (Index f = 0; f < fine.face_count(); ++f) {
    expect_near(prolonged[f].mu, expected[f].mu, 1e-13);
    expect_near(prolonged[f].fz(), expected[f].fz(), 1e-13);
  }
}

TEST(ProlongMetric, NeverExceedsTheGreatestCoarseValues) {
  Random random(13);
  const DiskMesh fine = disks::disk(meshes::cap(12, 40, 2.0));
  for (const auto& list : {meshes::cap(3, 8, 2.0), meshes::cap(12, 40, 2.0)}) {
    const DiskMesh coarse = disks::disk(list);
    const auto metrics = random_metrics(coarse, random);
    for (const FaceMetric& m : prolong_metric(coarse, metrics, fine, {}, Work(1))) {
      EXPECT_LE(std::abs(m.mu), greatest_mu(metrics) * (1 + 1e-12));
      EXPECT_GE(m.log_area, -3);
      EXPECT_LE(m.log_area, 2);
      EXPECT_NEAR(std::abs(m.phase), 1, 1e-12);
    }
  }
}

// At a slit, centroids may land on the wrong side: harmless, as long as the values are.
TEST(ProlongMetric, StaysBelowOneAtCoincidentSeamSides) {
  const DiskMesh coarse = disks::disk(disks::slit(2)), fine = disks::disk(disks::slit(8));
  const auto metrics = metrics_of(coarse, tutte_embedding(coarse, Work(1)));
  const auto prolonged = prolong_metric(coarse, metrics, fine, {}, Work(1));
  EXPECT_LE(greatest_mu(prolonged), greatest_mu(metrics) * (1 + 1e-12));
  EXPECT_LT(greatest_mu(prolonged), 1);
}

TEST(ProlongMetric, IsFiniteWithFacesThatHaveNoNormalOnEitherSide) {
  Random random(14);
  const DiskMesh bad = disks::disk(disks::degenerate_faces(8));
  const DiskMesh good = disks::disk(meshes::bumps(5, 5));
  for (const auto& [coarse, fine] : {std::pair(&bad, &good), std::pair(&good, &bad)}) {
    const auto metrics = random_metrics(*coarse, random);
    for (const FaceMetric& m : prolong_metric(*coarse, metrics, *fine, {}, Work(1))) {
      EXPECT_LT(std::abs(m.mu), 1);
      EXPECT_TRUE(std::isfinite(m.log_area));
      EXPECT_NEAR(std::abs(m.phase), 1, 1e-12);
    }
  }
}

// What the simplifier says of the neighbourhood saves searches, and changes nothing that matters.
TEST(ProlongMetric, IsTheSameFromANearbyVertexAsFromASearch) {
  for (const auto& list : {meshes::cap(40, 120, 1.5), disks::slit(40), meshes::bumps(60, 60)}) {
    const DiskMesh fine = disks::disk(list);
    const CoarseDisk coarse = simplify(fine, 400, Work(1));
    const auto metrics = metrics_of(coarse.mesh, tutte_embedding(coarse.mesh, Work(1)));
    const auto searched = prolong_metric(coarse.mesh, metrics, fine, {}, Work(1));
    const auto walked = prolong_metric(coarse.mesh, metrics, fine, coarse.nearby, Work(1));
    int off = 0;
    for (Index f = 0; f < fine.face_count(); ++f) {
      off += std::abs(searched[f].mu - walked[f].mu) > 1e-9;
    }
    // Beside ridges, where two faces are as near, and at seams.
    EXPECT_LE(off, 0.02 * fine.face_count());
    EXPECT_LE(greatest_mu(walked), greatest_mu(metrics) * (1 + 1e-12));
  }
}

TEST(SurfaceWalk, FindsThePointBelowFromAnyFace) {
  Random random(16);
  const DiskMesh mesh = disks::disk(meshes::grid(10, 10));
  const SurfaceWalk walk(mesh, Work(1));
  for (int i = 0; i < 100; ++i) {
    const auto face = static_cast<Index>(random.below(mesh.face_count()));
    const Triangle& t = mesh.faces[face];
    const Vec3 point = 0.2 * mesh.positions[t[0]] + 0.5 * mesh.positions[t[1]] +
                       0.3 * mesh.positions[t[2]] + Vec3(0, 0, 1e-3);
    const SurfacePoint hit =
        walk.find(point, Vec3::UnitZ(), static_cast<Index>(random.below(mesh.face_count())));
    ASSERT_EQ(hit.face, face);
    EXPECT_NEAR(hit.barycentric[1], 0.5, 1e-9);
    EXPECT_NEAR(hit.distance_sq, 1e-6, 1e-12);
  }
}

TEST(SurfaceWalk, GivesUpOutsideFarAwayAndOnTheOtherSide) {
  const DiskMesh mesh = disks::disk(meshes::grid(4, 4));
  const SurfaceWalk walk(mesh, Work(1));
  const Triangle& t = mesh.faces[0];
  const Vec3 centre = (mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]]) / 3;
  EXPECT_EQ(walk.find(centre, Vec3::UnitZ(), 7).face, 0);
  EXPECT_EQ(walk.find(centre - Vec3(100, 0, 0), Vec3::UnitZ(), 7).face, kNone);
  EXPECT_EQ(walk.find(centre + Vec3(0, 0, 100), Vec3::UnitZ(), 7).face, kNone);
  EXPECT_EQ(walk.find(centre, -Vec3::UnitZ(), 7).face, kNone);
}

TEST(ProlongMetric, HasTheSameBitsOnTwoThreads) {
  Random random(15);
  const DiskMesh coarse = disks::disk(meshes::bumps(12, 12));
  const DiskMesh fine = disks::disk(meshes::bumps(80, 80));
  const auto metrics = random_metrics(coarse, random);
  const auto one = prolong_metric(coarse, metrics, fine, {}, Work(1));
  const auto two = prolong_metric(coarse, metrics, fine, {}, Work(2));
  for (Index f = 0; f < fine.face_count(); ++f) {
    ASSERT_EQ(one[f].mu, two[f].mu);
    ASSERT_EQ(one[f].log_area, two[f].log_area);
    ASSERT_EQ(one[f].phase, two[f].phase);
  }
}

}  // namespace
}  // namespace beltrami
