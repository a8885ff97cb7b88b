#include "base/pool.h"

#include <algorithm>
#include <cstddef>
#include <system_error>

namespace beltrami {
namespace {

/// Holds the pool for one task, unless another one has it.
class Turn {
 public:
  explicit Turn(std::atomic<bool>& taken) : taken_(taken), mine_(!taken.exchange(true)) {}
  ~Turn() {
    if (mine_) taken_ = false;
  }
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;

  explicit operator bool() const { return mine_; }

 private:
  std::atomic<bool>& taken_;
  const bool mine_;
};

}  // namespace

Pool::~Pool() {
  {
    const std::lock_guard lock(guard_);
    closing_ = true;
  }
  begin_.notify_all();
}

void Pool::start(int helpers) {
  threads_.reserve(static_cast<std::size_t>(helpers));
  try {
    while (std::ssize(threads_) < helpers) threads_.emplace_back([this] { serve(); });
  } catch (const std::system_error&) {
    helpers_ = static_cast<int>(threads_.size());  // as many as the system has
  }
}

void Pool::serve() {
  std::unique_lock lock(guard_);
  for (;;) {
    begin_.wait(lock, [&] { return closing_ || places_ > 0; });
    if (closing_) return;
    --places_;
    ++inside_;
    const std::function<void()>& task = *task_;
    lock.unlock();
    task();
    lock.lock();
    if (--inside_ == 0) end_.notify_one();
  }
}

void Pool::run(int helpers, const std::function<void()>& task) {
  const Turn turn(taken_);
  if (turn) start(std::min(helpers, helpers_));
  const int places = turn ? std::min(helpers, helpers_) : 0;
  if (places == 0) {
    task();
    return;
  }
  {
    const std::lock_guard lock(guard_);
    task_ = &task;
    places_ = places;
  }
  for (int i = 0; i < places; ++i) begin_.notify_one();
  task();
  std::unique_lock lock(guard_);
  places_ = 0;
  end_.wait(lock, [&] { return inside_ == 0; });
}

}  // namespace beltrami
