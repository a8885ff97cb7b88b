// A file's polygons as the library takes them.
#pragma once

#include <beltrami/beltrami.h>

#include <cstdint>
#include <vector>

#include "files/mesh_file.h"

namespace beltrami::cli {

/// The arrays behind a beltrami_surface: those of the file, which must outlive this, and a few of
/// its own.
class SurfaceView {
 public:
  explicit SurfaceView(const MeshFile& file);
  SurfaceView(const SurfaceView&) = delete;
  SurfaceView& operator=(const SurfaceView&) = delete;

  /// With the UVs that the file has now, as UVs of corners; interrupted by signals.
  beltrami_surface surface() const;

 private:
  const MeshFile& file_;
  std::vector<std::uint32_t> sizes_;  ///< of the faces, where not all are triangles
  std::vector<double> corner_uvs_;
};

}  // namespace beltrami::cli
