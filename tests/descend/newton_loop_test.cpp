// When a run of Newton steps ends, by what its steps say of themselves.
#include "descend/newton_loop.h"

#include <gtest/gtest.h>

#include <vector>

#include "base/work.h"

namespace beltrami {
namespace {

constexpr double kTolerance = 1e-4;

/// How many of these steps, none of the proxy, are taken from energy 4.
int steps_taken(const std::vector<NewtonStep>& steps) {
  const NewtonRun run{.tolerance = kTolerance,
                      .max_iterations = static_cast<int>(steps.size()),
                      .proxy_steps = 0,
                      .comparable = [](double) { return 1.0; }};
  std::vector<double> energies{4};
  std::size_t next = 0;
  run_newton(
      run, Work(1), energies, [&](bool, double) { return steps[next++]; },
      [](const NewtonStep&, double) { return false; });
  return static_cast<int>(next);
}

NewtonStep step(double length, double gain, double predicted) {
  return {.length = length, .energy = 4 - gain, .gain = gain, .predicted = predicted};
}

TEST(NewtonLoop, EndsWhereAFullStepGainsLittle) {
  const NewtonStep good = step(1, 0.1, 0.2), little = step(1, 0.5 * kTolerance, kTolerance);
  EXPECT_EQ(steps_taken({good, little, good}), 2);
}

TEST(NewtonLoop, GoesOnAfterAShortStep) {
  const NewtonStep good = step(1, 0.1, 0.2), brief = step(0.1, 0.5 * kTolerance, kTolerance);
  EXPECT_EQ(steps_taken({brief, good, good}), 3);
}

TEST(NewtonLoop, GoesOnWhereAStepLeapsOverAValley) {
  const NewtonStep good = step(1, 0.1, 0.2), leap = step(1, 0.5 * kTolerance, 100 * kTolerance);
  EXPECT_EQ(steps_taken({good, leap, good, good}), 4);
}

TEST(NewtonLoop, EndsInPatienceWhereEveryStepLeaps) {
  const NewtonStep leap = step(1, 0.5 * kTolerance, 100 * kTolerance);
  EXPECT_EQ(steps_taken(std::vector<NewtonStep>(20, leap)), newton::kPatience);
}

}  // namespace
}  // namespace beltrami
