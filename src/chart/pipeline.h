// The order of the stages, their progress, cancellation and statistics. The only place that knows
// how the stages fit together.
#pragma once

#include <beltrami/beltrami.h>

#include <atomic>
#include <functional>
#include <utility>
#include <vector>

#include "base/types.h"
#include "base/work.h"
#include "energy/energy.h"
#include "energy/measure.h"
#include "exact/certificate.h"
#include "mesh/disk_mesh.h"

namespace beltrami {

/// Values of the BELTRAMI_OPTION_ keys; the ABI's option table holds their ranges and words.
struct Options {
  std::int32_t method = BELTRAMI_METHOD_BELTRAMI;
  Energy energy = Energy::kSymmetricDirichlet;
  std::int64_t coarse_faces = 0;  ///< 0: max(1% of the faces, 10,000)
  double tolerance = 1e-4;
  int max_iterations = 500;
  int threads = 1;
  bool unit_square = false;
  std::int32_t flatten = BELTRAMI_FLATTEN_METRIC;
  std::int32_t injectivity = BELTRAMI_INJECTIVITY_AUTO;
  bool refine = false;
  int refine_iterations = 0;  ///< 0: to the stopping rule of CM
  double time_limit = 0;      ///< wall seconds after which refinement stops; 0: none
  bool float32 = false;       ///< deliver single-precision numbers
  bool delaunay = false;      ///< flatten on the intrinsic Delaunay triangulation

  /// Bytes that the run is to stay within by its estimate; 0: any number.
  std::int64_t memory_limit = 0;
};

struct StageStatistics {
  const char* name;
  int iterations = 0;  ///< 0 where a stage does not iterate
  double seconds = 0, cpu_seconds = 0;
};

/// What a run leaves behind.
struct Flattening {
  beltrami_status status = BELTRAMI_OK;  ///< OK, or the greatest reservation
  std::vector<Vec2> uvs;                 ///< one per vertex of the disk, as delivered
  Certificate certificate;               ///< of `uvs`
  Certificate single_certificate;        ///< of `uvs` in single precision
  std::int64_t float32_moves = 0;        ///< vertices that are not at the nearest place there
  /// These vertices, increasing, and where they are instead; empty where `uvs` are there already.
  std::vector<std::pair<Index, Vec2>> single_moves;
  Distortion distortion;                ///< of `uvs` against the input in its own unit
  std::vector<double> face_energies;    ///< symmetric Dirichlet, one per face
  std::vector<StageStatistics> stages;  ///< in the order in which they ran
  std::int64_t coarse_faces = 0;        ///< of the mesh that CM ran on
  double coarse_energy = 0;             ///< its mean energy there, 0 where CM did not run
  std::int64_t flips_before_repair = 0;
  std::int64_t kernel_fixes = 0, patch_fixes = 0, global_fixes = 0;  ///< see repair.h
  std::int64_t restarts = 0;  ///< with a coarser mesh, after a map that broke its promise
  std::int64_t delaunay_flips = 0, delaunay_refused = 0;  ///< see intrinsic_delaunay.h
  std::vector<Triangle> faces;       ///< those of the map if they are not the disk's; else empty
  std::int64_t cleaned_patches = 0;  ///< see outliers.h
  double seconds = 0, cpu_seconds = 0;
  std::uint64_t peak_memory_bytes = 0;  ///< of the process so far
};

/// Flattens a disk that `normalise` has brought to about unit area; `frame` is what it returned.
/// `cancelled` may be set from another thread. Throws Cancelled, Error SOLVER or std::bad_alloc.
Flattening flatten(const DiskMesh& disk, const Normalisation& frame, const Options& options,
                   const Progress& progress, const std::atomic<bool>& cancelled);

}  // namespace beltrami
