#include "fullspace/newton.h"

#include <algorithm>

#include "fullspace/newton_step.h"

namespace beltrami {
namespace {

/// Shorter steps say nothing about convergence: on hard models the step is tiny for a while and the
/// energy hardly falls, long before the minimum.
constexpr double kFullStep = 0.5;

/// Unless there are many of them, and Newton's model sees little to gain either: energies that are
/// not smooth (symmetric ARAP at s1 = s2) creep towards their minimum in shortened steps.
constexpr int kPatience = 5;
constexpr double kNothing = 1e-3;  // share of the tolerance that is no gain, however short the step
constexpr double kLittleLeft = 0.05;  // predicted decrease, relative to the energy

/// Steps below this length are blocked by faces that are nearly singular.
constexpr double kBlockedStep = 0.02;

/// The number of steps is not known beforehand; ordinary meshes take about twelve.
double guessed_progress(int iterations) {
  return iterations / (iterations + 12.0);
}

template <class Density>
NewtonResult minimise(const std::vector<Triangle>& faces, const std::vector<RestTriangle>& rest,
                      const std::vector<bool>& fixed, std::vector<Vec2>& uvs,
                      const NewtonOptions& options, const Checkpoint& checkpoint) {
  NewtonStepper<Density> stepper(faces, rest, fixed, options.threads);
  NewtonResult result;
  result.energies.push_back(stepper.mean_energy(uvs));
  result.converged = stepper.free_count() == 0;
  int proxy_steps = options.proxy_steps;
  std::vector<Vec2> admitted;
  int little_gains = 0;
  while (!result.converged && result.iterations() < options.max_iterations) {
    if (options.out_of_time && options.out_of_time()) break;
    checkpoint(guessed_progress(result.iterations()));
    const double before = result.energies.back();
    const bool proxy = proxy_steps > 0;
    if (options.admissible) admitted = uvs;
    const NewtonStep step = proxy ? stepper.step_with(typename Density::Proxy{}, uvs, before)
                                  : stepper.step(uvs, before);
    if (step.length > 0 && options.admissible && !options.admissible(uvs)) {
      uvs.swap(admitted);
      result.refused = true;
      break;
    }
    if (step.length > 0) result.energies.push_back(step.energy);
    if (proxy) {
      proxy_steps = step.length > 0 ? proxy_steps - 1 : 0;
      continue;
    }
    if (step.length == 0) {
      // No representable decrease: at the minimum (or on a ridge) if little was predicted, stuck
      // otherwise.
      result.converged = step.predicted <= kLittleLeft * std::max(before, kLeastEnergy);
      break;
    }
    if (step.length < kBlockedStep) proxy_steps = options.proxy_steps;
    const double gain = (before - step.energy) / comparable_energy<Density>(before);
    const bool little = gain <= options.tolerance;
    little_gains = little && (step.length >= kBlockedStep || gain <= kNothing * options.tolerance)
                       ? little_gains + 1
                       : 0;
    const bool stalled = little_gains >= kPatience;
    const bool little_left = step.predicted <= kLittleLeft * std::max(before, kLeastEnergy);
    result.converged = (little && step.length >= kFullStep) || (stalled && little_left);
    if (stalled) break;
  }
  return result;
}

}  // namespace

NewtonResult minimise_energy(const std::vector<Triangle>& faces,
                             const std::vector<RestTriangle>& rest, const std::vector<bool>& fixed,
                             std::vector<Vec2>& uvs, const NewtonOptions& options,
                             const Checkpoint& checkpoint) {
  return with_density(options.energy, [&]<class Density>(Density) {
    return minimise<Density>(faces, rest, fixed, uvs, options, checkpoint);
  });
}

}  // namespace beltrami
