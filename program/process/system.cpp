#include "process/system.h"

#include <algorithm>
#include <thread>

#if defined(_WIN32)
#include <windows.h>
// After it.
#include <psapi.h>
#else
#include <sys/ioctl.h>
#include <sys/resource.h>
#include <unistd.h>
#endif
#if defined(__linux__)
#include <sched.h>
#endif

namespace beltrami::cli {
namespace {

constexpr int kUnknownColumns = 60;

}  // namespace

#if defined(_WIN32)

std::uint64_t peak_memory_bytes() {
  PROCESS_MEMORY_COUNTERS counters{};
  const bool told = K32GetProcessMemoryInfo(GetCurrentProcess(), &counters, sizeof counters) != 0;
  return told ? counters.PeakWorkingSetSize : 0;
}

bool stderr_is_terminal() {
  const HANDLE console = GetStdHandle(STD_ERROR_HANDLE);
  DWORD mode = 0;
  if (GetConsoleMode(console, &mode) == 0) return false;  // a file, a pipe, or nothing
  return SetConsoleMode(console, mode | ENABLE_VIRTUAL_TERMINAL_PROCESSING) != 0;
}

int stderr_columns() {
  CONSOLE_SCREEN_BUFFER_INFO info{};
  if (GetConsoleScreenBufferInfo(GetStdHandle(STD_ERROR_HANDLE), &info) == 0)
    return kUnknownColumns;
  return info.srWindow.Right - info.srWindow.Left + 1;
}

void prepare_console() {
  SetConsoleOutputCP(CP_UTF8);
}

#else

std::uint64_t peak_memory_bytes() {
  rusage usage{};
  if (getrusage(RUSAGE_SELF, &usage) != 0) return 0;
#if defined(__APPLE__)
  return static_cast<std::uint64_t>(usage.ru_maxrss);
#else
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
#endif
}

bool stderr_is_terminal() {
  return isatty(STDERR_FILENO) != 0;
}

int stderr_columns() {
  winsize size{};
  const bool told = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return told ? size.ws_col : kUnknownColumns;
}

void prepare_console() {}

#endif

std::int64_t usable_cores() {
#if defined(__linux__)
  cpu_set_t allowed;
  if (sched_getaffinity(0, sizeof allowed, &allowed) == 0) return CPU_COUNT(&allowed);
#endif
  return std::max<std::int64_t>(1, std::thread::hardware_concurrency());
}

}  // namespace beltrami::cli
