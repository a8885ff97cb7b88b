// The whole pipeline against one sparse solve: its cost in Um and Ua, which are measured beside it
// in the same process, round by round; how it grows with the mesh; its stages, memory and energy.
//
// Um is what stock CHOLMOD (supernodal, METIS) takes to analyze, factorize and solve twice the
// cotan Laplacian of the same mesh on one thread, Ua the same with AMD. Costs are CPU seconds of
// beltrami_set_mesh and beltrami_run together, the best of some rounds. Only ratios carry from
// machine to machine.
#include <beltrami/beltrami.h>
#include <malloc.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "commands/command.h"
#include "process_memory.h"
#include "records.h"
#include "refine.h"
#include "yardstick.h"

namespace beltrami::benchmarks {
namespace {

/// What memory is in use, and from where on a new peak counts.
double start_of_peak() {
  malloc_trim(0);
  reset_peak();
  return memory_of_process("VmRSS");
}

struct Run {
  double cpu = 0, wall = 0, load_cpu = 0;
  double energy = 0;
  double bytes_per_vertex = 0;  ///< the caller's arrays in and out included
  unsigned long long flips = 0, crossings = 0;
  std::vector<std::pair<std::string, double>> stages;  ///< CPU seconds, loading included
};

void require(beltrami_status status, beltrami_context* context) {
  if (status < 0) throw std::runtime_error(beltrami_error_message(context));
}

Run run_pipeline(const TriangleMesh& file, std::int32_t method, int threads) {
  const double before = start_of_peak();
  beltrami_context* raw = nullptr;
  beltrami_create(&raw);
  const std::unique_ptr<beltrami_context, void (*)(beltrami_context*)> context(raw,
                                                                               beltrami_destroy);
  beltrami_set_int(raw, BELTRAMI_OPTION_THREADS, threads);
  beltrami_set_int(raw, BELTRAMI_OPTION_METHOD, method);
  const beltrami_mesh mesh = cli::view_of(file.view());
  Run run;
  const double cpu = seconds(CLOCK_PROCESS_CPUTIME_ID), wall = seconds(CLOCK_MONOTONIC);
  require(beltrami_set_mesh(raw, &mesh), raw);
  run.load_cpu = seconds(CLOCK_PROCESS_CPUTIME_ID) - cpu;
  require(beltrami_run(raw, nullptr, nullptr), raw);
  run.cpu = seconds(CLOCK_PROCESS_CPUTIME_ID) - cpu;
  run.wall = seconds(CLOCK_MONOTONIC) - wall;
  std::vector<double> uvs(2 * file.vertex_count());
  require(beltrami_get_uvs(raw, uvs.data(), BELTRAMI_F64, 0), raw);

  const double vertices = static_cast<double>(file.vertex_count());
  const double input = 24 * vertices + 12 * static_cast<double>(file.face_count());
  run.bytes_per_vertex = (memory_of_process("VmHWM") - before + input) / vertices;
  beltrami_energy energy{};
  energy.struct_size = sizeof energy;
  beltrami_get_energy(raw, &energy);
  run.energy = energy.symmetric_dirichlet;
  beltrami_certificate certificate{};
  certificate.struct_size = sizeof certificate;
  beltrami_get_certificate(raw, &certificate);
  run.flips = certificate.negative + certificate.degenerate;
  run.crossings = certificate.boundary_crossings;
  run.stages.emplace_back("load", run.load_cpu);
  for (int i = 0; i < beltrami_stage_count(raw); ++i) {
    beltrami_stage stage{};
    stage.struct_size = sizeof stage;
    beltrami_get_stage(raw, i, &stage);
    const auto same = std::find_if(run.stages.begin(), run.stages.end(),
                                   [&](const auto& s) { return s.first == stage.name; });
    if (same == run.stages.end()) {
      run.stages.emplace_back(stage.name, stage.cpu_seconds);
    } else {
      same->second += stage.cpu_seconds;
    }
  }
  return run;
}

/// What is measured of one mesh at one size.
struct Figures {
  Run one, two;
  double um = 0, ua = 0;  ///< CPU seconds; 0 without CHOLMOD
  double cm_cpu = 0, cm_energy = 0;
};

void keep_best(Run& best, Run run) {
  if (best.cpu == 0 || run.cpu < best.cpu) {
    run.wall = best.cpu == 0 ? run.wall : std::min(best.wall, run.wall);
    best = std::move(run);
  } else {
    best.wall = std::min(best.wall, run.wall);
  }
}

Figures measure_mesh(const TriangleMesh& mesh, int rounds, bool with_cm) {
  Figures figures;
  for (int round = 0; round < rounds; ++round) {
#ifdef BELTRAMI_WITH_CHOLMOD
    {
      const System system = interior_laplacian(mesh, Numbering::kOfFile);
      const double um = run_cholmod(system, Unit::kUm).total();
      const double ua = run_cholmod(system, Unit::kUa).total();
      figures.um = round == 0 ? um : std::min(figures.um, um);
      figures.ua = round == 0 ? ua : std::min(figures.ua, ua);
    }
#endif
    // By turns, since whichever comes second finds warmer memory.
    for (const int threads : {1 + round % 2, 2 - round % 2}) {
      keep_best(threads == 1 ? figures.one : figures.two,
                run_pipeline(mesh, BELTRAMI_METHOD_BELTRAMI, threads));
    }
  }
  if (with_cm) {
    const Run cm = run_pipeline(mesh, BELTRAMI_METHOD_CM, 1);
    figures.cm_cpu = cm.cpu;
    figures.cm_energy = cm.energy;
  }
  return figures;
}

Json ratio(double a, double b) {
  return b > 0 ? Json(a / b) : Json();
}

std::string cell(const Json& number, const char* format) {
  if (number.is_null()) return "-";
  char text[32];
  std::snprintf(text, sizeof text, format, number.get<double>());
  return text;
}

void print(const Json& row) {
  std::printf("%9llu %7.2f %6s %6s %8.4f %8s %7s %6.2f %7s %7.0f %5llu\n",
              row["faces"].get<unsigned long long>(), row["cpu_seconds"].get<double>(),
              cell(row["cost_um"], "%.2f").c_str(), cell(row["cost_ua"], "%.2f").c_str(),
              row["energy"].get<double>(), cell(row["energy_over_cm"], "%.4f").c_str(),
              cell(row["cost_over_cm"], "%.3f").c_str(), row["speedup_2_threads"].get<double>(),
              cell(row["growth_exponent"], "%.2f").c_str(), row["bytes_per_vertex"].get<double>(),
              row["flips"].get<unsigned long long>());
  std::printf("%9s", "");
  for (const auto& [stage, share] : row["stage_shares"].items()) {
    std::printf(" %s %.0f%%", stage.c_str(), 100 * share.get<double>());
  }
  std::printf("\n");
  std::fflush(stdout);
}

void benchmark(const std::string& path, const std::vector<std::uint64_t>& sizes, int rounds,
               std::uint64_t cm_faces, Records& records) {
  const std::string name = std::filesystem::path(path).stem().string();
  std::printf("\n%s\n%9s %7s %6s %6s %8s %8s %7s %6s %7s %7s %5s\n", name.c_str(), "faces", "cpu s",
              "/ Um", "/ Ua", "E", "E / CM", "/ CM", "2 thr.", "growth", "B/vert", "flips");
  const TriangleMesh base = read_triangles(path);
  double last_cost = 0, last_faces = 0;
  for (const std::uint64_t faces : sizes) {
    const TriangleMesh mesh = faces > base.face_count() ? refine(base, faces) : base;
    const Figures f = measure_mesh(mesh, rounds, mesh.face_count() <= cm_faces);
    const double count = static_cast<double>(mesh.face_count());
    Json shares = Json::object();
    for (const auto& [stage, cpu] : f.one.stages) shares[stage] = cpu / f.one.cpu;
    const Json growth = last_cost > 0
                            ? Json(std::log(f.one.cpu / last_cost) / std::log(count / last_faces))
                            : Json();
    const Json row = {{"mesh", name},
                      {"faces", mesh.face_count()},
                      {"cpu_seconds", f.one.cpu},
                      {"wall_seconds", f.one.wall},
                      {"um_seconds", f.um},
                      {"ua_seconds", f.ua},
                      {"cost_um", ratio(f.one.cpu, f.um)},
                      {"cost_ua", ratio(f.one.cpu, f.ua)},
                      {"energy", f.one.energy},
                      {"energy_over_cm", ratio(f.one.energy, f.cm_energy)},
                      {"cost_over_cm", ratio(f.one.cpu, f.cm_cpu)},
                      {"speedup_2_threads", f.one.wall / f.two.wall},
                      {"growth_exponent", growth},
                      {"bytes_per_vertex", f.one.bytes_per_vertex},
                      {"flips", f.one.flips},
                      {"boundary_crossings", f.one.crossings},
                      {"stage_shares", shares}};
    print(row);
    records.add(row);
    last_cost = f.one.cpu;
    last_faces = count;
  }
}

}  // namespace
}  // namespace beltrami::benchmarks

int main(int argc, char** argv) {
  CLI::App app(
      "The whole pipeline on MESH... refined to some sizes, in units of one sparse solve (Um, "
      "Ua).");
  std::vector<std::string> meshes = {BELTRAMI_EXAMPLE_MESH};
  std::vector<std::uint64_t> sizes = {100000, 300000, 1000000, 3000000};
  int rounds = 3;
  std::uint64_t cm_faces = 300000;
  app.add_option("MESH", meshes, "Disks; the bust of examples/data by default");
  app.add_option("--faces", sizes, "Refine to about so many faces");
  app.add_option("--rounds", rounds, "The best of so many counts");
  app.add_option("--cm-faces", cm_faces, "Run CM beside it on meshes of up to so many faces");
  beltrami::benchmarks::Records records("pipeline");
  return beltrami::benchmarks::run(app, argc, argv, records, [&] {
    std::printf("%s\n", beltrami_build_info());
    for (const std::string& mesh : meshes) {
      beltrami::benchmarks::benchmark(mesh, sizes, rounds, cm_faces, records);
    }
    return 0;
  });
}
