// Energy, gradient and projected Hessian of a density over a set of faces.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "energy/density.h"
#include "linear/mesh_matrix.h"
#include "mesh/face_block.h"
#include "mesh/face_chunks.h"
#include "mesh/rest_shape.h"

namespace beltrami {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// Gradient and Hessian model of one face in its six coordinates (u0, v0, u1, v1, u2, v2).
struct FaceModel {
  Vector6 gradient;
  Matrix6 hessian;
};

/// Those of some faces side by side, as in a FaceBlock.
struct FaceModels {
  static constexpr int kFaces = FaceBlock::kFaces;
  FaceBlock::Numbers gradient[6];
  /// [row][column]: of the blocks on the diagonal the lower triangle, and all of those above.
  FaceBlock::Numbers hessian[6][6];

  static constexpr bool has(int row, int column) {
    return row / 2 == column / 2 ? row >= column : row < column;
  }
  FaceModel at(int i) const {
    FaceModel face;
    for (int r = 0; r < 6; ++r) {
      face.gradient[r] = gradient[r][i];
      for (int c = 0; c < 6; ++c)
        face.hessian(r, c) = (has(r, c) ? hessian[r][c] : hessian[c][r])[i];
    }
    return face;
  }
  void set(int i, const FaceModel& face) {
    for (int r = 0; r < 6; ++r) {
      gradient[r][i] = face.gradient[r];
      for (int c = 0; c < 6; ++c) {
        if (has(r, c)) hessian[r][c][i] = face.hessian(r, c);
      }
    }
  }
};

/// Signed singular values of a linear map. s2 comes from the determinant where |fz| - |fzbar| would
/// cancel.
struct SingularValues {
  double s1, s2;
};
inline SingularValues singular_values(const LinearMap& map) {
  const double a = modulus(map.fz), b = modulus(map.fzbar);
  const double s1 = a + b;
  return {s1, s1 > 0 ? (std::norm(map.fz) - std::norm(map.fzbar)) / s1 : 0.0};
}

/// What the singular values of a face change by with its corners: with fz = a e^{i alpha} and
/// fzbar = b e^{i beta} the derivatives of a, of a alpha, of b and of b beta by its six
/// coordinates.
struct CornerDerivatives {
  FaceBlock::Numbers radial_z[6], twist[6], radial_zbar[6], flip[6];
};

/// fz and fzbar are linear in the corners, with coefficients conj(G_k) / 2 and G_k / 2 for the hat
/// gradients G_k. The phases are conj(fz) / a and conj(fzbar) / b.
inline void corner_derivatives(const FaceBlock& block, const FaceBlock::Numbers (&phase_z)[2],
                               const FaceBlock::Numbers (&phase_zbar)[2], CornerDerivatives& by) {
  for (int k = 0; k < 3; ++k) {
    for (int i = 0; i < FaceBlock::kFaces; ++i) {
      const Complex hat = block.rest(i).hat_gradient(k);
      const double x = hat.real(), y = hat.imag();
      const double zr = 0.5 * phase_z[0][i], zi = 0.5 * phase_z[1][i];
      const double wr = 0.5 * phase_zbar[0][i], wi = 0.5 * phase_zbar[1][i];
      const double along_z = zr * x + zi * y, across_z = zi * x - zr * y;
      const double along_zbar = wr * x - wi * y, across_zbar = wr * y + wi * x;
      by.radial_z[2 * k][i] = along_z;
      by.radial_z[2 * k + 1][i] = -across_z;
      by.twist[2 * k][i] = across_z;
      by.twist[2 * k + 1][i] = along_z;
      by.radial_zbar[2 * k][i] = along_zbar;
      by.radial_zbar[2 * k + 1][i] = -across_zbar;
      by.flip[2 * k][i] = across_zbar;
      by.flip[2 * k + 1][i] = along_zbar;
    }
  }
}

/// Chain rule from the density model to the corners, of the faces [first, first + kFaces), beyond
/// `end` the last one before it again; `weight(face)` is a factor.
template <class Density, class Weight>
void give_face_models(const std::vector<Triangle>& faces, const std::vector<RestTriangle>& rest,
                      const std::vector<Vec2>& uvs, std::int64_t first, std::int64_t end,
                      const Density& density, const Weight& weight, FaceModels& models) {
  constexpr int kFaces = FaceBlock::kFaces;
  FaceBlock block;
  block.load(faces, rest, uvs, first, end);
  FaceBlock::Numbers a, b, s1, s2, phase_z[2], phase_zbar[2], factor;
  for (int i = 0; i < kFaces; ++i) {
    const LinearMap map = block.map(i);
    a[i] = modulus(map.fz);
    b[i] = modulus(map.fzbar);
    s1[i] = a[i] + b[i];
    s2[i] = (std::norm(map.fz) - std::norm(map.fzbar)) / s1[i];
    phase_z[0][i] = map.fz.real() / a[i];
    phase_z[1][i] = -map.fz.imag() / a[i];
    phase_zbar[0][i] = map.fzbar.real() / b[i];
    phase_zbar[1][i] = -map.fzbar.imag() / b[i];
  }
  for (int i = 0; i < kFaces; ++i) {  // apart, so that the loop above has no branch
    if (!(s1[i] > 0)) s2[i] = 0;
    if (!(a[i] > 0)) phase_z[0][i] = 1, phase_z[1][i] = 0;
    if (!(b[i] > 0)) phase_zbar[0][i] = 1, phase_zbar[1][i] = 0;
    factor[i] = weight(std::min(first + i, end - 1));
  }
  CornerDerivatives by;
  corner_derivatives(block, phase_z, phase_zbar, by);
  FaceBlock::Numbers d1, d2, h11, h12, h22, twist, flip, coupling;
  for (int i = 0; i < kFaces; ++i) {
    const DensityModel m = density.model(s1[i], s2[i]);
    d1[i] = m.d1;
    d2[i] = m.d2;
    h11[i] = m.h11;
    h12[i] = m.h12;
    h22[i] = m.h22;
    twist[i] = m.twist;
    flip[i] = m.flip;
    coupling[i] = m.coupling;
  }
  // By s1 = a + b and s2 = a - b, then with the radial block and the angular one.
  FaceBlock::Numbers by_s1[6], by_s2[6], pull_s1[6], pull_s2[6], pull_twist[6], pull_flip[6];
  for (int k = 0; k < 6; ++k) {
    for (int i = 0; i < kFaces; ++i) {
      const double g1 = by.radial_z[k][i] + by.radial_zbar[k][i];
      const double g2 = by.radial_z[k][i] - by.radial_zbar[k][i];
      by_s1[k][i] = g1;
      by_s2[k][i] = g2;
      pull_s1[k][i] = h11[i] * g1 + h12[i] * g2;
      pull_s2[k][i] = h12[i] * g1 + h22[i] * g2;
      pull_twist[k][i] = twist[i] * by.twist[k][i] + coupling[i] * by.flip[k][i];
      pull_flip[k][i] = coupling[i] * by.twist[k][i] + flip[i] * by.flip[k][i];
      models.gradient[k][i] = (d1[i] * g1 + d2[i] * g2) * factor[i];
    }
  }
  for (int r = 0; r < 6; ++r) {
    for (int c = 0; c < 6; ++c) {
      if (!FaceModels::has(r, c)) continue;
      for (int i = 0; i < kFaces; ++i) {
        models.hessian[r][c][i] =
            (pull_s1[r][i] * by_s1[c][i] + pull_s2[r][i] * by_s2[c][i] +
             pull_twist[r][i] * by.twist[c][i] + pull_flip[r][i] * by.flip[c][i]) *
            factor[i];
      }
    }
  }
}

/// Adds up, in parallel, what give(first, end, models) says of faces [first, end), kFaces or fewer.
template <class Give>
void assemble(const std::vector<Triangle>& faces, const Give& give, MeshMatrix& hessian,
              Eigen::VectorXd& gradient, const Work& work) {
  struct Aside {
    Index row;
    Vec2 term;
  };
  hessian.set_zero(work);
  gradient.setZero(2 * hessian.free_count());
  const FaceChunks& chunks = hessian.chunks();
  PutAside<Aside> aside(chunks, size_of(hessian.rows()));
  hessian.add_up_chunks(work, faces, [&](std::int64_t begin, std::int64_t end, const auto& add) {
    FaceModels models;
    for (std::int64_t first = begin; first < end; first += FaceModels::kFaces) {
      const std::int64_t last = std::min(end, first + FaceModels::kFaces);
      give(first, last, models);
      for (std::int64_t f = first; f < last; ++f) {
        const auto i = static_cast<int>(f - first);
        const Triangle& t = faces[f];
        for (int k = 0; k < 3; ++k) {
          const Index row = hessian.row(t[k]);
          if (row == kNone) continue;
          const Vec2 term(models.gradient[2 * k][i], models.gradient[2 * k + 1][i]);
          if (chunks.shared(t[k])) {
            aside.put(chunks.of(f), t[k], {row, term});
          } else {
            gradient.segment<2>(2 * row) += term;
          }
        }
        for (int k = 0; k < 3; ++k) {
          for (int l = k; l < 3; ++l) {
            add(static_cast<Index>(f), k, l,
                [&](int r, int c) { return models.hessian[2 * k + r][2 * l + c][i]; });
          }
        }
      }
    }
  });
  aside.add_up(work, [&](const Aside& a) { gradient.segment<2>(2 * a.row) += a.term; });
}

}  // namespace beltrami
