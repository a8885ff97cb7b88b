#include "base/work.h"

#include <algorithm>
#include <utility>

#include "base/interrupt.h"
#include "base/pool.h"
#include "base/processor.h"
#include "base/resources.h"

namespace beltrami {

struct Work::Run {
  Run(const Limits& all, Progress watcher)
      : limits(all), progress(std::move(watcher)), pool(all.threads) {}

  const Limits limits;
  const Progress progress;
  const double started = wall_seconds();
  const bool avx2 = has_avx2();
  double fraction = 0;  // that was reported last
  Pool pool;
};

Work::Work(int threads) : Work(Limits{.threads = threads}, nullptr) {}

Work::Work(const Limits& limits, Progress progress)
    : run_(std::make_shared<Run>(limits, std::move(progress))) {}

int Work::threads() const {
  return aside_ ? 1 : run_->limits.threads;
}

Pool& Work::pool() const {
  return run_->pool;
}

LoopTrace* Work::trace() const {
  return run_->limits.trace;
}

bool Work::on_avx2() const {
  return run_->avx2;
}

std::int64_t Work::memory_limit() const {
  return run_->limits.memory_bytes;
}

bool Work::out_of_time() const {
  return !untimed_ && run_->limits.seconds > 0 &&
         wall_seconds() - run_->started > run_->limits.seconds;
}

void Work::report(double fraction) const {
  if (aside_) {
    poll_interrupt();
    return;
  }
  const double whole = from_ + (to_ - from_) * std::clamp(fraction, 0.0, 1.0);
  run_->fraction = std::max(run_->fraction, whole);
  if (run_->progress && run_->progress(run_->fraction, name_)) throw Cancelled();
  poll_interrupt();
}

Work Work::part(double from, double to) const {
  Work inner = *this;
  inner.from_ = from_ + (to_ - from_) * from;
  inner.to_ = from_ + (to_ - from_) * to;
  return inner;
}

Work Work::aside() const {
  Work inner = *this;
  inner.aside_ = true;
  return inner;
}

Work Work::untimed() const {
  Work inner = *this;
  inner.untimed_ = true;
  return inner;
}

Work Work::named(const char* name) const {
  Work inner = *this;
  inner.name_ = name;
  return inner;
}

}  // namespace beltrami
