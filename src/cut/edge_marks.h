// The edges that a surface is cut along.
#pragma once

#include <vector>

#include "base/types.h"
#include "mesh/surface.h"

namespace beltrami {

/// Per half-edge of a surface whether its edge is marked: the two of an edge alike.
using EdgeMarks = std::vector<bool>;

inline void mark_edge(const Surface& surface, Index halfedge, EdgeMarks& marks) {
  marks[halfedge] = true;
  if (surface.twin[halfedge] != kNone) marks[surface.twin[halfedge]] = true;
}

}  // namespace beltrami
