// From the disk to what its flattening needs to know: the coarse map, and its metric on the fine
// faces.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "flatten/laplacian.h"
#include "mesh/disk_mesh.h"
#include "mesh/rest_shape.h"
#include "multilevel/chart_map.h"
#include "multilevel/options.h"
#include "prolong/prolongation.h"
#include "repair/repair.h"
#include "simplify/coarse.h"

namespace beltrami {

struct MapProblem {
  const DiskMesh* mesh;  ///< that is flattened: the input, or `retriangulated`
  std::unique_ptr<DiskMesh> retriangulated = nullptr;
  CoarseDisk coarse = {};             ///< without vertices where there is none
  std::vector<Vec2> coarse_uvs = {};  ///< one per coarse vertex
  bool in_contact = false;            ///< parts of the coarse boundary press on each other
  std::vector<RestTriangle> rest = {};
  std::vector<FaceMetric> metric = {};
  std::vector<Cotangents> cotangents = {};  ///< for the harmonic solves
  bool converged = true;                    ///< the coarse map
  ChartStatistics statistics = {};          ///< of what led here
};

/// The stage "simplify", to `target` faces; from a `level` of the mesh, if there is one that is
/// finer than that.
void simplify_fine(Index target, const std::optional<CoarseDisk>& level, const Work& work,
                   MapProblem& fine);

/// The stage "coarse": composite majorization of the coarse mesh. Throws Error SOLVER.
void solve_coarse(const ChartOptions& options, const Work& work, MapProblem& fine);

/// The stage `name`: the metric of the fine faces, that of the coarse map or of the surface where
/// there is no coarse mesh, and for `harmonic` solves the cotangents. With the option delaunay the
/// faces are those of the intrinsic Delaunay triangulation.
void measure_fine(const char* name, bool harmonic, const ChartOptions& options, const Work& work,
                  MapProblem& fine);

/// The stage "repair": mends flips and, on demand, crossings of the boundary, by `how`; where that
/// succeeds, cleans outliers. Returns whether all faces are positive.
bool mend(const MapProblem& fine, const RepairOptions& how, const ChartOptions& options,
          const Work& work, ChartMap& map);

/// With all that the memory of the run allows.
RepairOptions whole_repair(const MapProblem& fine, bool simple_boundary,
                           const ChartOptions& options, const Work& work);

/// The whole: `map` after what led to its problem.
ChartMap joined(MapProblem fine, ChartMap map);

}  // namespace beltrami
