// Ctrl-C: from a signal to a cancelled run.
#pragma once

#include <beltrami/beltrami.h>

namespace beltrami::cli {

/// From now on SIGINT and SIGTERM ask for an end; the third one ends the process at once.
void install_interrupt_handler();

/// Whether a signal has come.
bool interrupted();

/// Throws the Failure of a cancelled command if a signal has come.
void throw_if_interrupted();

/// While it lives, a signal cancels the runs of `context`. One at a time.
class CancelOnInterrupt {
 public:
  explicit CancelOnInterrupt(beltrami_context* context);
  ~CancelOnInterrupt();
  CancelOnInterrupt(const CancelOnInterrupt&) = delete;
  CancelOnInterrupt& operator=(const CancelOnInterrupt&) = delete;
};

}  // namespace beltrami::cli
