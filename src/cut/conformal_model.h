// What a cut is worth, without a map: the conformal map that keeps the lengths of seams and borders
// (Springborn, Schroeder & Pinkall 2008, section 5; the energy of Sharp & Crane, "Variational
// surface cutting", 2018, section 3), for its scales are the solution of one linear system.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "base/types.h"
#include "base/work.h"
#include "linear/spd_solver.h"
#include "mesh/surface.h"

namespace beltrami {

/// Solves L u = -K where no seam is, u = 0 on seams and borders: L the cotangent Laplacian, K the
/// defect of the angles at a vertex, e^u the factor by which lengths in the plane are to be those
/// on the surface.
class ConformalModel {
 public:
  /// `real_faces`: those after them are virtual and weigh nothing in the energy. Throws
  /// std::bad_alloc.
  ConformalModel(const Surface& surface, Index real_faces, const Work& work);

  /// Takes the vertices that seams are at, `pinned`: per vertex, those of borders need not be. Each
  /// component with a face must have one. Throws Error SOLVER.
  void pin(const std::vector<bool>& pinned);

  /// Per vertex, the logarithm of the factor of lengths.
  const std::vector<double>& factors() const { return u_; }

  /// What a real map's symmetric Dirichlet energy is taken for: that of the conformal map with the
  /// factors 0.4 u at its best scale, 2 sqrt(<e^0.8u> <e^-0.8u>), means by area; at least 2.
  double energy() const { return energy_; }

  /// That energy if `vertices` were pinned, too. Precondition: none of them is.
  double energy_with(std::span<const Index> vertices) const;

  /// That energy if pinned `vertices` were not. Precondition: all of them are, none is of a border,
  /// and of each component one that is not among them.
  double energy_without(std::span<const Index> vertices) const;

  /// By how much energy() would fall, to first order and up to a factor that is much the same for
  /// all, if a vertex were pinned alone. One per vertex, 0 where it is.
  std::vector<double> gains() const;

 private:
  double energy_of(const Eigen::VectorXd& u) const;

  const Surface& surface_;
  Eigen::VectorXd area_;    ///< per vertex, a third of its real faces; 1 in all
  Eigen::VectorXd defect_;  ///< per vertex: K
  SparseMatrix laplacian_;  ///< of the intrinsic Delaunay triangulation, whole
  std::vector<bool> pinned_;
  std::unique_ptr<SpdSolver> solver_;
  std::vector<double> u_;
  double energy_ = 2;
};

}  // namespace beltrami
