// The one exception type of the pipeline; the ABI turns it into a status, a message and an element.
#pragma once

#include <beltrami/beltrami.h>

#include <cstdint>
#include <stdexcept>
#include <string>

namespace beltrami {

/// What a failure is about, so that a host can select it.
struct Element {
  std::int32_t kind = BELTRAMI_ELEMENT_NONE;
  std::uint64_t index = BELTRAMI_NO_ELEMENT;

  static Element face(std::uint64_t index) { return {BELTRAMI_ELEMENT_FACE, index}; }
  static Element vertex(std::uint64_t index) { return {BELTRAMI_ELEMENT_VERTEX, index}; }
  static Element corner(std::uint64_t index) { return {BELTRAMI_ELEMENT_CORNER, index}; }
};

/// A run that cannot go on: a negative status, a sentence that says what to do, and the element.
class Error : public std::runtime_error {
 public:
  Error(beltrami_status status, const std::string& message, Element element = {})
      : std::runtime_error(message), status_(status), element_(element) {}

  beltrami_status status() const { return status_; }
  Element element() const { return element_; }

 private:
  beltrami_status status_;
  Element element_;
};

}  // namespace beltrami
