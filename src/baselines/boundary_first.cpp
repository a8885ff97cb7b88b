// The steps and their names (Cherrier formula, Poincare-Steklov operators, best fit curve) are
// those of Sawhney & Crane 2017.
#include "baselines/boundary_first.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>

#include "base/error.h"
#include "base/portable_math.h"
#include "base/types.h"
#include "flatten/laplacian.h"
#include "flatten/metric.h"
#include "linear/spd_solver.h"

namespace beltrami {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kClosingSteps = 60;   // Newton in two unknowns: 3 to 6 on curves that nearly close
constexpr double kClosed = 1e-14;   // of the length; the rest is spread over the vertices
constexpr double kLeastArea = 0.2;  // of an ear by itself, below which mean lengths are not used
constexpr double kGreatestSlope = 8.0;  // of the logarithms: beyond it edges differ by e^16

/// Squared length of a half-edge under the full linear map of its face.
double mapped_length_sq(const std::vector<RestTriangle>& rest,
                        const std::vector<FaceMetric>& metric, Index halfedge) {
  const RestTriangle& face = rest[halfedge / 3];
  const FaceMetric& m = metric[halfedge / 3];
  const Complex z = face.corner(next_corner(halfedge % 3)) - face.corner(halfedge % 3);
  return std::norm(z + m.mu * std::conj(z)) * portable::exp(m.log_area) / (1 - std::norm(m.mu));
}

/// The one squared length of an edge: the geometric mean over its faces, since a prolonged metric
/// jumps between them.
double edge_length_sq(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                      const std::vector<FaceMetric>& metric, Index halfedge) {
  const double here = mapped_length_sq(rest, metric, halfedge);
  const Index twin = mesh.twin[halfedge];
  return twin == kNone ? here : std::sqrt(here * mapped_length_sq(rest, metric, twin));
}

/// The Laplacian of the conformal class, its boundary held: the area factors are left out, which
/// weight an elastic energy but have no part in a conformal map.
MetricLaplacian conformal_laplacian(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                                    const std::vector<FaceMetric>& metric, const Work& work) {
  std::vector<EdgeWeights> weights;
  weights.reserve(rest.size());
  for (const Cotangents& face : modified_cotangents(rest, metric, work)) {
    weights.push_back(edge_weights(face, 0.5));
  }
  return MetricLaplacian(mesh, weights, mesh.on_boundary, {Precision::kSingle}, {}, work);
}

/// A x for the Laplacian A of all vertices: nothing of it is stored but the factor of its interior
/// block, since it is applied three times only.
DenseMatrix laplacian_times(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                            const std::vector<FaceMetric>& metric, const DenseMatrix& x) {
  DenseMatrix product = DenseMatrix::Zero(x.rows(), x.cols());
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const auto cotangents = modified_cotangents(rest[f], metric[f].mu);
    for (int k = 0; k < 3; ++k) {
      const Index i = mesh.faces[f][next_corner(k)], j = mesh.faces[f][previous_corner(k)];
      for (Eigen::Index c = 0; c < x.cols(); ++c) {
        const double flow = 0.5 * cotangents[k] * (x(i, c) - x(j, c));
        product(i, c) += flow;
        product(j, c) -= flow;
      }
    }
  }
  return product;
}

/// 16 times the squared area of the triangle with these squared edge lengths; not positive where
/// the triangle inequality fails. (Kahan's order of operations: needles keep their area to
/// roundoff.)
double area_sq_16(const std::array<double, 3>& length_sq) {
  std::array<double, 3> length;
  for (int k = 0; k < 3; ++k) length[k] = std::sqrt(length_sq[k]);
  std::sort(length.begin(), length.end(), std::greater<>());
  const auto [a, b, c] = length;
  return (a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c));
}

/// Angles of a face from the one length of each edge; where these make no triangle, pi opposite to
/// the longest edge and 0, as in the limit. A face with all corners on the boundary (an ear) would
/// then be laid out collinear with nothing to open it again: it keeps the angles it has by itself.
/// Each way they sum to pi.
std::array<double, 3> angles(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                             const std::vector<FaceMetric>& metric, Index face) {
  std::array<double, 3> mean, own;  // squared lengths, edge k from corner k to k + 1
  for (int k = 0; k < 3; ++k) {
    mean[k] = edge_length_sq(mesh, rest, metric, 3 * face + k);
    own[k] = mapped_length_sq(rest, metric, 3 * face + k);
  }
  const Triangle& t = mesh.faces[face];
  const bool ear = mesh.on_boundary[t[0]] && mesh.on_boundary[t[1]] && mesh.on_boundary[t[2]];
  const double own_area = std::max(area_sq_16(own), 0.0);
  const double mean_area = std::max(area_sq_16(mean), 0.0);
  const bool proper = !ear || mean_area > kLeastArea * kLeastArea * own_area;
  const std::array<double, 3>& length_sq = proper ? mean : own;
  const double area_4 = std::sqrt(proper ? mean_area : own_area);
  std::array<double, 3> result;
  for (int k = 0; k < 3; ++k) {
    const int next = next_corner(k), previous = previous_corner(k);
    result[k] = portable::atan2(area_4, length_sq[k] + length_sq[previous] - length_sq[next]);
  }
  return result;
}

/// Integrated curvatures: Gaussian 2 pi - sum of the angles inside, geodesic
/// pi - sum on the boundary; in total 2 pi. Taken with one length per edge from the full metric.
/// Angles of faces laid out one by one will not do: for the metric of a map they sum to 2 pi at
/// every inner vertex whatever its factors are, and the factors would be counted twice. With
/// compatible lengths the metric is flat, and the map that has it is reproduced exactly.
DenseMatrix curvatures(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                       const std::vector<FaceMetric>& metric) {
  DenseMatrix curvature(mesh.vertex_count(), 1);
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    curvature(v, 0) = mesh.on_boundary[v] ? kPi : 2 * kPi;
  }
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const auto angle = angles(mesh, rest, metric, f);
    for (int k = 0; k < 3; ++k) curvature(mesh.faces[f][k], 0) -= angle[k];
  }
  return curvature;
}

/// Log conformal factors that the lengths ask for, zero inside. Lengths belong to edges, factors to
/// vertices: the mean of both edges, weighted by length as an integral over the boundary would be.
DenseMatrix boundary_factors(const DiskMesh& mesh, const std::vector<double>& base,
                             const std::vector<double>& lengths) {
  DenseMatrix factors = DenseMatrix::Zero(mesh.vertex_count(), 1);
  for (std::size_t i = 0; i < base.size(); ++i) {
    const std::size_t before = i == 0 ? base.size() - 1 : i - 1;
    factors(mesh.boundary[i], 0) = (base[before] * portable::log(lengths[before] / base[before]) +
                                    base[i] * portable::log(lengths[i] / base[i])) /
                                   (base[before] + base[i]);
  }
  return factors;
}

/// Unit tangent of each boundary edge from the exterior angle at the vertex where it starts.
/// (The angles sum to 2 pi by Gauss-Bonnet; what roundoff leaves is spread.)
std::vector<Vec2> integrate_tangents(const std::vector<double>& exterior_angles) {
  const double total = std::accumulate(exterior_angles.begin(), exterior_angles.end(), 0.0);
  const double spread = (2 * kPi - total) / static_cast<double>(exterior_angles.size());
  std::vector<Vec2> tangents(exterior_angles.size());
  double direction = 0;
  for (std::size_t i = 0; i < tangents.size(); ++i) {
    if (i > 0) direction += exterior_angles[i] + spread;
    tangents[i] = {portable::cos(direction), portable::sin(direction)};
  }
  return tangents;
}

Vec2 gap(const std::vector<Vec2>& tangents, const std::vector<double>& lengths) {
  Vec2 sum = Vec2::Zero();
  for (std::size_t i = 0; i < lengths.size(); ++i) sum += lengths[i] * tangents[i];
  return sum;
}

/// Sum of the lengths after the factors exp(-slope . tangent), with its derivatives in `slope`.
struct ClosingEnergy {
  double value = 0;
  Vec2 gradient = Vec2::Zero();  ///< minus the gap of the curve with the new lengths
  Eigen::Matrix2d hessian = Eigen::Matrix2d::Zero();

  ClosingEnergy(const std::vector<Vec2>& tangents, const std::vector<double>& lengths,
                const Vec2& slope) {
    for (std::size_t i = 0; i < lengths.size(); ++i) {
      const Vec2& t = tangents[i];
      const double length = lengths[i] * portable::exp(-slope.dot(t));
      value += length;
      gradient -= length * t;
      hessian += length * t * t.transpose();
    }
  }
};

/// Changes the lengths by the least factors that close the curve. The paper takes
/// the least squares l - l* weighted by 1 / l*, whose solution l* (1 - slope . t) turns negative on
/// curves far from closed. The least relative entropy has the solution l* exp(-slope . t), always
/// positive, where `slope` minimises a convex function of two unknowns; its first Newton step is
/// the paper's. It has no minimum if all tangents lie in a half-plane: the lengths then stay.
void close_lengths(const std::vector<Vec2>& tangents, std::vector<double>& lengths) {
  Vec2 slope = Vec2::Zero();
  ClosingEnergy energy(tangents, lengths, slope);
  for (int step = 0; step < kClosingSteps; ++step) {
    if (energy.gradient.norm() <= kClosed * energy.value) break;
    const Vec2 direction = -energy.hessian.inverse() * energy.gradient;
    if (!direction.allFinite()) return;
    // Tangents are of unit length: within a step of 1 no factor changes by more than e.
    double t = std::min(1.0, 1 / direction.norm());
    ClosingEnergy next(tangents, lengths, slope + t * direction);
    const double descent = 1e-4 * energy.gradient.dot(direction);
    while (next.value > energy.value + t * descent && t > 1e-3) {
      t *= 0.5;
      next = ClosingEnergy(tangents, lengths, slope + t * direction);
    }
    if (next.gradient.norm() >= energy.gradient.norm() && next.value >= energy.value) break;
    slope += t * direction;
    energy = next;
    if (slope.norm() > kGreatestSlope) return;
  }
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    lengths[i] *= portable::exp(-slope.dot(tangents[i]));
  }
}

/// The boundary vertices of the curve; what is missing to close it is spread by arc length.
void place_boundary(const DiskMesh& mesh, const std::vector<Vec2>& tangents,
                    const std::vector<double>& lengths, DenseMatrix& places) {
  const double total = std::accumulate(lengths.begin(), lengths.end(), 0.0);
  const Vec2 drift = gap(tangents, lengths) / total;
  Vec2 place = Vec2::Zero();
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    places.row(mesh.boundary[i]) = place.transpose();
    place += lengths[i] * (tangents[i] - drift);
  }
}

}  // namespace

std::vector<double> metric_boundary_lengths(const DiskMesh& mesh,
                                            const std::vector<RestTriangle>& rest,
                                            const std::vector<FaceMetric>& metric) {
  std::vector<double> lengths(mesh.boundary.size());
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    lengths[i] = std::sqrt(mapped_length_sq(rest, metric, mesh.outgoing[mesh.boundary[i]]));
  }
  return lengths;
}

BoundaryFirstResult flatten_boundary_first(const DiskMesh& mesh,
                                           const std::vector<RestTriangle>& rest,
                                           const std::vector<FaceMetric>& metric,
                                           const std::vector<double>& boundary_lengths,
                                           const Work& work) {
  work.report(0);
  const MetricLaplacian laplacian = conformal_laplacian(mesh, rest, metric, work);
  work.report(0.7);

  // The Yamabe equation with the factors held on the boundary, and what the Cherrier formula says
  // of the boundary: k~ = k - h, h the Neumann data of the factors (a Dirichlet-to-Neumann map).
  const DenseMatrix curvature = curvatures(mesh, rest, metric);
  DenseMatrix factors =
      boundary_factors(mesh, metric_boundary_lengths(mesh, rest, metric), boundary_lengths);
  factors += laplacian.solve(-curvature - laplacian_times(mesh, rest, metric, factors));
  const DenseMatrix flat = curvature + laplacian_times(mesh, rest, metric, factors);
  work.report(0.85);

  std::vector<double> exterior_angles(mesh.boundary.size());
  for (std::size_t i = 0; i < exterior_angles.size(); ++i) {
    exterior_angles[i] = flat(mesh.boundary[i], 0);
  }
  const std::vector<Vec2> tangents = integrate_tangents(exterior_angles);
  std::vector<double> lengths = boundary_lengths;
  BoundaryFirstResult result;
  result.closure_defect =
      gap(tangents, lengths).norm() / std::accumulate(lengths.begin(), lengths.end(), 0.0);
  close_lengths(tangents, lengths);

  DenseMatrix places = DenseMatrix::Zero(mesh.vertex_count(), 2);
  place_boundary(mesh, tangents, lengths, places);
  // Both coordinates harmonic. The paper's other extension, the conjugate of the first coordinate,
  // differs in energy by less than 0.5% in most metrics that are resolved, in either direction; it
  // takes a second factorization, of the whole Laplacian, and lets go of the lengths.
  places -= laplacian.solve(laplacian_times(mesh, rest, metric, places));
  if (!places.allFinite()) {
    throw Error(Fault::kSolver,
                "boundary first flattening went out of the range of floating point: the faces of "
                "the mesh are too degenerate; try the method cm");
  }
  result.uvs.resize(mesh.vertex_count());
  for (Index v = 0; v < mesh.vertex_count(); ++v) result.uvs[v] = places.row(v).transpose();
  work.report(1);
  return result;
}

}  // namespace beltrami
