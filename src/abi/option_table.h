// The one table of options: the program's flags, Python's keywords and host panels come from it.
#pragma once

#include <cstdint>
#include <span>

#include "abi/option_entry.h"

namespace beltrami {

/// The options in the order of their keys, which count from 0 without gaps.
std::span<const OptionEntry> option_table();

/// The option with this key, or null.
const OptionEntry* find_option(std::int32_t key);

}  // namespace beltrami
