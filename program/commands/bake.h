// The textures of a mesh's materials, baked for its new UVs.
#pragma once

#include <beltrami/beltrami.h>

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "commands/bake_call.h"
#include "commands/report.h"
#include "files/atomic_file.h"
#include "files/gltf_file.h"
#include "files/mesh_file.h"
#include "files/mtl.h"
#include "files/texture_use.h"
#include "picture/stb_in_one_place.h"

namespace beltrami::cli {

/// The textures of OBJ and glTF, from before there are new UVs to the files that they go to.
class TextureBake {
 public:
  /// Lists the textures of `file`, looks into each image, and finds names beside `output` for the
  /// new ones. Those without an image file are left out, and noted by run(). Throws Failure for
  /// images that cannot be read, where all are missing, and for formats without materials.
  /// `file` must outlive the object, with its vertices as they are. `output` is of its format.
  /// `merges` materials, of glTF.
  TextureBake(const MeshFile& file, const std::string& output, bool merges);

  /// The files that will be written beside the output.
  std::vector<std::string> paths() const;
  bool empty() const { return baked_.empty(); }

  /// Takes over where corners have their new UVs, and where they had the old ones; `triangles`:
  /// three corners of the file's faces each.
  void place(const std::vector<std::uint32_t>& triangles);
  /// Bakes all, each on a page of `side` texels, on the threads of `context`. Throws Failure where
  /// most of a texture would be made up.
  void run(beltrami_context* context, int side, const BakeProgress& progress, Report& report);

  /// For write_outputs, of glTF.
  GltfTextures take_textures();
  /// Writes the images and the library of an OBJ file, and has the mesh that is written name that.
  void write_obj_parts(MeshFile& written, std::deque<AtomicFile>& outputs) const;

 private:
  struct Places;  ///< of the triangles of one texture

  void list_textures(std::vector<TextureUse> uses);
  std::string image_of(const TextureUse& use) const;
  Pixels pixels_of(const TextureUse& use) const;
  void require_image(const TextureUse& use) const;
  void name_files(const std::string& output);
  std::vector<double> old_uvs(std::uint64_t uv_set) const;
  Places places_of(std::uint64_t material, const TextureUse* use) const;
  BakeCall call_of(TextureUse& use) const;
  BakeCall merged_call(const MergedTexture& merged, TextureUse& use) const;
  void bake_one(std::size_t number, beltrami_context* context, int side,
                const BakeProgress& progress, Report& report);

  const MeshFile& file_;
  std::unique_ptr<MaterialLibraries> libraries_;  ///< of OBJ
  std::string library_path_;                      ///< of the new one
  std::vector<double> obj_uvs_;                   ///< u v of each corner of the faces, of OBJ
  std::vector<BakedTexture> baked_;
  std::vector<std::string> missing_;    ///< images that are not there, a note for each
  std::optional<MaterialMerge> merge_;  ///< its textures are those of baked_
  std::vector<std::uint32_t> corners_;  ///< three for each triangle, in the winding of the file
  std::vector<double> new_uvs_;         ///< u v for each of these
  double coarser_ = 1;  ///< at most so many texels of an old side are one of a new one
  std::uint64_t texels_ = 0, without_source_ = 0;
};

/// The textures of an OBJ file that new UVs do not fit, in a sentence; "" where there are none.
std::string textures_that_misfit(const MeshFile& file);

}  // namespace beltrami::cli
