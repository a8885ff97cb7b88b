// Which texels of a page charts cover, and which are near them.
#pragma once

#include <cstdint>
#include <vector>

#include "atlas/pages.h"
#include "base/types.h"
#include "base/vectors.h"

namespace beltrami {

enum class Texel : std::uint8_t { kFree = 0, kGutter = 1, kCovered = 2 };

/// The texels of a page, rows from the top (v = 1) down. Covered: a face that is in a chart has an
/// inner point, or an edge, in common with it. Gutter: its centre is no further from that of a
/// covered one than the margin that was asked for. In time linear in the texels and in the rows
/// that faces cross.
std::vector<Texel> page_mask(const std::vector<Triangle>& faces, const std::vector<Vec2>& uvs,
                             const std::vector<Index>& chart_of_face, const Pages& pages,
                             Index page);

}  // namespace beltrami
