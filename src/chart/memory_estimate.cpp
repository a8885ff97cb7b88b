// The stages, one after the other: what is alive when each is at its peak. Sizes of arrays are
// counted from the types of their items; what cannot be counted is in the table below, to be
// measured again with `./dev bench memory` whenever a kernel changes.
//
// Left out are the extras, which few meshes need and a memory limit forbids, and what takes less
// than the stage after it: orderings, repairs of patches, the certificate.
#include "chart/memory_estimate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/portable_math.h"
#include "base/types.h"
#include "chart/run.h"
#include "flatten/laplacian.h"
#include "flatten/metric.h"
#include "flatten/reduced/meta_vertices.h"
#include "flatten/reduced/reduced.h"
#include "linear/cholesky/native_solver.h"
#include "linear/spd_solver.h"
#include "mesh/disk_mesh.h"
#include "mesh/rest_shape.h"
#include "prolong/prolongation.h"

namespace beltrami {
namespace {

// ---- Measured ----------------------------------------------------------------------------------

/// Numbers of the factor per row and log2(rows). By minimum degree, which is worst where all
/// vertices are alike: 2.0 to 2.7 on scans, 4.7 on regular grids. By nested dissection in space,
/// and in the plane: composite majorization starts from Tutte's embedding, which squeezes most of
/// the mesh.
constexpr double kFillByDegree = 2.7, kFillOfRegular = 2.5;
constexpr double kFillInSpace = 2.75, kFillInPlane = 3.5;
/// Bytes per row of what describes the factor: supernodes and their rows.
constexpr double kSymbolic = 48;
/// Numbers per row in the update matrices of a factorization: on one thread, and on each other.
constexpr double kFronts = 12, kFrontsOfThread = 6.5;
/// Threads that a factorization keeps busy: it has so many tasks.
constexpr double kMostTasks = 96;
/// Bytes per fine vertex of the simplifier's surface and its candidates.
constexpr double kSimplify = 225;
/// GIF and FLIM: samples besides the metas' own, each with rows of three vertices and two edges; of
/// the Newton systems, which are dense, the matrix and its factor.
constexpr double kSamples = 2000, kRowsOfSample = 5, kNewtonCopies = 2;
/// The global fix, per face: the corners' entries twice, as they come and scaled; and the factor,
/// with room for as much again while it is made, in numbers of a factor by minimum degree.
constexpr double kEntriesOfFace = 2 * 6 * 16, kFactorOfFix = 2 * (8 + 4);
/// What the allocator holds beyond what is in use, what does not depend on the mesh, and what small
/// meshes may take that need the global fix.
constexpr double kAllocator = 1.08, kConstant = 8 << 20, kLeast = 40 << 20;

// ---- Arrays ------------------------------------------------------------------------------------

constexpr double kIndex = sizeof(Index), kReal = sizeof(double), kUv = sizeof(Vec2);
/// Edges per vertex of a triangulation, and so entries below the diagonal.
constexpr double kEdges = 3;
/// L-BFGS: a step and a change of the gradient for each of 5 pairs, 5 buffers, and the three arrays
/// of a preconditioning.
constexpr double kPolishFields = 2 * 5 + 5 + 3;
/// Of a solve, beside the right-hand side: a copy and the solution. Where conjugate gradients make
/// up for single precision two copies and the solution, three arrays more and one in single
/// precision.
constexpr double kSolveFields = 2, kSolveFieldsOfSingle = 3 + 3 + 0.5;

struct Counts {
  double vertices, faces, boundary;
  double regular;  ///< share of the vertices that have six faces
  double metas;    ///< of the reduced flattening
};

bool is_reduced(const Options& options) {
  const bool flattens =
      options.method == BELTRAMI_METHOD_BELTRAMI &&
      (options.flatten == BELTRAMI_FLATTEN_GIF || options.flatten == BELTRAMI_FLATTEN_FLIM);
  return flattens || options.method == BELTRAMI_METHOD_GIF;
}

Counts counts_of(const DiskMesh& mesh, const Options& options) {
  std::vector<std::uint8_t> faces_at(mesh.positions.size(), 0);
  for (const Triangle& face : mesh.faces) {
    for (const Index v : face) ++faces_at[v];
  }
  const auto regular = static_cast<double>(std::count(faces_at.begin(), faces_at.end(), 6));
  const double vertices = mesh.vertex_count();
  const Index metas = is_reduced(options) ? choose_meta_vertices(mesh).count() : 0;
  return {vertices, static_cast<double>(mesh.face_count()),
          static_cast<double>(mesh.boundary.size()), regular / vertices,
          static_cast<double>(std::min(metas, kMostMetas))};
}

double disk_bytes(const Counts& n) {
  return n.vertices * (sizeof(Vec3) + kIndex + 1.0 / 8) +
         n.faces * (sizeof(Triangle) + 3 * kIndex) + n.boundary * kIndex;
}

/// What the context holds: the disk, the input's numbers, and the results of a run.
double context_bytes(const Counts& n) {
  return disk_bytes(n) + n.vertices * kIndex + n.faces * kIndex + n.vertices * kUv +
         n.faces * kReal;
}

// ---- Systems -----------------------------------------------------------------------------------

/// A matrix of the mesh with its factor. `kept`: from the factorization to the end; `peak`: that
/// and what factorizing or solving takes on top.
struct System {
  double kept, peak;
};

double log2_of(double x) {
  return std::numbers::log2e * portable::log(x);
}

/// Entries of the factor, or blocks of it; `fill` is that of a dissection. It never has fewer for
/// more rows, though dissection is better than minimum degree, and left to large systems.
double factor_entries(double rows, double regular, double fill) {
  const auto by_degree = [regular](double count) {
    return (kFillByDegree + kFillOfRegular * regular) * count * log2_of(count + 2);
  };
  if (rows < kLeastDissected) return by_degree(rows);
  return std::max(fill * rows * log2_of(rows), by_degree(kLeastDissected));
}

/// With blocks of one. Small systems have it in double precision anyway.
double factor_bytes(const Counts& n, Precision precision, double fill) {
  const auto in_double = [&](double rows) {
    return sizeof(double) * factor_entries(rows, n.regular, fill);
  };
  const double bytes = in_double(n.vertices);
  if (precision == Precision::kDouble || n.vertices < kLeastSingle) return bytes;
  return std::max(0.5 * bytes, in_double(kLeastSingle));
}

/// Of blocks of one in space, of two in the plane.
System system_bytes(const Counts& n, int block, Precision precision, int threads) {
  const double fill = block == 1 ? kFillInSpace : kFillInPlane;
  const bool single = precision == Precision::kSingle;
  const double scalar = single ? sizeof(float) : sizeof(double);
  const double rows = n.vertices, squares = rows * block * block;
  const double entries = rows * (0.5 * block * (block + 1)) + kEdges * squares;
  const double matrix =
      entries * (sizeof(double) + sizeof(int)) + rows * (1 + block) * kIndex + n.faces * 3 * kIndex;
  const double pattern = entries * 2 * sizeof(int) + rows * block * sizeof(int);
  const double factor = block * block * factor_bytes(n, precision, fill);
  const double scaled = single ? entries * kReal + rows * block * 2 * kReal : 0;
  const double kept = matrix + pattern + rows * kSymbolic + scaled + factor;
  const double others = std::min(threads - 1.0, kMostTasks);
  const double factorizing =
      entries * scalar + squares * scalar * (kFronts + kFrontsOfThread * others);
  const double solving = rows * kUv * (single ? kSolveFieldsOfSingle : kSolveFields);
  return {kept, kept + std::max(factorizing, solving)};
}

// ---- Stages ------------------------------------------------------------------------------------

/// Newton's method on all faces, without the map itself.
double newton_bytes(const Counts& n, int threads) {
  const double fields = 5 * n.vertices * kUv + n.faces * kReal;  // and the weights of the faces
  return fields + system_bytes(n, 2, Precision::kDouble, threads).peak;
}

/// Composite majorization from Tutte's embedding; in a scaffold, the mesh is copied into it.
double cm_bytes(const Counts& n, int threads, bool scaffold) {
  const double copies =
      scaffold ? n.faces * (sizeof(Triangle) + sizeof(RestTriangle)) + n.vertices * kUv : 0;
  return n.faces * sizeof(RestTriangle) + n.vertices * kUv + copies + newton_bytes(n, threads);
}

double tutte_bytes(const Counts& n) {
  return 3 * n.vertices * kUv + system_bytes(n, 1, Precision::kDouble, 1).peak;
}

/// What is known of the fine mesh from the prolongation on, the map with it.
double fine_bytes(const Counts& n) {
  return n.faces * (sizeof(RestTriangle) + sizeof(FaceMetric)) + n.vertices * (kIndex + kUv);
}

/// The harmonic map in the prolonged Beltrami coefficients.
double harmonic_bytes(const Counts& n, int threads) {
  return n.faces * sizeof(Cotangents) + 2 * n.vertices * kUv +
         system_bytes(n, 1, Precision::kSingle, threads).peak;
}

/// What is alive beside the work of the metric mode: the problem, and where the coarse map has the
/// boundary.
double metric_problem_bytes(const Counts& n) {
  return fine_bytes(n) + n.vertices * kUv;
}

/// The metric solve, then L-BFGS with its factor.
double metric_bytes(const Counts& n, int threads) {
  const System system = system_bytes(n, 1, Precision::kSingle, threads);
  const double solve = n.faces * sizeof(EdgeWeights) + system.peak;
  const double polish = system.kept + kPolishFields * n.vertices * kUv;
  return metric_problem_bytes(n) + std::max(solve, polish);
}

/// Beside what the repair was given: the ring makes it a few faces and vertices more.
double global_fix_bytes(const Counts& n) {
  const double entries =
      (kFillByDegree + kFillOfRegular * n.regular) * n.vertices * log2_of(n.vertices + 2);
  return (n.faces + 2 * n.boundary) * (sizeof(Triangle) + kEntriesOfFace) + 8 * n.vertices * kUv +
         kFactorOfFix * entries;
}

/// An extra beside the factor of the metric solve.
double extra_bytes(const Counts& n, Extra extra, int threads) {
  if (extra == Extra::kGlobalFix) {
    return metric_problem_bytes(n) + system_bytes(n, 1, Precision::kSingle, threads).kept +
           global_fix_bytes(n);
  }
  const double factor = system_bytes(n, 1, Precision::kSingle, threads).kept;
  const double work = extra == Extra::kNewtonSteps
                          ? newton_bytes(n, threads)
                          : n.faces * sizeof(EdgeWeights) + harmonic_bytes(n, threads);
  return metric_problem_bytes(n) + factor + work;
}

/// GIF and FLIM: a factor in double precision, then rows of the basis, which is dense.
double reduced_bytes(const Counts& n) {
  const double metas = n.metas;
  const double basis = kRowsOfSample * std::min(kSamples + metas, n.faces) * metas * kReal +
                       kNewtonCopies * 4 * metas * metas * kReal;
  const System system = system_bytes(n, 1, Precision::kDouble, 1);
  return fine_bytes(n) + n.faces * sizeof(Cotangents) + n.vertices * kUv +
         std::max(system.peak, system.kept + basis);
}

double boundary_first_bytes(const Counts& n) {
  // Columns of curvatures and of factors, the places, and products of the Laplacian with them.
  return fine_bytes(n) + 5 * n.vertices * kUv + system_bytes(n, 1, Precision::kSingle, 1).peak;
}

/// As if the simplifier kept the shares of vertices and boundary edges.
Counts coarse_counts(const Counts& n, const Options& options) {
  const auto faces = static_cast<double>(coarse_faces(static_cast<Index>(n.faces), options));
  const double share = faces / n.faces;
  return {share * n.vertices, share * n.faces, share * n.boundary, n.regular, n.metas};
}

/// Whether there is a coarse mesh; smaller meshes are left to composite majorization.
bool simplifies(const Counts& n, const Options& options) {
  return coarse_counts(n, options).faces < n.faces;
}

/// Everything up to the coarse map.
double coarse_bytes(const Counts& n, const Options& options) {
  const Counts coarse = coarse_counts(n, options);
  const double nearby = n.vertices * kIndex;
  return std::max(n.vertices * kSimplify,
                  nearby + disk_bytes(coarse) + cm_bytes(coarse, options.threads, true));
}

/// From there on, in the method beltrami.
double flatten_bytes(const Counts& n, const Options& options) {
  switch (options.flatten) {
    case BELTRAMI_FLATTEN_DIRICHLET:
      return fine_bytes(n) + harmonic_bytes(n, options.threads);
    case BELTRAMI_FLATTEN_GIF:
    case BELTRAMI_FLATTEN_FLIM:
      return reduced_bytes(n);
    case BELTRAMI_FLATTEN_BFF:
      return boundary_first_bytes(n);
    default:
      return metric_bytes(n, options.threads);
  }
}

double method_bytes(const Counts& n, const Options& options) {
  switch (options.method) {
    case BELTRAMI_METHOD_CM:
      return cm_bytes(n, options.threads, options.injectivity == BELTRAMI_INJECTIVITY_GLOBAL);
    case BELTRAMI_METHOD_TUTTE:
      return tutte_bytes(n);
    case BELTRAMI_METHOD_GIF:
      return reduced_bytes(n);
    case BELTRAMI_METHOD_BFF:
      return boundary_first_bytes(n);
    case BELTRAMI_METHOD_UV_PROLONGATION:
      return coarse_bytes(n, options);
    default:
      return simplifies(n, options) ? std::max(coarse_bytes(n, options), flatten_bytes(n, options))
                                    : cm_bytes(n, options.threads, true);
  }
}

/// Of the whole run, from what its greatest stage takes.
std::uint64_t run_bytes(const Counts& n, const Options& options, double stage) {
  // The triangulation is a second disk.
  const double delaunay = options.delaunay ? disk_bytes(n) : 0;
  const double all = kConstant + kAllocator * (context_bytes(n) + delaunay + stage);
  return static_cast<std::uint64_t>(std::max(all, kLeast));
}

}  // namespace

bool affords(const DiskMesh& mesh, const Options& options, Extra extra) {
  if (options.memory_limit == 0) return true;
  const Counts n = counts_of(mesh, options);
  return run_bytes(n, options, extra_bytes(n, extra, options.threads)) <=
         static_cast<std::uint64_t>(options.memory_limit);
}

std::uint64_t estimate_memory(const DiskMesh& mesh, const Options& options) {
  const Counts n = counts_of(mesh, options);
  double stage = method_bytes(n, options);
  if (options.refine) stage = std::max(stage, cm_bytes(n, options.threads, true));
  return run_bytes(n, options, stage);
}

}  // namespace beltrami
