#include "commands/man_page.h"

#include <CLI/App.hpp>
#include <algorithm>
#include <sstream>
#include <vector>

namespace beltrami::cli {
namespace {

/// Text that roff takes as it is: a hyphen is the one that is typed, and no line is a request.
std::string escaped(const std::string& text) {
  std::string all;
  for (const char c : text) {
    const bool begins_line = all.empty() || all.back() == '\n';
    if (begins_line && (c == '.' || c == '\'')) all += "\\&";
    if (c == '\\') {
      all += "\\e";
    } else if (c == '-') {
      all += "\\-";
    } else {
      all += c;
    }
  }
  return all;
}

/// The texts of help are broken for a terminal; roff breaks them anew. Lines that begin with a
/// blank are examples, which stay as they are.
std::string paragraphs(const std::string& text) {
  std::string all = ".PP\n";
  bool example = false;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const bool indented = line.starts_with(' ');
    if (indented != example) all += indented ? ".PP\n.nf\n" : ".fi\n.PP\n";
    example = indented;
    if (!line.empty()) {
      all += escaped(line) + "\n";
    } else if (!all.ends_with(".PP\n")) {
      all += ".PP\n";
    }
  }
  return all + (example ? ".fi\n" : "");
}

bool is_positional(const CLI::Option& option) {
  return option.get_lnames().empty() && option.get_snames().empty();
}

std::string names_of(const CLI::Option& option) {
  std::string text;
  for (const std::string& name : option.get_snames()) text += "-" + name + ", ";
  for (const std::string& name : option.get_lnames()) text += "--" + name + ", ";
  if (text.ends_with(", ")) text.resize(text.size() - 2);
  return is_positional(option) ? option.get_name() : text;
}

std::string entry(const CLI::Option& option) {
  std::string text = ".TP\n\\fB" + escaped(names_of(option)) + "\\fR";
  if (!is_positional(option) && option.get_items_expected_max() > 0) {
    text += " \\fI" + escaped(option.get_type_name()) + "\\fR";
  }
  return text + "\n" + escaped(option.get_description()) + "\n";
}

std::string section(const CLI::App& command) {
  std::string text = ".SH BELTRAMI ";
  for (const char c : command.get_name()) {
    text += c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  }
  text += "\n" + escaped(command.get_description()) + ".\n";
  std::vector<std::string> groups;
  for (const CLI::Option* option : command.get_options()) {
    const std::string group = is_positional(*option) ? "Arguments" : option->get_group();
    if (group.empty() || std::find(groups.begin(), groups.end(), group) != groups.end()) continue;
    groups.push_back(group);
  }
  std::stable_partition(groups.begin(), groups.end(),
                        [](const std::string& group) { return group == "Arguments"; });
  for (const std::string& group : groups) {
    text += ".SS " + escaped(group) + "\n";
    for (const CLI::Option* option : command.get_options()) {
      const std::string own = is_positional(*option) ? "Arguments" : option->get_group();
      if (own == group) text += entry(*option);
    }
  }
  if (command.get_footer().empty()) return text;
  return text + ".SS Notes\n" + paragraphs(command.get_footer());
}

}  // namespace

std::string man_page(const CLI::App& app, const std::string& version) {
  std::string text = ".TH BELTRAMI 1 \"\" \"beltrami " + version +
                     "\" \"User Commands\"\n.SH NAME\nbeltrami \\- unwrap meshes to UVs\n"
                     ".SH SYNOPSIS\n";
  for (const CLI::App* command : app.get_subcommands({})) {
    text += ".PP\n\\fBbeltrami " + escaped(command->get_name()) + "\\fR";
    for (const CLI::Option* option : command->get_options()) {
      if (is_positional(*option)) text += " \\fI" + escaped(option->get_name()) + "\\fR";
    }
    text += " [options]\n";
  }
  text += ".SH DESCRIPTION\n" + escaped(app.get_description()) + ".\n";
  for (const CLI::App* command : app.get_subcommands({})) text += section(*command);
  text += ".SH EXIT STATUS\n" + paragraphs(app.get_footer());
  return text;
}

}  // namespace beltrami::cli
