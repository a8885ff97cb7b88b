#include "commands/progress_bar.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include "process/system.h"

namespace beltrami::cli {
namespace {

constexpr int kBarWidth = 30;      // of a wide terminal: a longer bar says no more
constexpr int kLeastBarWidth = 5;  // a shorter one says less than the number beside it
constexpr auto kRedrawInterval = std::chrono::milliseconds(100);

}  // namespace

std::string progress_line(double fraction, const std::string& stage, double seconds, int columns) {
  const double bounded = fraction > 0 ? std::min(fraction, 1.0) : 0.0;
  std::array<char, 64> text;
  std::snprintf(text.data(), text.size(), "%-10.10s ", stage.c_str());
  const std::string name = text.data();
  std::snprintf(text.data(), text.size(), "%3d%%", static_cast<int>(bounded * 100));
  const std::string percent = text.data();
  std::snprintf(text.data(), text.size(), " %7.1f s", seconds);
  const std::string time = text.data();

  // The last column stays free: some terminals wrap a line that fills it.
  const int room = std::max(columns - 1, 0);
  const auto length = [](const std::string& part) { return static_cast<int>(part.size()); };
  const int beside_bar = length(name) + length(percent) + length(time) + 3;
  const int width = std::min(room - beside_bar, kBarWidth);
  if (width >= kLeastBarWidth) {
    std::string bar(static_cast<std::size_t>(bounded * width), '#');
    bar.resize(static_cast<std::size_t>(width), '.');
    return name + "[" + bar + "] " + percent + time;
  }
  for (const std::string& line : {name + percent + time, name + percent, percent}) {
    if (length(line) <= room) return line;
  }
  return "";
}

ProgressBar::ProgressBar(bool wanted) : active_(wanted && stderr_is_terminal()) {}

ProgressBar::~ProgressBar() {
  clear();
}

void ProgressBar::show(double fraction, const char* stage) {
  if (!active_) return;
  const auto now = Clock::now();
  if (now - last_ < kRedrawInterval && stage_ == stage) return;
  last_ = now;
  stage_ = stage;
  const double seconds = std::chrono::duration<double>(now - start_).count();
  const std::string line = progress_line(fraction, stage_, seconds, stderr_columns());
  std::fprintf(stderr, "\r\x1b[2K%s", line.c_str());
  std::fflush(stderr);
  drawn_ = true;
}

void ProgressBar::clear() {
  if (!drawn_) return;
  std::fputs("\r\x1b[2K", stderr);
  std::fflush(stderr);
  drawn_ = false;
}

}  // namespace beltrami::cli
