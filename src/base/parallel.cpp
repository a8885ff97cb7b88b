#include "base/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#ifdef __linux__
#include <sys/mman.h>
#include <unistd.h>
#endif

#include "base/floating_point.h"
#include "base/interrupt.h"

namespace beltrami {

void parallel_for(int threads, std::int64_t count, std::int64_t grain,
                  const std::function<void(std::int64_t, std::int64_t)>& body) {
  const std::int64_t chunks = (count + grain - 1) / grain;
  const int workers = static_cast<int>(std::min<std::int64_t>(threads, chunks));
  if (workers <= 1) {
    for (std::int64_t begin = 0; begin < count; begin += grain) {
      poll_interrupt();
      body(begin, std::min(begin + grain, count));
    }
    return;
  }
  std::atomic<std::int64_t> next{0};
  std::exception_ptr failure;
  std::mutex failure_guard;
  const InterruptSource request = interrupt_for_workers();
  const auto work = [&] {
    const StandardFloatingPoint standard_mode;
    try {
      for (std::int64_t chunk; (chunk = next.fetch_add(1)) < chunks;) {
        poll_interrupt();
        body(chunk * grain, std::min((chunk + 1) * grain, count));
      }
    } catch (...) {
      const std::lock_guard<std::mutex> lock(failure_guard);
      if (!failure) failure = std::current_exception();
      next.store(chunks);
    }
  };
  {
    std::vector<std::jthread> pool;
    pool.reserve(static_cast<std::size_t>(workers - 1));
    const auto work_aside = [&] {
      const InterruptScope interruptible(request);
      work();
    };
    for (int i = 1; i < workers; ++i) pool.emplace_back(work_aside);
    work();
  }
  if (failure) std::rethrow_exception(failure);
}

void touch_memory([[maybe_unused]] int threads, [[maybe_unused]] void* memory,
                  [[maybe_unused]] std::size_t bytes) {
#ifdef MADV_POPULATE_WRITE
  constexpr std::size_t kChunk = std::size_t{1} << 20;
  const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  void* first = memory;
  std::size_t left = bytes;
  if (bytes < 2 * kChunk || std::align(page, page, first, left) == nullptr) return;
  parallel_for(threads, static_cast<std::int64_t>(left / page * page), kChunk,
               [&](std::int64_t begin, std::int64_t end) {
                 // A hint: what it does not do is done at the first touch.
                 madvise(static_cast<char*>(first) + begin, static_cast<std::size_t>(end - begin),
                         MADV_POPULATE_WRITE);
               });
#endif
}

double parallel_sum(int threads, std::int64_t count, std::int64_t grain,
                    const std::function<double(std::int64_t, std::int64_t)>& term) {
  std::vector<double> partial(static_cast<std::size_t>((count + grain - 1) / grain));
  parallel_for(threads, count, grain, [&](std::int64_t begin, std::int64_t end) {
    partial[static_cast<std::size_t>(begin / grain)] = term(begin, end);
  });
  double sum = 0;
  for (const double value : partial) sum += value;
  return sum;
}

}  // namespace beltrami
