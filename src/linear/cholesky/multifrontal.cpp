#include "linear/cholesky/multifrontal.h"

#include <algorithm>
#include <array>
#include <atomic>

#include "base/bucket_sort.h"
#include "base/interrupt.h"
#include "base/parallel.h"
#include "linear/cholesky/factor_solve.h"
#include "linear/cholesky/front.h"
#include "linear/cholesky/workspace_pool.h"

namespace beltrami {
namespace {

/// Fronts of one depth above the tasks that take so many multiplications are worth several threads.
constexpr double kParallelWave = 1e6;
/// Times a thread's share of the fronts at one depth: larger ones get all threads, if they take so
/// many multiplications.
constexpr double kDominant = 1.5;
constexpr double kParallelFront = 4e6;

/// Where the update matrices of a task are: on two stacks, of even and of odd depth in the tree. So
/// a front's update goes where its children's are not, and those are freed without moving anything.
struct StackPlan {
  std::vector<std::int64_t> offset;  // per supernode, in the stack of its depth
  std::vector<std::uint8_t> depth;   // modulo 2
  std::array<std::int64_t, 2> peak{};
  std::int64_t buffer = 0;  // scalars for front::factorize
};

std::int64_t update_stride(const Symbolic& symbolic, int s) {
  return front::padded(symbolic.height(s) - symbolic.width(s));
}

std::int64_t update_size(const Symbolic& symbolic, int s) {
  return update_stride(symbolic, s) * (symbolic.height(s) - symbolic.width(s));
}

StackPlan plan_stacks(const Symbolic& symbolic) {
  StackPlan plan;
  const int count = symbolic.supernode_count();
  plan.offset.resize(count);
  plan.depth.assign(count, 0);
  for (int s = count - 1; s >= 0; --s) {
    if (symbolic.parent[s] >= 0) plan.depth[s] = !plan.depth[symbolic.parent[s]];
  }
  for (const Symbolic::Range& task : symbolic.tasks) {
    std::array<std::int64_t, 2> top{};
    for (int s = task.begin; s < task.end; ++s) {
      const int d = plan.depth[s];
      plan.offset[s] = top[d];
      top[d] += update_size(symbolic, s);
      plan.peak[d] = std::max(plan.peak[d], top[d]);
      for (const int c : symbolic.children(s)) top[!d] -= update_size(symbolic, c);
    }
  }
  for (int s = 0; s < symbolic.top_begin(); ++s) {
    plan.buffer = std::max(plan.buffer, front::buffer_size(symbolic.height(s), symbolic.width(s)));
  }
  return plan;
}

template <class T>
class Numeric {
 public:
  Numeric(front::Vectors vectors, const Symbolic& symbolic, const PermutedPattern& pattern,
          const T* values, T* factor, const Work& work)
      : vectors_(vectors),
        symbolic_(symbolic),
        pattern_(pattern),
        values_(values),
        factor_(factor),
        work_(work),
        plan_(plan_stacks(symbolic)),
        kept_(symbolic.supernode_count() - symbolic.top_begin()),
        kept_of_task_(symbolic.tasks.size()) {}

  bool run() {
    poll_interrupt();
    if (!run_tasks()) return false;
    WorkspacePool<Workspace> pool;
    for (const Wave& wave : plan_waves()) {
      poll_interrupt();
      if (!run_wave(wave, pool)) return false;
    }
    return true;
  }

 private:
  struct Workspace {
    std::vector<int> place;  // per block row: its place in the front at hand
    std::vector<int> relative;
    std::array<LargeArray<T>, 2> stack;
    LargeArray<T> buffer;
    std::int64_t buffer_size = 0;
  };

  /// Supernodes of the top at one depth, which share nothing.
  struct Wave {
    bool worth_threads = false;
    std::vector<int> side_by_side, alone;  // alone: with all threads at work on one front
  };

  double work_of(int s) const {
    const double height = symbolic_.height(s), width = symbolic_.width(s);
    return height * height * width;
  }

  /// From the tasks up to the roots.
  std::vector<Wave> plan_waves() const {
    const int top = symbolic_.top_begin(), count = symbolic_.supernode_count();
    std::vector<int> depth(count - top, 0);
    int deepest = -1;
    for (int s = count - 1; s >= top; --s) {
      if (symbolic_.parent[s] >= 0) depth[s - top] = depth[symbolic_.parent[s] - top] + 1;
      deepest = std::max(deepest, depth[s - top]);
    }
    std::vector<double> work(deepest + 1, 0);
    for (int s = top; s < count; ++s) work[depth[s - top]] += work_of(s);
    std::vector<Wave> waves(deepest + 1);
    for (int s = top; s < count; ++s) {
      const int d = depth[s - top];
      Wave& wave = waves[deepest - d];
      wave.worth_threads = work[d] > kParallelWave;
      const int threads = wave.worth_threads ? work_.threads() : 1;
      // What is much more than a thread's share of its wave would keep the others waiting.
      const bool dominates =
          work_of(s) > kParallelFront && work_of(s) * threads > kDominant * work[d];
      (dominates ? wave.alone : wave.side_by_side).push_back(s);
    }
    return waves;
  }

  std::unique_ptr<Workspace> make_workspace() const {
    auto space = std::make_unique<Workspace>();
    space->place.resize(symbolic_.column_count());
    return space;
  }

  bool run_tasks() {
    std::atomic<bool> positive{true};
    WorkspacePool<Workspace> pool;
    const auto make = [&] {
      auto space = make_workspace();
      for (int d = 0; d < 2; ++d) space->stack[d] = allocate_large<T>(plan_.peak[d]);
      space->buffer = allocate_large<T>(plan_.buffer);
      return space;
    };
    parallel_for(work_, static_cast<std::int64_t>(symbolic_.tasks.size()), 1,
                 [&](std::int64_t t, std::int64_t) {
                   if (!positive) return;
                   auto space = pool.take(make);
                   if (!run_task(static_cast<int>(t), *space)) positive = false;
                   pool.give_back(std::move(space));
                 });
    return positive;
  }

  bool run_wave(const Wave& wave, WorkspacePool<Workspace>& pool) {
    std::atomic<bool> positive{true};
    const auto run = [&](int s, const Work& work) {
      if (!positive) return;
      auto space = pool.take([&] { return make_workspace(); });
      if (!run_top(s, *space, work)) positive = false;
      pool.give_back(std::move(space));
    };
    const Work alone = work_.aside(), &shared = wave.worth_threads ? work_ : alone;
    parallel_for(shared, static_cast<std::int64_t>(wave.side_by_side.size()), 1,
                 [&](std::int64_t i, std::int64_t) { run(wave.side_by_side[i], alone); });
    for (const int s : wave.alone) run(s, shared);
    return positive;
  }

  bool run_task(int t, Workspace& space) {
    const Symbolic::Range task = symbolic_.tasks[t];
    for (int s = task.begin; s < task.end; ++s) {
      T* update = space.stack[plan_.depth[s]].get() + plan_.offset[s];
      assemble(s, update, space, [&](int c) -> const T* {
        return space.stack[plan_.depth[c]].get() + plan_.offset[c];
      });
      if (!front::factorize(vectors_, panel(s), symbolic_.height(s), symbolic_.width(s), update,
                            space.buffer.get(), {})) {
        return false;
      }
    }
    // What the top will add: kept apart from the stack, which the next task needs.
    const int root = task.end - 1;
    if (symbolic_.parent[root] < 0) return true;
    const std::int64_t size = update_size(symbolic_, root);
    kept_of_task_[t] = allocate_large<T>(size);
    const T* update = space.stack[plan_.depth[root]].get() + plan_.offset[root];
    std::copy(update, update + size, kept_of_task_[t].get());
    return true;
  }

  bool run_top(int s, Workspace& space, const Work& work) {
    const int top = symbolic_.top_begin();
    const auto kept = [&](int c) -> LargeArray<T>& {
      return c >= top ? kept_[c - top] : kept_of_task_[task_of(c)];
    };
    kept_[s - top] = allocate_large<T>(update_size(symbolic_, s));
    assemble(s, kept_[s - top].get(), space, [&](int c) -> const T* { return kept(c).get(); });
    for (const int c : symbolic_.children(s)) kept(c).reset();
    const int height = symbolic_.height(s), width = symbolic_.width(s);
    const std::int64_t size = front::buffer_size(height, width);
    if (size > space.buffer_size) {
      space.buffer = allocate_large<T>(size);
      space.buffer_size = size;
    }
    front::ForChunks for_chunks;
    if (work.threads() > 1) {
      for_chunks = [&work](int count, const std::function<void(int, int)>& body) {
        parallel_for(work, count, 1, [&](std::int64_t begin, std::int64_t end) {
          body(static_cast<int>(begin), static_cast<int>(end));
        });
      };
    }
    return front::factorize(vectors_, panel(s), height, width, kept_[s - top].get(),
                            space.buffer.get(), for_chunks);
  }

  /// The task whose root is supernode c.
  int task_of(int c) const {
    const auto after = std::upper_bound(
        symbolic_.tasks.begin(), symbolic_.tasks.end(), c,
        [](int supernode, const Symbolic::Range& task) { return supernode < task.end; });
    return static_cast<int>(after - symbolic_.tasks.begin());
  }

  T* panel(int s) { return factor_ + symbolic_.value_start[s]; }

  /// Sums up a front: entries of the matrix in its panel, and the updates of its children.
  template <class UpdateOf>
  void assemble(int s, T* update, Workspace& space, const UpdateOf& update_of_child) {
    const int height = symbolic_.height(s), width = symbolic_.width(s),
              block = symbolic_.block_size;
    const int begin = symbolic_.first_column[s], end = symbolic_.first_column[s + 1];
    const auto rows = symbolic_.rows_of(s);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      space.place[rows[i]] = width + block * static_cast<int>(i);
    }
    for (int c = begin; c < end; ++c) space.place[c] = block * (c - begin);
    T* const columns = panel(s);
    std::fill(columns, columns + static_cast<std::int64_t>(height) * width, T(0));
    const int shift = block - 1;  // blocks are of one or two
    for (int j = 0; j < width; ++j) {
      T* column = columns + static_cast<std::int64_t>(j) * height;
      for (int e = pattern_.start[block * begin + j]; e < pattern_.start[block * begin + j + 1];
           ++e) {
        const int row = pattern_.row[e];
        column[space.place[row >> shift] + (row & shift)] = values_[e];
      }
    }
    const int below = height - width;
    const std::int64_t stride = update_stride(symbolic_, s);
    for (int j = 0; j < below; ++j) {
      std::fill(update + j * stride + j, update + (j + 1) * stride, T(0));
    }
    for (const int c : symbolic_.children(s)) add_child(s, c, update_of_child(c), update, space);
  }

  void add_child(int s, int c, const T* source, T* update, Workspace& space) {
    const int width = symbolic_.width(s), height = symbolic_.height(s),
              block = symbolic_.block_size;
    const std::int64_t stride = update_stride(symbolic_, s), from = update_stride(symbolic_, c);
    const auto rows = symbolic_.rows_of(c);
    const int count = block * static_cast<int>(rows.size());
    space.relative.resize(count);
    int* const relative = space.relative.data();
    if (block == 1) {
      for (int i = 0; i < count; ++i) relative[i] = space.place[rows[i]];
    } else {
      for (int i = 0; i < count; i += 2) {
        relative[i] = space.place[rows[i / 2]];
        relative[i + 1] = relative[i] + 1;
      }
    }
    for (int j = 0; j < count; ++j, source += from) {
      const int column = relative[j];
      T* target = column < width ? panel(s) + static_cast<std::int64_t>(column) * height
                                 : update + (column - width) * stride - width;
      int i = j;
      if (relative[count - 1] - relative[i] == count - 1 - i) {  // one run
        T* run = target + relative[i] - i;
        for (; i < count; ++i) run[i] += source[i];
        continue;
      }
      for (; i < count; ++i) target[relative[i]] += source[i];
    }
  }

  const front::Vectors vectors_;
  const Symbolic& symbolic_;
  const PermutedPattern& pattern_;
  const T* values_;
  T* const factor_;
  const Work work_;
  StackPlan plan_;
  std::vector<LargeArray<T>> kept_, kept_of_task_;  // updates that the top will add
};

}  // namespace

PermutedPattern permute_pattern(const SparseMatrix& lower, const Symbolic& symbolic,
                                const Work& work) {
  const int n = static_cast<int>(lower.cols()), block = symbolic.block_size, shift = block - 1;
  const int *start = lower.outerIndexPtr(), *row = lower.innerIndexPtr();
  const auto place = [&](int r) { return block * symbolic.place[r >> shift] + (r & shift); };
  PermutedPattern pattern;
  BucketSort<int> sort(work, n, n, pattern.start, [&](std::int64_t c, const auto& count) {
    const int column = place(static_cast<int>(c));
    for (int e = start[c]; e < start[c + 1]; ++e) count(std::min(column, place(row[e])));
  });
  const auto entries = static_cast<std::size_t>(lower.nonZeros());
  parallel_assign(work, pattern.row, entries);
  parallel_assign(work, pattern.source, entries);
  sort.place([&](std::int64_t c, const auto& place_in) {
    const int column = place(static_cast<int>(c));
    for (int e = start[c]; e < start[c + 1]; ++e) {
      const int other = place(row[e]);
      const int at = place_in(std::min(column, other));
      pattern.row[at] = std::max(column, other);
      pattern.source[at] = e;
    }
  });
  return pattern;
}

template <class T>
bool Factor<T>::factorize(const Symbolic& symbolic, const PermutedPattern& pattern, const T* values,
                          const Work& work) {
  const std::int64_t size = symbolic.value_start.back();
  if (capacity_ < size) {
    clear();
    values_ = allocate_large<T>(size);
    capacity_ = size;
  }
  return Numeric<T>(vectors_, symbolic, pattern, values, values_.get(), work).run();
}

template <class T>
void Factor<T>::solve(const Symbolic& symbolic, T* x, int columns, const Work& work) const {
  solve_with_factor(vectors_, symbolic, values_.get(), x, columns, work);
}

template <class T>
DenseMatrix Factor<T>::solve_rows(const Symbolic& symbolic, const SparseMatrix& rhs,
                                  const std::vector<int>& rows, const Work& work) const {
  return solve_rows_with_factor<T>(vectors_, symbolic, values_.get(), rhs, rows, work);
}

template class Factor<float>;
template class Factor<double>;

}  // namespace beltrami
