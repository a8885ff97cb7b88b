#include "cut/bilaplacian.h"

#include <cmath>
#include <cstddef>
#include <vector>

#include "linear/evaluated.h"

namespace beltrami {
namespace {

/// From so many entries of its row on a vertex is a hub.
constexpr int kHub = 128;

}  // namespace

SparseMatrix bilaplacian(const SparseMatrix& laplacian, const Eigen::VectorXd& softness) {
  std::vector<bool> is_hub(static_cast<std::size_t>(laplacian.cols()));
  std::vector<Eigen::Triplet<double>> stars;
  for (int v = 0; v < laplacian.cols(); ++v) {
    is_hub[v] = laplacian.innerVector(v).nonZeros() > kHub;
    if (!is_hub[v]) continue;
    const double scale = softness[v] * laplacian.coeff(v, v);
    for (SparseMatrix::InnerIterator entry(laplacian, v); entry; ++entry) {
      const auto other = static_cast<int>(entry.row());
      const double spring = scale * std::abs(entry.value());
      if (other == v) continue;
      stars.emplace_back(other, other, spring);
      stars.emplace_back(v, v, spring);
      stars.emplace_back(v, other, -spring);
      stars.emplace_back(other, v, -spring);
    }
  }
  SparseMatrix weighted = evaluated(laplacian * softness.asDiagonal());
  if (stars.empty()) return evaluated(weighted * laplacian);
  weighted.prune([&](Eigen::Index, Eigen::Index column, double) { return !is_hub[column]; });
  SparseMatrix of_hubs(laplacian.rows(), laplacian.cols());
  of_hubs.setFromTriplets(stars.begin(), stars.end());
  return evaluated(evaluated(weighted * laplacian) + of_hubs);
}

}  // namespace beltrami
