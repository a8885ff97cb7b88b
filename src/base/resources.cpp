#include "base/resources.h"

#include <chrono>
#include <ctime>

#if defined(_WIN32)
#include <windows.h>
// After it.
#include <psapi.h>
#elif defined(__unix__) || defined(__APPLE__)
#include <sys/resource.h>
#endif

namespace beltrami {

double wall_seconds() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double>(now).count();
}

double cpu_seconds() {
#if defined(_WIN32)
  // std::clock() counts wall time there.
  FILETIME begin, end, kernel, user;
  if (GetProcessTimes(GetCurrentProcess(), &begin, &end, &kernel, &user) == 0) return 0;
  constexpr double kHigh = 4294967296.0, kTick = 1e-7;
  return kTick * (kHigh * (double(kernel.dwHighDateTime) + double(user.dwHighDateTime)) +
                  double(kernel.dwLowDateTime) + double(user.dwLowDateTime));
#elif defined(__wasi__)
  return wall_seconds();  // one thread, and no clock of its own
#else
#if defined(CLOCK_PROCESS_CPUTIME_ID)
  timespec time{};
  if (clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time) == 0) {
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }
#endif
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
#endif
}

std::uint64_t peak_memory_bytes() {
#if defined(_WIN32)
  PROCESS_MEMORY_COUNTERS counters{};
  if (K32GetProcessMemoryInfo(GetCurrentProcess(), &counters, sizeof counters) != 0) {
    return counters.PeakWorkingSetSize;
  }
#elif defined(__unix__) || defined(__APPLE__)
  rusage usage{};
#if defined(__APPLE__)
  constexpr std::uint64_t kUnit = 1;
#else
  constexpr std::uint64_t kUnit = 1024;
#endif
  if (getrusage(RUSAGE_SELF, &usage) == 0) {
    return kUnit * static_cast<std::uint64_t>(usage.ru_maxrss);
  }
#endif
  return 0;
}

}  // namespace beltrami
