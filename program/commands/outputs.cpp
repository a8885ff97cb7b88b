#include "commands/outputs.h"

#include <string_view>

#include "commands/command.h"
#include "files/gltf_file.h"
#include "files/point_numbers.h"
#include "files/surface_view.h"
#include "process/failure.h"
#include "process/interrupt.h"

namespace beltrami::cli {

void require_output_format(const std::string& input, const std::string& output) {
  const MeshFormat format = format_of(input);
  if (format_of(output) != MeshFormat::kGltf) {
    require_writable_format(output);
  } else if (format != MeshFormat::kGltf) {
    throw Failure(output +
                  ": glTF is written from glTF alone, with all that a scene has: use the "
                  "extension .obj or .ply");
  }
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

beltrami_status judge_stored_uvs(MeshFile& file, const std::string& path,
                                 beltrami_atlas_certificate& found) {
  const std::vector<double> uvs = file.corner_uvs.values;
  for (std::size_t i = 0; i < uvs.size(); i += 2) {
    const auto [u, v] = stored_uv(uvs[i], uvs[i + 1]);
    file.corner_uvs.values[i] = double{u};
    file.corner_uvs.values[i + 1] = -double{v};
  }
  const SurfaceView view(file);
  const beltrami_surface surface = view.surface();
  found = {};
  found.struct_size = sizeof found;
  const beltrami_status status = beltrami_check_atlas(&surface, 0, &found, nullptr, 0);
  require_ok(status, path, "", found.error_element_kind, found.error_element);
  file.corner_uvs.values = uvs;
  return status;
}

std::vector<std::string> write_outputs(const MeshFile& file, const std::string& path,
                                       std::uint32_t uv_set, std::deque<AtomicFile>& outputs) {
  if (format_of(path) != MeshFormat::kGltf) {
    AtomicFile& output = outputs.emplace_back(path);
    write_mesh(file, path, [&](std::string_view bytes) {
      throw_if_interrupted();
      output.write(bytes);
    });
    output.close();
    return not_kept(file, path);
  }
  const GltfOutput gltf = write_gltf(file, uv_set, path);
  for (const GltfOutput::File& part : gltf.files) {
    AtomicFile& output = outputs.emplace_back(part.path);
    for (const std::string& piece : part.pieces) {
      throw_if_interrupted();
      output.write(piece);
    }
    output.close();
  }
  return gltf.not_kept;
}

}  // namespace beltrami::cli
