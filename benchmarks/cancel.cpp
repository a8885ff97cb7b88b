// How long a run goes on after beltrami_cancel, stage by stage.
//
// A first run notes when each stage begins and ends. Then further runs are cancelled from another
// thread, at moments spread evenly over the stage; the time until beltrami_run returns is the
// latency, and counts for the stage that the run was in by then. Beside the wall time stands the
// CPU time of the run's thread, which is what the latency would be on a machine with nothing else
// to do.
#include <beltrami/beltrami.h>
#include <pthread.h>
#include <time.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "commands/command.h"
#include "records.h"
#include "refine.h"

using beltrami::benchmarks::Records;

namespace {

using Clock = std::chrono::steady_clock;
using Context = std::unique_ptr<beltrami_context, void (*)(beltrami_context*)>;

double milliseconds(Clock::duration time) {
  return std::chrono::duration<double, std::milli>(time).count();
}

/// CPU milliseconds that a thread has used.
double thread_cpu(pthread_t thread) {
  clockid_t clock;
  timespec time{};
  if (pthread_getcpuclockid(thread, &clock) != 0 || clock_gettime(clock, &time) != 0) return 0;
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

struct Look {
  Clock::time_point when;
  std::string stage;
};

std::int32_t note_look(void* user, double, const char* stage) {
  static_cast<std::vector<Look>*>(user)->push_back({Clock::now(), stage});
  return 0;
}

/// Cancels from a thread of its own, some time after the run has looked `at` + 1 times.
class Canceller {
 public:
  Canceller(beltrami_context* context, std::size_t at, Clock::duration after)
      : context_(context), at_(at), after_(after), thread_([this] { wait_and_cancel(); }) {}

  static std::int32_t count_look(void* user, double, const char* stage) {
    auto& self = *static_cast<Canceller*>(user);
    self.stage_ = stage;
    if (self.looks_++ == self.at_) self.release();
    return 0;
  }

  struct Request {
    Clock::time_point when;
    double run_cpu;  ///< milliseconds of the run's thread by then
    std::string stage;
  };

  /// Call it once, after the run.
  Request requested() {
    release();
    thread_.join();
    return {requested_, requested_cpu_, stage_then_};
  }

 private:
  void release() {
    const std::lock_guard<std::mutex> lock(guard_);
    due_ = true;
    wake_.notify_one();
  }

  void wait_and_cancel() {
    {
      std::unique_lock<std::mutex> lock(guard_);
      wake_.wait(lock, [&] { return due_; });
    }
    std::this_thread::sleep_for(after_);
    stage_then_ = stage_;
    requested_cpu_ = thread_cpu(run_);
    requested_ = Clock::now();
    beltrami_cancel(context_);
  }

  beltrami_context* context_;
  std::size_t at_, looks_ = 0;
  Clock::duration after_;
  std::atomic<const char*> stage_{""};  // names of stages are static
  const char* stage_then_ = "";
  std::mutex guard_;
  std::condition_variable wake_;
  bool due_ = false;
  Clock::time_point requested_;
  double requested_cpu_ = 0;
  const pthread_t run_ = pthread_self();  // it is the run's thread that builds this
  std::thread thread_;
};

struct Stage {
  std::string name;
  std::size_t first_look;
  Clock::time_point begin, end;
};

/// Stages that come several times are listed as often.
std::vector<Stage> stages_of(const std::vector<Look>& looks, Clock::time_point end) {
  std::vector<Stage> stages;
  for (std::size_t i = 0; i < looks.size(); ++i) {
    if (!stages.empty() && stages.back().name == looks[i].stage) continue;
    if (!stages.empty()) stages.back().end = looks[i].when;
    stages.push_back({looks[i].stage, i, looks[i].when, end});
  }
  return stages;
}

struct Latency {
  std::string stage;
  double wall, cpu;
};

/// Cancels a run `after` the begin of the stage. Nothing if the run ended first.
std::optional<Latency> cancel_in(beltrami_context* context, const Stage& stage,
                                 Clock::duration after) {
  Canceller canceller(context, stage.first_look, after);
  const beltrami_status status = beltrami_run(context, Canceller::count_look, &canceller);
  const Clock::time_point returned = Clock::now();
  const double cpu = thread_cpu(pthread_self());
  const Canceller::Request request = canceller.requested();
  if (status != BELTRAMI_E_CANCELLED) {
    beltrami_run(context, nullptr, nullptr);  // uses up the request, which came too late
    return std::nullopt;
  }
  return Latency{request.stage, milliseconds(returned - request.when), cpu - request.run_cpu};
}

void print_row(const Stage& stage, std::vector<Latency> latencies, Records& records) {
  const auto by_wall = [](const Latency& a, const Latency& b) { return a.wall < b.wall; };
  const auto by_cpu = [](const Latency& a, const Latency& b) { return a.cpu < b.cpu; };
  std::sort(latencies.begin(), latencies.end(), by_wall);
  const std::size_t middle = latencies.size() / 2;
  const double median = latencies[middle].wall, longest = latencies.back().wall;
  std::sort(latencies.begin(), latencies.end(), by_cpu);
  std::printf("%-10s %9.0f %8zu %12.1f %12.1f %12.1f %12.1f\n", stage.name.c_str(),
              milliseconds(stage.end - stage.begin), latencies.size(), median, longest,
              latencies[middle].cpu, latencies.back().cpu);
  records.add({{"stage", stage.name},
               {"cancels", latencies.size()},
               {"median_wall_ms", median},
               {"longest_wall_ms", longest},
               {"median_cpu_ms", latencies[middle].cpu},
               {"longest_cpu_ms", latencies.back().cpu}});
}

void measure(beltrami_context* context, int samples, const std::string& only, Records& records) {
  std::vector<Look> looks;
  const beltrami_status status = beltrami_run(context, note_look, &looks);
  const Clock::time_point end = Clock::now();
  if (status < 0) throw std::runtime_error(beltrami_error_message(context));
  const std::vector<Stage> stages = stages_of(looks, end);
  std::map<std::string, std::vector<Latency>> found;
  for (const Stage& stage : stages) {
    if (!only.empty() && stage.name != only) continue;
    for (int i = 0; i < samples; ++i) {
      const auto after = (stage.end - stage.begin) * (2 * i + 1) / (2 * samples);
      if (const auto latency = cancel_in(context, stage, after)) {
        found[latency->stage].push_back(*latency);
      }
    }
  }
  std::printf("\n%-10s %9s %8s %12s %12s %12s %12s\n", "stage", "stage ms", "cancels", "median ms",
              "longest ms", "median cpu", "longest cpu");
  std::set<std::string> printed;
  for (const Stage& stage : stages) {
    const std::vector<Latency>& latencies = found[stage.name];
    if (!latencies.empty() && printed.insert(stage.name).second)
      print_row(stage, latencies, records);
  }
}

void set(beltrami_context* context, const std::string& option) {
  const std::size_t equals = option.find('=');
  const std::int32_t key = beltrami_option_find(option.substr(0, equals).c_str());
  const std::string value = equals == std::string::npos ? "" : option.substr(equals + 1);
  beltrami_option_info info{};
  info.struct_size = sizeof info;
  if (beltrami_option_describe(key, &info) != BELTRAMI_OK || value.empty()) {
    throw std::runtime_error("cannot set " + option);
  }
  beltrami_status status = BELTRAMI_E_INVALID_ARGUMENT;
  if (info.type == BELTRAMI_TYPE_FLOAT) {
    status = beltrami_set_float(context, key, std::stod(value));
  } else if (info.type == BELTRAMI_TYPE_INT) {
    status = beltrami_set_int(context, key, std::stoll(value));
  }
  for (std::int32_t i = 0; const char* choice = beltrami_option_choice(key, i); ++i) {
    if (value == choice) status = beltrami_set_int(context, key, i);
  }
  if (status != BELTRAMI_OK) throw std::runtime_error(beltrami_error_message(context));
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Measures the latency of beltrami_cancel in every stage.");
  std::string path = BELTRAMI_EXAMPLE_MESH;
  std::uint64_t faces = 1000000;
  int samples = 5;
  std::string stage;
  std::vector<std::string> options;
  app.add_option("MESH", path, "Disk to flatten; the bust of examples/data by default");
  app.add_option("--faces", faces, "Refine a smaller mesh to about this many faces first");
  app.add_option("--set", options, "Options of the library: --set threads=2 --set flatten=gif");
  app.add_option("--samples", samples, "Runs to cancel in each stage");
  app.add_option("--stage", stage, "This stage only");
  Records records("cancel");
  return beltrami::benchmarks::run(app, argc, argv, records, [&] {
    auto file = beltrami::benchmarks::read_triangles(path);
    if (faces > file.face_count()) file = beltrami::benchmarks::refine(file, faces);
    beltrami_context* raw = nullptr;
    if (beltrami_create(&raw) != BELTRAMI_OK) throw std::bad_alloc();
    const Context context(raw, beltrami_destroy);
    for (const std::string& option : options) set(raw, option);
    const beltrami_mesh mesh = beltrami::cli::view_of(file.view());
    const Clock::time_point begin = Clock::now();
    if (beltrami_set_mesh(raw, &mesh) != BELTRAMI_OK) {
      throw std::runtime_error(beltrami_error_message(raw));
    }
    std::printf("%s\n%llu faces; beltrami_set_mesh takes %.0f ms\n", beltrami_build_info(),
                static_cast<unsigned long long>(mesh.face_count),
                milliseconds(Clock::now() - begin));
    measure(raw, samples, stage, records);
    return 0;
  });
}
