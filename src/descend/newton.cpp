#include "descend/newton.h"

#include "descend/newton_loop.h"
#include "descend/newton_step.h"

namespace beltrami {
namespace {

/// Relative gain of a step below which a map that is not admissible is not going to be.
constexpr double kSettled = 0.05;

template <class Density>
NewtonResult minimise(const std::vector<Triangle>& faces, const std::vector<RestTriangle>& rest,
                      const std::vector<bool>& fixed, std::vector<Vec2>& uvs,
                      const NewtonOptions& options, const Work& work) {
  NewtonStepper<Density> stepper(faces, rest, fixed, work);
  NewtonResult result;
  result.energies.push_back(stepper.mean_energy(uvs));
  if (options.contact) stepper.set_contact(*options.contact);
  if (options.slides != nullptr) stepper.set_slides(*options.slides);
  stepper.set_ranks(options.ranks);
  const auto judge = [&] {
    if (!options.admissible) return;
    result.refused = !options.admissible(uvs);
    if (!result.refused) result.admitted = uvs;
  };
  judge();
  // With contact no proxy: its long steps take no heed of parts that turn towards each other, which
  // then jam.
  const NewtonRun run = {.tolerance = options.tolerance,
                         .max_iterations = options.max_iterations,
                         .proxy_steps = options.contact ? 0 : options.proxy_steps,
                         .comparable = comparable_energy<Density>,
                         .smooth = Density::kSmooth,
                         .hopeless = from_dirichlet<Density>(options.hopeless)};
  const auto take_step = [&](bool proxy, double before) {
    if (options.contact) {
      stepper.fit_contact(uvs, to_dirichlet<Density>(before), comparable_energy<Density>(before));
    }
    const NewtonStep step = proxy ? stepper.step_with(typename Density::Proxy{}, uvs, before)
                                  : stepper.step(uvs, before);
    if (step.length > 0) judge();
    return step;
  };
  const auto give_up = [&](const NewtonStep& step, double before) {
    return result.refused && step.length >= newton::kFullStep &&
           step.gain <= kSettled * comparable_energy<Density>(before);
  };
  result.converged =
      stepper.free_count() == 0 || run_newton(run, work, result.energies, take_step, give_up);
  result.is_hopeless = !result.converged && result.iterations() >= newton::kHopefulSteps &&
                       result.energies.back() > run.hopeless;
  result.is_cut_short = !result.converged && (result.iterations() >= options.max_iterations ||
                                              result.is_hopeless || work.out_of_time());
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
