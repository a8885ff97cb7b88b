// Paths of edges that turn little where the surface does not.
#pragma once

#include <span>
#include <vector>

#include "base/interrupt.h"
#include "base/types.h"
#include "base/vectors.h"
#include "cut/edge_marks.h"
#include "cut/seam_patch.h"
#include "mesh/surface.h"

namespace beltrami {

/// The cost of turns: a turn by t from one edge into the next costs weight (1 - cos t) of the mean
/// of what these cost. It is measured in the surface, the angles around a vertex being spread
/// evenly over the full circle: on a cone the straightest way has as much on either side (Polthier
/// & Schmies 1998).
class Turning {
 public:
  /// `cost`: per half-edge. Keeps references.
  Turning(const Surface& surface, const std::vector<double>& cost, double weight)
      : surface_(surface), cost_(cost), weight_(weight) {}

  double weight() const { return weight_; }

  /// Of the turn between two half-edges of a path, the second from where the first ends, off the
  /// border. kNone for one of them: of none.
  double cost(Index in, Index out) const;

  /// A part of a path, and the half-edges before and after it, or kNone.
  struct Piece {
    std::span<const Index> path;
    Index before = kNone, after = kNone;
  };

  /// With its turns.
  double cost(const Piece& piece) const;

  /// The half-edges of the cheapest path through the patch with its turns, also those into and out
  /// of it, between the ends of the piece; none where that is not below `query.below`, or touches
  /// itself. The query is for the goal, and through all.
  std::vector<Index> cheapest(const Piece& piece, const SeamPatch& patch, const PathQuery& query,
                              const EdgeMarks& locked, const EdgeMarks& seams);

 private:
  /// A half-edge out of a vertex of a patch, as a path may take it.
  struct Way {
    Index halfedge;
    Vec2 direction;  ///< around its origin
    double so_far;   ///< what a path with it costs
    Index last;      ///< the way before it, or kNone
  };
  void fan_out(const SeamPatch& patch);
  double turn(const Way& in, const Way& out) const;

  const Surface& surface_;
  const std::vector<double>& cost_;
  double weight_;
  std::vector<Way> ways_;     ///< out of the vertices of a patch
  std::vector<Index> first_;  ///< per vertex of the patch and one more: its first way
  PollSometimes poll_;
};

}  // namespace beltrami
