// Tiles of UDIM: the pages of a texture side by side in the plane of UVs.
#pragma once

#include <cstdint>
#include <utility>

namespace beltrami::cli {

/// Pages in a row of UDIM.
inline constexpr std::uint64_t kPagesInARow = 10;
/// Rows of them that numbers of four digits have.
inline constexpr std::uint64_t kMostRowsOfPages = 100;
/// The number of the first page.
inline constexpr std::uint64_t kFirstTile = 1001;

/// The least u and v of a page in a file.
inline std::pair<double, double> corner_of_page(std::uint64_t page) {
  const std::uint64_t column = page % kPagesInARow, row = page / kPagesInARow;
  return {static_cast<double>(column), static_cast<double>(row)};
}

}  // namespace beltrami::cli
