// The meshes that calls read: Surface for unwrap, flatten and the checks, UvMesh for pack.
#ifndef BELTRAMI_CPP_SURFACE_HPP
#define BELTRAMI_CPP_SURFACE_HPP

#include <beltrami/beltrami.h>
#include <beltrami/cpp/config.hpp>
#include <beltrami/cpp/result.hpp>
#include <beltrami/cpp/span.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

BELTRAMI_CPP_BEGIN

/// Triangles or polygons in the caller's memory, which must outlive the calls that read it. What
/// does not fit together (an array of another length) is told by the call that is given it.
class Surface {
 public:
  /// Triangles: positions in any unit of length, and the vertices of each, counter-clockwise, by
  /// indices of 32 or 64 bits, or std::uint16_t.
  Surface(const Reals<3>& positions, const Indices<3>& triangles) noexcept : Surface(positions) {
    surface_.face_count = triangles.size();
    surface_.indices = triangles.buffer();
    corners_ = triangles.size() * 3;
    note(triangles.defect());
  }
  /// Polygons: the vertices of all corners, face after face, and the number of corners of each.
  Surface(const Reals<3>& positions, const Indices<1>& corners, const Indices<1>& sizes) noexcept
      : Surface(positions) {
    surface_.face_count = sizes.size();
    surface_.corner_count = corners_ = corners.size();
    surface_.indices = corners.buffer();
    surface_.face_sizes = sizes.buffer();
    note(corners.defect());
    note(sizes.defect());
  }

  // What comes with it, or nothing: the fields of beltrami_surface.

  /// One (u, v) per corner: what the cut ISLANDS keeps, and check_atlas judges.
  Surface& corner_uvs(const Reals<2>& uvs) noexcept {
    return take(surface_.corner_uvs, uvs, corners_, "there is not one corner UV per corner");
  }
  /// One number per face: seams run where they differ.
  Surface& face_labels(const Indices<1>& labels) noexcept {
    return take(surface_.face_labels, labels, faces(), "there is not one label per face");
  }
  /// One factor per face, above 0: how much larger it is to be in the plane.
  Surface& densities(const Reals<1>& densities) noexcept {
    return take(surface_.densities, densities, faces(), "there is not one density per face");
  }
  /// Edges to cut, by their vertices.
  Surface& seams(const Indices<2>& edges) noexcept {
    surface_.seam_count = edges.size();
    return take(surface_.seams, edges, edges.size(), "");
  }
  /// Corners whose UVs are given, in the unit of positions.
  Surface& pins(const Indices<1>& corners, const Reals<2>& uvs) noexcept {
    surface_.pin_count = corners.size();
    take(surface_.pins, corners, corners.size(), "");
    return take(surface_.pin_uvs, uvs, corners.size(), "there is not one UV per pin");
  }
  /// What is held of each pin, BELTRAMI_PIN_, and of lines their directions; after pins().
  Surface& pin_kinds(const Indices<1>& kinds, const Reals<2>& directions) noexcept {
    const std::size_t pins = static_cast<std::size_t>(surface_.pin_count);
    take(surface_.pin_kinds, kinds, pins, "there is not one kind per pin");
    return take(surface_.pin_directions, directions, pins, "there is not one direction per pin");
  }
  /// Edges that are to be straight with those that they meet, and BELTRAMI_PIN_U, V or LINE for
  /// each.
  Surface& straight_edges(const Indices<2>& edges, const Indices<1>& kinds) noexcept {
    surface_.straight_edge_count = edges.size();
    take(surface_.straight_edges, edges, edges.size(), "");
    return take(surface_.straight_kinds, kinds, edges.size(), "there is not one kind per edge");
  }
  /// Faces whose charts become rectangles, with the corners that their borders have.
  Surface& rectangles(const Indices<1>& faces) noexcept {
    surface_.rectangle_count = faces.size();
    return take(surface_.rectangles, faces, faces.size(), "");
  }
  /// The same with corners, four vertices for each.
  Surface& rectangles(const Indices<1>& faces, const Indices<4>& corners) noexcept {
    rectangles(faces);
    return take(surface_.rectangle_corners, corners, faces.size(),
                "there are not four corners per rectangle");
  }
  /// One factor per vertex: what a seam costs there.
  Surface& vertex_paint(const Reals<1>& factors) noexcept {
    return take(surface_.vertex_paint, factors, vertices(), "there is not one factor per vertex");
  }
  /// Edges by their vertices, and a factor for each: what a seam costs there.
  Surface& edge_paint(const Indices<2>& edges, const Reals<1>& factors) noexcept {
    surface_.painted_edge_count = edges.size();
    take(surface_.painted_edges, edges, edges.size(), "");
    return take(surface_.edge_paint, factors, edges.size(),
                "there is not one factor per painted edge");
  }
  /// One number per face: where they differ a seam costs the factor of option::kMaterialSeams.
  Surface& materials(const Indices<1>& materials) noexcept {
    return take(surface_.materials, materials, faces(), "there is not one material per face");
  }
  /// Where the caller asks for an end, from any thread: calls end once the number is not 0.
  Surface& cancel(const std::int32_t* flag) noexcept {
    surface_.cancel = flag;
    return *this;
  }
  /// Keeps what the views show for as long as this surface and its copies live.
  Surface& keep(std::shared_ptr<const void> arrays) {
    kept_.push_back(std::move(arrays));
    return *this;
  }
  /// Says what is wrong with it, a sentence that is static; calls then end with INVALID_ARGUMENT.
  Surface& note(const char* defect) noexcept {
    if (defect_ == nullptr) defect_ = defect;
    return *this;
  }

  std::size_t vertices() const noexcept { return static_cast<std::size_t>(surface_.vertex_count); }
  std::size_t faces() const noexcept { return static_cast<std::size_t>(surface_.face_count); }
  std::size_t corners() const noexcept { return corners_; }
  const char* defect() const noexcept { return defect_; }

  /// For calls of the header of C, as long as this surface lives.
  const beltrami_surface& c() const noexcept { return surface_; }

  /// Its triangles as a mesh of C. Failure INVALID_ARGUMENT if it has polygons, or more than that.
  Result<beltrami_mesh> mesh() const {
    if (defect_ != nullptr) return Failure(Status::kInvalidArgument, defect_);
    const beltrami_buffer* others[] = {
        &surface_.face_sizes,     &surface_.corner_uvs,    &surface_.face_labels,
        &surface_.densities,      &surface_.seams,         &surface_.pins,
        &surface_.vertex_paint,   &surface_.painted_edges, &surface_.materials,
        &surface_.straight_edges, &surface_.rectangles};
    for (const beltrami_buffer* other : others) {
      if (other->data != nullptr) {
        return Failure(Status::kInvalidArgument,
                       "this call takes triangles alone: polygons, seams and all else that comes "
                       "with a surface are for unwrap");
      }
    }
    auto mesh = detail::sized<beltrami_mesh>();
    mesh.vertex_count = surface_.vertex_count;
    mesh.face_count = surface_.face_count;
    mesh.positions = surface_.positions;
    mesh.indices = surface_.indices;
    mesh.cancel = surface_.cancel;
    return mesh;
  }

 private:
  explicit Surface(const Reals<3>& positions) noexcept {
    surface_.vertex_count = positions.size();
    surface_.positions = positions.buffer();
    note(positions.defect());
  }

  template <class View>
  Surface& take(beltrami_buffer& buffer, const View& items, std::size_t count,
                const char* mismatch) noexcept {
    buffer = items.buffer();
    note(items.defect());
    return items.size() == count ? *this : note(mismatch);
  }

  beltrami_surface surface_ = detail::sized<beltrami_surface>();
  std::size_t corners_ = 0;
  const char* defect_ = nullptr;
  std::vector<std::shared_ptr<const void>> kept_;
};

/// Triangles in the plane, in the caller's memory, which must outlive the call of pack.
class UvMesh {
 public:
  /// UV vertices, and those of the corners of each triangle.
  UvMesh(const Reals<2>& uvs, const Indices<3>& triangles) noexcept {
    mesh_.uv_count = uvs.size();
    mesh_.face_count = triangles.size();
    mesh_.uvs = uvs.buffer();
    mesh_.uv_indices = triangles.buffer();
    note(uvs.defect());
    note(triangles.defect());
  }
  /// The surface, for charts of equal density: a position for each UV vertex.
  UvMesh& positions(const Reals<3>& positions) noexcept {
    mesh_.vertex_count = positions.size();
    mesh_.positions = positions.buffer();
    note(positions.defect());
    if (positions.size() != uvs()) note("there is not one position per UV vertex");
    return *this;
  }
  /// The same, with triangles of their own.
  UvMesh& positions(const Reals<3>& positions, const Indices<3>& triangles) noexcept {
    mesh_.vertex_count = positions.size();
    mesh_.positions = positions.buffer();
    mesh_.indices = triangles.buffer();
    note(positions.defect());
    note(triangles.defect());
    if (triangles.size() != faces()) note("there are not as many triangles as in the plane");
    return *this;
  }
  /// The page of each face whose chart stays where it is; all bits set (-1) for others.
  UvMesh& kept_pages(const Indices<1>& pages) noexcept {
    mesh_.kept_pages = pages.buffer();
    note(pages.defect());
    if (pages.size() != faces()) note("there is not one page per face");
    return *this;
  }
  /// A label for each face: charts of different labels get different pages, in the order of the
  /// labels. All meshes have them, or none, and none has kept_pages.
  UvMesh& page_labels(const Indices<1>& labels) noexcept {
    mesh_.page_labels = labels.buffer();
    note(labels.defect());
    if (labels.size() != faces()) note("there is not one label per face");
    return *this;
  }
  /// As of Surface; that of the first mesh counts.
  UvMesh& cancel(const std::int32_t* flag) noexcept {
    mesh_.cancel = flag;
    return *this;
  }

  std::size_t uvs() const noexcept { return static_cast<std::size_t>(mesh_.uv_count); }
  std::size_t faces() const noexcept { return static_cast<std::size_t>(mesh_.face_count); }
  const char* defect() const noexcept { return defect_; }
  const beltrami_uv_mesh& c() const noexcept { return mesh_; }

 private:
  void note(const char* defect) noexcept {
    if (defect_ == nullptr) defect_ = defect;
  }

  beltrami_uv_mesh mesh_ = detail::sized<beltrami_uv_mesh>();
  const char* defect_ = nullptr;
};

BELTRAMI_CPP_END

#endif  // BELTRAMI_CPP_SURFACE_HPP
