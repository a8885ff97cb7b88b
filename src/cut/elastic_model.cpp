#include "cut/elastic_model.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "base/error.h"
#include "base/interrupt.h"
#include "base/portable_math.h"
#include "base/vectors.h"
#include "cut/bilaplacian.h"
#include "flatten/intrinsic_delaunay.h"
#include "flatten/laplacian.h"
#include "linear/evaluated.h"
#include "linear/mesh_matrix.h"
#include "linear/shifted_factor.h"
#include "mesh/rest_shape.h"

namespace beltrami {
namespace {

/// A pinned vertex is held by a spring so many times as stiff as a vertex of average weight: what
/// it yields is below what the model is good for, and the pattern of the matrix stays.
constexpr double kPinned = 1e7;
/// What virtual faces weigh of their area: with nothing the sheet there would be infinitely soft.
constexpr double kVirtualArea = 1e-3;
/// The least area of a vertex, of their mean.
constexpr double kLeastArea = 1e-6;
/// The cotangents of the angles of slivers, at most: they are squared, and with 1e7 the factor
/// keeps nothing of the rest.
constexpr double kMostCotangent = 1e3;

/// Energies are compared over such a distance, in roots of the area, but over this many edges at
/// most.
constexpr double kAround = 0.05;
constexpr int kMostAround = 40;
/// Where both energies are small nothing is learnt: so much of the mean, or of this, is added.
constexpr double kNoise = 0.15, kLeastMean = 1e-4;
/// What strain costs is within so many times of what it was taken for.
constexpr double kMostPrice = 10;

double corner_angle(const RestTriangle& rest, int k) {
  const Complex to = rest.corner(next_corner(k)) - rest.corner(k);
  const Complex from = rest.corner(previous_corner(k)) - rest.corner(k);
  const Complex turn = from * std::conj(to);
  return portable::atan2(turn.imag(), turn.real());
}

}  // namespace

double ModelChange::energy_of(std::ptrdiff_t first, std::ptrdiff_t count) const {
  const auto load = load_.segment(first, count);
  const auto factor = matrix_.block(first, first, count, count).ldlt();
  const double change = 2 * load.dot(factor.solve(load));
  if (!factor.isPositive() || !(change >= 0)) {
    return sign_ < 0 ? energy_ : std::numeric_limits<double>::infinity();
  }
  return std::max(energy_ + sign_ * change, 2.0);
}

ElasticModel::ElasticModel(const Surface& surface, Index real_faces, const Work& work)
    : surface_(surface), work_(work), defect_(Eigen::VectorXd::Zero(surface.vertex_count())) {
  const Index count = surface.vertex_count();
  const auto rest = rest_triangles(surface.positions, surface.faces, work);
  Eigen::VectorXd area = Eigen::VectorXd::Zero(count);
  double whole = 0;  // that of the real faces
  std::vector<Cotangents> cotangents;
  for (Index v = 0; v < count; ++v) {
    defect_[v] = surface.on_boundary[v] ? 0 : 2 * std::numbers::pi;
  }
  for (Index f = 0; f < surface.face_count(); ++f) {
    const double weighed = (f < real_faces ? 1 : kVirtualArea) * rest[f].area();
    whole += f < real_faces ? rest[f].area() : 0;
    for (int k = 0; k < 3; ++k) {
      defect_[surface.faces[f][k]] -= corner_angle(rest[f], k);
      area[surface.faces[f][k]] += weighed / 3;
    }
    cotangents.push_back(modified_cotangents(rest[f], 0));
  }
  const DelaunayTriangulation delaunay = intrinsic_delaunay(surface, std::move(cotangents), work);
  std::vector<Eigen::Triplet<double>> entries;
  for (Index f = 0; f < size_of(delaunay.faces); ++f) {
    const Triangle& face = delaunay.faces[f];
    Cotangents bounded = delaunay.cotangents[f];
    for (double& c : bounded) c = std::clamp(c, -kMostCotangent, kMostCotangent);
    add_stiffness(edge_weights(bounded, 0.5), [&](int i, int j, const auto& entry) {
      entries.emplace_back(face[i], face[j], entry(0, 0));
      if (i != j) entries.emplace_back(face[j], face[i], entry(0, 0));
    });
  }
  // Vertices that no face names have an entry, too: they are pinned.
  for (Index v = 0; v < count; ++v) entries.emplace_back(v, v, 0);
  SparseMatrix laplacian(count, count);
  laplacian.setFromTriplets(entries.begin(), entries.end());
  area_ = area.array().max(kLeastArea * area.mean()) / whole;
  price_ = Eigen::VectorXd::Ones(count);
  laplacian_.swap(laplacian);
  assemble();
}

ElasticModel::ElasticModel(const ElasticModel& other, const Work& work)
    : surface_(other.surface_),
      work_(work),
      defect_(other.defect_),
      laplacian_(other.laplacian_),
      area_(other.area_),
      price_(other.price_),
      bilaplacian_(other.bilaplacian_),
      lower_(other.lower_),
      pinned_(other.pinned_) {}

/// In proportion to the price of strain the stress yields less, for the same curvature.
void ElasticModel::assemble() {
  bilaplacian_ = bilaplacian(laplacian_, area_.cwiseProduct(price_).cwiseInverse());
  lower_ = bilaplacian_.triangularView<Eigen::Lower>();
}

/// What each vertex has goes to those around it, by as many steps as lead over the distance.
Eigen::VectorXd ElasticModel::spread(Eigen::VectorXd field) const {
  // As if all faces were equilateral: 4 / sqrt(3) times the area of one.
  const double edge_squared = 2.3 / std::max<double>(surface_.face_count(), 1);
  const int steps = std::clamp(static_cast<int>(kAround * kAround / edge_squared), 1, kMostAround);
  std::vector<int> degree(static_cast<std::size_t>(field.size()));
  for (Index h = 0; h < size_of(surface_.twin); ++h) ++degree[surface_.origin(h)];
  for (int i = 0; i < steps; ++i) {
    poll_interrupt();
    Eigen::VectorXd next = field / 2;
    for (Index h = 0; h < size_of(surface_.twin); ++h) {
      const Index from = surface_.origin(h);
      next[surface_.target(h)] += field[from] / (2 * degree[from]);
    }
    field.swap(next);
  }
  return field;
}

/// The root of the ratio is taken: strain leaves the places where it has become dear, and a whole
/// step would leave the energy of the model too low.
void ElasticModel::calibrate(const std::vector<double>& excess) {
  const Sheet& sheet = this->sheet();
  const auto count = static_cast<Eigen::Index>(excess.size());
  const Eigen::VectorXd strain =
      laplacian_ * Eigen::Map<const Eigen::VectorXd>(sheet.stress.data(), count);
  const Eigen::VectorXd model =
      spread(2 * strain.cwiseAbs2().cwiseQuotient(area_.cwiseProduct(price_)));
  const Eigen::VectorXd real = spread(Eigen::Map<const Eigen::VectorXd>(excess.data(), count));
  const double noise = kNoise * std::max(real.sum(), kLeastMean);
  for (Eigen::Index v = 0; v < count; ++v) {
    const double ratio = (real[v] + noise * area_[v]) / (model[v] + noise * area_[v]);
    price_[v] = std::clamp(price_[v] * std::sqrt(ratio), 1 / kMostPrice, kMostPrice);
  }
  now_.pinned.clear();
  before_.pinned.clear();
  assemble();
}

ElasticModel::Sheet ElasticModel::unpinned() const {
  Sheet sheet;
  sheet.solver = make_spd_solver({}, work_);
  std::vector<Place> places;
  for (const Vec3& p : surface_.positions) places.push_back(place_of(p));
  sheet.solver->analyze(lower_, places);
  return sheet;
}

void ElasticModel::pin(std::vector<bool> pinned) {
  for (Index v = 0; v < surface_.vertex_count(); ++v) {
    if (surface_.on_boundary[v] || surface_.outgoing[v] == kNone) pinned[v] = true;
  }
  pinned_ = std::move(pinned);
}

const ElasticModel::Sheet& ElasticModel::sheet() const {
  if (pinned_ == now_.pinned) return now_;
  std::swap(now_, before_);
  if (pinned_ == now_.pinned) return now_;
  if (!now_.solver) now_ = unpinned();
  now_.pinned.clear();
  SparseMatrix held = evaluated(lower_);
  const double spring = kPinned * bilaplacian_.diagonal().mean();
  Eigen::VectorXd force = defect_;
  for (Index v = 0; v < surface_.vertex_count(); ++v) {
    if (!pinned_[v]) continue;
    held.valuePtr()[held.outerIndexPtr()[v]] += spring;  // the first of its column
    force[v] = 0;
  }
  poll_interrupt();
  if (factorize_shifted(*now_.solver, held) < 0) {
    throw Error(Fault::kSolver, "the model of the coarse surface is not definite");
  }
  const Eigen::VectorXd stress = now_.solver->solve(force);
  now_.stress.assign(stress.begin(), stress.end());
  now_.energy = 2 + 2 * std::max(force.dot(stress), 0.0);
  now_.pinned = pinned_;
  return now_;
}

ModelChange ElasticModel::with(std::span<const Index> vertices) const {
  const Sheet& sheet = this->sheet();
  const auto count = static_cast<Eigen::Index>(vertices.size());
  SparseMatrix unit(surface_.vertex_count(), count);
  Eigen::VectorXd there(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    unit.insert(vertices[i], i) = 1;
    there[i] = sheet.stress[vertices[i]];
  }
  unit.makeCompressed();
  poll_interrupt();
  DenseMatrix among = sheet.solver->solve_rows(unit, {vertices.begin(), vertices.end()});
  return {sheet.energy, std::move(there), std::move(among), -1};
}

ModelChange ElasticModel::without(std::span<const Index> vertices) const {
  const Sheet& sheet = this->sheet();
  const auto count = static_cast<Eigen::Index>(vertices.size());
  SparseMatrix coupling(surface_.vertex_count(), count);  // to vertices that are not pinned
  DenseMatrix among = DenseMatrix::Zero(count, count);
  std::vector<int> around;
  for (Eigen::Index i = 0; i < count; ++i) {
    for (SparseMatrix::InnerIterator entry(bilaplacian_, vertices[i]); entry; ++entry) {
      const auto other = static_cast<Index>(entry.row());
      if (!sheet.pinned[other]) {
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
  among -= near.transpose() * sheet.solver->solve_rows(coupling, around);
  Eigen::VectorXd force(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    force[i] = defect_[vertices[i]];
    for (SparseMatrix::InnerIterator entry(coupling, i); entry; ++entry) {
      force[i] -= entry.value() * sheet.stress[entry.row()];
    }
  }
  return {sheet.energy, std::move(force), std::move(among), 1};
}

}  // namespace beltrami
