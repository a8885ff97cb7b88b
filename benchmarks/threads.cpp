// How a run would scale: the chunks of all parallel loops of one run are timed on one thread, and
// handed out again to as many threads as are asked for, each to the one that is free first. What
// lies between the loops is serial. No limit of the memory's bandwidth and no cost of starting
// threads is counted, so that these are bounds; what two threads really take stands beside them.
#include <beltrami/beltrami.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <map>
#include <queue>
#include <string>
#include <utility>
#include <vector>

#include "abi/context.h"
#include "base/loop_trace.h"
#include "base/work.h"
#include "chart/flatten_disk.h"
#include "chart/flattening.h"
#include "multilevel/chart_map.h"
#include "multilevel/options.h"
#include "records.h"
#include "refine.h"
#include "yardstick.h"

namespace beltrami::benchmarks {
namespace {

/// When the last of the chunks would end.
double simulated(const std::vector<double>& chunks, int threads) {
  std::priority_queue<double, std::vector<double>, std::greater<>> free_at;
  for (int i = 0; i < threads; ++i) free_at.push(0);
  double end = 0;
  for (const double seconds : chunks) {
    const double done = free_at.top() + seconds;
    free_at.pop();
    free_at.push(done);
    end = std::max(end, done);
  }
  return end;
}

struct StageTimes {
  double work = 0;                ///< CPU seconds
  double in_loops = 0, span = 0;  ///< of these: in chunks; in the longest one of each loop
  std::vector<double> loops;      ///< per number of threads
  int chunks = 0;

  double serial() const { return std::max(0.0, work - in_loops); }
};

using Times = std::map<std::string, StageTimes>;

/// What is done outside of the stages.
constexpr const char* kBetween = "between";

/// Loads and flattens the mesh as the library does for its callers.
Flattening run_stages(const TriangleMesh& file, const Work& work, double& load) {
  const double begin = seconds(CLOCK_PROCESS_CPUTIME_ID);
  const Work loading = work.part(0, 0).named("load");
  if (work.trace()) work.trace()->enter("load");
  beltrami_mesh mesh{};
  mesh.struct_size = sizeof mesh;
  mesh.vertex_count = file.vertex_count();
  mesh.face_count = file.face_count();
  mesh.positions = {file.positions.data(), 0, BELTRAMI_F64, 0};
  mesh.indices = {file.faces.data(), 0, BELTRAMI_U32, 0};
  const LoadedMesh loaded = load_mesh(&mesh, loading, std::atomic<bool>{false});
  load = seconds(CLOCK_PROCESS_CPUTIME_ID) - begin;
  if (work.trace()) work.trace()->enter("");
  return flatten(loaded.input.disk, loaded.frame, ChartOptions{}, work);
}

/// `order`: of the stages, as they first begin.
Times trace_run(const TriangleMesh& file, const std::vector<int>& threads,
                std::vector<std::string>& order) {
  Times times;
  LoopTrace trace([&](const char* stage, const std::vector<double>& chunks) {
    StageTimes& of = times[*stage == '\0' ? kBetween : stage];
    of.loops.resize(threads.size());
    double longest = 0;
    for (const double time : chunks) {
      of.in_loops += time;
      longest = std::max(longest, time);
    }
    of.span += longest;
    of.chunks += static_cast<int>(chunks.size());
    for (std::size_t i = 0; i < threads.size(); ++i) of.loops[i] += simulated(chunks, threads[i]);
  });
  const int most = *std::max_element(threads.begin(), threads.end());
  double load = 0;
  const double begin = seconds(CLOCK_PROCESS_CPUTIME_ID);
  const Flattening done = run_stages(file, Work({.threads = most, .trace = &trace}, nullptr), load);
  double between = seconds(CLOCK_PROCESS_CPUTIME_ID) - begin - load;
  order = {"load"};
  times["load"].work = load;
  for (const StageStatistics& stage : done.statistics.stages) {
    if (std::find(order.begin(), order.end(), stage.name) == order.end()) {
      order.emplace_back(stage.name);
    }
    times[stage.name].work += stage.cpu_seconds;
    between -= stage.cpu_seconds;
  }
  order.emplace_back(kBetween);
  times[kBetween].work = between;
  for (auto& [name, of] : times) of.loops.resize(threads.size());
  return times;
}

/// Wall seconds of a run on so many threads.
double measured(const TriangleMesh& file, int threads) {
  const double begin = seconds(CLOCK_MONOTONIC);
  double load = 0;
  run_stages(file, Work(threads), load);
  return seconds(CLOCK_MONOTONIC) - begin;
}

void print_row(const char* name, const StageTimes& of, const std::vector<int>& threads) {
  std::printf("%-10s %8.3f %8.3f %8.4f", name, of.work, of.serial(), of.serial() + of.span);
  for (std::size_t i = 0; i < threads.size(); ++i) {
    std::printf(" %8.2f", of.work / (of.serial() + of.loops[i]));
  }
  std::printf("\n");
}

void benchmark(const std::string& path, std::uint64_t faces, const std::vector<int>& threads,
               int rounds, Records& records) {
  auto mesh = read_triangles(path);
  if (faces > mesh.face_count()) mesh = refine(mesh, faces);
  std::vector<std::string> order;
  const Times times = trace_run(mesh, threads, order);
  const std::string name = std::filesystem::path(path).stem().string();
  std::printf("%s, %llu faces\n%-10s %8s %8s %8s", name.c_str(),
              static_cast<unsigned long long>(mesh.face_count()), "stage", "work s", "serial s",
              "span s");
  for (const int count : threads) std::printf(" %7dx", count);
  std::printf("\n");
  StageTimes all;
  all.loops.resize(threads.size());
  Json stages = Json::object();
  for (const std::string& stage : order) {
    const StageTimes& of = times.at(stage);
    print_row(stage.c_str(), of, threads);
    all.work += of.work;
    all.in_loops += std::min(of.in_loops, of.work);
    all.span += of.span;
    for (std::size_t i = 0; i < threads.size(); ++i) all.loops[i] += of.loops[i];
    stages[stage] = {{"work", of.work}, {"serial", of.serial()}, {"span", of.serial() + of.span}};
  }
  print_row("all", all, threads);
  double one = 0, two = 0;
  for (int round = 0; round < rounds; ++round) {
    const double once = measured(mesh, 1), twice = measured(mesh, 2);
    one = round == 0 ? once : std::min(one, once);
    two = round == 0 ? twice : std::min(two, twice);
  }
  std::printf("measured on two threads: %.2f times as fast (%.2f s, %.2f s)\n\n", one / two, one,
              two);
  std::fflush(stdout);
  Json row = {{"mesh", name},           {"faces", mesh.face_count()},      {"work", all.work},
              {"serial", all.serial()}, {"span", all.serial() + all.span}, {"stages", stages},
              {"measured_2", one / two}};
  for (std::size_t i = 0; i < threads.size(); ++i) {
    row["simulated_" + std::to_string(threads[i])] = all.work / (all.serial() + all.loops[i]);
  }
  records.add(std::move(row));
}

}  // namespace
}  // namespace beltrami::benchmarks

int main(int argc, char** argv) {
  CLI::App app(
      "Flattens MESH..., refined to some size, and says how it would scale: work, what of it is "
      "serial, span (with threads without end) and the simulated speed-up on some numbers of "
      "threads, stage by stage.");
  std::vector<std::string> meshes = {BELTRAMI_EXAMPLE_MESH};
  std::vector<int> threads = {2, 4, 16, 64};
  std::uint64_t faces = 1000000;
  int rounds = 2;
  app.add_option("MESH", meshes, "Disks; the bust of examples/data by default");
  app.add_option("--faces", faces, "Refine smaller meshes to about so many faces")
      ->capture_default_str();
  app.add_option("--threads", threads, "Numbers of threads to simulate")
      ->check(CLI::PositiveNumber);
  app.add_option("--rounds", rounds, "The best of so many counts, for what is measured")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  beltrami::benchmarks::Records records("threads");
  return beltrami::benchmarks::run(app, argc, argv, records, [&] {
    for (const std::string& mesh : meshes) {
      beltrami::benchmarks::benchmark(mesh, faces, threads, rounds, records);
    }
    return 0;
  });
}
