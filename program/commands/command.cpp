#include "commands/command.h"

#include <sys/stat.h>

#include <chrono>
#include <filesystem>
#include <new>

#include "commands/report.h"
#include "files/atomic_file.h"
#include "files/mesh_file.h"
#include "process/descriptor.h"
#include "process/failure.h"
#include "process/interrupt.h"

namespace beltrami::cli {
namespace {

const auto kProgramStart = std::chrono::steady_clock::now();

/// Never throws: the line on stderr is taken by the first failure, which is the one to mend first.
template <class MakeFailure>
void report_failure(Report& report, const std::string& path, MakeFailure&& failure) {
  if (path.empty() && !report.printed) return;
  try {
    report.set_failure(failure());
    report.seconds = seconds_so_far();
    if (report.printed) {
      print(to_json(report), "the report", 0);
      return;
    }
    AtomicFile file(path);
    file.write(to_json(report));
    file.commit();
  } catch (const std::exception&) {
    return;
  }
}

}  // namespace

double seconds_so_far() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - kProgramStart).count();
}

Context make_context() {
  beltrami_context* raw = nullptr;
  const beltrami_status status = beltrami_create(&raw);
  if (status < 0) throw Failure(status, beltrami_status_advice(status));
  return {raw, &beltrami_destroy};
}

std::vector<double> face_energies(const TriangleView& triangles) {
  const beltrami_mesh mesh = view_of(triangles);
  const beltrami_buffer uvs = uv_view(triangles);
  beltrami_energy energy{};
  energy.struct_size = sizeof energy;
  std::vector<double> energies(triangles.face_count());
  const beltrami_status status = beltrami_measure(&mesh, &uvs, &energy, energies.data());
  require_ok(status, "the picture", "", BELTRAMI_ELEMENT_NONE, BELTRAMI_NO_ELEMENT);
  return energies;
}

beltrami_mesh view_of(const TriangleView& triangles) {
  beltrami_mesh mesh{};
  mesh.struct_size = sizeof mesh;
  mesh.vertex_count = triangles.vertex_count();
  mesh.face_count = triangles.face_count();
  mesh.positions = {triangles.positions.data(), 0, BELTRAMI_F64, 0};
  mesh.indices = {triangles.faces.data(), 0, BELTRAMI_U32, 0};
  mesh.cancel = interrupt_number();
  return mesh;
}

beltrami_buffer uv_view(const TriangleView& triangles) {
  return {triangles.uvs.data(), 0, BELTRAMI_F64, 0};
}

std::uint64_t unreferenced_vertices(const MeshFile& file) {
  std::vector<bool> used(file.vertex_count(), false);
  std::uint64_t unused = file.vertex_count();
  for (const std::uint32_t vertex : file.polygons.corners()) {
    if (!used[vertex]) --unused;
    used[vertex] = true;
  }
  return unused;
}

bool injective_in_float32(const TriangleView& triangles) {
  const std::vector<float> rounded(triangles.uvs.begin(), triangles.uvs.end());
  const beltrami_buffer view = {rounded.data(), 0, BELTRAMI_F32, 0};
  const beltrami_mesh mesh = view_of(triangles);
  beltrami_certificate certificate{};
  certificate.struct_size = sizeof certificate;
  const beltrami_status status = beltrami_check_injective(&mesh, &view, &certificate);
  if (status == BELTRAMI_E_OUT_OF_MEMORY) throw std::bad_alloc();
  return status == BELTRAMI_OK;  // an overflow to infinity is an error status: not injective
}

void require_ok(beltrami_status status, const std::string& path, const char* message,
                std::int32_t element_kind, std::uint64_t element) {
  if (status >= 0) return;
  if (status == BELTRAMI_E_CANCELLED) throw Failure(status, "cancelled");
  std::string text = path + ": " + (*message ? message : beltrami_status_advice(status));
  if (element != BELTRAMI_NO_ELEMENT && element_kind != BELTRAMI_ELEMENT_NONE) {
    const std::string name =
        std::string(element_name(element_kind)) + " " + std::to_string(element);
    const bool named = text.find(name) != std::string::npos;
    text += named ? " (counted from 0)" : " (" + name + ", counted from 0)";
  }
  throw Failure(status, text, element_kind, element);
}

void require_ok_mesh(beltrami_status status, const std::string& path, const char* message,
                     std::int32_t element_kind, std::uint64_t element, const MeshFile& file,
                     const Surface& surface) {
  if (status >= 0) return;
  std::string text = message;
  if (element_kind == BELTRAMI_ELEMENT_FACE) {
    const std::string triangle = "face " + std::to_string(element);
    to_face_of(surface, element);
    const std::size_t at = text.find(triangle);
    if (at != std::string::npos) {
      text.replace(at, triangle.size(), "face " + std::to_string(element));
    }
  }
  if (status == BELTRAMI_E_COMPONENTS && surface.welded_vertices() == 0 && welding_connects(file)) {
    text = "face " + std::to_string(element) +
           " shares no vertex with the faces that it touches: weld vertices at one place with "
           "--weld";
  }
  require_ok(status, path, text.c_str(), element_kind, element);
}

void to_face_of(const Surface& surface, std::uint64_t& triangle) {
  if (triangle != BELTRAMI_NO_ELEMENT) triangle = surface.face_of(triangle);
}

bool same_file(const std::string& a, const std::string& b) {
  namespace fs = std::filesystem;
  if (a.empty() || b.empty()) return false;
  std::error_code error;
  if (fs::equivalent(a, b, error)) return true;
  // Files that are yet to be written are compared by name.
  const auto full_name = [&](const std::string& path) {
    fs::path name = fs::weakly_canonical(fs::absolute(path, error), error);
    if (error == std::errc::not_enough_memory) throw std::bad_alloc();
    return name;
  };
  const fs::path first = full_name(a);
  return first == full_name(b) && !error;
}

void require_distinct(const std::vector<std::string>& paths) {
  for (std::size_t i = 0; i < paths.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (same_file(paths[i], paths[j])) {
        throw Failure(paths[i] + ": one file is named for two purposes");
      }
    }
  }
}

void require_apart_from_stdout(const std::vector<std::string>& paths) {
#if !defined(_WIN32)
  struct stat out {};
  if (fstat(kStandardOutput, &out) != 0 || !S_ISREG(out.st_mode)) return;
  for (const std::string& path : paths) {
    struct stat file {};
    if (stat(path.c_str(), &file) != 0) continue;
    if (file.st_dev != out.st_dev || file.st_ino != out.st_ino) continue;
    throw Failure(path + ": standard output goes there, and the summary with it: give --quiet");
  }
#endif
}

int run_guarded(Report& report, const std::string& report_path,
                const std::vector<std::string>& others, const std::function<int()>& body) {
  std::string path = report_path;
  for (const std::string& other : others) {
    if (same_file(report_path, other)) path.clear();
  }
  const std::string& input = report.input_path;
  try {
    return body();
  } catch (const Failure& failure) {
    const bool cancelled = failure.exit_code == kExitCancelled;
    const int code = cancelled ? tell(failure.exit_code, {"cancelled"})
                               : tell(failure.exit_code, {"beltrami: ", failure.what()});
    report_failure(report, path, [&] { return failure; });
    return code;
  } catch (const std::bad_alloc&) {
    const char* advice = beltrami_status_advice(BELTRAMI_E_OUT_OF_MEMORY);
    const int code = tell(kExitInternal, {"beltrami: ", input, ": ", advice});
    report_failure(report, path,
                   [&] { return Failure(BELTRAMI_E_OUT_OF_MEMORY, input + ": " + advice); });
    return code;
  } catch (const std::exception& error) {
    const int code = tell(kExitInternal, {"beltrami: ", input, ": ", error.what()});
    report_failure(report, path,
                   [&] { return Failure(BELTRAMI_E_INTERNAL, input + ": " + error.what()); });
    return code;
  }
}

}  // namespace beltrami::cli
