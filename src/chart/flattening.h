// What flattening a disk leaves behind.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "energy/measure.h"
#include "exact/certificate.h"
#include "multilevel/chart_map.h"

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

}  // namespace beltrami
