// Normal maps from the axes of one layout of UVs to those of another.
#pragma once

#include <span>
#include <vector>

#include "bake/page.h"
#include "base/work.h"

namespace beltrami {

/// Corners of triangles, three for each, in the winding of the mesh.
struct AxesOfCorners {
  std::span<const double> positions;  ///< x y z
  std::span<const double> normals;    ///< x y z; NaN for that of the triangle; or empty
  std::span<const double> tangents;   ///< of the old UVs, x y z and side, where given; or empty
  std::span<const double> old_uvs, new_uvs;
};

/// The turn of each triangle. The axis of u at a corner is the mean over the triangles that meet
/// there with one normal and one UV, by their angles, as MikkTSpace has it, which glTF asks viewers
/// for; so is the side, by the orientation of the UVs. Corners without such an axis do not turn.
std::vector<AxesTurn> axes_turns(const AxesOfCorners& corners, const Work& work);

}  // namespace beltrami
