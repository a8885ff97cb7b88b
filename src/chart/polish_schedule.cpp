// What is done                  with the factor       how often
// ----------------------------  --------------------  ------------------------------------------
// sweeps over the vertices      -                     two at the start, where the map comes rough,
//                                                     or once much holds it up; from then on
//                                                     one after each step
// one step of L-BFGS            of the flattening     once, and only if it is not held up; on the
//                                                     finest of several levels up to 4 steps, with
//                                                     which it mostly ends
// L-BFGS until it is stationary fitted to the map     rounds, to 30 steps in all, 8 on that level,
//   or held up                  where it has changed  16 below it, 20 after hard ones, while a
//                                                     round gains a thousandth of the energy or so
// Newton steps                  of their own          where much is left to gain: up to 10
// cleaning of outliers          -                     after each that is held up, and at the end
//   or of regions                                     if a step came since
//
// Held up: nearly singular faces would shorten the steps. Patches around these are optimised then,
// or whole regions where they are many, each of which a patch would leave to its neighbours.
// When the time is up, what is left of the rounds and the Newton steps is left out.
#include "chart/polish_schedule.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "base/parallel.h"
#include "chart/descent.h"
#include "chart/memory_estimate.h"
#include "descend/line_search.h"
#include "descend/newton.h"
#include "descend/polish.h"
#include "descend/tutte.h"
#include "descend/vertex_sweep.h"
#include "energy/energy.h"
#include "flatten/laplacian.h"
#include "flatten/metric.h"
#include "mesh/boundary.h"
#include "mesh/disk_mesh.h"
#include "repair/outliers.h"
#include "repair/regions.h"

namespace beltrami {
namespace {

constexpr double kTolerance = 3e-4;  // relative decrease: leaves the energy 0.1% too high
constexpr int kMostSteps = 30, kLongSteps = 20, kMiddlingSteps = 16;
constexpr int kSweeps = 2;              // of a map that is rough; one after each step
constexpr double kShortestSwept = 0.1;  // a first step: what holds up shorter ones is cleared
constexpr double kMuchLeft = 1e-2;  // predicted relative decrease that is then worth Newton steps
constexpr int kNewtonSteps = 10;
constexpr double kNothingLost = 1.002;     // times the distortion on a coarser mesh
constexpr double kNewtonTolerance = 1e-3;  // relative decrease
constexpr double kAsFitted = 2e-3;         // relative decrease up to which a factor is as good

/// With more faces in the way, in a mesh that is large or not, patches hold each other up, and
/// regions around the worst of them are relaxed instead.
constexpr double kManyOf = 1e-4, kMany = 10;
constexpr Index kLeastFaces = 20'000;  // of such a mesh: on smaller ones a region is half of it
constexpr double kMostRelaxed = 1e-2;  // of the faces
/// With more the whole map is rough, and is swept.
constexpr double kRoughOf = 1e-3;

/// What a length of the polish means.
struct Bounds {
  double enough;       ///< predicted relative decrease at which it ends
  double little_gain;  ///< a round that ends blocked is the last one where it has gained no more
  int most_steps;
  double stationary;  ///< predicted relative decrease that is none
  double at_rest;     ///< the same after a step that gained next to nothing
  bool newton;        ///< may end with Newton steps
  bool in_haste;  ///< one factor will do, where no distortion has come on since the coarser mesh
  bool rough;     ///< comes rough, and is swept at once: else where much holds it up
};

Bounds bounds_of(PolishLength length) {
  switch (length) {
    case PolishLength::kShort:
      return {4e-4, 1e-4, 8, 5e-4, 1e-4, false, true, false};
    case PolishLength::kMiddling:
      return {1e-4, 3e-4, kMiddlingSteps, 3e-4, 1e-4, false, false, true};
    case PolishLength::kLong:
      return {1e-4, 2e-3, kLongSteps, 1e-3, 1e-3, false, false, true};
    default:
      return {0, 1e-3, kMostSteps, 1e-4, 1e-4, true, false, true};
  }
}

/// What all steps have in common.
struct Setting {
  const FineProblem& fine;
  const BoundaryContact* contact;  ///< fitted to the map, or null
  const ChartOptions& options;
  const Work& work;
  double area;  ///< of the surface
  Bounds bounds;
  StiffnessInverse& inverse;

  double comparable(double energy) const { return comparable_energy(options.energy, energy); }
};

/// How far it got.
struct State {
  std::vector<Vec2> uvs;
  int iterations = 0;
  std::int64_t cleaned_patches = 0;
  bool swept = false;      ///< and so is what each step makes rough, from then on
  bool clean = true;       ///< no step since the last cleaning; it comes mended
  PolishResult last = {};  ///< of the last steps
  double fitted_at = std::numeric_limits<double>::infinity();  ///< the energy there
  bool converged = false;
};

double share(int steps) {
  return static_cast<double>(steps) / kMostSteps;
}

void clean(const Setting& setting, const std::vector<Index>& also, State& state) {
  state.cleaned_patches +=
      clean_outliers(setting.options.energy, *setting.fine.mesh, setting.fine.rest, state.uvs, also,
                     setting.work.part(share(state.iterations), share(state.iterations)));
  state.clean = true;
}

std::vector<Index> faces_of(const std::vector<SingularStep>& steps) {
  std::vector<Index> faces;
  for (const SingularStep& s : steps) faces.push_back(s.face);
  return faces;
}

/// One sweep, after so many steps of the polish.
void smooth(const Setting& setting, int iterations, std::vector<Vec2>& uvs) {
  sweep_vertices(setting.options.energy, *setting.fine.mesh, setting.fine.rest, uvs,
                 setting.work.part(share(iterations), share(iterations)));
}

/// Takes out what is rough in the map.
void sweep(const Setting& setting, State& state) {
  for (int i = 0; i < kSweeps; ++i) smooth(setting, state.iterations, state.uvs);
  state.swept = true;
  state.clean = false;
  if (!state.last.energies.empty()) {
    state.last.energies.back() = mean_energy(setting.options.energy, setting.fine.mesh->faces,
                                             setting.fine.rest, state.uvs, setting.work);
  }
}

/// Of what held the last steps up: in patches, or in regions around the worst of it; by sweeps over
/// all where the map is rough.
void clear_way(const Setting& setting, State& state) {
  std::vector<SingularStep> blocking = state.last.blocking;
  const DiskMesh& mesh = *setting.fine.mesh;
  const auto count = static_cast<double>(blocking.size());
  if (!state.swept && count > std::max(kMany, kRoughOf * mesh.face_count())) {
    sweep(setting, state);
    return;
  }
  const bool many = count > std::max(kMany, kManyOf * mesh.face_count());
  if (!many || mesh.face_count() < kLeastFaces) {
    clean(setting, faces_of(blocking), state);
    return;
  }
  std::sort(blocking.begin(), blocking.end(), [](const SingularStep& a, const SingularStep& b) {
    return a.length != b.length ? a.length < b.length : a.face < b.face;
  });
  const auto most = static_cast<std::size_t>(kMostRelaxed * mesh.face_count());
  if (blocking.size() > most) blocking.resize(most);
  const double done = share(state.iterations);
  state.cleaned_patches += relax_regions(setting.options.energy, mesh, setting.fine.rest, state.uvs,
                                         faces_of(blocking), setting.work.part(done, done));
}

/// Up to so many steps with the factor as it is, and the cleaning of what holds them up.
void take_steps(const Setting& setting, int steps, bool force_first, State& state) {
  // The objective is a mean, the stiffness that of a sum.
  const Precondition precondition = [&](const std::vector<Vec2>& in, std::vector<Vec2>& out) {
    setting.inverse.precondition(in, out);
    for (Vec2& w : out) w *= setting.area;
  };
  PolishOptions options;
  options.energy = setting.options.energy;
  options.tolerance = kTolerance;
  options.max_iterations = steps;
  options.shortest_first = !force_first ? kFullStep : state.swept ? kShortestSwept : 0;
  options.enough = setting.bounds.enough;
  options.stationary = setting.bounds.at_rest;
  options.contact = setting.contact;
  if (state.swept) {
    options.smooth = [&](std::vector<Vec2>& uvs) { smooth(setting, state.iterations, uvs); };
  }
  const int before = state.iterations;
  state.last = polish(setting.fine.mesh->faces, setting.fine.rest, precondition, state.uvs, options,
                      setting.work.part(share(before), share(before + steps)));
  state.iterations += state.last.iterations();
  if (state.last.iterations() > 0) state.clean = false;
  if (state.last.blocked) clear_way(setting, state);
}

/// Fits the factor to the map.
void fit_factor(const Setting& setting, const State& state) {
  std::vector<double> springs;
  if (setting.contact) {
    springs = setting.contact->stiffness(state.uvs);
    for (double& spring : springs) spring *= setting.contact->strength();
  }
  const DiskMesh& mesh = *setting.fine.mesh;
  std::vector<EdgeWeights> stiffness = energy_stiffness(setting.options.energy, mesh.faces,
                                                        setting.fine.rest, state.uvs, setting.work);
  setting.inverse.refit(stiffness, springs);
  parallel_free(setting.work, stiffness);  // so that the allocator does not keep it
}

/// Whether the last step looked at promises next to nothing.
bool is_stationary(const Setting& setting, const State& state) {
  const double energy = setting.comparable(state.last.energies.back());
  const double predicted = state.last.predicted;  // below 0 where it would lead uphill
  return predicted >= 0 && 0.5 * predicted <= setting.bounds.stationary * energy;
}

/// The same of what the last steps gained: a few faces promise more than that.
bool gained_little(const Setting& setting, const State& state) {
  const double energy = state.last.energies.back(), gain = state.last.energies.front() - energy;
  return gain <= setting.bounds.stationary * setting.comparable(energy);
}

/// Whether the map is no more distorted than that of the coarser mesh.
bool is_kept(const Setting& setting, const State& state) {
  const auto distortion = [&](double energy) {
    return to_dirichlet(setting.options.energy, energy);
  };
  return distortion(state.last.energies.back()) <=
         kNothingLost * distortion(setting.fine.statistics.coarse_energy);
}

/// Whether steps came to rest, or none was taken, where no distortion has come on, though a few
/// faces promise more.
bool has_settled(const Setting& setting, const State& state) {
  return setting.bounds.in_haste && is_kept(setting, state) && gained_little(setting, state);
}

void take_rounds(const Setting& setting, State& state) {
  double start = std::numeric_limits<double>::infinity();  // of the last round
  // Rounds of cleaning alone, without a step, are bounded too.
  for (int round = 0; round < kMostSteps; ++round) {
    if (state.last.converged || state.iterations >= setting.bounds.most_steps) return;
    if (setting.work.out_of_time()) return;
    if (setting.bounds.in_haste && is_kept(setting, state) &&
        (is_stationary(setting, state) || (state.iterations == 0 && !state.swept) ||
         (round > 0 && gained_little(setting, state)))) {
      return;  // what a few faces held up at once has been cleaned
    }
    // Springs of the contact change with the gaps, whatever the energy.
    if (setting.contact || state.last.energies.back() < (1 - kAsFitted) * state.fitted_at) {
      fit_factor(setting, state);
      state.fitted_at = state.last.energies.back();
    }
    take_steps(setting, setting.bounds.most_steps - state.iterations, true, state);
    if (!state.last.blocked) return;
    // Cleaning counts too: what a round gains includes what it did after the one before.
    const double energy = state.last.energies.back();
    const double gained = start - energy;
    start = state.last.energies.front();
    if (gained <= setting.bounds.little_gain * setting.comparable(energy)) return;
  }
}

/// A few steps of composite majorization: they cost most, and are not held up by nearly singular
/// faces.
void take_newton_steps(const Setting& setting, State& state) {
  NewtonOptions newton = newton_options(setting.options);
  newton.proxy_steps = 0;
  newton.contact = setting.contact;
  newton.max_iterations = kNewtonSteps;
  newton.tolerance = std::max(newton.tolerance, kNewtonTolerance);
  const DiskMesh& mesh = *setting.fine.mesh;
  const NewtonResult ended =
      minimise_energy(mesh.faces, setting.fine.rest, only_first_of_boundary(mesh), state.uvs,
                      newton, setting.work.part(0.9, 0.9));
  state.iterations += ended.iterations();
  if (ended.iterations() > 0) state.clean = false;
  state.converged = ended.converged;
}

/// Where the steps ended far from stationary, and time and memory are left.
void end_with_newton(const Setting& setting, State& state) {
  const double energy = setting.comparable(state.last.energies.back());
  state.converged = state.last.converged;
  if (state.converged || setting.work.out_of_time()) return;
  state.converged = is_stationary(setting, state) || has_settled(setting, state);
  if (!setting.bounds.newton || !(state.last.predicted > kMuchLeft * energy)) return;
  if (!affords(*setting.fine.mesh, setting.options, Extra::kNewtonSteps, setting.work)) return;
  take_newton_steps(setting, state);
}

}  // namespace

ChartMap polish_map(const FineProblem& fine, const BoundaryContact* contact, PolishLength length,
                    const ChartOptions& options, const Work& work, StiffnessInverse& inverse,
                    std::vector<Vec2> start) {
  ChartMap map;
  run_stage("polish", work, map.statistics.stages, [&](StageStatistics& stage, const Work& inner) {
    std::optional<BoundaryContact> fitted;
    if (contact) {
      fitted.emplace(*contact).fit(start,
                                   to_dirichlet(options.energy, fine.statistics.coarse_energy));
    }
    const Setting setting{fine,   fitted ? &*fitted : nullptr,     options,
                          inner,  surface_area(*fine.mesh, inner), bounds_of(length),
                          inverse};
    State state{.uvs = std::move(start)};
    if (setting.bounds.rough) sweep(setting, state);
    take_steps(setting, setting.bounds.in_haste ? setting.bounds.most_steps / 2 : 1, false, state);
    take_rounds(setting, state);
    end_with_newton(setting, state);
    if (!state.clean) clean(setting, {}, state);
    if (contact) scale_best(*fine.mesh, fine.rest, options, inner, state.uvs);
    stage.iterations = state.iterations;
    map.uvs = std::move(state.uvs);
    map.converged = state.converged;
    map.statistics.cleaned_patches = state.cleaned_patches;
  });
  return map;
}

}  // namespace beltrami
