// The unit of cost: what stock CHOLMOD takes for one sparse solve of a mesh, and how it is timed.
#pragma once

#include <ctime>
#include <functional>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "linear/spd_solver.h"
#include "refine.h"

namespace beltrami::benchmarks {

/// Seconds on CLOCK_MONOTONIC (wall) or CLOCK_PROCESS_CPUTIME_ID.
double seconds(clockid_t clock);

/// The mesh as the stages have it.
std::vector<Vec3> positions_of(const TriangleMesh& file);
std::vector<Triangle> faces_of(const TriangleMesh& file);

/// The interior cotan Laplacian of a mesh, and two right-hand sides.
struct System {
  SparseMatrix lower;
  std::vector<Place> places;
  DenseMatrix rhs;
};
/// The order of the unknowns: as in the file, which is what a user of CHOLMOD has (kAlongCurve
/// saves it up to a tenth), or as the library has them, which the native solver counts on.
enum class Numbering { kOfFile, kAlongCurve };
System interior_laplacian(const TriangleMesh& file, Numbering numbering);

/// CPU seconds of the steps; wall seconds of all.
struct Cost {
  double analyze = 0, factorize = 0, solve = 0, wall = 0, residual = 0;
  double total() const { return analyze + factorize + solve; }
};

/// Runs the steps and takes their times.
Cost measure(const System& system, const std::function<void()>& analyze,
             const std::function<void()>& factorize, const std::function<DenseMatrix()>& solve);

#ifdef BELTRAMI_WITH_CHOLMOD
enum class Unit {
  kUm,  ///< CHOLMOD supernodal, ordered by METIS: analyze + factorize + two solves
  kUa   ///< the same, ordered by AMD
};
/// On one thread if the BLAS is (OPENBLAS_NUM_THREADS=1).
Cost run_cholmod(const System& system, Unit unit);
#endif

}  // namespace beltrami::benchmarks
