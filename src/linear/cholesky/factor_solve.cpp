#include "linear/cholesky/factor_solve.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "base/parallel.h"
#include "base/types.h"
#include "linear/cholesky/workspace_pool.h"

namespace beltrami {
namespace {

/// Entries of fronts of the top at one depth that are worth several threads.
constexpr std::int64_t kWorthThreads = 50000;

/// Solves with subtrees side by side, then the fronts of the top that have the same depth. What
/// these subtract from rows above is collected apart and applied in their order.
template <class T>
class TreeSolve {
 public:
  TreeSolve(front::Vectors vectors, const Symbolic& symbolic, const PanelOf<T>& panel_of, T* x,
            int columns, const Work& work)
      : vectors_(vectors),
        symbolic_(symbolic),
        panel_of_(panel_of),
        x_(x),
        columns_(columns),
        work_(work),
        size_(static_cast<std::int64_t>(symbolic.column_count()) * symbolic.block_size),
        top_(static_cast<std::int64_t>(symbolic.block_size) *
             symbolic.first_column[symbolic.top_begin()]),
        sums_(symbolic.tasks.size()),
        waves_(waves_of(symbolic)) {
    for (int s = 0; s < symbolic.supernode_count(); ++s) {
      highest_ = std::max(highest_, symbolic.height(s));
    }
  }

  void run() {
    const auto tasks = static_cast<std::int64_t>(symbolic_.tasks.size());
    WorkspacePool<Workspace> pool;
    const auto make = [&] {
      auto work = std::make_unique<Workspace>();
      work->front.resize(static_cast<std::size_t>(highest_) * columns_);
      return work;
    };
    parallel_for(work_, tasks, 1, [&](std::int64_t t, std::int64_t) {
      auto work = pool.take(make);
      work->above.resize(static_cast<std::size_t>((size_ - top_) * columns_), T(0));
      const Symbolic::Range task = symbolic_.tasks[t];
      for (int s = task.begin; s < task.end; ++s) forward(s, *work);
      collect(static_cast<int>(t), *work);
      pool.give_back(std::move(work));
    });
    for (int t = 0; t < tasks; ++t) apply(symbolic_.tasks[t].end - 1, sums_[t]);
    const auto for_wave = [&](const Wave& wave, const auto& body) {
      const std::int64_t count = size_of(wave.fronts);
      parallel_for(work_, count, wave.worth_threads ? 1 : count,
                   [&](std::int64_t begin, std::int64_t end) {
                     auto own = pool.take(make);
                     for (std::int64_t i = begin; i < end; ++i) body(i, *own);
                     pool.give_back(std::move(own));
                   });
    };
    for (std::size_t w = waves_.size(); w-- > 0;) {
      const std::vector<int>& fronts = waves_[w].fronts;
      std::vector<std::vector<T>> sums(fronts.size());
      for_wave(waves_[w],
               [&](std::int64_t i, Workspace& own) { sums[i] = forward_apart(fronts[i], own); });
      for (std::size_t i = 0; i < fronts.size(); ++i) apply(fronts[i], sums[i]);
    }
    for (const Wave& wave : waves_) {
      for_wave(wave, [&](std::int64_t i, Workspace& own) { backward(wave.fronts[i], own); });
    }
    parallel_for(work_, tasks, 1, [&](std::int64_t t, std::int64_t) {
      auto own = pool.take(make);
      const Symbolic::Range task = symbolic_.tasks[t];
      for (int s = task.end - 1; s >= task.begin; --s) backward(s, *own);
      pool.give_back(std::move(own));
    });
  }

 private:
  struct Workspace {
    std::vector<T> front, above;  // above: sums for the rows of the top
    std::vector<T> panel;
  };

  /// Supernodes of the top at one depth, which share no columns.
  struct Wave {
    bool worth_threads = false;
    std::vector<int> fronts;
  };

  /// From the roots down.
  static std::vector<Wave> waves_of(const Symbolic& symbolic) {
    const int top = symbolic.top_begin(), count = symbolic.supernode_count();
    std::vector<int> depth(count - top, 0);
    std::vector<Wave> waves;
    std::vector<std::int64_t> entries;
    for (int s = count - 1; s >= top; --s) {
      const int parent = symbolic.parent[s];
      const int own = parent >= 0 ? depth[parent - top] + 1 : 0;
      depth[s - top] = own;
      if (own == static_cast<int>(waves.size())) {
        waves.emplace_back();
        entries.push_back(0);
      }
      waves[own].fronts.push_back(s);
      entries[own] += static_cast<std::int64_t>(symbolic.height(s)) * symbolic.width(s);
      waves[own].worth_threads = entries[own] > kWorthThreads;
    }
    return waves;
  }

  /// Of a supernode in a task; what it subtracts from rows of the top goes into the workspace.
  void forward(int s, Workspace& work) {
    const int height = symbolic_.height(s), width = symbolic_.width(s),
              block = symbolic_.block_size;
    const std::int64_t first = static_cast<std::int64_t>(block) * symbolic_.first_column[s];
    const auto rows = symbolic_.rows_of(s);
    const std::size_t inside = rows_inside(rows);
    T* front = work.front.data();
    const auto target = [&](std::size_t i, int c) {
      const std::int64_t row = static_cast<std::int64_t>(block) * rows[i];
      return i < inside ? x_ + c * size_ + row
                        : work.above.data() + c * (size_ - top_) + (row - top_);
    };
    for (int c = 0; c < columns_; ++c) {
      std::copy_n(x_ + c * size_ + first, width, front + static_cast<std::int64_t>(c) * height);
      T* y = front + static_cast<std::int64_t>(c) * height + width;
      for (std::size_t i = 0; i < rows.size(); ++i) {
        const T* from = target(i, c);
        for (int b = 0; b < block; ++b) *y++ = from[b];
      }
    }
    front::solve_forward(vectors_, panel_of_(s, work.panel), height, width, front, columns_);
    for (int c = 0; c < columns_; ++c) {
      std::copy_n(front + static_cast<std::int64_t>(c) * height, width, x_ + c * size_ + first);
      const T* y = front + static_cast<std::int64_t>(c) * height + width;
      for (std::size_t i = 0; i < rows.size(); ++i) {
        T* to = target(i, c);
        for (int b = 0; b < block; ++b) to[b] = *y++;
      }
    }
  }

  /// Of a supernode of the top. Returns what it adds to the rows below the diagonal block, as
  /// apply() takes it.
  std::vector<T> forward_apart(int s, Workspace& work) {
    const int height = symbolic_.height(s), width = symbolic_.width(s), below = height - width;
    const std::int64_t first =
        static_cast<std::int64_t>(symbolic_.block_size) * symbolic_.first_column[s];
    T* front = work.front.data();
    for (int c = 0; c < columns_; ++c) {
      T* column = front + static_cast<std::int64_t>(c) * height;
      std::copy_n(x_ + c * size_ + first, width, column);
      std::fill_n(column + width, below, T(0));
    }
    front::solve_forward(vectors_, panel_of_(s, work.panel), height, width, front, columns_);
    std::vector<T> sums;
    sums.reserve(static_cast<std::size_t>(below) * columns_);
    for (int c = 0; c < columns_; ++c) {
      const T* column = front + static_cast<std::int64_t>(c) * height;
      std::copy_n(column, width, x_ + c * size_ + first);
      sums.insert(sums.end(), column + width, column + height);
    }
    return sums;
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
    front::solve_backward(vectors_, panel_of_(s, work.panel), height, width, front, columns_);
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

  /// Adds what was collected for the rows of a supernode.
  void apply(int s, const std::vector<T>& sums) {
    const auto rows = symbolic_.rows_of(s);
    const T* from = sums.data();
    for (int c = 0; c < columns_; ++c) {
      for (const int row : rows) {
        T* to = x_ + c * size_ + static_cast<std::int64_t>(symbolic_.block_size) * row;
        for (int b = 0; b < symbolic_.block_size; ++b) to[b] += *from++;
      }
    }
  }

  const front::Vectors vectors_;
  const Symbolic& symbolic_;
  const PanelOf<T>& panel_of_;
  T* const x_;
  const int columns_;
  const Work work_;
  const std::int64_t size_, top_;  // scalars: all, and before the top
  int highest_ = 0;
  std::vector<std::vector<T>> sums_;  // per task: for the rows of its root
  const std::vector<Wave> waves_;
};

/// Solves for some rows only. The tree of supernodes tells what matters: forward a right-hand side
/// touches the ancestors of its nonzeros only, backward a row of the solution needs its ancestors
/// only (Gilbert & Peierls 1988).
template <class T>
class PrunedSolve {
 public:
  /// Columns that are solved together: each entry of the factor is loaded once for all of them.
  static constexpr int kBlock = 16;

  PrunedSolve(front::Vectors vectors, const Symbolic& symbolic, const T* factor,
              const SparseMatrix& rhs, const std::vector<int>& rows)
      : vectors_(vectors), symbolic_(symbolic), factor_(factor), rhs_(rhs), rows_(rows) {
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
    const int lanes = count <= 4 ? 4 : count <= 8 ? 8 : kBlock;
    std::vector<T> work(static_cast<std::size_t>(slots_) * lanes, T(0));
    std::vector<bool> reached(visited_.size(), false);
    for (Eigen::Index c = 0; c < count; ++c) {
      for (SparseMatrix::InnerIterator entry(rhs_, first + c); entry; ++entry) {
        const int column = column_of(static_cast<int>(entry.row()));
        work[slot_of(column) * lanes + c] += static_cast<T>(entry.value());
        int s = supernode_[column / symbolic_.block_size];
        for (; s >= 0 && !reached[rank_[s]]; s = symbolic_.parent[s]) reached[rank_[s]] = true;
      }
    }
    std::vector<T*> at;
    for (std::size_t i = 0; i < visited_.size(); ++i) {
      if (!reached[i]) continue;
      const int s = visited_[i];
      collect_rows(s, lanes, work.data(), at);
      front::solve_forward_side_by_side(vectors_, factor_ + symbolic_.value_start[s],
                                        symbolic_.height(s), symbolic_.width(s), at.data(), lanes);
    }
    for (std::size_t i = visited_.size(); i-- > 0;) {
      if (!wanted_[i]) continue;
      const int s = visited_[i];
      collect_rows(s, lanes, work.data(), at);
      front::solve_backward_side_by_side(vectors_, factor_ + symbolic_.value_start[s],
                                         symbolic_.height(s), symbolic_.width(s), at.data(), lanes);
    }
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const T* values = work.data() + slot_of(column_of(rows_[i])) * lanes;
      for (Eigen::Index c = 0; c < count; ++c) {
        result(static_cast<Eigen::Index>(i), first + c) = values[c];
      }
    }
  }

 private:
  enum : std::uint8_t { kUnused, kWanted, kReached };

  int column_of(int row) const {
    const int block = symbolic_.block_size;
    return block * symbolic_.place[row / block] + row % block;
  }
  std::size_t slot_of(int column) const {
    const int block = symbolic_.block_size;
    return static_cast<std::size_t>(slot_[column / block]) + column % block;
  }

  /// Where the lanes of each row of a supernode's panel are.
  void collect_rows(int s, int lanes, T* work, std::vector<T*>& at) const {
    const int block = symbolic_.block_size;
    at.clear();
    const auto add = [&](int column) {
      for (int b = 0; b < block; ++b) {
        at.push_back(work + (static_cast<std::size_t>(slot_[column]) + b) * lanes);
      }
    };
    for (int c = symbolic_.first_column[s]; c < symbolic_.first_column[s + 1]; ++c) add(c);
    for (const int row : symbolic_.rows_of(s)) add(row);
  }

  const front::Vectors vectors_;
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

template <class T>
void solve_with_factor(front::Vectors vectors, const Symbolic& symbolic, const T* factor, T* x,
                       int columns, const Work& work) {
  const PanelOf<T> panel_of = [&](int s, std::vector<T>&) {
    return factor + symbolic.value_start[s];
  };
  solve_with_panels(vectors, symbolic, panel_of, x, columns, work);
}

template <class T>
void solve_with_panels(front::Vectors vectors, const Symbolic& symbolic, const PanelOf<T>& panel_of,
                       T* x, int columns, const Work& work) {
  TreeSolve<T>(vectors, symbolic, panel_of, x, columns, work).run();
}

template <class T>
DenseMatrix solve_rows_with_factor(front::Vectors vectors, const Symbolic& symbolic,
                                   const T* factor, const SparseMatrix& rhs,
                                   const std::vector<int>& rows, const Work& work) {
  DenseMatrix result(static_cast<Eigen::Index>(rows.size()), rhs.cols());
  const PrunedSolve<T> pruned(vectors, symbolic, factor, rhs, rows);
  parallel_for(work, rhs.cols(), PrunedSolve<T>::kBlock, [&](std::int64_t begin, std::int64_t end) {
    pruned.run(begin, end - begin, result);
  });
  return result;
}

template void solve_with_factor(front::Vectors, const Symbolic&, const float*, float*, int,
                                const Work&);
template void solve_with_factor(front::Vectors, const Symbolic&, const double*, double*, int,
                                const Work&);
template void solve_with_panels(front::Vectors, const Symbolic&, const PanelOf<float>&, float*, int,
                                const Work&);
template DenseMatrix solve_rows_with_factor(front::Vectors, const Symbolic&, const float*,
                                            const SparseMatrix&, const std::vector<int>&,
                                            const Work&);
template DenseMatrix solve_rows_with_factor(front::Vectors, const Symbolic&, const double*,
                                            const SparseMatrix&, const std::vector<int>&,
                                            const Work&);

}  // namespace beltrami
