// What readers pass over, in words.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace beltrami::cli {

/// Adds "statements 'call'" for `what` "statements" and the keyword "call" to `notes`, unless it is
/// there; of many different ones the first few are named.
void note_unknown(std::vector<std::string>& notes, const std::string& what,
                  std::string_view keyword);

}  // namespace beltrami::cli
