#include "descend/newton.h"

#include <algorithm>

#include "descend/newton_step.h"

namespace beltrami {
namespace {

/// Shorter steps say nothing about convergence: on hard models the step is tiny for a while and the
/// energy hardly falls, long before the minimum.
constexpr double kFullStep = 0.5;

/// Unless there are many of them, and Newton's model sees little to gain either: energies that are
/// not smooth (symmetric ARAP at s1 = s2) creep towards their minimum in shortened steps.
constexpr int kPatience = 5;
constexpr double kNothing = 1e-3;  // share of the tolerance that is no gain, however short the step
constexpr double kLittleLeft = 0.05;  // predicted decrease, relative to the energy, then

/// Whether a Newton step would gain less than the tolerance by its own model; of an energy that is
/// not smooth the model knows less than that.
template <class Density>
bool is_stationary(const NewtonStep& step, double energy, double tolerance) {
  const double share = Density::kSmooth ? tolerance : kLittleLeft;
  return 0.5 * step.predicted <= share * comparable_energy<Density>(energy);
}

/// Relative gain of a step below which a map that is not admissible is not going to be.
constexpr double kSettled = 0.05;

/// Steps below this length are blocked by faces that are nearly singular.
constexpr double kBlockedStep = 0.02;

/// The number of steps is not known beforehand; ordinary meshes take about twelve.
double guessed_progress(int iterations) {
  return iterations / (iterations + 12.0);
}

template <class Density>
NewtonResult minimise(const std::vector<Triangle>& faces, const std::vector<RestTriangle>& rest,
                      const std::vector<bool>& fixed, std::vector<Vec2>& uvs,
                      const NewtonOptions& options, const Work& work) {
  NewtonStepper<Density> stepper(faces, rest, fixed, work);
  NewtonResult result;
  result.energies.push_back(stepper.mean_energy(uvs));
  result.converged = stepper.free_count() == 0;
  if (options.contact) stepper.set_contact(*options.contact);
  // Their long steps take no heed of parts that turn towards each other, which then jam.
  const int all_proxy_steps = options.contact ? 0 : options.proxy_steps;
  int proxy_steps = all_proxy_steps;
  int little_gains = 0;
  const auto judge = [&] {
    if (!options.admissible) return;
    result.refused = !options.admissible(uvs);
    if (!result.refused) result.admitted = uvs;
  };
  judge();
  while (!result.converged && result.iterations() < options.max_iterations) {
    if (work.out_of_time()) break;
    work.report(guessed_progress(result.iterations()));
    const double before = result.energies.back();
    const bool proxy = proxy_steps > 0;
    if (options.contact) stepper.fit_contact(uvs, comparable_energy<Density>(before));
    const NewtonStep step = proxy ? stepper.step_with(typename Density::Proxy{}, uvs, before)
                                  : stepper.step(uvs, before);
    if (step.length > 0) {
      result.energies.push_back(step.energy);
      judge();
    }
    if (proxy) {
      proxy_steps = step.length > 0 ? proxy_steps - 1 : 0;
      continue;
    }
    if (!(step.length > 0)) {
      // No representable decrease: at the minimum (or on a ridge) if little was predicted, stuck
      // otherwise.
      result.converged = is_stationary<Density>(step, before, options.tolerance);
      break;
    }
    if (step.length < kBlockedStep) proxy_steps = all_proxy_steps;
    const double gain = step.gain / comparable_energy<Density>(before);
    if (result.refused && step.length >= kFullStep && gain <= kSettled) break;
    const bool little = gain <= options.tolerance;
    little_gains = little && (step.length >= kBlockedStep || gain <= kNothing * options.tolerance)
                       ? little_gains + 1
                       : 0;
    const bool stalled = little_gains >= kPatience;
    result.converged = (little && step.length >= kFullStep) ||
                       (stalled && is_stationary<Density>(step, before, options.tolerance));
    if (stalled) break;
  }
  if (!result.refused) result.admitted.clear();
  return result;
}

}  // namespace

NewtonResult minimise_energy(const std::vector<Triangle>& faces,
                             const std::vector<RestTriangle>& rest, const std::vector<bool>& fixed,
                             std::vector<Vec2>& uvs, const NewtonOptions& options,
                             const Work& work) {
  return with_density(options.energy, [&]<class Density>(Density) {
    return minimise<Density>(faces, rest, fixed, uvs, options, work);
  });
}

}  // namespace beltrami
