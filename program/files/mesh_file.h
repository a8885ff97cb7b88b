// Meshes in files: OBJ, OFF, PLY, STL and glTF; and MNI objects, which have the extension of OBJ.
//
// The readers and writers are our own because four things are the point of this program that
// general mesh libraries do not give: doubles that are correctly rounded in both directions
// (std::from_chars and std::to_chars), vertices and faces that keep their order and count, what a
// file carries beside them kept for the output, and errors that say which line, face or vertex of
// which file. A file is read into memory whole.
//
// A reader returns what it has proved: every corner is a vertex that is stored, every polygon has
// three corners or more, and every column has a value for each of its items.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "files/column.h"
#include "files/inside_folder.h"
#include "files/polygons.h"

namespace beltrami::cli {

namespace gltf {
struct Model;
}

inline constexpr std::uint32_t kNoNormal = std::numeric_limits<std::uint32_t>::max();
/// What the library can index; files with more are refused.
inline constexpr std::int64_t kMaxIndex = std::numeric_limits<std::int32_t>::max();

/// Normals of corners. Those of vertices are the vertex columns nx, ny and nz.
struct CornerNormals {
  std::vector<double> values;            ///< x y z each
  std::vector<std::uint32_t> of_corner;  ///< kNoNormal for none; empty where no corner has one
};

/// UVs of corners, where a vertex has several.
struct CornerUvs {
  std::vector<double> values;            ///< u v each
  std::vector<std::uint32_t> of_corner;  ///< empty where vertices have the UVs
};

/// A statement of an OBJ file that holds for, or stands between, the faces: a group, a material.
struct Statement {
  std::uint64_t polygon = 0;  ///< it stands before this one
  std::string text;           ///< as in the file, without the line end; in UTF-8
  std::string bytes = {};     ///< as in the file, where that is no UTF-8 and the name is one of
                              ///< other files
  bool leads_on = false;      ///< names in it are those of files beside the output

  const std::string& in_file() const { return bytes.empty() ? text : bytes; }
};

/// A mesh as its file has it. What is computed on is its Surface (surface.h).
struct MeshFile {
  std::string path;                  ///< of the file, for messages; "" where it was never one
  Reach reach = Reach::kItsFolder;   ///< of names in it
  std::vector<double> positions;     ///< x y z per vertex, in file order
  Polygons polygons;                 ///< in file order
  std::vector<double> uvs;           ///< u v per vertex; empty where not asked for
  CornerUvs corner_uvs;              ///< instead of these
  bool single_uvs = false;           ///< single precision holds them: PLY stores them so
  std::uint64_t welded_corners = 0;  ///< STL: corners that fell together with an earlier one
  std::uint64_t short_faces = 0;     ///< of fewer than three corners, which are set aside

  /// What the file carries beside these, in the names of PLY: colours are red, green, blue and
  /// alpha, normals nx, ny and nz.
  std::vector<Column> vertex_columns, face_columns;
  bool unit_colours = false;  ///< colours go from 0 to 1 whatever their type, as in OBJ
  CornerNormals normals;
  std::vector<Statement> statements;  ///< by polygon
  std::vector<Table> tables;          ///< other elements of a PLY file
  std::vector<std::string> comments;  ///< of a PLY header, whole lines
  std::vector<std::string> not_kept;  ///< what the reader passed over, in words
  std::string truncated;  ///< "" or how the file ends amid its faces: these are left out
  std::shared_ptr<const gltf::Model> gltf;  ///< all of a glTF file, for gltf_file.h

  std::uint64_t vertex_count() const { return positions.size() / 3; }
};

enum class MeshFormat { kObj, kOff, kPly, kStl, kGltf };

/// Which parts of a file a command needs.
enum class Content {
  kSurface,  ///< all but UVs, which a run replaces
  kUvs,      ///< positions, polygons and UVs, and nothing else: a file without UVs fails
  kSomeUvs,  ///< the same, and corners of OBJ without UVs have some that are no numbers
  kAll       ///< both
};

/// Whether a command needs what is neither positions, polygons nor UVs.
constexpr bool wants_attributes(Content content) {
  return content == Content::kSurface || content == Content::kAll;
}

/// The format that the extension of `path` names, in any case. Throws Failure for others.
MeshFormat format_of(const std::string& path);

/// Throws Failure, which lists the formats that can be written, unless `path` has the extension of
/// one that holds UVs of any mesh: OBJ or PLY.
void require_writable_format(const std::string& path);
/// Whether `path` has the extension of glTF.
bool is_gltf_name(const std::string& path);
/// Throws Failure where `path` names a picture of another format than PNG, the one that is written.
void require_png_name(const std::string& path);

/// Reads `path`, and what it names within `reach`. Throws Failure for anything unreadable, and for
/// indices out of range; std::bad_alloc. A PLY file that ends amid its faces is read as far as it
/// goes: see `truncated`. Face and vertex numbers in messages count from 0.
MeshFile read_mesh(const std::string& path, Content content, Reach reach = Reach::kItsFolder);

/// Throws Failure for a file that ends amid its faces.
void require_whole(const MeshFile& mesh);

/// The readers behind read_mesh: `text` is the whole file, `path` is for messages.
MeshFile read_obj(std::string_view text, const std::string& path, Content content);
MeshFile read_off(std::string_view text, const std::string& path, Content content);
MeshFile read_ply(std::string_view text, const std::string& path, Content content);
MeshFile read_mni(std::string_view text, const std::string& path, Content content);
MeshFile read_stl(std::string_view text, const std::string& path, Content content);
/// gltf_file.h says what of a scene is in it. Buffers in files are read from beside `path`.
MeshFile read_gltf(std::string_view bytes, const std::string& path, Content content,
                   Reach reach = Reach::kItsFolder);

/// Receives the bytes of a file in order.
using Sink = std::function<void(std::string_view)>;

/// Writes `mesh` with its UVs in the format that `path` names, and of the rest
/// what that format can hold. Numbers in text have the fewest digits (at most 17) that read back to
/// the same bits.
void write_mesh(const MeshFile& mesh, const std::string& path, const Sink& sink);

/// Gives `mesh` the triangles that its polygons were cut into, as three corners each, in any order
/// of the corners. What belongs to faces and corners goes with them.
void cut_faces(MeshFile& mesh, const std::vector<std::uint32_t>& corners);

/// Makes UVs of corners such of vertices where all corners of each vertex agree.
void unite_corner_uvs(MeshFile& mesh);

/// Gives `mesh` other faces, triangles on the same vertices. What belonged to the old ones goes,
/// and is said in not_kept.
void replace_faces(MeshFile& mesh, std::vector<std::uint32_t> corners);

/// What write_mesh leaves out, and what the reader did, in words: "groups", "face property flags".
std::vector<std::string> not_kept(const MeshFile& mesh, const std::string& path);

}  // namespace beltrami::cli
