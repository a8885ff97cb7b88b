// Paint from a text file: factors of what seams cost at vertices and along edges.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "files/mesh_file.h"

namespace beltrami::cli {

struct Paint {
  std::vector<double> of_vertices;   ///< one for each, 1 where nothing is painted; or none
  std::vector<std::uint64_t> edges;  ///< two vertices each
  std::vector<double> of_edges;      ///< one for each edge
};

/// A line each: "v VERTEX FACTOR", or "e VERTEX VERTEX FACTOR" for an edge; vertices count from 0,
/// and # begins a comment. Throws Failure with the line that says something else, names a vertex
/// that is none, or a factor that is no finite number of 0 or more.
Paint read_paint(const std::string& path, const MeshFile& file);

}  // namespace beltrami::cli
