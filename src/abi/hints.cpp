#include "abi/hints.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "abi/buffers.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "base/types.h"
#include "cut/seam_costs.h"

namespace beltrami {
namespace {

constexpr const char* kNoFactor = " is no finite number of 0 or more";

bool is_factor(double number) {
  return number >= 0 && std::isfinite(number);
}

void require_search(const beltrami_surface& header, const AtlasOptions& options) {
  const char* given = header.vertex_paint.data != nullptr ? "vertex_paint"
                      : header.painted_edge_count > 0     ? "edge_paint"
                      : header.materials.data != nullptr  ? "materials"
                                                          : nullptr;
  if (given == nullptr || options.target) return;
  throw Error(Fault::kInvalidArgument,
              std::string(given) +
                  " of the surface has no effect where no seams are searched for: leave it out, "
                  "or take cut=auto");
}

std::vector<double> read_vertex_paint(const beltrami_surface& header, const Work& work) {
  std::vector<double> paint =
      read_numbers(header.vertex_paint, header.vertex_count, 1, "vertex paint", work);
  PollSometimes poll;
  for (std::size_t v = 0; v < paint.size(); ++v) {
    poll();
    if (is_factor(paint[v])) continue;
    throw Error(Fault::kInvalidArgument, "the paint of vertex " + std::to_string(v) + kNoFactor,
                Element::vertex(v));
  }
  return paint;
}

std::vector<PaintedEdge> read_edge_paint(const beltrami_surface& header, const Work& work) {
  const std::uint64_t count = header.painted_edge_count;
  if (count > static_cast<std::uint64_t>(std::numeric_limits<Index>::max())) {
    throw Error(Fault::kInvalidArgument, "there are " + std::to_string(count) +
                                             " painted edges: at most 2^31 - 1 are possible");
  }
  const std::vector<std::uint64_t> ends =
      read_integers(header.painted_edges, count, 2, "painted edges", work);
  const std::vector<double> factors = read_numbers(header.edge_paint, count, 1, "edge paint", work);
  std::vector<PaintedEdge> edges;
  edges.reserve(factors.size());
  PollSometimes poll;
  for (std::size_t i = 0; i < factors.size(); ++i) {
    poll();
    for (const std::uint64_t vertex : {ends[2 * i], ends[2 * i + 1]}) {
      if (vertex < header.vertex_count) continue;
      throw Error(Fault::kIndexOutOfRange, "painted edge " + std::to_string(i) + " names vertex " +
                                               std::to_string(vertex) + ", but there are " +
                                               std::to_string(header.vertex_count) +
                                               " vertices: indices count from 0");
    }
    if (!is_factor(factors[i])) {
      throw Error(Fault::kInvalidArgument,
                  "the paint of painted edge " + std::to_string(i) + kNoFactor);
    }
    edges.push_back(
        {{static_cast<Index>(ends[2 * i]), static_cast<Index>(ends[2 * i + 1])}, factors[i]});
  }
  return edges;
}

}  // namespace

InputHints read_hints(const beltrami_surface& header, const LoadedSurface& surface,
                      const AtlasOptions& options, const Work& work) {
  require_search(header, options);
  InputHints hints;
  if (header.vertex_paint.data != nullptr) hints.vertex_paint = read_vertex_paint(header, work);
  if (header.painted_edge_count > 0) hints.edge_paint = read_edge_paint(header, work);
  if (header.materials.data == nullptr) return hints;
  const std::vector<Index> of_faces =
      dense(read_integers(header.materials, header.face_count, 1, "materials", work));
  const Index triangles = size_of(surface.triangulation.triangles);
  hints.materials.reserve(static_cast<std::size_t>(triangles));
  for (Index t = 0; t < triangles; ++t) hints.materials.push_back(of_faces[surface.face_of(t)]);
  return hints;
}

}  // namespace beltrami
