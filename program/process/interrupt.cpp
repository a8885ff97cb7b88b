#include "process/interrupt.h"

#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <initializer_list>

#if !defined(_WIN32)
#include <unistd.h>
#endif

#include "process/failure.h"
#include "process/leftovers.h"

namespace beltrami::cli {
namespace {

// A handler reaches globals only; these are lock-free, which is what makes them safe there.
std::atomic<int> signals{0};
alignas(std::atomic_ref<std::int32_t>::required_alignment) std::int32_t number_for_library = 0;
std::atomic<beltrami_context*> target{nullptr};
static_assert(std::atomic<beltrami_context*>::is_always_lock_free);

/// When the first signal came, in nanoseconds of a clock that only rises; 0 before.
std::atomic<std::int64_t> first_at{0};
static_assert(std::atomic<std::int64_t>::is_always_lock_free);

/// A terminal, a job runner and its shell each send a signal of one request: so many nanoseconds
/// after the first, a second one is of the same request.
constexpr std::int64_t kOneRequest = 250'000'000;
/// Seconds that a process has to end by itself once a second one of the same request has come.
constexpr unsigned kGrace = 1;

[[noreturn]] void end_now() {
  remove_leftovers();
  std::_Exit(kExitCancelled);
}

#if defined(_WIN32)

void end_within_grace() {}

#else

extern "C" void on_end_of_grace(int) {
  end_now();
}

void end_within_grace() {
  struct sigaction action {};
  action.sa_handler = on_end_of_grace;
  sigaction(SIGALRM, &action, nullptr);
  alarm(kGrace);
}

#endif

/// The process looks on when it next can; a second request does not wait for that.
void ask_for_an_end() {
  const std::int64_t now = std::chrono::steady_clock::now().time_since_epoch().count();
  std::int64_t first = 0;
  if (!first_at.compare_exchange_strong(first, now)) {
    if (now - first > kOneRequest) end_now();
    end_within_grace();
  }
  signals.fetch_add(1);
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
