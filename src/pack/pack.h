// Charts onto the pages of a texture. The method is in docs/design/method.md.
#pragma once

#include <span>
#include <vector>

#include "base/work.h"
#include "pack/outline.h"
#include "pack/types.h"

namespace beltrami {

/// Places charts on pages: at least `margin` texels apart, also after their places have been
/// divided by the resolution and rounded to single precision, and inside one another's holes where
/// they fit. Charts of different groups share no page: their pages follow one another by the number
/// of the group, at one density. Charts with a kept placement stay, whatever they overlap, at the
/// density given. The same bits at any number of threads. Throws Error INVALID_ARGUMENT where the
/// options are out of range, a chart is kept and no density is given, or the charts do not fit into
/// `max_pages`.
Packing pack_charts(std::span<const PackChart> charts, const PackOptions& options,
                    const Work& work);

/// Likewise for charts of which the outlines are known, all of one scale. What many packings are
/// made of need not be found again for each.
Packing pack_outlines(std::vector<Outline> outlines, const PackOptions& options, const Work& work);

}  // namespace beltrami
