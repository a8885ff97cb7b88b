// What a cut is worth in truth: the charts along it flattened, each without regard to its own
// overlaps.
#pragma once

#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "cut/cut_into_charts.h"
#include "cut/edge_marks.h"
#include "cut/known_maps.h"
#include "mesh/surface.h"

namespace beltrami {

/// The charts of a surface and locally injective maps of them.
struct LocalMaps {
  CutSurface cut;
  std::vector<std::vector<Vec2>> uvs;  ///< per chart, one per vertex, in the unit of the surface
  std::vector<double> energies;  ///< per face of the surface: symmetric Dirichlet, NaN if virtual,
                                 ///< without area or folded
  double energy = 2;             ///< their mean by area, slivers having no say (kSliverShare)
  double p99 = 2;                ///< that exceeded on 1% of the area, likewise
};

/// Flattens every chart of the surface cut along `seams`, by composite majorization to `tolerance`.
/// Charts that were cut out of those of `before` start from their maps, or keep them where they are
/// the same. `known`: of charts of this surface, used and added to. `real_faces`: those after them
/// weigh nothing in the energy. Precondition: all pieces are disks. Throws Error SOLVER.
LocalMaps map_locally(const Surface& surface, Index real_faces, const EdgeMarks& seams,
                      double tolerance, const LocalMaps* before, KnownMaps& known,
                      const Work& work);

/// The maps, those that lie on themselves replaced by others that do not, where these are found:
/// the boundary is kept simple by contact. Their energies are what such charts cost in truth.
/// `before`: the same of other seams, or null: charts that were among its keep their maps.
LocalMaps with_contact(LocalMaps maps, Index real_faces, double tolerance, const LocalMaps* before,
                       KnownMaps& known, const Work& work);

/// Per vertex of the surface what the energies of the maps exceed 2 by on a third of each face
/// around it, by the area of all real faces; empty where these have none.
std::vector<double> excess_around(const Surface& surface, Index real_faces, const LocalMaps& maps);

}  // namespace beltrami
