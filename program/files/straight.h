// Straight borders from a text file: charts that become rectangles, edges that become straight.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "files/mesh_file.h"

namespace beltrami::cli {

struct Straight {
  std::vector<std::uint64_t> edges;              ///< two vertices per edge
  std::vector<std::uint32_t> kinds;              ///< per edge: BELTRAMI_PIN_U, V or LINE
  std::vector<std::uint64_t> edge_lines;         ///< per edge, where the file has it
  std::vector<std::uint64_t> rectangles;         ///< faces
  std::vector<std::uint64_t> rectangle_corners;  ///< four vertices for each, or BELTRAMI_NO_ELEMENT
  std::vector<std::uint64_t> rectangle_lines;    ///< per rectangle
};

/// A line each: "r FACE" or "r FACE VERTEX VERTEX VERTEX VERTEX" has the chart of the face become a
/// rectangle, with these corners; "u VERTEX VERTEX", "v VERTEX VERTEX" and "l VERTEX VERTEX" have
/// an edge lie at one u, at one v, or on any line, with those that it meets. Numbers count from 0,
/// and # begins a comment. Throws Failure with the line that says something else.
Straight read_straight(const std::string& path, const MeshFile& file);

}  // namespace beltrami::cli
