// Where to look at a model from.
#pragma once

#include <vector>

#include "files/surface.h"
#include "files/vector3.h"

namespace beltrami::cli {

/// An orthonormal frame: `toward` points from the model to the eye.
struct View {
  Vector3 right, up, toward;
};

/// The view of those around and above the model that shows the most of its front. `boundary`:
/// points along the boundary; where they lie below the rest they tell which way is up.
View choose_view(const TriangleView& mesh, const std::vector<Vector3>& boundary);

}  // namespace beltrami::cli
