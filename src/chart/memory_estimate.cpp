// The greatest of what is alive at the peaks of the stages, which the modes tell themselves.
//
// Left out are the extras, which few meshes need and a memory limit forbids, and what takes less
// than the stage after it: orderings, repairs of patches, the certificate.
#include "chart/memory_estimate.h"

#include <algorithm>
#include <string>

#include "base/error.h"
#include "base/types.h"
#include "chart/memory.h"
#include "chart/mode_bytes.h"
#include "chart/policy.h"
#include "flatten/laplacian.h"

namespace beltrami {
namespace {

/// What the allocator holds beyond what is in use, what does not depend on the mesh, and what small
/// meshes may take that need the global fix.
constexpr double kAllocator = 1.08, kConstant = 8 << 20, kLeast = 40 << 20;

bool is_reduced(const ChartOptions& options) {
  const bool flattens = options.flatten == Flatten::kGif || options.flatten == Flatten::kFlim;
  return options.method == Method::kGif || (options.method == Method::kBeltrami && flattens);
}

/// From the coarse map on, in the method beltrami.
double flatten_bytes(const MeshCounts& n, Flatten flatten, int threads) {
  switch (flatten) {
    case Flatten::kDirichlet:
      return dirichlet_bytes(n, threads);
    case Flatten::kGif:
    case Flatten::kFlim:
      return reduced_bytes(n, threads);
    case Flatten::kBff:
      return boundary_first_bytes(n, threads);
    default:
      return metric_bytes(n, threads);
  }
}

/// Meshes that are not simplified are left to composite majorization.
double beltrami_bytes(const MeshCounts& n, const ChartOptions& options, int threads) {
  const auto faces = static_cast<Index>(n.faces);
  const Index coarse = coarse_faces(faces, options.coarse_faces);
  if (coarse >= faces) return cm_bytes(n, true, threads);
  if (is_nested(faces, coarse, options)) return nested_bytes(n, threads);
  return std::max(coarse_bytes(n, options.coarse_faces, threads),
                  flatten_bytes(n, options.flatten, threads));
}

double method_bytes(const MeshCounts& n, const ChartOptions& options, int threads) {
  switch (options.method) {
    case Method::kCm:
      return cm_bytes(n, options.injectivity == Injectivity::kGlobal, threads);
    case Method::kTutte:
      return tutte_bytes(n, threads);
    case Method::kGif:
      return reduced_bytes(n, threads);
    case Method::kBff:
      return boundary_first_bytes(n, threads);
    case Method::kUvProlongation:
      return coarse_bytes(n, options.coarse_faces, threads);
    default:
      return beltrami_bytes(n, options, threads);
  }
}

/// An extra, as a rule beside the factor of the metric solve.
double extra_bytes(const MeshCounts& n, Extra extra, int threads) {
  switch (extra) {
    case Extra::kLevelHessian:
      return nested_hessian_bytes(n, threads);
    case Extra::kWholeFactor:
      return metric_bytes(n, threads);
    case Extra::kNewtonSteps:
      return metric_factor_bytes(n, threads) + newton_bytes(n, threads);
    case Extra::kHarmonicMap:
      return metric_factor_bytes(n, threads) +
             (n.faces * sizeof(EdgeWeights) + harmonic_bytes(n, threads));
    default:
      return metric_factor_bytes(n, threads) + global_fix_bytes(n);
  }
}

/// Of the whole run, from what its greatest stage takes.
std::uint64_t run_bytes(const MeshCounts& n, const ChartOptions& options, double stage) {
  // The triangulation is a second disk.
  const double delaunay = options.delaunay ? disk_bytes(n) : 0;
  const double all = kConstant + kAllocator * (context_bytes(n) + delaunay + stage);
  return static_cast<std::uint64_t>(std::max(all, kLeast));
}

std::uint64_t run_bytes_with(Extra extra, const DiskMesh& mesh, const ChartOptions& options,
                             const Work& work) {
  const MeshCounts n = counts_of(mesh, false);
  return run_bytes(n, options, extra_bytes(n, extra, work.threads()));
}

}  // namespace

bool affords(const DiskMesh& mesh, const ChartOptions& options, Extra extra, const Work& work) {
  return work.memory_limit() == 0 || run_bytes_with(extra, mesh, options, work) <=
                                         static_cast<std::uint64_t>(work.memory_limit());
}

void require_whole_factor(const DiskMesh& mesh, const ChartOptions& options, const Work& work) {
  if (affords(mesh, options, Extra::kWholeFactor, work)) return;
  constexpr std::uint64_t kMebibyte = 1 << 20;
  const std::uint64_t bytes = run_bytes_with(Extra::kWholeFactor, mesh, options, work);
  throw Error(Fault::kOutOfMemory,
              "the mesh cannot be flattened in levels, and at once is estimated to need " +
                  std::to_string((bytes + kMebibyte - 1) / kMebibyte) +
                  " MiB of memory, of which the option memory-limit allows " +
                  std::to_string(static_cast<std::uint64_t>(work.memory_limit()) / kMebibyte) +
                  " MiB: raise it, or flatten a mesh with fewer faces or less noise");
}

std::uint64_t estimate_memory(const DiskMesh& mesh, const ChartOptions& options, int threads) {
  const MeshCounts n = counts_of(mesh, is_reduced(options));
  double stage = method_bytes(n, options, threads);
  if (options.refine) stage = std::max(stage, cm_bytes(n, true, threads));
  return run_bytes(n, options, stage);
}

}  // namespace beltrami
