#include "commands/completions.h"

namespace beltrami::cli {
namespace {

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

std::vector<std::string> names_of(const std::vector<CompletedCommand>& commands) {
  std::vector<std::string> names;
  for (const CompletedCommand& command : commands) names.push_back(command.name);
  return names;
}

std::vector<std::string> option_names(const CompletedCommand& command) {
  std::vector<std::string> names;
  for (const CompletedOption& option : command.options) {
    names.insert(names.end(), option.names.begin(), option.names.end());
  }
  return names;
}

/// Within single quotes, where a shell takes all else as it is.
std::string quoted(const std::string& text) {
  std::string all = "'";
  for (const char c : text) all += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return all + "'";
}

std::string for_bash(const std::vector<CompletedCommand>& commands) {
  std::string text =
      "# Completions of beltrami for bash.\n"
      "_beltrami() {\n"
      "  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} words=\n"
      "  COMPREPLY=()\n"
      "  if ((COMP_CWORD == 1)); then\n"
      "    mapfile -t COMPREPLY < <(compgen -W '--help --version " +
      joined(names_of(commands)) +
      "' -- \"$word\")\n"
      "    return\n"
      "  fi\n"
      "  case ${COMP_WORDS[1]}:$before in\n";
  for (const CompletedCommand& command : commands) {
    for (const CompletedOption& option : command.options) {
      if (option.choices.empty()) continue;
      for (const std::string& name : option.names) {
        text +=
            "    " + command.name + ":" + name + ") words='" + joined(option.choices) + "' ;;\n";
      }
    }
  }
  text += "  esac\n  if [[ -z $words && $word == -* ]]; then\n    case ${COMP_WORDS[1]} in\n";
  for (const CompletedCommand& command : commands) {
    text += "      " + command.name + ") words='" + joined(option_names(command)) + "' ;;\n";
  }
  return text +
         "    esac\n  fi\n"
         "  if [[ -n $words ]]; then\n"
         "    mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$word\")\n"
         "  fi\n"
         "}\n"
         "complete -o default -F _beltrami beltrami\n";
}

/// In what zsh's _arguments reads: "[summary]", without brackets or colons of its own.
std::string for_zsh_in_brackets(const std::string& summary) {
  std::string text;
  for (const char c : summary) {
    if (c == '[' || c == ']' || c == ':') text += '\\';
    text += c;
  }
  return "[" + text + "]";
}

std::string for_zsh(const std::vector<CompletedCommand>& commands) {
  std::string text =
      "#compdef beltrami\n"
      "# Completions of beltrami for zsh.\n"
      "_beltrami() {\n"
      "  if ((CURRENT == 2)); then\n"
      "    local -a commands=(\n";
  for (const CompletedCommand& command : commands) {
    text += "      " + quoted(command.name + ":" + command.summary) + "\n";
  }
  text +=
      "    )\n"
      "    _describe command commands\n"
      "    return\n"
      "  fi\n"
      "  local command=$words[2]\n"
      "  shift words\n"
      "  ((CURRENT--))\n"
      "  case $command in\n";
  for (const CompletedCommand& command : commands) {
    text += "    " + command.name + ")\n      _arguments";
    for (const CompletedOption& option : command.options) {
      const std::string value = !option.takes_value ? ""
                                : option.choices.empty()
                                    ? ":value:_files"
                                    : ":value:(" + joined(option.choices) + ")";
      for (const std::string& name : option.names) {
        text += " \\\n        " + quoted(name + for_zsh_in_brackets(option.summary) + value);
      }
    }
    text += " \\\n        '*:file:_files'\n      ;;\n";
  }
  return text + "  esac\n}\n_beltrami \"$@\"\n";
}

std::string for_fish(const std::vector<CompletedCommand>& commands) {
  std::string text = "# Completions of beltrami for fish.\n";
  for (const CompletedCommand& command : commands) {
    text += "complete -c beltrami -n __fish_use_subcommand -f -a " + command.name + " -d " +
            quoted(command.summary) + "\n";
    for (const CompletedOption& option : command.options) {
      text += "complete -c beltrami -n '__fish_seen_subcommand_from " + command.name + "'";
      for (const std::string& name : option.names) {
        const bool is_long = name.compare(0, 2, "--") == 0;
        text += (is_long ? " -l " : " -s ") + name.substr(is_long ? 2 : 1);
      }
      if (option.takes_value) text += " -r";
      if (!option.choices.empty()) text += " -f -a " + quoted(joined(option.choices));
      text += " -d " + quoted(option.summary) + "\n";
    }
  }
  return text;
}

}  // namespace

std::string completions(const std::string& shell, const std::vector<CompletedCommand>& commands) {
  if (shell == "bash") return for_bash(commands);
  return shell == "zsh" ? for_zsh(commands) : for_fish(commands);
}

}  // namespace beltrami::cli
