// The memory of runs against its estimate: what src/chart/memory_estimate.cpp is calibrated
// with.
//
// Each run has a process of its own. It counts what the process grows by from before
// beltrami_set_mesh to the peak of beltrami_run, without what the loading took for a while: that is
// what beltrami_estimate_memory speaks of. Stage by stage the kernel's mark of the peak is set
// back.
#include <beltrami/beltrami.h>
#include <malloc.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "commands/command.h"
#include "process_memory.h"
#include "records.h"
#include "refine.h"

namespace beltrami::benchmarks {
namespace {

constexpr double kMebibyte = 1 << 20;

/// The peak of every stage, noted when the next one begins.
struct StagePeaks {
  double start = 0;  ///< bytes of the process before the library was called
  double peak = 0;
  std::string stage, text;

  static std::int32_t note(void* user, double, const char* stage) {
    auto& self = *static_cast<StagePeaks*>(user);
    if (self.stage != stage) self.finish(stage);
    return 0;
  }

  void finish(const char* next) {
    const double now = memory_of_process("VmHWM") - start;
    if (!stage.empty()) text += " " + stage + " " + std::to_string(std::lround(now / kMebibyte));
    peak = std::max(peak, now);
    stage = next;
    reset_peak();
  }
};

/// What the process of a run tells.
struct Measured {
  double bytes, estimate, energy;
  std::int32_t status;
  char stages[400];  ///< name and MiB of each
};

void set_option(beltrami_context* context, const std::string& assignment) {
  const std::size_t split = assignment.find('=');
  const std::string name = assignment.substr(0, split), word = assignment.substr(split + 1);
  const std::int32_t key = beltrami_option_find(name.c_str());
  std::int32_t value = 0;
  while (const char* choice = beltrami_option_choice(key, value)) {
    if (word == choice) break;
    ++value;
  }
  const bool is_choice = beltrami_option_choice(key, 0) != nullptr;
  if (beltrami_set_int(context, key, is_choice ? value : std::stoll(word)) < 0) {
    throw std::runtime_error(beltrami_error_message(context));
  }
}

Measured run(const TriangleMesh& file, const std::vector<std::string>& options) {
  Measured measured{};
  StagePeaks peaks;
  malloc_trim(0);
  peaks.start = memory_of_process("VmRSS");
  beltrami_context* context = nullptr;
  beltrami_create(&context);
  for (const std::string& option : options) set_option(context, option);
  const beltrami_mesh mesh = cli::view_of(file.view());
  std::uint64_t estimate = 0;
  if (beltrami_set_mesh(context, &mesh) < 0 || beltrami_estimate_memory(context, &estimate) < 0) {
    throw std::runtime_error(beltrami_error_message(context));
  }
  malloc_trim(0);
  reset_peak();
  measured.status = beltrami_run(context, StagePeaks::note, &peaks);
  if (measured.status < 0) throw std::runtime_error(beltrami_error_message(context));
  peaks.finish("");
  beltrami_energy energy{};
  energy.struct_size = sizeof energy;
  beltrami_get_energy(context, &energy);
  beltrami_destroy(context);
  measured.bytes = peaks.peak;
  measured.estimate = static_cast<double>(estimate);
  measured.energy = energy.symmetric_dirichlet;
  std::snprintf(measured.stages, sizeof measured.stages, "%s", peaks.text.c_str());
  return measured;
}

/// Runs in a process of its own, so that no run sees what another one left to the allocator.
Measured run_apart(const TriangleMesh& file, const std::vector<std::string>& options) {
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("no pipe could be made");
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("no process could be started");
  if (child == 0) {
    Measured measured{};
    try {
      measured = run(file, options);
    } catch (const std::exception& error) {
      measured.status = -1;
      std::snprintf(measured.stages, sizeof measured.stages, "%s", error.what());
    }
    const bool told = write(ends[1], &measured, sizeof measured) == sizeof measured;
    _exit(told ? 0 : 1);
  }
  close(ends[1]);
  Measured measured{};
  const bool told = read(ends[0], &measured, sizeof measured) == sizeof measured;
  close(ends[0]);
  waitpid(child, nullptr, 0);
  if (!told) throw std::runtime_error("a run ended without an answer");
  return measured;
}

std::vector<std::string> words(const std::string& text) {
  std::vector<std::string> result;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    if (end > begin) result.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return result;
}

/// Returns whether the estimate was enough.
bool report(const std::string& name, const TriangleMesh& mesh, const std::string& mode,
            Records& records) {
  const Measured m = run_apart(mesh, words(mode));
  if (m.status < 0) {
    std::printf("%-24.24s %9llu %s: %s\n", name.c_str(),
                static_cast<unsigned long long>(mesh.face_count()), mode.c_str(), m.stages);
    return true;
  }
  const bool enough = m.bytes <= m.estimate;
  std::printf("%-24.24s %9llu %8.1f %8.1f %6.2f%s %6.0f %8.4f  %s:%s\n", name.c_str(),
              static_cast<unsigned long long>(mesh.face_count()), m.bytes / kMebibyte,
              m.estimate / kMebibyte, m.estimate / m.bytes, enough ? " " : "!",
              m.bytes / static_cast<double>(mesh.vertex_count()), m.energy, mode.c_str(), m.stages);
  std::fflush(stdout);
  records.add({{"mesh", name},
               {"faces", mesh.face_count()},
               {"mode", mode},
               {"bytes", m.bytes},
               {"estimate", m.estimate},
               {"energy", m.energy}});
  return enough;
}

}  // namespace
}  // namespace beltrami::benchmarks

int main(int argc, char** argv) {
  CLI::App app(
      "Peak memory of runs against beltrami_estimate_memory, on MESH... refined to some sizes. "
      "Ends with 1 if an estimate was exceeded.");
  std::vector<std::string> meshes = {BELTRAMI_EXAMPLE_MESH};
  std::vector<std::string> modes = {"threads=1", "threads=2"};
  std::vector<std::uint64_t> sizes = {0};
  app.add_option("MESH", meshes, "Disks; the bust of examples/data by default");
  app.add_option("--faces", sizes, "Refine to about so many faces; 0: as it is");
  app.add_option("--mode", modes, "Options of a run, as in \"flatten=gif threads=2\"");
  beltrami::benchmarks::Records records("memory");
  return beltrami::benchmarks::run(app, argc, argv, records, [&] {
    using namespace beltrami;
    bool enough = true;
    std::printf("%s\n%-24s %9s %8s %8s %6s  %6s %8s  %s\n", beltrami_build_info(), "mesh", "faces",
                "MiB", "estimate", "ratio", "B/vert", "E", "mode: MiB at the peak of each stage");
    for (const std::string& path : meshes) {
      const benchmarks::TriangleMesh base = benchmarks::read_triangles(path);
      const std::string name = std::filesystem::path(path).stem().string();
      for (const std::uint64_t faces : sizes) {
        const benchmarks::TriangleMesh mesh =
            faces > base.face_count() ? benchmarks::refine(base, faces) : base;
        for (const std::string& mode : modes) {
          enough &= benchmarks::report(name, mesh, mode, records);
        }
      }
    }
    return enough ? 0 : 1;
  });
}
