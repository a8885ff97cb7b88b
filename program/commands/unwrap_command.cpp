// beltrami unwrap: read any mesh, cut it, flatten its charts, write, report.
#include <algorithm>
#include <deque>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "commands/bake.h"
#include "commands/command.h"
#include "commands/options.h"
#include "commands/outputs.h"
#include "commands/pages.h"
#include "commands/progress_bar.h"
#include "commands/report.h"
#include "commands/tiles.h"
#include "commands/to_gltf.h"
#include "files/atomic_file.h"
#include "files/given_cuts.h"
#include "files/gltf_file.h"
#include "files/mesh_file.h"
#include "files/paint.h"
#include "files/pins.h"
#include "files/split_mesh.h"
#include "files/straight.h"
#include "files/surface_view.h"
#include "picture/html.h"
#include "picture/picture.h"
#include "process/failure.h"
#include "process/interrupt.h"

namespace beltrami::cli {
namespace {

/// A summary names the first of them; more would bury the rest of a report.
constexpr std::size_t kMostFailedCharts = 1000;

void note_options(const UnwrapArguments& arguments, const Options& options, Report& report) {
  report.options = options.values();
  report.options.emplace_back("seams", arguments.seams);
  report.options.emplace_back("labels", arguments.labels);
  report.options.emplace_back("paint", arguments.paint);
  report.options.emplace_back("materials", arguments.materials);
  report.options.emplace_back("uv-set", std::to_string(arguments.uv_set));
  report.options.emplace_back("pins", arguments.pins);
  report.options.emplace_back("straighten", arguments.straighten);
  report.options.emplace_back("triangulate", arguments.triangulate);
  report.options.emplace_back("masks", arguments.masks);
  report.options.emplace_back("bake", arguments.bake);
  report.options.emplace_back("merge-materials", arguments.merge_materials);
  report.threads = options.integer(BELTRAMI_OPTION_THREADS);
}

class Unwrapping {
 public:
  Unwrapping(const UnwrapArguments& arguments, Options& options, Report& report)
      : arguments_(arguments),
        options_(options),
        report_(report),
        bar_(!arguments.quiet),
        context_(make_context()) {}

  int run() {
    require_files();
    // What glTF holds is in single precision.
    if (writes_gltf() && on_pages()) options_.set(BELTRAMI_OPTION_FLOAT32, 1);
    options_.apply_to(context_.get());
    note_options(arguments_, options_, report_);
    read();
    {
      const CancelOnInterrupt guard(context_.get());
      unwrap();
    }
    fetch_report();
    fetch_uvs();
    bake_textures();
    if (arguments_.triangulate) triangulate();
    judge_held();
    return write_files();
  }

 private:
  /// Everything about files that can be told before the work.
  void require_files() const {
    if (becomes_gltf()) {
      require_no_numbers();
    } else {
      require_output_format(arguments_.input, arguments_.output);
    }
    require_uv_set_of_gltf(arguments_.uv_set, arguments_.output);
    require_png_name(arguments_.picture);
    if (writes_gltf() && arguments_.triangulate) {
      throw Failure(arguments_.output +
                    ": the faces of glTF are triangles, in the winding that they have: leave out "
                    "--triangulate, or use the extension .obj or .ply");
    }
    for (const std::string& mesh : {arguments_.input, arguments_.output}) {
      require_distinct({mesh, arguments_.seams, arguments_.pins, arguments_.paint,
                        arguments_.straighten, arguments_.report, arguments_.picture,
                        arguments_.html});
      require_distinct({mesh, arguments_.written_seams, arguments_.pins, arguments_.paint,
                        arguments_.straighten, arguments_.report, arguments_.picture,
                        arguments_.html});
    }
    const std::vector<std::string> written = {arguments_.output, arguments_.written_seams,
                                              arguments_.report, arguments_.picture,
                                              arguments_.html};
    if (!arguments_.quiet || arguments_.print_report) require_apart_from_stdout(written);
    for (const std::string& path : written) {
      if (!path.empty()) require_writable(path);
    }
    if (!arguments_.masks.empty()) require_writable(path_of_page(arguments_.masks, 0));
    if (arguments_.merge_materials && !(arguments_.bake && writes_gltf())) {
      throw Failure(
          "--merge-materials: the textures of several materials become one set by --bake, in "
          "glTF: add --bake, and write .glb or .gltf");
    }
    if (on_pages()) return;
    if (!arguments_.masks.empty()) {
      throw Failure("--masks: there are masks of pages alone: do without --pack none and --pins");
    }
    if (arguments_.bake) {
      throw Failure(
          "--bake: textures are baked for pages alone: do without --pack none and --pins");
    }
  }

  bool on_pages() const {
    return options_.integer(BELTRAMI_OPTION_PACK) != BELTRAMI_PACK_NONE && arguments_.pins.empty();
  }

  /// Vertices and faces have other numbers in glTF than in the file that is read.
  void require_no_numbers() const {
    for (const auto& [option, path] :
         {std::pair("--seams", arguments_.seams), std::pair("--pins", arguments_.pins),
          std::pair("--paint", arguments_.paint), std::pair("--straighten", arguments_.straighten),
          std::pair("--write-seams", arguments_.written_seams)}) {
      if (path.empty()) continue;
      throw Failure(
          std::string(option) +
          ": it goes by numbers of vertices of IN, and glTF has others: write .obj or .ply");
    }
  }

  bool becomes_gltf() const {
    return writes_gltf() && format_of(arguments_.input) != MeshFormat::kGltf;
  }

  bool writes_gltf() const { return is_gltf_name(arguments_.output); }

  void read() {
    bar_.show(0, "read");
    StageClock clock(report_, "read");
    const bool islands = options_.integer(BELTRAMI_OPTION_CUT) == BELTRAMI_CUT_ISLANDS;
    file_ =
        read_mesh(arguments_.input, islands ? Content::kAll : Content::kSurface, arguments_.reach);
    read_labels();
    if (becomes_gltf()) {
      given_ = {file_.vertex_count(), unreferenced_vertices(file_)};
      auto [file, polygons] = as_gltf(file_, islands ? Content::kAll : Content::kSurface);
      file_ = std::move(file);
      for (std::vector<std::uint64_t>* labels : {&labels_, &materials_}) {
        if (labels->empty()) continue;
        std::vector<std::uint64_t> of_triangles;
        for (const std::uint64_t polygon : polygons) of_triangles.push_back((*labels)[polygon]);
        *labels = std::move(of_triangles);
      }
    }
    if (writes_gltf()) {
      require_uv_set(file_, arguments_.uv_set);
      for (const std::string& path : gltf_output_paths(file_, arguments_.output)) {
        require_writable(path);
      }
    }
    if (arguments_.bake) {
      bake_.emplace(file_, arguments_.output, arguments_.merge_materials);
      for (const std::string& path : bake_->paths()) {
        require_distinct({path, arguments_.report, arguments_.picture, arguments_.html,
                          arguments_.written_seams});
        require_writable(path);
      }
    }
    if (!file_.truncated.empty()) {
      file_.not_kept.push_back("what is missing of the input (" + file_.truncated + ")");
    }
    if (!arguments_.paint.empty()) paint_ = read_paint(arguments_.paint, file_);
    if (!arguments_.seams.empty()) {
      seams_ = read_seams(arguments_.seams, file_);
      note_seams_without_edge();
    }
    if (!arguments_.pins.empty()) pins_ = read_pins(arguments_.pins, file_);
    if (!arguments_.straighten.empty()) straight_ = read_straight(arguments_.straighten, file_);
    report_.vertices = given_ ? given_->count : file_.vertex_count();
    report_.faces = file_.polygons.size();
    report_.short_faces = file_.short_faces;
    clock.finish();
  }

  /// Of the faces that the file has.
  void read_labels() {
    const bool have_pages = options_.integer(BELTRAMI_OPTION_LABEL_PAGES) != 0;
    if (arguments_.labels.empty() && have_pages) {
      throw Failure("--label-pages gives each label pages of its own: say by --labels which");
    }
    if (!arguments_.labels.empty()) {
      labels_ = face_labels(file_, arguments_.labels, "--labels", "cut along");
      if (have_pages) label_texts_ = label_texts(file_, arguments_.labels, labels_);
    }
    if (!arguments_.materials.empty()) {
      materials_ = face_labels(file_, arguments_.materials, "--materials", "draw seams");
    }
  }

  void note_seams_without_edge() {
    const SeamsWithoutEdge loose = seams_without_edge(seams_, file_);
    if (loose.count == 0) return;
    report_.notes.push_back(arguments_.seams + ": " + std::to_string(loose.count) + " of " +
                            std::to_string(seams_.size() / 2) +
                            " seams join vertices that no face has side by side, the first " +
                            std::to_string(loose.from) + " and " + std::to_string(loose.to) +
                            ": nothing is cut there (vertices count from 0)");
  }

  void unwrap() {
    // A signal from before the guard has cancelled nothing yet.
    throw_if_interrupted();
    const SurfaceView view(file_);
    beltrami_surface surface = view.surface();
    if (!labels_.empty()) surface.face_labels = {labels_.data(), 0, BELTRAMI_U64, 0};
    if (!seams_.empty()) surface.seams = {seams_.data(), 0, BELTRAMI_U32, 0};
    surface.seam_count = seams_.size() / 2;
    if (!materials_.empty()) surface.materials = {materials_.data(), 0, BELTRAMI_U64, 0};
    if (!paint_.of_vertices.empty()) {
      surface.vertex_paint = {paint_.of_vertices.data(), 0, BELTRAMI_F64, 0};
    }
    surface.painted_edge_count = paint_.of_edges.size();
    if (surface.painted_edge_count > 0) {
      surface.painted_edges = {paint_.edges.data(), 0, BELTRAMI_U64, 0};
      surface.edge_paint = {paint_.of_edges.data(), 0, BELTRAMI_F64, 0};
    }
    surface.pin_count = pins_.corners.size();
    if (surface.pin_count > 0) {
      surface.pins = {pins_.corners.data(), 0, BELTRAMI_U64, 0};
      surface.pin_uvs = {pins_.uvs.data(), 0, BELTRAMI_F64, 0};
      surface.pin_kinds = {pins_.kinds.data(), 0, BELTRAMI_U32, 0};
      surface.pin_directions = {pins_.directions.data(), 0, BELTRAMI_F64, 0};
    }
    surface.straight_edge_count = straight_.kinds.size();
    if (surface.straight_edge_count > 0) {
      surface.straight_edges = {straight_.edges.data(), 0, BELTRAMI_U64, 0};
      surface.straight_kinds = {straight_.kinds.data(), 0, BELTRAMI_U32, 0};
    }
    surface.rectangle_count = straight_.rectangles.size();
    if (surface.rectangle_count > 0) {
      surface.rectangles = {straight_.rectangles.data(), 0, BELTRAMI_U64, 0};
      surface.rectangle_corners = {straight_.rectangle_corners.data(), 0, BELTRAMI_U64, 0};
    }
    const auto progress = [](void* bar, double fraction, const char* stage) -> std::int32_t {
      static_cast<ProgressBar*>(bar)->show(fraction, stage);
      return interrupted();
    };
    const beltrami_status status = beltrami_unwrap(context_.get(), &surface, progress, &bar_);
    require(status);
    report_.status = beltrami_status_name(status);
  }

  void fetch_report() {
    beltrami_context* context = context_.get();
    beltrami_atlas atlas{};
    atlas.struct_size = sizeof atlas;
    require(beltrami_get_atlas(context, &atlas));
    if (given_) count_as_given(atlas);
    report_.atlas = atlas;
    if (atlas.searched != 0) {
      report_.target = {
          options_.real(BELTRAMI_OPTION_TARGET_ENERGY), options_.real(BELTRAMI_OPTION_TARGET_P99),
          options_.integer(BELTRAMI_OPTION_MAX_CHARTS), options_.real(BELTRAMI_OPTION_SEAM_BUDGET)};
    }
    if (atlas.pages > 0) report_pages(context, report_);
    const bool stacks = options_.integer(BELTRAMI_OPTION_STACK) != BELTRAMI_STACK_NONE;
    if (stacks && atlas.stacked_parts == 0) {
      report_.notes.emplace_back("--stack found nothing of one shape: nothing is stacked");
    }
    report_.triangles = atlas.triangles;
    report_.area = atlas.area;
    report_.unreferenced_vertices = atlas.unused_vertices;
    report_.welded_vertices = file_.welded_corners + atlas.welded_vertices;
    // What is written reads back to these very doubles, so this is the verdict on the file.
    report_.atlas_certificate = certificate(BELTRAMI_F64);
    report_.float32_injective = certificate(BELTRAMI_F32).injective != 0;
    for (std::uint64_t i = 0; i < atlas.charts; ++i) {
      beltrami_chart chart{};
      chart.struct_size = sizeof chart;
      require(beltrami_get_chart(context, i, &chart));
      const double side = report_.packing ? chart.density * report_.packing->texels_per_unit : 0;
      if (report_.packing && chart.area * side * side < kFewTexels) ++report_.tiny_charts;
      if (chart.status <= BELTRAMI_NOT_CONVERGED) continue;
      if (report_.failed_charts.size() < kMostFailedCharts) {
        report_.failed_charts.push_back({i, chart});
      }
    }
    const std::int32_t stages = beltrami_atlas_stage_count(context);
    for (std::int32_t i = 0; i < stages; ++i) {
      beltrami_stage stage{};
      stage.struct_size = sizeof stage;
      require(beltrami_get_atlas_stage(context, i, &stage));
      report_.stages.push_back({stage.name, stage.seconds, stage.cpu_seconds, stage.iterations});
    }
  }

  /// glTF has a vertex for each normal and UV of one of IN, all at one place: what is said of
  /// vertices is of those of IN.
  void count_as_given(beltrami_atlas& atlas) const {
    const std::uint64_t used = given_->count - given_->unused;
    const std::uint64_t places =
        file_.vertex_count() - atlas.unused_vertices - atlas.welded_vertices;
    atlas.welded_vertices = used - std::min(used, places);
    atlas.unused_vertices = given_->unused;
  }

  beltrami_atlas_certificate certificate(std::int32_t type) const {
    beltrami_atlas_certificate found{};
    found.struct_size = sizeof found;
    require(beltrami_get_atlas_certificate(context_.get(), type, &found));
    return found;
  }

  void fetch_uvs() {
    const std::size_t corners = file_.polygons.corners().size();
    std::vector<double> uvs(2 * corners);
    require(beltrami_get_corner_uvs(context_.get(), uvs.data(), BELTRAMI_F64, 0));
    if (report_.atlas->pages > 0) {
      std::vector<std::uint64_t> pages(corners);
      require(beltrami_get_corner_pages(context_.get(), pages.data(), BELTRAMI_U64, 0));
      for (std::size_t c = 0; c < corners; ++c) {
        const auto [u, v] = corner_of_page(pages[c]);
        uvs[2 * c] += u;
        uvs[2 * c + 1] += v;
      }
      if (options_.integer(BELTRAMI_OPTION_LABEL_PAGES) != 0) note_label_pages(pages);
    }
    set_corner_uvs(file_, uvs, options_.integer(BELTRAMI_OPTION_FLOAT32) != 0);
    triangles_.resize(3 * report_.atlas->triangles);
    require(beltrami_get_triangles(context_.get(), triangles_.data(), BELTRAMI_U32, 0));
    if (!arguments_.html.empty()) fetch_charts();
  }

  void note_label_pages(const std::vector<std::uint64_t>& pages_of_corners) {
    PagesOfLabels pages;
    std::map<std::uint64_t, std::uint64_t> numbers;
    for (const auto& [label, text] : label_texts_) numbers[label] = pages.number(text);
    for (std::size_t c = 0; c < pages_of_corners.size(); ++c) {
      pages.add(numbers[labels_[file_.polygons.of_corner(c)]], pages_of_corners[c]);
    }
    report_.label_pages = pages.taken();
  }

  void fetch_charts() {
    std::vector<std::uint32_t> of_faces(file_.polygons.size());
    require(beltrami_get_face_charts(context_.get(), of_faces.data(), BELTRAMI_U32, 0));
    for (std::size_t i = 0; i < triangles_.size(); i += 3) {
      charts_.push_back(of_faces[file_.polygons.of_corner(triangles_[i])]);
    }
  }

  void triangulate() {
    cut_faces(file_, triangles_);
    for (std::size_t c = 0; c < triangles_.size(); ++c) {
      triangles_[c] = static_cast<std::uint32_t>(c);
    }
  }

  void bake_textures() {
    if (!bake_) return;
    const auto& packing = report_.packing;
    if (packing && packing->pages > 1) {
      throw Failure("--bake: the charts take " + std::to_string(packing->pages) +
                    " pages, and a material has a texture of one: leave out --texels-per-unit, or "
                    "lower it");
    }
    StageClock clock(report_, "bake");
    bake_->place(triangles_);
    bake_->run(
        context_.get(), static_cast<int>(options_.integer(BELTRAMI_OPTION_RESOLUTION)),
        [this](double share) { bar_.show(share, "bake"); }, report_);
    clock.finish();
  }

  /// The last verdict is on the numbers that the file gets.
  void judge_held() {
    const bool share = options_.integer(BELTRAMI_OPTION_SHARE_COPIES) != 0 ||
                       options_.integer(BELTRAMI_OPTION_STACK) != BELTRAMI_STACK_NONE;
    const auto found = judge_held_uvs(file_, arguments_.output, share, false);
    if (!found) return;
    note_held(*found, report_);
    report_.atlas_certificate = found;
    report_.float32_injective = found->injective != 0;
    if (found->injective == 0) report_.status = beltrami_status_name(BELTRAMI_NOT_INJECTIVE);
  }

  /// All files are complete on the disk before the first of them replaces anything. Returns the
  /// exit code.
  int write_files() {
    bar_.show(1, "write");
    StageClock clock(report_, "write");
    std::deque<AtomicFile> outputs;
    GltfTextures textures;
    if (bake_) {
      bake_->write_obj_parts(file_, outputs);
      textures = bake_->take_textures();
    }
    textures.advice = "--bake makes them anew";
    if (!bake_ && !file_.gltf) {
      const std::string misfit = textures_that_misfit(file_);
      if (!misfit.empty()) {
        report_.notes.push_back(misfit + ", which are replaced: " + textures.advice);
      }
    }
    write_outputs(file_, arguments_.output, arguments_.uv_set, outputs, report_, textures);
    if (!arguments_.written_seams.empty()) write_seams(outputs);
    if (!arguments_.masks.empty()) write_masks(context_.get(), arguments_.masks, outputs);
    clock.finish();

    HtmlMesh shown;
    if (!arguments_.picture.empty() || !arguments_.html.empty()) shown = write_pictures(outputs);
    report_.seconds = seconds_so_far();
    if (!arguments_.html.empty()) {
      AtomicFile& page = outputs.emplace_back(arguments_.html);
      write_html(shown, to_json(report_), [&](std::string_view part) { page.write(part); });
      page.close();
    }
    if (!arguments_.report.empty()) {
      outputs.emplace_back(arguments_.report).write(to_json(report_));
      outputs.back().close();
    }
    std::string note, summary;
    if (!arguments_.quiet) {
      note = to_note(report_, arguments_.output);
      summary = to_summary(report_, arguments_.output);
    }
    if (arguments_.print_report) summary = to_json(report_);
    bar_.clear();
    throw_if_interrupted();
    // From here on nothing needs memory: with something replaced, it must not run out.
    commit(outputs);
    remark(note);
    return print(summary, "the summary", report_.injective() ? kExitInjective : kExitNotInjective);
  }

  /// As read_seams reads them.
  void write_seams(std::deque<AtomicFile>& outputs) {
    std::vector<std::uint64_t> ends(2 * report_.atlas->seams);
    require(beltrami_get_seams(context_.get(), ends.data(), BELTRAMI_U64, 0));
    std::string text;
    for (std::size_t i = 0; i < ends.size(); i += 2) {
      text += std::to_string(ends[i]) + " " + std::to_string(ends[i + 1]) + "\n";
    }
    AtomicFile& output = outputs.emplace_back(arguments_.written_seams);
    output.write(text);
    output.close();
  }

  /// The picture, and what the page for browsers shows.
  HtmlMesh write_pictures(std::deque<AtomicFile>& outputs) {
    MeshFile scaled = file_;
    if (report_.packing) {  // energies are those of the surface's own scale
      const beltrami_packing& packing = *report_.packing;
      const double unit = static_cast<double>(packing.resolution) / packing.texels_per_unit;
      for (double& x : scaled.corner_uvs.values) x *= unit;
    }
    const SplitMesh split(scaled, triangles_);
    const std::vector<double> energies = face_energies(split.view());
    if (!arguments_.picture.empty()) {
      bar_.show(1, "picture");
      StageClock clock(report_, "picture");
      AtomicFile& file = outputs.emplace_back(arguments_.picture);
      file.write(encode_png(render_picture(split.view(), energies)));
      file.close();
      clock.finish();
    }
    if (arguments_.html.empty()) return {};
    bar_.show(1, "html");
    StageClock clock(report_, "html");
    const SplitMesh on_pages(file_, triangles_);
    HtmlMesh shown = html_mesh(on_pages.view(), energies, charts_);
    clock.finish();
    return shown;
  }

  void require(beltrami_status status) const {
    const std::int32_t kind = beltrami_error_element_kind(context_.get());
    const bool of_pins = kind == BELTRAMI_ELEMENT_CORNER;
    const bool is_straight = status == BELTRAMI_E_PINS && !of_pins;
    std::string message = with_lines(beltrami_error_message(context_.get()), "pin", pins_.lines);
    message = with_lines(message, "straight edge", straight_.edge_lines);
    message = with_lines(message, "rectangle", straight_.rectangle_lines);
    const std::string& about = of_pins       ? arguments_.pins
                               : is_straight ? arguments_.straighten
                                             : arguments_.input;
    require_ok(status, about, message.c_str(), kind, beltrami_error_element(context_.get()));
  }

  const UnwrapArguments& arguments_;
  Options& options_;
  Report& report_;
  ProgressBar bar_;
  Context context_;
  struct Vertices {
    std::uint64_t count, unused;
  };
  std::optional<Vertices> given_;  ///< of IN, where glTF has others
  MeshFile file_;
  std::vector<std::uint64_t> labels_, materials_;
  std::map<std::uint64_t, std::string> label_texts_;  ///< where labels have pages of their own
  Paint paint_;
  std::vector<std::uint32_t> seams_;
  Pins pins_;
  Straight straight_;
  std::optional<TextureBake> bake_;
  std::vector<std::uint32_t> triangles_;  ///< corners of the file's faces
  std::vector<std::uint32_t> charts_;     ///< of the triangles, where the page wants them
};

}  // namespace

int unwrap_command(const UnwrapArguments& arguments, Options& options) {
  Report report;
  report.command = "unwrap";
  report.printed = arguments.print_report;
  report.input_path = arguments.input;
  note_options(arguments, options, report);
  return run_guarded(
      report, arguments.report,
      {arguments.input, arguments.output, arguments.seams, arguments.pins, arguments.paint,
       arguments.straighten, arguments.written_seams, arguments.picture, arguments.html},
      [&] { return Unwrapping(arguments, options, report).run(); });
}

}  // namespace beltrami::cli
