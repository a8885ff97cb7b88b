// Charts that share no page: each group on pages of its own, at one density.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "pack/types.h"

namespace beltrami {

/// Packs charts of one group.
using PackGroup =
    std::function<Packing(const std::vector<PackChart>& charts, const PackOptions& options)>;

/// Whether the charts are of several groups.
bool has_groups(std::span<const PackChart> charts);

/// Packs the charts of each group by themselves, the least group on the first pages: at the
/// greatest density at which all of them are found to fit, or at that of `options`. `max_pages` are
/// those of each group. Throws what `pack` throws. Precondition: no chart is kept.
Packing pack_groups(std::span<const PackChart> charts, const PackOptions& options,
                    const PackGroup& pack);

}  // namespace beltrami
