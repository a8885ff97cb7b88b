// Projected Newton in the space of all piecewise linear maps: composite majorization (Shtengel et
// al. 2017; paper section 3.2), started by a few steps of SLIM (Rabinovich et al. 2017).
#pragma once

#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "descend/contact.h"
#include "descend/newton_loop.h"
#include "energy/energy.h"
#include "mesh/rest_shape.h"

namespace beltrami {

struct NewtonOptions {
  Energy energy = Energy::kSymmetricDirichlet;
  double tolerance = 1e-4;  ///< relative energy decrease of a step of at least 1/2 that ends it
  int max_iterations = 500;
  int proxy_steps = newton::kProxySteps;  ///< 0: composite majorization alone
  /// Mean energy, counted as symmetric Dirichlet (to_dirichlet), above which a run is given up
  /// after newton::kHopefulSteps.
  double hopeless = std::numeric_limits<double>::infinity();
  /// Keeps the boundary from touching itself: its barrier joins the energy, a share of it that
  /// falls with the energy, and steps end before the first touch. The boundary must be simple at
  /// the start. Null: it may cross itself.
  const BoundaryContact* contact = nullptr;
  /// Judges the start and the map after each step, for instance: the boundary is simple. Where that
  /// does not hold once steps gain less than 1%, the run ends. Anything goes by default.
  std::function<bool(const std::vector<Vec2>& uvs)> admissible;
  /// Per vertex the unit normal of the line along which it may slide, zero where it is free; null:
  /// all are free. It begins on its line.
  const std::vector<Vec2>* slides = nullptr;
  /// Per vertex its rank in an order of elimination (linear/elimination.h); none: one is found.
  std::span<const Index> ranks = {};
};

struct NewtonResult {
  /// Mean energy at the start and after each step; never rising, but with contact, where that holds
  /// of its sum with the barrier.
  std::vector<double> energies;
  bool converged = false;
  bool is_cut_short = false;   ///< ended by the limit of steps or of time, or given up
  bool is_hopeless = false;    ///< given up
  bool in_contact = false;     ///< boundary parts press on each other at the end
  bool refused = false;        ///< the map at the end is not admissible; then
  std::vector<Vec2> admitted;  ///< the last one that was, empty if none

  int iterations() const { return static_cast<int>(energies.size()) - 1; }
};

/// Minimises the mean energy (weighted by rest area) over the vertices that are
/// not `fixed`, from `uvs`, in place. No face ever flips: the step is bounded by the first
/// singular face, then halved until the energy falls sufficiently (Armijo).
/// Preconditions: every face is positively oriented in `uvs`; at least one vertex is fixed if the
/// faces are connected (a free map drifts otherwise).
/// Ends, not converged, where no shift makes a system definite, and where the time is up.
NewtonResult minimise_energy(const std::vector<Triangle>& faces,
                             const std::vector<RestTriangle>& rest, const std::vector<bool>& fixed,
                             std::vector<Vec2>& uvs, const NewtonOptions& options,
                             const Work& work);

}  // namespace beltrami
