// What all targets share: the entry of libFuzzer, and a clock that tells the slowest inputs.
#include "target.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdio>
#include <cstdlib>
#include <ctime>

namespace beltrami::fuzz {
namespace {

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// The most processor time that an input took, by the bits of its size.
class Slowest {
 public:
  void note(std::size_t size, double seconds) {
    double& most = most_[std::bit_width(size)];
    most = std::max(most, seconds);
  }

  /// A line for each range of sizes, as tools/soak.py reads it.
  void print() const {
    for (std::size_t bits = 0; bits < most_.size(); ++bits) {
      if (most_[bits] == 0) continue;
      const std::size_t past = std::size_t{1} << bits;
      std::fprintf(stderr, "slowest below %zu bytes: %.6f CPU s\n", past, most_[bits]);
    }
  }

 private:
  std::array<double, 48> most_{};
};

Slowest& slowest() {
  static Slowest it;
  return it;
}

}  // namespace

void broken(const char* promise) {
  std::fprintf(stderr, "BROKEN: %s\n", promise);
  std::abort();
}

}  // namespace beltrami::fuzz

// The sanitizers' runtime calls these by name.
extern "C" int LLVMFuzzerInitialize(int*, char***) {
  beltrami::fuzz::slowest();
  std::atexit([] { beltrami::fuzz::slowest().print(); });
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const double begin = beltrami::fuzz::cpu_seconds();
  beltrami::fuzz::run_one({reinterpret_cast<const char*>(data), size});
  beltrami::fuzz::slowest().note(size, beltrami::fuzz::cpu_seconds() - begin);
  return 0;
}
