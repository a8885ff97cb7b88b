// The memory that each mode takes at its peak: without the context and, of the modes that take a
// MapProblem, with it. Each is beside its mode; memory_estimate.h puts them together.
#pragma once

#include <cstdint>

#include "multilevel/memory.h"

namespace beltrami {

/// Newton's method on all faces, without the map itself.
double newton_bytes(const MeshCounts& n, int threads);
/// From Tutte's embedding on; in a scaffold, the mesh is copied into it.
double cm_bytes(const MeshCounts& n, bool scaffold, int threads);
double metric_bytes(const MeshCounts& n, int threads);
/// The metric mode's problem, and the factor of its solve: what is alive beside its extras.
double metric_factor_bytes(const MeshCounts& n, int threads);
/// The harmonic map beside another.
double harmonic_bytes(const MeshCounts& n, int threads);
/// In levels, where the finest needs no factor.
double climb_bytes(const MeshCounts& n, int threads);
/// The same with a Hessian of the level below the finest.
double climb_hessian_bytes(const MeshCounts& n, int threads);
double dirichlet_bytes(const MeshCounts& n, int threads);

/// Bytes of what is known from the prolongation on, the map with it.
double fine_bytes(const MeshCounts& n);

/// Bytes at the peak of everything up to the coarse map, for `asked` coarse faces.
double coarse_bytes(const MeshCounts& n, std::int64_t asked, int threads);

}  // namespace beltrami
