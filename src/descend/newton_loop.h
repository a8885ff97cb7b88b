// The run of projected Newton, whatever the steps move: which of them take the proxy's model, and
// when it ends.
#pragma once

#include <limits>
#include <vector>

#include "base/work.h"

namespace beltrami {

/// What the steps of every run go by.
namespace newton {

inline constexpr double kNoGain = 1e-14;  ///< relative predicted decrease within the roundoff
/// Of the diagonal: what nearly costs nothing gets it, growing a hundredfold up to the largest one
/// while the system is not definite.
inline constexpr double kShift = 1e-13, kLargestShift = 1e-3;

/// Of SLIM at the start, and again whenever a step is blocked by nearly singular faces: they save a
/// third of all steps on ordinary meshes, and on hard ones make the difference between 75 steps and
/// none that helps. A full one with little gain is the last.
inline constexpr int kProxySteps = 5;
/// Steps below this length are blocked by faces that are nearly singular.
inline constexpr double kBlockedStep = 0.02;
/// Shorter steps say nothing about convergence: on hard models the step is tiny for a while and the
/// energy hardly falls, long before the minimum.
inline constexpr double kFullStep = 0.5;
/// Nor does the gain of a step that leaps over a narrow valley, if the model has promised more than
/// so many times the tolerance.
inline constexpr double kLeap = 10;
/// Unless there are many of them, and Newton's model sees little to gain either: energies that are
/// not smooth (symmetric ARAP at s1 = s2) creep towards their minimum in shortened steps.
inline constexpr int kPatience = 5;
inline constexpr double kNothing = 1e-3;  ///< share of the tolerance that is no gain at any length
inline constexpr double kLittleLeft = 0.05;  ///< predicted decrease, relative to the energy, then
/// A run that has not got below the energy where it has hope after so many steps is not going to,
/// or crawls: of 1,240 starts above 1e3, on 176 files, 95% are below it then, most after one step.
inline constexpr int kHopefulSteps = 25;

}  // namespace newton

/// What a step did.
struct NewtonStep {
  double length = 0;     ///< in Newton steps, over 1 if doubled; 0: no representable decrease
  double energy = 0;     ///< mean energy after it
  double gain = 0;       ///< what it took from the objective: the mean energy and all barriers
  double predicted = 0;  ///< -gradient . direction: twice the decrease of the quadratic model;
                         ///< infinite where there is no telling
};

/// How a run goes and when it ends.
struct NewtonRun {
  double tolerance = 0;    ///< relative gain of a step of at least 1/2 that ends it
  int max_iterations = 0;  ///< steps that move anything
  int proxy_steps = newton::kProxySteps;
  double (*comparable)(double energy) = nullptr;  ///< what gains at an energy are relative to
  bool smooth = true;  ///< the energy: of another one the model knows less
  /// Mean energy above which a run ends after kHopefulSteps.
  double hopeless = std::numeric_limits<double>::infinity();
  /// Whether steps of the proxy and blocked ones that gain little count towards the patience as
  /// well, which then ends the run as converged, whatever the model still promises.
  bool impatient = false;
};

/// Whether a Newton step would gain less than so many times the tolerance by its own model.
inline bool is_stationary(const NewtonStep& step, double energy, const NewtonRun& run,
                          double times = 1) {
  const double share = run.smooth ? times * run.tolerance : newton::kLittleLeft;
  return 0.5 * step.predicted <= share * run.comparable(energy);
}

/// Takes steps until one gains next to nothing, no step helps, or the time is up, and returns
/// whether that is at a minimum. `step(proxy, energy)` takes one from where the last one ended, at
/// this mean energy, by the model of the density or of its proxy. `give_up(step, energy)` is asked
/// after a step of the former from this energy. `energies` begins with the energy of the start, and
/// gets that after each step.
template <class Step, class GiveUp>
bool run_newton(const NewtonRun& run, const Work& work, std::vector<double>& energies,
                const Step& step, const GiveUp& give_up) {
  int proxy_steps = run.proxy_steps, little_gains = 0;
  for (;;) {
    const int done = static_cast<int>(energies.size()) - 1;
    if (done >= run.max_iterations || work.out_of_time()) return false;
    work.report(done / (done + 12.0));  // their number is not known; ordinary meshes take twelve
    const double before = energies.back();
    if (done >= newton::kHopefulSteps && before > run.hopeless) return false;
    const bool proxy = proxy_steps > 0;
    const NewtonStep made = step(proxy, before);
    if (made.length > 0) energies.push_back(made.energy);
    if (proxy) {
      const bool helps =
          made.length < newton::kFullStep || made.gain > run.tolerance * run.comparable(before);
      proxy_steps = made.length > 0 && helps ? proxy_steps - 1 : 0;
      if (!run.impatient) continue;
    } else {
      // No representable decrease: at the minimum (or on a ridge) if little was predicted, stuck
      // otherwise.
      if (!(made.length > 0)) return is_stationary(made, before, run);
      if (made.length < newton::kBlockedStep) proxy_steps = run.proxy_steps;
      if (give_up(made, before)) return false;
    }
    const double enough = run.tolerance * run.comparable(before);
    const bool little = made.gain <= enough;
    const bool full = !proxy && made.length >= newton::kFullStep;
    if (little && full && is_stationary(made, before, run, newton::kLeap)) return true;
    const bool counts = run.impatient || made.length >= newton::kBlockedStep ||
                        made.gain <= newton::kNothing * enough;
    little_gains = little && counts ? little_gains + 1 : 0;
    if (little_gains >= newton::kPatience) {
      return run.impatient || is_stationary(made, before, run);
    }
  }
}

}  // namespace beltrami
