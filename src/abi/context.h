// The context behind the C interface: options, one mesh, the results of its last run.
#pragma once

#include <beltrami/beltrami.h>

#include <atomic>
#include <functional>
#include <memory>
#include <optional>

#include "abi/edit_session.h"
#include "abi/failure.h"
#include "abi/input_mesh.h"
#include "abi/options.h"
#include "abi/packed.h"
#include "abi/unwrapped.h"
#include "base/error.h"
#include "base/host_memory.h"
#include "base/types.h"
#include "base/work.h"
#include "chart/flattening.h"
#include "mesh/disk_mesh.h"

namespace beltrami {

/// A validated copy of the caller's mesh, normalised.
struct LoadedMesh {
  InputDisk input;
  Normalisation frame;
  std::uint64_t vertex_count = 0;       ///< of the input, unused vertices included
  double area = 0;                      ///< in the input's unit squared
  std::uint64_t degenerate_faces = 0;   ///< without area
  Index first_degenerate_face = kNone;  ///< in the input
};

/// Reads, validates and normalises. `cancelled` may be set from another thread. Throws Error
/// INVALID_ARGUMENT or a mesh status, or Cancelled.
LoadedMesh load_mesh(const beltrami_mesh* mesh, const Work& work,
                     const std::atomic<bool>& cancelled);

}  // namespace beltrami

struct beltrami_context {
  const beltrami::HostMemory* memory = nullptr;  ///< in a block of its own; null: the C library's
  beltrami::Options options;
  std::optional<beltrami::LoadedMesh> mesh;
  std::optional<beltrami::Flattening> flattening;  ///< of `mesh`
  std::optional<beltrami::Unwrapped> unwrapped;    ///< of the last surface
  std::optional<beltrami::PackedMeshes> packed;    ///< of the last UV meshes
  std::unique_ptr<beltrami::EditSession> session;
  double session_seconds = 0, session_cpu_seconds = 0;  ///< of its last call that ran
  enum class Packer { kNone, kUnwrap, kPack } last_packer = Packer::kNone;
  beltrami_parallel_for parallel_for = nullptr;  ///< the host's, or null: own threads
  void* parallel_user = nullptr;
  beltrami::Failure failure;
  std::atomic<bool> cancelled{false};
  bool running = false;

  /// What a run may use: the options' limits, and the host's threads where it lends them.
  beltrami::Work work(const beltrami::Limits& bounds, beltrami::Progress watched) const;
  /// Within those of the options.
  beltrami::Work work(beltrami::Progress watched) const;

  /// Bytes that the library will hold at the peak of the next run: see beltrami_estimate_memory.
  /// Throws Error INVALID_STATE where there is no mesh.
  std::uint64_t estimate_memory() const;

  /// Flattens the mesh. Throws Error INVALID_STATE, INVALID_ARGUMENT, OUT_OF_MEMORY or SOLVER, or
  /// Cancelled; keeps old results then.
  beltrami_status run(beltrami_progress progress, void* user);

  /// Unwraps surfaces together. Throws Error INVALID_ARGUMENT, OUT_OF_MEMORY or a mesh status, or
  /// Cancelled; keeps old results then.
  beltrami_status unwrap(const beltrami_surface* const* surfaces, std::uint64_t surface_count,
                         beltrami_progress progress, void* user);

  /// Packs charts. Throws Error INVALID_ARGUMENT, NO_ROOM, OUT_OF_MEMORY or a mesh status, or
  /// Cancelled; keeps old results then.
  beltrami_status pack(const beltrami_uv_mesh* const* meshes, std::uint64_t mesh_count,
                       beltrami_progress progress, void* user);

  /// Bakes images. Throws Error INVALID_ARGUMENT, EMPTY, NON_FINITE or OUT_OF_MEMORY, or Cancelled.
  beltrami_status bake(const beltrami_bake_job* job, beltrami_baked* out,
                       beltrami_progress progress, void* user);

  /// Begins a session, in place of the one before. Throws what its constructor does, or Cancelled;
  /// keeps the old one then.
  beltrami_status begin_session(const beltrami_surface* surface, beltrami_progress progress,
                                void* user);

  /// Runs `body(session, work)` for no more than `seconds`, or 0: any. Throws what that does, Error
  /// INVALID_STATE without a session, or Cancelled.
  beltrami_status run_session(
      double seconds, beltrami_progress progress, void* user,
      const std::function<beltrami_status(beltrami::EditSession&, const beltrami::Work&)>& body);

  /// The results. Throws Error INVALID_STATE where there are none.
  const beltrami::Flattening& results() const;
  const beltrami::Unwrapped& atlas() const;
  const beltrami::PackedMeshes& packing() const;
  beltrami::EditSession& editing() const;
  beltrami::OnPages on_pages() const;  ///< of what was packed last
};

namespace beltrami {

/// The wrapper of every entry point with a context: refuses NULL, and calls during a run. Memory is
/// that of the context.
template <class Body>
beltrami_status enter(beltrami_context* context, Body&& body) noexcept {
  if (context == nullptr) return BELTRAMI_E_INVALID_ARGUMENT;
  const HostMemoryScope of_the_context(context->memory);
  return guarded(context->failure, [&]() -> beltrami_status {
    if (context->running) {
      throw Error(Fault::kInvalidState,
                  "a run is under way on this context: only beltrami_cancel is possible");
    }
    return body(*context);
  });
}

}  // namespace beltrami
