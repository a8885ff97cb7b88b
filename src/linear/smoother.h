// The full rows of a mesh's Laplacian in single precision, and the two halves of a symmetric
// Gauss-Seidel step on them.
#pragma once

#include <cstdint>
#include <vector>

#include "base/scratch.h"
#include "base/types.h"
#include "base/work.h"
#include "mesh/surface.h"

namespace beltrami {

/// Weights of the edges of a face, each opposite to the corner of its index.
using SingleWeights = Eigen::Array3f;
/// One entry per vertex.
using SingleField = std::vector<Eigen::Vector2f>;

/// A Laplacian A = D - W of a mesh. Its sweeps are Gauss-Seidel within fixed blocks of vertices and
/// Jacobi between them: with M the diagonal and, within the blocks, the lower triangle of A.
/// Neighbours should lie close in memory. The same bits at any number of threads.
class Smoother {
 public:
  /// Without weights yet.
  Smoother(const Surface& mesh, const Work& work);

  /// `weights`: per face. `springs`: per vertex, what the diagonal has beside them, or empty.
  void set(const Surface& mesh, const std::vector<SingleWeights>& weights,
           const std::vector<float>& springs);

  /// The diagonal without the springs.
  float stiffness(Index vertex) const;

  /// Other springs with the same weights.
  void set_springs(const std::vector<float>& springs);

  /// A x.
  void multiply(const SingleField& x, SingleField& product) const;
  /// x = M^-1 rhs. Right-hand sides may be Vec2, too, and are rounded where they are read: a copy
  /// of the finest level's would be memory at its peak.
  template <class Rhs>
  void sweep_forward(const std::vector<Rhs>& rhs, SingleField& x) const;
  /// rhs - A x, where x is what sweep_forward left.
  void residual_after_forward(const SingleField& x, SingleField& residual) const;
  /// x += M^-T (rhs - A x); `before` is for its own use.
  template <class Rhs>
  void sweep_backward(const std::vector<Rhs>& rhs, SingleField& x, SingleField& before) const;

 private:
  static constexpr Index kBlock = 4096;
  /// The entries of a row: before `upper` those of earlier vertices of the block, before `outside`
  /// those of later ones.
  struct Row {
    Index begin, upper, outside;
  };

  Work work_;
  Index count_;        ///< of vertices
  Scratch<Row> rows_;  ///< and one more
  Scratch<Index> column_;
  Scratch<float> weight_;            ///< W
  std::vector<float> springs_;       ///< or empty
  Scratch<float> inverse_diagonal_;  ///< 0 where that is not positive
};

}  // namespace beltrami
