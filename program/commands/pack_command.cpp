// beltrami pack: read UVs of one mesh or several, pack their charts onto common pages, write,
// report.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <deque>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "commands/command.h"
#include "commands/options.h"
#include "commands/outputs.h"
#include "commands/pages.h"
#include "commands/progress_bar.h"
#include "commands/report.h"
#include "commands/tiles.h"
#include "commands/uv_mesh.h"
#include "files/atomic_file.h"
#include "files/given_cuts.h"
#include "files/gltf_file.h"
#include "files/mesh_file.h"
#include "files/polygons.h"
#include "files/surface_view.h"
#include "files/triangulate.h"
#include "picture/page_picture.h"
#include "picture/picture.h"
#include "process/failure.h"
#include "process/interrupt.h"

namespace beltrami::cli {
namespace {

/// A file with its UVs as the library takes them.
struct PackedFile {
  std::string input, output;
  MeshFile file;
  std::vector<std::uint32_t> corners;     ///< of the file's faces, three for each triangle
  UvMesh plane;                           ///< of the triangles, on their pages where they are kept
  std::vector<std::uint32_t> kept_pages;  ///< per triangle; empty: none is kept
  std::vector<std::uint64_t> labels;      ///< per triangle, where labels have their own pages
  std::vector<std::uint64_t> charts;      ///< per triangle
};

void note_options(const PackArguments& arguments, const Options& options, Report& report) {
  report.options = options.values();
  report.options.emplace_back("keep-scales", arguments.keep_scales);
  report.options.emplace_back("labels", arguments.labels);
  report.options.emplace_back("kept", static_cast<std::int64_t>(arguments.kept));
  report.options.emplace_back("mirrored", arguments.mirrored);
  report.options.emplace_back("masks", arguments.masks);
  report.threads = options.integer(BELTRAMI_OPTION_THREADS);
}

class PackRun {
 public:
  PackRun(const PackArguments& arguments, Options& options, Report& report)
      : arguments_(arguments),
        options_(options),
        report_(report),
        bar_(!arguments.quiet),
        context_(make_context()) {}

  int run() {
    name_files();
    require_files();
    // What glTF holds is in single precision.
    if (std::any_of(files_.begin(), files_.end(), is_gltf)) {
      options_.set(BELTRAMI_OPTION_FLOAT32, 1);
    }
    options_.apply_to(context_.get());
    note_options(arguments_, options_, report_);
    for (std::size_t i = 0; i < files_.size(); ++i) read(files_[i], i < arguments_.kept);
    {
      const CancelOnInterrupt guard(context_.get());
      pack();
    }
    fetch_report();
    for (std::size_t i = 0; i < files_.size(); ++i) fetch_uvs(i);
    report_.label_pages = labels_.taken();
    judge_again();
    for (const PackedFile& mesh : files_) judge_held(mesh);
    return write_files();
  }

 private:
  void name_files() {
    std::vector<std::string> inputs = arguments_.files, outputs = arguments_.outputs;
    if (outputs.empty() && inputs.size() == 2) {
      outputs = {inputs.back()};
      inputs.pop_back();
      require_meant_as_output(inputs.front(), outputs.front());
    }
    if (inputs.size() != outputs.size()) {
      throw Failure(
          "pack takes IN and OUT, or several INs and behind --output as many OUTs: there "
          "are " +
          std::to_string(inputs.size()) + " and " + std::to_string(outputs.size()));
    }
    if (arguments_.kept > 0 && !arguments_.labels.empty()) {
      throw Failure("--labels and --kept do not go together: charts that stay have their pages");
    }
    if (arguments_.kept > inputs.size()) {
      throw Failure("--kept: there are " + std::to_string(inputs.size()) + " meshes");
    }
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      files_.emplace_back();
      files_.back().input = inputs[i];
      files_.back().output = outputs[i];
    }
  }

  /// Two names may be two meshes to pack together: the second is written over only where it cannot
  /// be meant so, or --output says it.
  void require_meant_as_output(const std::string& input, const std::string& output) const {
    if (!same_file(input, output) && !has_uvs(output)) return;
    throw Failure(output +
                  ": is a mesh with UVs, which could be meant to be packed, too: to write over it, "
                  "put --output in front of it; to pack several meshes, give all of them, and as "
                  "many names behind --output");
  }

  bool has_uvs(const std::string& path) const {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored)) return false;
    try {
      read_mesh(path, Content::kUvs, arguments_.reach);
      return true;
    } catch (const Failure&) {
      throw_if_interrupted();
      return false;
    }
  }

  void require_files() const {
    require_png_name(arguments_.picture);
    std::vector<std::string> written = {arguments_.report, arguments_.picture};
    for (const PackedFile& mesh : files_) {
      require_output_format(mesh.input, mesh.output);
      require_uv_set_of_gltf(arguments_.uv_set, mesh.output);
      require_distinct({mesh.input, arguments_.report, arguments_.picture});
      written.push_back(mesh.output);
    }
    require_distinct(written);
    if (!arguments_.quiet || arguments_.print_report) require_apart_from_stdout(written);
    if (!arguments_.masks.empty()) written.push_back(path_of_page(arguments_.masks, 0));
    for (const std::string& path : written) {
      if (!path.empty()) require_writable(path);
    }
  }

  void read(PackedFile& mesh, bool kept) {
    throw_if_interrupted();
    bar_.show(0, "read");
    StageClock clock(report_, "read");
    MeshFile& file = mesh.file = read_mesh(mesh.input, Content::kAll, arguments_.reach);
    require_whole(file);
    if (file.uvs.empty() && file.corner_uvs.of_corner.empty()) {
      throw Failure(mesh.input + ": has no UVs to pack: unwrap it first");
    }
    if (is_gltf(mesh)) {
      require_uv_set(file, arguments_.uv_set);
      for (const std::string& path : gltf_output_paths(file, mesh.output)) require_writable(path);
    }
    mesh.corners = triangle_corners(file);
    mesh.plane = uv_mesh_of(file, mesh.corners);
    if (kept) keep(mesh);
    if (!arguments_.labels.empty()) label(mesh);
    report_.vertices = report_.vertices.value_or(0) + file.vertex_count();
    report_.faces = report_.faces.value_or(0) + file.polygons.size();
    report_.short_faces = report_.short_faces.value_or(0) + file.short_faces;
    report_.triangles = report_.triangles.value_or(0) + mesh.corners.size() / 3;
    clock.finish();
  }

  static bool is_gltf(const PackedFile& mesh) {
    return format_of(mesh.output) == MeshFormat::kGltf;
  }

  /// Charts stay in the tile that the centres of their faces are in.
  void keep(PackedFile& mesh) const {
    std::vector<double> moved = mesh.plane.uvs;
    for (std::size_t i = 0; i < mesh.plane.uv_indices.size(); i += 3) {
      std::array<double, 2> tile{};
      for (std::size_t d = 0; d < 2; ++d) {
        double sum = 0;
        for (std::size_t k = 0; k < 3; ++k)
          sum += mesh.plane.uvs[2 * mesh.plane.uv_indices[i + k] + d];
        tile[d] = std::floor(sum / 3);
      }
      const bool is_page = tile[0] >= 0 && tile[0] < double(kPagesInARow) && tile[1] >= 0;
      if (!is_page || tile[1] >= double(kMostRowsOfPages)) {
        throw Failure(mesh.input +
                      ": --kept: its UVs are beside the pages of a texture, [0,1]^2 "
                      "and the tiles of UDIM");
      }
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t uv = 2 * std::size_t{mesh.plane.uv_indices[i + k]};
        for (std::size_t d = 0; d < 2; ++d) moved[uv + d] = mesh.plane.uvs[uv + d] - tile[d];
      }
      mesh.kept_pages.push_back(
          static_cast<std::uint32_t>(tile[0] + double(kPagesInARow) * tile[1]));
    }
    mesh.plane.uvs = moved;
  }

  void label(PackedFile& mesh) {
    const std::vector<std::uint64_t> of_faces =
        face_labels(mesh.file, arguments_.labels, "--labels", "give pages to");
    std::map<std::uint64_t, std::uint64_t> numbers;
    for (const auto& [label, text] : label_texts(mesh.file, arguments_.labels, of_faces)) {
      numbers[label] = labels_.number(text);
    }
    for (std::size_t i = 0; i < mesh.corners.size(); i += 3) {
      mesh.labels.push_back(numbers[of_faces[mesh.file.polygons.of_corner(mesh.corners[i])]]);
    }
  }

  void pack() {
    throw_if_interrupted();
    std::vector<beltrami_uv_mesh> meshes;
    for (const PackedFile& mesh : files_) {
      beltrami_uv_mesh& view = meshes.emplace_back();
      view = {};
      view.struct_size = sizeof view;
      view.uv_count = mesh.plane.uvs.size() / 2;
      view.face_count = mesh.plane.uv_indices.size() / 3;
      view.uvs = {mesh.plane.uvs.data(), 0, BELTRAMI_F64, 0};
      view.uv_indices = {mesh.plane.uv_indices.data(), 0, BELTRAMI_U32, 0};
      if (!arguments_.keep_scales) {
        view.vertex_count = mesh.file.vertex_count();
        view.positions = {mesh.file.positions.data(), 0, BELTRAMI_F64, 0};
        view.indices = {mesh.plane.vertices.data(), 0, BELTRAMI_U32, 0};
      }
      if (!mesh.kept_pages.empty()) {
        view.kept_pages = {mesh.kept_pages.data(), 0, BELTRAMI_U32, 0};
      }
      if (!mesh.labels.empty()) view.page_labels = {mesh.labels.data(), 0, BELTRAMI_U64, 0};
      view.cancel = interrupt_number();
    }
    std::vector<const beltrami_uv_mesh*> pointers;
    for (const beltrami_uv_mesh& mesh : meshes) pointers.push_back(&mesh);
    const auto progress = [](void* bar, double fraction, const char* stage) -> std::int32_t {
      static_cast<ProgressBar*>(bar)->show(fraction, stage);
      return interrupted();
    };
    StageClock clock(report_, "pack");
    const beltrami_status status =
        beltrami_pack(context_.get(), pointers.data(), pointers.size(), progress, &bar_);
    require(status);
    report_.status = beltrami_status_name(status);
    clock.finish();
  }

  void fetch_report() {
    report_pages(context_.get(), report_);
    // What is written reads back to these very doubles, so this is the verdict on the files.
    report_.atlas_certificate = certificate(BELTRAMI_F64);
    report_.float32_injective = certificate(BELTRAMI_F32).injective != 0;
  }

  beltrami_atlas_certificate certificate(std::int32_t type) const {
    beltrami_atlas_certificate found{};
    found.struct_size = sizeof found;
    require(beltrami_get_packing_certificate(context_.get(), type, &found));
    return found;
  }

  void fetch_uvs(std::size_t index) {
    PackedFile& mesh = files_[index];
    require(beltrami_get_packed_uvs(context_.get(), index, mesh.plane.uvs.data(), BELTRAMI_F64, 0));
    mesh.charts.resize(mesh.plane.uv_indices.size() / 3);
    require(beltrami_get_packed_charts(context_.get(), index, mesh.charts.data(), BELTRAMI_U64, 0));
    std::vector<std::uint64_t> pages(report_.packing->charts);
    require(beltrami_get_chart_pages(context_.get(), pages.data(), BELTRAMI_U64, 0));
    std::vector<double> corner_uvs(2 * mesh.file.polygons.corners().size());
    for (std::size_t i = 0; i < mesh.corners.size(); ++i) {
      const auto [u, v] = corner_of_page(pages[mesh.charts[i / 3]]);
      const double* uv = &mesh.plane.uvs[2 * std::size_t{mesh.plane.uv_indices[i]}];
      corner_uvs[2 * std::size_t{mesh.corners[i]}] = uv[0] + u;
      corner_uvs[2 * std::size_t{mesh.corners[i]} + 1] = uv[1] + v;
    }
    for (std::size_t t = 0; t < mesh.labels.size(); ++t) {
      labels_.add(mesh.labels[t], pages[mesh.charts[t]]);
    }
    set_corner_uvs(mesh.file, corner_uvs, options_.integer(BELTRAMI_OPTION_FLOAT32) != 0);
  }

  /// Where the packer's verdict is no: that with charts that are mirrored as a whole taken for
  /// their mirror images, or with faces left out that have no area in space. On all meshes as one,
  /// for a chart of one may lie on that of another.
  void judge_again() {
    if (report_.atlas_certificate->injective != 0 && report_.float32_injective == true) return;
    MeshFile all;
    for (const PackedFile& mesh : files_) append_for_verdict(mesh.file, all);
    beltrami_atlas_certificate found{};
    beltrami_status status = check(all, true, found);
    if (!arguments_.mirrored) {
      if (status == BELTRAMI_OK && found.mirrored_charts > 0) report_.advice = kMirroredAdvice;
      if (!arguments_.keep_scales) return;
      // The packer was not told which faces have no area in space.
      status = check(all, false, found);
    }
    report_.status = beltrami_status_name(status);
    report_.atlas_certificate = found;
    for (double& x : all.corner_uvs.values) x = static_cast<double>(static_cast<float>(x));
    beltrami_atlas_certificate single{};
    report_.float32_injective = check(all, arguments_.mirrored, single) == BELTRAMI_OK;
  }

  static void append_for_verdict(const MeshFile& file, MeshFile& all) {
    const auto vertices = static_cast<std::uint32_t>(all.vertex_count());
    const auto uvs = static_cast<std::uint32_t>(all.corner_uvs.values.size() / 2);
    all.positions.insert(all.positions.end(), file.positions.begin(), file.positions.end());
    for (std::uint64_t i = 0; i < file.polygons.size(); ++i) {
      for (const std::uint32_t vertex : file.polygons[i])
        all.polygons.add_corner(vertices + vertex);
      all.polygons.end_polygon();
    }
    const auto& [values, of_corner] = file.corner_uvs;
    all.corner_uvs.values.insert(all.corner_uvs.values.end(), values.begin(), values.end());
    for (const std::uint32_t uv : of_corner) all.corner_uvs.of_corner.push_back(uvs + uv);
  }

  beltrami_status check(const MeshFile& all, bool mirrored,
                        beltrami_atlas_certificate& found) const {
    const SurfaceView view(all);
    const beltrami_surface surface = view.surface();
    found = {};
    found.struct_size = sizeof found;
    const beltrami_status status =
        beltrami_check_atlas(&surface, mirrored ? 1 : 0, &found, nullptr, 0);
    require_ok(status, "the meshes", "", found.error_element_kind, found.error_element);
    return status;
  }

  /// The last verdict is on the numbers that the file gets.
  void judge_held(const PackedFile& mesh) {
    const auto found = judge_held_uvs(mesh.file, mesh.output, false, arguments_.mirrored);
    if (!found || found->injective != 0 || report_.atlas_certificate->injective == 0) return;
    note_held(*found, report_);
    report_.status = beltrami_status_name(BELTRAMI_NOT_INJECTIVE);
    report_.atlas_certificate = found;
    report_.float32_injective = false;
  }

  int write_files() {
    bar_.show(1, "write");
    StageClock clock(report_, "write");
    std::deque<AtomicFile> outputs;
    for (const PackedFile& mesh : files_) {
      write_outputs(mesh.file, mesh.output, arguments_.uv_set, outputs, report_);
    }
    if (!arguments_.masks.empty()) write_masks(context_.get(), arguments_.masks, outputs);
    if (!arguments_.picture.empty()) write_picture(outputs.emplace_back(arguments_.picture));
    clock.finish();
    report_.seconds = seconds_so_far();
    if (!arguments_.report.empty()) {
      AtomicFile& report = outputs.emplace_back(arguments_.report);
      report.write(to_json(report_));
      report.close();
    }
    std::string note, summary;
    if (!arguments_.quiet) {
      std::string written;
      for (const PackedFile& mesh : files_) written += (written.empty() ? "" : ", ") + mesh.output;
      note = to_note(report_, written);
      summary = to_summary(report_, written);
    }
    if (arguments_.print_report) summary = to_json(report_);
    bar_.clear();
    throw_if_interrupted();
    // From here on nothing needs memory: with something replaced, it must not run out.
    commit(outputs);
    remark(note);
    return print(summary, "the summary", report_.injective() ? kExitInjective : kExitNotInjective);
  }

  void write_picture(AtomicFile& file) const {
    PageTriangles all;
    for (const PackedFile& mesh : files_) {
      const auto& [values, of_corner] = mesh.file.corner_uvs;
      for (const std::uint32_t corner : mesh.corners) {
        const double* uv = &values[2 * std::size_t{of_corner[corner]}];
        all.uvs.insert(all.uvs.end(), uv, uv + 2);
      }
      all.charts.insert(all.charts.end(), mesh.charts.begin(), mesh.charts.end());
    }
    file.write(encode_png(render_pages(all, report_.packing->pages)));
    file.close();
  }

  void require(beltrami_status status) const {
    const std::string path = files_.size() == 1 ? files_.front().input : "the meshes";
    require_ok(status, path, beltrami_error_message(context_.get()),
               beltrami_error_element_kind(context_.get()), beltrami_error_element(context_.get()));
  }

  const PackArguments& arguments_;
  Options& options_;
  Report& report_;
  ProgressBar bar_;
  Context context_;
  std::vector<PackedFile> files_;
  PagesOfLabels labels_;
};

}  // namespace

int pack_command(const PackArguments& arguments, Options& options) {
  Report report;
  report.command = "pack";
  report.printed = arguments.print_report;
  report.input_path = arguments.files.front();
  note_options(arguments, options, report);
  std::vector<std::string> others = arguments.files;
  others.insert(others.end(), arguments.outputs.begin(), arguments.outputs.end());
  others.push_back(arguments.picture);
  return run_guarded(report, arguments.report, others,
                     [&] { return PackRun(arguments, options, report).run(); });
}

}  // namespace beltrami::cli
