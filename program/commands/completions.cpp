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

std::vector<std::string> names_of(const std::vector<CompletedOption>& options) {
  std::vector<std::string> names;
  for (const CompletedOption& option : options) {
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

std::string for_bash(const std::vector<CompletedOption>& general,
                     const std::vector<CompletedCommand>& commands) {
  std::string text =
      "# Completions of beltrami for bash.\n"
      "_beltrami() {\n"
      "  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} words=\n"
      "  COMPREPLY=()\n"
      "  if ((COMP_CWORD == 1)); then\n"
      "    mapfile -t COMPREPLY < <(compgen -W '" +
      joined(names_of(general)) + " " + joined(names_of(commands)) +
      "' -- \"$word\")\n"
      "    return\n"
      "  fi\n"
      "  case ${COMP_WORDS[1]}:$before in\n";
  for (const CompletedCommand& command : commands) {
    if (!command.words.empty()) {
      text += "    " + command.name + ":" + command.name + ") words='" + joined(command.words) +
              "' ;;\n";
    }
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
    text += "      " + command.name + ") words='" + joined(names_of(command.options)) + "' ;;\n";
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

/// Of one that has several names zsh offers none of them again.
std::string options_for_zsh(const std::vector<CompletedOption>& options) {
  std::string text;
  for (const CompletedOption& option : options) {
    const std::string value = !option.takes_value      ? ""
                              : option.choices.empty() ? ":value:_files"
                                                       : ":value:(" + joined(option.choices) + ")";
    const std::string others = "(" + joined(option.names) + ")";
    for (const std::string& name : option.names) {
      text += " \\\n        " + quoted(others + name + for_zsh_in_brackets(option.summary) + value);
    }
  }
  return text;
}

std::string for_zsh(const std::vector<CompletedOption>& general,
                    const std::vector<CompletedCommand>& commands) {
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
      "    _arguments" +
      options_for_zsh(general) +
      "\n"
      "    return\n"
      "  fi\n"
      "  local command=$words[2]\n"
      "  shift words\n"
      "  ((CURRENT--))\n"
      "  case $command in\n";
  for (const CompletedCommand& command : commands) {
    const std::string arguments =
        command.words.empty() ? "'*:file:_files'" : "'1:word:(" + joined(command.words) + ")'";
    text += "    " + command.name + ")\n      _arguments" + options_for_zsh(command.options) +
            " \\\n        " + arguments + "\n      ;;\n";
  }
  // As a file of fpath it is the function; read by source it is to be made known.
  return text +
         "  esac\n}\n"
         "if [[ $funcstack[1] == _beltrami ]]; then\n"
         "  _beltrami \"$@\"\n"
         "elif (( $+functions[compdef] )); then\n"
         "  compdef _beltrami beltrami\n"
         "fi\n";
}

std::string option_for_fish(const CompletedOption& option) {
  std::string text;
  for (const std::string& name : option.names) {
    const bool is_long = name.compare(0, 2, "--") == 0;
    text += (is_long ? " -l " : " -s ") + name.substr(is_long ? 2 : 1);
  }
  if (option.takes_value) text += " -r";
  if (!option.choices.empty()) text += " -f -a " + quoted(joined(option.choices));
  return text + " -d " + quoted(option.summary) + "\n";
}

std::string for_fish(const std::vector<CompletedOption>& general,
                     const std::vector<CompletedCommand>& commands) {
  const std::string start = "complete -c beltrami -n ";
  std::string text = "# Completions of beltrami for fish.\n";
  for (const CompletedOption& option : general) {
    text += start + "__fish_use_subcommand" + option_for_fish(option);
  }
  for (const CompletedCommand& command : commands) {
    const std::string of_it = start + "'__fish_seen_subcommand_from " + command.name + "'";
    text += start + "__fish_use_subcommand -f -a " + command.name + " -d " +
            quoted(command.summary) + "\n";
    if (!command.words.empty()) text += of_it + " -f -a " + quoted(joined(command.words)) + "\n";
    for (const CompletedOption& option : command.options) text += of_it + option_for_fish(option);
  }
  return text;
}

}  // namespace

std::string completions(const std::string& shell, const std::vector<CompletedOption>& general,
                        const std::vector<CompletedCommand>& commands) {
  if (shell == "bash") return for_bash(general, commands);
  return shell == "zsh" ? for_zsh(general, commands) : for_fish(general, commands);
}

}  // namespace beltrami::cli
