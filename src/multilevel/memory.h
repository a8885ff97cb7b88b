// What the modes' estimates of memory are made of. Sizes of arrays are counted from the types of
// their items; what cannot be counted is measured, to be measured again with `./dev bench memory`
// whenever a kernel changes.
#pragma once

#include "linear/spd_solver.h"
#include "mesh/disk_mesh.h"

namespace beltrami {

/// What the estimates know of a mesh.
struct MeshCounts {
  double vertices, faces, boundary;
  double regular;    ///< share of the vertices that have six faces
  double metas = 0;  ///< of the reduced flattening, where that is the mode
};

/// Counts a mesh, but for its meta vertices.
MeshCounts counts_of(const DiskMesh& mesh);

double disk_bytes(const MeshCounts& n);

/// What the context holds: the disk, the input's numbers, and the results of a run.
double context_bytes(const MeshCounts& n);

/// Bytes of a matrix of the mesh with its factor. `kept`: from the factorization to the end;
/// `peak`: that and what factorizing or solving takes on top; `preconditioner`: what is left of it
/// once it serves as one alone, in single precision.
struct System {
  double kept, peak, preconditioner;
};

/// Of blocks of one, ordered in space, or of two, ordered in the plane.
System system_bytes(const MeshCounts& n, int block, Precision precision, int threads);

/// The global fix of the repair, beside what it was given.
double global_fix_bytes(const MeshCounts& n);

}  // namespace beltrami
