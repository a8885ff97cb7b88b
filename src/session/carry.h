// The maps of charts before a cut -> where the charts after it start from.
#pragma once

#include <vector>

#include "atlas/open.h"
#include "base/vectors.h"
#include "base/work.h"
#include "mesh/disk_mesh.h"
#include "session/ground.h"
#include "session/state.h"

namespace beltrami {

/// What a chart brings with it.
struct Carried {
  std::vector<Vec2> uvs;     ///< one per vertex; where `placed`
  bool placed = false;       ///< its faces had a place before
  double scale = 1;          ///< of the largest part, or of that which is held
  bool warm = false;         ///< all of it had maps that were of use
  bool presses = false;      ///< the boundary of one of these did so on itself
  std::vector<MetPin> pins;  ///< that its parts were mapped with
};

/// The UVs of a new chart from those of its corners. Where it has parts of several charts, they are
/// aligned with the largest one, or with that which may not move, by similarities along the edges
/// that were sewn; vertices where parts meet lie in the middle, unless they are held. Vertices of
/// holes lie in the middle of their neighbours. Throws Error INVALID_STATE with the face where
/// parts that may not move lie apart.
Carried carry(const Ground& ground, const SessionState& before, const CornerUvs& uvs,
              const AtlasChart& part);

/// Puts the vertices of filled holes, which have no corners of their own, in the middle of their
/// neighbours.
void place_virtual(const AtlasChart& part, std::vector<Vec2>& uvs);

/// Whether a vertex of a chart may not move: it has a face that may not.
std::vector<bool> held_vertices(const SessionState& state, const AtlasChart& part);

/// Mends a start whose faces are not all positive around these, but for `held` vertices, and parts
/// sides of its boundary that lie on each other. Whether it is a start then: no face is folded, and
/// the boundary is simple, or where vertices are held the faces do at least not overlap.
bool mend_start(const DiskMesh& mesh, const std::vector<bool>& held, std::vector<Vec2>& uvs,
                const Work& work);

}  // namespace beltrami
