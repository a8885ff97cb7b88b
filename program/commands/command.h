// What the commands share: a mesh for the library, failures, and reports.
#pragma once

#include <beltrami/beltrami.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "commands/options.h"
#include "commands/report.h"
#include "files/inside_folder.h"
#include "files/mesh_file.h"
#include "files/surface.h"

namespace beltrami::cli {

struct FlattenArguments {
  std::string input, output;
  std::string report, picture;      ///< paths, or "" for none
  Reach reach = Reach::kItsFolder;  ///< of names inside the mesh
  bool weld = false;                ///< vertices at one place count as one
  bool quiet = false;
  bool print_report = false;  ///< on standard output, instead of the summary
};

struct UnwrapArguments {
  std::string input, output;
  std::string seams, pins;       ///< paths, or "" for none
  std::string straighten;        ///< path of what is to be straight, or ""
  std::string paint;             ///< path of factors of seams, or ""
  std::string labels;            ///< what labels faces, or ""
  std::string materials;         ///< what draws seams to where it differs, or ""
  std::string written_seams;     ///< path, or ""
  std::string report, picture;   ///< paths, or "" for none
  std::string html;              ///< path of a page for browsers, or ""
  std::string masks;             ///< folder and name of the masks of pages, or ""
  std::uint32_t uv_set = 0;      ///< of glTF: TEXCOORD_ and this number
  bool bake = false;             ///< the textures of materials, for the new UVs
  bool merge_materials = false;  ///< with that, into one
  Reach reach = Reach::kItsFolder;
  bool triangulate = false;  ///< write the triangles that were computed on
  bool quiet = false;
  bool print_report = false;  ///< on standard output, instead of the summary
};

struct PackArguments {
  std::vector<std::string> files;    ///< inputs; without `outputs` an input and its output
  std::vector<std::string> outputs;  ///< one for each input, or none
  std::string report, picture;       ///< paths, or "" for none
  std::string masks;                 ///< as for unwrap
  std::string labels;                ///< what labels faces with pages of their own, or ""
  std::uint64_t kept = 0;            ///< the charts of so many inputs stay where they are
  bool keep_scales = false;          ///< charts keep their sizes to each other
  bool mirrored = false;             ///< charts that are mirrored as a whole are no fault
  std::uint32_t uv_set = 0;          ///< of glTF
  Reach reach = Reach::kItsFolder;
  bool quiet = false;
  bool print_report = false;  ///< on standard output, instead of the summary
};

struct TransferArguments {
  std::string old_mesh, new_mesh, texture, output;
  std::string wrap = "auto";  ///< what the texture shows beyond its edges, or that it has tiles
  int resolution = 0;         ///< of the output; 0: of the texture
  int margin = 2;             ///< texels of gutters
  double cage = 0;            ///< how far rays look for OLD; 0: the nearest places
  std::uint64_t rays = 0;     ///< to the sky; 0: as many as usual
  Reach reach = Reach::kItsFolder;
  bool quiet = false;
};

struct CheckArguments {
  std::string input;
  std::string report, picture;      ///< paths, or "" for none
  bool float32 = false;             ///< judge the UVs rounded to single precision
  bool weld = false;                ///< vertices at one place and with one UV count as one
  bool mirrored = false;            ///< charts that are mirrored as a whole are no fault
  std::uint32_t uv_set = 0;         ///< of glTF: TEXCOORD_ and this number
  std::string labels;               ///< what densities are told by, or ""
  std::uint64_t resolution = 1024;  ///< texels to the side of a page
  double margin = 0;                ///< texels that there have to be
  bool within_page = false;         ///< all UVs have to be in [0,1]^2
  bool within_tiles = false;        ///< each chart has to be in a tile of UDIM
  Reach reach = Reach::kItsFolder;
  bool quiet = false;
  bool print_report = false;  ///< on standard output, instead of the summary
};

/// The commands: the exit code. They print the summary, or one line on stderr.
int flatten_command(const FlattenArguments& arguments, Options& options);
int unwrap_command(const UnwrapArguments& arguments, Options& options);
int check_command(const CheckArguments& arguments);
int pack_command(const PackArguments& arguments, Options& options);
int transfer_command(const TransferArguments& arguments);

using Context = std::unique_ptr<beltrami_context, void (*)(beltrami_context*)>;

/// Throws Failure.
Context make_context();

/// The symmetric Dirichlet energy of each triangle. Throws std::bad_alloc, or Failure.
std::vector<double> face_energies(const TriangleView& triangles);

/// The arrays as the library takes them; what `triangles` views must outlive it.
beltrami_mesh view_of(const TriangleView& triangles);
beltrami_buffer uv_view(const TriangleView& triangles);

/// Whether the UVs rounded to single precision are still injective.
bool injective_in_float32(const TriangleView& triangles);

/// Vertices that no face of the file uses.
std::uint64_t unreferenced_vertices(const MeshFile& file);

/// Throws for a status below 0: "path: message (face 3, counted from 0)".
void require_ok(beltrami_status status, const std::string& path, const char* message,
                std::int32_t element_kind, std::uint64_t element);

/// The same for a status about a mesh that was read: triangles become faces of the file, and where
/// it is in pieces only because faces do not share their vertices, the message says how to weld it.
/// `surface` is of `file`.
void require_ok_mesh(beltrami_status status, const std::string& path, const char* message,
                     std::int32_t element_kind, std::uint64_t element, const MeshFile& file,
                     const Surface& surface);

/// The number of a face of the file for that of a triangle; BELTRAMI_NO_ELEMENT stays.
void to_face_of(const Surface& surface, std::uint64_t& triangle);

/// Whether two paths lead to one file; "" is no path.
bool same_file(const std::string& a, const std::string& b);

/// Throws Failure if two of the paths are the same file.
void require_distinct(const std::vector<std::string>& paths);

/// Throws Failure if standard output is one of the paths: the summary, which follows the files,
/// would be lost with what was there before them.
void require_apart_from_stdout(const std::vector<std::string>& paths);

/// Whether a status refuses a mesh for its topology: it is no disk, and may be unwrapped.
inline bool says_no_disk(beltrami_status status) {
  return status <= BELTRAMI_E_REPEATED_VERTEX && status >= BELTRAMI_E_GENUS;
}

/// Runs `body`, which returns the exit code. Its failures become one line on stderr, an exit code,
/// and a report at `report_path`, unless that is "" or one of `others`, which must not be lost.
int run_guarded(Report& report, const std::string& report_path,
                const std::vector<std::string>& others, const std::function<int()>& body);

/// Said where the one fault of a map is that charts are mirrored as a whole.
inline constexpr const char* kMirroredAdvice =
    "its faults are charts that are mirrored as a whole: where that is meant, give --mirrored";

/// Seconds since the program started.
double seconds_so_far();

}  // namespace beltrami::cli
