// How far a map can go along a direction before a face becomes singular.
#pragma once

#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"

namespace beltrami {

/// The smallest t > 0 at which a face of uvs + t * direction has no area; infinity if none has.
/// Precondition: all faces are positively oriented in `uvs`. (Smith & Schaefer 2015, section 3.3;
/// the roots are taken without cancellation and without an absolute threshold, which would fail on
/// meshes of millions of faces.)
double first_singular_step(const std::vector<Triangle>& faces, const std::vector<Vec2>& uvs,
                           const std::vector<Vec2>& direction, const Work& work);

struct SingularStep {
  Index face;
  double length;
};

/// The faces that become singular before `limit`, and where, in the order of the faces. The same
/// precondition.
std::vector<SingularStep> singular_steps(const std::vector<Triangle>& faces,
                                         const std::vector<Vec2>& uvs,
                                         const std::vector<Vec2>& direction, double limit,
                                         const Work& work);

/// The same among some of the faces, which come in any order, each once.
std::vector<SingularStep> singular_steps_of(const std::vector<Index>& some,
                                            const std::vector<Triangle>& faces,
                                            const std::vector<Vec2>& uvs,
                                            const std::vector<Vec2>& direction, double limit,
                                            const Work& work);

}  // namespace beltrami
