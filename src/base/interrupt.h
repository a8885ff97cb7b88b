// How a request to cancel reaches the loops of a run. A Checkpoint is for the steps of a stage,
// with their progress; this is for the sweeps inside a step, which take seconds on the largest
// meshes.
#pragma once

#include <atomic>

namespace beltrami {

/// Makes `request` what poll_interrupt() of this thread looks at, until destruction. Scopes nest,
/// as a progress callback may run another context.
class InterruptScope {
 public:
  explicit InterruptScope(const std::atomic<bool>* request);
  ~InterruptScope();
  InterruptScope(const InterruptScope&) = delete;
  InterruptScope& operator=(const InterruptScope&) = delete;

 private:
  const std::atomic<bool>* outer_;
};

/// What poll_interrupt() of this thread looks at, to pass on to workers; null outside a run.
const std::atomic<bool>* interrupt_request();

/// Throws Error CANCELLED if the run on this thread is to end. Costs a few nanoseconds; does
/// nothing outside a run. parallel_for calls it before each chunk; serial loops of more than some
/// ten milliseconds should, too.
void poll_interrupt();

}  // namespace beltrami
