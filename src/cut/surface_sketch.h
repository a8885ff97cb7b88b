// A surface with few points: what varies slowly is found on these and carried to all vertices.
#pragma once

#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "mesh/surface.h"

namespace beltrami {

/// Clusters of vertices (after Rossignac & Borrel 1993): those that edges connect within a cell of
/// a grid, so that the sides of a thin sheet stay apart. Each vertex is one on small surfaces.
/// Clusters come by their least vertex.
struct SurfaceSketch {
  std::vector<Vec3> face_normals;   ///< per face of the surface: of length one, or zero
  std::vector<double> face_areas;   ///< per face of the surface
  double area = 0;                  ///< of the surface
  double spacing = 0;               ///< between clusters, on a surface that is not small: the root
                                    ///< of a share of the area that does not depend on its faces
  std::vector<Index> cluster_of;    ///< per vertex; kNone where no face names it
  std::vector<Vec3> positions;      ///< per cluster: the mean over its area
  std::vector<Vec3> normals;        ///< per cluster: of length one, or zero
  std::vector<double> areas;        ///< per cluster: a third of that of the faces at its vertices
  std::vector<bool> on_open_piece;  ///< per cluster: whether its component has a boundary
  std::vector<bool> inside_out;     ///< per cluster: whether its component faces inwards, by volume
  std::vector<Triangle> faces;      ///< of clusters: the faces with three different ones
  std::vector<Index> start, neighbours;  ///< per cluster those that an edge leads to, increasing

  Index cluster_count() const { return size_of(positions); }
  /// The normal that points out of its component.
  Vec3 outwards(Index cluster) const {
    return inside_out[cluster] ? Vec3(-normals[cluster]) : normals[cluster];
  }
};

/// Time: linear, and that of sorting the edges between clusters.
SurfaceSketch sketch(const Surface& surface, const Work& work);

/// Values of clusters at the vertices: the mean of those around each, by distance; 0 where no face
/// names it.
std::vector<double> carry_to_vertices(const SurfaceSketch& sketch, const Surface& surface,
                                      const std::vector<double>& values, const Work& work);

/// What a cluster at this distance counts, next to one that is at hand; 0 from `reach` on.
inline double kernel(double distance_sq, double reach) {
  const double rest = 1 - distance_sq / (reach * reach);
  return rest > 0 ? rest * rest : 0.0;
}

}  // namespace beltrami
