// The memory of this process, as Linux tells it.
#pragma once

#include <fstream>
#include <string>

namespace beltrami::benchmarks {

/// A line of /proc/self/status, in bytes: "VmRSS" is what is in use, "VmHWM" the peak. 0 where
/// there is none.
inline double memory_of_process(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with(key + ":")) return 1024 * std::stod(line.substr(key.size() + 1));
  }
  return 0;
}

/// From here on a new peak counts.
inline void reset_peak() {
  std::ofstream("/proc/self/clear_refs") << 5;
}

}  // namespace beltrami::benchmarks
