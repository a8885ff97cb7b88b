// The floating-point environment of a host cannot be trusted: merely loading a library that was
// linked with -ffast-math switches on flush-to-zero, under which exact predicates lie.
#pragma once

namespace beltrami {

/// Saves the calling thread's floating-point mode, sets the IEEE default (round to nearest,
/// subnormals kept, exceptions masked), and restores the saved mode on destruction.
class StandardFloatingPoint {
 public:
  StandardFloatingPoint();
  ~StandardFloatingPoint();
  StandardFloatingPoint(const StandardFloatingPoint&) = delete;
  StandardFloatingPoint& operator=(const StandardFloatingPoint&) = delete;

 private:
  unsigned long long saved_;
  int saved_rounding_;
};

}  // namespace beltrami
