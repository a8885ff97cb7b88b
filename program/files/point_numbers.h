// Numbers points by their coordinates.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

namespace beltrami::cli {

/// Points with the same coordinates to the last bit have one number; numbers go by first
/// appearance. 0 and -0 are the same coordinate: exporters give both for one point. A hash table
/// with open addressing.
template <std::size_t Dimension>
class PointNumbers {
 public:
  using Point = std::array<double, Dimension>;

  std::uint32_t size() const { return static_cast<std::uint32_t>(coordinates_.size() / Dimension); }
  /// Precondition: fewer than 2^32 - 1 points so far.
  std::uint32_t number(Point point) {
    if (2 * (std::size_t{size()} + 1) > slots_.size()) grow();
    for (double& x : point) x += 0.0;  // -0 + 0 is 0
    std::size_t slot = hash(point.data()) & (slots_.size() - 1);
    for (; slots_[slot] != kFree; slot = (slot + 1) & (slots_.size() - 1)) {
      const double* known = &coordinates_[Dimension * slots_[slot]];
      if (std::memcmp(known, point.data(), sizeof point) == 0) return slots_[slot];
    }
    slots_[slot] = size();
    coordinates_.insert(coordinates_.end(), point.begin(), point.end());
    return slots_[slot];
  }
  /// The coordinates by number.
  std::vector<double> take_coordinates() { return std::move(coordinates_); }

 private:
  static constexpr std::uint32_t kFree = std::numeric_limits<std::uint32_t>::max();

  static std::size_t hash(const double* point) {
    std::uint64_t state = 0;
    for (std::size_t k = 0; k < Dimension; ++k) {
      state = (state ^ std::bit_cast<std::uint64_t>(point[k])) * 0x9E3779B97F4A7C15u;
      state ^= state >> 29;
    }
    return static_cast<std::size_t>(state);
  }

  void grow() {
    slots_.assign(2 * slots_.size(), kFree);
    for (std::uint32_t i = 0; i < size(); ++i) {
      std::size_t slot = hash(&coordinates_[Dimension * i]) & (slots_.size() - 1);
      while (slots_[slot] != kFree) slot = (slot + 1) & (slots_.size() - 1);
      slots_[slot] = i;
    }
  }

  std::vector<double> coordinates_;
  std::vector<std::uint32_t> slots_ = std::vector<std::uint32_t>(1024, kFree);
};

}  // namespace beltrami::cli
