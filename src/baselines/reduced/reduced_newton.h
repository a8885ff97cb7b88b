// Dense projected Newton in the reduced harmonic subspace, after the locally and the globally
// injective flattening in it (Hefetz, Chien, Weber 2019, FLIM; Fargion & Weber 2022, GIF; paper
// section 3.5).
#pragma once

#include <vector>

#include "base/vectors.h"
#include "base/work.h"
#include "energy/energy.h"
#include "linear/spd_solver.h"
#include "mesh/rest_shape.h"

namespace beltrami {

/// The mean energy of sampled faces as a function of the meta vertices.
struct ReducedProblem {
  Energy energy = Energy::kSymmetricDirichlet;
  DenseMatrix edges;               ///< rows 2s, 2s + 1: edges of sample s from its corner 0 to its
                                   ///< corners 1 and 2; one column per meta vertex
  std::vector<RestTriangle> rest;  ///< per sample
  std::vector<double> weights;     ///< per sample, > 0: the area it stands for
};

struct ReducedDescent {
  std::vector<double> energies;  ///< mean energy of the samples at first and after each step
  bool converged = false;
};

/// Moves the meta vertices `x`, a polygon that is simple and counter-clockwise at first, to lessen
/// the energy. No positive sample ever flips. Samples that are flipped at first count with a
/// constant, and take part once they have become better than that, so that the energy never rises.
/// With `scaffold` the polygon stays simple: the ring around it is triangulated anew for each step,
/// its faces joining the energy with a small weight, and every step is judged by exact predicates.
/// Ends, not converged, where no shift makes a Newton system definite.
ReducedDescent minimise_reduced(const ReducedProblem& problem, bool scaffold, double tolerance,
                                int max_iterations, std::vector<Vec2>& x, const Work& work);

}  // namespace beltrami
