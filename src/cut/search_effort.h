// How much is looked at for short seams.
#pragma once

#include <cstddef>

#include "base/types.h"

namespace beltrami {

enum class Effort { kQuick, kNormal, kHigh };

struct SearchEffort {
  Index coarse_faces;    ///< seams are decided on so many: finer ones add little to a shape
  Index rough_faces;     ///< what is to be joined by long seams is seen on so many
  Index finest_faces;    ///< of no more faces, a surface's seams are finished by its own maps
  int starts;            ///< searches begin in so many ways
  std::size_t finished;  ///< and go on with so many of them, the most promising ones
  int rounds;            ///< of coming nearer to a target that is reached already
  int settling;          ///< steps to where maps just reach it
  int exchanges;         ///< rounds in which branches are put elsewhere
  double tolerance;    ///< of the maps that judge, by the excess over 2 that is asked for: at 0.02
                       ///< theirs is within some 3%, at 0.002 within 1%
  bool improves;       ///< the best, by a model that has learnt from maps
  int idle_joins;      ///< charts are joined elsewhere until so many trials in turn gain nothing
  Index varied_faces;  ///< what was found is varied in rounds over so many faces in all; 0: never
  int tries;           ///< at a target that finer maps miss
  Index rest_faces;    ///< from so many on, further tries where finer maps have excess to spare
  double packing;      ///< as PackOptions has its effort
};

/// The settings of a level. Over 102 files of 1 to 100,000 faces, normal takes 2.0 times the CPU of
/// quick for seams that are 1.6% shorter.
SearchEffort search_effort(Effort effort);

}  // namespace beltrami
