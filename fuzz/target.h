// A fuzz target is one function of bytes. What breaks a promise ends the process with a sentence.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace beltrami::fuzz {

/// The body of a target: every source with a target defines it.
void run_one(std::string_view bytes);

/// Ends the process as a finding, which says `promise` is broken.
[[noreturn]] void broken(const char* promise);

inline void promise(bool kept, const char* what) {
  if (!kept) broken(what);
}

}  // namespace beltrami::fuzz
