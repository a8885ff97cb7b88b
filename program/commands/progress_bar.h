// One line on a terminal that says how far a command has come.
#pragma once

#include <chrono>
#include <string>

namespace beltrami::cli {

class ProgressBar {
 public:
  /// Draws on stderr if it is a terminal and `wanted`, else nothing.
  explicit ProgressBar(bool wanted);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// Redraws if the line would differ and the last drawing is old enough.
  void show(double fraction, const char* stage);
  /// Leaves the line empty, for what is printed next.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;

  bool active_;
  bool drawn_ = false;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_ = start_ - std::chrono::hours(1);
  std::string stage_;
};

/// The line itself: "flatten    [#####......]  50%     3.2 s". It is shorter than `columns`: where
/// they are few, the bar goes first, then the time, then the stage. "" where nothing fits.
std::string progress_line(double fraction, const std::string& stage, double seconds, int columns);

}  // namespace beltrami::cli
