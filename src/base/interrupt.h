// How a request to cancel reaches the loops of a run. A Checkpoint is for the steps of a stage,
// with their progress; this is for the sweeps inside a step, which take seconds on the largest
// meshes.
#pragma once

#include <atomic>

namespace beltrami {

/// Makes `cancelled` what poll_interrupt() of this thread looks at, until destruction. Scopes nest:
/// a progress callback may run another context.
class InterruptScope {
 public:
  explicit InterruptScope(const std::atomic<bool>& cancelled);
  ~InterruptScope();
  InterruptScope(const InterruptScope&) = delete;
  InterruptScope& operator=(const InterruptScope&) = delete;

 private:
  const std::atomic<bool>* outer_;
};

/// Throws Error CANCELLED if the run on this thread is to end. Costs a few nanoseconds, and nothing
/// happens outside a run, or on the other threads of a parallel loop. parallel_for calls it before
/// each chunk; loops of their own of more than some ten milliseconds should, too.
void poll_interrupt();

}  // namespace beltrami
