// glTF 2.0, .gltf and .glb, beyond what MeshFile shows of it: UVs go back into the whole file.
//
// The document is kept as a tree of JSON beside the bytes of its buffers, and is edited in place:
// materials, nodes, skins, animations, textures, extras and extensions, known or not, come out as
// they went in. Libraries of structs (tinygltf is the one that Debian has) lose what they do not
// know, and check few of the bounds that a file from anywhere needs checked.
//
// A MeshFile of glTF has every primitive of triangles once, however many nodes show its mesh, in
// the order of the file. Strips and fans are triangles; those of a strip that only join its parts,
// and have a vertex twice, are left out. Points and lines are no triangles. Vertices are those that
// faces of a mesh use, with the UVs of TEXCOORD_0 where they are asked for; the face properties
// mesh, primitive and material have the numbers of these in the file, -1 for no material.
//
// Positions are in the scene, so that areas are to scale: a mesh is where the first node that
// shows it has it, by the order of nodes, of those whose transform can be inverted. A mesh that no
// such node shows, and one that a skin moves, stays where its own coordinates have it.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "files/gltf/merge.h"
#include "files/mesh_file.h"
#include "files/texture_use.h"

namespace beltrami::cli {

namespace gltf {
struct MergePlan;
}

/// What write_gltf wants written.
struct GltfOutput {
  struct File {
    std::string path;
    std::vector<std::string> pieces;  ///< one after another
  };
  std::vector<File> files;            ///< to be put in place in this order: a .bin, then its .gltf
  std::vector<std::string> replaced;  ///< buffers of the model that was there, to be removed then
  std::vector<std::string> not_kept;  ///< in words: "tangents"
  std::vector<std::string> notes;     ///< what else is to be known of the output, in sentences
};

/// What becomes of the textures that were drawn through other UVs.
struct GltfTextures {
  std::vector<BakedTexture> baked;
  const char* advice = "beltrami transfer makes them anew";  ///< where none is baked
  std::shared_ptr<const gltf::MergePlan> merge;              ///< of materials, or null
};

/// Materials that become one, or as few as what cannot be baked leaves.
struct MaterialMerge {
  std::vector<MergedTexture> textures;  ///< which are to be baked for it
  std::shared_ptr<const gltf::MergePlan> plan;
  std::string note;  ///< why several are left, or ""
};

/// u v per vertex of TEXCOORD_`uv_set`, NaN in primitives without; empty where none has it. glTF's
/// V axis points down, that of beltrami up: v here is 1 - v there. Precondition: file.gltf.
std::vector<double> gltf_uvs(const MeshFile& file, std::uint32_t uv_set);

/// x y and so on, `width` numbers per vertex, of an attribute as the primitives have it, without
/// the transforms of nodes; NaN in primitives without, empty where none has it. Precondition:
/// file.gltf.
std::vector<double> gltf_attribute(const MeshFile& file, const char* name, std::size_t width);

/// The textures of the materials that triangles have. Precondition: file.gltf.
std::vector<TextureUse> gltf_textures(const MeshFile& file);
/// How the materials that triangles have are merged. They share their pictures; what glTF has in
/// textures and in factors of them is baked, and materials stay apart that differ in anything else,
/// such as alpha modes. Throws Failure for a file with variants of materials. Precondition:
/// file.gltf.
MaterialMerge gltf_merge(const MeshFile& file);
/// Per face, whether it has this material, as its own or as a variant. Precondition: file.gltf.
std::vector<bool> gltf_faces_of(const MeshFile& file, std::uint64_t material);
/// The files that it was read from, and those of its images. Precondition: file.gltf.
std::vector<std::string> gltf_sources(const MeshFile& file);
/// The file of the image of one of these textures, there or not; "" for one that the glTF holds.
/// Throws Failure where it is out of the reach of the file, or no image is known.
std::string gltf_image_path(const MeshFile& file, const TextureUse& use);
/// The bytes of the image of one of these textures. Throws Failure where there is none within
/// reach.
std::string gltf_image(const MeshFile& file, const TextureUse& use);

/// Throws Failure where `uv_set` is beyond 1 and leaves out a set that no primitive has; it names
/// the greatest that does not. Precondition: file.gltf.
void require_uv_set(const MeshFile& file, std::uint32_t uv_set);

/// The paths of what write_gltf would give now. Preconditions: those of write_gltf.
std::vector<std::string> gltf_output_paths(const MeshFile& file, const std::string& path);

/// The file with its UVs now, of corners or of vertices, as TEXCOORD_`uv_set` of every primitive
/// with triangles, in single precision, for `path`: .glb holds its buffer; .gltf has it beside it,
/// in a new file of its name with .bin, where the input had a file too, else in itself.
///
/// A vertex is split only where its corners have UVs of different numbers; its copies have its
/// other attributes to the bit, also those of morph targets, and come behind the old vertices,
/// which keep their places. Bytes that nothing refers to any more are left out. Tangents go where
/// the material's normal map uses the new UVs: they belonged to the old ones; so do the transforms
/// of KHR_texture_transform of textures that use them. Primitives without the sets before `uv_set`
/// get the same UVs in these.
///
/// Textures that were baked take the places of those that they were made of, and draw through
/// `uv_set`; where a normal map is among them tangents are made anew. Materials are merged as
/// textures.merge says, and primitives with it that share their vertices are joined. Without such,
/// a note names the textures that no longer fit, and says what to do.
///
/// Preconditions: file.gltf, and its faces are where they were, though their corners may have
/// turned; `path` is of glTF. Throws Failure as require_uv_set does, and for what is too large
/// for GLB; std::bad_alloc.
GltfOutput write_gltf(const MeshFile& file, std::uint32_t uv_set, const std::string& path,
                      const GltfTextures& textures = {});

}  // namespace beltrami::cli
