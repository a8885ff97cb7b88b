// What is compiled in another way than the tests are, and linked with them.
#pragma once

#include <beltrami/beltrami.h>

namespace beltrami::host {

/// Unwraps a triangle without exceptions; the status of a second one whose index is out of range.
beltrami_status unwrap_without_exceptions();

/// Flattens a triangle from std::span, in C++20; the number of UVs, from another unit.
unsigned flatten_spans();

}  // namespace beltrami::host
