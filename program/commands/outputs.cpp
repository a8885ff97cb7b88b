#include "commands/outputs.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <set>
#include <string_view>
#include <utility>

#include "commands/command.h"
#include "files/gltf_file.h"
#include "files/point_numbers.h"
#include "files/polygons.h"
#include "files/surface_view.h"
#include "files/uv_numbers.h"
#include "process/failure.h"
#include "process/interrupt.h"

namespace beltrami::cli {

void require_output_format(const std::string& input, const std::string& output) {
  const MeshFormat format = format_of(input);
  if (!is_gltf_name(output)) {
    require_writable_format(output);
  } else if (format != MeshFormat::kGltf) {
    throw Failure(output +
                  ": glTF is written from glTF alone, with all that a scene has: use the "
                  "extension .obj or .ply");
  }
}

void require_uv_set_of_gltf(std::uint32_t uv_set, const std::string& output) {
  if (uv_set == 0 || is_gltf_name(output)) return;
  throw Failure("--uv-set " + std::to_string(uv_set) + ": " + output +
                " has one set of UVs, as all formats but glTF have: leave the option out, or write "
                ".gltf or .glb");
}

void set_corner_uvs(MeshFile& file, const std::vector<double>& uvs, bool single) {
  PointNumbers<2> points;
  file.corner_uvs.of_corner.clear();
  file.corner_uvs.of_corner.reserve(uvs.size() / 2);
  for (std::size_t c = 0; c < uvs.size(); c += 2) {
    file.corner_uvs.of_corner.push_back(points.number({uvs[c], uvs[c + 1]}));
  }
  file.corner_uvs.values = points.take_coordinates();
  file.uvs.clear();
  file.single_uvs = single;
}

namespace {

/// Of triangles: the corners of the first with these three UVs, in any order.
std::vector<std::uint32_t> corners_of_first_copies(const MeshFile& file) {
  std::set<std::array<std::uint32_t, 3>> known;
  std::vector<std::uint32_t> kept;
  const std::vector<std::uint32_t>& uvs = file.corner_uvs.of_corner;
  for (std::uint32_t c = 0; c < uvs.size(); c += 3) {
    std::array<std::uint32_t, 3> key = {uvs[c], uvs[c + 1], uvs[c + 2]};
    std::sort(key.begin(), key.end());
    if (known.insert(key).second) kept.insert(kept.end(), {c, c + 1, c + 2});
  }
  return kept;
}

}  // namespace

std::optional<beltrami_atlas_certificate> judge_held_uvs(const MeshFile& file,
                                                         const std::string& path, bool share,
                                                         bool mirrored) {
  const UvNumbers numbers = uv_numbers(format_of(path), file.single_uvs);
  const std::vector<double>& uvs = file.corner_uvs.values;
  bool kept = true;
  for (std::size_t i = 0; kept && i < uvs.size(); i += 2) kept = numbers.keeps(uvs[i], uvs[i + 1]);
  if (kept) return std::nullopt;
  MeshFile judged;
  judged.positions = file.positions;
  judged.polygons = file.polygons;
  judged.corner_uvs = file.corner_uvs;
  for (std::size_t i = 0; i < uvs.size(); i += 2) {
    const auto [u, v] = numbers.judged(uvs[i], uvs[i + 1]);
    judged.corner_uvs.values[i] = u;
    judged.corner_uvs.values[i + 1] = v;
  }
  if (share && judged.polygons.all_triangles()) cut_faces(judged, corners_of_first_copies(judged));
  const SurfaceView view(judged);
  const beltrami_surface surface = view.surface();
  beltrami_atlas_certificate found{};
  found.struct_size = sizeof found;
  const beltrami_status status =
      beltrami_check_atlas(&surface, mirrored ? 1 : 0, &found, nullptr, 0);
  require_ok(status, file.path, "", found.error_element_kind, found.error_element);
  return found;
}

void note_held(const beltrami_atlas_certificate& held, Report& report) {
  if (held.injective != 0 || report.atlas_certificate->injective == 0) return;
  report.notes.emplace_back(
      "the UVs are injective, but not in the numbers that this format has for them where they lie: "
      "have them on pages, without --pack none, --pins and --kept, or write .obj or .ply");
}

void write_outputs(const MeshFile& file, const std::string& path, std::uint32_t uv_set,
                   std::deque<AtomicFile>& outputs, Report& report, const GltfTextures& textures) {
  const auto append = [](std::vector<std::string> lines, std::vector<std::string>& all) {
    std::move(lines.begin(), lines.end(), std::back_inserter(all));
  };
  if (format_of(path) != MeshFormat::kGltf) {
    AtomicFile& output = outputs.emplace_back(path);
    write_mesh(file, path, [&](std::string_view bytes) {
      throw_if_interrupted();
      output.write(bytes);
    });
    output.close();
    append(not_kept(file, path), report.not_kept);
    return;
  }
  GltfOutput gltf = write_gltf(file, uv_set, path, textures);
  for (const GltfOutput::File& part : gltf.files) {
    AtomicFile& output = outputs.emplace_back(part.path);
    for (const std::string& piece : part.pieces) {
      throw_if_interrupted();
      output.write(piece);
    }
    output.close();
  }
  for (std::string& old : gltf.replaced) outputs.back().remove_then(std::move(old));
  append(std::move(gltf.not_kept), report.not_kept);
  append(std::move(gltf.notes), report.notes);
}

}  // namespace beltrami::cli
