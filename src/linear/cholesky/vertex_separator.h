// Minimum vertex cuts in small graphs.
#pragma once

#include <cstdint>
#include <vector>

namespace beltrami {

/// The smallest set of vertices that separates the sources from the sinks, which may be part of it:
/// a maximum flow of vertex-disjoint paths (Menger 1927; Ford & Fulkerson 1956). Fast where the
/// first neighbours in the list lead towards the sinks: most paths are found at the first try then.
/// Reusable, so that its buffers are allocated once. Fill the graph's arrays, call cut().
class VertexSeparator {
 public:
  /// Whether a vertex touches the source or the sink side; both is possible.
  enum Terminal : std::uint8_t { kNeither = 0, kSource = 1, kSink = 2 };
  enum Side : std::uint8_t { kSourceSide, kSeparator, kSinkSide };

  std::vector<int> start;  ///< per vertex, and one more: where its neighbours start
  std::vector<int> neighbour;
  std::vector<std::uint8_t> terminal;  ///< per vertex: bits of Terminal

  /// Of the two extreme minimum cuts (nearest to the sources, nearest to the sinks) the one that
  /// splits `source_weight` + `sink_weight` + these vertices more evenly. One Side per vertex.
  const std::vector<std::uint8_t>& cut(std::int64_t source_weight, std::int64_t sink_weight);

 private:
  static constexpr int kNone = -1, kTerminal = -2;
  // Every vertex v is split into the nodes "in" 2 v and "out" 2 v + 1.
  static int in(int v) { return 2 * v; }
  static int out(int v) { return 2 * v + 1; }

  bool augment(int source);
  void apply_path();
  template <bool kFromSources>
  void flood();
  void reach_from_sources();
  void reach_from_sinks();

  int count_ = 0;
  std::vector<int> previous_, next_;  // per vertex on a path of the flow, else kNone
  std::vector<int> cursor_;           // per vertex: neighbours already tried in this round
  std::vector<int> queue_, path_;
  std::vector<std::uint8_t> tried_, reached_;  // per node
  std::vector<std::uint8_t> side_, other_side_;
};

}  // namespace beltrami
