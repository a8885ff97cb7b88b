// The entry points that need a context, and those that describe the library.
#include <beltrami/beltrami.h>

#include <new>
#include <string>
#include <string_view>

#include "abi/buffers.h"
#include "abi/context.h"
#include "abi/failure.h"
#include "abi/input_mesh.h"
#include "abi/option_entry.h"
#include "abi/option_table.h"
#include "abi/option_values.h"
#include "abi/options.h"
#include "abi/reports.h"
#include "abi/status.h"
#include "base/error.h"
#include "base/host_memory.h"
#include "base/types.h"
#include "base/vectors.h"
#include "chart/flattening.h"
#include "energy/measure.h"
#include "exact/certificate.h"
#include "exact/exact_number.h"
#include "linear/spd_solver.h"
#include "multilevel/chart_map.h"
#include "ring/triangulate_ring.h"
#include "simplify/simplify.h"

#define BELTRAMI_TEXT_(x) #x
#define BELTRAMI_TEXT(x) BELTRAMI_TEXT_(x)
#define BELTRAMI_VERSION_TEXT           \
  BELTRAMI_TEXT(BELTRAMI_VERSION_MAJOR) \
  "." BELTRAMI_TEXT(BELTRAMI_VERSION_MINOR) "." BELTRAMI_TEXT(BELTRAMI_VERSION_PATCH)

#define BELTRAMI_BUILD_TEXT                                                      \
  "beltrami " BELTRAMI_VERSION_TEXT                                              \
  ", ABI " BELTRAMI_TEXT(BELTRAMI_ABI) ", solver " BELTRAMI_BUILD_SOLVER         \
                                       ", scaffold " BELTRAMI_BUILD_SCAFFOLD     \
                                       ", simplifier " BELTRAMI_BUILD_SIMPLIFIER \
                                       ", exact numbers " BELTRAMI_BUILD_EXACT

namespace beltrami {
namespace {

constexpr std::string_view kSolver = "solver:", kScaffold = "scaffold:",
                           kSimplifier = "simplifier:", kExact = "exact:";

/// Whether what this build links is under the GPL: CHOLMOD's Supernodal module is, and CGAL's
/// package of triangulations.
bool has_gpl() {
  return std::string_view(spd_solver_name()) == "cholmod" ||
         std::string_view(ring_triangulation_name()) == "cgal";
}

/// Whether it is under the LGPL: CGAL's numbers are, and CHOLMOD's other modules.
bool has_lgpl() {
  return std::string_view(kExactNumberName) == "cgal" ||
         std::string_view(spd_solver_name()).starts_with("cholmod");
}

/// A copy in memory of the allocator's own; null of null. Throws Error INVALID_ARGUMENT or
/// OUT_OF_MEMORY.
const HostMemory* keep_allocator(const beltrami_allocator* allocator) {
  if (allocator == nullptr) return nullptr;
  const beltrami_allocator given = read_sized(allocator, "allocator");
  if (given.allocate == nullptr || given.release == nullptr || given.reserved != 0) {
    throw Error(Fault::kInvalidArgument, "an allocator needs both functions, and 0 as reserved");
  }
  void* const place = given.allocate(given.user, sizeof(HostMemory), alignof(HostMemory));
  if (place == nullptr) throw std::bad_alloc();
  return new (place) HostMemory{given.user, given.allocate, given.release};
}

void release_allocator(const HostMemory* kept) {
  if (kept == nullptr) return;
  const HostMemory memory = *kept;
  memory.release(memory.user, const_cast<HostMemory*>(kept), sizeof(HostMemory),
                 alignof(HostMemory));
}

beltrami_option_info describe(const OptionEntry& option) {
  beltrami_option_info info{};
  info.key = option.key;
  info.type = option.type;
  info.minimum = option.minimum;
  info.maximum = option.maximum;
  info.default_value = option.get(Options{});
  info.name = option.name;
  info.summary = option.summary;
  info.calls = option.calls;
  return info;
}

beltrami_result describe(const LoadedMesh& mesh, const Flattening& flattening) {
  beltrami_result result{};
  const ChartStatistics& statistics = flattening.statistics;
  result.status = status_of(flattening.status);
  result.vertices = mesh.vertex_count;
  result.faces = mesh.input.disk.faces.size();
  result.boundary_edges = mesh.input.disk.boundary.size();
  result.unreferenced_vertices = mesh.vertex_count - mesh.input.original.size();
  result.coarse_faces = static_cast<std::uint64_t>(statistics.coarse_faces);
  result.flips_before_repair = static_cast<std::uint64_t>(statistics.flips_before_repair);
  result.area = mesh.area;
  result.seconds = flattening.seconds;
  result.cpu_seconds = flattening.cpu_seconds;
  result.peak_memory_bytes = flattening.peak_memory_bytes;
  result.kernel_fixes = static_cast<std::uint64_t>(statistics.kernel_fixes);
  result.patch_fixes = static_cast<std::uint64_t>(statistics.patch_fixes);
  result.global_fixes = static_cast<std::uint64_t>(statistics.global_fixes);
  result.cleaned_patches = static_cast<std::uint64_t>(statistics.cleaned_patches);
  result.restarts = static_cast<std::uint64_t>(flattening.restarts);
  result.float32_moves = static_cast<std::uint64_t>(flattening.float32_moves);
  result.delaunay_flips = static_cast<std::uint64_t>(statistics.delaunay_flips);
  result.delaunay_refused = static_cast<std::uint64_t>(statistics.delaunay_refused);
  result.coarse_energy = statistics.coarse_energy;
  result.degenerate_faces = mesh.degenerate_faces;
  result.first_degenerate_face = element_or_none(mesh.first_degenerate_face);
  return result;
}

/// The face's number in the input.
std::uint64_t input_face(const LoadedMesh& mesh, Index face) {
  return face == kNone
             ? BELTRAMI_NO_ELEMENT
             : static_cast<std::uint64_t>(mesh.input.original_face[static_cast<std::size_t>(face)]);
}

beltrami_certificate describe(const LoadedMesh& mesh, const Certificate& certificate) {
  beltrami_certificate report = empty_certificate();
  describe_orientations(report, certificate.orientations);
  report.first_bad_face = input_face(mesh, certificate.orientations.first_bad_face);
  describe_crossings(report, certificate.crossings, mesh.input.original);
  report.injective = certificate.injective() ? 1 : 0;
  return report;
}

void write_uvs(const LoadedMesh& mesh, const std::vector<Vec2>& uvs, Writer& writer) {
  const std::vector<Index>& original = mesh.input.original;
  if (original.size() < mesh.vertex_count) {
    const double origin[2] = {0, 0};
    for (std::size_t i = 0; i < mesh.vertex_count; ++i) writer.write(i, origin);
  }
  for (std::size_t i = 0; i < original.size(); ++i) {
    writer.write(static_cast<std::size_t>(original[i]), uvs[i].data());
  }
}

}  // namespace
}  // namespace beltrami

using beltrami::enter;
using beltrami::Error;
using beltrami::Fault;
using beltrami::guarded;

uint32_t beltrami_version(void) {
  return BELTRAMI_VERSION_MAJOR * 1000000 + BELTRAMI_VERSION_MINOR * 1000 + BELTRAMI_VERSION_PATCH;
}

const char* beltrami_build_info(void) {
  if (beltrami::has_gpl()) {
    return BELTRAMI_BUILD_TEXT ", links GPL code: distribute under the GPL only";
  }
  return beltrami::has_lgpl() ? BELTRAMI_BUILD_TEXT ", links no GPL code, but LGPL code"
                              : BELTRAMI_BUILD_TEXT ", links no GPL code and no LGPL code";
}

int32_t beltrami_has(const char* feature) {
  if (feature == nullptr) return 0;
  const std::string_view name(feature);
  if (name == "gpl") return beltrami::has_gpl() ? 1 : 0;
  if (name == "lgpl") return beltrami::has_lgpl() ? 1 : 0;
  if (name == "allocator") return beltrami::follows_host_memory() ? 1 : 0;
  const auto is = [&](std::string_view prefix, const char* value) {
    return name.starts_with(prefix) && name.substr(prefix.size()) == value;
  };
  return is(beltrami::kSolver, beltrami::spd_solver_name()) ||
         is(beltrami::kScaffold, beltrami::ring_triangulation_name()) ||
         is(beltrami::kSimplifier, beltrami::simplifier_name()) ||
         is(beltrami::kExact, beltrami::kExactNumberName);
}

const char* beltrami_status_name(beltrami_status status) {
  return beltrami::status_name(status);
}

const char* beltrami_status_advice(beltrami_status status) {
  return beltrami::status_advice(status);
}

beltrami_status beltrami_create_(uint32_t abi, beltrami_context** out) {
  return beltrami_create_with_(abi, nullptr, out);
}

beltrami_status beltrami_create_with_(uint32_t abi, const beltrami_allocator* allocator,
                                      beltrami_context** out) {
  if (out == nullptr) return BELTRAMI_E_INVALID_ARGUMENT;
  *out = nullptr;
  if (abi != BELTRAMI_ABI) return BELTRAMI_E_ABI_MISMATCH;
  if (allocator != nullptr && !beltrami::follows_host_memory()) return BELTRAMI_E_UNSUPPORTED;
  beltrami::Failure unused;
  return guarded(unused, [&] {
    const beltrami::HostMemory* const memory = beltrami::keep_allocator(allocator);
    const beltrami::HostMemoryScope of_the_context(memory);
    *out = new (std::nothrow) beltrami_context;
    if (*out == nullptr) {
      beltrami::release_allocator(memory);
      return BELTRAMI_E_OUT_OF_MEMORY;
    }
    (*out)->memory = memory;
    return BELTRAMI_OK;
  });
}

void beltrami_destroy(beltrami_context* context) {
  // During a run this is the caller's defect; a leak is the milder outcome.
  if (context == nullptr || context->running) return;
  const beltrami::HostMemory* const memory = context->memory;
  delete context;
  beltrami::release_allocator(memory);
}

const char* beltrami_error_message(const beltrami_context* context) {
  return context != nullptr ? context->failure.message() : "";
}

uint64_t beltrami_error_element(const beltrami_context* context) {
  return context != nullptr ? context->failure.element() : BELTRAMI_NO_ELEMENT;
}

int32_t beltrami_error_element_kind(const beltrami_context* context) {
  return context != nullptr ? context->failure.element_kind() : BELTRAMI_ELEMENT_NONE;
}

int32_t beltrami_option_find(const char* name) {
  if (name == nullptr) return -1;
  for (const beltrami::OptionEntry& option : beltrami::option_table()) {
    if (std::string_view(name) == option.name) return option.key;
  }
  return -1;
}

beltrami_status beltrami_option_describe(int32_t key, beltrami_option_info* out) {
  beltrami::Failure unused;
  return guarded(unused, [&] {
    beltrami::require_sized(out, "out");
    const beltrami::OptionEntry* option = beltrami::find_option(key);
    if (option == nullptr) return BELTRAMI_E_INVALID_ARGUMENT;
    beltrami::write_sized(out, beltrami::describe(*option));
    return BELTRAMI_OK;
  });
}

const char* beltrami_option_choice(int32_t key, int32_t value) {
  const beltrami::OptionEntry* option = beltrami::find_option(key);
  if (option == nullptr || value < 0) return nullptr;
  const auto index = static_cast<std::size_t>(value);
  return index < option->choices.size() ? option->choices[index] : nullptr;
}

beltrami_status beltrami_set_int(beltrami_context* context, int32_t key, int64_t value) {
  return enter(context, [&](beltrami_context& self) {
    beltrami::set_int_option(self.options, key, value);
    return BELTRAMI_OK;
  });
}

beltrami_status beltrami_set_float(beltrami_context* context, int32_t key, double value) {
  return enter(context, [&](beltrami_context& self) {
    beltrami::set_float_option(self.options, key, value);
    return BELTRAMI_OK;
  });
}

beltrami_status beltrami_get_option(beltrami_context* context, int32_t key, double* value) {
  return enter(context, [&](beltrami_context& self) {
    if (value == nullptr) {
      throw beltrami::Error(beltrami::Fault::kInvalidArgument, "value is NULL");
    }
    *value = beltrami::get_option(self.options, key);
    return BELTRAMI_OK;
  });
}

beltrami_status beltrami_set_parallel_for(beltrami_context* context,
                                          beltrami_parallel_for parallel_for, void* user) {
  return enter(context, [&](beltrami_context& self) {
    self.parallel_for = parallel_for;
    self.parallel_user = user;
    return BELTRAMI_OK;
  });
}

beltrami_status beltrami_set_mesh(beltrami_context* context, const beltrami_mesh* mesh) {
  return enter(context, [&](beltrami_context& self) {
    self.cancelled.store(false);
    self.mesh = beltrami::load_mesh(mesh, self.work(nullptr), self.cancelled);
    self.flattening.reset();
    return BELTRAMI_OK;
  });
}

beltrami_status beltrami_estimate_memory(beltrami_context* context, uint64_t* bytes) {
  return enter(context, [&](beltrami_context& self) {
    if (bytes == nullptr) throw Error(Fault::kInvalidArgument, "bytes is NULL");
    *bytes = self.estimate_memory();
    return BELTRAMI_OK;
  });
}

beltrami_status beltrami_run(beltrami_context* context, beltrami_progress progress, void* user) {
  return enter(context, [&](beltrami_context& self) { return self.run(progress, user); });
}

void beltrami_cancel(beltrami_context* context) {
  if (context != nullptr) context->cancelled.store(true);
}

beltrami_status beltrami_get_result(beltrami_context* context, beltrami_result* out) {
  return enter(context, [&](beltrami_context& self) {
    beltrami::require_sized(out, "out");
    beltrami::write_sized(out, beltrami::describe(*self.mesh, self.results()));
    return BELTRAMI_OK;
  });
}

beltrami_status beltrami_get_uvs(beltrami_context* context, void* out, int32_t type,
                                 uint64_t stride) {
  return enter(context, [&](beltrami_context& self) {
    const beltrami::Flattening& results = self.results();
    beltrami::Writer writer(out, type, stride, self.mesh->vertex_count, 2);
    beltrami::write_uvs(*self.mesh, results.uvs, writer);
    if (type == BELTRAMI_F32) {
      for (const auto& [vertex, place] : results.single_moves) {
        writer.write(static_cast<std::size_t>(self.mesh->input.original[vertex]), place.data());
      }
    }
    return BELTRAMI_OK;
  });
}

beltrami_status beltrami_get_certificate(beltrami_context* context, beltrami_certificate* out) {
  return enter(context, [&](beltrami_context& self) {
    beltrami::require_sized(out, "out");
    beltrami::write_sized(out, beltrami::describe(*self.mesh, self.results().certificate));
    return BELTRAMI_OK;
  });
}

beltrami_status beltrami_get_float32_certificate(beltrami_context* context,
                                                 beltrami_certificate* out) {
  return enter(context, [&](beltrami_context& self) {
    beltrami::require_sized(out, "out");
    beltrami::write_sized(out, beltrami::describe(*self.mesh, self.results().single_certificate));
    return BELTRAMI_OK;
  });
}

beltrami_status beltrami_get_faces(beltrami_context* context, void* out, int32_t type,
                                   uint64_t stride) {
  return enter(context, [&](beltrami_context& self) {
    const beltrami::Flattening& results = self.results();
    const beltrami::InputDisk& input = self.mesh->input;
    const auto& faces = results.faces.empty() ? input.disk.faces : results.faces;
    beltrami::write_faces(faces, input.original, input.original_face, out, type, stride);
    return BELTRAMI_OK;
  });
}

beltrami_status beltrami_get_energy(beltrami_context* context, beltrami_energy* out) {
  return enter(context, [&](beltrami_context& self) {
    beltrami::require_sized(out, "out");
    const beltrami::Distortion& distortion = self.results().distortion;
    beltrami_energy energy = beltrami::describe_distortion(distortion);
    energy.worst_face = beltrami::input_face(*self.mesh, distortion.worst_face);
    beltrami::write_sized(out, energy);
    return BELTRAMI_OK;
  });
}

beltrami_status beltrami_get_face_energies(beltrami_context* context, void* out, uint64_t stride) {
  return enter(context, [&](beltrami_context& self) {
    const std::vector<double>& energies = self.results().face_energies;
    beltrami::Writer writer(out, BELTRAMI_F64, stride, energies.size(), 1);
    const std::vector<beltrami::Index>& original = self.mesh->input.original_face;
    for (std::size_t f = 0; f < energies.size(); ++f) {
      writer.write(static_cast<std::size_t>(original[f]), &energies[f]);
    }
    return BELTRAMI_OK;
  });
}

int32_t beltrami_stage_count(const beltrami_context* context) {
  if (context == nullptr || !context->flattening) return 0;
  return static_cast<int32_t>(context->flattening->statistics.stages.size());
}

beltrami_status beltrami_get_stage(beltrami_context* context, int32_t index, beltrami_stage* out) {
  return enter(context, [&](beltrami_context& self) {
    beltrami::require_sized(out, "out");
    const std::vector<beltrami::StageStatistics>& stages = self.results().statistics.stages;
    if (index < 0 || static_cast<std::size_t>(index) >= stages.size()) {
      throw Error(Fault::kInvalidArgument,
                  "there is no stage " + std::to_string(index) + ": the last run had " +
                      std::to_string(stages.size()) + " stages, counted from 0");
    }
    beltrami::write_sized(out, beltrami::describe_stage(stages[static_cast<std::size_t>(index)]));
    return BELTRAMI_OK;
  });
}
