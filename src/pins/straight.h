// Maps with straight borders: vertices slide along lines until the energy is least.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "mesh/disk_mesh.h"
#include "multilevel/options.h"
#include "pins/hold.h"

namespace beltrami {

/// Vertices that are to lie on one line, in their order along it.
struct StraightPath {
  PinKind kind;  ///< kU: with one u, kV: with one v, kLine: on any line
  std::vector<Index> vertices;
};

struct StraightMap {
  std::vector<Vec2> uvs;  ///< one per vertex; none where it cannot be
  bool converged = true;  ///< the optimisation was not cut short
  Index released = 0;     ///< vertices that stand out of their line, see straighten
};

/// Turns a map so that its paths lie best along the axes, puts each on the line that it has in the
/// mean, and minimises the energy with its vertices sliding along that, at the scale of the mesh.
/// Where an edge joins two vertices of a path that are no neighbours on it, what it cuts off would
/// have no area: the vertices between them are released. Vertices of two paths lie where the lines
/// cross. Paths of kU and kV are met to the bit. Preconditions: a mesh of about unit area; paths of
/// two vertices at least, none twice in one of them; positive faces but for those without area.
/// Throws Error SOLVER, Cancelled or std::bad_alloc.
StraightMap straighten(const DiskMesh& mesh, const std::vector<Vec2>& uvs,
                       const std::vector<StraightPath>& paths, const ChartOptions& options,
                       const Work& work);

/// Maps a disk to a rectangle along the axes, of the sides that leave the least energy, with a
/// corner at the origin; the side from the first corner to the second along u. `corners`: of the
/// boundary, in its order. Vertices are released as by straighten.
StraightMap to_rectangle(const DiskMesh& mesh, const std::array<Index, 4>& corners,
                         const ChartOptions& options, const Work& work);

/// The four vertices where the boundary of a map turns most, in its order; nothing where a fourth
/// turns by less than some 40 degrees, or a fifth hardly less than that.
std::optional<std::array<Index, 4>> four_corners(const DiskMesh& mesh,
                                                 const std::vector<Vec2>& uvs);

}  // namespace beltrami
