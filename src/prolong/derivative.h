// The derivative of a coarse map, carried to the vertices of a finer mesh without frames.
#pragma once

#include <array>
#include <vector>

#include "base/lanes.h"
#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "mesh/disk_mesh.h"
#include "mesh/rest_shape.h"

namespace beltrami {

/// At a vertex: the gradients of u and of v as vectors in space, the unit normal of the surface
/// that they are tangent to, and the logarithm of the map's area factor, which averages of
/// gradients that turn lose. A vector, so that averages are plain ones.
class VertexDerivative : public Eigen::Matrix<float, 10, 1> {
 public:
  using Eigen::Matrix<float, 10, 1>::Matrix;
  VertexDerivative() {}  // NOLINT(modernize-use-equals-default): leaves the numbers as they are

  auto gradient_u() const { return segment<3>(0); }
  auto gradient_v() const { return segment<3>(3); }
  auto normal() const { return segment<3>(6); }
  float scale() const { return (*this)[9]; }
};

/// Those of a map whose faces are all positive: means over the faces of each vertex by area.
std::vector<VertexDerivative> vertex_derivatives(const DiskMesh& mesh,
                                                 const std::vector<RestTriangle>& rest,
                                                 const std::vector<Vec2>& uvs, const Work& work);

/// The maps of kLanes faces, each in the frame of its rest triangle, whose first edge counts as 1.
struct CarriedMaps {
  LanesComplex corner;        ///< of the rest triangle, the third; the second is at 1
  LanesComplex fz, fzbar;     ///< 0 where the face has no shape in space
  Lanes fz_norm, fzbar_norm;  ///< their squared moduli
};

/// Of the faces of a mesh with these derivatives at its corners: their means, turned as little as
/// takes their normals to those of the faces, with the mean scales.
CarriedMaps carried_maps(const DiskMesh& mesh, const std::array<Index, kLanes>& faces,
                         const std::vector<RestTriangle>& rest,
                         const std::vector<VertexDerivative>& derivatives);

}  // namespace beltrami
