#include "descend/tutte.h"

#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "base/error.h"
#include "base/parallel.h"
#include "descend/assembly.h"
#include "linear/mesh_matrix.h"
#include "linear/spd_solver.h"
#include "mesh/boundary.h"
#include "mesh/face_chunks.h"

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

namespace {

/// The sum over the faces of the array that `term(area, s1, s2)` returns, chunk by chunk; nothing
/// where a face is not positive.
template <class Term>
auto sum_faces(const std::vector<Triangle>& faces, const std::vector<RestTriangle>& rest,
               const std::vector<Vec2>& uvs, const Work& work, const Term& term) {
  using Sum = decltype(term(0.0, 0.0, 0.0));
  const std::int64_t grain = FaceChunks::grain_of(size_of(faces));
  std::vector<Sum> partial(faces.size() / grain + 1, Sum{});
  std::atomic<bool> positive{true};
  parallel_for(work, size_of(faces), grain, [&](std::int64_t begin, std::int64_t end) {
    Sum& sum = partial[begin / grain];
    for (std::int64_t f = begin; f < end && positive; ++f) {
      const Triangle& t = faces[f];
      const SingularValues s =
          singular_values(linear_map(rest[f], uvs[t[0]], uvs[t[1]], uvs[t[2]]));
      if (!(s.s2 > 0)) positive = false;
      const Sum of_face = term(rest[f].area(), s.s1, s.s2);
      for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += of_face[k];
    }
  });
  std::optional<Sum> total;
  if (!positive) return total;
  total.emplace();
  for (const Sum& sum : partial) {
    for (std::size_t k = 0; k < sum.size(); ++k) (*total)[k] += sum[k];
  }
  return total;
}

}  // namespace

double best_scale(Energy energy, const std::vector<Triangle>& faces,
                  const std::vector<RestTriangle>& rest, const std::vector<Vec2>& uvs,
                  const Work& work) {
  bool positive = true;
  const auto sum = [&](const auto& term) {
    const auto total = sum_faces(faces, rest, uvs, work, term);
    positive = positive && total;
    return total.value_or(decltype(term(0.0, 0.0, 0.0)){});
  };
  const double scale = with_density(energy, [&](auto density) { return density.best_scale(sum); });
  return positive && std::isfinite(scale) && scale > 0 ? scale : 1;
}

double mean_energy(Energy energy, const std::vector<Triangle>& faces,
                   const std::vector<RestTriangle>& rest, const std::vector<Vec2>& uvs,
                   const Work& work) {
  return with_density(energy, [&]<class Density>(Density) {
    const auto sums = sum_faces(faces, rest, uvs, work, [](double area, double s1, double s2) {
      return std::array{area * Density::value(s1, s2), area};
    });
    return sums ? (*sums)[0] / (*sums)[1] : std::numeric_limits<double>::infinity();
  });
}

}  // namespace beltrami
