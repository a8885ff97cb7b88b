// The header of an OFF file: what a vertex has, and how many of what there are.
#pragma once

#include <cstddef>
#include <cstdint>

#include "files/text_cursor.h"

namespace beltrami::cli {

struct OffHeader {
  /// What follows the coordinates of a vertex, in this order.
  bool normals = false, colours = false, uvs = false;
  bool homogeneous = false;  ///< vertices have a fourth coordinate
  std::uint64_t vertices = 0, faces = 0;

  /// Numbers of a vertex behind its coordinates where nothing but the header says it.
  std::size_t numbers_behind() const {
    return (normals ? std::size_t{3} : 0) + (colours ? std::size_t{4} : 0) +
           (uvs ? std::size_t{2} : 0);
  }
  std::size_t coordinates() const { return homogeneous ? 4 : 3; }
  /// The least that the line of a vertex has; a colour may be of three numbers.
  std::size_t least_numbers() const {
    return coordinates() + numbers_behind() - (colours ? std::size_t{1} : 0);
  }
};

/// Reads the header and the counts, in any case and broken into lines anywhere; the first count may
/// stand behind OFF without a blank. Without a word there are coordinates alone. Leaves the cursor
/// before the first vertex. Throws Failure for what is not OFF, and for dimensions other than
/// three.
OffHeader read_off_header(TextCursor& cursor);

}  // namespace beltrami::cli
