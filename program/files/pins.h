// Pins from a text file: corners whose UVs are given.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "files/mesh_file.h"

namespace beltrami::cli {

struct Pins {
  std::vector<std::uint64_t> corners;  ///< of the file's faces, one after another
  std::vector<double> uvs;             ///< two per pin
  std::vector<std::uint32_t> kinds;    ///< per pin: BELTRAMI_PIN_
  std::vector<double> directions;      ///< two per pin, of lines
  std::vector<std::uint64_t> lines;    ///< per pin, where the file has it
};

/// A line each: "c CORNER U V", or "v VERTEX U V" for all corners of a vertex; numbers count from
/// 0, and # begins a comment. With - for U or V that number is free; "v VERTEX U V DU DV" holds it
/// to the line through (U, V) along (DU, DV). Throws Failure with the line that says something
/// else, or that names a corner or a vertex of no face.
Pins read_pins(const std::string& path, const MeshFile& file);

/// A message of the library with "pin 3", where that is the item, written as "the pin of line 5";
/// `lines`: per item.
std::string with_lines(const std::string& message, std::string_view item,
                       const std::vector<std::uint64_t>& lines);

}  // namespace beltrami::cli
