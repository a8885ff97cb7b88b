// A whole run on a mesh of a test.
#pragma once

#include <utility>

#include "base/work.h"
#include "chart/flatten_disk.h"
#include "chart/flattening.h"
#include "mesh/disk_mesh.h"
#include "multilevel/options.h"
#include "support/disks.h"
#include "support/meshes.h"

namespace beltrami::disks {

/// The map of a disk, as it is delivered.
inline Flattening run(meshes::TriangleList mesh, const ChartOptions& options = {},
                      const Work& work = Work()) {
  const Normalisation frame = normalise(mesh.positions, mesh.faces, Work(1));
  return flatten(disk(std::move(mesh)), frame, options, work);
}

}  // namespace beltrami::disks
