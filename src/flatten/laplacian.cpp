#include "flatten/laplacian.h"

#include "base/error.h"
#include "base/interrupt.h"
#include "base/parallel.h"
#include "linear/shifted_factor.h"
#include "linear/spd_solver.h"

namespace beltrami {
namespace {

constexpr std::int64_t kGrain = 8192;

}  // namespace

Cotangents modified_cotangents(const RestTriangle& rest, Complex mu) {
  Cotangents cotangents;
  for (int k = 0; k < 3; ++k) {
    const Complex v1 = rest.corner(next_corner(k)) - rest.corner(k);
    const Complex v2 = rest.corner(previous_corner(k)) - rest.corner(k);
    const Complex q = (v1 + mu * std::conj(v1)) * std::conj(v2 + mu * std::conj(v2));
    cotangents[k] = -q.real() / q.imag();
  }
  return cotangents;
}

std::vector<Cotangents> modified_cotangents(const std::vector<RestTriangle>& rest,
                                            const std::vector<FaceMetric>& metric,
                                            const Work& work) {
  std::vector<Cotangents> cotangents;
  parallel_assign(work, cotangents, rest.size());
  parallel_for(work, size_of(rest), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t f = begin; f < end; ++f) {
      cotangents[f] = modified_cotangents(rest[f], metric[f].mu);
    }
  });
  return cotangents;
}

std::unique_ptr<SpdSolver> factorize_laplacian(MeshMatrix& laplacian,
                                               const std::vector<Vec3>& positions,
                                               const SolverOptions& options, const Work& work) {
  auto solver = make_spd_solver(options, work);
  poll_interrupt();
  solver->analyze(laplacian.matrix(), laplacian.places(positions));
  refactorize_laplacian(*solver, laplacian);
  return solver;
}

void refactorize_laplacian(SpdSolver& solver, MeshMatrix& laplacian) {
  poll_interrupt();
  if (factorize_shifted(solver, laplacian.matrix()) >= 0) return;
  throw Error(Fault::kSolver,
              "the Laplacian of the fine mesh is not definite in floating point: its faces are too "
              "degenerate; try the method cm");
}

}  // namespace beltrami
