// A row of the option table.
#pragma once

#include <beltrami/beltrami.h>

#include <cstdint>
#include <span>

#include "abi/options.h"

namespace beltrami {

/// One option. Values pass as double: every range lies within its exact integers.
struct OptionEntry {
  std::int32_t key;
  std::int32_t type;
  const char* name;
  const char* summary;
  double minimum, maximum;                    ///< inclusive
  std::span<const char* const> choices = {};  ///< names of the values 0, 1, ... of a choice
  double (*get)(const Options&);
  void (*set)(Options&, double);
  std::int32_t calls = BELTRAMI_CALL_RUN | BELTRAMI_CALL_UNWRAP;  ///< that take it
};

}  // namespace beltrami
