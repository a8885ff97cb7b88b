#include "flatten/metric.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/portable_math.h"
#include "flatten/laplacian.h"
#include "flatten/principal_stiffness.h"
#include "mesh/vertex_sums.h"

namespace beltrami {
namespace {

constexpr std::int64_t kGrain = 8192;

/// The stiffness of a face whose singular values are a + b and a - b, the greater one along
/// `direction`, a unit complex twice as far from the real axis.
template <class Density>
EdgeWeights stiffness_at(const RestTriangle& rest, double a, double b, Complex direction) {
  const auto [along, across] = principal_stiffness<Density>(a, b);
  // The metric whose Laplacian has this stiffness: lengths go with the inverse roots.
  const double ratio = std::sqrt(across / along), signed_mu = (ratio - 1) / (ratio + 1);
  return edge_weights(modified_cotangents(rest, signed_mu * direction),
                      0.5 * std::sqrt(along * across));
}

std::vector<EdgeWeights> all_of(const StiffnessOfFaces& stiffness, std::size_t count,
                                const Work& work) {
  std::vector<EdgeWeights> weights;
  parallel_assign(work, weights, count);
  parallel_for(work, size_of(weights), kGrain, [&](std::int64_t begin, std::int64_t end) {
    stiffness(begin, end, weights.data() + begin);
  });
  return weights;
}

template <class Density>
EdgeWeights stiffness_at(const RestTriangle& rest, const FaceMetric& metric) {
  const double k = modulus(metric.mu);
  const Complex direction = k > 0 ? metric.mu / k : Complex(1);
  const double a = portable::exp(0.5 * metric.log_area) / std::sqrt(1 - k * k);
  return stiffness_at<Density>(rest, a, k * a, direction);
}

template <class Density>
EdgeWeights stiffness_at(const RestTriangle& rest, const LinearMap& map) {
  const double a = modulus(map.fz), b = modulus(map.fzbar);
  // Flipped: the density is infinite there, its finite part (squared singular values) is not.
  if (!(a > b)) return edge_weights(modified_cotangents(rest, 0), 1);
  const Complex direction = b > 0 ? quotient(map.fzbar, map.fz) * (a / b) : Complex(1);
  return stiffness_at<Density>(rest, a, b, direction);
}

using Rows = Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>;

Eigen::Map<const Rows> as_rows(const std::vector<Vec2>& field) {
  return {field.data()->data(), size_of(field), 2};
}
Eigen::Map<Rows> as_rows(std::vector<Vec2>& field) {
  return {field.data()->data(), size_of(field), 2};
}

Complex to_complex(const Vec2& v) {
  return {v.x(), v.y()};
}

/// The edges opposite to each corner, from the corner after it to the one before.
std::array<Complex, 3> edges(Complex p0, Complex p1, Complex p2) {
  return {p2 - p1, p0 - p2, p1 - p0};
}

std::array<Complex, 3> edges(const Triangle& t, const std::vector<Vec2>& uvs) {
  return edges(to_complex(uvs[t[0]]), to_complex(uvs[t[1]]), to_complex(uvs[t[2]]));
}

/// The same of the face laid out in its target metric.
std::array<Complex, 3> target_edges(const RestTriangle& rest, const FaceMetric& metric) {
  const Complex fz = metric.fz(), fzbar = metric.mu * fz, z = rest.corner(2);
  return edges(0, (fz + fzbar) * rest.x1, fz * z + fzbar * std::conj(z));
}

/// The unit complex that turns the target closest to the present face.
Complex fitted_rotation(const EdgeWeights& weights, const std::array<Complex, 3>& target,
                        const std::array<Complex, 3>& present) {
  Complex fit = 0;
  for (int k = 0; k < 3; ++k) fit += weights[k] * present[k] * std::conj(target[k]);
  const double length = modulus(fit);
  return length > 0 ? fit / length : Complex(1);
}

}  // namespace

std::vector<EdgeWeights> energy_stiffness(Energy energy, const std::vector<RestTriangle>& rest,
                                          const std::vector<FaceMetric>& metric, const Work& work) {
  return with_density(energy, [&]<class Density>(Density) {
    const auto some = [&](std::int64_t first, std::int64_t end, EdgeWeights* weights) {
      for (std::int64_t f = first; f < end; ++f) {
        weights[f - first] = stiffness_at<Density>(rest[f], metric[f]);
      }
    };
    return all_of(some, rest.size(), work);
  });
}

std::vector<EdgeWeights> energy_stiffness(Energy energy, const std::vector<Triangle>& faces,
                                          const std::vector<RestTriangle>& rest,
                                          const std::vector<Vec2>& uvs, const Work& work) {
  return all_of(stiffness_of_faces(energy, faces, rest, uvs), faces.size(), work);
}

StiffnessOfFaces stiffness_of_faces(Energy energy, const std::vector<Triangle>& faces,
                                    const std::vector<RestTriangle>& rest,
                                    const std::vector<Vec2>& uvs) {
  return with_density(energy, [&]<class Density>(Density) -> StiffnessOfFaces {
    return [&](std::int64_t first, std::int64_t end, EdgeWeights* weights) {
      for (std::int64_t f = first; f < end; ++f) {
        const Triangle& t = faces[f];
        const LinearMap map = linear_map(rest[f], uvs[t[0]], uvs[t[1]], uvs[t[2]]);
        weights[f - first] = stiffness_at<Density>(rest[f], map);
      }
    };
  });
}

std::vector<double> stiff_springs(const DiskMesh& mesh, const std::vector<EdgeWeights>& stiffness,
                                  const std::vector<bool>& vertices) {
  std::vector<double> springs(vertices.size(), 0);
  if (springs.empty()) return springs;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const Index v = mesh.faces[f][k];
      if (!vertices[v]) continue;
      const EdgeWeights& weights = stiffness[f];
      springs[v] += kStiffSpring * std::abs(weights[next_corner(k)] + weights[previous_corner(k)]);
    }
  }
  return springs;
}

MetricLaplacian::MetricLaplacian(const DiskMesh& mesh, const std::vector<EdgeWeights>& stiffness,
                                 const std::vector<bool>& held, const SolverOptions& options,
                                 const std::vector<double>& springs, const Work& work)
    : faces_(mesh.faces), matrix_(mesh.vertex_count(), mesh.faces, held, 1, work), work_(work) {
  assemble(stiffness, springs);
  if (matrix_.free_count() > 0)
    solver_ = factorize_laplacian(matrix_, mesh.positions, options, work);
}

void MetricLaplacian::refit(const StiffnessOfFaces& stiffness, const std::vector<double>& springs) {
  std::vector<EdgeWeights> weights = all_of(stiffness, faces_.size(), work_);
  refit(weights, springs);
  parallel_free(work_, weights);  // so that the allocator does not keep it
}

void MetricLaplacian::refit(const std::vector<EdgeWeights>& stiffness,
                            const std::vector<double>& springs) {
  if (matrix_.free_count() == 0) return;
  matrix_.set_zero(work_);
  assemble(stiffness, springs);
  refactorize_laplacian(*solver_, matrix_);
}

void MetricLaplacian::assemble(const std::vector<EdgeWeights>& stiffness,
                               const std::vector<double>& springs) {
  matrix_.add_up(work_, faces_,
                 [&](Index f, const auto& add) { add_stiffness(stiffness[f], add); });
  SparseMatrix& matrix = matrix_.matrix();
  for (Index v = 0; v < size_of(springs); ++v) {
    const Index row = matrix_.row(v);
    if (row != kNone) matrix.valuePtr()[matrix.outerIndexPtr()[row]] += springs[v];
  }
}

/// The rows of the free vertices.
template <class Rows>
DenseMatrix MetricLaplacian::packed(const Rows& rhs) const {
  const std::vector<Index>& row = matrix_.rows();
  DenseMatrix result(matrix_.free_count(), rhs.cols());
  parallel_for(work_, size_of(row), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t v = begin; v < end; ++v) {
      if (row[v] != kNone) result.row(row[v]) = rhs.row(v);
    }
  });
  return result;
}

template <class Rows>
void MetricLaplacian::unpack(const DenseMatrix& x, Rows&& result) const {
  const std::vector<Index>& row = matrix_.rows();
  parallel_for(work_, size_of(row), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t v = begin; v < end; ++v) {
      if (row[v] != kNone) result.row(v) = x.row(row[v]);
    }
  });
}

DenseMatrix MetricLaplacian::solve(const DenseMatrix& rhs) const {
  DenseMatrix x = DenseMatrix::Zero(rhs.rows(), rhs.cols());
  if (solver_) unpack(solver_->solve(packed(rhs)), x);
  return x;
}

void MetricLaplacian::solve(const std::vector<Vec2>& rhs, std::vector<Vec2>& x) const {
  x.assign(rhs.size(), Vec2::Zero());
  if (solver_) unpack(solver_->solve(packed(as_rows(rhs))), as_rows(x));
}

void MetricLaplacian::precondition(const std::vector<Vec2>& rhs, std::vector<Vec2>& x) {
  x.assign(rhs.size(), Vec2::Zero());
  if (solver_) unpack(solver_->precondition(packed(as_rows(rhs))), as_rows(x));
}

void solve_metric(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                  const std::vector<FaceMetric>& metric, const std::vector<EdgeWeights>& stiffness,
                  const MetricLaplacian& laplacian, const Anchors& anchors, bool rotate,
                  std::vector<Vec2>& uvs, const Work& work) {
  // The residual of the present map, so that held vertices need no treatment of their own.
  const auto give = [&](Index f, VertexSums::Terms& terms) {
    const EdgeWeights& weights = stiffness[f];
    const auto target = target_edges(rest[f], metric[f]);
    const auto present = edges(mesh.faces[f], uvs);
    const Complex rotation = rotate ? fitted_rotation(weights, target, present) : Complex(1);
    std::array<Complex, 3> pull;  // of each edge on its first end
    for (int k = 0; k < 3; ++k) pull[k] = weights[k] * (rotation * target[k] - present[k]);
    for (int k = 0; k < 3; ++k) {
      const Complex term = pull[next_corner(k)] - pull[previous_corner(k)];
      terms[k] = {term.real(), term.imag()};
    }
    return 0.0;
  };
  std::vector<Vec2> residual, change;
  VertexSums(mesh.vertex_count(), mesh.faces, work).add_up(give, residual);
  for (Index v = 0; v < size_of(anchors.springs); ++v) {
    residual[v] += anchors.springs[v] * (anchors.places[v] - uvs[v]);
  }
  laplacian.solve(residual, change);
  parallel_for(work, mesh.vertex_count(), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t v = begin; v < end; ++v) uvs[v] += change[v];
  });
}

}  // namespace beltrami
