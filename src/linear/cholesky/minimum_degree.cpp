#include "linear/cholesky/minimum_degree.h"

#include <Eigen/OrderingMethods>
#include <algorithm>
#include <bit>
#include <limits>

#include "base/compiler.h"

namespace beltrami {
namespace {

// Leaves see so many vertices in all, those of their separators included.
constexpr int kMostInLeaf = 448;

}  // namespace

/// The number of a vertex around the leaf, a new one at need; -1: there is no room left.
int LeafOrder::number_around(int v) {
  std::size_t at = static_cast<std::size_t>(v) * 0x9E3779B1U % around_.size();
  while (around_[at].first != v) {
    if (around_[at].first < 0) {
      if (all_.size() >= kMostInLeaf) return -1;
      around_[at] = {v, static_cast<int>(all_.size())};
      all_.push_back(v);
      break;
    }
    at = (at + 1) % around_.size();
  }
  return around_[at].second;
}

[[gnu::always_inline]] inline std::int16_t LeafOrder::degree_of(int i) {
  int sum = 0;
  for (std::size_t w = 0; w < words_; ++w) sum += std::popcount(row(i)[w] & alive_[w]);
  return static_cast<std::int16_t>(sum);
}

template <class Visit>
[[gnu::always_inline]] inline void LeafOrder::for_each_bit(Visit&& visit) {
  for (std::size_t w = 0; w < words_; ++w) {
    for (std::uint64_t bits = pivot_[w]; bits != 0; bits &= bits - 1) {
      visit(static_cast<int>(64 * w) + std::countr_zero(bits));
    }
  }
}

[[gnu::always_inline]] inline void LeafOrder::eliminate_with(std::span<int> order) {
  constexpr std::int16_t kGone = std::numeric_limits<std::int16_t>::max();
  degree_.resize(count_);
  alive_.assign(words_, 0);
  for (std::size_t i = 0; i < all_.size(); ++i) alive_[i / 64] |= std::uint64_t{1} << (i % 64);
  pivot_.resize(words_);
  for (int i = 0; i < count_; ++i) degree_[i] = degree_of(i);
  int done = 0;
  const auto take = [&](int i) {
    order[done++] = all_[i];
    degree_[i] = kGone;
    alive_[i / 64] &= ~(std::uint64_t{1} << (i % 64));
  };
  while (done < count_) {
    std::int16_t least = kGone;
    for (const std::int16_t d : degree_) least = std::min(least, d);
    const int p =
        static_cast<int>(std::find(degree_.begin(), degree_.end(), least) - degree_.begin());
    take(p);
    std::int16_t clique = 0;
    for (std::size_t w = 0; w < words_; ++w) {
      pivot_[w] = row(p)[w] & alive_[w];
      clique = static_cast<std::int16_t>(clique + std::popcount(pivot_[w]));
    }
    touched_.clear();
    for_each_bit([&](int i) {
      if (i >= count_) return;
      std::uint64_t* r = row(i);
      for (std::size_t w = 0; w < words_; ++w) r[w] |= pivot_[w];
      r[i / 64] &= ~(std::uint64_t{1} << (i % 64));
      degree_[i] = degree_of(i);
      touched_.push_back(i);
    });
    // Those whose neighbours are the rest of the clique cause no fill any more.
    bool taken = false;
    for (const int i : touched_) {
      if (degree_[i] != clique - 1) continue;
      take(i);
      taken = true;
    }
    if (!taken) continue;
    for (const int i : touched_) {
      if (degree_[i] != kGone) degree_[i] = degree_of(i);
    }
  }
}

BELTRAMI_FOR_POPCNT void LeafOrder::eliminate_popcnt(std::span<int> order) {
  eliminate_with(order);
}

void LeafOrder::eliminate(std::span<int> order) {
  if (popcnt_) {
    eliminate_popcnt(order);
  } else {
    eliminate_with(order);
  }
}

void LeafOrder::run(const Graph& graph, std::span<int> vertices, std::vector<int>& local) {
  count_ = static_cast<int>(vertices.size());
  all_.assign(vertices.begin(), vertices.end());
  for (int i = 0; i < count_; ++i) local[vertices[i]] = i;
  edges_.clear();
  around_.fill({-1, -1});
  for (int i = 0; i < count_; ++i) {
    for (const int w : graph.neighbours(all_[i])) {
      const int j = local[w] >= 0 ? local[w] : number_around(w);
      if (j >= 0) edges_.emplace_back(i, j);
    }
  }
  words_ = (all_.size() + 63) / 64;
  rows_.assign(words_ * count_, 0);
  for (const auto& [i, j] : edges_) row(i)[j / 64] |= std::uint64_t{1} << (j % 64);
  for (const int v : vertices) local[v] = -1;
  eliminate(vertices);
}

std::vector<int> minimum_degree_order(const Graph& graph) {
  // With the diagonal: Eigen takes rows without it for dense ones.
  const int n = graph.count();
  Eigen::SparseMatrix<signed char, Eigen::ColMajor, int> pattern(n, n);
  pattern.resizeNonZeros(static_cast<Eigen::Index>(graph.neighbour.size()) + n);
  int *start = pattern.outerIndexPtr(), *row = pattern.innerIndexPtr();
  start[0] = 0;
  for (int v = 0; v < n; ++v) {
    *row++ = v;
    row = std::copy(graph.neighbours(v).begin(), graph.neighbours(v).end(), row);
    start[v + 1] = static_cast<int>(row - pattern.innerIndexPtr());
  }
  // One longer than the result, as Eigen works on it: where memory ends, its resizing of what is
  // not empty frees twice.
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order(n + 1);
  Eigen::internal::minimum_degree_ordering(pattern, order);
  return {order.indices().begin(), order.indices().end()};
}

}  // namespace beltrami
