#include "files/notes.h"

#include <algorithm>
#include <cstddef>

namespace beltrami::cli {

void note_unknown(std::vector<std::string>& notes, const std::string& what,
                  std::string_view keyword) {
  // More names would bury the rest of a line; and a longer one is no keyword.
  constexpr std::size_t kMostNames = 8, kLongestName = 40;
  const auto add = [&](const std::string& note) {
    if (std::find(notes.begin(), notes.end(), note) == notes.end()) notes.push_back(note);
  };
  const auto of_this_kind = [&](const std::string& note) { return note.starts_with(what + " '"); };
  if (std::count_if(notes.begin(), notes.end(), of_this_kind) >= std::ptrdiff_t{kMostNames}) {
    add(what + " of other kinds");
    return;
  }
  add(what + " '" + std::string(keyword.substr(0, kLongestName)) + "'");
}

}  // namespace beltrami::cli
