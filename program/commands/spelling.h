// What a misspelt word was to be.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace beltrami::cli {

/// The one of `known` that takes the fewest letters left out, put in, exchanged or swapped with
/// their neighbour to come from `word`; the first of several. "" where all take more than a third
/// of its letters.
std::string nearest_spelling(std::string_view word, const std::vector<std::string>& known);

}  // namespace beltrami::cli
