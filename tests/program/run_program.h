// Runs the program as a script would.
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "temporary_directory.h"

namespace beltrami::cli {

struct Outcome {
  int exit_code = -1;  ///< -1 for a death by signal
  int signal = 0;      ///< of such a death
  std::string out, err;

  int err_lines() const { return static_cast<int>(std::count(err.begin(), err.end(), '\n')); }
};

/// What a process starts with.
struct Surroundings {
  std::vector<std::pair<int, rlim_t>> limits;  ///< RLIMIT_...
  std::vector<int> ignored;                    ///< signals
  std::vector<int> closed;                     ///< descriptors
  std::vector<std::pair<std::string, std::string>> environment;
  std::string out, err;  ///< paths of stdout and stderr, or "" for files that the outcome tells
};

/// Starts the program; its stdout and stderr are files of a directory of its own.
class Program {
 public:
  explicit Program(std::vector<std::string> arguments, const Surroundings& around = {}) {
    arguments.insert(arguments.begin(), BELTRAMI_PROGRAM);
    std::vector<char*> pointers;
    for (std::string& argument : arguments) pointers.push_back(argument.data());
    pointers.push_back(nullptr);
    const std::string out = around.out.empty() ? directory_.path("out") : around.out;
    const std::string err = around.err.empty() ? directory_.path("err") : around.err;
    child_ = fork();
    if (child_ != 0) return;
    dup2(open(out.c_str(), O_WRONLY | O_CREAT, 0600), 1);
    dup2(open(err.c_str(), O_WRONLY | O_CREAT, 0600), 2);
    for (int descriptor = 3; descriptor < 100; ++descriptor) close(descriptor);
    for (const int descriptor : around.closed) close(descriptor);
    // The tests themselves may run where some are ignored or blocked: under nohup, in scripts.
    for (int number = 1; number < 32; ++number) signal(number, SIG_DFL);
    for (const int number : around.ignored) signal(number, SIG_IGN);
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, nullptr);
    for (const auto& [name, value] : around.environment) setenv(name.c_str(), value.c_str(), 1);
    for (const auto& [resource, value] : around.limits) {
      const rlimit limit = {value, value};
      setrlimit(static_cast<decltype(RLIMIT_AS)>(resource), &limit);
    }
    execv(pointers[0], pointers.data());
    _exit(127);
  }

  void send(int signal_number) const { kill(child_, signal_number); }

  bool has_ended() const {
    siginfo_t info{};
    return waitid(P_PID, static_cast<id_t>(child_), &info, WEXITED | WNOHANG | WNOWAIT) != 0 ||
           info.si_pid != 0;
  }

  /// Waits for `condition`, however long it takes. Throws if the program ends without it.
  template <class Condition>
  void wait_until(Condition&& condition) const {
    while (!condition()) {
      if (has_ended() && !condition()) throw std::runtime_error("the program has ended");
      usleep(1000);
    }
  }

  Outcome wait() {
    int status = 0;
    waitpid(child_, &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1,
            WIFSIGNALED(status) ? WTERMSIG(status) : 0, directory_.read("out"),
            directory_.read("err")};
  }

 private:
  TemporaryDirectory directory_;
  pid_t child_ = -1;
};

inline Outcome run(std::vector<std::string> arguments, const Surroundings& around = {}) {
  return Program(std::move(arguments), around).wait();
}

/// Makes a pipe that has a name, and returns its path.
inline std::string make_pipe(const TemporaryDirectory& directory, const std::string& name) {
  const std::string path = directory.path(name);
  if (mkfifo(path.c_str(), 0600) != 0) throw std::runtime_error("no pipe");
  return path;
}

/// Whether a temporary of the program is in `directory`.
inline bool has_temporary(const TemporaryDirectory& directory) {
  const std::vector<std::string> names = directory.names();
  return std::any_of(names.begin(), names.end(),
                     [](const std::string& name) { return name.ends_with(".tmp"); });
}

}  // namespace beltrami::cli
