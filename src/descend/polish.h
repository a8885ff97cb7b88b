// Descending from a good map to the minimum next to it, without another factorization.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "base/vectors.h"
#include "base/work.h"
#include "descend/contact.h"
#include "descend/line_search.h"
#include "energy/energy.h"
#include "mesh/disk_mesh.h"
#include "mesh/rest_shape.h"

namespace beltrami {

/// Shorter steps say nothing about convergence; all but the first one are at least so long.
inline constexpr double kFullStep = 0.5;

/// What a call of one step leaves to the next one, for conjugate gradients over calls.
struct LastStep {
  std::vector<Eigen::Vector2f> step;  ///< per vertex; empty: there is none
  double predicted = 0;               ///< -gradient . preconditioned gradient before it
};

struct PolishOptions {
  Energy energy = Energy::kSymmetricDirichlet;
  double tolerance = 1e-5;   ///< relative energy decrease of a step after which it may end, if
  double stationary = 1e-4;  ///< the next one is predicted to decrease it by less than that
  double enough = 0;  ///< it ends as soon as a step is predicted to decrease it by less than that
  int max_iterations = 20;
  /// Steps remembered, of which each takes 32 bytes of a vertex, and the first 16 more.
  std::size_t history = 5;
  double shortest_first = 0;  ///< the first step is taken unless it has to be shorter than that
  /// Keeps the boundary from touching itself: its barrier joins the energy, and steps end before
  /// the first touch. Fitted to the map; the boundary must be simple at the start. Null: it may
  /// cross itself.
  const BoundaryContact* contact = nullptr;
  double near = 0;  ///< told are the faces that so many times the last step would make singular
  /// With a history of 0: a share of the step before joins the direction (Fletcher & Reeves 1964,
  /// "Function minimization by conjugate gradients"), and the last one is kept there. Or null.
  LastStep* last = nullptr;
};

struct PolishResult {
  std::vector<double> energies;  ///< mean energy, with contact the barrier's share included, at
                                 ///< the start and after each step, never rising
  bool converged = false;        ///< ended so, after a step of at least 1/2 or, with contact,
                                 ///< after three that gained as little as the next one would
  bool blocked = false;          ///< the next step would have had to be shorter than that
  std::vector<SingularStep> blocking;  ///< because of these, near to which it would come
  std::vector<SingularStep> near;      ///< those asked for, and these
  double predicted = 0;                ///< -gradient . direction of the last step looked at
  int iterations() const { return static_cast<int>(energies.size()) - 1; }
};

/// Sets `out` to about the inverse Hessian times `in`, one entry per vertex; linear, symmetric,
/// definite.
using Precondition = std::function<void(const std::vector<Vec2>& in, std::vector<Vec2>& out)>;

/// Minimises the mean energy by L-BFGS (Nocedal 1980) with `precondition` for the initial inverse
/// Hessian. No face ever flips: faces that a step would bring too near to that move more rigidly
/// with their neighbours, and where this does not help the whole step is shortened. It ends where
/// the time is up, and where steps become short: clean_outliers mends the faces that block them.
/// Precondition: all faces of `uvs` are positively oriented.
PolishResult polish(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                    const Precondition& precondition, std::vector<Vec2>& uvs,
                    const PolishOptions& options, const Work& work);

}  // namespace beltrami
