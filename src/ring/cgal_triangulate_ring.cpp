// The same triangulation by CGAL's package 2D Triangulations, which is under the GPL.
#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <CGAL/spatial_sort.h>

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>

#include "exact/orientation.h"
#include "ring/ring_predicates.h"
#include "ring/triangulate_ring.h"

namespace beltrami {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Vertex = CGAL::Triangulation_vertex_base_with_info_2<Index, Kernel>;
using Face = CGAL::Constrained_triangulation_face_base_2<Kernel>;
using Structure = CGAL::Triangulation_data_structure_2<Vertex, Face>;
using Triangulation =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure,
                                               CGAL::No_constraint_intersection_tag>;

/// Points with their indices, in an order that keeps neighbours together.
void insert_points(const std::vector<Vec2>& points, Triangulation& triangulation,
                   std::vector<Triangulation::Vertex_handle>& handles) {
  std::vector<Kernel::Point_2> places;
  for (const Vec2& p : points) places.emplace_back(p.x(), p.y());
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  using Map = CGAL::Pointer_property_map<Kernel::Point_2>::type;
  CGAL::spatial_sort(
      order.begin(), order.end(),
      CGAL::Spatial_sort_traits_adapter_2<Kernel, Map>(CGAL::make_property_map(places)));
  handles.resize(points.size());
  Triangulation::Face_handle hint;
  for (const std::size_t i : order) {
    const std::size_t known = triangulation.number_of_vertices();
    handles[i] = triangulation.insert(places[i], hint);
    if (triangulation.number_of_vertices() == known) {
      fail_ring("vertex " + std::to_string(i) + " lies on another.");
    }
    handles[i]->info() = static_cast<Index>(i);
    hint = handles[i]->face();
  }
}

void insert_loop(Index begin, Index end, const char* name, Triangulation& triangulation,
                 const std::vector<Triangulation::Vertex_handle>& handles) {
  for (Index i = begin; i < end; ++i) {
    const auto a = handles[i], b = handles[i + 1 == end ? begin : i + 1];
    bool crosses = false;
    try {
      triangulation.insert_constraint(a, b);
    } catch (const Triangulation::Intersection_of_constraints_exception&) {
      crosses = true;
    }
    // An edge through a vertex is there in parts only.
    if (crosses || !triangulation.is_edge(a, b)) {
      fail_ring("edge " + std::to_string(i - begin) + " of the " + name +
                " polygon meets another vertex or edge.");
    }
  }
}

/// Takes the diagonals of points on a circle that is_in_circle asks for; CGAL leaves them open.
void flip_to_unique(Triangulation& triangulation) {
  std::vector<Triangulation::Edge> pending(triangulation.finite_edges_begin(),
                                           triangulation.finite_edges_end());
  const auto point = [](Triangulation::Face_handle face, int i) {
    const auto& p = face->vertex(i)->point();
    return Vec2(p.x(), p.y());
  };
  while (!pending.empty()) {
    auto [face, i] = pending.back();
    pending.pop_back();
    auto other = face->neighbor(i);
    if (face->is_constrained(i) || triangulation.is_infinite(face) ||
        triangulation.is_infinite(other)) {
      continue;
    }
    const int j = triangulation.mirror_index(face, i);
    // In front of the edge the face's own corner, behind it the neighbour's.
    if (!is_in_circle(point(face, face->ccw(i)), point(face, face->cw(i)), point(face, i),
                      point(other, j))) {
      continue;
    }
    triangulation.flip(face, i);
    for (int k = 0; k < 3; ++k) {
      pending.emplace_back(face, k);
      pending.emplace_back(other, k);
    }
  }
}

/// The faces that are reached from outside without crossing the inner polygon.
std::vector<Triangle> ring_of(const Triangulation& triangulation, Index inner_count,
                              std::size_t expected) {
  auto vertex = triangulation.incident_vertices(triangulation.infinite_vertex());
  const auto first_vertex = vertex;
  do {
    if (vertex->info() < inner_count) fail_ring("the inner polygon is not inside the outer one.");
  } while (++vertex != first_vertex);
  std::vector<Triangle> found;
  std::vector<Triangulation::Face_handle> front;
  CGAL::Unique_hash_map<Triangulation::Face_handle, bool> seen(false);
  auto circulator = triangulation.incident_faces(triangulation.infinite_vertex());
  const auto first = circulator;
  do {
    front.push_back(circulator->neighbor(circulator->index(triangulation.infinite_vertex())));
  } while (++circulator != first);
  while (!front.empty()) {
    const auto face = front.back();
    front.pop_back();
    if (triangulation.is_infinite(face) || seen[face]) continue;
    seen[face] = true;
    found.push_back({face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
    for (int k = 0; k < 3; ++k) {
      if (!face->is_constrained(k)) front.push_back(face->neighbor(k));
    }
  }
  if (found.size() != expected) fail_ring("the inner polygon is not inside the outer one.");
  return found;
}

bool turns_left(const std::vector<Vec2>& polygon) {
  const auto lowest =
      std::min_element(polygon.begin(), polygon.end(), lexicographically_less) - polygon.begin();
  const std::size_t n = polygon.size(), i = static_cast<std::size_t>(lowest);
  return orientation(polygon[(i + n - 1) % n], polygon[i], polygon[(i + 1) % n]) > 0;
}

}  // namespace

RingTriangulation triangulate_ring(const std::vector<Vec2>& inner, const std::vector<Vec2>& outer) {
  RingTriangulation ring{{}, ring_points(inner, outer)};
  corners_of_convex(outer);
  Triangulation triangulation;
  std::vector<Triangulation::Vertex_handle> handles;
  insert_points(ring.points, triangulation, handles);
  const Index count = size_of(inner);
  insert_loop(0, count, "inner", triangulation, handles);
  insert_loop(count, size_of(ring.points), "outer", triangulation, handles);
  if (!turns_left(inner)) fail_ring("the inner polygon runs clockwise.");
  flip_to_unique(triangulation);
  ring.faces = ring_of(triangulation, count, ring.points.size());
  return ring;
}

const char* ring_triangulation_name() {
  return "cgal";
}

}  // namespace beltrami
