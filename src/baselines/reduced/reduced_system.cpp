#include "baselines/reduced/reduced_system.h"

#include <Eigen/Cholesky>
#include <array>
#include <cstdint>

#include "base/parallel.h"
#include "descend/newton_loop.h"

namespace beltrami {
namespace {

/// Columns of the Hessian that are formed together.
constexpr Eigen::Index kTile = 32;

}  // namespace

/// In tiles of columns, so that threads share no sums.
ReducedSystem assemble_reduced(const DenseMatrix& all_edges, const std::vector<Index>& active,
                               const std::vector<Triangle>& faces,
                               const std::vector<FaceModel>& models, Index metas,
                               const Work& work) {
  const Index samples = size_of(active);
  const Index first_meta = 1 + static_cast<Index>(all_edges.rows());
  ReducedSystem system;
  DenseMatrix edges(2 * samples, metas), pull(2 * samples, 2);
  parallel_for(work, metas, kTile, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t m = begin; m < end; ++m) {
      for (Index i = 0; i < samples; ++i) {
        edges.col(m).segment<2>(2 * i) = all_edges.col(m).segment<2>(2 * active[i]);
      }
    }
  });
  for (Index i = 0; i < samples; ++i) {
    for (int corner = 0; corner < 2; ++corner) {
      pull.row(2 * i + corner) = models[i].gradient.segment<2>(2 * corner + 2).transpose();
    }
  }
  system.gradient.resize(2 * metas);
  system.gradient.head(metas).noalias() = edges.transpose() * pull.col(0);
  system.gradient.tail(metas).noalias() = edges.transpose() * pull.col(1);

  system.hessian.setZero(2 * metas, 2 * metas);
  // (row, column) of D: u with u, v with u, v with v.
  const std::array<std::array<int, 2>, 3> blocks = {{{0, 0}, {1, 0}, {1, 1}}};
  parallel_for(work, metas, kTile, [&](std::int64_t begin, std::int64_t end) {
    const Eigen::Index width = end - begin;
    DenseMatrix scaled(2 * samples, width);
    for (const auto& [r, c] : blocks) {
      for (Eigen::Index m = 0; m < width; ++m) {
        for (Index i = 0; i < samples; ++i) {
          const Matrix6& d = models[i].hessian;
          const double e1 = edges(2 * i, begin + m), e2 = edges(2 * i + 1, begin + m);
          scaled(2 * i, m) = d(2 + r, 2 + c) * e1 + d(2 + r, 4 + c) * e2;
          scaled(2 * i + 1, m) = d(4 + r, 2 + c) * e1 + d(4 + r, 4 + c) * e2;
        }
      }
      const Eigen::Index top = r == c ? begin : 0;
      system.hessian.block(r * metas + top, c * metas + begin, metas - top, width).noalias() =
          edges.rightCols(metas - top).transpose() * scaled;
    }
  });

  const auto place = [&](Index point, int axis) { return axis * metas + point - first_meta; };
  for (Index f = samples; f < size_of(faces); ++f) {
    const Triangle& t = faces[f];
    for (int a = 0; a < 6; ++a) {
      if (t[a / 2] >= first_meta + metas) continue;
      const Index row = place(t[a / 2], a % 2);
      system.gradient[row] += models[f].gradient[a];
      for (int b = 0; b < 6; ++b) {
        if (t[b / 2] >= first_meta + metas) continue;
        const Index column = place(t[b / 2], b % 2);
        if (row >= column) system.hessian(row, column) += models[f].hessian(a, b);
      }
    }
  }
  return system;
}

std::vector<Vec2> newton_direction(ReducedSystem& system) {
  const Index metas = static_cast<Index>(system.gradient.size()) / 2;
  const Eigen::VectorXd diagonal = system.hessian.diagonal();
  const double floor = diagonal.maxCoeff() * newton::kShift;
  std::vector<Vec2> direction;
  for (double shift = newton::kShift; shift <= newton::kLargestShift; shift *= 1e2) {
    system.hessian.diagonal() =
        diagonal * (1 + shift) + Eigen::VectorXd::Constant(2 * metas, floor);
    const Eigen::LLT<DenseMatrix, Eigen::Lower> factor(system.hessian);
    if (factor.info() != Eigen::Success) continue;
    const Eigen::VectorXd flat = factor.solve(-system.gradient);
    if (!flat.allFinite()) continue;
    for (Index m = 0; m < metas; ++m) direction.push_back({flat[m], flat[metas + m]});
    break;
  }
  return direction;
}

}  // namespace beltrami
