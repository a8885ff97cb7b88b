#include "linear/cholesky/symbolic.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "base/interrupt.h"
#include "base/parallel.h"

namespace beltrami {
namespace {

constexpr int kRoot = -1;

/// The parent of column j is the first row below the diagonal of column j of L (Liu 1986).
/// The graph is numbered in the order of elimination.
std::vector<int> elimination_tree(const Graph& graph) {
  std::vector<int> parent(graph.count(), kRoot), ancestor(graph.count(), kRoot);
  for (int k = 0; k < graph.count(); ++k) {
    for (const int w : graph.neighbours(k)) {
      for (int i = w; i < k;) {
        const int next = std::exchange(ancestor[i], k);
        if (next == k) break;
        if (next == kRoot) {
          parent[i] = k;
          break;
        }
        i = next;
      }
    }
  }
  return parent;
}

/// The nodes of a forest, children (ascending) before parents, subtrees contiguous.
std::vector<int> postorder(const std::vector<int>& parent) {
  const int n = static_cast<int>(parent.size());
  std::vector<int> child(n, kRoot), sibling(n, kRoot), order, path;
  for (int v = n - 1; v >= 0; --v) {
    if (parent[v] == kRoot) continue;
    sibling[v] = child[parent[v]];
    child[parent[v]] = v;
  }
  order.reserve(n);
  for (int root = 0; root < n; ++root) {
    if (parent[root] != kRoot) continue;
    path.assign(1, root);
    while (!path.empty()) {
      const int v = path.back();
      if (child[v] != kRoot) {
        path.push_back(std::exchange(child[v], kRoot));
        continue;
      }
      order.push_back(v);
      path.pop_back();
      if (sibling[v] != kRoot) path.push_back(sibling[v]);
    }
  }
  return order;
}

/// Entries of every column of L, diagonal included; `post` is a postorder of the tree.
std::vector<int> column_counts(const Graph& graph, const std::vector<int>& parent,
                               const std::vector<int>& post) {
  const int n = graph.count();
  std::vector<int> count(n), first(n, kRoot), set(n), last_leaf(n, kRoot), last_first(n, kRoot);
  for (int p = 0; p < n; ++p) {
    int v = post[p];
    count[v] = first[v] == kRoot ? 1 : 0;  // a leaf of the tree starts a count
    for (; v != kRoot && first[v] == kRoot; v = parent[v]) first[v] = p;
  }
  std::iota(set.begin(), set.end(), 0);
  for (int p = 0; p < n; ++p) {
    const int j = post[p];
    if (parent[j] != kRoot) --count[parent[j]];
    for (const int i : graph.neighbours(j)) {
      // Row i's pattern is a subtree of the tree; j is one of its leaves if nothing below j is.
      if (i < j || first[j] <= last_first[i]) continue;
      last_first[i] = first[j];
      ++count[j];
      const int before = std::exchange(last_leaf[i], j);
      if (before == kRoot) continue;
      int common = before;  // the least common ancestor of two leaves is counted twice
      while (common != set[common]) common = set[common];
      for (int v = before; v != common;) v = std::exchange(set[v], common);
      --count[common];
    }
    if (parent[j] != kRoot) set[j] = parent[j];
  }
  for (const int v : post) {
    if (parent[v] != kRoot) count[parent[v]] += count[v];
  }
  return count;
}

/// The multiplications of a factorization whose columns have so many entries.
double work_of(const std::vector<int>& counts) {
  double work = 0;
  for (const int c : counts) work += static_cast<double>(c) * c;
  return work;
}

/// Nanoseconds, roughly, that a supernode of k columns with r rows below costs, factor and solves
/// together. Only ratios matter: they decide which supernodes are merged.
double cost(double k, double r) {
  constexpr double kFront = 200, kRow = 4, kUpdate = 0.7, kEntry = 2, kMultiply = 0.1;
  const double work = k * r * r + k * k * r + k * k * k / 3;
  return kFront + kRow * (k + r) + kUpdate * r * r + kEntry * k * (k + r) + kMultiply * work;
}

/// A supernode before its rows are known.
struct Node {
  int columns, rows;  // rows: below the diagonal block
  int parent = kRoot;
  int merged_into = kRoot;
};

/// The supernodes of L as the column counts show them, and the vertices in each.
struct Supernodes {
  std::vector<Node> nodes;
  std::vector<int> start;  // per node, and one more: its first vertex in the postorder
};

/// Runs of the postorder in which each vertex is a child of the next one, and its column of L has
/// the rows of the next one's and itself.
Supernodes find_supernodes(const std::vector<int>& tree, const std::vector<int>& post,
                           const std::vector<int>& counts) {
  const int n = static_cast<int>(post.size());
  Supernodes result;
  std::vector<int> node_of(n);
  for (int p = 0; p < n; ++p) {
    const int v = post[p];
    const bool joins = p > 0 && tree[post[p - 1]] == v && counts[post[p - 1]] == counts[v] + 1;
    if (!joins) {
      result.start.push_back(p);
      result.nodes.push_back({0, 0});
    }
    result.nodes.back().columns += 1;
    result.nodes.back().rows = counts[v] - 1;
    node_of[v] = static_cast<int>(result.nodes.size()) - 1;
  }
  result.start.push_back(n);
  for (std::size_t s = 0; s < result.nodes.size(); ++s) {
    const int above = tree[post[result.start[s + 1] - 1]];
    if (above != kRoot) result.nodes[s].parent = node_of[above];
  }
  return result;
}

/// Merges children into their parents where that is cheaper. The columns of L that a child adds to
/// its parent get the parent's rows; nothing else changes.
void merge_nodes(std::vector<Node>& nodes, int scale) {
  const int n = static_cast<int>(nodes.size());
  std::vector<int> child(n, kRoot), sibling(n, kRoot), candidates;
  for (int s = 0; s < n; ++s) {
    Node& node = nodes[s];
    // The children so far, those with the most rows first: they bring the fewest zeros.
    candidates.clear();
    for (int c = child[s]; c != kRoot; c = sibling[c]) candidates.push_back(c);
    std::sort(candidates.begin(), candidates.end(), [&](int a, int b) {
      const int ra = nodes[a].rows, rb = nodes[b].rows;
      return ra > rb || (ra == rb && a < b);
    });
    child[s] = kRoot;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      const int c = candidates[i];
      const double apart = cost(scale * nodes[c].columns, scale * nodes[c].rows) +
                           cost(scale * node.columns, scale * node.rows);
      if (cost(scale * (nodes[c].columns + node.columns), scale * node.rows) < apart) {
        node.columns += nodes[c].columns;
        nodes[c].merged_into = s;
        for (int g = child[c]; g != kRoot; g = sibling[g]) {
          nodes[g].parent = s;
          candidates.push_back(g);
        }
      } else {
        sibling[c] = child[s];
        child[s] = c;
      }
    }
    if (node.parent != kRoot) {
      sibling[s] = child[node.parent];
      child[node.parent] = s;
    }
  }
}

/// Per node the one that it ended up in. Parents are brought up to date: a merge changes who is
/// whose parent.
std::vector<int> resolve_merges(std::vector<Node>& nodes) {
  std::vector<int> final_of(nodes.size());
  for (int s = static_cast<int>(nodes.size()); s-- > 0;) {
    final_of[s] = nodes[s].merged_into == kRoot ? s : final_of[nodes[s].merged_into];
    if (nodes[s].parent != kRoot) nodes[s].parent = final_of[nodes[s].parent];
  }
  return final_of;
}

/// Nanoseconds: smaller matrices are not worth a second thread.
constexpr double kLeastTaskCost = 3e5;

/// Which nodes lie above the tasks, and in which order the nodes are numbered.
struct Numbering {
  std::vector<int> order;  // of nodes
  std::vector<int> task_sizes;
};

Numbering number_nodes(const std::vector<Node>& nodes, int scale) {
  const int n = static_cast<int>(nodes.size());
  std::vector<double> below(n, 0);
  double total = 0;
  std::vector<int> alive, parent;  // without the merged ones
  std::vector<int> compact(n, kRoot);
  for (int s = 0; s < n; ++s) {
    if (nodes[s].merged_into != kRoot) continue;
    compact[s] = static_cast<int>(alive.size());
    alive.push_back(s);
  }
  for (const int s : alive) {
    const double own = cost(scale * nodes[s].columns, scale * nodes[s].rows);
    below[s] += own;
    total += own;
    if (nodes[s].parent != kRoot) below[nodes[s].parent] += below[s];
    parent.push_back(nodes[s].parent == kRoot ? kRoot : compact[nodes[s].parent]);
  }
  // A subtree is a task if it has no more work: on the average one has half of that.
  const double most = std::max(2 * total / kMostTasks, kLeastTaskCost);
  Numbering result;
  std::vector<int> top;
  for (const int c : postorder(parent)) {
    const int s = alive[c];
    const bool above = below[s] > most;
    if (above) {
      top.push_back(s);
      continue;
    }
    result.order.push_back(s);
    const bool root = parent[c] == kRoot || below[nodes[s].parent] > most;
    if (!root) continue;
    const int before = std::accumulate(result.task_sizes.begin(), result.task_sizes.end(), 0);
    result.task_sizes.push_back(static_cast<int>(result.order.size()) - before);
  }
  result.order.insert(result.order.end(), top.begin(), top.end());
  return result;
}

/// Children of every node, ascending, from their parents.
void list_children(Symbolic& symbolic) {
  const int n = symbolic.supernode_count();
  symbolic.child_start.assign(static_cast<std::size_t>(n) + 1, 0);
  for (const int p : symbolic.parent) {
    if (p != kRoot) ++symbolic.child_start[p + 1];
  }
  for (int s = 0; s < n; ++s) symbolic.child_start[s + 1] += symbolic.child_start[s];
  symbolic.child.resize(symbolic.child_start[n]);
  std::vector<int> cursor(symbolic.child_start.begin(), symbolic.child_start.end() - 1);
  for (int s = 0; s < n; ++s) {
    if (symbolic.parent[s] != kRoot) symbolic.child[cursor[symbolic.parent[s]]++] = s;
  }
}

/// Sizes, parents, children and tasks of the supernodes, in the order of `numbering`. Returns the
/// rank of each node in that order.
std::vector<int> lay_out(const std::vector<Node>& nodes, const Numbering& numbering,
                         Symbolic& symbolic) {
  const int count = static_cast<int>(numbering.order.size()), block = symbolic.block_size;
  std::vector<int> rank(nodes.size(), kRoot);
  symbolic.first_column.assign(static_cast<std::size_t>(count) + 1, 0);
  symbolic.row_start.assign(static_cast<std::size_t>(count) + 1, 0);
  symbolic.value_start.assign(static_cast<std::size_t>(count) + 1, 0);
  symbolic.parent.resize(count);
  for (int i = 0; i < count; ++i) {
    const Node& node = nodes[numbering.order[i]];
    rank[numbering.order[i]] = i;
    symbolic.first_column[i + 1] = symbolic.first_column[i] + node.columns;
    symbolic.row_start[i + 1] = symbolic.row_start[i] + node.rows;
    symbolic.value_start[i + 1] =
        symbolic.value_start[i] +
        static_cast<std::int64_t>(block * node.columns) * (block * (node.columns + node.rows));
  }
  for (int i = 0; i < count; ++i) {
    const int above = nodes[numbering.order[i]].parent;
    symbolic.parent[i] = above == kRoot ? kRoot : rank[above];
  }
  list_children(symbolic);
  int done = 0;
  for (const int size : numbering.task_sizes) {
    symbolic.tasks.push_back({done, done + size});
    done += size;
  }
  return rank;
}

/// Vertices of the graph to columns of L, and back.
struct Columns {
  std::vector<int> column;  // per vertex
  std::vector<int> vertex;  // per column
};

/// The columns of each supernode: those of the nodes merged into it, in postorder. `target`: the
/// supernode that each node ended up in.
Columns number_columns(const Supernodes& supernodes, const std::vector<int>& target,
                       const std::vector<int>& post, const std::vector<int>& first_column) {
  std::vector<int> cursor(first_column.begin(), first_column.end() - 1);
  Columns result = {std::vector<int>(post.size()), std::vector<int>(post.size())};
  for (std::size_t s = 0; s < supernodes.nodes.size(); ++s) {
    int& at = cursor[target[s]];
    for (int p = supernodes.start[s]; p < supernodes.start[s + 1]; ++p) {
      result.column[post[p]] = at;
      result.vertex[at++] = post[p];
    }
  }
  return result;
}

/// The rows of one supernode: those of the matrix and of its children, below its own columns.
void find_rows(const Graph& graph, const Columns& columns, Symbolic& symbolic, int s,
               std::vector<int>& seen) {
  const int begin = symbolic.first_column[s], end = symbolic.first_column[s + 1];
  int* const first = symbolic.rows.data() + symbolic.row_start[s];
  int* last = first;
  const auto add = [&](int row) {
    if (row < end || seen[row] == s) return;
    seen[row] = s;
    *last++ = row;
  };
  for (const int c : symbolic.children(s)) {
    for (const int row : symbolic.rows_of(c)) add(row);
  }
  for (int j = begin; j < end; ++j) {
    for (const int w : graph.neighbours(columns.vertex[j])) add(columns.column[w]);
  }
  std::sort(first, last);
}

/// The rows of all supernodes.
void find_all_rows(const Graph& graph, const Columns& columns, Symbolic& symbolic,
                   const Work& work) {
  symbolic.rows.resize(symbolic.row_start.back());
  // Subtrees side by side, in as many parts as there are threads, each with marks of its own.
  const auto tasks = static_cast<std::int64_t>(symbolic.tasks.size());
  const std::int64_t part =
      std::max<std::int64_t>(1, (tasks + work.threads() - 1) / work.threads());
  parallel_for(work, tasks, part, [&](std::int64_t begin, std::int64_t end) {
    std::vector<int> seen(graph.count(), kRoot);
    for (std::int64_t t = begin; t < end; ++t) {
      for (int s = symbolic.tasks[t].begin; s < symbolic.tasks[t].end; ++s) {
        find_rows(graph, columns, symbolic, s, seen);
      }
    }
  });
  std::vector<int> seen(graph.count(), kRoot);
  for (int s = symbolic.top_begin(); s < symbolic.supernode_count(); ++s) {
    find_rows(graph, columns, symbolic, s, seen);
  }
}

}  // namespace

Symbolic analyze_pattern(const Graph& given, const std::vector<int>& order, int block_size,
                         const Work& work) {
  const Graph graph = renumber(given, order, work);
  const std::vector<int> tree = elimination_tree(graph);
  const std::vector<int> post = postorder(tree);
  const std::vector<int> counts = column_counts(graph, tree, post);
  poll_interrupt();

  Supernodes supernodes = find_supernodes(tree, post, counts);
  merge_nodes(supernodes.nodes, block_size);
  std::vector<int> target = resolve_merges(supernodes.nodes);
  Symbolic symbolic;
  symbolic.block_size = block_size;
  symbolic.work = work_of(counts);
  const std::vector<int> rank =
      lay_out(supernodes.nodes, number_nodes(supernodes.nodes, block_size), symbolic);
  for (int& node : target) node = rank[node];
  const Columns columns = number_columns(supernodes, target, post, symbolic.first_column);
  symbolic.place.resize(given.count());
  for (int v = 0; v < given.count(); ++v) symbolic.place[order[v]] = columns.column[v];
  poll_interrupt();

  find_all_rows(graph, columns, symbolic, work);
  return symbolic;
}

double factor_work(const Graph& given, const std::vector<int>& order, const Work& work) {
  const Graph graph = renumber(given, order, work);
  const std::vector<int> tree = elimination_tree(graph);
  return work_of(column_counts(graph, tree, postorder(tree)));
}

}  // namespace beltrami
