// A rounding of a map to single precision that keeps it injective.
#pragma once

#include <cstdint>
#include <vector>

#include "base/checkpoint.h"
#include "base/types.h"
#include "exact/certificate.h"
#include "mesh/disk_mesh.h"

namespace beltrami {

/// The nearest place whose coordinates are single-precision numbers; coordinates beyond their range
/// go to its end.
Vec2 nearest_single(const Vec2& place);

struct SinglePrecision {
  std::vector<Vec2> uvs;    ///< one per vertex; every coordinate is a single-precision number
  Certificate certificate;  ///< of them
  std::int64_t moved = 0;   ///< vertices that are not at the nearest such number
};

/// Rounds every coordinate to nearest. Where that flips a face or makes the boundary cross itself,
/// vertices nearby move: first by a few units in the last place, then into the kernel of their
/// one-ring, then in patches that are untangled towards equilateral faces; crossings are undone by
/// the faces of a triangulated ring around the boundary, which must become positive. What cannot be
/// mended is said by the certificate. What `exact`, the certificate of `uvs`, finds wrong already
/// is left alone. Precondition: finite.
SinglePrecision round_to_single(const DiskMesh& mesh, const std::vector<Vec2>& uvs,
                                const Certificate& exact, int threads,
                                const Checkpoint& checkpoint = no_checkpoint);

}  // namespace beltrami
