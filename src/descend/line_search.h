// How far a map can go along a direction before a face becomes singular, and how far it goes: the
// backtracking line search of all descents (Armijo 1966; Nocedal & Wright 2006, algorithm 3.1).
#pragma once

#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"

namespace beltrami {

/// Of the way to the first singular face: no step is longer.
inline constexpr double kSingularShare = 0.8;
/// Of the decrease that the slope promises: a step brings so much at least.
inline constexpr double kSufficientShare = 1e-4;
/// Of a step: then its energy is that of the start but for rounding.
inline constexpr int kMostHalvings = 40;

/// Whether a step of `length` brings the decrease that is asked of it; `slope`: of the energy along
/// the direction, below 0.
inline bool falls_enough(double before, double after, double length, double slope) {
  return after < before && after <= before + kSufficientShare * length * slope;
}

/// Halves `length` until `takes_step(length)`, up to `most` times. Returns whether it took one.
template <class TakesStep>
bool backtrack(double& length, const TakesStep& takes_step, int most = kMostHalvings) {
  for (int halving = 0; halving < most; ++halving, length *= 0.5) {
    if (takes_step(length)) return true;
  }
  return false;
}

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
