// One disk -> one map: the only place that the ABI knows of this room, but for the estimate of
// memory.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "chart/chart_map.h"
#include "chart/inherited.h"
#include "chart/options.h"
#include "energy/measure.h"
#include "exact/certificate.h"
#include "mesh/disk_mesh.h"

namespace beltrami {

/// OK, or the greatest reservation.
enum class Outcome { kOk, kNotConverged, kNotInjective, kNotInjectiveFloat32 };

/// What a run leaves behind.
struct Flattening {
  Outcome status = Outcome::kOk;
  std::vector<Vec2> uvs;           ///< one per vertex of the disk, as delivered
  std::vector<Triangle> faces;     ///< those of the map if they are not the disk's; else empty
  Certificate certificate;         ///< of `uvs`
  Certificate single_certificate;  ///< of `uvs` in single precision
  std::int64_t float32_moves = 0;  ///< vertices that are not at the nearest place there
  /// These vertices, increasing, and where they are instead; empty where `uvs` are there already.
  std::vector<std::pair<Index, Vec2>> single_moves;
  Distortion distortion;              ///< of `uvs` against the input in its own unit
  std::vector<double> face_energies;  ///< symmetric Dirichlet, one per face
  ChartStatistics statistics;         ///< of the attempt that was kept
  std::int64_t restarts = 0;          ///< attempts after the first
  double seconds = 0, cpu_seconds = 0;
  std::uint64_t peak_memory_bytes = 0;  ///< of the process so far
};

/// Flattens a disk that `normalise` has brought to about unit area; `frame` is what it returned.
/// Where the time of `work` is up, iterations end with the best map so far, NOT_CONVERGED. Throws
/// Cancelled, Error SOLVER or std::bad_alloc.
Flattening flatten(const DiskMesh& disk, const Normalisation& frame, const ChartOptions& options,
                   const Work& work);

/// The same with what is known of the disk, in its numbers and its unit.
Flattening flatten(const DiskMesh& disk, const Normalisation& frame, const Inherited& inherited,
                   const ChartOptions& options, const Work& work);

}  // namespace beltrami
