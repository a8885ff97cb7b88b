#include "linear/cholesky/multifrontal.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <mutex>

#include "base/bucket_sort.h"
#include "base/parallel.h"
#include "linear/cholesky/front.h"
#include "linear/spd_solver.h"

namespace beltrami {
namespace {

/// Fronts of one depth above the tasks that take so many multiplications are worth several threads.
constexpr double kParallelWave = 2e7;
/// Times a thread's share of the fronts at one depth: larger ones get all threads.
constexpr double kDominant = 1.5;

/// Things that threads take and give back, so that there are no more than threads.
template <class T>
class Pool {
 public:
  template <class Make>
  std::unique_ptr<T> take(Make&& make) {
    {
      const std::lock_guard<std::mutex> lock(guard_);
      if (!items_.empty()) {
        std::unique_ptr<T> item = std::move(items_.back());
        items_.pop_back();
        return item;
      }
    }
    return make();
  }
  void give_back(std::unique_ptr<T> item) {
    const std::lock_guard<std::mutex> lock(guard_);
    items_.push_back(std::move(item));
  }

 private:
  std::mutex guard_;
  std::vector<std::unique_ptr<T>> items_;
};

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
          const T* values, T* factor, int threads)
      : vectors_(vectors),
        symbolic_(symbolic),
        pattern_(pattern),
        values_(values),
        factor_(factor),
        threads_(threads),
        plan_(plan_stacks(symbolic)),
        kept_(symbolic.supernode_count() - symbolic.top_begin()),
        kept_of_task_(symbolic.tasks.size()) {}

  bool run(const Poll& poll) {
    poll();
    if (!run_tasks()) return false;
    Pool<Workspace> pool;
    for (const Wave& wave : plan_waves()) {
      poll();
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
    int threads = 1;
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
      wave.threads = work[d] > kParallelWave ? threads_ : 1;
      // What is much more than a thread's share of its wave would keep the others waiting.
      const bool dominates = work_of(s) * wave.threads > kDominant * work[d];
      (dominates ? wave.alone : wave.side_by_side).push_back(s);
    }
    return waves;
  }

  std::unique_ptr<Workspace> make_workspace() const {
    auto work = std::make_unique<Workspace>();
    work->place.resize(symbolic_.column_count());
    return work;
  }

  bool run_tasks() {
    std::atomic<bool> positive{true};
    Pool<Workspace> pool;
    const auto make = [&] {
      auto work = make_workspace();
      for (int d = 0; d < 2; ++d) work->stack[d] = allocate_large<T>(plan_.peak[d]);
      work->buffer = allocate_large<T>(plan_.buffer);
      return work;
    };
    parallel_for(threads_, static_cast<std::int64_t>(symbolic_.tasks.size()), 1,
                 [&](std::int64_t t, std::int64_t) {
                   if (!positive) return;
                   auto work = pool.take(make);
                   if (!run_task(static_cast<int>(t), *work)) positive = false;
                   pool.give_back(std::move(work));
                 });
    return positive;
  }

  bool run_wave(const Wave& wave, Pool<Workspace>& pool) {
    std::atomic<bool> positive{true};
    const auto run = [&](int s, int threads) {
      if (!positive) return;
      auto work = pool.take([&] { return make_workspace(); });
      if (!run_top(s, threads, *work)) positive = false;
      pool.give_back(std::move(work));
    };
    parallel_for(wave.threads, static_cast<std::int64_t>(wave.side_by_side.size()), 1,
                 [&](std::int64_t i, std::int64_t) { run(wave.side_by_side[i], 1); });
    for (const int s : wave.alone) run(s, wave.threads);
    return positive;
  }

  bool run_task(int t, Workspace& work) {
    const Symbolic::Range task = symbolic_.tasks[t];
    for (int s = task.begin; s < task.end; ++s) {
      T* update = work.stack[plan_.depth[s]].get() + plan_.offset[s];
      assemble(s, update, work, [&](int c) -> const T* {
        return work.stack[plan_.depth[c]].get() + plan_.offset[c];
      });
      if (!front::factorize(vectors_, panel(s), symbolic_.height(s), symbolic_.width(s), update,
                            work.buffer.get(), {})) {
        return false;
      }
    }
    // What the top will add: kept apart from the stack, which the next task needs.
    const int root = task.end - 1;
    if (symbolic_.parent[root] < 0) return true;
    const std::int64_t size = update_size(symbolic_, root);
    kept_of_task_[t] = allocate_large<T>(size);
    const T* update = work.stack[plan_.depth[root]].get() + plan_.offset[root];
    std::copy(update, update + size, kept_of_task_[t].get());
    return true;
  }

  bool run_top(int s, int threads, Workspace& work) {
    const int top = symbolic_.top_begin();
    const auto kept = [&](int c) -> LargeArray<T>& {
      return c >= top ? kept_[c - top] : kept_of_task_[task_of(c)];
    };
    kept_[s - top] = allocate_large<T>(update_size(symbolic_, s));
    assemble(s, kept_[s - top].get(), work, [&](int c) -> const T* { return kept(c).get(); });
    for (const int c : symbolic_.children(s)) kept(c).reset();
    const int height = symbolic_.height(s), width = symbolic_.width(s);
    const std::int64_t size = front::buffer_size(height, width);
    if (size > work.buffer_size) {
      work.buffer = allocate_large<T>(size);
      work.buffer_size = size;
    }
    front::ForChunks for_chunks;
    if (threads > 1) {
      for_chunks = [threads](int count, const std::function<void(int, int)>& body) {
        parallel_for(threads, count, 1, [&](std::int64_t begin, std::int64_t end) {
          body(static_cast<int>(begin), static_cast<int>(end));
        });
      };
    }
    return front::factorize(vectors_, panel(s), height, width, kept_[s - top].get(),
                            work.buffer.get(), for_chunks);
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
  void assemble(int s, T* update, Workspace& work, const UpdateOf& update_of_child) {
    const int height = symbolic_.height(s), width = symbolic_.width(s),
              block = symbolic_.block_size;
    const int begin = symbolic_.first_column[s], end = symbolic_.first_column[s + 1];
    const auto rows = symbolic_.rows_of(s);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      work.place[rows[i]] = width + block * static_cast<int>(i);
    }
    for (int c = begin; c < end; ++c) work.place[c] = block * (c - begin);
    T* const columns = panel(s);
    std::fill(columns, columns + static_cast<std::int64_t>(height) * width, T(0));
    const int shift = block - 1;  // blocks are of one or two
    for (int j = 0; j < width; ++j) {
      T* column = columns + static_cast<std::int64_t>(j) * height;
      for (int e = pattern_.start[block * begin + j]; e < pattern_.start[block * begin + j + 1];
           ++e) {
        const int row = pattern_.row[e];
        column[work.place[row >> shift] + (row & shift)] = values_[e];
      }
    }
    const int below = height - width;
    const std::int64_t stride = update_stride(symbolic_, s);
    for (int j = 0; j < below; ++j) {
      std::fill(update + j * stride + j, update + (j + 1) * stride, T(0));
    }
    for (const int c : symbolic_.children(s)) add_child(s, c, update_of_child(c), update, work);
  }

  void add_child(int s, int c, const T* source, T* update, Workspace& work) {
    const int width = symbolic_.width(s), height = symbolic_.height(s),
              block = symbolic_.block_size;
    const std::int64_t stride = update_stride(symbolic_, s), from = update_stride(symbolic_, c);
    const auto rows = symbolic_.rows_of(c);
    const int count = block * static_cast<int>(rows.size());
    work.relative.resize(count);
    int* const relative = work.relative.data();
    if (block == 1) {
      for (int i = 0; i < count; ++i) relative[i] = work.place[rows[i]];
    } else {
      for (int i = 0; i < count; i += 2) {
        relative[i] = work.place[rows[i / 2]];
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
  const int threads_;
  StackPlan plan_;
  std::vector<LargeArray<T>> kept_, kept_of_task_;  // updates that the top will add
};

/// Solves with subtrees side by side. What a task subtracts from rows of the top is collected apart
/// and applied in the order of the tasks.
template <class T>
class TreeSolve {
 public:
  TreeSolve(front::Vectors vectors, const Symbolic& symbolic, const T* factor, T* x, int columns,
            int threads)
      : vectors_(vectors),
        symbolic_(symbolic),
        factor_(factor),
        x_(x),
        columns_(columns),
        threads_(threads),
        size_(static_cast<std::int64_t>(symbolic.column_count()) * symbolic.block_size),
        top_(static_cast<std::int64_t>(symbolic.block_size) *
             symbolic.first_column[symbolic.top_begin()]),
        sums_(symbolic.tasks.size()) {
    for (int s = 0; s < symbolic.supernode_count(); ++s) {
      highest_ = std::max(highest_, symbolic.height(s));
    }
  }

  void run() {
    const auto tasks = static_cast<std::int64_t>(symbolic_.tasks.size());
    Pool<Workspace> pool;
    const auto make = [&] {
      auto work = std::make_unique<Workspace>();
      work->front.resize(static_cast<std::size_t>(highest_) * columns_);
      return work;
    };
    parallel_for(threads_, tasks, 1, [&](std::int64_t t, std::int64_t) {
      auto work = pool.take(make);
      work->above.resize(static_cast<std::size_t>((size_ - top_) * columns_), T(0));
      const Symbolic::Range task = symbolic_.tasks[t];
      for (int s = task.begin; s < task.end; ++s) forward(s, work->above.data(), *work);
      collect(static_cast<int>(t), *work);
      pool.give_back(std::move(work));
    });
    for (int t = 0; t < tasks; ++t) apply(t);
    auto work = pool.take(make);
    const int top = symbolic_.top_begin(), count = symbolic_.supernode_count();
    for (int s = top; s < count; ++s) forward(s, x_ + top_, *work, size_);
    for (int s = count - 1; s >= top; --s) backward(s, *work);
    pool.give_back(std::move(work));
    parallel_for(threads_, tasks, 1, [&](std::int64_t t, std::int64_t) {
      auto own = pool.take(make);
      const Symbolic::Range task = symbolic_.tasks[t];
      for (int s = task.end - 1; s >= task.begin; --s) backward(s, *own);
      pool.give_back(std::move(own));
    });
  }

 private:
  struct Workspace {
    std::vector<T> front, above;  // above: sums for the rows of the top
  };

  /// `above`: what the rows of the top are subtracted from, with `stride` between columns.
  void forward(int s, T* above, Workspace& work) { forward(s, above, work, size_ - top_); }

  void forward(int s, T* above, Workspace& work, std::int64_t stride) {
    const int height = symbolic_.height(s), width = symbolic_.width(s),
              block = symbolic_.block_size;
    const std::int64_t first = static_cast<std::int64_t>(block) * symbolic_.first_column[s];
    const auto rows = symbolic_.rows_of(s);
    const std::size_t inside = s >= symbolic_.top_begin() ? 0 : rows_inside(rows);
    T* front = work.front.data();
    const auto target = [&](std::size_t i, int c) {
      const std::int64_t row = static_cast<std::int64_t>(block) * rows[i];
      return i < inside ? x_ + c * size_ + row : above + c * stride + (row - top_);
    };
    for (int c = 0; c < columns_; ++c) {
      std::copy_n(x_ + c * size_ + first, width, front + static_cast<std::int64_t>(c) * height);
      T* y = front + static_cast<std::int64_t>(c) * height + width;
      for (std::size_t i = 0; i < rows.size(); ++i) {
        const T* from = target(i, c);
        for (int b = 0; b < block; ++b) *y++ = from[b];
      }
    }
    front::solve_forward(vectors_, factor_ + symbolic_.value_start[s], height, width, front,
                         columns_);
    for (int c = 0; c < columns_; ++c) {
      std::copy_n(front + static_cast<std::int64_t>(c) * height, width, x_ + c * size_ + first);
      const T* y = front + static_cast<std::int64_t>(c) * height + width;
      for (std::size_t i = 0; i < rows.size(); ++i) {
        T* to = target(i, c);
        for (int b = 0; b < block; ++b) to[b] = *y++;
      }
    }
  }

  void backward(int s, Workspace& work) {
    const int height = symbolic_.height(s), width = symbolic_.width(s),
              block = symbolic_.block_size;
    const std::int64_t first = static_cast<std::int64_t>(block) * symbolic_.first_column[s];
    const auto rows = symbolic_.rows_of(s);
    T* front = work.front.data();
    for (int c = 0; c < columns_; ++c) {
      std::copy_n(x_ + c * size_ + first, width, front + static_cast<std::int64_t>(c) * height);
      T* y = front + static_cast<std::int64_t>(c) * height + width;
      for (const int row : rows) {
        const T* from = x_ + c * size_ + static_cast<std::int64_t>(block) * row;
        for (int b = 0; b < block; ++b) *y++ = from[b];
      }
    }
    front::solve_backward(vectors_, factor_ + symbolic_.value_start[s], height, width, front,
                          columns_);
    for (int c = 0; c < columns_; ++c) {
      std::copy_n(front + static_cast<std::int64_t>(c) * height, width, x_ + c * size_ + first);
    }
  }

  /// Rows come in ascending order: those of the task first, then those of the top.
  std::size_t rows_inside(std::span<const int> rows) const {
    const int top = symbolic_.first_column[symbolic_.top_begin()];
    if (rows.empty() || rows.back() < top) return rows.size();
    return static_cast<std::size_t>(std::lower_bound(rows.begin(), rows.end(), top) - rows.begin());
  }

  /// Moves the sums of a task out of the workspace, which is left zero. A task touches only the
  /// rows of its root.
  void collect(int t, Workspace& work) {
    const auto rows = symbolic_.rows_of(symbolic_.tasks[t].end - 1);
    const int block = symbolic_.block_size;
    std::vector<T>& sums = sums_[t];
    sums.reserve(rows.size() * block * columns_);
    for (int c = 0; c < columns_; ++c) {
      for (const int row : rows) {
        T* from = work.above.data() + c * (size_ - top_) +
                  (static_cast<std::int64_t>(block) * row - top_);
        for (int b = 0; b < block; ++b) {
          sums.push_back(from[b]);
          from[b] = 0;
        }
      }
    }
  }

  void apply(int t) {
    const auto rows = symbolic_.rows_of(symbolic_.tasks[t].end - 1);
    const T* from = sums_[t].data();
    for (int c = 0; c < columns_; ++c) {
      for (const int row : rows) {
        T* to = x_ + c * size_ + static_cast<std::int64_t>(symbolic_.block_size) * row;
        for (int b = 0; b < symbolic_.block_size; ++b) to[b] += *from++;
      }
    }
  }

  const front::Vectors vectors_;
  const Symbolic& symbolic_;
  const T* factor_;
  T* const x_;
  const int columns_, threads_;
  const std::int64_t size_, top_;  // scalars: all, and before the top
  int highest_ = 0;
  std::vector<std::vector<T>> sums_;  // per task: for the rows of its root
};

/// Solves for some rows only. The tree of supernodes tells what matters: forward a right-hand side
/// touches the ancestors of its nonzeros only, backward a row of the solution needs its ancestors
/// only (Gilbert & Peierls 1988).
template <class T>
class PrunedSolve {
 public:
  /// Columns that are solved together: each entry of the factor is loaded once for all of them.
  static constexpr int kBlock = 16;

  PrunedSolve(const Symbolic& symbolic, const T* factor, const SparseMatrix& rhs,
              const std::vector<int>& rows)
      : symbolic_(symbolic), factor_(factor), rhs_(rhs), rows_(rows) {
    supernode_.resize(symbolic.column_count());
    for (int s = 0; s < symbolic.supernode_count(); ++s) {
      std::fill(supernode_.begin() + symbolic.first_column[s],
                supernode_.begin() + symbolic.first_column[s + 1], s);
    }
    std::vector<std::uint8_t> mark(symbolic.supernode_count(), kUnused);
    const auto mark_ancestors = [&](int row, std::uint8_t how) {
      int s = supernode_[column_of(row) / symbolic_.block_size];
      for (; s >= 0 && mark[s] == kUnused; s = symbolic_.parent[s]) mark[s] = how;
    };
    for (const int row : rows) mark_ancestors(row, kWanted);
    for (Eigen::Index e = 0; e < rhs.nonZeros(); ++e) {
      mark_ancestors(rhs.innerIndexPtr()[e], kReached);
    }
    slot_.assign(symbolic.column_count(), 0);
    rank_.assign(symbolic.supernode_count(), 0);
    for (int s = 0; s < symbolic.supernode_count(); ++s) {
      if (mark[s] == kUnused) continue;
      rank_[s] = static_cast<int>(visited_.size());
      visited_.push_back(s);
      wanted_.push_back(mark[s] == kWanted);
      for (int c = symbolic.first_column[s]; c < symbolic.first_column[s + 1]; ++c) {
        slot_[c] = slots_;
        slots_ += symbolic.block_size;
      }
    }
  }

  /// Columns [first, first + count) of the result; count <= kBlock.
  void run(Eigen::Index first, Eigen::Index count, DenseMatrix& result) const {
    std::vector<T> work(static_cast<std::size_t>(slots_) * kBlock, T(0));
    std::vector<bool> reached(visited_.size(), false);
    for (Eigen::Index c = 0; c < count; ++c) {
      for (SparseMatrix::InnerIterator entry(rhs_, first + c); entry; ++entry) {
        const int column = column_of(static_cast<int>(entry.row()));
        work[slot_of(column) * kBlock + c] += static_cast<T>(entry.value());
        int s = supernode_[column / symbolic_.block_size];
        for (; s >= 0 && !reached[rank_[s]]; s = symbolic_.parent[s]) reached[rank_[s]] = true;
      }
    }
    std::vector<T*> lanes;
    for (std::size_t i = 0; i < visited_.size(); ++i) {
      if (reached[i]) forward(visited_[i], lanes, work.data());
    }
    for (std::size_t i = visited_.size(); i-- > 0;) {
      if (wanted_[i]) backward(visited_[i], lanes, work.data());
    }
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const T* values = work.data() + slot_of(column_of(rows_[i])) * kBlock;
      for (Eigen::Index c = 0; c < count; ++c) {
        result(static_cast<Eigen::Index>(i), first + c) = values[c];
      }
    }
  }

 private:
  using Lane = Eigen::Map<Eigen::Array<T, kBlock, 1>>;
  enum : std::uint8_t { kUnused, kWanted, kReached };

  int column_of(int row) const {
    const int block = symbolic_.block_size;
    return block * symbolic_.place[row / block] + row % block;
  }
  std::size_t slot_of(int column) const {
    const int block = symbolic_.block_size;
    return static_cast<std::size_t>(slot_[column / block]) + column % block;
  }

  void collect_lanes(int s, std::vector<T*>& lanes, T* work) const {
    const int block = symbolic_.block_size;
    lanes.clear();
    const auto add = [&](int column) {
      for (int b = 0; b < block; ++b) {
        lanes.push_back(work + (static_cast<std::size_t>(slot_[column]) + b) * kBlock);
      }
    };
    for (int c = symbolic_.first_column[s]; c < symbolic_.first_column[s + 1]; ++c) add(c);
    for (const int row : symbolic_.rows_of(s)) add(row);
  }

  void forward(int s, std::vector<T*>& lanes, T* work) const {
    collect_lanes(s, lanes, work);
    const int height = symbolic_.height(s), width = symbolic_.width(s);
    const T* column = factor_ + symbolic_.value_start[s];
    for (int j = 0; j < width; ++j, column += height) {
      Lane source(lanes[j]);
      source /= column[j];
      for (int i = j + 1; i < height; ++i) Lane(lanes[i]) -= source * column[i];
    }
  }

  void backward(int s, std::vector<T*>& lanes, T* work) const {
    collect_lanes(s, lanes, work);
    const int height = symbolic_.height(s), width = symbolic_.width(s);
    for (int j = width; j-- > 0;) {
      const T* column = factor_ + symbolic_.value_start[s] + static_cast<std::int64_t>(j) * height;
      Eigen::Array<T, kBlock, 1> sum = Lane(lanes[j]);
      for (int i = j + 1; i < height; ++i) sum -= column[i] * Lane(lanes[i]);
      Lane target(lanes[j]);
      target = sum / column[j];
    }
  }

  const Symbolic& symbolic_;
  const T* factor_;
  const SparseMatrix& rhs_;
  const std::vector<int>& rows_;
  std::vector<int> supernode_;  // per column of L
  std::vector<int> slot_;     // per column of L that matters: where its lanes are in the workspace
  std::vector<int> visited_;  // supernodes that matter, ascending
  std::vector<int> rank_;     // per supernode that matters: its place in `visited_`
  std::vector<bool> wanted_;  // per entry of `visited_`: whether the backward solve needs it
  int slots_ = 0;
};

}  // namespace

PermutedPattern permute_pattern(const SparseMatrix& lower, const Symbolic& symbolic, int threads) {
  const int n = static_cast<int>(lower.cols()), block = symbolic.block_size, shift = block - 1;
  const int *start = lower.outerIndexPtr(), *row = lower.innerIndexPtr();
  const auto place = [&](int r) { return block * symbolic.place[r >> shift] + (r & shift); };
  PermutedPattern pattern;
  BucketSort<int> sort(threads, n, n, pattern.start, [&](std::int64_t c, const auto& count) {
    const int column = place(static_cast<int>(c));
    for (int e = start[c]; e < start[c + 1]; ++e) count(std::min(column, place(row[e])));
  });
  const auto entries = static_cast<std::size_t>(lower.nonZeros());
  parallel_assign(threads, pattern.row, entries);
  parallel_assign(threads, pattern.source, entries);
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
                          int threads, const Poll& poll) {
  const std::int64_t size = symbolic.value_start.back();
  if (capacity_ < size) {
    clear();
    values_ = allocate_large<T>(size);
    capacity_ = size;
  }
  return Numeric<T>(vectors_, symbolic, pattern, values, values_.get(), threads).run(poll);
}

template <class T>
void Factor<T>::solve(const Symbolic& symbolic, T* x, int columns, int threads) const {
  TreeSolve<T>(vectors_, symbolic, values_.get(), x, columns, threads).run();
}

template <class T>
DenseMatrix Factor<T>::solve_rows(const Symbolic& symbolic, const SparseMatrix& rhs,
                                  const std::vector<int>& rows, int threads) const {
  DenseMatrix result(static_cast<Eigen::Index>(rows.size()), rhs.cols());
  const PrunedSolve<T> pruned(symbolic, values_.get(), rhs, rows);
  parallel_for(
      threads, rhs.cols(), PrunedSolve<T>::kBlock,
      [&](std::int64_t begin, std::int64_t end) { pruned.run(begin, end - begin, result); });
  return result;
}

template class Factor<float>;
template class Factor<double>;

}  // namespace beltrami
