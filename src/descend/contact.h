// Contact of the boundary with itself: which parts of it are near each other, how far they can move
// before they touch, and a barrier that keeps them apart (after Li et al. 2020, "Incremental
// potential contact", section 4, in the plane). It presses, and lets what touches slide; a scaffold
// of triangles around the map (Jiang et al. 2017, SCAF) glues it together instead.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "descend/assembly.h"

namespace beltrami {

/// A boundary vertex and a boundary edge near it that does not end there.
struct Contact {
  Index vertex, from, to;  ///< vertices of the mesh
  double reach;            ///< distance below which the barrier acts, > 0
  double weight;           ///< of the barrier: an area of the surface
};

/// The pairs near each other in one map, some way beyond their reach: they serve while it grows.
struct Neighbours {
  std::vector<Contact> pairs;     ///< with their reach at scale 1
  double scale = 0;               ///< up to which none is missing; 0: there are too many
  std::vector<double> distances;  ///< of the pairs
};

/// A boundary vertex that meets an edge on a way.
struct Touch {
  Index vertex, from;  ///< vertices of the mesh
  double time;
};

/// The barrier on the distances between the vertices and the edges of a boundary loop: the double
/// integral over pairs of its points, so to say, of (1 - x)^3 / x, where x is their distance over
/// its reach: infinite at contact, 0 from the reach on, twice differentiable. The reach is a few
/// edges, but for points that are near each other along the boundary, and so by nature, less.
/// Copies are cheap beside a map.
class BoundaryContact {
 public:
  /// `lengths`: on the surface, of the edges from loop[i] to loop[i + 1]; `scales`: per edge, the
  /// length that the reach is a multiple of: those of the edges themselves, or of a coarser mesh.
  /// All > 0. Keeps a reference to `loop`.
  BoundaryContact(const std::vector<Index>& loop, const std::vector<double>& lengths,
                  std::vector<double> scales);

  /// Scales the reach, and the contact's weight in an objective, to a map: `energy` is its mean
  /// energy, counted from 2 at the isometries. A map far too small gets a reach as much smaller,
  /// and one with more parts near each other than the barrier needs, too.
  void fit(const std::vector<Vec2>& uvs, double energy);

  /// The same. `known`: what neighbours() gave for `uvs`, or nothing yet; replaced where it does
  /// not reach far enough.
  void fit(const std::vector<Vec2>& uvs, double energy, Neighbours& known);

  /// What the barrier's energy counts in an objective, times the inverse area of the surface: it
  /// must hold against what presses.
  double strength() const { return strength_; }

  /// Pairs nearer than `margin` times their reach, in the order of the vertices along the loop,
  /// then of the edges; the first `most` of them. O(n log n) for n edges if each is near to a few
  /// others.
  std::vector<Contact> find(const std::vector<Vec2>& uvs, double margin = 1,
                            std::size_t most = std::numeric_limits<std::size_t>::max()) const;

  /// Pairs that `find` might see after the next fit().
  Neighbours neighbours(const std::vector<Vec2>& uvs) const;

  /// The same as find(uvs), from `known` of `uvs` where that reaches far enough.
  std::vector<Contact> find(const std::vector<Vec2>& uvs, const Neighbours& known) const;

  /// Whether parts of the boundary are near each other, and not as many as in a shape that is made
  /// so: a star of long teeth does not press on itself.
  bool is_pressed(const std::vector<Vec2>& uvs) const;

  /// The sum over all pairs: an area. Infinite if two touch.
  double energy(const std::vector<Vec2>& uvs) const;

  /// The same, and its gradient added to `gradient`, one entry per vertex, `strength` times.
  double add_gradient(const std::vector<Vec2>& uvs, double strength,
                      std::vector<Vec2>& gradient) const;

  /// Per vertex: the stiffness of its contacts across, of `energy`.
  std::vector<double> stiffness(const std::vector<Vec2>& uvs) const;

  /// The vertices that would go through an edge on the way uvs + t * direction before t = limit,
  /// each with the t at which they touch: all before t = `all_before`, and of the others some, with
  /// the first of all. Precondition: the boundary is simple in `uvs`.
  std::vector<Touch> touches(const std::vector<Vec2>& uvs, const std::vector<Vec2>& direction,
                             double limit, double all_before = 0) const;

  /// The first of these t; `limit` if there is none.
  double first_touch(const std::vector<Vec2>& uvs, const std::vector<Vec2>& direction,
                     double limit) const;

  /// Exactly.
  bool is_simple(const std::vector<Vec2>& uvs) const;

 private:
  Index after(Index i) const { return i + 1 == size_of(loop_) ? 0 : i + 1; }
  Index before(Index i) const { return i == 0 ? size_of(loop_) - 1 : i - 1; }
  std::size_t most() const;
  double reach_of_vertex(Index i) const;
  double reach(Index i, Index e) const;
  template <class Visit>
  void for_each_pair(const std::vector<Vec2>& uvs, double scale, double behind,
                     const Visit& visit) const;
  template <class BoxOf, class EndBoxOf, class Visit>
  void for_each_near(const BoxOf& vertex_box, const EndBoxOf& edge_end_box,
                     const Visit& visit) const;

  const std::vector<Index>& loop_;
  std::vector<double> lengths_, scales_;
  double scale_ = 1;  // of all reaches
  double strength_ = 1;
  std::vector<double> along_;  // of each vertex along the loop, and the whole length at the end
};

/// The sum of the pairs' terms: an area. Infinite if two touch.
double contact_energy(const std::vector<Contact>& contacts, const std::vector<Vec2>& uvs);

/// How stiff a pair's term is across.
double contact_stiffness(const Contact& contact, const std::vector<Vec2>& uvs);

/// The distance of a pair over its reach.
double share_of_reach(const Contact& contact, const std::vector<Vec2>& uvs);

/// Gradient and positive semi-definite model of the Hessian of one pair's term in the coordinates
/// of its vertex and of the ends of its edge. `stuck`: as if it were as stiff along as across.
FaceModel contact_model(const Contact& contact, const std::vector<Vec2>& uvs, bool stuck);

}  // namespace beltrami
