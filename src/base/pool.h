// The threads of a run: started once, lent to its parallel loops one after the other.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace beltrami {

/// Calls `job(index)` once for each index below `count`, on any threads, and returns once all calls
/// have: how a host runs the loops of a run.
using HostLoop = std::function<void(int count, const std::function<void(int index)>& job)>;

class Pool {
 public:
  /// Starts none yet: a run of small loops alone never does.
  explicit Pool(int threads) : helpers_(threads - 1) {}
  /// Ends and joins them.
  ~Pool();
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;

  /// Calls `task` on this thread and, at the same time, on up to `helpers` of the pool's, with the
  /// number of the thread: 0 for this one, from 1 for those. Returns once all calls have. None is
  /// waited for that has not begun by the time this thread is done, and where no thread can be
  /// started, or a task is running already (loops in a loop), it is called on this thread alone.
  /// `task` throws nothing.
  void run(int helpers, const std::function<void(int thread)>& task);

  /// From now on tasks run on the host's threads, and none is started here. `loop` throws nothing.
  /// Before the first run alone.
  void lend(HostLoop loop) { host_ = std::move(loop); }

 private:
  void run_on_host(int count, const std::function<void(int thread)>& task) const;
  void start(int helpers);
  void serve(int thread);

  int helpers_;    // that there may be
  HostLoop host_;  // or empty: own threads
  std::atomic<bool> taken_ = false;
  std::mutex guard_;  // whoever changes what follows, but for the threads, holds it
  std::condition_variable begin_, end_;
  const std::function<void(int)>* task_ = nullptr;
  std::atomic<int> places_ = 0;  // of the task at hand that are not taken
  std::atomic<int> inside_ = 0;  // helpers that are at it
  std::atomic<bool> closing_ = false;
  std::vector<std::jthread> threads_;
};

}  // namespace beltrami
