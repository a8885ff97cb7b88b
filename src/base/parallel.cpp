#include "base/parallel.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <memory>
#include <mutex>
#include <vector>

#ifdef __linux__
#include <sys/mman.h>
#include <unistd.h>
#endif

#include "base/floating_point.h"
#include "base/host_memory.h"
#include "base/interrupt.h"
#include "base/loop_trace.h"
#include "base/pool.h"

namespace beltrami {
namespace {

/// Hands out the chunks of a loop: to each thread those of its own share, the same ones in every
/// loop over as many items, whose data its caches may still have; then what others have left.
class Shares {
 public:
  Shares(std::int64_t chunks, int shares) : shares_(static_cast<std::size_t>(shares)) {
    for (int i = 0; i < shares; ++i) {
      shares_[i].next = chunks * i / shares;
      shares_[i].end = chunks * (i + 1) / shares;
    }
  }

  /// A chunk that nobody has; -1 where there is none.
  std::int64_t take(int thread) {
    const std::size_t count = shares_.size(), own = static_cast<std::size_t>(thread) % count;
    for (std::size_t i = 0; i < count; ++i) {
      Share& share = shares_[(own + i) % count];
      if (share.next.load(std::memory_order_relaxed) >= share.end) continue;
      const std::int64_t chunk = share.next.fetch_add(1, std::memory_order_relaxed);
      if (chunk < share.end) return chunk;
    }
    return -1;
  }

  /// Nothing is handed out any more.
  void drop() {
    for (Share& share : shares_) share.next = share.end;
  }

 private:
  struct alignas(64) Share {
    std::atomic<std::int64_t> next;
    std::int64_t end = 0;
  };
  std::vector<Share> shares_;
};

#ifdef __linux__
/// Gives the system a hint on the pages that lie within the memory, on several threads. Not on
/// those of a host, who may have given hints of its own.
void advise(const Work& work, void* memory, std::size_t bytes, int advice) {
  constexpr std::size_t kChunk = std::size_t{1} << 20;
  const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  if (host_memory() != nullptr) return;
  if (bytes < 2 * kChunk || std::align(page, page, memory, bytes) == nullptr) return;
  parallel_for(work, static_cast<std::int64_t>(bytes / page * page), kChunk,
               [&](std::int64_t begin, std::int64_t end) {
                 madvise(static_cast<char*>(memory) + begin, static_cast<std::size_t>(end - begin),
                         advice);
               });
}
#endif

}  // namespace

void parallel_for(const Work& work, std::int64_t count, std::int64_t grain,
                  const std::function<void(std::int64_t, std::int64_t)>& body) {
  const std::int64_t chunks = (count + grain - 1) / grain;
  LoopTrace* const trace = work.trace();
  if (trace && work.threads() > 1 && !trace->is_inside()) {
    trace->run(chunks, [&](std::int64_t chunk) {
      poll_interrupt();
      body(chunk * grain, std::min((chunk + 1) * grain, count));
    });
    return;
  }
  const int threads = trace ? 1 : work.threads();
  const int workers = static_cast<int>(std::min<std::int64_t>(threads, chunks));
  if (workers <= 1) {
    for (std::int64_t begin = 0; begin < count; begin += grain) {
      poll_interrupt();
      body(begin, std::min(begin + grain, count));
    }
    return;
  }
  Shares shares(chunks, grain > 1 ? workers : 1);
  std::exception_ptr failure;
  std::mutex failure_guard;
  const InterruptSource request = interrupt_for_workers();
  const HostMemory* const memory = host_memory();
  const auto take_chunks = [&](int thread) {
    const StandardFloatingPoint standard_mode;
    try {
      for (std::int64_t chunk; (chunk = shares.take(thread)) >= 0;) {
        poll_interrupt();
        body(chunk * grain, std::min((chunk + 1) * grain, count));
      }
    } catch (...) {
      const std::lock_guard<std::mutex> lock(failure_guard);
      if (!failure) failure = std::current_exception();
      shares.drop();
    }
  };
  work.pool().run(workers - 1, [&](int thread) {
    const HostMemoryScope same_memory(memory);
    if (thread == 0) {
      take_chunks(thread);
      return;
    }
    const InterruptScope interruptible(request);
    take_chunks(thread);
  });
  if (failure) std::rethrow_exception(failure);
}

void touch_memory([[maybe_unused]] const Work& work, [[maybe_unused]] void* memory,
                  [[maybe_unused]] std::size_t bytes) {
#ifdef MADV_POPULATE_WRITE
  // What it does not do is done at the first touch.
  advise(work, memory, bytes, MADV_POPULATE_WRITE);
#endif
}

void release_memory([[maybe_unused]] const Work& work, [[maybe_unused]] void* memory,
                    [[maybe_unused]] std::size_t bytes) {
#ifdef MADV_DONTNEED
  advise(work, memory, bytes, MADV_DONTNEED);
#endif
}

double parallel_sum(const Work& work, std::int64_t count, std::int64_t grain,
                    const std::function<double(std::int64_t, std::int64_t)>& term) {
  std::vector<double> partial(static_cast<std::size_t>((count + grain - 1) / grain));
  parallel_for(work, count, grain, [&](std::int64_t begin, std::int64_t end) {
    partial[static_cast<std::size_t>(begin / grain)] = term(begin, end);
  });
  double sum = 0;
  for (const double value : partial) sum += value;
  return sum;
}

}  // namespace beltrami
