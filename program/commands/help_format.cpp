#include "commands/help_format.h"

#include <algorithm>
#include <iterator>
#include <sstream>
#include <string_view>
#include <utility>

namespace beltrami::cli {
namespace {

constexpr std::size_t kColumns = 80;  // of the narrowest terminal that is common
constexpr std::size_t kTextFrom = 26;
constexpr std::size_t kLeastGap = 2;  // between an option and its text

/// What most runs are given, if anything; --help has all.
constexpr std::string_view kMostUsed[] = {"preset", "target-energy", "effort", "resolution",
                                          "margin", "report",        "output"};

bool is_most_used(const CLI::Option& option) {
  const std::vector<std::string>& names = option.get_lnames();
  return std::any_of(names.begin(), names.end(), [](const std::string& name) {
    return std::find(std::begin(kMostUsed), std::end(kMostUsed), name) != std::end(kMostUsed);
  });
}

/// The words of a text in lines of `columns`; a list of choices may also break behind a bar.
std::vector<std::string> broken(const std::string& text, std::size_t columns) {
  std::vector<std::string> lines(1);
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const bool fits = lines.back().size() + 1 + word.size() <= columns;
    if (!lines.back().empty() && !fits) lines.emplace_back();
    if (!lines.back().empty()) lines.back() += ' ';
    lines.back() += word;
    while (lines.back().size() > columns) {
      const std::size_t bar = lines.back().rfind('|', columns - 1);
      if (bar == std::string::npos) break;
      std::string rest = lines.back().substr(bar + 1);
      lines.back().resize(bar + 1);
      lines.push_back(std::move(rest));
    }
  }
  return lines;
}

/// Paragraphs as wide as the page, and examples as they are.
std::string paragraphs(const std::string& text) {
  std::string all, open;
  const auto close = [&] {
    if (open.empty()) return;
    for (const std::string& line : broken(open, kColumns)) all += line + '\n';
    open.clear();
  };
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (!line.empty() && line.front() != ' ') {
      open += line + ' ';
      continue;
    }
    close();
    all += line + '\n';
  }
  close();
  return all;
}

}  // namespace

HelpFormat::HelpFormat(bool brief) : brief_(brief) {
  label("Positionals", "Files");
}

/// CLI11 parts groups by two blank lines or none.
std::string HelpFormat::make_help(const CLI::App* app, std::string name,
                                  CLI::AppFormatMode mode) const {
  const std::string made = Formatter::make_help(app, std::move(name), mode);
  std::string text;
  for (const char c : made) {
    if (c != '\n' || !text.ends_with("\n\n")) text += c;
  }
  return text;
}

std::string HelpFormat::make_group(std::string group, bool is_positional,
                                   std::vector<const CLI::Option*> options) const {
  if (brief_ && !is_positional) {
    std::erase_if(options, [](const CLI::Option* option) { return !is_most_used(*option); });
  }
  if (options.empty()) return "";
  std::string text = '\n' + group + ":\n";
  for (const CLI::Option* option : options) text += make_option(option, is_positional);
  return text;
}

std::string HelpFormat::make_option(const CLI::Option* option, bool is_positional) const {
  std::string name = "  " + make_option_name(option, is_positional);
  // That a file must be named is what usage says.
  if (!is_positional) name += make_option_opts(option);
  std::vector<std::string> head = broken(name, kColumns - kLeastGap);
  std::string text;
  for (const std::string& line : head) text += (text.empty() ? "  " : "\n    ") + line;
  const bool is_short = head.size() == 1 && text.size() + kLeastGap <= kTextFrom;
  if (!is_short) text += '\n';
  const std::string indent(kTextFrom, ' ');
  text += is_short ? std::string(kTextFrom - text.size(), ' ') : indent;
  bool first = true;
  for (const std::string& line : broken(make_option_desc(option), kColumns - kTextFrom)) {
    text += (first ? "" : indent) + line + '\n';
    first = false;
  }
  return text;
}

std::string HelpFormat::make_footer(const CLI::App* app) const {
  if (brief_) {
    const CLI::App* parent = app->get_parent();
    const std::string name = parent != nullptr ? parent->get_name() + ' ' : "";
    return '\n' + name + app->get_name() + " --help has all options.\n";
  }
  return app->get_footer().empty() ? "" : '\n' + paragraphs(app->get_footer());
}

bool asks_briefly(const std::vector<std::string>& words) {
  const auto end = std::find(words.begin(), words.end(), "--");
  return std::find(words.begin(), end, "-h") != end &&
         std::find(words.begin(), end, "--help") == end;
}

}  // namespace beltrami::cli
