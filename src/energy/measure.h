// Distortion of a given map, as delivered to the user.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"

namespace beltrami {

/// Distortion of one face. Without 3D area all but `area` are NaN.
struct FaceDistortion {
  double area;                 ///< in 3D
  double s1, s2;               ///< singular values, s1 >= |s2|; s2 < 0 where the face is flipped
  double symmetric_dirichlet;  ///< infinite where it is flipped or degenerate in the plane
  double symmetric_arap;       ///< likewise
};

/// Distortion of the face with corners `p` in space and `w` in the plane, at the scale of both.
FaceDistortion measure_face(const std::array<Vec3, 3>& p, const std::array<Vec2, 3>& w);

/// A face: its energy and its area in space.
struct WeighedEnergy {
  double energy, area;
};

/// The worst faces that together have less than this share of the area have no say in what a map is
/// worth: a sliver without visible area can have any energy, and no cut takes it away.
inline constexpr double kSliverShare = 1e-6;

/// What energies come to, weighted by area. All are NaN where there is none.
struct EnergySummary {
  double mean, p99, max;  ///< without slivers; p99 is exceeded on no more than 1% of the area
  Index slivers = 0;      ///< faces that have no say, see kSliverShare
  double mean_of_all, max_of_all;  ///< with them
};

/// Sums finite energies up.
EnergySummary summarise(const std::vector<WeighedEnergy>& faces);

/// Means over the faces weighted by 3D area. A face is left out if it has no 3D area, or if its
/// energy is not finite (flipped or degenerate in the plane).
struct Distortion {
  double symmetric_dirichlet =
      0;                      ///< 1/2 (s1^2 + s2^2 + s1^-2 + s2^-2), >= 2; NaN: no face is left
  double symmetric_arap = 0;  ///< (s1 - 1)^2 + (1/s2 - 1)^2, >= 0; NaN: no face is left
  double max = 0;             ///< greatest symmetric Dirichlet energy of a face
  Index worst_face = kNone;   ///< where
  std::int64_t left_out = 0;  ///< faces left out
};

/// Measures `uvs` (one per vertex) against `positions`, at the scale of both as given.
/// `face_energies`: null, or one double per face for its symmetric Dirichlet energy (infinity where
/// the face is left out).
Distortion measure_distortion(const std::vector<Vec3>& positions,
                              const std::vector<Triangle>& faces, const std::vector<Vec2>& uvs,
                              double* face_energies, const Work& work);

}  // namespace beltrami
