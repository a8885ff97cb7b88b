#include "linear/cholesky/graph.h"

#include <algorithm>

#include "base/bucket_sort.h"
#include "base/parallel.h"

namespace beltrami {
namespace {

constexpr int kChunk = 1 << 15;

/// The clusters of a run of vertices, and what they touch.
struct Chunk {
  std::vector<int> start, member;  // by cluster of the chunk
  std::vector<int> degree, neighbour;
  int first = 0;  // its clusters
};

/// Numbers clusters within the chunk of vertices [begin, end).
void find_clusters(const Graph& graph, int begin, int end, std::vector<int>& cluster,
                   Chunk& chunk) {
  std::fill(cluster.begin() + begin, cluster.begin() + end, -1);
  chunk.member.reserve(end - begin);
  const auto put = [&](int v) {
    cluster[v] = static_cast<int>(chunk.start.size()) - 1;
    chunk.member.push_back(v);
  };
  for (int v = begin; v < end; ++v) {
    if (cluster[v] >= 0) continue;
    chunk.start.push_back(static_cast<int>(chunk.member.size()));
    put(v);
    for (const int w : graph.neighbours(v)) {
      if (w >= begin && w < end && cluster[w] < 0) put(w);
    }
  }
  chunk.start.push_back(static_cast<int>(chunk.member.size()));
}

/// Lists the clusters next to each cluster of the chunk.
void find_neighbours(const Graph& graph, const std::vector<int>& cluster, Chunk& chunk) {
  constexpr int kMany = 64;
  for (std::size_t c = 0; c + 1 < chunk.start.size(); ++c) {
    const int own = chunk.first + static_cast<int>(c);
    const std::ptrdiff_t first = std::ssize(chunk.neighbour);
    for (int i = chunk.start[c]; i < chunk.start[c + 1]; ++i) {
      for (const int w : graph.neighbours(chunk.member[i])) {
        const int other = cluster[w];
        if (other == own) continue;
        // As long as they are few, a look along the list is cheaper than sorting it.
        const auto known = chunk.neighbour.begin() + first, end = chunk.neighbour.end();
        const bool many = end - known >= kMany;
        if (many || std::find(known, end, other) == end) chunk.neighbour.push_back(other);
      }
    }
    if (std::ssize(chunk.neighbour) - first > kMany) {
      const auto known = chunk.neighbour.begin() + first;
      std::sort(known, chunk.neighbour.end());
      chunk.neighbour.erase(std::unique(known, chunk.neighbour.end()), chunk.neighbour.end());
    }
    chunk.degree.push_back(static_cast<int>(std::ssize(chunk.neighbour) - first));
  }
}

}  // namespace

int block_size_of(const SparseMatrix& lower) {
  const int n = static_cast<int>(lower.cols());
  if (n == 0 || n % 2 != 0) return 1;
  const int *start = lower.outerIndexPtr(), *row = lower.innerIndexPtr();
  for (int c = 0; c < n; c += 2) {
    const int first = start[c], second = start[c + 1];
    const int count = second - first;
    if (count % 2 != 0 || start[c + 2] - second != count - 1 || row[first] != c) return 1;
    for (int i = 1; i < count; ++i) {
      if (row[first + i] != row[second + i - 1]) return 1;
      if (i % 2 != 0 && (row[first + i - 1] % 2 != 0 || row[first + i] != row[first + i - 1] + 1)) {
        return 1;
      }
    }
  }
  return 2;
}

Graph graph_of(const SparseMatrix& lower, int block_size, const Work& work) {
  const int n = static_cast<int>(lower.cols()) / block_size;
  const int *start = lower.outerIndexPtr(), *row = lower.innerIndexPtr();
  const auto for_each_row_below = [&](std::int64_t c, auto&& visit) {
    const std::int64_t column = c * block_size;
    for (int i = start[column]; i < start[column + 1]; i += block_size) {
      const int r = row[i] / block_size;
      if (r > c) visit(r);
    }
  };
  Graph graph;
  BucketSort<std::uint32_t> sort(work, n, n, graph.start, [&](std::int64_t c, const auto& count) {
    for_each_row_below(c, [&](int r) {
      count(r);
      count(c);
    });
  });
  parallel_assign(work, graph.neighbour, graph.start[n]);
  sort.place([&](std::int64_t c, const auto& place) {
    for_each_row_below(c, [&](int r) {
      graph.neighbour[place(r)] = static_cast<int>(c);
      graph.neighbour[place(c)] = r;
    });
  });
  return graph;
}

Graph renumber(const Graph& graph, const std::vector<int>& order, const Work& work) {
  std::vector<int> place(order.size());
  for (int i = 0; i < graph.count(); ++i) place[order[i]] = i;
  Graph result;
  result.start.resize(graph.start.size());
  result.start[0] = 0;
  for (int i = 0; i < graph.count(); ++i) {
    result.start[i + 1] = result.start[i] + (graph.start[order[i] + 1] - graph.start[order[i]]);
  }
  parallel_assign(work, result.neighbour, graph.neighbour.size());
  parallel_for(work, graph.count(), 16384, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i) {
      int* target = result.neighbour.data() + result.start[i];
      for (const int w : graph.neighbours(order[i])) *target++ = place[w];
    }
  });
  return result;
}

ClusterGraph coarsen(const Graph& graph, const Work& work) {
  ClusterGraph coarse;
  std::vector<int>& cluster = coarse.cluster;
  cluster.resize(graph.count());
  std::vector<Chunk> chunks((graph.count() + kChunk - 1) / kChunk);
  const auto for_each_chunk = [&](const auto& body) {
    parallel_for(work, graph.count(), kChunk, [&](std::int64_t begin, std::int64_t end) {
      body(chunks[begin / kChunk], static_cast<int>(begin), static_cast<int>(end));
    });
  };
  for_each_chunk(
      [&](Chunk& chunk, int begin, int end) { find_clusters(graph, begin, end, cluster, chunk); });
  int count = 0;
  for (Chunk& chunk : chunks) {
    chunk.first = count;
    count += static_cast<int>(chunk.start.size()) - 1;
  }
  for_each_chunk([&](Chunk& chunk, int begin, int end) {
    for (int v = begin; v < end; ++v) cluster[v] += chunk.first;
  });
  for_each_chunk([&](Chunk& chunk, int, int) { find_neighbours(graph, cluster, chunk); });
  coarse.graph.start.reserve(static_cast<std::size_t>(count) + 1);
  coarse.graph.start.push_back(0);
  for (const Chunk& chunk : chunks) {
    for (const int d : chunk.degree) coarse.graph.start.push_back(coarse.graph.start.back() + d);
    coarse.graph.neighbour.insert(coarse.graph.neighbour.end(), chunk.neighbour.begin(),
                                  chunk.neighbour.end());
  }
  return coarse;
}

}  // namespace beltrami
