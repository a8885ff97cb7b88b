#include "process/interrupt.h"

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <initializer_list>

#include "process/failure.h"
#include "process/leftovers.h"

namespace beltrami::cli {
namespace {

// A handler reaches globals only; these are lock-free, which is what makes them safe there.
std::atomic<int> signals{0};
alignas(std::atomic_ref<std::int32_t>::required_alignment) std::int32_t number_for_library = 0;
std::atomic<beltrami_context*> target{nullptr};
static_assert(std::atomic<beltrami_context*>::is_always_lock_free);

/// The process looks on when it next can.
void ask_for_an_end() {
  // The first may be followed at once by a second: terminals and job runners both send one.
  if (signals.fetch_add(1) >= 2) {
    remove_leftovers();
    std::_Exit(kExitCancelled);
  }
  std::atomic_ref(number_for_library).store(1);
  beltrami_cancel(target.load());
}

#if defined(_WIN32)

extern "C" void on_request(int number) {
  std::signal(number, on_request);  // the system resets the handler
  ask_for_an_end();
}

#else

extern "C" void on_request(int) {
  const int number = errno;
  ask_for_an_end();
  errno = number;
}

extern "C" void on_death(int number) {
  remove_leftovers();
  raise(number);  // its own action is back in place, and follows once this handler has returned
}

/// Leaves alone what is not at its default: ignored by the parent, or handled by a sanitizer.
void replace_default(int number, void (*handler)(int), int flags) {
  struct sigaction action {};
  if (sigaction(number, nullptr, &action) != 0) return;
  if ((action.sa_flags & SA_SIGINFO) != 0 || action.sa_handler != SIG_DFL) return;
  action = {};
  action.sa_handler = handler;
  // No SA_RESTART: system calls that wait must come back, so that a request is heard.
  action.sa_flags = flags;
  sigaction(number, &action, nullptr);
}

#endif

}  // namespace

void install_signal_handlers() {
#if defined(_WIN32)
  std::signal(SIGINT, on_request);
  std::signal(SIGTERM, on_request);
#else
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGXCPU}) {
    replace_default(number, on_request, 0);
  }
  for (const int number : {SIGQUIT, SIGABRT, SIGALRM, SIGBUS, SIGFPE, SIGILL, SIGPROF, SIGSEGV,
                           SIGSYS, SIGTRAP, SIGUSR1, SIGUSR2, SIGVTALRM}) {
    replace_default(number, on_death, static_cast<int>(SA_RESETHAND));
  }
  for (const int number : {SIGPIPE, SIGXFSZ}) replace_default(number, SIG_IGN, 0);
#endif
}

const std::int32_t* interrupt_number() {
  return &number_for_library;
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
