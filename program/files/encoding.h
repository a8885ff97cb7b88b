// Names in files of unknown encodings.
#pragma once

#include <string>
#include <string_view>

namespace beltrami::cli {

/// The text where it is UTF-8, else each byte as the character that it is in Latin-1.
std::string utf8_of(std::string_view text);

}  // namespace beltrami::cli
