// Patches that are worked on side by side.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "local/patch.h"
#include "mesh/disk_mesh.h"
#include "mesh/rest_shape.h"

namespace beltrami {

inline constexpr std::size_t kTogether = 256;  ///< places whose patches are kept at once

/// The patch around a face, once it is cut, and what came of it.
struct PatchTry {
  Index face;
  Patch patch;
  bool positive = false;

  bool is_cut() const { return !patch.faces.empty(); }
};

/// Takes patches of `rings` rings out of `waiting`, in turn, none of which moves a vertex of
/// another: at least one, where one is left. Those around faces that are `done` go. Their UVs are
/// those of when they were cut: see Patch::refresh. The result does not depend on the threads.
std::vector<PatchTry> take_apart(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                                 const std::vector<Vec2>& uvs, int rings,
                                 const std::function<bool(Index face)>& done, const Work& work,
                                 std::vector<PatchTry>& waiting);

}  // namespace beltrami
