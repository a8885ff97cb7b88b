// What the adaptors of half-edge meshes have in common: faces gathered into arrays, and UVs handed
// back corner by corner in the order in which they were gathered.
#ifndef BELTRAMI_ADAPTORS_POLYGONS_HPP
#define BELTRAMI_ADAPTORS_POLYGONS_HPP

#include <beltrami/beltrami.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

BELTRAMI_CPP_BEGIN

namespace detail {

/// Faces of a mesh, one after another; positions where they had to be copied.
struct Polygons {
  std::vector<double> positions;  // three per vertex
  std::vector<std::uint32_t> corners, sizes;

  /// Adds the vertex of the next corner of the face at hand. At most 2^31 - 1 vertices are taken,
  /// so an index that does not fit is out of range afterwards, too.
  void corner(std::size_t vertex) {
    constexpr std::size_t kMost = UINT32_MAX;
    corners.push_back(static_cast<std::uint32_t>(vertex < kMost ? vertex : kMost));
  }
  /// Ends a face, whose corners began at `first`.
  void end_face(std::size_t first) {
    sizes.push_back(static_cast<std::uint32_t>(corners.size() - first));
  }
  bool triangles() const {
    for (const std::uint32_t size : sizes) {
      if (size != 3) return false;
    }
    return true;
  }
};

/// The surface of gathered faces, which it keeps. Triangles are given as such: flatten takes them.
inline Surface surface_of(const Reals<3>& positions, std::shared_ptr<const Polygons> polygons) {
  Surface surface = polygons->triangles() ? Surface(positions, Indices<3>(polygons->corners))
                                          : Surface(positions, polygons->corners, polygons->sizes);
  return surface.keep(std::move(polygons));
}

/// Hands `uvs`, one per corner or vertex, to `put(uv)` in their order through `walk`, which calls
/// it once for each of `count`. Failure INVALID_ARGUMENT if the mesh is another one than that of
/// the result.
template <class Walk>
Result<void> hand_out(Result<std::vector<Uv>> uvs, std::size_t count, Walk walk) {
  if (!uvs) return uvs.error();
  if (uvs->size() != count) {
    return Failure(Status::kInvalidArgument, "the result is that of a mesh of another size");
  }
  std::size_t next = 0;
  walk([&] { return (*uvs)[next++]; });
  return {};
}

}  // namespace detail

BELTRAMI_CPP_END

#endif  // BELTRAMI_ADAPTORS_POLYGONS_HPP
