// A vertex for every fan of faces: what a triangle list becomes where some of its faces part.
#pragma once

#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "mesh/surface.h"

namespace beltrami {

/// A surface whose vertices are fans around vertices of another one.
struct SplitSurface {
  Surface surface;            ///< its faces are those given
  std::vector<Index> vertex;  ///< per vertex the one that it stands for, increasing
};

/// Parts what is glued where more than two sides run between the same two fans, so that split_fans
/// takes it: no vertex may have two edges to another one. Preconditions: as there, but for the
/// last.
void part_double_edges(const std::vector<Triangle>& faces, std::vector<Index>& twin);

/// Unites the corners of `faces` across glued half-edges: `twin` has the opposite one, or kNone.
/// Fans at one vertex come in the order of their least corners. Two sides left apart that run
/// between the same two fans are one edge in the result: a slit that nothing holds open closes.
/// Preconditions: twins run against each other between the same two vertices; no other pair of
/// vertices has two edges in one fan.
SplitSurface split_fans(const std::vector<Vec3>& positions, const std::vector<Triangle>& faces,
                        const std::vector<Index>& twin, const Work& work);

/// What split_fans makes of a surface whose edges `apart`, per half-edge, are not glued.
SplitSurface split_along(const Surface& surface, const std::vector<bool>& apart, const Work& work);

}  // namespace beltrami
