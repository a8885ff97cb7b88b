// How well places of a surface are seen from outside: ambient occlusion by depth buffers.
#pragma once

#include <vector>

#include "base/work.h"
#include "cut/surface_sketch.h"

namespace beltrami {

/// Per cluster the share in [0, 1] of the directions above its tangent plane in which nothing of
/// the surface stands before it, counted by their cosine to the normal (Landis 2002; with buffers
/// of depth as Williams 1978). 64 fixed directions: right to some 0.05. A component with a boundary
/// is seen from both sides, and the better one counts. Details below 1/100 of the extent of the
/// surface hide nothing.
std::vector<double> visibility(const SurfaceSketch& sketch, const Work& work);

}  // namespace beltrami
