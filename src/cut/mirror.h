// The plane that a surface is symmetric to, for seams that lie in it or come in pairs.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "mesh/surface.h"

namespace beltrami {

/// A plane, and what it does to a surface.
struct Mirror {
  Vec3 point = Vec3::Zero();
  Vec3 normal = Vec3::UnitX();  ///< of length one
  double share = 0;             ///< of the area: what is within the tolerance when mirrored
  std::vector<Index> image;     ///< per vertex: of the face nearest to where it is mirrored to, the
                                ///< nearest corner; not one to one where the mesh is not symmetric
                                ///< itself; kNone at vertices without area around them
  std::vector<std::int8_t> side;  ///< per vertex: 0 near the plane, by its edges and the tolerance,
                                  ///< unless it is one of a pair there;
                                  ///< 1 where the normal points; else -1
};

/// The share of the area that has to be within the tolerance.
inline constexpr double kMirroredShare = 0.95;

/// The symmetry of the surface as a whole, its components one another's images or their own;
/// nothing where less than kMirroredShare of its area is mirrored to within `tolerance` times the
/// root of the area. Planes start across the principal axes, or any direction between axes that are
/// not distinct, and are fitted to pairs of points as Podolak et al. (SIGGRAPH 2006) do; of several
/// the nearest fit is taken, or nearly so, then the one across the shortest axis. Faces are matched
/// with faces turned alike: components turned inside out against their images are no images. Time:
/// that of a tree of the faces, and a search in it per vertex.
std::optional<Mirror> find_mirror(const Surface& surface, double tolerance, const Work& work);

/// Multiplies by `factor` what edges along the plane cost: both of whose ends are near it by the
/// lengths of edges around them. `costs`: per half-edge, the two of an edge alike. The surface may
/// be a simplification of the one that the mirror was found on, or what that was simplified from.
void weigh_mirror(const Surface& surface, const Mirror& mirror, double factor,
                  std::vector<double>& costs, const Work& work);

/// A factor for weigh_mirror: beyond the detour of a path of edges along a plane that it does not
/// follow, which is 1.15 in a mesh of equilateral triangles.
inline constexpr double kAlongMirror = 0.7;

}  // namespace beltrami
