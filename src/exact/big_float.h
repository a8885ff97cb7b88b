// Exact sums, differences and products of doubles, in whole numbers alone: nothing is rounded, so
// no rounding mode and no processor has a say.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace beltrami {

/// A whole number of any size times a power of 2^32. As the sums of products that predicates take
/// are of degree four at most, a power stays far within its range.
class BigFloat {
 public:
  /// Zero.
  BigFloat() = default;
  /// The value of a finite double; subnormal ones are as exact as all others.
  explicit BigFloat(double value);

  /// -1, 0 or 1.
  int sign() const { return sign_; }

  friend BigFloat operator+(const BigFloat& a, const BigFloat& b) { return sum(a, b, b.sign_); }
  friend BigFloat operator-(const BigFloat& a, const BigFloat& b) { return sum(a, b, -b.sign_); }
  friend BigFloat operator*(const BigFloat& a, const BigFloat& b);

 private:
  /// Of a and of b with another sign.
  static BigFloat sum(const BigFloat& a, const BigFloat& b, int sign_of_b);
  /// -1, 0 or 1 as the size of a is below, at or above that of b.
  static int compare_sizes(const BigFloat& a, const BigFloat& b);

  /// The digit of (2^32)^place, which may be beyond those stored.
  std::uint32_t digit(std::int64_t place) const;
  /// The place above the greatest digit.
  std::int64_t end() const { return place_ + static_cast<std::int64_t>(digits_.size()); }
  /// Drops zeros at both ends.
  void trim();

  int sign_ = 0;
  std::int64_t place_ = 0;             ///< of the least digit
  std::vector<std::uint32_t> digits_;  ///< from the least; the first and the last are not zero
};

inline int sign_of(const BigFloat& x) {
  return x.sign();
}

}  // namespace beltrami
