// What went wrong in a call, in public numbers, and the one wrapper that no exception passes.
#pragma once

#include <beltrami/beltrami.h>

#include <cstdint>
#include <string>

#include "base/error.h"
#include "base/floating_point.h"

namespace beltrami {

/// The public number of a fault: below 0.
beltrami_status status_of(Fault fault) noexcept;

/// The last failure. Setting it never throws: without memory for the message, a static one stands.
class Failure {
 public:
  void clear() noexcept;
  void set(beltrami_status status, const char* message, Element element = {}) noexcept;
  /// As set, but `message` must be static; allocates nothing.
  void set_static(const char* message) noexcept;

  const char* message() const noexcept { return message_; }
  /// BELTRAMI_NO_ELEMENT without one.
  std::uint64_t element() const noexcept { return element_; }
  /// A BELTRAMI_ELEMENT_ number.
  std::int32_t element_kind() const noexcept { return element_kind_; }

 private:
  std::string text_;
  const char* message_ = "";  ///< text_ or a static sentence
  std::uint64_t element_ = BELTRAMI_NO_ELEMENT;
  std::int32_t element_kind_ = BELTRAMI_ELEMENT_NONE;
};

/// Turns the exception under way into `failure` and its status. Call it in a catch block only.
beltrami_status describe_exception(Failure& failure) noexcept;

/// Runs the body of an entry point in the standard floating-point mode and catches everything.
template <class Body>
beltrami_status guarded(Failure& failure, Body&& body) noexcept {
  const StandardFloatingPoint standard_mode;
  try {
    const beltrami_status status = body();
    failure.clear();
    return status;
  } catch (...) {
    return describe_exception(failure);
  }
}

}  // namespace beltrami
