// Data-parallel loops whose results do not depend on the number of threads.
#pragma once

#include <cstdint>
#include <functional>

namespace beltrami {

/// Calls `body(begin, end)` over [0, count) in chunks of `grain`, on up to `threads` threads
/// (the caller's included). Chunk borders depend on `count` and `grain` only, so a body that
/// writes per-item or per-chunk results gives the same bits at any thread count.
/// The first exception thrown by a body is rethrown here, after all threads have stopped; so is the
/// one by which a run ends that is cancelled (poll_interrupt).
void parallel_for(int threads, std::int64_t count, std::int64_t grain,
                  const std::function<void(std::int64_t begin, std::int64_t end)>& body);

/// Sum of `term(begin, end)` over fixed chunks, added in order: the same bits at any thread count.
double parallel_sum(int threads, std::int64_t count, std::int64_t grain,
                    const std::function<double(std::int64_t begin, std::int64_t end)>& term);

}  // namespace beltrami
