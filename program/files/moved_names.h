// Names of files beside a mesh, when the mesh is written to another folder.
#pragma once

#include <string>
#include <vector>

#include "files/mesh_file.h"

namespace beltrami::cli {

/// Lines of a mesh that name files (`mtllib` and its like of OBJ, `comment TextureFile` of PLY), as
/// they are to stand in the output: so that they lead to the files that they led to.
class MovedNames {
 public:
  /// Of `mesh`, which is written to `path`.
  MovedNames(const MeshFile& mesh, const std::string& path);

  /// The line with its names led on. Names that lead to no file stay, and so do those that may not
  /// be followed: see notes().
  std::string line(const std::string& line);
  /// What does not lead anywhere any more, in words.
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  std::string moved(const std::string& name);

  const MeshFile& mesh_;
  std::string folder_;  ///< of the output; "" where it is that of the input
  std::vector<std::string> notes_;
};

}  // namespace beltrami::cli
