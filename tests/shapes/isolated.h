// Checks in a process of their own, so that a crash and an endless run are findings.
#pragma once

#include "shapes/properties.h"
#include "shapes/shape.h"

namespace beltrami::shapes {

using Check = Report (*)(const Shape&, Way);

/// check() in a child that may use `cpu_limit` seconds of processor time, and 4 GiB of memory; or
/// another check.
Report check_isolated(const Shape& shape, Way way, int cpu_limit, Check how = check);

/// A smaller shape with the same fault: faces are left out while it stays, then digits. It takes
/// at most `runs` checks.
Shape minimised(const Shape& shape, Way way, Fault fault, int runs, int cpu_limit);

}  // namespace beltrami::shapes
