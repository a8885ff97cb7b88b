// Whole runs: injective, timed, cancellable, and the same whatever the threads, the unit and the
// order of the input.
#include "chart/flatten_disk.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numeric>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "base/interrupt.h"
#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "chart/flattening.h"
#include "descend/tutte.h"
#include "exact/certificate.h"
#include "mesh/disk_mesh.h"
#include "multilevel/chart_map.h"
#include "multilevel/options.h"
#include "support/disks.h"
#include "support/meshes.h"
#include "support/run.h"
#include "support/shared_data.h"

namespace beltrami {
namespace {

using disks::Random;
using disks::run;
using meshes::TriangleList;

ChartOptions method(Method which) {
  ChartOptions options;
  options.method = which;
  return options;
}

/// The method that this library is about, simplified to `coarse_faces`.
ChartOptions coarse_to_fine(std::int64_t coarse_faces, Flatten how = Flatten::kMetric) {
  ChartOptions options;
  options.coarse_faces = coarse_faces;
  options.flatten = how;
  return options;
}

double energy(const Flattening& result) {
  return result.distortion.symmetric_dirichlet;
}

void expect_injective(const Flattening& result, const std::string& where,
                      Outcome at_worst = Outcome::kOk) {
  EXPECT_LE(result.status, at_worst) << where;
  EXPECT_TRUE(result.certificate.injective()) << where;
  EXPECT_TRUE(std::isfinite(energy(result))) << where;
  EXPECT_GE(energy(result), 2 - 1e-12) << where;
  for (const Vec2& w : result.uvs) ASSERT_TRUE(w.allFinite()) << where;
}

// ---- Methods --------------------------------------------------------------------------------

TEST(Pipeline, IsInjectiveWithEveryMethodOnAGridAndACap) {
  for (const auto& mesh : {meshes::bumps(16, 16), meshes::cap(10, 30, 2.0)}) {
    for (const ChartOptions& options :
         {method(Method::kBeltrami), method(Method::kCm), method(Method::kTutte),
          coarse_to_fine(120), coarse_to_fine(120, Flatten::kDirichlet)}) {
      const Flattening result = run(mesh, options);
      expect_injective(result, "method " + std::to_string(static_cast<int>(options.method)) +
                                   " flatten " + std::to_string(static_cast<int>(options.flatten)) +
                                   " coarse " + std::to_string(options.coarse_faces));
      EXPECT_EQ(result.uvs.size(), mesh.positions.size());
      EXPECT_EQ(result.face_energies.size(), mesh.faces.size());
    }
  }
}

TEST(Pipeline, FlattensAFlatMeshIsometrically) {
  EXPECT_NEAR(energy(run(meshes::grid(12, 9), method(Method::kCm))), 2, 1e-3);
  EXPECT_NEAR(energy(run(meshes::grid(20, 20), coarse_to_fine(100))), 2, 1e-3);
}

TEST(Pipeline, ComesCloseToTheFullSpaceMinimumFromACoarseMesh) {
  const TriangleList mesh = meshes::bumps(40, 40);
  const double cm = energy(run(mesh, method(Method::kCm)));
  EXPECT_LE(energy(run(mesh, coarse_to_fine(600))), 1.01 * cm);
  EXPECT_LE(energy(run(mesh, coarse_to_fine(600, Flatten::kDirichlet))), 1.06 * cm);
  EXPECT_GT(energy(run(mesh, method(Method::kTutte))), 1.01 * cm);
}

TEST(Pipeline, RunsFullSpaceOnTheMeshItselfBelowTheCutOff) {
  const Flattening result = run(meshes::bumps(10, 10));
  EXPECT_EQ(result.statistics.coarse_faces, 200);
  const Flattening coarse = run(meshes::bumps(20, 20), coarse_to_fine(200));
  EXPECT_LE(coarse.statistics.coarse_faces, 200);
  EXPECT_GT(coarse.statistics.coarse_faces, 50);
}

TEST(Pipeline, SaysSoWhereItDidNotConverge) {
  ChartOptions options = method(Method::kCm);
  options.max_iterations = 1;
  const Flattening result = run(meshes::cap(10, 30, 2.5), options);
  EXPECT_EQ(result.status, Outcome::kNotConverged);
  EXPECT_TRUE(result.certificate.injective());
}

// ---- Stages, progress, cancel ---------------------------------------------------------------

std::vector<std::string> stage_names(const Flattening& result) {
  std::vector<std::string> names;
  for (const StageStatistics& stage : result.statistics.stages) names.emplace_back(stage.name);
  return names;
}

bool in_this_order(const std::vector<std::string>& names, const std::vector<std::string>& wanted) {
  auto from = names.begin();
  for (const std::string& name : wanted) {
    from = std::find(from, names.end(), name);
    if (from == names.end()) return false;
    ++from;
  }
  return true;
}

TEST(Pipeline, NamesItsStagesInTheOrderInWhichTheyRan) {
  const TriangleList mesh = meshes::bumps(20, 20);
  EXPECT_TRUE(
      in_this_order(stage_names(run(mesh, coarse_to_fine(200))),
                    {"simplify", "coarse", "prolong", "flatten", "repair", "polish", "certify"}));
  EXPECT_TRUE(in_this_order(stage_names(run(mesh, coarse_to_fine(200, Flatten::kDirichlet))),
                            {"simplify", "coarse", "prolong", "flatten", "repair", "certify"}));
  EXPECT_TRUE(in_this_order(stage_names(run(mesh, method(Method::kCm))), {"cm", "certify"}));
  EXPECT_TRUE(in_this_order(stage_names(run(mesh, method(Method::kTutte))), {"tutte", "certify"}));
}

TEST(Pipeline, TimesItsStagesWithinTheWholeRun) {
  const Flattening result = run(meshes::bumps(20, 20), coarse_to_fine(200));
  double sum = 0;
  for (const StageStatistics& stage : result.statistics.stages) {
    EXPECT_GE(stage.seconds, 0) << stage.name;
    EXPECT_GE(stage.cpu_seconds, 0) << stage.name;
    sum += stage.seconds;
  }
  EXPECT_GT(sum, 0);
  EXPECT_LE(sum, result.seconds + 1e-6);
}

TEST(Pipeline, ReportsProgressThatRisesFromZeroToOneOnTheCallingThread) {
  for (const ChartOptions& options :
       {method(Method::kCm), method(Method::kTutte), coarse_to_fine(200),
        coarse_to_fine(200, Flatten::kDirichlet)}) {
    std::vector<double> fractions;
    int elsewhere = 0, unnamed = 0;
    const auto caller = std::this_thread::get_id();
    const Progress watch = [&](double fraction, const char* stage) {
      fractions.push_back(fraction);
      elsewhere += std::this_thread::get_id() != caller;
      unnamed += stage == nullptr || std::strlen(stage) == 0;
      return false;
    };
    run(meshes::bumps(20, 20), options, Work({.threads = 2}, watch));
    ASSERT_FALSE(fractions.empty());
    EXPECT_EQ(fractions.front(), 0);
    EXPECT_EQ(fractions.back(), 1);
    EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
    EXPECT_EQ(elsewhere, 0);
    EXPECT_EQ(unnamed, 0);
  }
}

/// Whether a run that is cancelled at callback number `last` ends so.
bool is_cancelled_at(int last, const TriangleList& mesh, const ChartOptions& options) {
  int calls = 0;
  try {
    run(mesh, options, Work({}, [&](double, const char*) { return ++calls == last; }));
  } catch (const Cancelled&) {
    EXPECT_EQ(calls, last) << "called again after it was cancelled";
    return true;
  }
  return false;
}

TEST(Pipeline, IsCancelledAtEveryCallbackOfEveryStage) {
  const TriangleList mesh = meshes::bumps(10, 10);
  for (const ChartOptions& options :
       {method(Method::kCm), method(Method::kTutte), coarse_to_fine(80),
        coarse_to_fine(80, Flatten::kDirichlet)}) {
    int callbacks = 0;
    run(mesh, options, Work({}, [&](double, const char*) {
          ++callbacks;
          return false;
        }));
    EXPECT_GE(callbacks, 4);
    for (int k = 1; k <= callbacks; ++k) {
      ASSERT_TRUE(is_cancelled_at(k, mesh, options)) << k << " of " << callbacks;
    }
  }
}

TEST(Pipeline, IsCancelledByTheFlagWithoutAProgressFunction) {
  TriangleList mesh = meshes::bumps(10, 10);
  const Normalisation frame = normalise(mesh.positions, mesh.faces, Work(1));
  const DiskMesh disk = disks::disk(mesh);
  const std::atomic<bool> cancelled{true};
  const InterruptScope interruptible(&cancelled);
  EXPECT_THROW(flatten(disk, frame, {}, Work()), Cancelled);
}

// ---- Invariance -----------------------------------------------------------------------------

TEST(Pipeline, HasTheSameBitsOnTwoThreads) {
  const TriangleList mesh = meshes::bumps(75, 75);
  for (const Flatten how : {Flatten::kMetric, Flatten::kDirichlet}) {
    const ChartOptions options = coarse_to_fine(2000, how);
    const Flattening one = run(mesh, options);
    const Flattening two = run(mesh, options, Work(2));
    EXPECT_EQ(one.uvs, two.uvs);
    EXPECT_EQ(one.face_energies, two.face_energies);
    EXPECT_EQ(energy(one), energy(two));
  }
}

TEST(Pipeline, HasTheSameBitsInASecondRun) {
  const TriangleList mesh = meshes::bumps(20, 20);
  EXPECT_EQ(run(mesh, coarse_to_fine(200)).uvs, run(mesh, coarse_to_fine(200)).uvs);
}

TriangleList transformed(TriangleList mesh, double scale, const Vec3& offset) {
  for (Vec3& p : mesh.positions) p = scale * p + offset;
  return mesh;
}

TEST(Pipeline, HasTheSameBitsInAnyUnitThatIsAPowerOfTwo) {
  const TriangleList mesh = meshes::bumps(20, 20);
  const Flattening plain = run(mesh, coarse_to_fine(200));
  for (const int exponent : {-20, -1, 20}) {
    const double unit = std::ldexp(1.0, exponent);
    const Flattening scaled = run(transformed(mesh, unit, Vec3::Zero()), coarse_to_fine(200));
    for (std::size_t v = 0; v < plain.uvs.size(); ++v) {
      ASSERT_EQ(scaled.uvs[v], Vec2(unit * plain.uvs[v])) << exponent;
    }
    EXPECT_EQ(energy(scaled), energy(plain));
  }
}

TEST(Pipeline, HasTheSameEnergyAtAnyScaleAndOffset) {
  const TriangleList mesh = meshes::bumps(20, 20);
  const double plain = energy(run(mesh, coarse_to_fine(200)));
  for (const double scale : {1e-6, 1.0, 1e6}) {
    for (const double offset : {0.0, 1e4}) {
      const Vec3 shift = scale * offset * Vec3(1, -2, 0.5);
      const Flattening result = run(transformed(mesh, scale, shift), coarse_to_fine(200));
      EXPECT_NEAR(energy(result), plain, 1e-3 * plain) << scale << ' ' << offset;
      EXPECT_TRUE(result.certificate.injective()) << scale << ' ' << offset;
    }
  }
}

TriangleList shuffled(const TriangleList& mesh, std::uint64_t seed) {
  Random random(seed);
  const auto permutation = [&](std::size_t count) {
    std::vector<Index> order(count);
    std::iota(order.begin(), order.end(), 0);
    for (std::size_t i = count; i > 1; --i) {
      std::swap(order[i - 1], order[static_cast<std::size_t>(random.below(static_cast<int>(i)))]);
    }
    return order;
  };
  const auto new_vertex = permutation(mesh.positions.size());
  TriangleList result = mesh;
  for (std::size_t v = 0; v < new_vertex.size(); ++v) {
    result.positions[new_vertex[v]] = mesh.positions[v];
  }
  const auto new_face = permutation(mesh.faces.size());
  for (std::size_t f = 0; f < new_face.size(); ++f) {
    Triangle t = mesh.faces[f];
    for (Index& v : t) v = new_vertex[v];
    std::rotate(t.begin(), t.begin() + random.below(3), t.end());
    result.faces[new_face[f]] = t;
  }
  return result;
}

TEST(Pipeline, DoesNotDependOnTheOrderOfFacesAndVertices) {
  const TriangleList mesh = meshes::bumps(20, 20);
  const double cm = energy(run(mesh, method(Method::kCm)));
  const double metric = energy(run(mesh, coarse_to_fine(300)));
  for (const std::uint64_t seed : {1, 2, 3}) {
    const TriangleList other = shuffled(mesh, seed);
    EXPECT_NEAR(energy(run(other, method(Method::kCm))), cm, 1e-3 * cm) << seed;
    // The simplifier breaks its ties another way.
    EXPECT_NEAR(energy(run(other, coarse_to_fine(300))), metric, 1e-2 * metric) << seed;
  }
}

TEST(Pipeline, FitsTheUnitSquareOnRequest) {
  for (const double scale : {1e-6, 1.0, 3e5}) {
    ChartOptions options = coarse_to_fine(200);
    options.unit_square = true;
    const Flattening result = run(transformed(meshes::bumps(20, 20), scale, Vec3::Zero()), options);
    double greatest = 0;
    for (const Vec2& w : result.uvs) {
      EXPECT_GE(w.minCoeff(), 0);
      EXPECT_LE(w.maxCoeff(), 1);
      greatest = std::max(greatest, w.maxCoeff());
    }
    EXPECT_GE(greatest, 1 - 1e-12);
    EXPECT_TRUE(result.certificate.injective());
  }
}

// ---- Difficult and tiny disks ---------------------------------------------------------------

struct NamedMesh {
  std::string name;
  TriangleList mesh;
};

std::vector<NamedMesh> tiny_disks() {
  return {{"triangle", meshes::triangle()},
          {"quad", meshes::quad()},
          {"fan of 3, a boundary of 3", meshes::fan(3)},
          {"fan of 12", meshes::fan(12)},
          {"strip without interior vertices", meshes::strip(10)}};
}

std::vector<NamedMesh> difficult_disks() {
  return {{"long strip", meshes::strip(300)},
          {"dumbbell", disks::dumbbell(6)},
          {"spike", disks::spike(10)},
          {"slivers", disks::slivers(10, 10)},
          {"slit", disks::slit(5)},
          {"degenerate faces", disks::degenerate_faces(10)},
          {"closed but for one face", disks::punctured(3)}};
}

TEST(Pipeline, FlattensTinyDisksIsometrically) {
  for (const auto& [name, mesh] : tiny_disks()) {
    for (const ChartOptions& options : {ChartOptions{}, method(Method::kCm), coarse_to_fine(1)}) {
      const Flattening result = run(mesh, options);
      expect_injective(result, name);
      EXPECT_NEAR(energy(result), 2, 1e-3) << name;
    }
    // These two force the boundary: onto a circle, and onto the edges of a coarser polygon.
    expect_injective(run(mesh, method(Method::kTutte)), name);
    expect_injective(run(mesh, coarse_to_fine(1, Flatten::kDirichlet)), name);
  }
}

TEST(Pipeline, IsInjectiveOnDifficultDisks) {
  for (const auto& [name, mesh] : difficult_disks()) {
    expect_injective(run(mesh), name);
    // At energies of 180 the polish may end before it is done, and says so.
    expect_injective(run(mesh, coarse_to_fine(60)), name + ", coarse to fine",
                     Outcome::kNotConverged);
    expect_injective(run(mesh, coarse_to_fine(60, Flatten::kDirichlet)), name + ", harmonic");
  }
}

TEST(Pipeline, StartsFromCoarserMeshesWhereTutteIsLostInRounding) {
  // Each ring of the tube is smaller by a factor in Tutte's embedding: long before the last one
  // doubles cannot tell its vertices apart.
  for (const Index sectors : {4, 7}) {
    const TriangleList mesh = disks::tube(400, sectors, 0.5);
    const DiskMesh disk = disks::disk(mesh);
    ASSERT_GT(non_positive_faces(disk.faces, tutte_embedding(disk, Work(1)), Work(1)).size(), 0u);
    expect_injective(run(mesh), "tube of " + std::to_string(sectors));
    // So far from a good map the polish may end before it is done, and says so.
    const Flattening coarse = run(mesh, coarse_to_fine(800));
    EXPECT_TRUE(coarse.certificate.injective()) << "coarse tube of " << sectors;
    EXPECT_LE(coarse.status, Outcome::kNotConverged) << "coarse tube of " << sectors;
    EXPECT_LT(energy(coarse), 300) << "coarse tube of " << sectors;
  }
}

TEST(Pipeline, LeavesOutFacesWithoutAreaAndHasFiniteEnergies) {
  TriangleList mesh = disks::degenerate_faces(10);
  std::int64_t without_area = 0;
  for (const auto& [a, b, c] : mesh.faces) {
    without_area += triangle_area(mesh.positions[a], mesh.positions[b], mesh.positions[c]) == 0;
  }
  ASSERT_GE(without_area, 2);
  const Flattening result = run(mesh);
  EXPECT_GE(result.distortion.left_out, without_area);
  EXPECT_TRUE(std::isfinite(result.distortion.max));
  EXPECT_LT(energy(result), 20);
}

// ---- Scanned models, where they are at hand -------------------------------------------------

/// The energy at which the authors' own full-space code ends.
double reference_energy(const std::string& name) {
  std::ifstream file(shared_data::folder() / "reference.json");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const std::size_t entry = text.find('"' + name + '"');
  if (entry == std::string::npos) return 0;
  return std::stod(text.substr(text.find(':', text.find("\"E\"", entry)) + 1));
}

class Scan : public testing::TestWithParam<const char*> {};

TEST_P(Scan, IsFlattenedInjectivelyCloseToTheReferenceEnergy) {
  if (!std::filesystem::exists(shared_data::folder())) GTEST_SKIP() << "the mesh data are not here";
  const std::string name = GetParam();
  const TriangleList mesh =
      shared_data::read_obj(shared_data::folder() / "disks" / (name + ".obj"));
  ASSERT_FALSE(mesh.faces.empty());
  const double reference = reference_energy(name);
  ASSERT_GT(reference, 2);
  const Flattening result = run(mesh);
  EXPECT_TRUE(result.certificate.injective());
  EXPECT_LE(energy(result), 1.05 * reference);
}

INSTANTIATE_TEST_SUITE_P(Disks, Scan,
                         testing::Values("gargoyle_i_f10000", "rgb_dragon_o_f8000",
                                         "vase_lion_o_f20000"),
                         [](const auto& tested) { return std::string(tested.param); });

}  // namespace
}  // namespace beltrami
