#include "linear/cholesky/nested_dissection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <tuple>
#include <utility>

#include "base/interrupt.h"
#include "base/parallel.h"
#include "linear/cholesky/minimum_degree.h"
#include "linear/cholesky/vertex_separator.h"

namespace beltrami {
namespace {

// Parts of up to this many vertices are ordered by minimum degree: they fit into the nearest cache.
constexpr int kLeaf = 256;
// A part is split further on one thread; above, parts of a level are split side by side.
constexpr int kParts = 64;

struct Part {
  int begin, end;  // of the members
};

/// Splits parts of a graph in two and a separator, in place: first part, second part, separator.
/// The separator of a large part is sought among clusters first, in a wide band around the middle
/// of the part, and then among the vertices near the best of them.
class Dissection {
 public:
  Dissection(const Graph& graph, std::span<const Place> places, const Work& work)
      : graph_(graph), label_(graph.count()), members_(graph.count()) {
    for (int level = 0; level < kLevels; ++level) {
      coarse_.push_back(coarsen(level == 0 ? graph : coarse_.back().graph, work));
    }
    std::vector<int> finest(graph.count());
    parallel_for(work, graph.count(), 16384, [&](std::int64_t begin, std::int64_t end) {
      for (auto v = static_cast<int>(begin); v < end; ++v) {
        members_[v] = {places[v], v};
        label_[v] = kOutside;
        finest[v] = coarse_[1].cluster[coarse_[0].cluster[v]];
      }
    });
    coarse_[1].cluster.swap(finest);
  }

  struct Member {
    Place place;
    int vertex;
  };

  struct Scratch {
    struct Item {
      float key;
      int index;
      bool operator<(const Item& other) const {
        return key < other.key || (key == other.key && index < other.index);
      }
    };
    struct Cluster {
      int name;
      int size = 0;    // its vertices in the part
      double key = 0;  // their sum
      int label = 0;
    };
    std::vector<Item> items;  // of the part: index among the members
    std::vector<Item> band_items;
    std::vector<int> cluster_of;  // per item: its place in `clusters`
    std::vector<Cluster> clusters;
    std::array<std::vector<int>, 2>
        number;                           // per level and cluster: its place in `clusters`, or -1
    std::vector<int> band;                // vertices or clusters, first side to second side
    int own = 0;                          // the rest of the band was taken from the first side
    std::array<std::int64_t, 2> sizes{};  // of the sides besides the band
    std::vector<Member> second, separator;
    std::vector<int> leaf_vertices;
    VertexSeparator separate;
    LeafOrder leaf;
  };

  std::pair<Part, Part> split(Part part, Scratch& scratch) {
    const Place direction = longest_direction(part);
    const int count = part.end - part.begin;
    scratch.items.resize(count);
    for (int i = 0; i < count; ++i) {
      scratch.items[i] = {dot(members_[part.begin + i].place, direction), part.begin + i};
    }
    if (count < kFewest[0] || !label_by_clusters(count < kFewest[1] ? 0 : 1, scratch)) {
      label_by_place(scratch);
    }
    describe_band(
        graph_, [&](int v) { return label_[v]; }, scratch);
    const auto& sides = scratch.separate.cut(scratch.sizes[0], scratch.sizes[1]);

    scratch.second.clear();
    scratch.separator.clear();
    Member* target = members_.data() + part.begin;
    for (int i = part.begin; i < part.end; ++i) {
      const Member member = members_[i];
      int& label = label_[member.vertex];
      std::uint8_t side = VertexSeparator::kSourceSide;
      if (label >= 0) side = sides[label];
      if (label == kSecondCore) side = VertexSeparator::kSinkSide;
      label = kOutside;
      if (side == VertexSeparator::kSourceSide) {
        *target++ = member;
      } else {
        (side == VertexSeparator::kSinkSide ? scratch.second : scratch.separator).push_back(member);
      }
    }
    const Part first = {part.begin, static_cast<int>(target - members_.data())};
    target = std::copy(scratch.second.begin(), scratch.second.end(), target);
    const Part second = {first.end, static_cast<int>(target - members_.data())};
    std::copy(scratch.separator.begin(), scratch.separator.end(), target);
    sort_separator({second.end, part.end}, scratch);
    return {first, second};
  }

  /// On one thread, depth first.
  void finish(Part part, Scratch& scratch) {
    std::vector<Part> waiting = {part};
    while (!waiting.empty()) {
      const Part next = waiting.back();
      waiting.pop_back();
      if (next.end - next.begin <= kLeaf) {
        order_leaf(next, scratch);
        continue;
      }
      const auto [first, second] = split(next, scratch);
      waiting.push_back(second);
      waiting.push_back(first);
    }
  }

  const std::vector<Member>& members() const { return members_; }

 private:
  using Item = Scratch::Item;
  // What label_ says, besides the number of a vertex in the band (>= 0).
  static constexpr int kOutside = -1, kFirstCore = -2, kSecondCore = -3;
  static constexpr int kLevels = 2;
  // Parts of so many vertices are split by clusters of about 5, and of about 25.
  static constexpr std::array<int, kLevels> kFewest = {800, 2500};
  // In parts of so many, the band around a separator of clusters is three clusters wide, not one.
  static constexpr int kWide = 4000;
  // The share of a part, on each side of its middle, where the separator is looked for: wider bands
  // hold smaller separators, and cost more.
  static constexpr double kHalfBand = 0.08, kHalfBandOfClusters = 0.2;

  static float dot(const Place& a, const Place& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  }

  void order_leaf(Part part, Scratch& scratch) {
    auto& vertices = scratch.leaf_vertices;
    vertices.clear();
    for (int i = part.begin; i < part.end; ++i) vertices.push_back(members_[i].vertex);
    scratch.leaf.run(graph_, vertices, label_);
    for (int i = part.begin; i < part.end; ++i) members_[i].vertex = vertices[i - part.begin];
  }

  /// The direction in which the part extends the most, by power iterations on its covariance.
  Place longest_direction(Part part) const {
    std::array<double, 3> mean{};
    std::array<double, 6> moments{};
    const Place origin = members_[part.begin].place;
    for (int i = part.begin; i < part.end; ++i) {
      Place p = members_[i].place;
      for (int k = 0; k < 3; ++k) {
        p[k] -= origin[k];
        mean[k] += p[k];
      }
      moments[0] += p[0] * p[0];
      moments[1] += p[1] * p[1];
      moments[2] += p[2] * p[2];
      moments[3] += p[0] * p[1];
      moments[4] += p[1] * p[2];
      moments[5] += p[2] * p[0];
    }
    const double count = part.end - part.begin;
    for (double& m : mean) m /= count;
    const double xx = moments[0] / count - mean[0] * mean[0],
                 yy = moments[1] / count - mean[1] * mean[1],
                 zz = moments[2] / count - mean[2] * mean[2],
                 xy = moments[3] / count - mean[0] * mean[1],
                 yz = moments[4] / count - mean[1] * mean[2],
                 zx = moments[5] / count - mean[2] * mean[0];
    std::array<double, 3> d = {xx >= yy && xx >= zz ? 1.0 : 0.3, yy > xx && yy >= zz ? 1.0 : 0.2,
                               zz > xx && zz > yy ? 1.0 : 0.1};
    for (int round = 0; round < 12; ++round) {
      const std::array<double, 3> next = {xx * d[0] + xy * d[1] + zx * d[2],
                                          xy * d[0] + yy * d[1] + yz * d[2],
                                          zx * d[0] + yz * d[1] + zz * d[2]};
      const double norm = std::sqrt(next[0] * next[0] + next[1] * next[1] + next[2] * next[2]);
      if (!(norm > 0) || !std::isfinite(norm)) break;
      for (int k = 0; k < 3; ++k) d[k] = next[k] / norm;
    }
    return {static_cast<float>(d[0]), static_cast<float>(d[1]), static_cast<float>(d[2])};
  }

  /// Sets label_ for the vertices of a part: the two sides, and in the middle a band. A vertex of
  /// the first half that has an edge right across the band is added to it.
  void label_by_place(Scratch& scratch) {
    auto& items = scratch.items;
    const int count = static_cast<int>(items.size());
    const int half = std::max(static_cast<int>(kHalfBand * count), 16);
    const int begin = std::max(count / 2 - half, 1), end = std::min(count / 2 + half, count - 1);
    std::nth_element(items.begin(), items.begin() + begin, items.end());
    std::nth_element(items.begin() + begin, items.begin() + (end - 1), items.end());
    std::sort(items.begin() + begin, items.begin() + end);
    const auto vertex = [&](int i) { return members_[items[i].index].vertex; };
    for (int i = 0; i < begin; ++i) label_[vertex(i)] = kFirstCore;
    for (int i = end; i < count; ++i) label_[vertex(i)] = kSecondCore;
    scratch.band.clear();
    for (int i = begin; i < end; ++i) add_to_band(vertex(i), scratch);
    scratch.own = end - begin;
    for (int i = 0; i < begin; ++i) {
      for (const int w : graph_.neighbours(vertex(i))) {
        if (label_[w] != kSecondCore) continue;
        add_to_band(vertex(i), scratch);
        break;
      }
    }
    scratch.sizes = {begin - (static_cast<int>(scratch.band.size()) - scratch.own), count - end};
  }

  void add_to_band(int v, Scratch& scratch) {
    label_[v] = static_cast<int>(scratch.band.size());
    scratch.band.push_back(v);
  }

  /// The same from a separator among clusters: the band is those clusters and the ones next to
  /// them. False: the clusters are too few to have sides.
  bool label_by_clusters(int level, Scratch& scratch) {
    const ClusterGraph& coarse = coarse_[level];
    std::vector<int>& number = scratch.number[level];
    if (number.empty()) number.assign(coarse.graph.count(), -1);
    auto& clusters = scratch.clusters;
    clusters.clear();
    scratch.cluster_of.clear();
    for (const Item& item : scratch.items) {
      const int name = coarse.cluster[members_[item.index].vertex];
      int& place = number[name];
      if (place < 0) {
        place = static_cast<int>(clusters.size());
        clusters.push_back({name});
      }
      clusters[place].key += item.key;
      ++clusters[place].size;
      scratch.cluster_of.push_back(place);
    }
    const auto label_of = [&](int name) {
      return number[name] < 0 ? kOutside : clusters[number[name]].label;
    };
    choose_band_of_clusters(coarse.graph, label_of, scratch);
    describe_band(coarse.graph, label_of, scratch);
    std::array<std::int64_t, 2> cores{};
    for (const auto& c : clusters) {
      if (c.label < 0) ++cores[c.label == kFirstCore ? 0 : 1];
    }
    const auto& sides = scratch.separate.cut(cores[0], cores[1]);
    constexpr int kSeparator = 0, kBeside = 1;
    for (auto& c : clusters) {
      if (c.label < 0) continue;
      const std::uint8_t side = sides[c.label];
      c.label = side == VertexSeparator::kSourceSide ? kFirstCore
                : side == VertexSeparator::kSinkSide ? kSecondCore
                                                     : kSeparator;
    }
    // In small parts the separators matter less than the time to find them.
    const bool wide = static_cast<int>(scratch.items.size()) >= kWide;
    for (const auto& c : clusters) {
      if (c.label != kSeparator || !wide) continue;
      for (const int w : coarse.graph.neighbours(c.name)) {
        if (number[w] >= 0 && clusters[number[w]].label < 0) clusters[number[w]].label = kBeside;
      }
    }
    for (const auto& c : clusters) number[c.name] = -1;
    scratch.sizes = {0, 0};
    scratch.band_items.clear();
    for (std::size_t i = 0; i < scratch.items.size(); ++i) {
      const int label = clusters[scratch.cluster_of[i]].label;
      if (label >= 0) {
        scratch.band_items.push_back(scratch.items[i]);
      } else {
        ++scratch.sizes[label == kFirstCore ? 0 : 1];
        label_[members_[scratch.items[i].index].vertex] = label;
      }
    }
    std::sort(scratch.band_items.begin(), scratch.band_items.end());
    scratch.band.clear();
    for (const Item& item : scratch.band_items) add_to_band(members_[item.index].vertex, scratch);
    scratch.own = static_cast<int>(scratch.band.size());
    return scratch.sizes[0] > 0 && scratch.sizes[1] > 0;
  }

  template <class LabelOf>
  void choose_band_of_clusters(const Graph& graph, const LabelOf& label_of, Scratch& scratch) {
    auto& clusters = scratch.clusters;
    auto& items = scratch.band_items;
    items.clear();
    for (std::size_t i = 0; i < clusters.size(); ++i) {
      items.push_back(
          {static_cast<float>(clusters[i].key / clusters[i].size), static_cast<int>(i)});
    }
    std::sort(items.begin(), items.end());
    const auto total = static_cast<double>(scratch.items.size());
    scratch.band.clear();
    double before = 0;
    for (const Item& item : items) {
      auto& c = clusters[item.index];
      const double middle = (before + 0.5 * c.size) / total - 0.5;
      before += c.size;
      if (middle < -kHalfBandOfClusters) {
        c.label = kFirstCore;
      } else if (middle > kHalfBandOfClusters) {
        c.label = kSecondCore;
      } else {
        c.label = static_cast<int>(scratch.band.size());
        scratch.band.push_back(c.name);
      }
    }
    scratch.own = static_cast<int>(scratch.band.size());
    for (auto& c : clusters) {
      if (c.label != kFirstCore) continue;
      for (const int w : graph.neighbours(c.name)) {
        if (label_of(w) != kSecondCore) continue;
        c.label = static_cast<int>(scratch.band.size());
        scratch.band.push_back(c.name);
        break;
      }
    }
  }

  /// By insertion where they are few, as they are but for the hubs of huge fans.
  static void sort_descending(std::span<int> items) {
    constexpr std::size_t kFew = 32;
    if (items.size() > kFew) {
      std::sort(items.begin(), items.end(), std::greater<>());
      return;
    }
    for (std::size_t i = 1; i < items.size(); ++i) {
      const int item = items[i];
      std::size_t at = i;
      for (; at > 0 && items[at - 1] < item; --at) items[at] = items[at - 1];
      items[at] = item;
    }
  }

  /// The band and what its members touch, for the search of the smallest separator.
  template <class LabelOf>
  static void describe_band(const Graph& graph, const LabelOf& label_of, Scratch& scratch) {
    VertexSeparator& cut = scratch.separate;
    cut.start.assign(1, 0);
    cut.neighbour.clear();
    cut.terminal.clear();
    for (const int v : scratch.band) {
      std::uint8_t terminal = VertexSeparator::kNeither;
      const std::size_t first = cut.neighbour.size();
      for (const int w : graph.neighbours(v)) {
        const int label = label_of(w);
        if (label >= 0) {
          cut.neighbour.push_back(label);
        } else if (label == kFirstCore) {
          terminal |= VertexSeparator::kSource;
        } else if (label == kSecondCore) {
          terminal |= VertexSeparator::kSink;
        }
      }
      // The band is numbered from the sources to the sinks: onward first.
      sort_descending(std::span(cut.neighbour).subspan(first));
      cut.start.push_back(static_cast<int>(cut.neighbour.size()));
      if (static_cast<int>(cut.terminal.size()) >= scratch.own)
        terminal |= VertexSeparator::kSource;
      cut.terminal.push_back(terminal);
    }
  }

  /// Along its longest direction: fronts below touch separators in few runs then.
  void sort_separator(Part part, Scratch& scratch) {
    if (part.end - part.begin < 2) return;
    const Place direction = longest_direction(part);
    auto& items = scratch.band_items;
    items.clear();
    for (int i = part.begin; i < part.end; ++i) {
      items.push_back({dot(members_[i].place, direction), i - part.begin});
    }
    std::sort(items.begin(), items.end());
    for (int i = part.begin; i < part.end; ++i) {
      members_[i] = scratch.separator[items[i - part.begin].index];
    }
  }

  const Graph& graph_;
  std::vector<int> label_;  // per vertex; parts at work side by side share no vertex and no edge
  std::vector<ClusterGraph> coarse_;
  std::vector<Member> members_;
};

}  // namespace

std::vector<int> nested_dissection_order(const Graph& graph, std::span<const Place> places,
                                         const Work& work) {
  Dissection dissection(graph, places, work);

  // Level by level while parts are few, then part by part.
  std::vector<Part> parts = {{0, graph.count()}};
  Dissection::Scratch scratch;
  while (parts.size() < kParts) {
    poll_interrupt();
    std::vector<Part> next(2 * parts.size());
    std::vector<Part> splittable;
    const int least = 4 * kLeaf;
    bool any = false;
    for (const Part& p : parts) any = any || p.end - p.begin > least;
    if (!any) break;
    parallel_for(work, static_cast<std::int64_t>(parts.size()), 1,
                 [&](std::int64_t i, std::int64_t) {
                   const Part p = parts[i];
                   next[2 * i] = p;
                   next[2 * i + 1] = {p.end, p.end};
                   if (p.end - p.begin <= least) return;
                   Dissection::Scratch own;
                   std::tie(next[2 * i], next[2 * i + 1]) = dissection.split(p, own);
                 });
    parts.swap(next);
  }
  poll_interrupt();
  parallel_for(work, static_cast<std::int64_t>(parts.size()), 1, [&](std::int64_t i, std::int64_t) {
    Dissection::Scratch own;
    dissection.finish(parts[i], own);
  });
  std::vector<int> order;
  order.reserve(places.size());
  for (const auto& member : dissection.members()) order.push_back(member.vertex);
  return order;
}

}  // namespace beltrami
