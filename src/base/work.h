// What a run may use and whom it answers to: one object, handed down to every stage.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "base/loop_trace.h"

namespace beltrami {

class Pool;

/// Called on the thread that runs the work; `fraction` in [0, 1] never decreases. Returns true to
/// cancel.
using Progress = std::function<bool(double fraction, const char* stage)>;

/// Bounds of a run.
struct Limits {
  int threads = 1;                ///< the caller's included
  std::int64_t memory_bytes = 0;  ///< that its estimate is to stay within; 0: any number
  double seconds = 0;             ///< of wall time from its start; 0: any number
  LoopTrace* trace = nullptr;     ///< loops are watched instead of shared; outlives the run
};

/// A share of a run: the part of the progress bar that it fills, and the limits of the whole.
/// Copies are cheap and belong to the same run. A stage calls report() with the share of *its* work
/// done, at least once per solver step, and asks out_of_time() before it begins a step that it can
/// do without; it need not know what it is a part of.
///
/// Functions take it as their last parameter; loops, which end with their body, as the first.
class Work {
 public:
  /// A run of its own that nobody watches, without limits but for the threads.
  explicit Work(int threads = 1);
  Work(const Limits& limits, Progress progress);

  int threads() const;                ///< for a loop of this share, the caller's included
  Pool& pool() const;                 ///< the threads of the run; parallel_for lends them
  LoopTrace* trace() const;           ///< or null
  bool on_avx2() const;               ///< what has_avx2() said, which is slow, when the run began
  std::int64_t memory_limit() const;  ///< bytes; 0: none

  /// Whether the time is up. Work that improves on what it has ends then, and keeps the best.
  bool out_of_time() const;

  /// Takes the progress to `fraction` of this share. Throws Cancelled where the run is to end.
  void report(double fraction) const;

  /// From `from` to `to` of this share, both in [0, 1].
  Work part(double from, double to) const;

  /// For a part too small to be shared or seen, and on threads of a loop: on one thread, without
  /// progress. report() still throws where the run is to end.
  Work aside() const;

  /// The same share without the limit of time: for what must be finished whenever it begins.
  Work untimed() const;

  /// The same share under the name that progress is reported with. `name` outlives the run.
  Work named(const char* name) const;

 private:
  struct Run;  // what all shares of a run have in common
  std::shared_ptr<Run> run_;
  double from_ = 0, to_ = 1;
  const char* name_ = "";
  bool aside_ = false, untimed_ = false;
};

}  // namespace beltrami
