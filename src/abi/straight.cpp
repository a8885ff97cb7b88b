#include "abi/straight.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "abi/buffers.h"
#include "abi/pins.h"
#include "atlas/types.h"
#include "base/error.h"
#include "base/types.h"
#include "pins/hold.h"

namespace beltrami {
namespace {

void require_countable(std::uint64_t count, const char* what) {
  if (count <= static_cast<std::uint64_t>(std::numeric_limits<Index>::max())) return;
  throw Error(Fault::kInvalidArgument, "there are " + std::to_string(count) + " " + what +
                                           ": at most 2^31 - 1 are possible");
}

Index vertex_of(std::uint64_t vertex, const beltrami_surface& header, const std::string& what) {
  if (vertex < header.vertex_count) return static_cast<Index>(vertex);
  throw Error(Fault::kIndexOutOfRange,
              what + " names vertex " + std::to_string(vertex) + ", but there are " +
                  std::to_string(header.vertex_count) + " vertices: indices count from 0");
}

std::vector<StraightEdge> read_edges(const beltrami_surface& header, const Work& work) {
  const std::uint64_t count = header.straight_edge_count;
  require_countable(count, "straight edges");
  const std::vector<std::uint64_t> ends =
      read_integers(header.straight_edges, count, 2, "straight edges", work);
  const std::vector<std::uint64_t> kinds =
      read_integers(header.straight_kinds, count, 1, "kinds of straight edges", work);
  std::vector<StraightEdge> edges;
  edges.reserve(kinds.size());
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    const std::string name = "straight edge " + std::to_string(i);
    const PinKind kind = pin_kind_of(kinds[i], name);
    if (kind == PinKind::kPoint) {
      throw Error(Fault::kInvalidArgument,
                  name + " is of the kind BELTRAMI_PIN_POINT: give U, V or LINE");
    }
    edges.push_back(
        {vertex_of(ends[2 * i], header, name), vertex_of(ends[2 * i + 1], header, name), kind});
  }
  return edges;
}

std::vector<ChartRectangle> read_rectangles(const beltrami_surface& header,
                                            const LoadedSurface& surface, const Work& work) {
  const std::uint64_t count = header.rectangle_count;
  require_countable(count, "rectangles");
  const std::vector<std::uint64_t> faces =
      read_integers(header.rectangles, count, 1, "rectangles", work);
  std::vector<std::uint64_t> corners;
  if (header.rectangle_corners.data != nullptr) {
    corners = read_integers(header.rectangle_corners, count, 4, "corners of rectangles", work);
  }
  std::vector<Index> triangle_of(header.face_count, kNone);
  for (Index t = size_of(surface.triangulation.triangles); t-- > 0;) {
    triangle_of[surface.face_of(t)] = t;
  }
  std::vector<ChartRectangle> rectangles;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const std::string name = "rectangle " + std::to_string(i);
    if (faces[i] >= header.face_count) {
      throw Error(Fault::kIndexOutOfRange,
                  name + " names face " + std::to_string(faces[i]) + ", but there are " +
                      std::to_string(header.face_count) + " faces: indices count from 0");
    }
    ChartRectangle rectangle{triangle_of[faces[i]], static_cast<Index>(faces[i])};
    if (!corners.empty() && corners[4 * i] != BELTRAMI_NO_ELEMENT) {
      std::array<Index, 4>& own = rectangle.corners.emplace();
      for (std::size_t k = 0; k < 4; ++k) own[k] = vertex_of(corners[4 * i + k], header, name);
    }
    rectangles.push_back(rectangle);
  }
  return rectangles;
}

}  // namespace

void read_straight(const beltrami_surface& header, const LoadedSurface& surface, const Work& work,
                   AtlasInput& input) {
  if (header.straight_edge_count > 0) input.straight = read_edges(header, work);
  if (header.rectangle_count > 0) input.rectangles = read_rectangles(header, surface, work);
}

}  // namespace beltrami
