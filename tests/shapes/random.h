// Numbers that look random and are the same on every platform.
#pragma once

#include <cstdint>

#include "base/portable_math.h"

namespace beltrami::shapes {

/// SplitMix64 (Steele, Lea and Flood, 2014). The distributions of the standard library differ from
/// one to another, so those that are needed are here.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t bits() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return z ^ (z >> 31);
  }
  /// In [0, 1), a multiple of 2^-53.
  double unit() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  double between(double low, double high) { return low + (high - low) * unit(); }
  /// Whose logarithm is spread evenly over that of [low, high]; both are above 0.
  double spread(double low, double high) {
    return portable::exp(between(portable::log(low), portable::log(high)));
  }
  /// One of low, ..., high.
  int count(int low, int high) {
    return low + static_cast<int>(bits() % static_cast<std::uint64_t>(high - low + 1));
  }
  bool chance(double probability) { return unit() < probability; }

 private:
  std::uint64_t state_;
};

}  // namespace beltrami::shapes
