// The disk around a part of the seams, and shortest paths through it.
#pragma once

#include <array>
#include <vector>

#include "base/interrupt.h"
#include "base/types.h"
#include "cut/edge_marks.h"
#include "mesh/surface.h"

namespace beltrami {

/// Shortest paths from one vertex through a patch, each entry of a vertex of it.
struct PathTree {
  std::vector<double> distance;   ///< infinite where none leads
  std::vector<Index> reached_by;  ///< the half-edge that leads there, or kNone
};

/// What paths are sought. Vertices are those of the surface, kNone where there is none.
struct PathQuery {
  Index start;
  double below;                                        ///< they cost less
  Index goal = kNone;                                  ///< the path to it will do
  std::array<Index, 2> through_none = {kNone, kNone};  ///< they may end here, but not go on
  Index not_between = kNone;                           ///< nor along an edge from the start here
};

/// The complex that is induced by vertices of a surface, which have numbers of their own in it, in
/// the order in which they were added.
class SeamPatch {
 public:
  /// Keeps a reference.
  explicit SeamPatch(const Surface& surface)
      : surface_(surface), number_(surface.positions.size(), kNone) {}

  void clear();
  Index number(Index v) const { return number_[v]; }  ///< kNone: not of the patch
  Index vertex(Index number) const { return vertices_[number]; }
  Index size() const { return size_of(vertices_); }
  /// Of a connected patch, which is no closed surface: whether it can be shrunk to a point.
  bool is_disk() const { return euler_ == 1; }

  void add(Index v) { add(v, euler_with(v)); }
  /// Adds so many rings of vertices of degree 0 off the border, those with which the patch stays
  /// connected and holes in it become no more. `degree`: per vertex of the surface.
  void grow(Index rings, const std::vector<Index>& degree);

  /// Shortest paths from the start (Dijkstra 1959), through the inside of the surface, and along
  /// locked edges where they are seams. `cost`: per half-edge; `locked`: or none.
  void find_paths(const PathQuery& query, const std::vector<double>& cost, const EdgeMarks& locked,
                  const EdgeMarks& seams, PathTree& tree);

 private:
  void add(Index v, Index change);
  void try_add(Index v);
  Index euler_with(Index v) const;

  const Surface& surface_;
  std::vector<Index> number_;  ///< per vertex of the surface, or kNone
  std::vector<Index> vertices_;
  Index euler_ = 0;
  PollSometimes poll_;
};

}  // namespace beltrami
