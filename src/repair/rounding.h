// Roundings of a map to the numbers that it is delivered in, which keep it injective.
#pragma once

#include <cstdint>
#include <vector>

#include "base/vectors.h"
#include "base/work.h"
#include "exact/certificate.h"
#include "mesh/disk_mesh.h"

namespace beltrami {

/// The numbers of a floating-point type, in a unit of 2^exponent of its own: x stands for the
/// number x * 2^-exponent of the type.
struct Numbers {
  bool single = false;  ///< float; else double
  int exponent = 0;
  /// Above 0: the multiples of it alone. A power of two, and those in use are numbers of the type.
  double step = 0;

  /// The nearest number to a finite one; beyond the range of the type the end of it.
  double nearest(double x) const;
  Vec2 nearest(const Vec2& place) const { return {nearest(place.x()), nearest(place.y())}; }
  /// The distance to the next number away from zero.
  double spacing(double x) const;
  /// Whether the type reaches as far as the places, and is fine enough not to round them all onto a
  /// line: where not, no rounding nearby is injective.
  bool hold(const std::vector<Vec2>& places, const Work& work) const;
  /// The number of the type that x stands for.
  double delivered(double x) const;
  Vec2 delivered(const Vec2& place) const { return {delivered(place.x()), delivered(place.y())}; }
};

struct Rounded {
  std::vector<Vec2> uvs;    ///< one per vertex; every coordinate is one of the numbers
  Certificate certificate;  ///< of them
  std::int64_t moved = 0;   ///< vertices that are not at the nearest number
};

/// Unfolds faces of hardly any area in place: vertices move by a few units in the last place of the
/// numbers, or as far as round_map has it where that does not serve. Whether all faces are positive
/// then; others never fold.
bool unfold_nearby(const DiskMesh& mesh, const Numbers& numbers, const Work& work,
                   std::vector<Vec2>& uvs);

/// Rounds every coordinate of `placed` to nearest. Where that flips a face or makes the boundary
/// cross itself, vertices nearby move: first by a few units in the last place, then into the kernel
/// of their one-ring, then in patches that are untangled towards equilateral faces; crossings are
/// undone by the faces of a triangulated ring around the boundary, which must become positive. What
/// cannot be mended is said by the certificate. What is wrong with `uvs` already is left alone.
/// `placed` is `uvs` moved and scaled, in floating point: it may have folds that `uvs` has not.
/// Precondition: finite.
Rounded round_map(const DiskMesh& mesh, const std::vector<Vec2>& uvs,
                  const std::vector<Vec2>& placed, const Numbers& numbers, const Work& work);

/// The same, with the vertices `held` (per vertex, or empty) at the nearest number whatever folds.
Rounded round_map(const DiskMesh& mesh, const std::vector<Vec2>& uvs,
                  const std::vector<Vec2>& placed, const std::vector<bool>& held,
                  const Numbers& numbers, const Work& work);

}  // namespace beltrami
