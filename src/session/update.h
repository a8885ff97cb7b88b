// What an update of a session does: cut, carry over, map.
#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "atlas/open.h"
#include "atlas/pins.h"
#include "base/error.h"
#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "cut/edge_marks.h"
#include "session/remap.h"
#include "session/session.h"
#include "session/state.h"

namespace beltrami {

/// One update of a session, of at most `steps` Newton steps a chart; see Session::update. The
/// session itself is not changed: `result` is its next state.
class Updater {
 public:
  Updater(const Session& session, int steps, const Work& work)
      : session_(session), next_(session.state_), steps_(steps), work_(work) {}

  Updated run();
  SessionState result() { return std::move(next_); }

 private:
  using Pins = std::vector<ChartPin>;

  /// A chart that is due, and its new map.
  struct Job {
    Index chart = 0;
    Pins pins;
    std::vector<bool> held;
    std::shared_ptr<const std::vector<Index>> ranks = nullptr;
    std::optional<Draft> draft = {};
    std::optional<Error> error = {};
  };

  void cut();
  std::vector<bool> affected() const;
  std::shared_ptr<const std::vector<Index>> ranks_after_cut(const AtlasChart& part) const;
  EdgeMarks standing(const std::vector<Index>& faces) const;
  void replace(const std::vector<bool>& affected, std::vector<SessionChart> fresh);
  void number(std::vector<SessionChart>& fresh);
  std::vector<Pins> pins_of_charts() const;
  std::vector<MetPin> met_pins(const Pins& pins) const;
  void note_pins(const std::vector<Pins>& pins);
  std::vector<Job> jobs(std::vector<Pins> pins) const;
  void map(Job& job, const Work& work) const;
  std::vector<Vec2> places(const std::vector<Job>& jobs) const;
  void take(Job& job, const Vec2& shift);
  Updated report(Index mapped) const;

  const Session& session_;
  SessionState next_;
  const int steps_;
  const Work& work_;
};

}  // namespace beltrami
