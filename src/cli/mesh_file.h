// Triangle meshes in files: OBJ, OFF, PLY and STL.
//
// The readers and writers are our own because three things are the point of this program that
// general mesh libraries do not give: doubles that are correctly rounded in both directions
// (std::from_chars and std::to_chars), vertices and faces that keep their order and count, and
// errors that say which line, face or vertex of which file. A file is read into memory whole.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace beltrami::cli {

struct MeshFile {
  std::vector<double> positions;      ///< x y z per vertex, in file order
  std::vector<std::uint32_t> faces;   ///< 3 vertices per face, in file order, each < vertex_count
  std::vector<double> uvs;            ///< u v per vertex; empty where not asked for
  bool single_uvs = false;            ///< single precision holds them: PLY stores them so
  std::uint64_t welded_vertices = 0;  ///< STL: corners that fell together with an earlier one

  std::uint64_t vertex_count() const { return positions.size() / 3; }
  std::uint64_t face_count() const { return faces.size() / 3; }
};

enum class MeshFormat { kObj, kOff, kPly, kStl };

/// Which parts of a file a command needs.
enum class Content {
  kSurface,  ///< positions and faces: UVs of the file are passed over
  kUvs       ///< also one UV per vertex: a file without, or with several for one vertex, fails
};

/// The format that the extension of `path` names, in any case. Throws Failure for others.
MeshFormat format_of(const std::string& path);

/// Throws Failure unless `path` has the extension of a format that can hold UVs: OBJ or PLY.
void require_writable_format(const std::string& path);

/// Reads `path`. Throws Failure for anything unreadable, truncated or not a triangle, and for
/// indices out of range; std::bad_alloc. Face and vertex numbers in messages count from 0.
MeshFile read_mesh(const std::string& path, Content content);

/// The readers behind read_mesh: `text` is the whole file, `path` is for messages.
MeshFile read_obj(std::string_view text, const std::string& path, Content content);
MeshFile read_off(std::string_view text, const std::string& path, Content content);
MeshFile read_ply(std::string_view text, const std::string& path, Content content);
MeshFile read_stl(std::string_view text, const std::string& path, Content content);

/// Receives the bytes of a file in order.
using Sink = std::function<void(std::string_view)>;

/// Writes `mesh` with its UVs (one per vertex) in the format that `path` names. Numbers in text
/// have the fewest digits (at most 17) that read back to the same bits.
void write_mesh(const MeshFile& mesh, const std::string& path, const Sink& sink);

}  // namespace beltrami::cli
