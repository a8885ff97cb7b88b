// A whole run on a mesh of a test.
#pragma once

#include <atomic>
#include <utility>

#include "chart/pipeline.h"
#include "mesh/disk_mesh.h"
#include "support/disks.h"

namespace beltrami::disks {

/// The map of a disk, as it is delivered.
inline Flattening run(meshes::TriangleList mesh, const Options& options = {},
                      const Progress& progress = {}) {
  const Normalisation frame = normalise(mesh.positions, mesh.faces);
  const std::atomic<bool> cancelled{false};
  return flatten(disk(std::move(mesh)), frame, options, progress, cancelled);
}

}  // namespace beltrami::disks
