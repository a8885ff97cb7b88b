#include "base/pool.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <system_error>

#include "base/host_memory.h"

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

/// Looks for a while whether `ready` holds. A run has thousands of loops, many of them as short as
/// a thread takes to fall asleep and to be woken.
template <class Ready>
void await_awake(const Ready& ready) {
  constexpr auto kPatience = std::chrono::microseconds(50);
  const auto until = std::chrono::steady_clock::now() + kPatience;
  while (!ready() && std::chrono::steady_clock::now() < until) std::this_thread::yield();
}

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
    while (std::ssize(threads_) < helpers) {
      threads_.emplace_back(
          [this, thread = static_cast<int>(threads_.size()) + 1] { serve(thread); });
    }
  } catch (const std::system_error&) {
    helpers_ = static_cast<int>(threads_.size());  // as many as the system has
  }
}

void Pool::serve(int thread) {
  const auto called = [&] { return closing_ || places_ > 0; };
  for (;;) {
    await_awake(called);
    std::unique_lock lock(guard_);
    begin_.wait(lock, called);
    if (closing_) return;
    --places_;
    ++inside_;
    const std::function<void(int)>& task = *task_;
    lock.unlock();
    task(thread);
    lock.lock();
    if (--inside_ == 0) end_.notify_one();
  }
}

void Pool::run_on_host(int count, const std::function<void(int)>& task) const {
  const std::thread::id caller = std::this_thread::get_id();
  const HostMemoryScope not_of_the_run(nullptr);  // what the host calls on the way
  host_(count, [&](int index) {
    task(std::this_thread::get_id() == caller ? 0 : std::max(index, 0) + 1);
  });
  task(0);  // what a host has left undone, if it called fewer jobs than it was to
}

void Pool::run(int helpers, const std::function<void(int)>& task) {
  const Turn turn(taken_);
  if (turn && host_) {
    run_on_host(std::min(helpers, helpers_) + 1, task);
    return;
  }
  if (turn) start(std::min(helpers, helpers_));
  const int places = turn ? std::min(helpers, helpers_) : 0;
  if (places == 0) {
    task(0);
    return;
  }
  {
    const std::lock_guard lock(guard_);
    task_ = &task;
    places_ = places;
  }
  for (int i = 0; i < places; ++i) begin_.notify_one();
  task(0);
  {
    const std::lock_guard lock(guard_);
    places_ = 0;
  }
  const auto alone = [&] { return inside_ == 0; };
  await_awake(alone);
  std::unique_lock lock(guard_);
  end_.wait(lock, alone);
}

}  // namespace beltrami
