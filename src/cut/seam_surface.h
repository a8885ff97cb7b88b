// The surfaces on which seams are sought, coarser and coarser, and the way of seams back.
#pragma once

#include <vector>

#include "base/types.h"
#include "base/work.h"
#include "cut/edge_marks.h"
#include "cut/seam_costs.h"
#include "mesh/surface.h"
#include "simplify/history.h"

namespace beltrami {

/// A surface on which seams are sought.
struct SeamSurface {
  Surface surface;
  Index real_faces = 0;
  EdgeMarks locked;  ///< or none
  SeamHints hints;
  std::vector<double> cost;        ///< per half-edge, what a seam along it costs
  std::vector<double> factor;      ///< per vertex, what seams there cost for their length by shape
  std::vector<Index> fine_vertex;  ///< per vertex; empty: this is the finer surface itself
  CollapseHistory history;         ///< from the finer surface to this
  double straightness = 0;         ///< of seams, as SeamWeights has it
};

/// Per half-edge what a path along it costs: infinite along locked edges.
std::vector<double> path_costs(const SeamSurface& coarse);

/// Faces to which a surface is simplified that is to have about `faces`: more where components
/// would keep too few, all where that is hardly more.
Index coarse_target(const Surface& fine, const Topology& topology, Index faces);

/// A simplification of `fine` to the coarse_target of `faces`, or `fine` itself. Faces after
/// `real_faces` are virtual: edges among them cost little, for no seam will be there. A coarse
/// surface knows of no locked edges.
SeamSurface make_seam_surface(const Surface& fine, Index real_faces, const Topology& topology,
                              const EdgeMarks& locked, Index faces, const SeamWeights& weights,
                              const SeamHints& hints, const Work& work);

/// What seams cost on the finer surface, its shape being judged on the coarse one: as at the coarse
/// vertices that its own became. Precondition: the coarse one is no copy of it.
std::vector<double> finer_costs(const SeamSurface& coarse, const Surface& fine, Index real_faces,
                                const SeamWeights& weights, const SeamHints& hints,
                                const Work& work);

/// Seams, and the vertices in which paths ended.
struct AnchoredSeams {
  EdgeMarks seams;
  std::vector<bool> anchors;  ///< per vertex
};

/// Seams of a coarse surface on the finer one, straightened there by `cost`. Those that were
/// carried to locked edges and cannot leave them are left out.
AnchoredSeams carry_to_finer(const SeamSurface& coarse, const Surface& fine,
                             std::vector<double> cost, const EdgeMarks& locked,
                             const AnchoredSeams& seams, const Work& work);

}  // namespace beltrami
