// Any triangles -> an atlas: charts that are disks, each flattened, laid out side by side and
// judged together. The place that knows the order of the stages.
#pragma once

#include "atlas/types.h"
#include "base/work.h"

namespace beltrami {

/// Cuts the surface into disks, flattens each and packs them onto pages, or lays them out in rows.
/// A chart that rounding to single precision would fold is delivered in such numbers at once,
/// mended. The same bits at any number of threads; powers of two of the input's unit scale the UVs
/// alone. A chart that fails is named in its info; the others are not touched. UV vertices with
/// pins are delivered at their very numbers; charts with pins stay where these put them, above them
/// the others. Charts with straight borders are turned by quarters alone. Throws what admit does,
/// Error PINS with the corner of the first pin that no map of its chart meets together with those
/// before it, proven or after all attempts; OUT_OF_MEMORY where the charts are estimated to need
/// more than the limit of the work, Cancelled, or std::bad_alloc. Preconditions: densities finite
/// and above 0; none, and no unit_square, with pins.
Atlas unwrap(const AtlasInput& input, const AtlasOptions& options, const Work& work);

}  // namespace beltrami
