// The manual page, of the same table of commands and options as the help.
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace beltrami::cli {

/// beltrami.1 in roff, with the macros of man: each command of `app` with its options by groups and
/// its footer. It has no date, so that one program always writes the same page.
std::string man_page(const CLI::App& app, const std::string& version);

}  // namespace beltrami::cli
