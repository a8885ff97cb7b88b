#include "fullspace/newton.h"

#include "distortion/symmetric_dirichlet.h"
#include "fullspace/newton_step.h"

namespace beltrami {
namespace {

/// Shorter steps say nothing about convergence: on hard models the step is tiny for a while and the
/// energy hardly falls, long before the minimum.
constexpr double kFullStep = 0.5;

/// The number of steps is not known beforehand; ordinary meshes take about twenty.
double guessed_progress(int iterations) { return iterations / (iterations + 12.0); }

}  // namespace

NewtonResult minimise_energy(const std::vector<Triangle>& faces,
                             const std::vector<RestTriangle>& rest,
                             const std::vector<bool>& fixed, std::vector<Vec2>& uvs,
                             const NewtonOptions& options, const Checkpoint& checkpoint) {
  NewtonStepper<SymmetricDirichlet> stepper(faces, rest, fixed, options.threads);
  NewtonResult result;
  result.energies.push_back(stepper.mean_energy(uvs));
  result.converged = stepper.free_count() == 0;
  while (!result.converged && result.iterations() < options.max_iterations) {
    checkpoint(guessed_progress(result.iterations()));
    const double before = result.energies.back();
    const NewtonStep step = stepper.step(uvs, before);
    if (step.length == 0) {
      // No representable decrease: at the minimum if little was predicted, stuck otherwise.
      result.converged = step.predicted <= options.tolerance * before;
      break;
    }
    result.energies.push_back(step.energy);
    result.converged = step.length >= kFullStep && before - step.energy <= options.tolerance * before;
  }
  return result;
}

}  // namespace beltrami
