// The greatest of what is alive at the peaks of the stages, which the modes tell themselves.
//
// Left out are the extras, which few meshes need and a memory limit forbids, and what takes less
// than the stage after it: orderings, repairs of patches, the certificate.
#include "chart/memory_estimate.h"

#include <algorithm>

#include "base/types.h"
#include "baselines/baselines.h"
#include "multilevel/extras.h"
#include "multilevel/memory.h"
#include "multilevel/mode_bytes.h"
#include "multilevel/policy.h"

namespace beltrami {
namespace {

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
  if (has_levels(faces, coarse, options)) return climb_bytes(n, threads);
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

}  // namespace

std::uint64_t estimate_memory(const DiskMesh& mesh, const ChartOptions& options, int threads) {
  MeshCounts n = counts_of(mesh);
  if (is_reduced(options)) n.metas = count_metas(mesh);
  double stage = method_bytes(n, options, threads);
  if (options.refine) stage = std::max(stage, cm_bytes(n, true, threads));
  return run_bytes(n, options, stage);
}

}  // namespace beltrami
