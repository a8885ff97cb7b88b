// A V-cycle over levels of a disk: from each level to the next finer one by interpolation, a factor
// on the coarsest, half a symmetric Gauss-Seidel step before and after on the others (Brandt 1977,
// "Multi-level adaptive solutions to boundary-value problems"; Hackbusch 1985, chapter 4).
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "energy/energy.h"
#include "flatten/hessian_factor.h"
#include "flatten/laplacian.h"
#include "flatten/metric.h"
#include "flatten/stiffness_inverse.h"
#include "linear/smoother.h"
#include "mesh/disk_mesh.h"
#include "mesh/rest_shape.h"
#include "prolong/interpolation.h"

namespace beltrami {

/// Levels are added from coarse to fine, each with the stiffness of its own map: what a stiffness
/// is like on a finer mesh, the coarser one knows well enough.
class VCycle final : public StiffnessInverse {
 public:
  /// The coarsest level, with its factor; levels of more than `most_for_hessian` faces get no
  /// Hessian. Keeps references to the meshes. Throws Error SOLVER.
  VCycle(const DiskMesh& mesh, const std::vector<EdgeWeights>& stiffness, Index most_for_hessian,
         const Work& work);
  ~VCycle() override;

  /// From now on precondition() ends on the level that is the finest now, with a factor of the
  /// Hessian of the energy at this map of it, as long as there are no springs: what is left over
  /// there of a descent by stiffness, which is slow along motions of large parts, takes a few steps
  /// with it. It takes the place of that of a coarser level, which stays where this one cannot be
  /// factorized; if it cannot the second time, there is none. Returns whether there is one here.
  bool take_hessian(Energy energy, const std::vector<RestTriangle>& rest,
                    const std::vector<Vec2>& uvs) override;
  /// Whether that is of a level finer than the coarsest.
  bool has_hessian_of_finer() const { return hessian_ && hessian_level_ > 0; }

  /// Frees what only the next Hessian of this level would be made faster with.
  void settle();

  /// Adds the next finer level, without weights yet; `points`: of its vertices on the one before.
  void add(const DiskMesh& mesh, std::vector<Footpoint> points);

  /// Those of the finest level.
  const std::vector<Footpoint>& points() const;

  /// Gives the finest level its stiffness, and all of them springs, per vertex of the finest or
  /// none.
  void set(const std::vector<SingleWeights>& weights, const std::vector<double>& springs);
  /// Gives all levels stiff springs at these vertices of the finest, see kStiffSpring; one entry
  /// per vertex.
  void anchor(const std::vector<bool>& vertices);
  /// Of the finest level, unless that is the coarsest, which keeps what it has.
  void refit(const StiffnessOfFaces& stiffness, const std::vector<double>& springs) override;

  void precondition(const std::vector<Vec2>& rhs, std::vector<Vec2>& x) override;

  /// Adds to `uvs` what conjugate gradients with the V-cycle of the stiffness make of the residual,
  /// on the finest level, and leaves what is left of it: up to `most` steps, until `enough`, which
  /// is told how many were made, says so after one. Ends without asking where rounding leaves no
  /// direction.
  void improve(int most, const std::function<bool(int step)>& enough, SingleField& residual,
               std::vector<Vec2>& uvs);

 private:
  struct Level;

  const DiskMesh& finest() const;
  template <class Rhs>
  void apply(std::size_t level, const std::vector<Rhs>& rhs, bool by_hessian, SingleField& x);
  template <class Factor, class Rhs>
  void solve_with(Factor& factor, const std::vector<Rhs>& rhs, SingleField& x);
  void set_springs_below(std::size_t level, const std::vector<float>& springs);

  Work work_;
  const DiskMesh& coarsest_;
  const Index most_for_hessian_;
  std::vector<EdgeWeights> coarsest_stiffness_;
  MetricLaplacian factor_;
  std::unique_ptr<HessianFactor> hessian_;
  std::size_t hessian_level_ = 0;               ///< 0 is the coarsest
  std::vector<std::unique_ptr<Level>> levels_;  ///< from the coarsest that has no factor
  bool has_springs_ = false;                    ///< on the levels below the finest
  std::vector<Vec2> solve_rhs_, solve_x_;
};

}  // namespace beltrami
