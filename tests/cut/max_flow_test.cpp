// Least cuts, against all cuts.
#include "cut/max_flow.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "base/types.h"
#include "support/polls.h"
#include "support/surfaces.h"

namespace beltrami {
namespace {

struct Network {
  std::vector<Terminal> terminals;
  std::vector<FlowEdge> edges;

  Index count() const { return size_of(terminals); }
  template <class IsSource>
  double capacity(const IsSource& is_source) const {
    double sum = 0;
    for (const FlowEdge& edge : edges) {
      if (is_source(edge.one) != is_source(edge.other)) sum += edge.capacity;
    }
    return sum;
  }
  template <class IsSource>
  bool keeps_terminals(const IsSource& is_source) const {
    for (Index n = 0; n < count(); ++n) {
      if (terminals[n] != Terminal::kNeither &&
          is_source(n) != (terminals[n] == Terminal::kSource)) {
        return false;
      }
    }
    return true;
  }
};

Network random_network(std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  const auto below = [&](Index bound) { return meshes::random_below(generator, bound); };
  Network network;
  const Index count = 2 + below(8);
  network.terminals.assign(count, Terminal::kNeither);
  network.terminals[below(count)] = Terminal::kSource;
  for (Index i = below(3); i-- > 0;) network.terminals[below(count)] = Terminal::kSink;
  for (Index i = below(3 * count); i-- > 0;) {
    network.edges.push_back({below(count), below(count), static_cast<double>(below(8))});
  }
  return network;
}

/// The least capacity of all cuts.
double least_capacity(const Network& network) {
  double least = std::numeric_limits<double>::infinity();
  for (unsigned mask = 0; mask < 1U << network.count(); ++mask) {
    const auto is_source = [&](Index n) { return (mask >> n & 1U) != 0; };
    if (!network.keeps_terminals(is_source)) continue;
    least = std::min(least, network.capacity(is_source));
  }
  return least;
}

TEST(LeastCut, IsLeast) {
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    const Network network = random_network(seed);
    const std::vector<bool> cut = least_cut(network.terminals, network.edges);
    const auto is_source = [&](Index n) { return bool{cut[n]}; };
    EXPECT_TRUE(network.keeps_terminals(is_source)) << seed;
    EXPECT_EQ(network.capacity(is_source), least_capacity(network)) << seed;
  }
}

/// A grid of nodes between its first and last columns.
Network grid_network(Index n) {
  Network network;
  for (Index i = 0; i < n * n; ++i) {
    network.terminals.push_back(i % n == 0       ? Terminal::kSource
                                : i % n == n - 1 ? Terminal::kSink
                                                 : Terminal::kNeither);
    if (i % n + 1 < n) network.edges.push_back({i, i + 1, 1.0 + i * 7 % 13});
    if (i + n < n * n) network.edges.push_back({i, i + n, 1.0 + i * 5 % 11});
  }
  return network;
}

TEST(LeastCut, IsTheOneNearestToTheSinks) {
  // Along a path of even edges.
  const std::vector<bool> cut =
      least_cut({Terminal::kSource, Terminal::kNeither, Terminal::kNeither, Terminal::kSink},
                {{0, 1, 0.25}, {1, 2, 0.25}, {2, 3, 0.25}});
  EXPECT_EQ(cut, std::vector<bool>({true, true, true, false}));
}

TEST(LeastCut, CanBeCancelled) {
  const Network network = grid_network(100);
  EXPECT_GT(count_polls([&] { least_cut(network.terminals, network.edges); }), 1);
}

}  // namespace
}  // namespace beltrami
