// A bracket around the place where something that grows passes what is asked for.
#pragma once

#include <cmath>
#include <limits>

namespace beltrami {

/// The greatest place that is known to be below, and the least that is known to be above. Either
/// may be unknown, as an infinity. Whoever looks for the place notes what was found at each that
/// was tried, and takes the next one from inside.
struct Bracket {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();

  void note(double at, bool is_above) { (is_above ? high : low) = at; }

  bool has_low() const { return std::isfinite(low); }
  bool has_high() const { return std::isfinite(high); }
  bool is_closed() const { return has_low() && has_high(); }

  /// Whether both ends are positive, and by less than this factor apart.
  bool is_within(double factor) const { return low > 0 && high < factor * low; }

  double middle() const { return 0.5 * (low + high); }

  /// The guess, if it is inside; else the middle of a bracket with two ends.
  double inside(double guess) const {
    return !is_closed() || (guess > low && guess < high) ? guess : middle();
  }
};

}  // namespace beltrami
