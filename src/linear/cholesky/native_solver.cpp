#include "linear/cholesky/native_solver.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/interrupt.h"
#include "base/parallel.h"
#include "base/scratch.h"
#include "base/types.h"
#include "linear/cholesky/compact_factor.h"
#include "linear/cholesky/front.h"
#include "linear/cholesky/graph.h"
#include "linear/cholesky/minimum_degree.h"
#include "linear/cholesky/multifrontal.h"
#include "linear/cholesky/nested_dissection.h"
#include "linear/cholesky/symbolic.h"

namespace beltrami {
namespace {

constexpr int kMaxSteps = 16;

// Multiplications per vertex^(3/2) that nested dissection of a surface does not exceed, unless its
// places mislead.
constexpr double kMostWork = 20;

bool all_finite(std::span<const Place> places) {
  return std::all_of(places.begin(), places.end(), [](const Place& p) {
    return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
  });
}

class NativeSolver final : public SpdSolver {
 public:
  NativeSolver(const SolverOptions& options, int least_single, const Work& work)
      : options_(options), least_single_(least_single), work_(work) {}

  using SpdSolver::analyze;
  void analyze(const SparseMatrix& lower, std::span<const Place> places,
               std::span<const int> given) override {
    single_.clear();
    double_.clear();
    compact_ = {};
    scaling_.clear();
    // An order says how large the blocks are: a few rows may look like blocks by chance.
    const int block =
        given.empty() ? block_size_of(lower) : static_cast<int>(lower.cols() / std::ssize(given));
    const Graph graph = graph_of(lower, block, work_);
    poll_interrupt();
    std::vector<int> order(given.begin(), given.end());
    const bool has_places = static_cast<int>(places.size()) == graph.count() && all_finite(places);
    const bool doubtful = order.empty() && has_places && graph.count() >= kLeastDissected;
    if (doubtful) {
      order = nested_dissection_order(graph, places, work_);
    } else if (order.empty()) {
      order = minimum_degree_order(graph);
    }
    poll_interrupt();
    symbolic_ = analyze_pattern(graph, order, block, work_);
    const double count = graph.count();
    if (doubtful && symbolic_.work > kMostWork * count * std::sqrt(count)) {
      const std::vector<int> other = minimum_degree_order(graph);
      if (factor_work(graph, other, work_) < symbolic_.work) {
        symbolic_ = analyze_pattern(graph, other, block, work_);
      }
    }
    pattern_ = permute_pattern(lower, symbolic_, work_);
  }

  bool factorize(const SparseMatrix& lower) override {
    if (lower.cols() == 0) return true;
    if (options_.precision == Precision::kDouble || lower.cols() < least_single_) {
      return factorize_double(lower.valuePtr());
    }
    double_.clear();
    if (!scale(lower)) return false;
    std::vector<float> values(values_.begin(), values_.end());
    if (single_.factorize(symbolic_, pattern_, values.data(), work_)) {
      return true;
    }
    single_.clear();
    return double_.factorize(symbolic_, pattern_, values_.data(), work_);
  }

  DenseMatrix solve(const DenseMatrix& rhs) const override {
    const auto n = static_cast<std::size_t>(rhs.rows());
    const auto columns = static_cast<int>(rhs.cols());
    if (n == 0 || columns == 0) return rhs;
    std::vector<double> x = permuted<double>(rhs);
    if (!single_.empty()) {
      const std::vector<double> b = x;
      if (!iterate(b, x, columns)) {
        if (!double_.factorize(symbolic_, pattern_, values_.data(), work_)) {
          double_.clear();
          throw Error(Fault::kSolver, "a linear system is not definite in floating point");
        }
        single_.clear();
        x = b;
      }
    }
    if (single_.empty()) double_.solve(symbolic_, x.data(), columns, work_);
    return restored(x, columns);
  }

  DenseMatrix precondition(const DenseMatrix& rhs) const override {
    const bool is_single = !single_.empty() || !compact_.empty();
    if (!is_single || rhs.size() == 0) return solve(rhs);
    // A power of two keeps the numbers in the range of single precision, and costs no bits.
    const double unit = unit_of(largest_of(rhs.data(), rhs.size()));
    std::vector<float> x = permuted<float>(rhs, 1 / unit);
    const int columns = static_cast<int>(rhs.cols());
    if (compact_.empty()) {
      single_.solve(symbolic_, x.data(), columns, work_);
    } else {
      compact_.solve(vectors_, symbolic_, x.data(), columns, work_);
    }
    return restored(x, columns, unit);
  }

  void keep_preconditioner() override {
    if (single_.empty()) return;  // solve() is what preconditions then
    values_ = {};
    unscaling_ = {};
    pattern_ = {};
    compact_ = CompactFactor(symbolic_, single_.panels(), work_);
    single_.clear();
  }

  DenseMatrix solve_rows(const SparseMatrix& rhs, const std::vector<int>& rows) const override {
    if (rows.empty() || rhs.cols() == 0) return DenseMatrix(rows.size(), rhs.cols());
    if (single_.empty() && scaling_.empty()) {
      return double_.solve_rows(symbolic_, rhs, rows, work_);
    }
    return rows_of_whole_solves(*this, rhs, rows);
  }

 private:
  static constexpr std::int64_t kGrain = 2048;

  static double unit_of(double largest) {
    if (!(largest > 0) || !std::isfinite(largest)) return 1;
    return std::ldexp(1.0, std::clamp(std::ilogb(largest), -1000, 1000));
  }

  int column_of(int row) const {
    const int block = symbolic_.block_size;
    return block == 1 ? symbolic_.place[row] : 2 * symbolic_.place[row / 2] + row % 2;
  }

  bool factorize_double(const double* values) {
    Scratch<double> gathered(work_, pattern_.source.size());
    parallel_for(work_, size_of(pattern_.source), kGrain,
                 [&](std::int64_t begin, std::int64_t end) {
                   for (std::int64_t e = begin; e < end; ++e) {
                     gathered[e] = values[pattern_.source[e]];
                   }
                 });
    return double_.factorize(symbolic_, pattern_, gathered.data(), work_);
  }

  /// Scales the matrix to a diagonal near 1, by powers of two. False: the diagonal is not positive.
  bool scale(const SparseMatrix& lower) {
    const int n = static_cast<int>(lower.cols());
    const double* given = lower.valuePtr();
    parallel_assign(work_, values_, pattern_.source.size());
    scaling_.assign(n, 0);
    std::atomic<bool> positive{true};
    parallel_for(work_, n, kGrain, [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t c = begin; c < end; ++c) {
        for (int e = pattern_.start[c]; e < pattern_.start[c + 1]; ++e) {
          const double diagonal = given[pattern_.source[e]];
          if (pattern_.row[e] != c || !(diagonal > 0) || !std::isfinite(diagonal)) continue;
          scaling_[c] = std::ldexp(1.0, -(std::ilogb(diagonal) >> 1));
        }
        if (scaling_[c] == 0) positive = false;
      }
    });
    if (!positive) return false;
    unscaling_.resize(n);
    parallel_for(work_, n, kGrain, [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t c = begin; c < end; ++c) {
        unscaling_[c] = 1 / scaling_[c];
        for (int e = pattern_.start[c]; e < pattern_.start[c + 1]; ++e) {
          values_[e] = given[pattern_.source[e]] * scaling_[c] * scaling_[pattern_.row[e]];
        }
      }
    });
    return true;
  }

  double scaling(int column) const { return scaling_.empty() ? 1 : scaling_[column]; }

  /// In the order of L, scaled, column after column.
  template <class T>
  std::vector<T> permuted(const DenseMatrix& rhs, double factor = 1) const {
    const auto n = static_cast<int>(rhs.rows());
    std::vector<T> x;
    parallel_assign(work_, x, static_cast<std::size_t>(rhs.size()));
    for (Eigen::Index c = 0; c < rhs.cols(); ++c) {
      T* column = x.data() + c * n;
      parallel_for(work_, n, kGrain, [&](std::int64_t begin, std::int64_t end) {
        for (auto i = static_cast<int>(begin); i < end; ++i) {
          const int at = column_of(i);
          column[at] = static_cast<T>(rhs(i, c) * factor * scaling(at));
        }
      });
    }
    return x;
  }

  template <class T>
  DenseMatrix restored(const std::vector<T>& x, int columns, double factor = 1) const {
    const auto n = static_cast<int>(x.size() / columns);
    DenseMatrix result(n, columns);
    for (int c = 0; c < columns; ++c) {
      const T* column = x.data() + static_cast<std::size_t>(c) * n;
      parallel_for(work_, n, kGrain, [&](std::int64_t begin, std::int64_t end) {
        for (auto i = static_cast<int>(begin); i < end; ++i) {
          const int at = column_of(i);
          result(i, c) = static_cast<double>(column[at]) * scaling(at) * factor;
        }
      });
    }
    return result;
  }

  /// Y = A X for kColumns columns, with A scaled and in the order of L. The columns of a task have
  /// entries in its own rows and in those of the top; what they give to the latter is added after
  /// all of them, in the order of the columns.
  template <int kColumns>
  void multiply(const double* x, double* y) const {
    struct Aside {
      int row;
      std::array<double, kColumns> terms;
    };
    const std::int64_t n = pattern_.count();
    const auto first_of = [&](int s) {
      return std::int64_t{symbolic_.block_size} * symbolic_.first_column[s];
    };
    const std::int64_t top = first_of(symbolic_.top_begin());
    const auto add = [&](std::int64_t row, const std::array<double, kColumns>& terms) {
      for (int k = 0; k < kColumns; ++k) y[k * n + row] += terms[k];
    };
    const auto run = [&](std::int64_t begin, std::int64_t end, const auto& put) {
      for (std::int64_t c = begin; c < end; ++c) {
        std::array<double, kColumns> own, sum, terms;
        for (int k = 0; k < kColumns; ++k) {
          own[k] = x[k * n + c];
          sum[k] = y[k * n + c];
        }
        for (int e = pattern_.start[c]; e < pattern_.start[c + 1]; ++e) {
          const int r = pattern_.row[e];
          const double value = values_[e];
          for (int k = 0; k < kColumns; ++k) {
            sum[k] += value * x[k * n + r];
            terms[k] = value * own[k];
          }
          if (r != c) put(r, terms);
        }
        for (int k = 0; k < kColumns; ++k) y[k * n + c] = sum[k];
      }
    };
    const auto clear = [&](std::int64_t begin, std::int64_t end) {
      for (int k = 0; k < kColumns; ++k) std::fill(y + k * n + begin, y + k * n + end, 0.0);
    };
    std::vector<std::vector<Aside>> asides(symbolic_.tasks.size());
    parallel_for(work_, static_cast<std::int64_t>(asides.size()), 1,
                 [&](std::int64_t t, std::int64_t) {
                   const std::int64_t begin = first_of(symbolic_.tasks[t].begin);
                   const std::int64_t end = first_of(symbolic_.tasks[t].end);
                   clear(begin, end);
                   run(begin, end, [&](int row, const std::array<double, kColumns>& terms) {
                     if (row < top) {
                       add(row, terms);
                     } else {
                       asides[t].push_back({row, terms});
                     }
                   });
                 });
    clear(top, n);
    for (const std::vector<Aside>& aside : asides) {
      for (const Aside& a : aside) add(a.row, a.terms);
    }
    run(top, n, add);
  }

  template <class Body>
  void for_rows(std::int64_t n, const Body& body) const {
    parallel_for(work_, n, kGrain, [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t i = begin; i < end; ++i) body(i);
    });
  }

  /// Sums over the rows in fixed chunks: the same bits at any number of threads.
  template <class Term>
  double sum_rows(std::int64_t n, const Term& term) const {
    return parallel_sum(work_, n, kGrain, [&](std::int64_t begin, std::int64_t end) {
      double sum = 0;
      for (std::int64_t i = begin; i < end; ++i) sum += term(i);
      return sum;
    });
  }

  /// The largest magnitude.
  double largest_of(const double* values, std::int64_t n) const {
    std::vector<double> of_chunk(static_cast<std::size_t>((n + kGrain - 1) / kGrain), 0.0);
    parallel_for(work_, n, kGrain, [&](std::int64_t begin, std::int64_t end) {
      double largest = 0;
      for (std::int64_t i = begin; i < end; ++i) largest = std::max(largest, std::abs(values[i]));
      of_chunk[static_cast<std::size_t>(begin / kGrain)] = largest;
    });
    return of_chunk.empty() ? 0 : *std::max_element(of_chunk.begin(), of_chunk.end());
  }

  /// Conjugate gradients with the factor in single precision as preconditioner: one step per four
  /// digits or more, and where rounding spoils the factor still convergence. False: none.
  /// For one right-hand side or two; all of a step is done for both, which have nothing else in
  /// common.
  template <int kColumns>
  bool iterate(const double* b, double* x) const {
    const std::int64_t n = pattern_.count(), size = n * kColumns;
    std::vector<double> residual, direction, product;
    std::vector<float> correction;
    for (std::vector<double>* vector : {&residual, &direction, &product}) {
      parallel_assign(work_, *vector, static_cast<std::size_t>(size));
    }
    parallel_assign(work_, correction, static_cast<std::size_t>(size));
    std::copy(b, b + size, residual.begin());
    std::array<double, kColumns> rho{}, goal{};
    std::array<bool, kColumns> done{};
    std::fill(x, x + size, 0.0);
    // The norm is in the units of the matrix as it was given.
    for (int k = 0; k < kColumns; ++k) {
      const double size_sq = sum_rows(n, [&](std::int64_t i) {
        const double value = b[k * n + i] * unscaling_[i];
        return value * value;
      });
      if (!std::isfinite(size_sq)) return false;
      goal[k] = options_.residual * options_.residual * size_sq;
      done[k] = size_sq == 0;
    }
    for (int step = 0; step < kMaxSteps; ++step) {
      if (std::all_of(done.begin(), done.end(), [](bool d) { return d; })) return true;
      std::array<double, kColumns> unit{};
      for (int k = 0; k < kColumns; ++k) {
        unit[k] = unit_of(largest_of(residual.data() + k * n, n));
        const double inverse = 1 / unit[k];
        for_rows(n, [&](std::int64_t i) {
          correction[k * n + i] = static_cast<float>(residual[k * n + i] * inverse);
        });
      }
      single_.solve(symbolic_, correction.data(), kColumns, work_);
      for (int k = 0; k < kColumns; ++k) {
        if (done[k]) continue;
        const double* r = residual.data() + k * n;
        const float* z = correction.data() + k * n;
        double* p = direction.data() + k * n;
        const double next = sum_rows(n, [&](std::int64_t i) { return r[i] * (z[i] * unit[k]); });
        const double beta = rho[k] == 0 ? 0 : next / rho[k];
        rho[k] = next;
        for_rows(n, [&](std::int64_t i) { p[i] = z[i] * unit[k] + beta * p[i]; });
      }
      multiply<kColumns>(direction.data(), product.data());
      for (int k = 0; k < kColumns; ++k) {
        if (done[k]) continue;
        double *r = residual.data() + k * n, *u = x + k * n;
        const double *p = direction.data() + k * n, *q = product.data() + k * n;
        const double curvature = sum_rows(n, [&](std::int64_t i) { return p[i] * q[i]; });
        const double length = rho[k] / curvature;
        if (!(curvature > 0) || !(rho[k] > 0) || !std::isfinite(length)) return false;
        const double left = sum_rows(n, [&](std::int64_t i) {
          u[i] += length * p[i];
          r[i] -= length * q[i];
          const double value = r[i] * unscaling_[i];
          return value * value;
        });
        done[k] = left <= goal[k];
      }
    }
    return std::all_of(done.begin(), done.end(), [](bool d) { return d; });
  }

  bool iterate(const std::vector<double>& b, std::vector<double>& x, int columns) const {
    const std::size_t n = b.size() / columns;
    for (int k = 0; k < columns; k += 2) {
      const double* from = b.data() + k * n;
      double* to = x.data() + k * n;
      if (!(k + 1 < columns ? iterate<2>(from, to) : iterate<1>(from, to))) return false;
    }
    return true;
  }

  const SolverOptions options_;
  const int least_single_;
  const Work work_;
  const front::Vectors vectors_ = front::widest_vectors(work_);
  Symbolic symbolic_;
  PermutedPattern pattern_;
  // The matrix in the order of L, scaled; with factors in single precision only, which need it.
  std::vector<double> values_, scaling_, unscaling_;
  // One of them is empty. A single one that turns out to be useless is replaced while solving.
  mutable Factor<float> single_{vectors_};
  mutable Factor<double> double_{vectors_};
  CompactFactor compact_;  // of the one in single precision, when that serves nothing else
};

}  // namespace

std::unique_ptr<SpdSolver> make_native_solver(const SolverOptions& options, int least_single,
                                              const Work& work) {
  return std::make_unique<NativeSolver>(options, least_single, work);
}

}  // namespace beltrami
