// What the reader of glTF hands to the writer, beside what MeshFile shows.
#pragma once

#include <cstdint>
#include <vector>

#include "files/gltf/document.h"
#include "files/gltf/item.h"
#include "files/mesh_file.h"

namespace beltrami::cli::gltf {

/// The vertices of primitives that have the same attributes and morph targets.
struct VertexSet {
  std::uint32_t mesh = 0, primitive = 0;  ///< the first of these primitives
  std::uint64_t count = 0;                ///< of vertices
};

/// Primitive `primitive` of mesh `mesh`, which is drawn as triangles.
struct Primitive {
  std::uint32_t mesh = 0, primitive = 0;
  std::uint32_t set = 0;
  std::uint64_t first_face = 0, face_count = 0;  ///< of the MeshFile
  std::vector<std::uint64_t> normal_maps;  ///< the sets of UVs that those of its materials use
};

/// Every accessor that a vertex set has is whole, and has its count.
struct Model {
  Document document;
  std::vector<VertexSet> sets;
  std::vector<Primitive> primitives;  ///< by first_face
  std::vector<std::uint32_t> local;   ///< per vertex of the MeshFile: which one of its set it is

  Item primitive(std::uint32_t mesh, std::uint32_t primitive) const {
    return (*document.entry("meshes", mesh).array("primitives"))[primitive];
  }
};

/// Precondition: file.gltf.
inline const Model& model_of(const MeshFile& file) {
  return *file.gltf;
}

}  // namespace beltrami::cli::gltf
