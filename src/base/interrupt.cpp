#include "base/interrupt.h"

#include <utility>

namespace beltrami {
namespace {

/// Of the run that this thread is in. Not a parameter, since it would go through every function
/// down to the loops; not shared, since a thread is in one run at a time.
thread_local const InterruptSource* current = nullptr;

std::int32_t load(const std::int32_t* number) {
  // Only read; an atomic_ref of constants comes with C++26.
  const std::atomic_ref<std::int32_t> shared(*const_cast<std::int32_t*>(number));
  return shared.load(std::memory_order_relaxed);
}

}  // namespace

InterruptScope::InterruptScope(InterruptSource source)
    : source_(std::move(source)), outer_(current) {
  current = &source_;
}

InterruptScope::~InterruptScope() {
  current = outer_;
}

InterruptSource interrupt_for_workers() {
  if (current == nullptr) return {};
  return {current->request, current->number, {}};
}

void poll_interrupt() {
  if (current == nullptr) return;
  const bool requested =
      current->request != nullptr && current->request->load(std::memory_order_relaxed);
  if (requested || (current->number != nullptr && load(current->number) != 0) ||
      (current->ask && current->ask()))
    throw Cancelled();
}

}  // namespace beltrami
