#include "admit/fill.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "base/interrupt.h"
#include "base/vectors.h"
#include "mesh/disk_mesh.h"

namespace beltrami {
namespace {

/// Of the square of its longest edge: a virtual face with less area would be one without a shape.
constexpr double kLeastArea = 1e-6;

/// Of a component's area: a boundary within which a flat disk has no more is an opening of a body;
/// that of a sheet, however it is bent, spans more.
constexpr double kLargestOpening = 0.25;

using Loop = std::span<const Index>;  // of half-edges

Loop loop_of(const BoundaryLoops& loops, Index i) {
  return std::span(loops.halfedge).subspan(loops.start[i], loops.start[i + 1] - loops.start[i]);
}

std::vector<double> component_areas(const Surface& surface, const Topology& topology) {
  std::vector<double> areas(topology.components.size(), 0);
  PollSometimes poll;
  for (Index f = 0; f < surface.face_count(); ++f) {
    poll();
    const auto [a, b, c] = surface.faces[f];
    areas[topology.component_of_face[f]] +=
        triangle_area(surface.positions[a], surface.positions[b], surface.positions[c]);
  }
  return areas;
}

/// The points of a loop in its order, each the origin of its half-edge.
std::vector<Vec3> points_of(const Surface& surface, Loop loop) {
  std::vector<Vec3> points;
  for (const Index h : loop) points.push_back(surface.positions[surface.origin(h)]);
  return points;
}

double length_of(const std::vector<Vec3>& points) {
  double length = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    length += (points[(i + 1) % points.size()] - points[i]).norm();
  }
  return length;
}

/// The centre of mass of a closed line: it does not move where edges are divided.
Vec3 centre_of(const std::vector<Vec3>& points) {
  const double length = length_of(points);
  Vec3 centre = Vec3::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3& next = points[(i + 1) % points.size()];
    centre += ((next - points[i]).norm() / length) * (0.5 * (points[i] + next));
  }
  return centre;
}

/// Whether every virtual face has a shape.
bool spans_area(const std::vector<Vec3>& points) {
  if (points.size() < 3) return false;
  const Vec3 apex = points.size() == 3 ? points[2] : centre_of(points);
  const std::size_t faces = points.size() == 3 ? 1 : points.size();
  for (std::size_t i = 0; i < faces; ++i) {
    const Vec3 &a = points[i], &b = points[(i + 1) % points.size()];
    const double longest_sq =
        std::max({(b - a).squaredNorm(), (apex - a).squaredNorm(), (apex - b).squaredNorm()});
    if (!(triangle_area(a, b, apex) > kLeastArea * longest_sq)) return false;
  }
  return true;
}

void add_face(Surface& surface, const Triangle& face, const Triangle& twins) {
  const Index first = 3 * surface.face_count();
  surface.faces.push_back(face);
  for (int k = 0; k < 3; ++k) {
    surface.twin.push_back(twins[k]);
    if (twins[k] != kNone) surface.twin[twins[k]] = first + k;
  }
}

void fill(Surface& surface, Loop loop) {
  const auto origin = [&](std::size_t i) { return surface.origin(loop[i % loop.size()]); };
  for (const Index h : loop) surface.on_boundary[surface.origin(h)] = false;
  if (loop.size() == 3) {
    add_face(surface, {origin(0), origin(2), origin(1)}, {loop[2], loop[1], loop[0]});
    return;
  }
  const Index centre = surface.vertex_count();
  const Index first = 3 * surface.face_count();
  const Vec3 place = centre_of(points_of(surface, loop));
  surface.positions.push_back(place);
  surface.on_boundary.push_back(false);
  surface.outgoing.push_back(first + 2);
  for (std::size_t i = 0; i < loop.size(); ++i) {
    // Its last edge is that of the next face, which looks for it here.
    const Index before = i > 0 ? 3 * surface.face_count() - 1 : kNone;
    add_face(surface, {origin(i + 1), origin(i), centre}, {loop[i], before, kNone});
  }
  const Index last = 3 * surface.face_count() - 1;
  surface.twin[last] = first + 1;
  surface.twin[first + 1] = last;
}

/// Which boundaries are to stay open whatever their length: the longest of each component, the
/// first of equal ones; but for the only one of a body with handles, where it is an opening.
std::vector<bool> outlines_of(const Topology& topology, const std::vector<double>& lengths,
                              const std::vector<double>& areas) {
  std::vector<Index> longest(areas.size(), kNone);
  for (Index i = 0; i < size_of(lengths); ++i) {
    Index& known = longest[topology.component_of_loop[i]];
    if (known == kNone || lengths[i] > lengths[known]) known = i;
  }
  std::vector<bool> is_outline(lengths.size(), false);
  for (Index c = 0; c < size_of(longest); ++c) {
    if (longest[c] == kNone) continue;
    const double length = lengths[longest[c]];
    const Component& component = topology.components[c];
    const bool is_opening = component.loops == 1 && component.genus() > 0 &&
                            length * length / (4 * std::numbers::pi) < kLargestOpening * areas[c];
    is_outline[longest[c]] = !is_opening;
  }
  return is_outline;
}

}  // namespace

FilledSurface fill_holes(Surface surface, const Topology& topology, double limit,
                         const Work& work) {
  FilledSurface filled{std::move(surface), 0, 0, 0};
  filled.real_vertices = filled.surface.vertex_count();
  filled.real_faces = filled.surface.face_count();
  const BoundaryLoops& loops = topology.loops;
  if (loops.count() == 0) return filled;
  const std::vector<double> areas = component_areas(filled.surface, topology);
  std::vector<double> lengths;
  PollSometimes poll;
  for (Index i = 0; i < loops.count(); ++i) {
    poll();
    lengths.push_back(length_of(points_of(filled.surface, loop_of(loops, i))));
  }
  const std::vector<bool> is_outline = outlines_of(topology, lengths, areas);
  for (Index i = 0; i < loops.count(); ++i) {
    work.report(static_cast<double>(i) / loops.count());
    const double most = limit * std::sqrt(areas[topology.component_of_loop[i]]);
    if (is_outline[i] || lengths[i] > most) continue;
    if (!spans_area(points_of(filled.surface, loop_of(loops, i)))) continue;
    fill(filled.surface, loop_of(loops, i));
    ++filled.filled_loops;
  }
  return filled;
}

}  // namespace beltrami
