// beltrami flatten: read, flatten, write, report.
#include <deque>
#include <memory>
#include <optional>

#include "commands/command.h"
#include "commands/options.h"
#include "commands/progress_bar.h"
#include "commands/report.h"
#include "files/atomic_file.h"
#include "files/mesh_file.h"
#include "files/surface.h"
#include "picture/picture.h"
#include "process/failure.h"
#include "process/interrupt.h"

namespace beltrami::cli {
namespace {

/// What takes a mesh that is no disk.
const char* advice_to_unwrap(beltrami_status status) {
  return says_no_disk(status) ? " (or give it to beltrami unwrap, which takes any mesh)" : "";
}

void note_options(const FlattenArguments& arguments, const Options& options, Report& report) {
  report.options = options.values();
  report.options.emplace_back("weld", arguments.weld);
  report.threads = options.integer(BELTRAMI_OPTION_THREADS);
}

class Flattening {
 public:
  Flattening(const FlattenArguments& arguments, Options& options, Report& report)
      : arguments_(arguments),
        options_(options),
        report_(report),
        bar_(!arguments.quiet),
        context_(make_context()) {}

  int run() {
    require_files();
    options_.apply_to(context_.get());
    read();
    const CancelOnInterrupt guard(context_.get());
    flatten();
    fetch_results();
    return write_files();
  }

 private:
  /// Everything about files that can be told before the work.
  void require_files() const {
    format_of(arguments_.input);
    require_writable_format(arguments_.output);
    require_png_name(arguments_.picture);
    require_distinct({arguments_.input, arguments_.report, arguments_.picture});
    require_distinct({arguments_.output, arguments_.report, arguments_.picture});
    const std::vector<std::string> written = {arguments_.output, arguments_.report,
                                              arguments_.picture};
    if (!arguments_.quiet || arguments_.print_report) require_apart_from_stdout(written);
    for (const std::string& path : written) {
      if (!path.empty()) require_writable(path);
    }
  }

  void read() {
    bar_.show(0, "read");
    StageClock clock(report_, "read");
    file_ = read_mesh(arguments_.input, Content::kSurface, arguments_.reach);
    require_whole(file_);
    surface_.emplace(file_, arguments_.weld);
    report_.set_input(file_, *surface_);
    const beltrami_mesh mesh = view_of(surface_->view());
    const beltrami_status status = beltrami_set_mesh(context_.get(), &mesh);
    const std::string message =
        beltrami_error_message(context_.get()) + std::string(advice_to_unwrap(status));
    require_ok_mesh(status, arguments_.input, message.c_str(),
                    beltrami_error_element_kind(context_.get()),
                    beltrami_error_element(context_.get()), file_, *surface_);
    clock.finish();
  }

  /// All cores are the program's own choice, which must not be what fails at a memory limit.
  void fit_threads() {
    const auto limit = static_cast<std::uint64_t>(options_.integer(BELTRAMI_OPTION_MEMORY_LIMIT));
    for (;;) {
      std::uint64_t estimate = 0;
      require(beltrami_estimate_memory(context_.get(), &estimate));
      report_.estimated_memory_bytes = estimate;
      if (limit == 0 || estimate <= limit || !options_.use_fewer_threads()) return;
      const std::int64_t threads = options_.integer(BELTRAMI_OPTION_THREADS);
      require(beltrami_set_int(context_.get(), BELTRAMI_OPTION_THREADS, threads));
      note_options(arguments_, options_, report_);
    }
  }

  void flatten() {
    // A signal from before the guard has cancelled nothing yet.
    throw_if_interrupted();
    fit_threads();
    const auto progress = [](void* bar, double fraction, const char* stage) -> std::int32_t {
      static_cast<ProgressBar*>(bar)->show(fraction, stage);
      return interrupted();
    };
    const beltrami_status status = beltrami_run(context_.get(), progress, &bar_);
    require(status);
    report_.status = beltrami_status_name(status);
  }

  void fetch_results() {
    beltrami_context* context = context_.get();
    beltrami_result result{};
    result.struct_size = sizeof result;
    require(beltrami_get_result(context, &result));
    report_.boundary_edges = result.boundary_edges;
    report_.unreferenced_vertices = unreferenced_vertices(file_);
    report_.area = result.area;
    report_.coarse_faces = result.coarse_faces;
    report_.flips_before_repair = result.flips_before_repair;
    to_face_of(*surface_, result.first_degenerate_face);
    report_.result = result;
    if (result.delaunay_flips > 0) take_flipped_triangles();

    file_.single_uvs = options_.integer(BELTRAMI_OPTION_FLOAT32) != 0;
    file_.uvs.resize(2 * file_.vertex_count());
    require(beltrami_get_uvs(context, file_.uvs.data(), BELTRAMI_F64, 0));
    surface_->spread_uvs(file_.uvs);
    report_.not_kept = not_kept(file_, arguments_.output);
    fetch_verdicts();
  }

  /// The triangles of the intrinsic triangulation take the place of the file's faces, and with them
  /// goes what belonged to those.
  void take_flipped_triangles() {
    std::vector<std::uint32_t> corners(surface_->view().faces.size());
    require(beltrami_get_faces(context_.get(), corners.data(), BELTRAMI_U32, 0));
    replace_faces(file_, std::move(corners));
    surface_->follow_file();
  }

  void fetch_verdicts() {
    beltrami_context* context = context_.get();
    // What is written reads back to these very doubles, so this is the verdict on the file.
    beltrami_certificate certificate{};
    certificate.struct_size = sizeof certificate;
    require(beltrami_get_certificate(context, &certificate));
    to_face_of(*surface_, certificate.first_bad_face);
    report_.certificate = certificate;
    beltrami_certificate single{};
    single.struct_size = sizeof single;
    require(beltrami_get_float32_certificate(context, &single));
    report_.float32_possible = single.injective != 0;
    beltrami_energy energy{};
    energy.struct_size = sizeof energy;
    require(beltrami_get_energy(context, &energy));
    to_face_of(*surface_, energy.worst_face);
    report_.energy = energy;

    const std::int32_t stages = beltrami_stage_count(context);
    for (std::int32_t i = 0; i < stages; ++i) {
      beltrami_stage stage{};
      stage.struct_size = sizeof stage;
      require(beltrami_get_stage(context, i, &stage));
      report_.stages.push_back({stage.name, stage.seconds, stage.cpu_seconds, stage.iterations});
    }
    StageClock clock(report_, "float32");
    report_.float32_injective = injective_in_float32(surface_->view());
    clock.finish();
  }

  /// All files are complete on the disk before the first of them replaces anything. Returns the
  /// exit code.
  int write_files() {
    bar_.show(1, "write");
    StageClock clock(report_, "write");
    std::deque<AtomicFile> outputs;
    AtomicFile& output = outputs.emplace_back(arguments_.output);
    write_mesh(file_, arguments_.output, [&](std::string_view bytes) {
      throw_if_interrupted();
      output.write(bytes);
    });
    output.close();
    clock.finish();

    if (!arguments_.picture.empty()) write_picture(outputs.emplace_back(arguments_.picture));
    report_.seconds = seconds_so_far();
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
    return print(summary, "the summary",
                 report_.certificate->injective ? kExitInjective : kExitNotInjective);
  }

  void write_picture(AtomicFile& file) {
    bar_.show(1, "picture");
    StageClock clock(report_, "picture");
    const TriangleView triangles = surface_->view();
    std::vector<double> energies(triangles.face_count());
    require(beltrami_get_face_energies(context_.get(), energies.data(), 0));
    file.write(encode_png(render_picture(triangles, energies)));
    file.close();
    clock.finish();
  }

  void require(beltrami_status status) const {
    require_ok(status, arguments_.input, beltrami_error_message(context_.get()),
               beltrami_error_element_kind(context_.get()), beltrami_error_element(context_.get()));
  }

  const FlattenArguments& arguments_;
  Options& options_;
  Report& report_;
  ProgressBar bar_;
  Context context_;
  MeshFile file_;
  std::optional<Surface> surface_;  ///< of file_
};

}  // namespace

int flatten_command(const FlattenArguments& arguments, Options& options) {
  Report report;
  report.command = "flatten";
  report.printed = arguments.print_report;
  report.input_path = arguments.input;
  note_options(arguments, options, report);
  return run_guarded(report, arguments.report,
                     {arguments.input, arguments.output, arguments.picture},
                     [&] { return Flattening(arguments, options, report).run(); });
}

}  // namespace beltrami::cli
