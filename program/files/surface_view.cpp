#include "files/surface_view.h"

#include <cstddef>

#include "files/polygons.h"
#include "process/interrupt.h"

namespace beltrami::cli {

SurfaceView::SurfaceView(const MeshFile& file) : file_(file) {
  const Polygons& polygons = file.polygons;
  if (!polygons.all_triangles()) {
    sizes_.reserve(polygons.size());
    for (std::uint64_t i = 0; i < polygons.size(); ++i) {
      sizes_.push_back(static_cast<std::uint32_t>(polygons.end(i) - polygons.begin(i)));
    }
  }
  const auto& [values, of_corner] = file.corner_uvs;
  if (of_corner.empty() && file.uvs.empty()) return;
  const std::vector<double>& uvs = of_corner.empty() ? file.uvs : values;
  const std::vector<std::uint32_t>& index = of_corner.empty() ? polygons.corners() : of_corner;
  corner_uvs_.reserve(2 * index.size());
  for (const std::uint32_t i : index) {
    for (std::size_t k = 0; k < 2; ++k) corner_uvs_.push_back(uvs[2 * std::size_t{i} + k]);
  }
}

beltrami_surface SurfaceView::surface() const {
  const Polygons& polygons = file_.polygons;
  beltrami_surface surface{};
  surface.struct_size = sizeof surface;
  surface.vertex_count = file_.vertex_count();
  surface.face_count = polygons.size();
  surface.corner_count = polygons.corners().size();
  surface.positions = {file_.positions.data(), 0, BELTRAMI_F64, 0};
  surface.indices = {polygons.corners().data(), 0, BELTRAMI_U32, 0};
  if (!sizes_.empty()) surface.face_sizes = {sizes_.data(), 0, BELTRAMI_U32, 0};
  if (!corner_uvs_.empty()) surface.corner_uvs = {corner_uvs_.data(), 0, BELTRAMI_F64, 0};
  surface.cancel = interrupt_number();
  return surface;
}

}  // namespace beltrami::cli
