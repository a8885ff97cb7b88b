// How the entries of the option table read and write members of Options.
#pragma once

#include <type_traits>

#include "abi/options.h"

namespace beltrami {

template <auto Member>
double get(const Options& options) {
  return static_cast<double>(options.*Member);
}

/// Of a member of a part of the options.
template <auto Part, auto Member>
double get(const Options& options) {
  return static_cast<double>(options.*Part.*Member);
}

template <auto Member>
void set(Options& options, double value) {
  using Value = std::remove_reference_t<decltype(options.*Member)>;
  options.*Member = static_cast<Value>(value);
}

template <auto Part, auto Member>
void set(Options& options, double value) {
  using Value = std::remove_reference_t<decltype(options.*Part.*Member)>;
  options.*Part.*Member = static_cast<Value>(value);
}

}  // namespace beltrami
