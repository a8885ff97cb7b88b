// From the map of a mode to the numbers that are delivered: placed, rounded, judged, measured.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/vectors.h"
#include "base/work.h"
#include "chart/flattening.h"
#include "exact/certificate.h"
#include "mesh/disk_mesh.h"
#include "multilevel/chart_map.h"
#include "multilevel/options.h"
#include "repair/rounding.h"

namespace beltrami {

/// A map in the numbers that are delivered, but for a power of two, and what they are worth.
struct Delivery {
  std::vector<Vec2> uvs;          ///< one per vertex, in double precision
  Certificate certificate;        ///< of them
  std::optional<Rounded> single;  ///< in single precision, with the option float32
};

/// The stage "certify": places a map and judges the very numbers that would be returned, after
/// mending what placing and rounding folded. `mesh` is the disk whose faces the map has.
Delivery prepare(const DiskMesh& mesh, const Normalisation& frame, const std::vector<Vec2>& uvs,
                 const ChartOptions& options, const Work& work,
                 std::vector<StageStatistics>& stages);

/// What is wrong with the numbers that were asked for: faces that are not positive, and crossings
/// where the boundary was to stay simple. Where single precision cannot hold the map at all,
/// another one would be no better: then in double precision.
std::int64_t broken_promises(const Delivery& made, const Normalisation& frame,
                             const ChartOptions& options, const Work& work);

/// The map in the unit that was asked for, its verdicts and its energies: of the result uvs,
/// certificates, float32_moves, single_moves, distortion, face_energies and the status, which is
/// NOT_CONVERGED or OK where no greater reservation stands.
Flattening deliver(const DiskMesh& mesh, const Normalisation& frame, Delivery made, bool converged,
                   const ChartOptions& options, const Work& work);

}  // namespace beltrami
