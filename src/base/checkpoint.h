// How long work stays interruptible without knowing who watches it.
#pragma once

#include <functional>

namespace beltrami {

/// A stage calls its checkpoint with the share of its work done, in [0, 1], at least once per
/// solver step. The callee may throw to cancel; the stage only has to be exception safe.
using Checkpoint = std::function<void(double fraction)>;

inline void no_checkpoint(double) {}

}  // namespace beltrami
