#include "descend/tutte.h"

#include <cmath>
#include <limits>

#include "base/error.h"
#include "descend/assembly.h"
#include "linear/mesh_matrix.h"
#include "linear/spd_solver.h"
#include "mesh/boundary.h"

namespace beltrami {
std::vector<Vec2> tutte_embedding(const DiskMesh& mesh, const Work& work) {
  std::vector<Vec2> uvs(mesh.vertex_count(), Vec2::Zero());
  const std::vector<Vec2> circle = boundary_on_circle(mesh, work);
  for (std::size_t i = 0; i < circle.size(); ++i) uvs[mesh.boundary[i]] = circle[i];

  MeshMatrix laplacian(mesh.vertex_count(), mesh.faces, mesh.on_boundary, 1, work);
  if (laplacian.free_count() == 0) return uvs;
  DenseMatrix rhs = DenseMatrix::Zero(laplacian.free_count(), 2);
  const auto one = [](int, int) { return 1.0; };
  // Each face stands for half of the unit weight of its edges: every edge of a free vertex has two.
  const auto minus_half = [](int, int) { return -0.5; };
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const Triangle& face = mesh.faces[f];
    for (int k = 0; k < 3; ++k) {
      const int l = next_corner(k);
      laplacian.add(f, face, k, k, one);
      laplacian.add(f, face, k, l, minus_half);
      const Index rk = laplacian.row(face[k]), rl = laplacian.row(face[l]);
      if (rk != kNone && rl == kNone) rhs.row(rk) += 0.5 * uvs[face[l]].transpose();
      if (rl != kNone && rk == kNone) rhs.row(rl) += 0.5 * uvs[face[k]].transpose();
    }
  }
  const auto solver = make_spd_solver({}, work);
  solver->analyze(laplacian.matrix(), laplacian.places(mesh.positions));
  if (!solver->factorize(laplacian.matrix())) {
    throw Error(Fault::kSolver, "the linear system of the Tutte embedding is not definite");
  }
  const DenseMatrix solution = solver->solve(rhs);
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (laplacian.row(v) != kNone) uvs[v] = solution.row(laplacian.row(v)).transpose();
  }
  return uvs;
}

double best_scale(Energy energy, const std::vector<Triangle>& faces,
                  const std::vector<RestTriangle>& rest, const std::vector<Vec2>& uvs) {
  bool positive = true;
  const auto each_face = [&](const auto& body) {
    for (Index f = 0; f < size_of(faces) && positive; ++f) {
      const Triangle& t = faces[f];
      const SingularValues s =
          singular_values(linear_map(rest[f], uvs[t[0]], uvs[t[1]], uvs[t[2]]));
      positive = s.s2 > 0;
      if (positive) body(rest[f].area(), s.s1, s.s2);
    }
  };
  const double scale =
      with_density(energy, [&](auto density) { return density.best_scale(each_face); });
  return positive && std::isfinite(scale) && scale > 0 ? scale : 1;
}

double mean_energy(Energy energy, const std::vector<Triangle>& faces,
                   const std::vector<RestTriangle>& rest, const std::vector<Vec2>& uvs) {
  return with_density(energy, [&]<class Density>(Density) {
    double sum = 0, area = 0;
    for (Index f = 0; f < size_of(faces); ++f) {
      const Triangle& t = faces[f];
      const SingularValues s =
          singular_values(linear_map(rest[f], uvs[t[0]], uvs[t[1]], uvs[t[2]]));
      if (!(s.s2 > 0)) return std::numeric_limits<double>::infinity();
      sum += rest[f].area() * Density::value(s.s1, s.s2);
      area += rest[f].area();
    }
    return sum / area;
  });
}

}  // namespace beltrami
