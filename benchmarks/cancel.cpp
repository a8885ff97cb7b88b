// How long a run goes on after beltrami_cancel, stage by stage.
//
// The first run notes when the library looks for a request: at each call of the progress callback.
// Then, for each stage, another thread cancels at the worst moment, right after the look that
// begins the stage's longest pause, and the time until beltrami_run returns is the latency. Wall
// time, so the machine should have nothing else to do.
#include <beltrami/beltrami.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "mesh_file.h"
#include "refine.h"

namespace {

using Clock = std::chrono::steady_clock;
using Context = std::unique_ptr<beltrami_context, void (*)(beltrami_context*)>;

double milliseconds(Clock::duration time) {
  return std::chrono::duration<double, std::milli>(time).count();
}

struct Look {
  Clock::time_point when;
  std::string stage;
};

std::int32_t note_look(void* user, double, const char* stage) {
  static_cast<std::vector<Look>*>(user)->push_back({Clock::now(), stage});
  return 0;
}

/// Cancels from a thread of its own, as soon as the run has looked `at` + 1 times.
class Canceller {
 public:
  Canceller(beltrami_context* context, std::size_t at)
      : context_(context), at_(at), thread_([this] { wait_and_cancel(); }) {}

  static std::int32_t count_look(void* user, double, const char*) {
    auto& self = *static_cast<Canceller*>(user);
    if (self.looks_++ == self.at_) {
      const std::lock_guard<std::mutex> lock(self.guard_);
      self.due_ = true;
      self.wake_.notify_one();
    }
    return 0;
  }

  /// When the request was made. Call it after the run.
  Clock::time_point requested() {
    {
      const std::lock_guard<std::mutex> lock(guard_);
      due_ = true;
    }
    wake_.notify_one();
    thread_.join();
    return requested_;
  }

 private:
  void wait_and_cancel() {
    std::unique_lock<std::mutex> lock(guard_);
    wake_.wait(lock, [&] { return due_; });
    lock.unlock();
    // The run must leave the look itself before it can miss the request.
    std::this_thread::sleep_for(std::chrono::microseconds(200));
    requested_ = Clock::now();
    beltrami_cancel(context_);
  }

  beltrami_context* context_;
  std::size_t at_, looks_ = 0;
  std::mutex guard_;
  std::condition_variable wake_;
  bool due_ = false;
  Clock::time_point requested_;
  std::thread thread_;
};

struct StagePauses {
  std::string name;
  std::size_t looks = 0, before_longest = 0;
  double total = 0, longest = 0;
};

std::vector<StagePauses> pauses_of(const std::vector<Look>& looks, Clock::time_point end) {
  std::vector<StagePauses> stages;
  for (std::size_t i = 0; i < looks.size(); ++i) {
    auto stage = std::find_if(stages.begin(), stages.end(),
                              [&](const StagePauses& s) { return s.name == looks[i].stage; });
    if (stage == stages.end()) stage = stages.insert(stages.end(), StagePauses{looks[i].stage});
    const Clock::time_point next = i + 1 < looks.size() ? looks[i + 1].when : end;
    const double pause = milliseconds(next - looks[i].when);
    ++stage->looks;
    stage->total += pause;
    if (pause > stage->longest) {
      stage->longest = pause;
      stage->before_longest = i;
    }
  }
  return stages;
}

void measure(beltrami_context* context, double noteworthy) {
  std::vector<Look> looks;
  const beltrami_status status = beltrami_run(context, note_look, &looks);
  const Clock::time_point end = Clock::now();
  if (status < 0) throw std::runtime_error(beltrami_error_message(context));

  std::printf("\npauses above %.0f ms\n", noteworthy);
  for (std::size_t i = 0; i < looks.size(); ++i) {
    const Clock::time_point next = i + 1 < looks.size() ? looks[i + 1].when : end;
    const double pause = milliseconds(next - looks[i].when);
    if (pause > noteworthy) {
      std::printf("  look %4zu  %-10s %8.0f ms\n", i, looks[i].stage.c_str(), pause);
    }
  }

  std::printf("\n%-12s %10s %8s %16s %12s\n", "stage", "total ms", "looks", "longest pause ms",
              "latency ms");
  for (const StagePauses& stage : pauses_of(looks, end)) {
    Canceller canceller(context, stage.before_longest);
    const beltrami_status cancelled = beltrami_run(context, Canceller::count_look, &canceller);
    const Clock::time_point returned = Clock::now();
    const Clock::time_point requested = canceller.requested();
    std::printf("%-12s %10.0f %8zu %16.1f ", stage.name.c_str(), stage.total, stage.looks,
                stage.longest);
    if (cancelled == BELTRAMI_E_CANCELLED) {
      std::printf("%12.1f\n", milliseconds(returned - requested));
    } else {
      std::printf("%12s\n", "ended first");
    }
    std::fflush(stdout);
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
  double noteworthy = 100;
  std::vector<std::string> options;
  app.add_option("MESH", path, "Disk to flatten; the bust of examples/data by default");
  app.add_option("--faces", faces, "Refine a smaller mesh to about this many faces first");
  app.add_option("--set", options, "Options of the library: --set threads=2 --set flatten=gif");
  app.add_option("--above", noteworthy, "List the pauses of more than this many milliseconds");
  CLI11_PARSE(app, argc, argv);
  try {
    auto file = beltrami::cli::read_mesh(path, beltrami::cli::Content::kSurface);
    if (faces > file.face_count()) file = beltrami::benchmarks::refine(file, faces);
    beltrami_context* raw = nullptr;
    if (beltrami_create(&raw) != BELTRAMI_OK) throw std::bad_alloc();
    const Context context(raw, beltrami_destroy);
    for (const std::string& option : options) set(raw, option);
    beltrami_mesh mesh{};
    mesh.struct_size = sizeof mesh;
    mesh.vertex_count = file.vertex_count();
    mesh.face_count = file.face_count();
    mesh.positions = {file.positions.data(), 0, BELTRAMI_F64, 0};
    mesh.indices = {file.faces.data(), 0, BELTRAMI_U32, 0};
    const Clock::time_point begin = Clock::now();
    if (beltrami_set_mesh(raw, &mesh) != BELTRAMI_OK) {
      throw std::runtime_error(beltrami_error_message(raw));
    }
    std::printf("%s\n%llu faces; beltrami_set_mesh, which cannot be cancelled, takes %.0f ms\n",
                beltrami_build_info(), static_cast<unsigned long long>(mesh.face_count),
                milliseconds(Clock::now() - begin));
    measure(raw, noteworthy);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "beltrami_cancel_bench: %s\n", error.what());
    return 2;
  }
  return 0;
}
