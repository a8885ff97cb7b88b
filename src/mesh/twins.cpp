// An edge of a face is one at its least vertex or the one opposite that. So the two of a face that
// are the first's are found with the face, in the order of the least vertices, and the third alone
// is sorted by its lesser end.
#include "mesh/twins.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "base/bucket_sort.h"
#include "base/error.h"
#include "base/parallel.h"
#include "base/scratch.h"
#include "mesh/edges.h"
#include "mesh/locality.h"

namespace beltrami {
namespace {

constexpr std::int64_t kGrain = 4096;

std::string quoted(Index index) {
  return std::to_string(index);
}

/// Throws NON_MANIFOLD_EDGE or ORIENTATION with the later face concerned, at the first edge with
/// more than two half-edges, or two in the same direction.
[[noreturn]] void throw_edge_defect(const std::vector<Triangle>& faces,
                                    const HalfedgeBuckets& buckets) {
  // For the larger end vertex: the half-edges seen in the current bucket, in each direction.
  struct Seen {
    Index bucket = kNone, up = kNone, down = kNone;
  };
  const Index vertex_count = size_of(buckets.start) - 1;
  std::vector<Seen> seen(vertex_count);
  for (Index v = 0; v < vertex_count; ++v) {
    for (Index i = buckets.start[v]; i < buckets.start[v + 1]; ++i) {
      const Index h = buckets.spokes[i].halfedge();
      const auto [from, to] = ends_of(faces, h);
      Seen& other = seen[std::max(from, to)];
      if (other.bucket != v) other = {v, kNone, kNone};
      Index& same = from < to ? other.up : other.down;
      const Index opposite = from < to ? other.down : other.up;
      if (same == kNone) {
        same = h;
        continue;
      }
      const std::string edge = "the edge " + quoted(from) + "-" + quoted(to);
      if (opposite != kNone) {
        throw Error(Fault::kNonManifoldEdge,
                    "face " + quoted(h / 3) + " is at least the third on " + edge +
                        ": split the surface there, so that no edge has more than two faces",
                    Element::face(h / 3));
      }
      // A third face on the edge makes it non-manifold, whichever way it runs.
      const auto rest = buckets.spokes.begin() + i + 1;
      const auto end = buckets.spokes.begin() + buckets.start[v + 1];
      if (std::any_of(rest, end, [larger = std::max(from, to)](const Spoke& spoke) {
            return spoke.far() == larger;
          })) {
        throw Error(Fault::kNonManifoldEdge,
                    "more than two faces, " + quoted(h / 3) + " among them, share " + edge +
                        ": split the surface there",
                    Element::face(h / 3));
      }
      throw Error(Fault::kOrientation,
                  "faces " + quoted(same / 3) + " and " + quoted(h / 3) + " run along " + edge +
                      " in the same direction: orient all faces alike (or remove a duplicate)",
                  Element::face(h / 3));
    }
  }
  throw Error(Fault::kInternal, "half-edges could not be paired, please report it");
}

/// The corner with the least vertex: a comparison that goes either way costs more than both.
int least_corner(const Triangle& face) {
  const int second = static_cast<int>(face[1] < face[0]) & static_cast<int>(face[1] < face[2]);
  const int third = static_cast<int>(face[2] < face[0]) & static_cast<int>(face[2] < face[1]);
  return second + 2 * third;
}

/// Faces in the order of their least vertices: the faces, or empty where they lie so.
std::vector<Index> by_least(Index vertex_count, const std::vector<Triangle>& faces,
                            const Work& work) {
  const auto least = [&](std::int64_t f) { return faces[f][least_corner(faces[f])]; };
  const std::int64_t count = size_of(faces);
  const auto lies_wrong = [&](std::int64_t f) { return f > 0 && least(f) < least(f - 1); };
  if (parallel_find(work, count, kGrain, lies_wrong) == count) return {};
  return by_least_vertex(vertex_count, faces, work);
}

/// Per face the edge opposite its least vertex, by the lesser end.
struct OppositeEdges {
  std::vector<Index> start;  ///< per vertex, and one more
  Scratch<Spoke> spokes;
};

OppositeEdges opposite_edges(Index vertex_count, const std::vector<Triangle>& faces,
                             const Work& work) {
  OppositeEdges buckets{{}, Scratch<Spoke>(work, faces.size())};
  const auto edge = [&](std::int64_t f, const auto& visit) {
    const int k = next_corner(least_corner(faces[f]));
    visit(static_cast<Index>(3 * f + k), faces[f][k], faces[f][next_corner(k)]);
  };
  BucketSort<Index> sort(work, size_of(faces), vertex_count, buckets.start,
                         [&](std::int64_t f, const auto& count) {
                           edge(f, [&](Index, Index from, Index to) { count(std::min(from, to)); });
                         });
  sort.place([&](std::int64_t f, const auto& place) {
    edge(f, [&](Index h, Index from, Index to) {
      buckets.spokes[place(std::min(from, to))] = Spoke(h, from, to);
    });
  });
  return buckets;
}

/// Finds the twins of the half-edges between a vertex and greater ones, vertex by vertex. Those of
/// a direction have slots by their far ends: no sort, and hardly a branch that may go either way.
class Matcher {
 public:
  Matcher() {
    for (auto& side : slots_) side.fill({~std::uint64_t{0}, kNone});
  }

  void begin(Index vertex) {
    vertex_ = static_cast<std::uint64_t>(vertex);
    count_ = 0;
    in_doubt_ = false;
  }
  void add(bool leaves, Index far, Index halfedge) {
    Slot& slot = slots_[leaves ? 1 : 0][static_cast<std::size_t>(far) % kSlots];
    in_doubt_ |= slot.edge >> 32 == vertex_;
    slot = {edge_to(far), halfedge};
    added_[count_] = {far, halfedge, leaves};
    count_ += static_cast<int>(count_ < kFew);
  }
  /// Writes the twins of all. Returns false where there are too many, or two of a direction have
  /// one slot, maybe one edge.
  bool pair(std::vector<Index>& twin) const {
    if (in_doubt_ || count_ == kFew) return false;
    for (int i = 0; i < count_; ++i) {
      const auto& [far, halfedge, leaves] = added_[i];
      const Slot& slot = slots_[leaves ? 0 : 1][static_cast<std::size_t>(far) % kSlots];
      twin[halfedge] = slot.edge == edge_to(far) ? slot.halfedge : kNone;
    }
    return true;
  }

 private:
  static constexpr std::size_t kSlots = 256;
  static constexpr int kFew = 48;
  struct Slot {
    std::uint64_t edge;  // the vertex and the far end
    Index halfedge;
  };
  struct Added {
    Index far, halfedge;
    bool leaves;
  };

  std::uint64_t edge_to(Index far) const { return vertex_ << 32 | static_cast<std::uint64_t>(far); }

  std::array<std::array<Slot, kSlots>, 2> slots_;
  std::array<Added, kFew + 1> added_;
  std::uint64_t vertex_ = 0;
  int count_ = 0;
  bool in_doubt_ = false;
};

/// The same for any number of them.
bool pair_sorted(std::span<Spoke> spokes, std::vector<Index>& twin) {
  bool sound = true;
  for_each_edge(spokes, [&](std::span<const Spoke> edge) {
    for (const Spoke& spoke : edge) twin[spoke.halfedge()] = kNone;
    if (edge.size() == 1) return;
    if (edge.size() > 2 || edge[0].outwards() == edge[1].outwards()) {
      sound = false;
      return;
    }
    twin[edge[0].halfedge()] = edge[1].halfedge();
    twin[edge[1].halfedge()] = edge[0].halfedge();
  });
  return sound;
}

}  // namespace

HalfedgeBuckets sort_halfedges(Index vertex_count, const std::vector<Triangle>& faces,
                               const Work& work) {
  HalfedgeBuckets buckets;
  const auto for_each_halfedge = [&](std::int64_t f, const auto& visit) {
    for (int k = 0; k < 3; ++k) {
      visit(static_cast<Index>(3 * f + k), faces[f][k], faces[f][next_corner(k)]);
    }
  };
  BucketSort<Index> sort(
      work, size_of(faces), vertex_count, buckets.start, [&](std::int64_t f, const auto& count) {
        for_each_halfedge(f, [&](Index, Index from, Index to) { count(std::min(from, to)); });
      });
  parallel_assign(work, buckets.spokes, 3 * faces.size());
  sort.place([&](std::int64_t f, const auto& place) {
    for_each_halfedge(f, [&](Index h, Index from, Index to) {
      buckets.spokes[place(std::min(from, to))] = Spoke(h, from, to);
    });
  });
  return buckets;
}

std::vector<Index> pair_halfedges(Index vertex_count, const std::vector<Triangle>& faces,
                                  const Work& work) {
  const std::vector<Index> order = by_least(vertex_count, faces, work);
  const OppositeEdges opposite = opposite_edges(vertex_count, faces, work);
  const auto face_at = [&](std::int64_t place) {
    return order.empty() ? static_cast<Index>(place) : order[place];
  };
  const auto least_at = [&](std::int64_t place) {
    const Triangle& face = faces[face_at(place)];
    return face[least_corner(face)];
  };
  const std::int64_t face_count = size_of(faces);
  std::vector<Index> twin;
  parallel_assign(work, twin, 3 * faces.size());
  std::atomic<bool> sound{true};
  parallel_for(work, vertex_count, kGrain, [&](std::int64_t begin, std::int64_t end) {
    std::int64_t first = 0,
                 last = face_count;  // the first place whose least vertex is in the range
    while (first < last) {
      const std::int64_t middle = first + (last - first) / 2;
      if (least_at(middle) < begin) {
        first = middle + 1;
      } else {
        last = middle;
      }
    }
    Matcher matcher;
    std::vector<Spoke> many;
    bool all_sound = true;
    for (auto v = static_cast<Index>(begin); v < end; first = last, ++v) {
      const auto for_each_spoke = [&](const auto& visit) {
        for (last = first; last < face_count; ++last) {
          const Index f = face_at(last);
          const int k = least_corner(faces[f]), before = previous_corner(k);
          if (faces[f][k] != v) break;
          visit(true, faces[f][next_corner(k)], 3 * f + k);
          visit(false, faces[f][before], 3 * f + before);
        }
        for (Index i = opposite.start[v]; i < opposite.start[v + 1]; ++i) {
          const Spoke& spoke = opposite.spokes[i];
          visit(spoke.outwards(), spoke.far(), spoke.halfedge());
        }
      };
      matcher.begin(v);
      for_each_spoke([&](bool leaves, Index far, Index h) { matcher.add(leaves, far, h); });
      if (matcher.pair(twin)) continue;
      many.clear();
      for_each_spoke([&](bool leaves, Index far, Index h) {
        many.push_back(leaves ? Spoke(h, v, far) : Spoke(h, far, v));
      });
      all_sound &= pair_sorted(many, twin);
    }
    if (!all_sound) sound = false;
  });
  if (!sound) throw_edge_defect(faces, sort_halfedges(vertex_count, faces, work));
  return twin;
}

}  // namespace beltrami
