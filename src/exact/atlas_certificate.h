// The exact verdict on an atlas: every triangle has an area of its own.
//
// If all triangles are positively oriented, the number of them over a point that is on no edge is
// the winding number of their boundary around it. So no two of them overlap, in one chart or in
// two, in holes and bays, if and only if that number is 0 or 1 in every cell of the boundary's
// arrangement, which a sweep over the boundary alone decides. Triangles overlap if their interiors
// have a point in common; they may share any points of their borders, so charts may touch, which is
// counted.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "exact/certificate.h"
#include "exact/overlaps.h"

namespace beltrami {

/// What is asked of an atlas.
struct AtlasRules {
  /// Per face, whether it is not judged, as it has no area on the surface: it may lie anywhere, and
  /// does not join others to one chart. Empty: all are judged.
  std::vector<bool> excepted;
  /// Charts all of whose triangles are negative are taken as their mirror images.
  bool allow_mirrored = false;
  std::int64_t most_listed = 16;  ///< pairs in each list of the result
};

struct AtlasCertificate {
  Orientations orientations;  ///< of the judged faces, after mirroring
  std::int64_t excepted_faces = 0;
  std::int64_t mirrored_charts = 0, mirrored_faces = 0;  ///< where that is allowed
  std::int64_t not_finite = 0;  ///< UV vertices of faces with a coordinate that is no number
  Index first_not_finite = kNone;
  /// Of the judged faces that have an area, taken as positive. Counted where some overlap.
  Overlaps overlaps;
  /// Places where boundaries touch, and the lowest UV vertex there: a vertex on another one or on
  /// an edge. None: charts, and the sides of a seam, are apart. Counted in full if the atlas is
  /// injective.
  std::int64_t touching_places = 0;
  Index first_touching = kNone;
  bool injective() const {
    return not_finite == 0 && orientations.negative == 0 && orientations.degenerate == 0 &&
           overlaps.faces == 0;
  }
};

/// Judges the atlas of `faces`, given as indices of its UV vertices `uvs`: an edge is in the inside
/// of a chart where two faces use the same two indices. Doubles are taken as they are; what is to
/// be delivered in single precision is to be rounded before. O(m + n log n) for m faces, n edges at
/// the boundary. Precondition: indices in range. Never fails: UVs that are no numbers are counted.
AtlasCertificate certify_atlas(const std::vector<Triangle>& faces, const std::vector<Vec2>& uvs,
                               const AtlasRules& rules, const Work& work);

}  // namespace beltrami
