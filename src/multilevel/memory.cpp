#include "multilevel/memory.h"

#include <algorithm>
#include <cstdint>
#include <numbers>
#include <vector>

#include "base/portable_math.h"
#include "base/types.h"
#include "base/vectors.h"
#include "linear/cholesky/native_solver.h"
#include "linear/cholesky/symbolic.h"

namespace beltrami {
namespace {

// ---- Measured ----------------------------------------------------------------------------------

/// Numbers of the factor per row and log2(rows). By minimum degree, which is worst where all
/// vertices are alike, 2.0 to 2.7 on scans and 4.7 on regular grids: by so much more there. By
/// nested dissection in space no more than these; and in the plane, for composite majorization
/// starts from Tutte's embedding, which squeezes most of the mesh.
constexpr double kFill = 2.75, kFillOfRegular = 2.5, kFillInPlane = 3.5;
/// Bytes per row of what describes the factor: supernodes and their rows.
constexpr double kSymbolic = 48;
/// Numbers per row in the update matrices of a factorization: on one thread, and on each other.
constexpr double kFronts = 12, kFrontsOfThread = 6.5;
/// Of a factor in single precision, what 16 bits per entry below the diagonal take.
constexpr double kOfCompact = 0.5;
/// The global fix, per face: the corners' entries twice, as they come and scaled; and the factor,
/// with room for as much again while it is made, in numbers of a factor by minimum degree.
constexpr double kEntriesOfFace = 2 * 6 * 16, kFactorOfFix = 2 * (8 + 4);

// ---- Arrays ------------------------------------------------------------------------------------

constexpr double kIndex = sizeof(Index), kReal = sizeof(double), kUv = sizeof(Vec2);
/// Edges per vertex of a triangulation, and so entries below the diagonal.
constexpr double kEdges = 3;
/// Of a solve, beside the right-hand side: a copy and the solution. Where conjugate gradients make
/// up for single precision two copies and the solution, three arrays more and one in single
/// precision.
constexpr double kSolveFields = 2, kSolveFieldsOfSingle = 3 + 3 + 0.5;

double log2_of(double x) {
  return std::numbers::log2e * portable::log(x);
}

/// Entries of the factor, or blocks of it; `fill` is that of a dissection. It never has fewer for
/// more rows, though dissection is better than minimum degree, and left to large systems.
double factor_entries(double rows, double regular, double fill) {
  const auto by_degree = [regular](double count) {
    return (kFill + kFillOfRegular * regular) * count * log2_of(count + 2);
  };
  if (rows < kLeastDissected) return by_degree(rows);
  return std::max(fill * rows * log2_of(rows), by_degree(kLeastDissected));
}

/// With blocks of one. Small systems have it in double precision anyway.
double factor_bytes(const MeshCounts& n, Precision precision, double fill) {
  const auto in_double = [&](double rows) {
    return sizeof(double) * factor_entries(rows, n.regular, fill);
  };
  const double bytes = in_double(n.vertices);
  if (precision == Precision::kDouble || n.vertices < kLeastSingle) return bytes;
  return std::max(0.5 * bytes, in_double(kLeastSingle));
}

}  // namespace

MeshCounts counts_of(const DiskMesh& mesh) {
  std::vector<std::uint8_t> faces_at(mesh.positions.size(), 0);
  for (const Triangle& face : mesh.faces) {
    for (const Index v : face) ++faces_at[v];
  }
  const auto regular = static_cast<double>(std::count(faces_at.begin(), faces_at.end(), 6));
  const double vertices = mesh.vertex_count();
  return {vertices, static_cast<double>(mesh.face_count()),
          static_cast<double>(mesh.boundary.size()), regular / vertices};
}

double disk_bytes(const MeshCounts& n) {
  return n.vertices * (sizeof(Vec3) + kIndex + 1.0 / 8) +
         n.faces * (sizeof(Triangle) + 3 * kIndex) + n.boundary * kIndex;
}

double context_bytes(const MeshCounts& n) {
  return disk_bytes(n) + n.vertices * kIndex + n.faces * kIndex + n.vertices * kUv +
         n.faces * kReal;
}

System system_bytes(const MeshCounts& n, int block, Precision precision, int threads) {
  const double fill = block == 1 ? kFill : kFillInPlane;
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
  const double others = std::min(threads - 1, kMostTasks);
  const double factorizing =
      entries * scalar + squares * scalar * (kFronts + kFrontsOfThread * others);
  const double solving = rows * kUv * (single ? kSolveFieldsOfSingle : kSolveFields);
  return {kept, kept + std::max(factorizing, solving), rows * kSymbolic + kOfCompact * factor};
}

double global_fix_bytes(const MeshCounts& n) {
  // The ring makes it a few faces and vertices more.
  const double entries =
      (kFill + kFillOfRegular * n.regular) * n.vertices * log2_of(n.vertices + 2);
  return (n.faces + 2 * n.boundary) * (sizeof(Triangle) + kEntriesOfFace) + 8 * n.vertices * kUv +
         kFactorOfFix * entries;
}

}  // namespace beltrami
