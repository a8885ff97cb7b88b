// How often code looks whether it is to end: a measure of its work that no machine changes.
#pragma once

#include "base/interrupt.h"

namespace beltrami {

/// Runs `body` and counts its polls on this thread; ends it at poll number `last` (0: never).
template <class Body>
std::int64_t count_polls(const Body& body, std::int64_t last = 0) {
  std::int64_t polls = 0;
  const InterruptScope scope({nullptr, nullptr, [&] { return ++polls == last; }});
  body();
  return polls;
}

}  // namespace beltrami
