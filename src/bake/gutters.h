// What a page shows around its charts.
#pragma once

#include <span>

#include "bake/page.h"
#include "base/work.h"

namespace beltrami {

/// As many rings as fill the page.
inline constexpr int kWholePage = -1;

/// Fills gutters: in each of `rings` rounds texels beside filled ones get the mean of these. With
/// kWholePage some rounds are followed by smooth colours, each a mean of what is baked nearby. What
/// is filled here becomes Filled::kGutter.
void fill_gutters(const PageRoom& room, std::span<Filled> filled, int rings, const Work& work);

}  // namespace beltrami
