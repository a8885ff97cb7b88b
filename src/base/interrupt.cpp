#include "base/interrupt.h"

#include "base/error.h"

namespace beltrami {
namespace {

/// Of the run that this thread is in. Not a parameter, since it would go through every function
/// down to the loops; not shared, since a thread is in one run at a time.
thread_local const std::atomic<bool>* current = nullptr;

}  // namespace

InterruptScope::InterruptScope(const std::atomic<bool>* request) : outer_(current) {
  current = request;
}

InterruptScope::~InterruptScope() {
  current = outer_;
}

const std::atomic<bool>* interrupt_request() {
  return current;
}

void poll_interrupt() {
  if (current != nullptr && current->load(std::memory_order_relaxed)) {
    throw Error(BELTRAMI_E_CANCELLED, "the run was cancelled");
  }
}

}  // namespace beltrami
