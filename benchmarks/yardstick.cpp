#include "yardstick.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/types.h"
#include "base/work.h"
#include "linear/mesh_matrix.h"
#include "mesh/disk_mesh.h"
#include "mesh/locality.h"
#ifdef BELTRAMI_WITH_CHOLMOD
#include <cholmod.h>
#endif

namespace beltrami::benchmarks {

double seconds(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

Cost measure(const System& system, const std::function<void()>& analyze,
             const std::function<void()>& factorize, const std::function<DenseMatrix()>& solve) {
  Cost cost;
  const double wall = seconds(CLOCK_MONOTONIC);
  const auto time = [](double& sum, const auto& step) {
    const double begin = seconds(CLOCK_PROCESS_CPUTIME_ID);
    step();
    sum = seconds(CLOCK_PROCESS_CPUTIME_ID) - begin;
  };
  DenseMatrix x;
  time(cost.analyze, analyze);
  time(cost.factorize, factorize);
  time(cost.solve, [&] { x = solve(); });
  cost.wall = seconds(CLOCK_MONOTONIC) - wall;
  const DenseMatrix left = system.lower.selfadjointView<Eigen::Lower>() * x - system.rhs;
  cost.residual = left.norm() / system.rhs.norm();
  return cost;
}

#ifdef BELTRAMI_WITH_CHOLMOD
Cost run_cholmod(const System& system, Unit unit) {
  cholmod_common common;
  cholmod_start(&common);
  common.nmethods = 1;
  common.method[0].ordering = unit == Unit::kUm ? CHOLMOD_METIS : CHOLMOD_AMD;
  common.supernodal = CHOLMOD_SUPERNODAL;
  cholmod_sparse view{};
  view.nrow = view.ncol = static_cast<std::size_t>(system.lower.rows());
  view.nzmax = static_cast<std::size_t>(system.lower.nonZeros());
  view.p = const_cast<int*>(system.lower.outerIndexPtr());
  view.i = const_cast<int*>(system.lower.innerIndexPtr());
  view.x = const_cast<double*>(system.lower.valuePtr());
  view.stype = -1;
  view.itype = CHOLMOD_INT;
  view.xtype = CHOLMOD_REAL;
  view.sorted = view.packed = 1;
  cholmod_factor* factor = nullptr;
  const Cost cost = measure(
      system, [&] { factor = cholmod_analyze(&view, &common); },
      [&] { cholmod_factorize(&view, factor, &common); },
      [&] {
        DenseMatrix x(system.rhs.rows(), system.rhs.cols());
        for (Eigen::Index c = 0; c < system.rhs.cols(); ++c) {
          cholmod_dense right{};
          right.nrow = right.nzmax = right.d = view.nrow;
          right.ncol = 1;
          right.x = const_cast<double*>(system.rhs.col(c).data());
          right.xtype = CHOLMOD_REAL;
          cholmod_dense* solution = cholmod_solve(CHOLMOD_A, factor, &right, &common);
          x.col(c) =
              Eigen::Map<const Eigen::VectorXd>(static_cast<const double*>(solution->x), x.rows());
          cholmod_free_dense(&solution, &common);
        }
        return x;
      });
  cholmod_free_factor(&factor, &common);
  cholmod_finish(&common);
  return cost;
}
#endif

namespace {

/// Numbers the vertices as the library does before all else.
void number_along_curve(std::vector<Vec3>& positions, std::vector<Triangle>& faces) {
  const std::vector<Index> order = along_hilbert_curve(positions, Work(1));
  std::vector<Vec3> arranged;
  std::vector<Index> place(order.size());
  for (Index i = 0; i < size_of(order); ++i) {
    arranged.push_back(positions[order[i]]);
    place[order[i]] = i;
  }
  positions.swap(arranged);
  for (Triangle& face : faces) {
    for (Index& v : face) v = place[v];
  }
}

}  // namespace

std::vector<Vec3> positions_of(const TriangleMesh& file) {
  std::vector<Vec3> positions;
  for (std::size_t v = 0; v < file.vertex_count(); ++v) {
    positions.emplace_back(file.positions[3 * v], file.positions[3 * v + 1],
                           file.positions[3 * v + 2]);
  }
  return positions;
}

std::vector<Triangle> faces_of(const TriangleMesh& file) {
  std::vector<Triangle> faces;
  for (std::size_t f = 0; f < file.face_count(); ++f) {
    faces.push_back({static_cast<Index>(file.faces[3 * f]),
                     static_cast<Index>(file.faces[3 * f + 1]),
                     static_cast<Index>(file.faces[3 * f + 2])});
  }
  return faces;
}

System interior_laplacian(const TriangleMesh& file, Numbering numbering) {
  std::vector<Vec3> positions = positions_of(file);
  std::vector<Triangle> faces = faces_of(file);
  if (numbering == Numbering::kAlongCurve) number_along_curve(positions, faces);
  const DiskMesh mesh = build_disk(std::move(positions), std::move(faces), Work(1));
  MeshMatrix matrix(mesh.vertex_count(), mesh.faces, mesh.on_boundary, 1, Work(1));
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const Triangle& t = mesh.faces[f];
    for (int k = 0; k < 3; ++k) {
      const int i = next_corner(k), j = previous_corner(k);
      const Vec3 a = mesh.positions[t[i]] - mesh.positions[t[k]],
                 b = mesh.positions[t[j]] - mesh.positions[t[k]];
      const double weight = 0.5 * a.dot(b) / std::max(a.cross(b).norm(), 1e-300);
      matrix.add(f, t, i, i, [=](int, int) { return weight; });
      matrix.add(f, t, j, j, [=](int, int) { return weight; });
      matrix.add(f, t, i, j, [=](int, int) { return -weight; });
    }
  }
  DenseMatrix rhs(matrix.free_count(), 2);
  for (Eigen::Index i = 0; i < rhs.rows(); ++i) {
    rhs(i, 0) = std::sin(static_cast<double>(i));
    rhs(i, 1) = std::cos(0.7 * static_cast<double>(i));
  }
  return {matrix.matrix(), matrix.places(mesh.positions), rhs};
}

}  // namespace beltrami::benchmarks
