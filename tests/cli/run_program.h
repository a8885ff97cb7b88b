// Runs the program as a script would.
#pragma once

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <string>
#include <vector>

#include "temporary_directory.h"

namespace beltrami::cli {

struct Outcome {
  int exit_code = -1;  ///< -1 for a death by signal
  std::string out, err;

  int err_lines() const { return static_cast<int>(std::count(err.begin(), err.end(), '\n')); }
};

/// Starts the program with its output in the files "out" and "err" of a directory of its own.
class Program {
 public:
  /// `memory_limit`: bytes of address space, 0 for no limit.
  explicit Program(std::vector<std::string> arguments, rlim_t memory_limit = 0) {
    arguments.insert(arguments.begin(), BELTRAMI_PROGRAM);
    std::vector<char*> pointers;
    for (std::string& argument : arguments) pointers.push_back(argument.data());
    pointers.push_back(nullptr);
    const std::string out = directory_.path("out"), err = directory_.path("err");
    child_ = fork();
    if (child_ != 0) return;
    dup2(open(out.c_str(), O_WRONLY | O_CREAT, 0600), 1);
    dup2(open(err.c_str(), O_WRONLY | O_CREAT, 0600), 2);
    const rlimit limit = {memory_limit, memory_limit};
    if (memory_limit > 0) setrlimit(RLIMIT_AS, &limit);
    execv(pointers[0], pointers.data());
    _exit(127);
  }

  pid_t id() const { return child_; }

  Outcome wait() {
    int status = 0;
    waitpid(child_, &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, directory_.read("out"),
            directory_.read("err")};
  }

 private:
  TemporaryDirectory directory_;
  pid_t child_ = -1;
};

inline Outcome run(std::vector<std::string> arguments) {
  return Program(std::move(arguments)).wait();
}

}  // namespace beltrami::cli
