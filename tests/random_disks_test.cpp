// Nothing it cannot flatten: 800 disks that nobody chose.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <string>
#include <vector>

#include "base/error.h"
#include "pipeline/pipeline.h"
#include "support/disks.h"

namespace beltrami {
namespace {

using disks::Random;
using meshes::TriangleList;

void scale_axes(Random& random, double most, TriangleList& mesh) {
  const Vec3 factor(std::pow(most, random.unit()), std::pow(most, random.unit()), 1);
  for (Vec3& p : mesh.positions) p = p.cwiseProduct(factor);
}

void add_noise(Random& random, double share, TriangleList& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.faces) {
    sum += (mesh.positions[t[1]] - mesh.positions[t[0]]).norm();
  }
  const double length = share * sum / static_cast<double>(mesh.faces.size());
  for (Vec3& p : mesh.positions) p += length * random.vec3();
}

void add_spikes(Random& random, TriangleList& mesh) {
  const int count = 1 + random.below(4);
  for (int i = 0; i < count; ++i) {
    const int v = random.below(static_cast<int>(mesh.positions.size()));
    mesh.positions[v] += random.between(1, 30) * random.vec3();
  }
}

/// Faces glued to boundary edges by one edge each.
void add_ears(Random& random, TriangleList& mesh) {
  const DiskMesh disk = build_disk(mesh.positions, mesh.faces);
  const Index count = size_of(disk.boundary);
  for (Index i = 0; i < count; ++i) {
    if (random.below(4) != 0) continue;
    const Index a = disk.boundary[i], b = disk.boundary[(i + 1) % count];
    const Vec3 middle = 0.5 * (mesh.positions[a] + mesh.positions[b]);
    const double length = (mesh.positions[b] - mesh.positions[a]).norm();
    mesh.faces.push_back({b, a, size_of(mesh.positions)});
    mesh.positions.push_back(middle + length * random.vec3());
  }
}

/// Flips interior edges at random, for vertices of high degree and bridges.
void flip_edges(Random& random, TriangleList& mesh) {
  for (int attempt = 0; attempt < 200; ++attempt) {
    const DiskMesh disk = build_disk(mesh.positions, mesh.faces);
    const Index h = random.below(static_cast<int>(disk.twin.size()));
    if (disk.twin[h] == kNone) continue;
    const Index t = disk.twin[h];
    const Index p = disk.origin(h), q = disk.target(h);
    const Index r = disk.origin(DiskMesh::previous(h)), s = disk.origin(DiskMesh::previous(t));
    std::vector<Triangle> faces = mesh.faces;
    faces[h / 3] = {p, s, r};
    faces[t / 3] = {q, r, s};
    try {
      build_disk(mesh.positions, faces);
    } catch (const Error&) {
      continue;  // the edge is there already
    }
    mesh.faces = std::move(faces);
  }
}

void collapse_some_positions(Random& random, TriangleList& mesh) {
  if (mesh.faces.size() < 12) return;  // some area must remain
  const int count = 1 + random.below(5);
  for (int i = 0; i < count; ++i) {
    const Triangle& t = mesh.faces[random.below(static_cast<int>(mesh.faces.size()))];
    mesh.positions[t[0]] = mesh.positions[t[random.below(2) + 1]];
  }
}

TriangleList random_base(Random& random) {
  switch (random.below(11)) {
    case 0:
      return meshes::triangle();
    case 1:
      return meshes::quad();
    case 2:
      return meshes::fan(3 + random.below(40));
    case 3:
      return meshes::strip(1 + random.below(60));
    case 4:
      return meshes::bumps(2 + random.below(20), 2 + random.below(20));
    case 5:
      return meshes::cap(2 + random.below(12), 3 + random.below(30), random.between(0.2, 3.1));
    case 6:
      return disks::dumbbell(3 + random.below(7));
    case 7:
      return disks::tube(2 + random.below(25), 3 + random.below(14), random.between(0.02, 2));
    case 8:
      return disks::ramp(10 + random.below(40), 2 + random.below(5));
    case 9:
      return disks::punctured(1 + random.below(3));
    default:
      return disks::slit(2 + random.below(6));
  }
}

TriangleList random_disk(int seed) {
  Random random(static_cast<std::uint64_t>(seed));
  TriangleList mesh = random_base(random);
  if (random.below(3) == 0) flip_edges(random, mesh);
  if (random.below(3) == 0) add_ears(random, mesh);
  if (random.below(2) == 0) add_noise(random, random.between(0, 0.8), mesh);
  if (random.below(3) == 0) scale_axes(random, 1000, mesh);
  if (random.below(4) == 0) add_spikes(random, mesh);
  if (random.below(8) == 0) collapse_some_positions(random, mesh);
  return mesh;
}

Options random_options(int seed) {
  Random random(static_cast<std::uint64_t>(seed) + 1000000);
  Options options;
  if (random.below(2) == 0) options.coarse_faces = 20 + random.below(200);
  if (random.below(3) == 0) {
    constexpr std::array<std::int32_t, 2> kFlattens = {BELTRAMI_FLATTEN_DIRICHLET,
                                                       BELTRAMI_FLATTEN_GIF};
    options.flatten = kFlattens[static_cast<std::size_t>(random.below(2))];
  }
  if (random.below(4) == 0) options.energy = BELTRAMI_ENERGY_SYMMETRIC_ARAP;
  options.delaunay = random.below(6) == 0;
  options.unit_square = random.below(6) == 0;
  return options;
}

/// Ten seeds a test, so that they run side by side.
class RandomDisks : public testing::TestWithParam<int> {};

TEST_P(RandomDisks, EndInjective) {
  for (int seed = 10 * GetParam(); seed < 10 * GetParam() + 10; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    TriangleList mesh = random_disk(seed);
    const Normalisation frame = normalise(mesh.positions, mesh.faces);
    const DiskMesh disk = disks::disk(std::move(mesh));
    const std::atomic<bool> cancelled{false};
    const Flattening result = flatten(disk, frame, random_options(seed), {}, cancelled);
    EXPECT_TRUE(result.certificate.injective())
        << disk.face_count() << " faces, " << result.certificate.orientations.negative
        << " flipped, " << result.certificate.orientations.degenerate << " degenerate, "
        << result.certificate.crossings.count << " crossings";
    EXPECT_NE(result.status, BELTRAMI_NOT_INJECTIVE);
    EXPECT_TRUE(std::isfinite(result.distortion.symmetric_dirichlet));
    for (const Vec2& w : result.uvs) ASSERT_TRUE(w.allFinite());
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomDisks, testing::Range(0, 50));

// ---- Everything at its extreme, through every method -----------------------------------------

void scale_coordinates(Random& random, double decades, int one_in, TriangleList& mesh) {
  for (Vec3& p : mesh.positions) {
    for (int k = 0; k < 3; ++k) {
      if (random.below(one_in) == 0) p[k] *= std::pow(10.0, random.between(-decades, decades));
    }
  }
}

void scale_to_an_end_of_the_range(Random& random, TriangleList& mesh) {
  double greatest = 0;
  for (const Vec3& p : mesh.positions) greatest = std::max(greatest, p.cwiseAbs().maxCoeff());
  const double target = random.below(2) == 0 ? 1e-308 : 1e302;
  for (Vec3& p : mesh.positions) p = p / greatest * target;
}

TriangleList extreme_disk(int seed, Random& random) {
  TriangleList mesh = random_disk(seed);
  if (random.below(3) == 0) scale_coordinates(random, 20, 4, mesh);
  if (random.below(12) == 0) scale_coordinates(random, 250, 3, mesh);
  if (random.below(6) == 0) {
    const double flat = std::pow(10.0, -random.between(3, 14));
    for (Vec3& p : mesh.positions) p.y() *= flat;
  }
  if (random.below(6) == 0) {
    const Vec3 offset = std::pow(10.0, random.between(0, 12)) * random.vec3();
    for (Vec3& p : mesh.positions) p += offset;
  }
  if (random.below(6) == 0) scale_to_an_end_of_the_range(random, mesh);
  if (random.below(4) == 0) {
    const double unit = random.below(2) == 0 ? std::ldexp(1.0, random.below(80) - 40)
                                             : std::pow(10.0, random.between(-12, 12));
    for (Vec3& p : mesh.positions) p = (unit * p).cwiseMax(-1e307).cwiseMin(1e307);
  }
  return mesh;
}

Options extreme_options(Random& random) {
  Options options;
  if (random.below(3) > 0) options.coarse_faces = 4 + random.below(random.below(2) == 0 ? 20 : 300);
  options.method = std::max(0, random.below(10) - 4);
  if (random.below(2) == 0) options.flatten = random.below(5);
  if (random.below(4) == 0) options.energy = BELTRAMI_ENERGY_SYMMETRIC_ARAP;
  if (random.below(3) == 0) options.injectivity = random.below(3);
  options.delaunay = random.below(6) == 0;
  options.unit_square = random.below(4) == 0;
  options.float32 = random.below(3) == 0;
  options.refine = random.below(8) == 0;
  return options;
}

/// Whether the mode promises an injective map in the numbers that were asked for.
bool promises(const Options& options) {
  if (options.injectivity == BELTRAMI_INJECTIVITY_LOCAL) return false;
  if (options.method == BELTRAMI_METHOD_TUTTE) return !options.float32;
  return options.method == BELTRAMI_METHOD_BELTRAMI && options.flatten != BELTRAMI_FLATTEN_BFF &&
         options.flatten != BELTRAMI_FLATTEN_FLIM;
}

class ExtremeDisks : public testing::TestWithParam<int> {};

TEST_P(ExtremeDisks, EndWithAMapAndATruthfulStatus) {
  for (int seed = 10 * GetParam(); seed < 10 * GetParam() + 10; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(static_cast<std::uint64_t>(seed) + 2000000);
    TriangleList mesh = extreme_disk(seed, random);
    const Options options = extreme_options(random);
    Normalisation frame;
    try {
      frame = normalise(mesh.positions, mesh.faces);
    } catch (const Error&) {
      continue;  // no area is left
    }
    const DiskMesh disk = disks::disk(std::move(mesh));
    const std::atomic<bool> cancelled{false};
    const Flattening result = flatten(disk, frame, options, {}, cancelled);
    for (const Vec2& w : result.uvs) ASSERT_TRUE(w.allFinite());
    const auto& faces = result.faces.empty() ? disk.faces : result.faces;
    const bool injective = certify(faces, disk.boundary, result.uvs, 1).injective();
    EXPECT_EQ(injective, result.certificate.injective());
    // Beyond the range of the type a map is not what was asked for even where it is injective.
    EXPECT_TRUE(injective || result.status >= BELTRAMI_NOT_INJECTIVE);
    const bool beyond_floats =
        options.float32 && !options.unit_square && std::abs(frame.exponent) > 90;
    EXPECT_TRUE(injective || beyond_floats || !promises(options));
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, ExtremeDisks, testing::Range(0, 30));

}  // namespace
}  // namespace beltrami
