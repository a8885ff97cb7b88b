// The shortest seams with which a surface flattens to a distortion that is asked for.
#pragma once

#include <memory>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "cut/edge_marks.h"
#include "cut/known_maps.h"
#include "cut/mirror.h"
#include "cut/seam_costs.h"
#include "cut/seam_surface.h"
#include "cut/seam_target.h"
#include "cut/search_effort.h"
#include "mesh/surface.h"

namespace beltrami {

/// What a search leaves to one of the same surface for another target.
struct BegunSearch {
  std::shared_ptr<const SeamSurface> coarse;  ///< on which seams were decided; null: none were
  AnchoredSeams seams;  ///< what was found there; empty where no coarser one was searched
  std::shared_ptr<const Mirror> mirror;  ///< that the seams are symmetric to; null: none
  std::shared_ptr<KnownMaps> maps;       ///< of charts of the coarse surface; null: none yet
};

struct SearchedSeams {
  EdgeMarks seams;    ///< on the surface given
  double energy = 2;  ///< of the maps along them that judged, most often coarse ones
  BegunSearch search;
  /// The maps, where the surface is its own coarse one or the seams were finished on it, and is cut
  /// at all: per chart of it cut along the seams.
  std::vector<std::vector<Vec2>> maps;
};

/// Marks seams that make disks of all components, so short as they are found, along which the maps
/// have the energy asked for. (Where seams of a simplified surface were carried to locked edges and
/// cannot leave them, these are left out, and a piece may be no disk.) All of it is decided on a
/// coarse surface, by a model of the maps and then by maps, and carried to the fine one.
/// `real_faces`: those after them are virtual, they weigh and cost nothing. `locked`: edges that
/// are not to be cut where there is a way, or none. `begun`: the search of the same for another
/// target, from whose seams this one goes on, if there are any. When the time of the work is up the
/// search ends with the best seams so far. Preconditions: `topology` is the
/// surface's; hints are of its vertices and faces; area about 1. Throws Error SOLVER.
SearchedSeams search_seams(const Surface& surface, Index real_faces, const Topology& topology,
                           const EdgeMarks& locked, const SeamTarget& target,
                           const SearchEffort& effort, const SeamWeights& weights,
                           const SeamHints& hints, const BegunSearch& begun, const Work& work);

}  // namespace beltrami
