// What --help and -h print: in 80 columns, in whole paragraphs.
#pragma once

#include <CLI/App.hpp>
#include <CLI/Formatter.hpp>
#include <string>
#include <vector>

namespace beltrami::cli {

/// All options in their groups; or, `brief`, those that are asked for most, and where the others
/// are. Texts are broken anew, but for lines that begin with a blank, which are examples.
class HelpFormat : public CLI::Formatter {
 public:
  explicit HelpFormat(bool brief);

  std::string make_help(const CLI::App* app, std::string name,
                        CLI::AppFormatMode mode) const override;
  std::string make_group(std::string group, bool is_positional,
                         std::vector<const CLI::Option*> options) const override;
  std::string make_option(const CLI::Option* option, bool is_positional) const override;
  std::string make_footer(const CLI::App* app) const override;

 private:
  bool brief_;
};

/// Whether -h, and not --help, is among the words of a command line.
bool asks_briefly(const std::vector<std::string>& words);

}  // namespace beltrami::cli
