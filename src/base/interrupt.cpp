#include "base/interrupt.h"

#include <utility>

namespace beltrami {
namespace {

/// Of the run that this thread is in. Not a parameter, since it would go through every function
/// down to the loops; not shared, since a thread is in one run at a time.
thread_local const InterruptSource* current = nullptr;

}  // namespace

InterruptScope::InterruptScope(InterruptSource source)
    : source_(std::move(source)), outer_(current) {
  current = &source_;
}

InterruptScope::~InterruptScope() {
  current = outer_;
}

const std::atomic<bool>* interrupt_request() {
  return current != nullptr ? current->request : nullptr;
}

void poll_interrupt() {
  if (current == nullptr) return;
  const bool requested =
      current->request != nullptr && current->request->load(std::memory_order_relaxed);
  if (requested || (current->ask && current->ask())) throw Cancelled();
}

}  // namespace beltrami
