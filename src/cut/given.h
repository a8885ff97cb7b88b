// Cuts that come with the input: edges, the islands of its UVs, its labels, its hard edges.
#pragma once

#include <array>
#include <cstdint>
#include <numbers>
#include <vector>

#include "admit/admit.h"
#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "cut/edge_marks.h"

namespace beltrami {

/// What the caller wants cut. Vertices, faces and corners are those of the input of admit.
struct GivenCuts {
  std::vector<std::array<Index, 2>> edges;  ///< ends; pairs that are no edge mark nothing
  std::vector<std::uint64_t> labels;        ///< per face, or none: cut where they differ
  std::vector<Vec2> corner_uvs;             ///< three per face, or none: cut where they differ
  double hard_angle = std::numbers::pi;     ///< cut where normals turn by more, in radians, but for
                                            ///< creases that part nothing and meet no border

  bool none() const {
    return edges.empty() && labels.empty() && corner_uvs.empty() && hard_angle >= std::numbers::pi;
  }
};

/// The edges of the admitted surface that are to be cut. UVs are compared as they are: to the bit,
/// but for the sign of zero. Precondition: sizes as said.
EdgeMarks given_marks(const Admitted& admitted, const GivenCuts& cuts, const Work& work);

}  // namespace beltrami
