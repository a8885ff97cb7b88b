// The material libraries (.mtl) that an OBJ file names, and their textures.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "files/mesh_file.h"
#include "files/texture_use.h"

namespace beltrami::cli {

class MaterialLibraries {
 public:
  static constexpr std::uint64_t kNone = UINT64_MAX;

  /// Reads those that the statements of `file` name within its reach. `strict`: throws Failure
  /// where one cannot be read; else it is passed over, see unread(). `file` must outlive the
  /// object.
  MaterialLibraries(const MeshFile& file, bool strict);

  /// How many materials there are, used or not, and what they are called, in UTF-8. What no library
  /// has and `file` names is one, without lines.
  std::uint64_t count() const { return materials_.size(); }
  const std::string& name(std::uint64_t material) const { return materials_[material].name; }
  /// What follows a keyword, in small letters, where a material first has it; "" where it has not.
  std::string value(std::uint64_t material, std::string_view keyword) const;
  /// Every texture that follows UVs, of the materials that faces have.
  std::vector<TextureUse> textures() const;
  /// Those of one material, each by itself also where two show one image alike.
  std::vector<TextureUse> textures_of(std::uint64_t material) const;
  /// Per face the material that it has, or kNone.
  std::vector<std::uint64_t> material_of_faces() const;
  /// Why libraries could not be read, a sentence each.
  const std::vector<std::string>& unread() const { return unread_; }
  /// The file of the image of a texture, there or not. Throws Failure where it is out of reach.
  std::string image_path(const TextureUse& use) const;
  /// The files that were read, and those of images.
  std::vector<std::string> sources() const;
  /// One library of all of them, that names the files of `baked` where a texture was.
  std::string text(const std::vector<BakedTexture>& baked) const;
  /// Gives statements of a copy of the file this library instead of its own.
  static void name_library(MeshFile& file, const std::string& name);

 private:
  struct Line {
    std::string text;     ///< as it is
    std::string keyword;  ///< of a texture that follows UVs, or ""
    std::string options;  ///< of it, that say nothing of UVs
    std::string name;     ///< of its image
    std::array<double, 6> transform = {1, 0, 0, 0, 1, 0};
    bool clamps = false;
    char channel = 0;
  };
  struct Material {
    std::string name, library;  ///< path of the latter
    std::string bytes;          ///< of the name in that file
    std::vector<Line> lines;
  };
  void read_library(const std::string& path);
  void add_unlisted();
  std::string slot(const Material& material, const Line& line) const;
  std::vector<bool> materials_in_use() const;

  const MeshFile& file_;
  std::vector<std::string> libraries_, unread_;
  std::vector<Material> materials_;
  std::unordered_map<std::string, std::uint64_t> first_of_name_;  ///< by their bytes
};

}  // namespace beltrami::cli
