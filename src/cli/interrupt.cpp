#include "interrupt.h"

#include <atomic>
#include <csignal>
#include <cstdlib>

#include "failure.h"

namespace beltrami::cli {
namespace {

// A handler reaches globals only; these are lock-free, which is what makes them safe there.
std::atomic<int> signals{0};
std::atomic<beltrami_context*> target{nullptr};
static_assert(std::atomic<beltrami_context*>::is_always_lock_free);

extern "C" void on_signal(int number) {
  std::signal(number, on_signal);  // some systems reset the handler
  // The first may be followed at once by a second: terminals and job runners both send one.
  if (signals.fetch_add(1) >= 2) std::_Exit(kExitCancelled);
  beltrami_cancel(target.load());
}

}  // namespace

void install_interrupt_handler() {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
}

bool interrupted() {
  return signals.load() > 0;
}

void throw_if_interrupted() {
  if (interrupted()) throw Failure(BELTRAMI_E_CANCELLED, "cancelled");
}

CancelOnInterrupt::CancelOnInterrupt(beltrami_context* context) {
  target.store(context);
}
CancelOnInterrupt::~CancelOnInterrupt() {
  target.store(nullptr);
}

}  // namespace beltrami::cli
