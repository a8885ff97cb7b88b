// The memory that a run takes against its estimate, measured from outside: of the native solver,
// and without sanitizers, whose own memory counts. CTest runs each test in a process of its own,
// whose peak is therefore the test's.
#include <malloc.h>

#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "abi/host.h"
#include "base/vectors.h"
#include "support/disks.h"
#include "support/meshes.h"

namespace beltrami {
namespace {

using namespace host;

double memory_of_process(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with(key + ":")) return 1024 * std::stod(line.substr(key.size() + 1));
  }
  return 0;
}

/// What the process grows by from `before` to its peak from here on.
class PeakFrom {
 public:
  explicit PeakFrom(double before) : before_(before) {
    malloc_trim(0);
    std::ofstream("/proc/self/clear_refs") << 5;  // the kernel's mark of the peak starts anew
  }
  double bytes() const { return memory_of_process("VmHWM") - before_; }

 private:
  double before_;
};

using Setting = std::pair<std::int32_t, int>;  // key and value of an option

class MemoryOfMode : public testing::TestWithParam<std::vector<Setting>> {};

TEST_P(MemoryOfMode, TakesNoMoreThanEstimated) {
  const meshes::TriangleList mesh = meshes::bumps(230, 230);
  malloc_trim(0);
  const double before = memory_of_process("VmRSS");
  const Context context = create();
  for (const auto& [key, value] : GetParam())
    set_option(context, key, static_cast<std::uint64_t>(value));
  ASSERT_EQ(set_mesh(context, mesh), BELTRAMI_OK);
  const auto estimated = static_cast<double>(estimate(context));
  const PeakFrom peak(before);
  ASSERT_GE(run(context), BELTRAMI_OK) << message(context);
  EXPECT_LE(peak.bytes(), estimated);
  EXPECT_GE(peak.bytes(), 0.3 * estimated) << "the estimate says nothing";
}

INSTANTIATE_TEST_SUITE_P(
    Modes, MemoryOfMode,
    testing::Values(std::vector<Setting>{{BELTRAMI_OPTION_FLATTEN, BELTRAMI_FLATTEN_DIRICHLET},
                                         {BELTRAMI_OPTION_THREADS, 2}},
                    std::vector<Setting>{{BELTRAMI_OPTION_FLATTEN, BELTRAMI_FLATTEN_GIF}},
                    std::vector<Setting>{{BELTRAMI_OPTION_METHOD, BELTRAMI_METHOD_CM},
                                         {BELTRAMI_OPTION_MAX_ITERATIONS, 1}}));

/// A run within the least limit, which has no room for what few meshes need.
struct LimitedRun {
  beltrami_status status;
  std::string message;
  double peak, limit;  ///< bytes
};

LimitedRun run_within_least_limit(const meshes::TriangleList& mesh) {
  malloc_trim(0);
  const double before = memory_of_process("VmRSS");
  const Context context = create();
  EXPECT_EQ(set_mesh(context, mesh), BELTRAMI_OK);
  set_option(context, BELTRAMI_OPTION_MEMORY_LIMIT, 1);
  const std::uint64_t limit = estimate(context);
  set_option(context, BELTRAMI_OPTION_MEMORY_LIMIT, limit);
  const PeakFrom peak(before);
  const beltrami_status status = run(context);
  return {status, message(context), peak.bytes(), static_cast<double>(limit)};
}

// In levels, of which the coarsest may need the room of a whole smaller disk.
TEST(MemoryOfLimitedRun, StaysWithinItsLimit) {
  const LimitedRun limited = run_within_least_limit(meshes::bumps(400, 400));
  ASSERT_GE(limited.status, BELTRAMI_OK) << limited.message;
  EXPECT_LE(limited.peak, limited.limit);
  // Half of it is for a level that needs a factor of its own, which this mesh has not.
  EXPECT_GE(limited.peak, 0.4 * limited.limit) << "the estimate says nothing";
}

// Noise, which no coarser level knows: what would take a factor of the whole does without it or
// ends for want of memory.
TEST(MemoryOfLimitedRun, StaysWithinItsLimitOnNoise) {
  for (const double height : {2.0, 4.0}) {
    disks::Random random(5);
    meshes::TriangleList mesh = meshes::grid(400, 400);
    for (Vec3& p : mesh.positions) p *= 400;
    for (Vec3& p : mesh.positions) p.z() = height * random.between(-1.7, 1.7);
    const LimitedRun limited = run_within_least_limit(mesh);
    if (height < 3) {
      EXPECT_EQ(limited.status, BELTRAMI_NOT_CONVERGED) << limited.message;
    } else {
      EXPECT_EQ(limited.status, BELTRAMI_E_OUT_OF_MEMORY);
      EXPECT_NE(limited.message.find("memory-limit"), std::string::npos) << limited.message;
    }
    EXPECT_LE(limited.peak, limited.limit) << height;
  }
}

}  // namespace
}  // namespace beltrami
