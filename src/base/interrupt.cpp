#include "base/interrupt.h"

#include "base/error.h"

namespace beltrami {
namespace {

/// Of the run that this thread is in. Not a parameter, since it would go through every function
/// down to the loops; not shared, since a thread is in one run at a time.
thread_local const std::atomic<bool>* request = nullptr;

}  // namespace

InterruptScope::InterruptScope(const std::atomic<bool>& cancelled) : outer_(request) {
  request = &cancelled;
}

InterruptScope::~InterruptScope() {
  request = outer_;
}

void poll_interrupt() {
  if (request != nullptr && request->load(std::memory_order_relaxed)) {
    throw Error(BELTRAMI_E_CANCELLED, "the run was cancelled");
  }
}

}  // namespace beltrami
