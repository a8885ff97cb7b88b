#include "abi/joined.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <numeric>
#include <string>
#include <utility>

#include "abi/hints.h"
#include "abi/pins.h"
#include "abi/straight.h"
#include "admit/triangulate.h"
#include "atlas/pins.h"
#include "base/error.h"
#include "cut/seam_costs.h"

namespace beltrami {
namespace {

constexpr std::uint64_t kMostVertices = std::numeric_limits<Index>::max();
constexpr std::uint64_t kMostTriangles = 700'000'000;  // 3 half-edges each fit an Index

/// Straight angles are exactly that.
double radians_of(double degrees) {
  return degrees / 180 * std::numbers::pi;
}

AtlasProblem read_one(const beltrami_surface& header, const AtlasOptions& options, bool islands,
                      double hard_angle, const Work& work) {
  AtlasProblem problem;
  problem.surface = read_surface(header, work);
  problem.input = atlas_input(header, problem.surface, islands, work);
  problem.input.cuts.hard_angle = radians_of(hard_angle);
  problem.input.pins = read_pins(header, problem.surface, options, work);
  read_straight(header, problem.surface, work, problem.input);
  problem.input.hints = read_hints(header, problem.surface, options, work);
  problem.bodies = {0};
  return problem;
}

/// How many of each kind there are before a surface.
struct Before {
  Index vertices, faces, corners, triangles, pins;
};

Before counts_of(const AtlasProblem& problem) {
  const std::vector<Pin>& pins = problem.input.pins;
  return {problem.surface.vertex_count, problem.surface.polygons.count(),
          size_of(problem.surface.polygons.corners),
          size_of(problem.surface.triangulation.triangles),
          pins.empty() ? 0 : pins.back().number + 1};  // they come in the order of their numbers
}

template <class T>
void append(std::vector<T>& all, const std::vector<T>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

/// The same for numbers that count on from those before.
void append(std::vector<Index>& all, std::vector<Index> more, Index before) {
  for (Index& number : more) number += before;
  append(all, more);
}

/// The same for lists with one value per item, or none: those without get `plain`.
template <class T>
void append(std::vector<T>& all, Index before, const std::vector<T>& more, Index count,
            const T& plain) {
  if (all.empty() && more.empty()) return;
  all.resize(static_cast<std::size_t>(before), plain);
  append(all, more);
  all.resize(static_cast<std::size_t>(before + count), plain);
}

/// The ends of the corners of each face, also where all are triangles.
std::vector<Index> ends_of(const Polygons& polygons) {
  std::vector<Index> ends(static_cast<std::size_t>(polygons.count()));
  for (Index f = 0; f < polygons.count(); ++f) ends[f] = polygons.end(f);
  return ends;
}

std::vector<Index> faces_of_triangles(const LoadedSurface& surface) {
  std::vector<Index> faces = surface.face_of_triangle;
  if (faces.empty()) {
    faces.resize(surface.triangulation.triangles.size());
    std::iota(faces.begin(), faces.end(), 0);
  }
  return faces;
}

void append(LoadedSurface& all, LoadedSurface&& one, const Before& before) {
  if (!all.polygons.all_triangles() || !one.polygons.all_triangles()) {
    all.face_of_triangle = faces_of_triangles(all);
    append(all.face_of_triangle, faces_of_triangles(one), before.faces);
    all.polygons.ends = ends_of(all.polygons);
    append(all.polygons.ends, ends_of(one.polygons), before.corners);
  }
  append(all.positions, one.positions);
  append(all.polygons.corners, std::move(one.polygons.corners), before.vertices);
  for (Triangle triangle : one.triangulation.triangles) {
    for (Index& corner : triangle) corner += before.corners;
    all.triangulation.triangles.push_back(triangle);
  }
  all.vertex_count += one.vertex_count;
}

void append(AtlasInput& all, AtlasInput&& one, const Before& before, const Before& count) {
  append(all.positions, one.positions);
  for (Triangle face : one.faces) {
    for (Index& vertex : face) vertex += before.vertices;
    all.faces.push_back(face);
  }
  for (auto [a, b] : one.cuts.edges) {
    all.cuts.edges.push_back({a + before.vertices, b + before.vertices});
  }
  append(all.cuts.labels, before.triangles, one.cuts.labels, count.triangles, std::uint64_t{0});
  append(all.cuts.corner_uvs, one.cuts.corner_uvs);  // all have them, or none
  append(all.densities, before.triangles, one.densities, count.triangles, 1.0);
  append(all.hints.vertex_paint, before.vertices, one.hints.vertex_paint, count.vertices, 1.0);
  append(all.hints.materials, before.triangles, one.hints.materials, count.triangles, Index{0});
  for (PaintedEdge edge : one.hints.edge_paint) {
    for (Index& vertex : edge.ends) vertex += before.vertices;
    all.hints.edge_paint.push_back(edge);
  }
  for (Pin pin : one.pins) {
    pin.face += before.triangles;
    pin.number += before.pins;
    pin.of_caller += before.corners;
    all.pins.push_back(pin);
  }
  for (StraightEdge edge : one.straight) {
    edge.from += before.vertices;
    edge.to += before.vertices;
    all.straight.push_back(edge);
  }
  for (ChartRectangle rectangle : one.rectangles) {
    rectangle.face += before.triangles;
    rectangle.of_caller += before.faces;
    if (rectangle.corners) {
      for (Index& vertex : *rectangle.corners) vertex += before.vertices;
    }
    all.rectangles.push_back(rectangle);
  }
}

/// An element of a surface, counted through all.
Element through_all(Element element, const Before& before) {
  switch (element.kind) {
    case ElementKind::kFace:
      return Element::face(element.index + static_cast<std::uint64_t>(before.faces));
    case ElementKind::kVertex:
      return Element::vertex(element.index + static_cast<std::uint64_t>(before.vertices));
    case ElementKind::kCorner:
      return Element::corner(element.index + static_cast<std::uint64_t>(before.corners));
    case ElementKind::kNothing:
      break;
  }
  return element;
}

/// The same error with the surface named.
Error named(const Error& error, std::uint64_t surface, Element element) {
  return {error.fault(), "surface " + std::to_string(surface) + ": " + error.what(), element};
}

/// The header of surface `number` of `count`, which errors name where there are several.
beltrami_surface read_header_of(const beltrami_surface* surface, std::uint64_t number,
                                std::uint64_t count) {
  if (count == 1) return read_surface_header(surface);
  try {
    return read_surface_header(surface);
  } catch (const Error& error) {
    throw named(error, number, error.element());
  }
}

/// Throws Error INVALID_ARGUMENT where what goes with all surfaces comes with some.
void require_agreement(const std::vector<beltrami_surface>& headers) {
  const auto has_pins = [](const beltrami_surface& header) { return header.pin_count > 0; };
  const auto has_densities = [](const beltrami_surface& header) {
    return header.densities.data != nullptr;
  };
  if (std::ranges::any_of(headers, has_pins) && std::ranges::any_of(headers, has_densities)) {
    throw Error(Fault::kInvalidArgument,
                "pins say how large charts are, and so do densities: leave one out, in all of the "
                "surfaces");
  }
}

}  // namespace

std::vector<beltrami_surface> read_surface_headers(const beltrami_surface* const* surfaces,
                                                   std::uint64_t count) {
  if (surfaces == nullptr) throw Error(Fault::kInvalidArgument, "surfaces is NULL");
  if (count == 0) throw Error(Fault::kEmpty, "there are no surfaces: there is nothing to unwrap");
  std::vector<beltrami_surface> headers;
  std::uint64_t vertices = 0, triangles = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    headers.push_back(read_header_of(surfaces[i], i, count));
    const beltrami_surface& header = headers.back();
    vertices += header.vertex_count;
    triangles += header.corner_count - std::min(header.corner_count, 2 * header.face_count);
    if (vertices > kMostVertices || triangles > kMostTriangles) {
      throw Error(Fault::kInvalidArgument,
                  "the surfaces have more than " + std::to_string(kMostVertices) + " vertices or " +
                      std::to_string(kMostTriangles) + " triangles: unwrap fewer at once");
    }
  }
  require_agreement(headers);
  return headers;
}

AtlasProblem read_problem(const std::vector<beltrami_surface>& headers, const AtlasOptions& options,
                          bool islands, double hard_angle, const Work& work) {
  if (headers.size() == 1) return read_one(headers.front(), options, islands, hard_angle, work);
  AtlasProblem all;
  all.input.cuts.hard_angle = radians_of(hard_angle);
  for (std::size_t i = 0; i < headers.size(); ++i) {
    const Before before = counts_of(all);
    try {
      AtlasProblem one = read_one(headers[i], options, islands, hard_angle, work);
      const Before count = counts_of(one);
      append(all.surface, std::move(one.surface), before);
      append(all.input, std::move(one.input), before, count);
      all.bodies.push_back(before.vertices);
    } catch (const Error& error) {
      throw named(error, i, through_all(error.element(), before));
    }
  }
  return all;
}

}  // namespace beltrami
