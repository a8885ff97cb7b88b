// Signals: from Ctrl-C to a cancelled run, and ends that leave no temporary behind.
#pragma once

#include <beltrami/beltrami.h>

#include <cstdint>

namespace beltrami::cli {

/// From now on SIGINT, SIGTERM, SIGHUP and SIGXCPU ask for an end, and a second of them ends the
/// process, whatever it is at: at once, or after a second where it came together with the first;
/// other signals that kill, SIGKILL excepted, remove the temporaries first.
/// Writing where nobody reads any more, or beyond a limit, is an error of the write. What the
/// parent process had ignored (nohup, background jobs of scripts) stays ignored, what it handles
/// stays handled.
void install_signal_handlers();

/// Whether a signal has asked for an end.
bool interrupted();

/// Not 0 once a signal has come: for beltrami_mesh.cancel.
const std::int32_t* interrupt_number();

/// Throws the Failure of a cancelled command if a signal has asked for an end.
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
