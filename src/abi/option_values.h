// Options by their keys, as callers set and read them.
#pragma once

#include <cstdint>

#include "abi/options.h"

namespace beltrami {

/// Sets an option. Throws Error INVALID_ARGUMENT (unknown key, wrong type, out of range) and then
/// leaves `options` alone.
void set_int_option(Options& options, std::int32_t key, std::int64_t value);
void set_float_option(Options& options, std::int32_t key, double value);

/// The value of an option. Throws Error INVALID_ARGUMENT for an unknown key.
double get_option(const Options& options, std::int32_t key);

}  // namespace beltrami
