#include "commands/progress_bar.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include "process/system.h"

namespace beltrami::cli {
namespace {

constexpr int kBarWidth = 30;  // the whole line fits a terminal of 60 columns
constexpr auto kRedrawInterval = std::chrono::milliseconds(100);

}  // namespace

std::string progress_line(double fraction, const std::string& stage, double seconds) {
  const double bounded = fraction > 0 ? std::min(fraction, 1.0) : 0.0;
  const int filled = static_cast<int>(bounded * kBarWidth);
  std::string bar(static_cast<std::size_t>(filled), '#');
  bar.resize(kBarWidth, '.');
  std::array<char, 128> line;
  std::snprintf(line.data(), line.size(), "%-10.10s [%s] %3d%% %7.1f s", stage.c_str(), bar.c_str(),
                static_cast<int>(bounded * 100), seconds);
  return line.data();
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
  std::fprintf(stderr, "\r\x1b[2K%s", progress_line(fraction, stage_, seconds).c_str());
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
