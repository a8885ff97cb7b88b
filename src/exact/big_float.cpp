#include "exact/big_float.h"

#include <algorithm>
#include <cmath>

namespace beltrami {
namespace {

constexpr int kDigitBits = 32;
constexpr int kMantissaBits = 53;

}  // namespace

BigFloat::BigFloat(double value) {
  if (value == 0) return;
  int exponent = 0;
  // The mantissa as a whole number: exact, since it has no more bits than a double holds.
  const auto mantissa =
      static_cast<std::uint64_t>(std::ldexp(std::frexp(std::abs(value), &exponent), kMantissaBits));
  exponent -= kMantissaBits;
  const int shift = ((exponent % kDigitBits) + kDigitBits) % kDigitBits;
  place_ = (exponent - shift) / kDigitBits;
  const std::uint64_t low = mantissa << shift;
  const std::uint64_t high = shift == 0 ? 0 : mantissa >> (64 - shift);
  digits_ = {static_cast<std::uint32_t>(low), static_cast<std::uint32_t>(low >> kDigitBits),
             static_cast<std::uint32_t>(high)};
  sign_ = value > 0 ? 1 : -1;
  trim();
}

BigFloat operator*(const BigFloat& a, const BigFloat& b) {
  BigFloat product;
  if (a.sign_ == 0 || b.sign_ == 0) return product;
  product.digits_.assign(a.digits_.size() + b.digits_.size(), 0);
  for (std::size_t i = 0; i < a.digits_.size(); ++i) {
    std::uint64_t carry = 0;  // of digits: their product and two more digits fit
    for (std::size_t j = 0; j < b.digits_.size(); ++j) {
      carry += product.digits_[i + j] + std::uint64_t{a.digits_[i]} * b.digits_[j];
      product.digits_[i + j] = static_cast<std::uint32_t>(carry);
      carry >>= kDigitBits;
    }
    product.digits_[i + b.digits_.size()] = static_cast<std::uint32_t>(carry);
  }
  product.place_ = a.place_ + b.place_;
  product.sign_ = a.sign_ * b.sign_;
  product.trim();
  return product;
}

BigFloat BigFloat::sum(const BigFloat& a, const BigFloat& b, int sign_of_b) {
  BigFloat result;
  if (a.sign_ == 0 || sign_of_b == 0) {
    result = sign_of_b == 0 ? a : b;
    result.sign_ = sign_of_b == 0 ? a.sign_ : sign_of_b;
    return result;
  }
  const bool adds = a.sign_ == sign_of_b;
  const int order = adds ? 1 : compare_sizes(a, b);
  if (order == 0) return result;
  const BigFloat& large = order > 0 ? a : b;
  const BigFloat& small = order > 0 ? b : a;
  result.sign_ = order > 0 ? a.sign_ : sign_of_b;
  result.place_ = std::min(a.place_, b.place_);
  const std::int64_t last = std::max(a.end(), b.end());
  result.digits_.reserve(static_cast<std::size_t>(last - result.place_ + 1));
  std::int64_t carry = 0;  // or what was borrowed
  for (std::int64_t place = result.place_; place <= last; ++place) {
    const std::int64_t other = small.digit(place);
    carry += std::int64_t{large.digit(place)} + (adds ? other : -other);
    result.digits_.push_back(static_cast<std::uint32_t>(carry));
    carry >>= kDigitBits;
  }
  result.trim();
  return result;
}

int BigFloat::compare_sizes(const BigFloat& a, const BigFloat& b) {
  const std::int64_t first = std::min(a.place_, b.place_);
  for (std::int64_t place = std::max(a.end(), b.end()) - 1; place >= first; --place) {
    const std::uint32_t x = a.digit(place), y = b.digit(place);
    if (x != y) return x < y ? -1 : 1;
  }
  return 0;
}

std::uint32_t BigFloat::digit(std::int64_t place) const {
  return place < place_ || place >= end() ? 0 : digits_[static_cast<std::size_t>(place - place_)];
}

void BigFloat::trim() {
  while (!digits_.empty() && digits_.back() == 0) digits_.pop_back();
  const auto first =
      std::find_if(digits_.begin(), digits_.end(), [](std::uint32_t digit) { return digit != 0; });
  place_ += first - digits_.begin();
  digits_.erase(digits_.begin(), first);
}

}  // namespace beltrami
