#include "command.h"

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <new>

#include "atomic_file.h"

namespace beltrami::cli {
namespace {

const auto program_start = std::chrono::steady_clock::now();

void write_failure_report(Report& report, const std::string& path) {
  if (path.empty()) return;
  report.seconds = seconds_so_far();
  AtomicFile file(path);
  file.write(to_json(report));
  file.commit();
}

int fail(Report& report, const std::string& report_path, const Failure& failure) {
  if (failure.exit_code == kExitCancelled) {
    std::fputs("cancelled\n", stderr);
  } else {
    std::fprintf(stderr, "beltrami: %s\n", one_line(failure.what()).c_str());
  }
  report.set_failure(failure);
  try {
    write_failure_report(report, report_path);
  } catch (const std::exception&) {
    // The line on stderr is taken by the first failure, which is the one to mend first.
  }
  return failure.exit_code;
}

}  // namespace

double seconds_so_far() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - program_start).count();
}

beltrami_mesh view_of(const MeshFile& file) {
  beltrami_mesh mesh{};
  mesh.struct_size = sizeof mesh;
  mesh.vertex_count = file.vertex_count();
  mesh.face_count = file.face_count();
  mesh.positions = {file.positions.data(), 0, BELTRAMI_F64, 0};
  mesh.indices = {file.faces.data(), 0, BELTRAMI_U32, 0};
  return mesh;
}

beltrami_buffer uv_view(const std::vector<double>& uvs) {
  return {uvs.data(), 0, BELTRAMI_F64, 0};
}

bool injective_in_float32(const MeshFile& file, const std::vector<double>& uvs) {
  const std::vector<float> rounded(uvs.begin(), uvs.end());
  const beltrami_buffer view = {rounded.data(), 0, BELTRAMI_F32, 0};
  const beltrami_mesh mesh = view_of(file);
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
        (element_kind == BELTRAMI_ELEMENT_FACE ? "face " : "vertex ") + std::to_string(element);
    const bool named = text.find(name) != std::string::npos;
    text += named ? " (counted from 0)" : " (" + name + ", counted from 0)";
  }
  throw Failure(status, text, element_kind, element);
}

bool same_file(const std::string& a, const std::string& b) {
  namespace fs = std::filesystem;
  if (a.empty() || b.empty()) return false;
  std::error_code error;
  if (fs::equivalent(a, b, error)) return true;
  // Files that are yet to be written are compared by name.
  const fs::path first = fs::weakly_canonical(fs::absolute(a, error), error);
  return first == fs::weakly_canonical(fs::absolute(b, error), error) && !error;
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

int run_guarded(Report& report, const std::string& report_path,
                const std::vector<std::string>& others, const std::function<int()>& body) {
  std::string path = report_path;
  for (const std::string& other : others) {
    if (same_file(report_path, other)) path.clear();
  }
  try {
    return body();
  } catch (const Failure& failure) {
    return fail(report, path, failure);
  } catch (const std::bad_alloc&) {
    const std::string advice = beltrami_status_advice(BELTRAMI_E_OUT_OF_MEMORY);
    return fail(report, path, Failure(BELTRAMI_E_OUT_OF_MEMORY, report.input_path + ": " + advice));
  } catch (const std::exception& error) {
    return fail(report, path,
                Failure(BELTRAMI_E_INTERNAL, report.input_path + ": " + error.what()));
  }
}

}  // namespace beltrami::cli
