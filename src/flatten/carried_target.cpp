#include "flatten/carried_target.h"

#include <array>
#include <cmath>

#include "base/lanes.h"
#include "base/parallel.h"
#include "base/types.h"
#include "flatten/principal_stiffness.h"
#include "mesh/vertex_sums.h"

namespace beltrami {
namespace {

constexpr std::int64_t kGrain = 16384;

/// The edges opposite to each corner, from the corner after it to the one before, of triangles with
/// the first corner at the origin.
std::array<LanesComplex, 3> edges(const LanesComplex& p1, const LanesComplex& p2) {
  return {p2 - p1, {-p2.real, -p2.imag}, p1};
}

/// The entries of the stiffness matrices, with the opposite sign, of tensors with the mean m of
/// their eigenvalues, half their difference d and the greater one along the root of c:
/// w_k = -(m e_i . e_j - d Re(conj(c) e_i e_j)) / 4A.
template <class Density>
std::array<Lanes, 3> weights_at(const CarriedMaps& maps) {
  Lanes mean, half_over_norms;
  for (int i = 0; i < kLanes; ++i) {
    const bool known = maps.fz_norm[i] > 0;
    const double a = known ? std::sqrt(double{maps.fz_norm[i]}) : 1;
    const double b = std::sqrt(double{maps.fzbar_norm[i]});
    const auto [along, across] = principal_stiffness<Density>(a, b);
    mean[i] = static_cast<float>(0.5 * (along + across));
    half_over_norms[i] = b > 0 ? static_cast<float>(0.5 * (along - across) / (a * b)) : 0;
  }
  const LanesComplex anisotropy = half_over_norms * (conj(maps.fzbar) * maps.fz);
  const auto e = edges({Lanes::Ones(), Lanes::Zero()}, maps.corner);
  const Lanes scale = -0.5F / maps.corner.imag;
  std::array<Lanes, 3> weights;
  for (int k = 0; k < 3; ++k) {
    const LanesComplex &p = e[next_corner(k)], &q = e[previous_corner(k)];
    const Lanes isotropic = p.real * q.real + p.imag * q.imag;
    weights[k] = scale * (mean * isotropic - (anisotropy * (p * q)).real);
  }
  return weights;
}

/// The corners of the faces after the first one, from there, as far as they are from the targets.
struct Differences {
  LanesComplex second, third;
};

Differences differences(const DiskMesh& mesh, const std::array<Index, kLanes>& faces,
                        const std::vector<RestTriangle>& rest, const std::vector<Vec2>& uvs,
                        const CarriedMaps& maps) {
  Lanes length;
  Differences present;
  for (int i = 0; i < kLanes; ++i) {
    const Triangle& t = mesh.faces[faces[i]];
    const Vec2 second = uvs[t[1]] - uvs[t[0]], third = uvs[t[2]] - uvs[t[0]];
    length[i] = static_cast<float>(rest[faces[i]].x1);
    present.second.real[i] = static_cast<float>(second.x());
    present.second.imag[i] = static_cast<float>(second.y());
    present.third.real[i] = static_cast<float>(third.x());
    present.third.imag[i] = static_cast<float>(third.y());
  }
  const LanesComplex second = maps.fz + maps.fzbar;
  const LanesComplex third = maps.fz * maps.corner + maps.fzbar * conj(maps.corner);
  return {length * second - present.second, length * third - present.third};
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
    const auto give = [&](const std::array<Index, kLanes>& faces, VertexSums::LaneTerms& terms) {
      const CarriedMaps maps = carried_maps(mesh, faces, rest, derivatives);
      const std::array<Lanes, 3> weights = weights_at<Density>(maps);
      const Differences to_go = differences(mesh, faces, rest, uvs, maps);
      auto pull = edges(to_go.second, to_go.third);  // of each edge on its first end
      for (int k = 0; k < 3; ++k) pull[k] = weights[k] * pull[k];
      for (int k = 0; k < 3; ++k) terms[k] = pull[next_corner(k)] - pull[previous_corner(k)];
      for (int i = 0; i < kLanes; ++i) {
        for (int k = 0; k < 3; ++k) equations.weights[faces[i]][k] = weights[k][i];
        if (maps.fz_norm[i] > 0) continue;
        for (LanesComplex& term : terms) term.real[i] = term.imag[i] = 0;
      }
    };
    VertexSums(mesh.vertex_count(), mesh.faces, work).add_up_lanes(give, residual);
  });
  equations.residual.resize(residual.size());
  parallel_for(work, size_of(residual), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t v = begin; v < end; ++v) {
      equations.residual[v] = residual[v].cast<float>();
    }
  });
  parallel_free(work, residual);
  return equations;
}

}  // namespace beltrami
