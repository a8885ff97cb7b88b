#include "linear/shifted_factor.h"

#include <cmath>
#include <limits>

namespace beltrami {
namespace {

constexpr double kSmallestShift = 1e-13, kLargestShift = 2e-6, kGrowth = 1e2;

/// The diagonal is the first entry of each column of a lower triangle.
double& diagonal(SparseMatrix& lower, int column) {
  return lower.valuePtr()[lower.outerIndexPtr()[column]];
}

}  // namespace

double factorize_shifted(SpdSolver& solver, SparseMatrix& lower) {
  if (solver.factorize(lower)) return 0;
  Eigen::VectorXd kept(lower.cols());
  for (int c = 0; c < lower.cols(); ++c) {
    kept[c] = diagonal(lower, c);
    if (!std::isfinite(kept[c])) return -1;
  }
  double found = -1;
  for (double shift = kSmallestShift; shift < kLargestShift && found < 0; shift *= kGrowth) {
    const double floor = shift * kept.cwiseAbs().mean();
    for (int c = 0; c < lower.cols(); ++c) {
      diagonal(lower, c) = kept[c] + shift * std::abs(kept[c]) + floor;
    }
    if (solver.factorize(lower)) found = shift;
  }
  for (int c = 0; c < lower.cols(); ++c) diagonal(lower, c) = kept[c];
  return found;
}

}  // namespace beltrami
