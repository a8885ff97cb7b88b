#include "cut/sheets.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include "base/interrupt.h"
#include "exact/crossings.h"

namespace beltrami {
namespace {

/// Faces of a pixel that are looked at: those of deeper pixels come on top once others are parted.
constexpr Index kMostLayers = 4;
/// Faces on the way from a pixel centre to the next one, on the same sheet.
constexpr int kMostSteps = 64;

/// Two entries of a pixel: places in its list of faces.
struct Pair {
  Index pixel;
  int one, other;

  std::uint8_t bit() const {
    const auto [low, high] = std::minmax(one, other);
    return static_cast<std::uint8_t>(1U << (high * (high - 1) / 2 + low));
  }
};

/// The pairs of faces that lie on each other, joined where both sheets go on from pixel to pixel.
class Pairs {
 public:
  Pairs(const Surface& mesh, const std::vector<Vec2>& uvs, const Layers& layers)
      : mesh_(mesh), uvs_(uvs), layers_(layers), visited_(layers.pixels.size(), 0) {
    below_.assign(layers.pixels.size(), kNone);
    above_.assign(layers.pixels.size(), kNone);
    for (Index i = 0, j = 0; i < layers.count(); ++i) {
      const std::int64_t above = std::int64_t{layers.pixels[i]} + layers.width;
      while (j < layers.count() && layers.pixels[j] < above) ++j;
      if (j == layers.count() || layers.pixels[j] != above) continue;
      above_[i] = j;
      below_[j] = i;
    }
  }

  Sheets sheets(Index rank) {
    struct Component {
      Index size;
      Pair end;
    };
    std::vector<Component> components;
    for (Index i = 0; i < layers_.count(); ++i) {
      for (int other = 1; other < depth(i); ++other) {
        for (int one = 0; one < other; ++one) {
          const Pair pair{i, one, other};
          if ((visited_[i] & pair.bit()) != 0) continue;
          visit_from(pair, [](const Pair&, const Pair&) { return true; });
          components.push_back({size_of(queue_), queue_.back().pair});
        }
      }
    }
    if (rank >= size_of(components)) return {};
    std::stable_sort(components.begin(), components.end(),
                     [](const Component& a, const Component& b) { return a.size > b.size; });
    return grown(components[rank].end);
  }

 private:
  struct Reached {
    Pair pair;
    Index steps;
  };

  int depth(Index pixel) const { return std::min<Index>(size_of_pixel(pixel), kMostLayers); }
  Index size_of_pixel(Index pixel) const { return static_cast<Index>(layers_[pixel].size()); }

  /// From the face at one pixel centre to the one at another, over the faces in between; kNone
  /// where the sheet ends before.
  Index walk(Index face, const Vec2& to, std::vector<Index>* way) const {
    Index came_by = kNone;
    for (int step = 0; step < kMostSteps; ++step) {
      Index out = kNone;
      for (Index h = 3 * face; h < 3 * face + 3 && out == kNone; ++h) {
        const Vec2& a = uvs_[mesh_.origin(h)];
        const Vec2 along = uvs_[mesh_.target(h)] - a, off = to - a;
        if (h != came_by && along.x() * off.y() - along.y() * off.x() < 0) out = h;
      }
      if (way != nullptr) way->push_back(face);
      if (out == kNone) return face;
      came_by = mesh_.twin[out];
      if (came_by == kNone) return kNone;
      face = came_by / 3;
    }
    return kNone;
  }

  /// The place in the list of the pixel `to` of the sheet at `place` of the pixel `from`, or kNone.
  int next_place(Index from, int place, Index to) const {
    const Index face = walk(layers_[from][place], layers_.centre(to), nullptr);
    for (int i = 0; i < depth(to); ++i) {
      if (layers_[to][i] == face) return i;
    }
    return kNone;
  }

  template <class Visit>
  void for_each_neighbour(Index pixel, const Visit& visit) const {
    if (below_[pixel] != kNone) visit(below_[pixel]);
    if (pixel > 0 && is_beside(pixel - 1)) visit(pixel - 1);
    if (pixel + 1 < layers_.count() && is_beside(pixel)) visit(pixel + 1);
    if (above_[pixel] != kNone) visit(above_[pixel]);
  }
  /// Rows end with a pixel outside of the box, so none begins beside the end of another one.
  bool is_beside(Index left) const { return layers_.pixels[left] + 1 == layers_.pixels[left + 1]; }

  /// Breadth first from `first` over the pairs that accept(from, to) takes, into queue_.
  template <class Accept>
  void visit_from(const Pair& first, const Accept& accept) {
    queue_.clear();
    queue_.push_back({first, 0});
    visited_[first.pixel] |= first.bit();
    for (std::size_t i = 0; i < queue_.size(); ++i) {
      poll_();
      const auto [pair, steps] = queue_[i];
      for_each_neighbour(pair.pixel, [&, pair = pair, steps = steps](Index pixel) {
        const int one = next_place(pair.pixel, pair.one, pixel);
        if (one == kNone) return;
        const int other = next_place(pair.pixel, pair.other, pixel);
        if (other == kNone || other == one) return;
        const Pair next{pixel, one, other};
        if ((visited_[pixel] & next.bit()) != 0 || !accept(pair, next)) return;
        visited_[pixel] |= next.bit();
        queue_.push_back({next, steps + 1});
      });
    }
  }

  /// The sheets around a pair: all of them, or until they meet each other and then half that far.
  Sheets grown(const Pair& end) {
    Sheets sheets;
    std::vector<Terminal>& terminals = sheets.terminals;
    terminals.assign(mesh_.faces.size(), Terminal::kNeither);
    const auto fits = [&](const Pair& pair) {
      return terminals[face_of(pair.pixel, pair.one)] != Terminal::kSink &&
             terminals[face_of(pair.pixel, pair.other)] != Terminal::kSource;
    };
    const auto take = [&](const Pair& pair) {
      terminals[face_of(pair.pixel, pair.one)] = Terminal::kSource;
      terminals[face_of(pair.pixel, pair.other)] = Terminal::kSink;
    };
    std::fill(visited_.begin(), visited_.end(), 0);
    take(end);
    visit_from(end, [&](const Pair&, const Pair& to) {
      if (sheets.is_band) return false;
      if (!fits(to)) {
        sheets.is_band = true;
        return false;
      }
      take(to);
      return true;
    });
    if (sheets.is_band) {
      const Index far = queue_.back().steps / 2;
      std::erase_if(queue_, [&](const Reached& reached) { return reached.steps > far; });
      std::fill(terminals.begin(), terminals.end(), Terminal::kNeither);
      for (const Reached& reached : queue_) take(reached.pair);
    }
    fill_ways(terminals);
    return sheets;
  }

  /// The faces between pixel centres: without them, sheets of faces finer than pixels have holes.
  void fill_ways(std::vector<Terminal>& terminals) {
    std::vector<Index> way;
    const auto fill = [&](Index from, int place, Index to, Terminal side) {
      way.clear();
      const Index face = walk(face_of(from, place), layers_.centre(to), &way);
      if (face == kNone || terminals[face] != side) return;
      for (const Index f : way) {
        if (terminals[f] == Terminal::kNeither) terminals[f] = side;
      }
    };
    for (const auto& [pair, steps] : queue_) {
      poll_();
      for_each_neighbour(pair.pixel, [&, pair = pair](Index pixel) {
        fill(pair.pixel, pair.one, pixel, Terminal::kSource);
        fill(pair.pixel, pair.other, pixel, Terminal::kSink);
      });
    }
  }

  Index face_of(Index pixel, int place) const { return layers_[pixel][place]; }

  const Surface& mesh_;
  const std::vector<Vec2>& uvs_;
  const Layers& layers_;
  std::vector<std::uint8_t> visited_;  // per pixel a bit for each two entries
  std::vector<Index> below_, above_;   // per pixel the ones in the rows beside its own, or kNone
  std::vector<Reached> queue_;
  PollSometimes poll_;
};

}  // namespace

Sheets largest_sheets(const Surface& mesh, const std::vector<Vec2>& uvs, const Layers& layers,
                      Index rank) {
  return Pairs(mesh, uvs, layers).sheets(rank);
}

Sheets crossing_faces(const DiskMesh& mesh, const std::vector<Vec2>& uvs) {
  const auto face_at = [&](Index place) { return mesh.outgoing[mesh.boundary[place]] / 3; };
  for (const auto& [one, other] : find_crossings(mesh.boundary, uvs)) {
    if (face_at(one) == face_at(other)) continue;
    Sheets sheets;
    sheets.terminals.assign(mesh.faces.size(), Terminal::kNeither);
    sheets.terminals[face_at(one)] = Terminal::kSource;
    sheets.terminals[face_at(other)] = Terminal::kSink;
    return sheets;
  }
  return {};
}

}  // namespace beltrami
