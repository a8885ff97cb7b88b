#include "abi/context.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>

#include "abi/bake_job.h"
#include "abi/buffers.h"
#include "abi/core_options.h"
#include "abi/joined.h"
#include "abi/reports.h"
#include "abi/surface.h"
#include "abi/unwrapped.h"
#include "bake/bake.h"
#include "base/error.h"
#include "base/floating_point.h"
#include "base/host_memory.h"
#include "base/interrupt.h"
#include "base/pool.h"
#include "base/resources.h"
#include "base/work.h"
#include "chart/flatten_disk.h"
#include "chart/memory_estimate.h"
#include "mesh/rest_shape.h"

static_assert(std::atomic<bool>::is_always_lock_free,
              "beltrami_cancel may be called from a signal handler");

namespace beltrami {
namespace {

/// Passes progress on to the host: in [0, 1], never decreasing, in a floating-point mode that the
/// host may change at will. Returns true to cancel.
class HostProgress {
 public:
  HostProgress(beltrami_progress callback, void* user) : callback_(callback), user_(user) {}

  bool operator()(double fraction, const char* stage) {
    // Not std::clamp: NaN must not pass.
    if (fraction > reached_) reached_ = std::min(fraction, 1.0);
    const StandardFloatingPoint mode_of_the_run;
    const InterruptScope not_in_the_run(nullptr);  // for checks that the host makes meanwhile
    const HostMemoryScope not_of_the_run(nullptr);
    if (callback_(user_, reached_, stage) != 0) cancelled_ = true;
    return cancelled_;
  }

  bool cancelled() const { return cancelled_; }
  /// As the work takes it, on this object.
  Progress watched() {
    if (callback_ == nullptr) return {};
    return [this](double fraction, const char* stage) { return (*this)(fraction, stage); };
  }

 private:
  beltrami_progress callback_;
  void* user_;
  double reached_ = 0;
  bool cancelled_ = false;
};

/// Marks a run for as long as it lasts, and uses up a request to cancel it, whichever way it ends.
class RunMark {
 public:
  explicit RunMark(beltrami_context& context) : context_(context) { context_.running = true; }
  ~RunMark() {
    if (!used_) context_.cancelled.store(false);
    context_.running = false;
  }
  RunMark(const RunMark&) = delete;
  RunMark& operator=(const RunMark&) = delete;

  /// Whether a request came in time. Later ones are for the next run.
  bool take_request() {
    used_ = true;
    return context_.cancelled.exchange(false);
  }

 private:
  beltrami_context& context_;
  bool used_ = false;
};

/// Throws Error OUT_OF_MEMORY. A limit of 0 allows everything.
void require_within_limit(std::uint64_t estimate, std::int64_t limit) {
  constexpr std::uint64_t kMebibyte = 1 << 20;
  const auto allowed = static_cast<std::uint64_t>(limit);
  if (limit == 0 || estimate <= allowed) return;
  throw Error(Fault::kOutOfMemory,
              "the run is estimated to need " +
                  std::to_string((estimate + kMebibyte - 1) / kMebibyte) +
                  " MiB of memory, and the option memory-limit allows " +
                  std::to_string(allowed / kMebibyte) +
                  " MiB: raise it, flatten a mesh with fewer faces, or do without cm, refine and "
                  "many threads (fewer coarse-faces hardly help)");
}

}  // namespace

LoadedMesh load_mesh(const beltrami_mesh* theirs, const Work& work,
                     const std::atomic<bool>& cancelled) {
  const beltrami_mesh mesh = read_mesh_header(theirs);
  const InterruptScope interruptible({&cancelled, mesh.cancel, {}});
  LoadedMesh loaded;
  loaded.vertex_count = mesh.vertex_count;
  loaded.input = read_disk(mesh, work);
  DiskMesh& disk = loaded.input.disk;
  loaded.frame = normalise(disk.positions, disk.faces, work);
  loaded.area = std::ldexp(surface_area(disk, work), -2 * loaded.frame.exponent);
  for (const Index f : degenerate_faces(disk.positions, disk.faces, work)) {
    ++loaded.degenerate_faces;
    const Index original = loaded.input.original_face[f];
    Index& first = loaded.first_degenerate_face;
    if (first == kNone || original < first) first = original;
  }
  return loaded;
}

}  // namespace beltrami

beltrami::Work beltrami_context::work(beltrami::Progress watched) const {
  return work(beltrami::limits(options), std::move(watched));
}

beltrami::Work beltrami_context::work(const beltrami::Limits& bounds,
                                      beltrami::Progress watched) const {
  const beltrami::Work made(bounds, std::move(watched));
  if (parallel_for == nullptr) return made;
  made.pool().lend([function = parallel_for, user = parallel_user](
                       int count, const std::function<void(int)>& job) {
    const beltrami_job call = [](void* data, std::int32_t index) {
      (*static_cast<const std::function<void(int)>*>(data))(index);
    };
    function(user, count, call, const_cast<std::function<void(int)>*>(&job));
  });
  return made;
}

std::uint64_t beltrami_context::estimate_memory() const {
  if (!mesh) {
    throw beltrami::Error(beltrami::Fault::kInvalidState,
                          "there is no mesh yet: call beltrami_set_mesh");
  }
  return beltrami::estimate_memory(mesh->input.disk, beltrami::chart_options(options),
                                   options.threads);
}

beltrami_status beltrami_context::run(beltrami_progress progress, void* user) {
  const std::uint64_t estimate = estimate_memory();
  beltrami::require_effect(options);
  beltrami::require_within_limit(estimate, options.memory_limit);
  beltrami::RunMark mark(*this);
  const beltrami::InterruptScope interruptible(&cancelled);
  beltrami::HostProgress host(progress, user);
  const beltrami::Work work = this->work(host.watched());
  beltrami::Flattening result =
      beltrami::flatten(mesh->input.disk, mesh->frame, beltrami::chart_options(options), work);
  // A request that came after the last look at it still counts, since the run was under way.
  if (mark.take_request() || host.cancelled()) {
    throw beltrami::Cancelled();
  }
  flattening = std::move(result);
  return beltrami::status_of(flattening->status);
}

beltrami_status beltrami_context::unwrap(const beltrami_surface* const* surfaces,
                                         std::uint64_t surface_count, beltrami_progress progress,
                                         void* user) {
  const std::vector<beltrami_surface> headers =
      beltrami::read_surface_headers(surfaces, surface_count);
  beltrami::AtlasGivens given;
  for (const beltrami_surface& header : headers) {
    given.pins = given.pins || header.pin_count > 0;
    given.labels = given.labels || header.face_labels.data != nullptr;
  }
  beltrami::require_effect_on_atlas(options, given);
  beltrami::RunMark mark(*this);
  const beltrami::InterruptScope interruptible({&cancelled, headers.front().cancel, {}});
  beltrami::HostProgress host(progress, user);
  const beltrami::Work work = this->work(host.watched());
  beltrami::Unwrapped result =
      beltrami::unwrap_surfaces(headers, beltrami::atlas_options(options),
                                options.cut == BELTRAMI_CUT_ISLANDS, options.hard_angle, work);
  if (mark.take_request() || host.cancelled()) {
    throw beltrami::Cancelled();
  }
  unwrapped = std::move(result);
  if (unwrapped->atlas.pages) {
    last_packer = Packer::kUnwrap;
  } else if (last_packer == Packer::kUnwrap) {
    last_packer = packed ? Packer::kPack : Packer::kNone;
  }
  return beltrami::status_of(unwrapped->atlas.outcome);
}

beltrami_status beltrami_context::pack(const beltrami_uv_mesh* const* meshes,
                                       std::uint64_t mesh_count, beltrami_progress progress,
                                       void* user) {
  const std::vector<beltrami_uv_mesh> headers = beltrami::read_uv_headers(meshes, mesh_count);
  beltrami::RunMark mark(*this);
  const beltrami::InterruptScope interruptible({&cancelled, headers.front().cancel, {}});
  beltrami::HostProgress host(progress, user);
  const beltrami::Work work = this->work(host.watched());
  beltrami::PackedMeshes result =
      beltrami::pack_meshes(headers, beltrami::pack_options(options), options.float32, work);
  if (mark.take_request() || host.cancelled()) {
    throw beltrami::Cancelled();
  }
  packed = std::move(result);
  last_packer = Packer::kPack;
  return beltrami::status_of(packed->result.outcome);
}

beltrami_status beltrami_context::bake(const beltrami_bake_job* job, beltrami_baked* out,
                                       beltrami_progress progress, void* user) {
  const double wall = beltrami::wall_seconds(), cpu = beltrami::cpu_seconds();
  const beltrami_bake_job header = beltrami::read_bake_header(job);
  const beltrami::BakeRoom room = beltrami::room_of(header, out);
  beltrami::RunMark mark(*this);
  const beltrami::InterruptScope interruptible({&cancelled, header.cancel, {}});
  beltrami::HostProgress host(progress, user);
  const beltrami::Work work = this->work(host.watched()).named("bake");
  const beltrami::BakeProblem problem = beltrami::read_bake_problem(header, work);
  const beltrami::BakeReport report = beltrami::bake(problem, room.pages, room.masks, work);
  if (mark.take_request() || host.cancelled()) {
    throw beltrami::Cancelled();
  }
  beltrami::write_baked(report, beltrami::wall_seconds() - wall, beltrami::cpu_seconds() - cpu,
                        out);
  beltrami::require_sources(report);
  return BELTRAMI_OK;
}

beltrami_status beltrami_context::begin_session(const beltrami_surface* surface,
                                                beltrami_progress progress, void* user) {
  const beltrami_surface header = beltrami::read_surface_header(surface);
  beltrami::RunMark mark(*this);
  const beltrami::InterruptScope interruptible({&cancelled, header.cancel, {}});
  beltrami::HostProgress host(progress, user);
  const beltrami::Work work = this->work(host.watched());
  auto begun = std::make_unique<beltrami::EditSession>(header, options, work.named("read"));
  if (mark.take_request() || host.cancelled()) {
    throw beltrami::Cancelled();
  }
  session = std::move(begun);
  return BELTRAMI_OK;
}

beltrami_status beltrami_context::run_session(
    double seconds, beltrami_progress progress, void* user,
    const std::function<beltrami_status(beltrami::EditSession&, const beltrami::Work&)>& body) {
  beltrami::EditSession& own = editing();
  const double wall = beltrami::wall_seconds(), cpu = beltrami::cpu_seconds();
  beltrami::RunMark mark(*this);
  const beltrami::InterruptScope interruptible(&cancelled);
  beltrami::HostProgress host(progress, user);
  beltrami::Limits bounds = beltrami::limits(options);
  if (seconds > 0) bounds.seconds = seconds;
  const beltrami::Work work = this->work(bounds, host.watched());
  const beltrami_status status = body(own, work);
  session_seconds = beltrami::wall_seconds() - wall;
  session_cpu_seconds = beltrami::cpu_seconds() - cpu;
  return status;
}

beltrami::EditSession& beltrami_context::editing() const {
  if (!session) {
    throw beltrami::Error(beltrami::Fault::kInvalidState,
                          "there is no session: call beltrami_session_begin");
  }
  return *session;
}

const beltrami::PackedMeshes& beltrami_context::packing() const {
  if (!packed) {
    throw beltrami::Error(beltrami::Fault::kInvalidState,
                          "there is no packing yet: call beltrami_pack");
  }
  return *packed;
}

beltrami::OnPages beltrami_context::on_pages() const {
  if (last_packer == Packer::kPack) return beltrami::on_pages(*packed);
  if (last_packer == Packer::kUnwrap) return beltrami::on_pages(*unwrapped);
  throw beltrami::Error(beltrami::Fault::kInvalidState,
                        "nothing is packed yet: call beltrami_pack, or beltrami_unwrap with the "
                        "option pack at pages and without pins");
}

const beltrami::Unwrapped& beltrami_context::atlas() const {
  if (!unwrapped) {
    throw beltrami::Error(beltrami::Fault::kInvalidState,
                          "there is no atlas yet: call beltrami_unwrap");
  }
  return *unwrapped;
}

const beltrami::Flattening& beltrami_context::results() const {
  if (!flattening) {
    throw beltrami::Error(beltrami::Fault::kInvalidState,
                          "there is no result yet: call beltrami_run");
  }
  return *flattening;
}
