// The cheapest path between the two borders of an annulus.
#pragma once

#include <functional>
#include <vector>

#include "base/types.h"
#include "cut/edge_marks.h"
#include "mesh/surface.h"

namespace beltrami {

/// Paths across the annuli that seams and borders bound, which make disks of them. What it needs of
/// the surface's size is made once: a path takes time by the shorter loop, and n log n of what is
/// within reach of it.
class PathsAcross {
 public:
  /// `is_on`: whether a seam or border is at a vertex; `cost`: per half-edge, both of an edge
  /// alike. Keeps references to all but the function, and they may change between calls.
  PathsAcross(const Surface& surface, const EdgeMarks& seams, std::function<bool(Index)> is_on,
              const std::vector<double>& cost);

  /// From the loop of a side (a half-edge of a seam or border) of an annulus to the other loop: the
  /// half-edges of the cheapest path, empty if none costs less than `bound`.
  std::vector<Index> from_loop(Index side, double bound);

  /// Where an arc of seams was taken away, `first` and `last` are its ends' half-edges, both of
  /// them away from its ends: the same between the loops that it joined. Empty if it joined one
  /// with itself, or no other seam is at an end. Precondition: before, the pieces were disks.
  std::vector<Index> between_ends(Index first, Index last, double bound);

 private:
  /// On the way along a loop.
  struct Trace {
    Index start, at;
    std::vector<Index> spokes = {};  ///< that leave the loop into the piece
    bool is_closed = false;
  };

  bool is_side(Index h) const { return seams_[h] || surface_.twin[h] == kNone; }
  Index side_beside(Index spoke) const;
  void advance(Trace& trace) const;
  std::vector<Index> from_spokes(const std::vector<Index>& spokes, double bound);

  const Surface& surface_;
  const EdgeMarks& seams_;
  const std::function<bool(Index)> is_on_;
  const std::vector<double>& cost_;
  std::vector<bool> leaves_;   ///< per half-edge, whether it is one of the spokes
  std::vector<double> costs_;  ///< per vertex, infinite between calls
  std::vector<Index> from_;    ///< per vertex that has a cost, the half-edge by which it is reached
};

}  // namespace beltrami
