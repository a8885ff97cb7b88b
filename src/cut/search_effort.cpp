#include "cut/search_effort.h"

#include <limits>

#include "base/types.h"

namespace beltrami {
namespace {

constexpr Index kNever = std::numeric_limits<Index>::max();

}  // namespace

SearchEffort search_effort(Effort effort) {
  switch (effort) {
    case Effort::kQuick:
      return {.coarse_faces = 4000,
              .rough_faces = 1000,
              .finest_faces = 0,
              .starts = 1,
              .finished = 1,
              .rounds = 3,
              .settling = 1,
              .exchanges = 1,
              .tolerance = 0.02,
              .improves = false,
              .idle_joins = 0,
              .varied_faces = 0,
              .tries = 3,
              .rest_faces = kNever,
              .packing = 0};
    case Effort::kHigh:
      return {.coarse_faces = 10'000,
              .rough_faces = 3000,
              .finest_faces = 30'000,
              .starts = 6,
              .finished = 2,
              .rounds = 8,
              .settling = 6,
              .exchanges = 6,
              .tolerance = 0.002,
              .improves = true,
              .idle_joins = 6,
              .varied_faces = 60'000,
              .tries = 4,
              .rest_faces = 0,
              .packing = 1};
    case Effort::kNormal:
      break;
  }
  return {.coarse_faces = 6000,
          .rough_faces = 2000,
          .finest_faces = 0,
          .starts = 2,
          .finished = 1,
          .rounds = 4,
          .settling = 1,
          .exchanges = 1,
          .tolerance = 0.02,
          .improves = true,
          .idle_joins = 2,
          .varied_faces = 0,
          .tries = 4,
          .rest_faces = 20'000,
          .packing = 0.05};
}

}  // namespace beltrami
