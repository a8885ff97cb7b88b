// Where a closed polygon meets itself.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"

namespace beltrami {

struct Crossings {
  std::int64_t count = 0;  ///< pairs of edges that meet: see find_crossings
  std::array<Index, 2> first_pair = {kNone, kNone};  ///< start vertices of the first such pair
};

/// Whether no two edges of the closed polygon through uvs[loop[0]], uvs[loop[1]], ... share any
/// point other than the end that neighbours have in common. Exact, and O(n log n) in time, O(n) in
/// memory, whatever the polygon. Precondition: at least three vertices, each once, finite.
bool is_simple(const std::vector<Index>& loop, const std::vector<Vec2>& uvs);

/// Pairs of edges that meet so, as positions in the loop, in increasing order: edge i runs from
/// loop[i] to loop[i + 1]. Empty if and only if the polygon is simple. All of them where that takes
/// no longer than O(n log n) and they are fewer than 4 n or 65,536; else some of them, one at least
/// for each edge of a set without which the polygon would not meet itself.
std::vector<std::array<Index, 2>> find_crossings(const std::vector<Index>& loop,
                                                 const std::vector<Vec2>& uvs);

/// Counts what find_crossings finds.
Crossings count_crossings(const std::vector<Index>& loop, const std::vector<Vec2>& uvs);

}  // namespace beltrami
