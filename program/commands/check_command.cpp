// beltrami check: judge the UVs that a file carries.
#include <algorithm>
#include <cmath>
#include <deque>
#include <new>
#include <optional>
#include <span>

#include "commands/command.h"
#include "commands/page_layout.h"
#include "commands/progress_bar.h"
#include "commands/report.h"
#include "files/atomic_file.h"
#include "files/gltf_file.h"
#include "files/mesh_file.h"
#include "files/split_mesh.h"
#include "files/surface.h"
#include "files/surface_view.h"
#include "files/triangulate.h"
#include "files/vector3.h"
#include "picture/picture.h"
#include "process/failure.h"
#include "process/interrupt.h"

namespace beltrami::cli {
namespace {

/// Over the whole range of numbers, and not std::hypot, whose last bit depends on the processor.
double safe_norm(const Vector3& a) {
  const double largest = std::max({std::abs(a[0]), std::abs(a[1]), std::abs(a[2])});
  if (!(largest > 0) || !std::isfinite(largest)) return largest;
  return largest * norm({a[0] / largest, a[1] / largest, a[2] / largest});
}

double area_of(const TriangleView& mesh) {
  double area = 0;
  for (std::size_t i = 0; i < mesh.faces.size(); i += 3) {
    const double* a = &mesh.positions[3 * std::size_t{mesh.faces[i]}];
    const double* b = &mesh.positions[3 * std::size_t{mesh.faces[i + 1]}];
    const double* c = &mesh.positions[3 * std::size_t{mesh.faces[i + 2]}];
    Vector3 p, q;
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = b[k] - a[k];
      q[k] = c[k] - a[k];
    }
    area += 0.5 * safe_norm(cross(p, q));
  }
  return area;
}

/// Of a disk, by Euler's formula.
std::uint64_t boundary_edges_of(const TriangleView& disk) {
  std::vector<bool> used(disk.vertex_count(), false);
  std::uint64_t vertices = 0;
  for (const std::uint32_t vertex : disk.faces) {
    vertices += !used[vertex];
    used[vertex] = true;
  }
  return 2 * vertices - 2 - disk.face_count();
}

void round_to_float32(std::vector<double>& uvs) {
  for (double& value : uvs) value = static_cast<double>(static_cast<float>(value));
}

/// Texels: what doubles take of a distance that was made as wide as it is asked for.
constexpr double kRounding = 1e-6;

/// Times it the UVs have the area of the surface; 1 where one of them has none.
double scale_of_equal_areas(const TriangleView& triangles) {
  double area = 0, uv_area = 0;
  for (std::size_t f = 0; f < triangles.face_count(); ++f) {
    const auto side = [&](std::size_t k, std::span<const double> points, std::size_t width) {
      const std::size_t from = width * triangles.faces[3 * f],
                        to = width * triangles.faces[3 * f + k];
      Vector3 along{};
      for (std::size_t axis = 0; axis < width; ++axis) {
        along[axis] = points[to + axis] - points[from + axis];
      }
      return along;
    };
    area += norm(cross(side(1, triangles.positions, 3), side(2, triangles.positions, 3)));
    uv_area += norm(cross(side(1, triangles.uvs, 2), side(2, triangles.uvs, 2)));
  }
  const double scale = std::sqrt(area / uv_area);
  return std::isfinite(scale) && scale > 0 ? scale : 1;
}

class Check {
 public:
  Check(const CheckArguments& arguments, Report& report)
      : arguments_(arguments), report_(report), bar_(!arguments.quiet) {}

  int run() {
    require_files();
    read();
    judge();
    measure();
    measure_pages();
    return write_files();
  }

 private:
  void require_files() const {
    if (format_of(arguments_.input) != MeshFormat::kGltf && arguments_.uv_set > 0) {
      throw Failure(uv_set_flag() + ": " + arguments_.input +
                    " has one set of UVs, as all formats but glTF have: leave the option out");
    }
    require_png_name(arguments_.picture);
    require_distinct({arguments_.input, arguments_.report, arguments_.picture});
    if (!arguments_.quiet || arguments_.print_report)
      require_apart_from_stdout({arguments_.report, arguments_.picture});
    for (const std::string& path : {arguments_.report, arguments_.picture}) {
      if (!path.empty()) require_writable(path);
    }
  }

  void read() {
    bar_.show(0, "read");
    StageClock clock(report_, "read");
    const Content content = arguments_.uv_set > 0       ? Content::kSurface
                            : arguments_.labels.empty() ? Content::kUvs
                                                        : Content::kAll;
    file_ = read_mesh(arguments_.input, content, arguments_.reach);
    require_whole(file_);
    if (arguments_.uv_set > 0) take_uv_set();
    if (arguments_.float32) {
      round_to_float32(file_.uvs);
      round_to_float32(file_.corner_uvs.values);
    }
    if (file_.corner_uvs.of_corner.empty()) {
      surface_.emplace(file_, arguments_.weld);
      report_.set_input(file_, *surface_);
    } else {
      split();
    }
    report_.unreferenced_vertices = unreferenced_vertices(file_);
    report_.area = area_of(triangles());
    clock.finish();
  }

  std::string uv_set_flag() const { return "--uv-set " + std::to_string(arguments_.uv_set); }

  /// The UVs of another set than the first, which every face has to have.
  void take_uv_set() {
    file_.uvs = gltf_uvs(file_, arguments_.uv_set);
    const std::vector<std::uint32_t>& corners = file_.polygons.corners();
    for (std::uint64_t c = 0; c < corners.size(); ++c) {
      if (!file_.uvs.empty() && !std::isnan(file_.uvs[2 * std::size_t{corners[c]}])) continue;
      throw Failure(uv_set_flag() + ": " + arguments_.input + ": face " +
                    std::to_string(file_.polygons.of_corner(c)) +
                    " (counted from 0) has no texture coordinates, TEXCOORD_" +
                    std::to_string(arguments_.uv_set));
    }
  }

  /// What is no disk, or has several UVs at a vertex, is an atlas.
  void split() {
    surface_.reset();
    corners_ = triangle_corners(file_);
    split_.emplace(file_, corners_);
    report_.vertices = file_.vertex_count();
    report_.faces = file_.polygons.size();
    report_.triangles = corners_.size() / 3;
    report_.welded_vertices = file_.welded_corners;
    report_.short_faces = file_.short_faces;
  }

  TriangleView triangles() const { return surface_ ? surface_->view() : split_->view(); }
  std::uint64_t face_of(std::uint64_t triangle) const {
    if (triangle == BELTRAMI_NO_ELEMENT) return triangle;
    return surface_ ? surface_->face_of(triangle)
                    : file_.polygons.of_corner(corners_[3 * triangle]);
  }

  void judge() {
    throw_if_interrupted();
    bar_.show(0.2, "check");
    StageClock clock(report_, "check");
    if (!surface_ || !judge_disk()) judge_atlas();
    clock.finish();
  }

  void judge_atlas() {
    if (surface_) split();
    const SurfaceView view(file_);
    beltrami_surface surface = view.surface();
    beltrami_atlas_certificate found{};
    found.struct_size = sizeof found;
    const beltrami_status status =
        beltrami_check_atlas(&surface, arguments_.mirrored, &found, nullptr, 0);
    require_ok(status, arguments_.input, "", found.error_element_kind, found.error_element);
    report_.atlas_certificate = found;
    report_.status = beltrami_status_name(status);
    if (status != BELTRAMI_OK && !arguments_.mirrored) {
      beltrami_atlas_certificate mirrored{};
      mirrored.struct_size = sizeof mirrored;
      const bool passes = beltrami_check_atlas(&surface, 1, &mirrored, nullptr, 0) == BELTRAMI_OK;
      if (passes && mirrored.mirrored_charts > 0) report_.advice = kMirroredAdvice;
    }
    const std::vector<double> uvs(
        static_cast<const double*>(surface.corner_uvs.data),
        static_cast<const double*>(surface.corner_uvs.data) + 2 * surface.corner_count);
    const std::vector<float> rounded(uvs.begin(), uvs.end());
    surface.corner_uvs = {rounded.data(), 0, BELTRAMI_F32, 0};
    const beltrami_status single =
        beltrami_check_atlas(&surface, arguments_.mirrored, &found, nullptr, 0);
    if (single == BELTRAMI_E_OUT_OF_MEMORY) throw std::bad_alloc();
    report_.float32_injective = single == BELTRAMI_OK;
  }

  /// Whether faces have no area in space: any UVs of theirs are right, and a verdict on an atlas
  /// leaves them out.
  bool excepts_faces() const {
    const SurfaceView view(file_);
    const beltrami_surface surface = view.surface();
    beltrami_atlas_certificate found{};
    found.struct_size = sizeof found;
    return beltrami_check_atlas(&surface, arguments_.mirrored, &found, nullptr, 0) >= BELTRAMI_OK &&
           found.excepted > 0;
  }

  /// False where the mesh is no disk, or is better judged as an atlas.
  bool judge_disk() {
    const TriangleView triangles = surface_->view();
    const beltrami_mesh mesh = view_of(triangles);
    const beltrami_buffer uvs = uv_view(triangles);
    beltrami_certificate certificate{};
    certificate.struct_size = sizeof certificate;
    const beltrami_status status = beltrami_check_injective(&mesh, &uvs, &certificate);
    if (says_no_disk(status)) return false;
    if (status == BELTRAMI_NOT_INJECTIVE && excepts_faces()) return false;
    require_ok_mesh(status, arguments_.input, "", certificate.error_element_kind,
                    certificate.error_element, file_, *surface_);
    to_face_of(*surface_, certificate.first_bad_face);
    report_.certificate = certificate;
    report_.status = beltrami_status_name(status);
    report_.boundary_edges = boundary_edges_of(triangles);
    report_.float32_injective =
        arguments_.float32 ? certificate.injective != 0 : injective_in_float32(triangles);
    return true;
  }

  /// Of the UVs, all times `scale`.
  beltrami_energy measured(const TriangleView& triangles, double scale) {
    std::vector<double> scaled(triangles.uvs.begin(), triangles.uvs.end());
    for (double& coordinate : scaled) coordinate *= scale;
    const TriangleView view{triangles.positions, triangles.faces, scaled};
    const beltrami_mesh mesh = view_of(view);
    const beltrami_buffer uvs = uv_view(view);
    beltrami_energy energy{};
    energy.struct_size = sizeof energy;
    const beltrami_status status = beltrami_measure(
        &mesh, &uvs, &energy, face_energies_.empty() ? nullptr : face_energies_.data());
    require_ok(status, arguments_.input, "", BELTRAMI_ELEMENT_NONE, BELTRAMI_NO_ELEMENT);
    return energy;
  }

  /// The one scale of all UVs at which their mean energy is least. It is P scale² + Q / scale², and
  /// two scales about equal areas tell P and Q.
  double best_scale(const TriangleView& triangles) {
    constexpr double kOther = 2;  // times the square of the one
    const double equal = scale_of_equal_areas(triangles);
    const double one = measured(triangles, equal).symmetric_dirichlet;
    const double other = measured(triangles, equal * std::sqrt(kOther)).symmetric_dirichlet;
    const double p = (other - one / kOther) / (kOther - 1 / kOther), q = one - p;
    const double best = equal * std::pow(q / p, 0.25);
    return std::isfinite(best) && best > 0 ? best : equal;
  }

  void measure() {
    throw_if_interrupted();
    bar_.show(0.6, "measure");
    StageClock clock(report_, "measure");
    const TriangleView triangles = this->triangles();
    if (!arguments_.picture.empty()) face_energies_.resize(triangles.face_count());
    beltrami_energy energy = measured(triangles, best_scale(triangles));
    energy.worst_face = face_of(energy.worst_face);
    report_.energy = energy;
    clock.finish();
  }

  void measure_pages() {
    throw_if_interrupted();
    bar_.show(0.7, "pages");
    StageClock clock(report_, "pages");
    report_.layout =
        page_layout(file_, triangle_corners(file_), arguments_.resolution, arguments_.labels);
    const PageLayout& found = *report_.layout;
    if (arguments_.within_page && found.outside > 0) {
      report_.unmet.push_back("--within-page: " + std::to_string(found.outside) +
                              " charts leave [0,1]^2");
    }
    if (arguments_.within_tiles && found.astride > 0) {
      report_.unmet.push_back("--within-tiles: " + std::to_string(found.astride) +
                              " charts leave the tiles of UDIM");
    }
    if (found.margin < arguments_.margin - kRounding) {
      report_.unmet.push_back(
          "--margin: charts, or a chart and the edge of its page, are too close");
    }
    clock.finish();
  }

  int exit_code() const {
    return report_.injective() && report_.unmet.empty() ? kExitInjective : kExitNotInjective;
  }

  /// Returns the exit code.
  int write_files() {
    throw_if_interrupted();
    std::deque<AtomicFile> outputs;
    if (!arguments_.picture.empty()) {
      bar_.show(0.8, "picture");
      StageClock clock(report_, "picture");
      outputs.emplace_back(arguments_.picture)
          .write(encode_png(render_picture(triangles(), face_energies_)));
      outputs.back().close();
      clock.finish();
    }
    report_.seconds = seconds_so_far();
    if (!arguments_.report.empty()) {
      outputs.emplace_back(arguments_.report).write(to_json(report_));
      outputs.back().close();
    }
    std::string summary = arguments_.quiet ? std::string() : to_summary(report_, "");
    if (arguments_.print_report) summary = to_json(report_);
    bar_.clear();
    throw_if_interrupted();
    // From here on nothing needs memory: with something replaced, it must not run out.
    commit(outputs);
    return print(summary, "the summary", exit_code());
  }

  const CheckArguments& arguments_;
  Report& report_;
  ProgressBar bar_;
  MeshFile file_;
  std::optional<Surface> surface_;      ///< of file_, where it is a disk
  std::optional<SplitMesh> split_;      ///< else
  std::vector<std::uint32_t> corners_;  ///< of its triangles
  std::vector<double> face_energies_;
};

}  // namespace

int check_command(const CheckArguments& arguments) {
  Report report;
  report.command = "check";
  report.printed = arguments.print_report;
  report.input_path = arguments.input;
  report.options = {{"float32", arguments.float32},
                    {"mirrored", arguments.mirrored},
                    {"weld", arguments.weld},
                    {"uv-set", std::to_string(arguments.uv_set)},
                    {"resolution", static_cast<std::int64_t>(arguments.resolution)},
                    {"margin", arguments.margin},
                    {"within-page", arguments.within_page},
                    {"within-tiles", arguments.within_tiles}};
  return run_guarded(report, arguments.report, {arguments.input, arguments.picture},
                     [&] { return Check(arguments, report).run(); });
}

}  // namespace beltrami::cli
