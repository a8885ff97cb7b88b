// What a cut is worth, without a map: the strain of a thin sheet that is pressed flat, to first
// order.
//
// Half of the symmetric Dirichlet energy is, near an isometry, one and the squares of the two
// strains: that of an elastic sheet without lateral contraction. Such a sheet in the plane has an
// Airy stress function x with Delta Delta x = -K, K the Gaussian curvature that is pressed out, and
// x = dx/dn = 0 where it is free, at seams and borders (Seung & Nelson, "Defects in flexible
// membranes with crystalline order", 1988, section III). Its energy is the integral of (Delta x)^2.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "base/types.h"
#include "base/work.h"
#include "linear/spd_solver.h"
#include "mesh/surface.h"

namespace beltrami {

/// What the energy of a model becomes where `count` vertices, or a run of them, are pinned or let
/// go, in the order that they were given in.
class ModelChange {
 public:
  /// `energy`: of the model as it is. `load`, (count), and `matrix`, (count, count), symmetric and
  /// positive: the stress at the vertices and their compliance where they are pinned, `sign` -1;
  /// the force on them and their stiffness where they are let go, `sign` 1.
  ModelChange(double energy, Eigen::VectorXd load, DenseMatrix matrix, double sign)
      : energy_(energy), load_(std::move(load)), matrix_(std::move(matrix)), sign_(sign) {}

  /// Symmetric Dirichlet, at least 2, where all are.
  double energy() const { return energy_of(0, load_.size()); }
  /// Where `count` vertices from the one with the number `first` are. Where rounding has left
  /// nothing of the change (a chart that hangs on a branch alone): as it is where more are pinned,
  /// infinite where some are let go.
  double energy_of(std::ptrdiff_t first, std::ptrdiff_t count) const;

 private:
  double energy_;
  Eigen::VectorXd load_;
  DenseMatrix matrix_;
  double sign_;
};

/// The stress function by linear elements, Delta Delta as L M^-1 L (mixed method of Ciarlet &
/// Raviart 1974): L the cotangent Laplacian, M the areas of vertices. A seam is where x = 0; that
/// its two sides may be stretched differently is left out, so that adding one is a change of low
/// rank.
class ElasticModel {
 public:
  /// `real_faces`: those after them are virtual and weigh hardly anything in the energy. Throws
  /// std::bad_alloc.
  ElasticModel(const Surface& surface, Index real_faces, const Work& work);
  /// One that knows the same, for another thread. What follows from the pins it computes anew.
  ElasticModel(const ElasticModel& other, const Work& work);

  /// Takes the vertices that seams are at, `pinned`: per vertex, those of borders need not be. Each
  /// component with a face must have one. What follows is computed when it is asked for; that of
  /// those asked about last before is kept: what is tried is often taken back.
  void pin(std::vector<bool> pinned);

  /// Per vertex, the stress function: greatest in magnitude where a seam relieves most.
  /// Throws Error SOLVER, as all that ask do.
  const std::vector<double>& stress() const { return sheet().stress; }

  /// What a real map's symmetric Dirichlet energy is taken for, at least 2. Of 17 scans, sculpted
  /// meshes and CAD parts with seams for 2.05 the excess over 2 of real maps was .83 to 1.05 times
  /// the model's, and up to 2 times where most vertices lie on seams.
  double energy() const { return sheet().energy; }

  /// Learns from real maps along the seams at the pinned vertices where strain costs more or less
  /// than it was taken for, so that the energies around each place come nearer to those of the maps
  /// (space mapping, Bandler et al. 1994, place by place). The whole may still err by a factor.
  /// Calibrating again goes on from there. `excess`: per vertex, the energy over 2 of what is
  /// around it, times its share of the area.
  void calibrate(const std::vector<double>& excess);

  /// Where `vertices` are pinned, too. Precondition: none of them is.
  ModelChange with(std::span<const Index> vertices) const;

  /// Where pinned `vertices` are pinned no more. Precondition: all of them are, none is of a
  /// border, and of each component one that is not among them.
  ModelChange without(std::span<const Index> vertices) const;

 private:
  /// What follows from the vertices that are pinned.
  struct Sheet {
    std::vector<bool> pinned;  ///< empty: none has been taken
    std::unique_ptr<SpdSolver> solver;
    std::vector<double> stress;
    double energy = 2;
  };

  void assemble();
  Eigen::VectorXd spread(Eigen::VectorXd field) const;
  Sheet unpinned() const;
  const Sheet& sheet() const;

  const Surface& surface_;
  const Work work_;
  Eigen::VectorXd defect_;    ///< per vertex: K
  SparseMatrix laplacian_;    ///< of the intrinsic Delaunay triangulation
  Eigen::VectorXd area_;      ///< per vertex, the share of the whole
  Eigen::VectorXd price_;     ///< per vertex: what was learnt, times what strain there costs
  SparseMatrix bilaplacian_;  ///< whole
  SparseMatrix lower_;        ///< its lower triangle, diagonal included
  std::vector<bool> pinned_;
  mutable Sheet now_, before_;  ///< of the vertices asked about last, and before
};

}  // namespace beltrami
