#include "multilevel/extras.h"

#include <algorithm>
#include <string>

#include "base/error.h"
#include "flatten/laplacian.h"
#include "multilevel/mode_bytes.h"

namespace beltrami {
namespace {

/// What the allocator holds beyond what is in use, what does not depend on the mesh, and what small
/// meshes may take that need the global fix.
constexpr double kAllocator = 1.08, kConstant = 8 << 20, kLeast = 40 << 20;

/// An extra, as a rule beside the factor of the metric solve.
double extra_bytes(const MeshCounts& n, Extra extra, int threads) {
  switch (extra) {
    case Extra::kLevelHessian:
      return climb_hessian_bytes(n, threads);
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

std::uint64_t run_bytes_with(Extra extra, const DiskMesh& mesh, const ChartOptions& options,
                             const Work& work) {
  const MeshCounts n = counts_of(mesh);
  return run_bytes(n, options, extra_bytes(n, extra, work.threads()));
}

}  // namespace

std::uint64_t run_bytes(const MeshCounts& n, const ChartOptions& options, double stage) {
  // The triangulation is a second disk.
  const double delaunay = options.delaunay ? disk_bytes(n) : 0;
  const double all = kConstant + kAllocator * (context_bytes(n) + delaunay + stage);
  return static_cast<std::uint64_t>(std::max(all, kLeast));
}

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

}  // namespace beltrami
