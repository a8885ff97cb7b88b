#include "cut/conformal_model.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "base/interrupt.h"
#include "base/portable_math.h"
#include "flatten/intrinsic_delaunay.h"
#include "flatten/laplacian.h"
#include "linear/mesh_matrix.h"
#include "linear/shifted_factor.h"
#include "mesh/rest_shape.h"

namespace beltrami {
namespace {

/// A pinned vertex is held by a spring so many times as stiff as a vertex of average weight: what
/// it yields is below what the model is good for, and the pattern of the matrix stays.
constexpr double kPinned = 1e7;
/// Beyond, the squares of factors are no numbers.
constexpr double kMostFactor = 300;
/// A map that is free to be no conformal one is less distorted: the part of the factors that
/// counts. Seams were shortest with it on 20 scans, sculpted meshes and CAD parts (0.25 to 0.7
/// tried).
constexpr double kRealShare = 0.4;

double corner_angle(const RestTriangle& rest, int k) {
  const Complex to = rest.corner(next_corner(k)) - rest.corner(k);
  const Complex from = rest.corner(previous_corner(k)) - rest.corner(k);
  const Complex turn = from * std::conj(to);
  return portable::atan2(turn.imag(), turn.real());
}

}  // namespace

ConformalModel::ConformalModel(const Surface& surface, Index real_faces, const Work& work)
    : surface_(surface),
      area_(Eigen::VectorXd::Zero(surface.vertex_count())),
      defect_(Eigen::VectorXd::Zero(surface.vertex_count())),
      solver_(make_spd_solver({}, work)) {
  const auto rest = rest_triangles(surface.positions, surface.faces, work);
  for (Index v = 0; v < surface.vertex_count(); ++v) {
    defect_[v] = surface.on_boundary[v] ? 0 : 2 * std::numbers::pi;
  }
  std::vector<Cotangents> cotangents;
  for (Index f = 0; f < surface.face_count(); ++f) {
    for (int k = 0; k < 3; ++k) {
      defect_[surface.faces[f][k]] -= corner_angle(rest[f], k);
      if (f < real_faces) area_[surface.faces[f][k]] += rest[f].area() / 3;
    }
    cotangents.push_back(modified_cotangents(rest[f], 0));
  }
  area_ /= area_.sum();
  const DelaunayTriangulation delaunay = intrinsic_delaunay(surface, std::move(cotangents), work);
  std::vector<Eigen::Triplet<double>> entries;
  for (Index f = 0; f < size_of(delaunay.faces); ++f) {
    const Triangle& face = delaunay.faces[f];
    add_stiffness(edge_weights(delaunay.cotangents[f], 0.5), [&](int i, int j, const auto& entry) {
      entries.emplace_back(face[i], face[j], entry(0, 0));
      if (i != j) entries.emplace_back(face[j], face[i], entry(0, 0));
    });
  }
  // Vertices that no face names have an entry, too: they are pinned.
  for (Index v = 0; v < surface.vertex_count(); ++v) entries.emplace_back(v, v, 0);
  laplacian_.resize(surface.vertex_count(), surface.vertex_count());
  laplacian_.setFromTriplets(entries.begin(), entries.end());
  std::vector<Place> places;
  for (const Vec3& p : surface.positions) places.push_back(place_of(p));
  solver_->analyze(laplacian_.triangularView<Eigen::Lower>(), places);
}

void ConformalModel::pin(const std::vector<bool>& pinned) {
  pinned_ = pinned;
  SparseMatrix held = laplacian_.triangularView<Eigen::Lower>();
  const double spring = kPinned * laplacian_.diagonal().mean();
  Eigen::VectorXd force = -defect_;
  for (Index v = 0; v < surface_.vertex_count(); ++v) {
    if (surface_.on_boundary[v] || surface_.outgoing[v] == kNone) pinned_[v] = true;
    if (!pinned_[v]) continue;
    held.coeffRef(v, v) += spring;
    force[v] = 0;
  }
  poll_interrupt();
  if (factorize_shifted(*solver_, held) < 0) {
    throw Error(Fault::kSolver, "the Laplacian of the coarse surface is not definite");
  }
  const Eigen::VectorXd u = solver_->solve(force);
  u_.assign(u.begin(), u.end());
  energy_ = energy_of(u);
}

double ConformalModel::energy_of(const Eigen::VectorXd& u) const {
  double stretched = 0, shrunk = 0;
  for (Eigen::Index v = 0; v < u.size(); ++v) {
    if (area_[v] == 0) continue;
    const double factor =
        portable::exp(2 * kRealShare * std::clamp(u[v], -kMostFactor, kMostFactor));
    stretched += area_[v] * factor;
    shrunk += area_[v] / factor;
  }
  return 2 * std::sqrt(stretched * shrunk);
}

double ConformalModel::energy_with(std::span<const Index> vertices) const {
  const auto count = static_cast<Eigen::Index>(vertices.size());
  SparseMatrix unit(surface_.vertex_count(), count);
  Eigen::VectorXd there(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    unit.insert(vertices[i], i) = 1;
    there[i] = u_[vertices[i]];
  }
  unit.makeCompressed();
  poll_interrupt();
  const DenseMatrix among = solver_->solve_rows(unit, {vertices.begin(), vertices.end()});
  const Eigen::VectorXd force = unit * among.ldlt().solve(there).eval();
  Eigen::VectorXd u = Eigen::Map<const Eigen::VectorXd>(u_.data(), size_of(u_));
  u -= solver_->solve(force);
  return energy_of(u);
}

double ConformalModel::energy_without(std::span<const Index> vertices) const {
  const auto count = static_cast<Eigen::Index>(vertices.size());
  SparseMatrix coupling(surface_.vertex_count(), count);  // to vertices that are not pinned
  DenseMatrix among = DenseMatrix::Zero(count, count);
  std::vector<int> around;
  for (Eigen::Index i = 0; i < count; ++i) {
    for (SparseMatrix::InnerIterator entry(laplacian_, vertices[i]); entry; ++entry) {
      const auto other = static_cast<Index>(entry.row());
      if (!pinned_[other]) {
        coupling.insert(other, i) = entry.value();
        around.push_back(other);
      } else {
        const auto j = std::find(vertices.begin(), vertices.end(), other) - vertices.begin();
        if (j < count) among(j, i) = entry.value();
      }
    }
  }
  coupling.makeCompressed();
  std::sort(around.begin(), around.end());
  around.erase(std::unique(around.begin(), around.end()), around.end());
  DenseMatrix near = DenseMatrix::Zero(size_of(around), count);
  for (Eigen::Index i = 0; i < count; ++i) {
    for (SparseMatrix::InnerIterator entry(coupling, i); entry; ++entry) {
      near(std::lower_bound(around.begin(), around.end(), entry.row()) - around.begin(), i) =
          entry.value();
    }
  }
  poll_interrupt();
  among -= near.transpose() * solver_->solve_rows(coupling, around);
  Eigen::VectorXd u = Eigen::Map<const Eigen::VectorXd>(u_.data(), size_of(u_));
  Eigen::VectorXd force = -(coupling.transpose() * u);
  for (Eigen::Index i = 0; i < count; ++i) force[i] -= defect_[vertices[i]];
  const Eigen::VectorXd freed = among.ldlt().solve(force);
  u -= solver_->solve(Eigen::VectorXd(coupling * freed));
  for (Eigen::Index i = 0; i < count; ++i) u[vertices[i]] = freed[i];
  return energy_of(u);
}

std::vector<double> ConformalModel::gains() const {
  Eigen::VectorXd slope = Eigen::VectorXd::Zero(surface_.vertex_count());
  double stretched = 0, shrunk = 0;
  std::vector<double> factors(u_.size(), 1);
  for (std::size_t v = 0; v < u_.size(); ++v) {
    factors[v] = portable::exp(2 * kRealShare * std::clamp(u_[v], -kMostFactor, kMostFactor));
    stretched += area_[v] * factors[v];
    shrunk += area_[v] / factors[v];
  }
  for (std::size_t v = 0; v < u_.size(); ++v) {
    slope[v] = area_[v] * (factors[v] / stretched - 1 / (factors[v] * shrunk));
  }
  const Eigen::VectorXd pull = solver_->solve(slope);
  std::vector<double> gains(u_.size(), 0);
  for (std::size_t v = 0; v < u_.size(); ++v) {
    if (!pinned_[v]) gains[v] = pull[v] * u_[v];
  }
  return gains;
}

}  // namespace beltrami
