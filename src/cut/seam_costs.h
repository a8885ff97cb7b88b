// What a seam costs along every edge: its length, and less where it is looked at least.
#pragma once

#include <array>
#include <numbers>
#include <vector>

#include "base/types.h"
#include "base/work.h"
#include "cut/surface_sketch.h"
#include "mesh/surface.h"

namespace beltrami {

/// How much each term counts; a seam costs its length alone where concavity and visibility are 0
/// and the others 1. All are >= 0, those of hard edges and materials > 0.
struct SeamWeights {
  double concavity = 0.15;   ///< a: times exp(-a c), c in [-1, 1] as edge_concavity has it
  double visibility = 0.2;   ///< b: times 1 + b v, v in [0, 1] as visibility has it
  double hard_edges = 0.85;  ///< factor of edges with a greater angle than SeamHints has
  double materials = 0.5;    ///< factor of edges between faces of different labels
  double symmetry = 0;      ///< seams that are symmetric may cost more by this share; 0: not sought
  double straightness = 0;  ///< w: a turn by an angle t costs as w (1 - cos t) of the edges there
};

/// An edge of the surface, by its ends in either order, and its factor.
struct PaintedEdge {
  std::array<Index, 2> ends;
  double factor = 1;
};

/// What is known of the vertices, faces and edges of the surface; each may be empty.
struct SeamHints {
  std::vector<double> vertex_paint;     ///< per vertex a factor, see kLeastPaint
  std::vector<PaintedEdge> edge_paint;  ///< no two of one edge; pairs that are no edge do nothing
  std::vector<Index> labels;            ///< per face, materials for instance
  double hard_angle = std::numbers::pi / 3;  ///< between normals, in radians
};

/// Painted factors are >= 0; below 1 attracts seams. They are brought into this range: no paint is
/// a promise, and costs stay positive and finite.
inline constexpr double kLeastPaint = 0.05, kMostPaint = 20;

/// Per half-edge what a seam costs along its edge, the two of an edge alike: positive and finite,
/// and in proportion to the size of the surface. The product of the length and the factors below.
/// Time: linear but for the sketch of the surface, half a second for a million faces on one thread.
/// Preconditions: sizes as said; lengths far from the ends of the range of numbers.
std::vector<double> seam_costs(const Surface& surface, const SeamWeights& weights,
                               const SeamHints& hints, const Work& work);

// ---- The terms, each by itself. All are per half-edge, the two of an edge alike. ---------------

/// Lengths; one that is below a millionth of their mean gets that, and 1 where all are 0.
std::vector<double> edge_lengths(const Surface& surface, const Work& work);

/// How concave the surface is around an edge, in [-1, 1]: the chord between the normals of its
/// faces, which is the square root of 2 and counts as 1 at a right angle, averaged over a
/// neighbourhood of 1/30 of the root of the area, so that noise does not decide. An edge whose
/// faces are wider than that is its own neighbourhood. Positive where the normals turn towards each
/// other.
std::vector<double> edge_concavity(const Surface& surface, const SurfaceSketch& sketch,
                                   const Work& work);

// These multiply `costs`.
void weigh_concavity(const Surface& surface, const SurfaceSketch& sketch, double weight,
                     std::vector<double>& costs, const Work& work);
void weigh_visibility(const Surface& surface, const SurfaceSketch& sketch, double weight,
                      std::vector<double>& costs, const Work& work);
void weigh_hard_edges(const Surface& surface, const SurfaceSketch& sketch, double angle,
                      double factor, std::vector<double>& costs, const Work& work);
/// Precondition: a label for every face.
void weigh_labels(const Surface& surface, const std::vector<Index>& labels, double factor,
                  std::vector<double>& costs, const Work& work);
/// The geometric mean of the ends, and the edge's own. Either may be empty.
void weigh_paint(const Surface& surface, const std::vector<double>& vertex_paint,
                 const std::vector<PaintedEdge>& edge_paint, std::vector<double>& costs,
                 const Work& work);

}  // namespace beltrami
