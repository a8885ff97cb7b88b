// What the loops of a run are made of, to see how it would scale on processors that are not there.
#pragma once

#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "base/resources.h"

namespace beltrami {

/// Takes the place of threads: parallel loops run on the caller's alone, as they would be divided
/// among the threads of the run, and tell how long each of their chunks took. Loops within the
/// chunks of another count as a part of these.
class LoopTrace {
 public:
  /// Called after each loop with the stage that it belongs to, or "" between stages, and the CPU
  /// seconds of its chunks, in the order in which they are handed out.
  using Listener = std::function<void(const char* stage, const std::vector<double>& chunks)>;

  explicit LoopTrace(Listener listener) : listener_(std::move(listener)) {}

  /// Whether a loop is under way, so that this one is within a chunk of it.
  bool is_inside() const { return inside_; }

  /// The loops to come belong to `stage`; returns the one before.
  const char* enter(const char* stage) { return std::exchange(stage_, stage); }

  /// Runs chunk(i) for i in [0, count).
  template <class Chunk>
  void run(std::int64_t count, const Chunk& chunk) {
    std::vector<double> seconds(static_cast<std::size_t>(count));
    inside_ = true;
    try {
      // The end of a chunk is the beginning of the next one: what the clock costs is not serial.
      double begin = cpu_seconds();
      for (std::int64_t i = 0; i < count; ++i) {
        chunk(i);
        const double end = cpu_seconds();
        seconds[static_cast<std::size_t>(i)] = end - std::exchange(begin, end);
      }
    } catch (...) {
      inside_ = false;
      throw;
    }
    inside_ = false;
    listener_(stage_, seconds);
  }

 private:
  Listener listener_;
  const char* stage_ = "";
  bool inside_ = false;
};

}  // namespace beltrami
