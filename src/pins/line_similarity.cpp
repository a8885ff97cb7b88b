#include "pins/line_similarity.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>
#include <utility>

#include "base/portable_math.h"

namespace beltrami {
namespace {

/// Turns that are tried first, then the best is refined by parts of the step between them.
constexpr int kTurns = 72, kRefinements = 30;
/// Places that differ by less than this share of the points say nothing of the scale.
constexpr double kNoSpread = 1e-6;
/// What the square of the scale's logarithm counts, beside the share of the points' spread that is
/// left between them and their lines: of turns that fit alike the one that leaves the scale wins.
constexpr double kScaleCost = 1e-3;
/// Where more than this share of the spread is left, the places say nothing of the scale, either.
constexpr double kNoFit = 0.5;

struct Fit {
  double error = std::numeric_limits<double>::infinity();
  double left = 1;  ///< share of the spread
  double inverse_scale = 1;
  Vec2 shift = Vec2::Zero();  ///< of the turned map, before it is scaled
};

/// The best of one turn: n . (turn z + shift) = q n . place in the least squares, for the shift and
/// with `scaled` for q as well.
Fit fit_at(const std::vector<LineFit>& fits, Complex turn, bool scaled) {
  const int unknowns = scaled ? 3 : 2;
  Eigen::MatrixXd rows(size_of(fits), unknowns);
  Eigen::VectorXd right(size_of(fits));
  for (Index i = 0; i < size_of(fits); ++i) {
    const LineFit& fit = fits[i];
    const Complex z = turn * Complex(fit.point.x(), fit.point.y());
    const double along = fit.normal.x() * z.real() + fit.normal.y() * z.imag();
    rows(i, 0) = fit.normal.x();
    rows(i, 1) = fit.normal.y();
    if (scaled) rows(i, 2) = -fit.normal.dot(fit.place);
    right[i] = (scaled ? 0 : fit.normal.dot(fit.place)) - along;
  }
  // The shortest solution where lines leave one open.
  const Eigen::VectorXd x = rows.completeOrthogonalDecomposition().solve(right);
  Fit best;
  best.error = (rows * x - right).squaredNorm();
  best.shift = {x[0], x[1]};
  if (!scaled) return best;
  const Eigen::VectorXd apart =
      right - rows.leftCols(2) * rows.leftCols(2).completeOrthogonalDecomposition().solve(right);
  best.inverse_scale = x[2];
  if (!(x[2] > 0 && apart.squaredNorm() > 0)) return {};
  best.left = best.error / apart.squaredNorm();
  const double times = portable::log(x[2]);
  best.error = best.left + kScaleCost * times * times;
  return best;
}

/// Whether the places of parallel lines, or of points, lie apart enough to tell a scale.
bool tells_scale(const std::vector<LineFit>& fits) {
  Vec2 middle = Vec2::Zero();
  for (const LineFit& fit : fits) middle += fit.point / static_cast<double>(fits.size());
  double size = 0;
  for (const LineFit& fit : fits) size = std::max(size, (fit.point - middle).norm());
  // What no shift takes away of the places.
  Eigen::MatrixXd rows(size_of(fits), 2);
  Eigen::VectorXd places(size_of(fits));
  for (Index i = 0; i < size_of(fits); ++i) {
    rows.row(i) = fits[i].normal.transpose();
    places[i] = fits[i].normal.dot(fits[i].place);
  }
  const Eigen::VectorXd shift = rows.completeOrthogonalDecomposition().solve(places);
  return (rows * shift - places).cwiseAbs().maxCoeff() > kNoSpread * size;
}

Complex turn_of(double angle) {
  return {portable::cos(angle), portable::sin(angle)};
}

/// The best turn, and its angle.
std::pair<Fit, double> best_turn(const std::vector<LineFit>& fits, bool scaled) {
  double step = 2 * std::numbers::pi / kTurns, angle = 0;
  Fit best = fit_at(fits, 1, scaled);
  const auto consider = [&](double other) {
    const Fit fit = fit_at(fits, turn_of(other), scaled);
    if (!(fit.error < best.error)) return false;
    best = fit;
    angle = other;
    return true;
  };
  for (int k = 1; k < kTurns; ++k) consider(step * k);
  for (int k = 0; k < kRefinements; ++k) {
    const double from = angle;
    if (!consider(from + step) && !consider(from - step)) step /= 2;
  }
  return {best, angle};
}

}  // namespace

LineSimilarity fit_to_lines(const std::vector<LineFit>& fits) {
  auto [best, angle] = best_turn(fits, tells_scale(fits));
  if (!(best.left <= kNoFit)) std::tie(best, angle) = best_turn(fits, false);
  const double scale = 1 / best.inverse_scale;
  return {scale * turn_of(angle), scale * best.shift};
}

}  // namespace beltrami
