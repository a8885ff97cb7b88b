// What depends on the size of a disk: how coarse its coarse meshes are, and whether it has levels.
#pragma once

#include <cstdint>

#include "base/types.h"
#include "chart/options.h"

namespace beltrami {

/// From so many faces on, few steps on the finest level are worth their time; and beside coarse
/// faces that are asked for levels are worth it.
inline constexpr Index kManyFaces = 100'000;

/// Faces that a mesh of so many is simplified to: the number `asked` for, or (0) max(1%, 10,000),
/// and no more than it has.
Index coarse_faces(Index faces, std::int64_t asked);

/// Faces of the coarsest of several levels of a disk of so many.
Index coarsest_faces(Index faces);

/// Whether a disk of so many faces is flattened in levels (nested_mode): a large one, in the metric
/// way, with the `coarse` faces that the options ask for. What is tried where a map broke its
/// promise is not.
bool is_nested(Index faces, Index coarse, const ChartOptions& options);

}  // namespace beltrami
