#include "flatten/carried_target.h"

#include "base/parallel.h"
#include "flatten/laplacian.h"
#include "flatten/principal_stiffness.h"
#include "mesh/vertex_sums.h"

namespace beltrami {
namespace {

constexpr std::int64_t kGrain = 16384;

/// The edges opposite to each corner, from the corner after it to the one before.
std::array<Complex, 3> edges(Complex p0, Complex p1, Complex p2) {
  return {p2 - p1, p0 - p2, p1 - p0};
}

Complex to_complex(const Vec2& v) {
  return {v.x(), v.y()};
}

/// The weights w_k = -(m e_i . e_j - d Re(conj(c) e_i e_j)) / 4A of a tensor with the mean m of its
/// eigenvalues, half their difference d and the greater one along the root of c: the entries of its
/// stiffness matrix, with the opposite sign.
template <class Density>
EdgeWeights weights_at(const RestTriangle& rest, const LinearMap& map) {
  const double a = modulus(map.fz), b = modulus(map.fzbar);
  const auto [along, across] = principal_stiffness<Density>(a, b);
  const double mean = 0.5 * (along + across);
  const Complex anisotropy =
      b > 0 ? 0.5 * (along - across) / (a * b) * (std::conj(map.fzbar) * map.fz) : Complex(0);
  const auto e = edges(0, rest.x1, rest.corner(2));
  const double scale = -0.5 / (rest.x1 * rest.y2);
  EdgeWeights weights;
  for (int k = 0; k < 3; ++k) {
    const Complex p = e[next_corner(k)], q = e[previous_corner(k)];
    const double isotropic = p.real() * q.real() + p.imag() * q.imag();
    weights[k] = scale * (mean * isotropic - (anisotropy * (p * q)).real());
  }
  return weights;
}

}  // namespace

TargetEquations target_equations(Energy energy, const DiskMesh& mesh,
                                 const std::vector<RestTriangle>& rest,
                                 const std::vector<VertexDerivative>& derivatives,
                                 const std::vector<Vec2>& uvs, const Work& work) {
  TargetEquations equations;
  parallel_assign(work, equations.weights, mesh.faces.size());
  std::vector<Vec2> residual;
  with_density(energy, [&]<class Density>(Density) {
    const auto give = [&](Index f, VertexSums::Terms& terms) {
      const Triangle& t = mesh.faces[f];
      const LinearMap map = derivative_of_face(mesh, f, rest[f], derivatives);
      const bool known = map.fz != Complex(0);
      const EdgeWeights weights = weights_at<Density>(rest[f], known ? map : LinearMap{1, 0});
      for (int k = 0; k < 3; ++k) equations.weights[f][k] = static_cast<float>(weights[k]);
      terms = {Vec2::Zero(), Vec2::Zero(), Vec2::Zero()};
      if (!known) return 0.0;
      const Complex z = rest[f].corner(2);
      const auto target =
          edges(0, (map.fz + map.fzbar) * rest[f].x1, map.fz * z + map.fzbar * std::conj(z));
      const auto present =
          edges(to_complex(uvs[t[0]]), to_complex(uvs[t[1]]), to_complex(uvs[t[2]]));
      std::array<Complex, 3> pull;  // of each edge on its first end
      for (int k = 0; k < 3; ++k) pull[k] = weights[k] * (target[k] - present[k]);
      for (int k = 0; k < 3; ++k) {
        const Complex term = pull[next_corner(k)] - pull[previous_corner(k)];
        terms[k] = {term.real(), term.imag()};
      }
      return 0.0;
    };
    VertexSums(mesh.vertex_count(), mesh.faces, work).add_up(give, residual);
  });
  equations.residual.resize(residual.size());
  parallel_for(work, size_of(residual), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t v = begin; v < end; ++v) {
      equations.residual[v] = residual[v].cast<float>();
    }
  });
  return equations;
}

}  // namespace beltrami
