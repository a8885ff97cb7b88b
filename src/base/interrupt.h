// How a request to cancel reaches the loops of a run. Work::report is for the steps of a stage,
// with their progress; this is for the sweeps inside a step, which take seconds on the largest
// meshes.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <functional>

namespace beltrami {

/// Thrown where work is to end on request. No Error, and no std::exception: a handler that makes up
/// for a failure, or puts it in other words, must not take it for one. Only the ABI catches it.
class Cancelled {};

/// Where poll_interrupt() looks. Each may be missing.
struct InterruptSource {
  const std::atomic<bool>* request = nullptr;  ///< set from any thread, looked at by all workers
  const std::int32_t* number = nullptr;        ///< likewise, in the host's memory: 0 to go on
  std::function<bool()> ask;  ///< called on the thread of the scope only; true to cancel
};

/// Makes `source` what poll_interrupt() of this thread looks at, until destruction. Scopes nest,
/// as a progress callback may run another context: the innermost one counts.
class InterruptScope {
 public:
  explicit InterruptScope(InterruptSource source);
  explicit InterruptScope(const std::atomic<bool>* request)
      : InterruptScope(InterruptSource{request, nullptr, {}}) {}
  ~InterruptScope();
  InterruptScope(const InterruptScope&) = delete;
  InterruptScope& operator=(const InterruptScope&) = delete;

 private:
  const InterruptSource source_;
  const InterruptSource* const outer_;
};

/// What workers are to look at on behalf of this thread; nothing outside a run.
InterruptSource interrupt_for_workers();

/// Throws Cancelled if the work on this thread is to end. Costs a few nanoseconds; does nothing
/// outside a run. parallel_for calls it before each chunk; serial loops of more than some ten
/// milliseconds should, too.
void poll_interrupt();

/// Polls at every so many calls, for loops whose steps are too short to poll at each.
class PollSometimes {
 public:
  void operator()() {
    if (++calls_ % kPeriod == 0) poll_interrupt();
  }

 private:
  static constexpr unsigned kPeriod = 4096;
  unsigned calls_ = 0;
};

/// std::sort that polls.
template <class Iterator, class Less>
void sort_interruptibly(Iterator begin, Iterator end, const Less& less) {
  PollSometimes poll;
  std::sort(begin, end, [&](const auto& a, const auto& b) {
    poll();
    return less(a, b);
  });
}

}  // namespace beltrami
