// Every mode on the same meshes, in one process: energy, flips and cost as one table.
//
// Costs are CPU seconds of the run, and their ratio to composite majorization (CM) on the same
// mesh, which is run beside the others; only the ratios carry from machine to machine.
#include <beltrami/beltrami.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "commands/command.h"
#include "records.h"
#include "refine.h"

namespace {

using beltrami::benchmarks::Json;
using beltrami::benchmarks::Records;

struct Setting {
  std::int32_t key;
  std::int64_t value;
};

struct Mode {
  const char* name;
  std::vector<Setting> settings;
};

const std::vector<Mode>& modes() {
  static const std::vector<Mode> all = {
      {"cm", {{BELTRAMI_OPTION_METHOD, BELTRAMI_METHOD_CM}}},
      {"metric", {}},
      {"dirichlet", {{BELTRAMI_OPTION_FLATTEN, BELTRAMI_FLATTEN_DIRICHLET}}},
      {"gif", {{BELTRAMI_OPTION_FLATTEN, BELTRAMI_FLATTEN_GIF}}},
      {"flim", {{BELTRAMI_OPTION_FLATTEN, BELTRAMI_FLATTEN_FLIM}}},
      {"bff", {{BELTRAMI_OPTION_FLATTEN, BELTRAMI_FLATTEN_BFF}}},
      {"refine", {{BELTRAMI_OPTION_REFINE, 1}}},
      {"uv-prolongation", {{BELTRAMI_OPTION_METHOD, BELTRAMI_METHOD_UV_PROLONGATION}}},
      {"plain gif", {{BELTRAMI_OPTION_METHOD, BELTRAMI_METHOD_GIF}}},
      {"plain bff", {{BELTRAMI_OPTION_METHOD, BELTRAMI_METHOD_BFF}}},
      {"tutte", {{BELTRAMI_OPTION_METHOD, BELTRAMI_METHOD_TUTTE}}},
  };
  return all;
}

struct Figures {
  beltrami_status status;
  double energy = 0, cpu_seconds = 0;
  bool injective = false;
  unsigned long long flips_before = 0, flips = 0, crossings = 0;
};

Figures run(const beltrami::benchmarks::TriangleMesh& file, const Mode& mode,
            std::int32_t energy_kind, int threads) {
  beltrami_context* raw = nullptr;
  beltrami_create(&raw);
  const std::unique_ptr<beltrami_context, void (*)(beltrami_context*)> context(raw,
                                                                               beltrami_destroy);
  const beltrami_mesh mesh = beltrami::cli::view_of(file.view());
  Figures figures{};
  figures.status = beltrami_set_mesh(raw, &mesh);
  if (figures.status < 0) return figures;
  beltrami_set_int(raw, BELTRAMI_OPTION_ENERGY, energy_kind);
  beltrami_set_int(raw, BELTRAMI_OPTION_THREADS, threads);
  for (const Setting& s : mode.settings) beltrami_set_int(raw, s.key, s.value);
  figures.status = beltrami_run(raw, nullptr, nullptr);
  if (figures.status < 0) return figures;
  beltrami_result result{};
  result.struct_size = sizeof result;
  beltrami_certificate certificate{};
  certificate.struct_size = sizeof certificate;
  beltrami_energy energy{};
  energy.struct_size = sizeof energy;
  beltrami_get_result(raw, &result);
  beltrami_get_certificate(raw, &certificate);
  beltrami_get_energy(raw, &energy);
  const bool arap = energy_kind == BELTRAMI_ENERGY_SYMMETRIC_ARAP;
  figures.energy = arap ? energy.symmetric_arap : energy.symmetric_dirichlet;
  figures.cpu_seconds = result.cpu_seconds;
  figures.injective = certificate.injective != 0;
  figures.flips_before = result.flips_before_repair;
  figures.flips = certificate.negative + certificate.degenerate;
  figures.crossings = certificate.boundary_crossings;
  return figures;
}

void benchmark(const std::string& path, std::uint64_t faces, bool with_cm, std::int32_t energy,
               int threads, Records& records) {
  auto mesh = beltrami::benchmarks::read_triangles(path);
  if (faces > mesh.face_count()) mesh = beltrami::benchmarks::refine(mesh, faces);
  const std::string name = std::filesystem::path(path).stem().string();
  std::printf("\n%s, %llu faces\n", name.c_str(),
              static_cast<unsigned long long>(mesh.face_count()));
  std::printf("%-16s %12s %9s %10s %9s %7s %6s %9s  %s\n", "mode", "E", "E / CM", "flips in",
              "flips out", "cross", "cpu s", "cpu / CM", "verdict");
  Figures cm;
  for (const Mode& mode : modes()) {
    const bool is_cm = std::string(mode.name) == "cm";
    if (is_cm && !with_cm) continue;
    const Figures f = run(mesh, mode, energy, threads);
    if (is_cm) cm = f;
    const double energy_ratio = with_cm ? f.energy / cm.energy : 0;
    const double cost_ratio = with_cm ? f.cpu_seconds / cm.cpu_seconds : 0;
    const char* verdict = f.status < 0 ? beltrami_status_name(f.status)
                                       : (f.injective ? "injective" : "not injective");
    std::printf("%-16s %12.6g %9.4f %10llu %9llu %7llu %6.2f %9.4f  %s\n", mode.name, f.energy,
                energy_ratio, f.flips_before, f.flips, f.crossings, f.cpu_seconds, cost_ratio,
                verdict);
    std::fflush(stdout);
    records.add({{"mesh", name},
                 {"faces", mesh.face_count()},
                 {"mode", mode.name},
                 {"status", beltrami_status_name(f.status)},
                 {"energy", f.energy},
                 {"energy_over_cm", with_cm ? Json(energy_ratio) : Json()},
                 {"flips_before_repair", f.flips_before},
                 {"flips", f.flips},
                 {"boundary_crossings", f.crossings},
                 {"cpu_seconds", f.cpu_seconds},
                 {"cost_over_cm", with_cm ? Json(cost_ratio) : Json()},
                 {"injective", f.injective}});
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Runs every mode on MESH... and prints energy, flips and cost against CM.");
  std::vector<std::string> meshes = {BELTRAMI_EXAMPLE_MESH};
  std::uint64_t faces = 0;
  std::string energy = "symmetric-dirichlet";
  int threads = 1;
  bool no_cm = false;
  app.add_option("MESH", meshes, "Disks to flatten; the bust of examples/data by default");
  app.add_option("--faces", faces, "Refine smaller meshes to about this many faces first");
  app.add_option("--energy", energy,
                 "symmetric-dirichlet, symmetric-arap or exponential-dirichlet");
  app.add_option("--threads", threads, "Threads to use");
  app.add_flag("--no-cm", no_cm, "Leave out CM on the full mesh, which takes the longest");
  Records records("modes");
  return beltrami::benchmarks::run(app, argc, argv, records, [&] {
    const std::int32_t kind = energy == "symmetric-arap" ? BELTRAMI_ENERGY_SYMMETRIC_ARAP
                              : energy == "exponential-dirichlet"
                                  ? BELTRAMI_ENERGY_EXPONENTIAL_DIRICHLET
                                  : BELTRAMI_ENERGY_SYMMETRIC_DIRICHLET;
    std::printf("%s, %d thread(s), energy %s\n", beltrami_build_info(), threads, energy.c_str());
    for (const std::string& mesh : meshes) {
      benchmark(mesh, faces, !no_cm, kind, threads, records);
    }
    return 0;
  });
}
