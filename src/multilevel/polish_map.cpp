// What is done                  with the factor       how often
// ----------------------------  --------------------  ------------------------------------------
// relaxing of spikes            -                     at the start, where the map comes rough, or
//                                                     once much holds it up
// one step of L-BFGS            of the flattening     once, and only if it is not held up; on the
//                                                     finest of several levels up to 4 steps, with
//                                                     which it mostly ends
// one step, and regions around  fitted to the map     rounds from then on, while there is much
//   what it brings near to        where it has changed  of that; with contact the next row instead
//   being singular
// L-BFGS until it is stationary fitted to the map     rounds, to 30 steps in all, 8 on that level,
//   or held up                  where it has changed  20 below it and after hard ones, while a
//                                                     round gains some ten thousandths of the
//                                                     energy
// Newton steps                  of their own          where much is left to gain: up to 10
// cleaning of outliers          -                     after each that is held up, and at the end
//   or of regions                                     if a step came since
//
// On a level that still gains much by a round with regions, its own Hessian takes the place of that
// factor.
//
// Held up: nearly singular faces would shorten the steps. Patches around these are optimised then,
// or whole regions where they are many, each of which a patch would leave to its neighbours.
// Steps of the whole and regions in turns are a nonlinear Schwarz method with a coarse correction
// (Cai & Keyes 2002, "Nonlinearly preconditioned inexact Newton algorithms"): the V-cycle moves
// what is far apart, the regions what is nonlinear, and that is where faces are about to be
// singular. When the time is up, what is left of the rounds and the Newton steps is left out.
#include "multilevel/polish_map.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

#include "base/interrupt.h"
#include "base/parallel.h"
#include "base/types.h"
#include "descend/line_search.h"
#include "descend/newton.h"
#include "descend/polish.h"
#include "descend/tutte.h"
#include "energy/energy.h"
#include "energy/symmetric_dirichlet.h"
#include "flatten/metric.h"
#include "local/regions.h"
#include "mesh/boundary.h"
#include "mesh/disk_mesh.h"
#include "multilevel/descent.h"
#include "multilevel/extras.h"
#include "repair/outliers.h"
#include "repair/spikes.h"

namespace beltrami {
namespace {

/// Relative decrease of the energy in a step at which L-BFGS ends: it leaves it 0.1% too high.
constexpr double kTolerance = 3e-4;
/// Steps of all rounds together.
constexpr int kMostSteps = 30;
/// Faces with more times the distortion of the coarser mesh are spikes, and relaxed before a step.
constexpr double kSpike = 30;
/// A step that regions follow may be so short, of a full one.
constexpr double kShortest = 0.01;
/// Regions relax what so many times that step would make singular...
constexpr double kNear = 6;
/// ... and so many rings around it.
constexpr int kRings = 8;
/// Predicted relative decrease from which on Newton steps of their own are worth their cost.
constexpr double kMuchLeft = 1e-2;
constexpr int kNewtonSteps = 10;
/// Relative decrease of the energy that is worth something: another fit of a factor, a Hessian, the
/// ways of a rough map, one more Newton step.
constexpr double kWorthIt = 2e-3;
/// Faces in the way, as a share of all, with more of which a map is rough: patches would hold each
/// other up, and regions around the worst of them are relaxed instead.
constexpr double kManyOf = 3e-4;
/// Share of the faces that regions are put around at once.
constexpr double kMostRelaxed = 1e-2;
/// What a length of the polish means. Decreases are relative ones of the energy.
struct Bounds {
  double enough;       ///< predicted decrease at which it ends
  double little_gain;  ///< a round that ends blocked is the last one where it has gained no more
  int most_steps;
  double stationary;      ///< predicted decrease that is none
  double at_rest;         ///< the same after a step that gained next to nothing
  bool newton = false;    ///< may end with Newton steps
  bool in_haste = false;  ///< one factor will do, where no distortion has come on since below
  bool rough = false;     ///< the map comes rough: else where much holds it up
};

constexpr Bounds kWholeBounds{.enough = 0,
                              .little_gain = 1e-3,
                              .most_steps = kMostSteps,
                              .stationary = 1e-4,
                              .at_rest = 1e-4,
                              .newton = true,
                              .rough = true};
constexpr Bounds kLongBounds{.enough = 1e-4,
                             .little_gain = 1e-4,
                             .most_steps = 20,
                             .stationary = 1e-3,
                             .at_rest = 1.5e-4,
                             .rough = true};
constexpr Bounds kLongOnLargeBounds{.enough = 1e-4,
                                    .little_gain = 5e-4,
                                    .most_steps = 20,
                                    .stationary = 1e-3,
                                    .at_rest = 1e-3,
                                    .rough = true};
constexpr Bounds kShortBounds{.enough = 4e-4,
                              .little_gain = 1e-4,
                              .most_steps = 8,
                              .stationary = 5e-4,
                              .at_rest = 1e-4,
                              .in_haste = true};

const Bounds& bounds_of(PolishLength length, Index faces) {
  switch (length) {
    case PolishLength::kShort:
      return kShortBounds;
    case PolishLength::kLong:
      return faces <= kLargeMesh ? kLongBounds : kLongOnLargeBounds;
    default:
      return kWholeBounds;
  }
}

/// What all steps have in common.
struct Setting {
  const MapProblem& fine;
  const BoundaryContact* contact;  ///< fitted to the map, or null
  const ChartOptions& options;
  const Work& work;
  double area;  ///< of the surface
  StiffnessInverse& inverse;

  double comparable(double energy) const { return comparable_energy(options.energy, energy); }
};

/// How far it got.
struct State {
  Bounds bounds;
  std::vector<Vec2> uvs;
  int iterations = 0;
  std::int64_t cleaned_patches = 0;
  bool rough = false;       ///< or was at first
  bool near = true;         ///< and steps bring much near to being singular
  bool alternated = false;  ///< the last round was one step, and regions
  bool clean = true;        ///< no step since the last cleaning; it comes mended
  PolishResult last = {};   ///< of the last steps
  LastStep step = {};       ///< of rounds of one step and regions, on large meshes
  double energy = 0;        ///< after these; and after regions that follow a step
  double fitted_at = std::numeric_limits<double>::infinity();   ///< the energy there
  double hessian_at = std::numeric_limits<double>::infinity();  ///< of the inverse, if it has one
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

/// Whether these are many of the faces of a mesh.
bool are_many(const std::vector<SingularStep>& faces, const DiskMesh& mesh) {
  return static_cast<double>(faces.size()) > kManyOf * mesh.face_count();
}

/// Relaxes what is worst in a map that is rough. Returns whether there was any.
bool relax_worst(const Setting& setting, State& state) {
  const Energy energy = setting.options.energy;
  const double coarse = to_dirichlet(energy, setting.fine.statistics.coarse_energy);
  const double limit = kSpike * std::max(SymmetricDirichlet::kMinimum, coarse);
  const double done = share(state.iterations);
  state.rough = true;
  if (relax_spikes(energy, limit, *setting.fine.mesh, setting.fine.rest, state.uvs,
                   setting.work.part(done, done)) == 0) {
    return false;
  }
  state.clean = false;
  return true;
}

/// Relaxes regions around those of the faces that are singular first. Returns the mean energy then.
double relax(const Setting& setting, std::vector<SingularStep> faces, State& state) {
  const DiskMesh& mesh = *setting.fine.mesh;
  PollSometimes poll;
  const auto is_first = [&](const SingularStep& a, const SingularStep& b) {
    poll();
    return a.length != b.length ? a.length < b.length : a.face < b.face;
  };
  const auto most = static_cast<std::size_t>(kMostRelaxed * mesh.face_count());
  if (faces.size() > most) {
    std::nth_element(faces.begin(), faces.begin() + static_cast<std::ptrdiff_t>(most), faces.end(),
                     is_first);
    faces.resize(most);
  }
  std::sort(faces.begin(), faces.end(), is_first);
  const double done = share(state.iterations);
  const Work inner = setting.work.part(done, done);
  state.cleaned_patches += relax_regions(setting.options.energy, mesh, setting.fine.rest, state.uvs,
                                         faces_of(faces), kRings, inner);
  return mean_energy(setting.options.energy, mesh.faces, setting.fine.rest, state.uvs, inner);
}

/// Whether the last step looked at promises more than a share of the energy.
bool promises(double share_of, const Setting& setting, const State& state) {
  return 0.5 * state.last.predicted > share_of * setting.comparable(state.energy);
}

/// Of what held the last steps up: in patches, or in regions around the worst of it.
void clear_way(const Setting& setting, State& state) {
  const std::vector<SingularStep>& blocking = state.last.blocking;
  const DiskMesh& mesh = *setting.fine.mesh;
  const bool worth_it = promises(kWorthIt, setting, state);
  if (!state.rough && worth_it && are_many(blocking, mesh)) {
    if (state.bounds.in_haste) state.bounds = bounds_of(PolishLength::kLong, mesh.face_count());
    state.near = true;
    if (relax_worst(setting, state)) return;
  }
  if (mesh.face_count() >= kLeastForRegions && are_many(blocking, mesh)) {
    relax(setting, blocking, state);
  } else {
    clean(setting, faces_of(blocking), state);
  }
}

/// Up to so many steps with the factor as it is, and the cleaning of what holds them up; or one
/// step and regions.
void take_steps(const Setting& setting, int steps, bool force_first, State& state) {
  // The objective is a mean, the stiffness that of a sum.
  const Precondition precondition = [&](const std::vector<Vec2>& in, std::vector<Vec2>& out) {
    setting.inverse.precondition(in, out);
    for (Vec2& w : out) w *= setting.area;
  };
  const DiskMesh& mesh = *setting.fine.mesh;
  // Regions know nothing of contact.
  state.alternated = state.rough && state.near && !setting.contact;
  PolishOptions options;
  options.energy = setting.options.energy;
  options.tolerance = kTolerance;
  options.max_iterations = state.alternated ? 1 : steps;
  options.shortest_first = state.alternated ? kShortest : force_first ? 0 : kFullStep;
  const bool is_whole = state.bounds.newton && !setting.contact;
  if (!is_whole && mesh.face_count() > kLargeMesh) {
    options.history = 0;
    if (state.alternated) options.last = &state.step;
  }
  if (!options.last) parallel_free(setting.work, state.step.step);
  options.enough = state.bounds.enough;
  options.stationary = state.bounds.at_rest;
  options.contact = setting.contact;
  options.near = state.alternated ? kNear : 0;
  const int before = state.iterations;
  state.last = polish(mesh, setting.fine.rest, precondition, state.uvs, options,
                      setting.work.part(share(before), share(before + steps)));
  state.energy = state.last.energies.back();
  state.iterations += state.last.iterations();
  if (state.last.iterations() > 0) state.clean = false;
  state.near = are_many(state.alternated ? state.last.near : state.last.blocking, mesh);
  if (state.alternated && !state.last.converged) {
    state.energy = relax(setting, std::move(state.last.near), state);
  } else if (state.last.blocked) {
    clear_way(setting, state);
  }
}

/// Fits the factor to the map.
void fit_factor(const Setting& setting, const State& state) {
  std::vector<double> springs;
  if (setting.contact) {
    springs = setting.contact->stiffness(state.uvs);
    for (double& spring : springs) spring *= setting.contact->strength();
  }
  const DiskMesh& mesh = *setting.fine.mesh;
  setting.inverse.refit(
      stiffness_of_faces(setting.options.energy, mesh.faces, setting.fine.rest, state.uvs),
      springs);
}

/// Whether the last step looked at promises next to nothing.
bool is_stationary(const Setting& setting, const State& state) {
  const double energy = setting.comparable(state.energy);
  const double predicted = state.last.predicted;  // below 0 where it would lead uphill
  return std::isfinite(energy) && predicted >= 0 &&
         0.5 * predicted <= state.bounds.stationary * energy;
}

/// The same of what the last steps gained: a few faces promise more than that.
bool gained_little(const Setting& setting, const State& state) {
  const double gain = state.last.energies.front() - state.energy;
  return gain <= state.bounds.stationary * setting.comparable(state.energy);
}

/// Whether the map is no more distorted than that of the coarser mesh.
bool is_kept(const Setting& setting, const State& state) {
  const auto distortion = [&](double energy) {
    return to_dirichlet(setting.options.energy, energy);
  };
  return distortion(state.energy) <= distortion(setting.fine.statistics.coarse_energy);
}

void take_rounds(const Setting& setting, State& state) {
  double start = std::numeric_limits<double>::infinity();  // of the last round
  // Rounds of cleaning alone, without a step, are bounded too.
  for (int round = 0; round < kMostSteps; ++round) {
    if (state.last.converged || state.iterations >= state.bounds.most_steps) return;
    if (setting.work.out_of_time()) return;
    if (state.bounds.in_haste && is_kept(setting, state) &&
        (is_stationary(setting, state) || (round > 0 && gained_little(setting, state)))) {
      return;  // what a few faces held up at once has been cleaned
    }
    // Springs of the contact change with the gaps, whatever the energy.
    if (setting.contact || state.energy < (1 - kWorthIt) * state.fitted_at) {
      fit_factor(setting, state);
      state.fitted_at = state.energy;
    }
    take_steps(setting, state.bounds.most_steps - state.iterations, true, state);
    if ((!state.last.blocked && !state.alternated) || setting.work.out_of_time()) return;
    // Cleaning counts too: what a round gains includes what it did after the one before.
    const double first = state.last.energies.front();
    const double gained = (state.alternated ? first : start) - state.energy;
    start = first;
    if (state.alternated && state.energy < (1 - kWorthIt) * state.hessian_at &&
        gained > kWorthIt * setting.comparable(state.energy)) {
      const bool taken =
          setting.inverse.take_hessian(setting.options.energy, setting.fine.rest, state.uvs);
      state.hessian_at = taken ? state.energy : 0;  // or never again
    }
    if (gained <= state.bounds.little_gain * setting.comparable(state.energy)) {
      state.last.converged = state.rough && !setting.contact && state.last.iterations() > 0;
      return;
    }
  }
}

/// A few steps of composite majorization: they cost most, and are not held up by nearly singular
/// faces.
void take_newton_steps(const Setting& setting, State& state) {
  NewtonOptions newton = newton_options(setting.options);
  newton.proxy_steps = 0;
  newton.contact = setting.contact;
  newton.max_iterations = kNewtonSteps;
  newton.tolerance = std::max(newton.tolerance, kWorthIt);
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
  const double energy = setting.comparable(state.energy);
  state.converged = state.last.converged;
  if (state.converged || setting.work.out_of_time()) return;
  state.converged = is_stationary(setting, state);
  if (!state.bounds.newton || !(state.last.predicted > kMuchLeft * energy)) return;
  if (!affords(*setting.fine.mesh, setting.options, Extra::kNewtonSteps, setting.work)) return;
  take_newton_steps(setting, state);
}

}  // namespace

ChartMap polish_map(const MapProblem& fine, const BoundaryContact* contact, PolishLength length,
                    const ChartOptions& options, const Work& work, StiffnessInverse& inverse,
                    std::vector<Vec2> start) {
  ChartMap map;
  run_stage("polish", work, map.statistics.stages, [&](StageStatistics& stage, const Work& inner) {
    std::optional<BoundaryContact> fitted;
    if (contact) {
      fitted.emplace(*contact).fit(start,
                                   to_dirichlet(options.energy, fine.statistics.coarse_energy));
    }
    const Setting setting{fine,  fitted ? &*fitted : nullptr,     options,
                          inner, surface_area(*fine.mesh, inner), inverse};
    State state{.bounds = bounds_of(length, fine.mesh->face_count()), .uvs = std::move(start)};
    if (state.bounds.rough) relax_worst(setting, state);
    const int first_steps = state.bounds.in_haste ? state.bounds.most_steps / 2 : 1;
    take_steps(setting, first_steps, false, state);
    // A face that is positive by exact predicates may be singular in floats.
    if (!std::isfinite(state.energy) && relax_worst(setting, state)) {
      take_steps(setting, first_steps, false, state);
    }
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
