// Points and directions of the plane and of space. Who takes cross products includes
// Eigen/Geometry.
#pragma once

#include <Eigen/Core>

namespace beltrami {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;

}  // namespace beltrami
