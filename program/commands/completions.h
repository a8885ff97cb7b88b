// What shells complete: the commands, their options, and the choices of these.
#pragma once

#include <string>
#include <vector>

namespace beltrami::cli {

/// An option of a command, as it is typed.
struct CompletedOption {
  std::vector<std::string> names;    ///< with their dashes: "-q", "--quiet"
  std::vector<std::string> choices;  ///< what may follow, or none
  bool takes_value = false;          ///< a file, unless there are choices
  std::string summary;               ///< one line
};

struct CompletedCommand {
  std::string name, summary;
  std::vector<CompletedOption> options;
  std::vector<std::string> words;  ///< that may be its arguments; none: files
};

/// The script for "bash", "zsh" or "fish". Precondition: one of them. `general` has the options
/// that stand before a command.
std::string completions(const std::string& shell, const std::vector<CompletedOption>& general,
                        const std::vector<CompletedCommand>& commands);

}  // namespace beltrami::cli
