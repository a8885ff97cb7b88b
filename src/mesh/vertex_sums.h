// Sums at the vertices of what every face gives to its corners.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "base/lanes.h"
#include "base/parallel.h"
#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "mesh/face_block.h"
#include "mesh/face_chunks.h"

namespace beltrami {

/// Adds up in parallel, chunk by chunk: the same bits at any number of threads. Keeps a reference
/// to `faces`.
class VertexSums {
 public:
  /// What a face gives to its three corners.
  using Terms = std::array<Vec2, 3>;
  /// The same of kLanes faces.
  using LaneTerms = std::array<LanesComplex, 3>;

  VertexSums(Index vertex_count, const std::vector<Triangle>& faces, const Work& work)
      : faces_(faces),
        work_(work),
        vertex_count_(vertex_count),
        chunks_(vertex_count, faces, work),
        aside_(chunks_, vertex_count) {}

  /// Faces of a chunk, whose values are added up on their own.
  std::int64_t grain() const { return chunks_.grain(); }

  /// Sets sums[v] to the sum over the corners at v of what `give(face, terms)` writes into its
  /// terms. Returns the sum over the faces of what `give` returns.
  template <class Give>
  double add_up(const Give& give, std::vector<Vec2>& sums);

  /// What the faces of a block give to their corners, and to the sum over the faces.
  struct BlockTerms {
    std::array<FaceBlock::Numbers, 3> x, y;
    FaceBlock::Numbers value;
  };
  /// The same of what `give(first, end, terms)` writes for the faces of a block, of which those
  /// from `end` on do not count.
  template <class Give>
  double add_up_blocks(const Give& give, std::vector<Vec2>& sums);

  /// The same of what `give(faces, terms)` writes for kLanes faces at once, as float; the last ones
  /// may be one face several times, of which the first counts.
  template <class Give>
  void add_up_lanes(const Give& give, std::vector<Vec2>& sums);

 private:
  struct Aside {
    Index vertex;
    double x, y;  // not a Vec2, whose alignment would take a third more
  };

  void add(std::size_t chunk, Index v, const Vec2& term, std::vector<Vec2>& sums) {
    if (chunks_.shared(v)) {
      aside_.put(chunk, v, {v, term.x(), term.y()});
    } else {
      sums[v] += term;
    }
  }

  /// Calls add_chunk(begin, end, chunk) for the chunks, with sums of zero before.
  template <class AddChunk>
  double sum_chunks(std::vector<Vec2>& sums, const AddChunk& add_chunk);

  const std::vector<Triangle>& faces_;
  const Work work_;
  Index vertex_count_;
  FaceChunks chunks_;
  PutAside<Aside> aside_;
};

template <class AddChunk>
double VertexSums::sum_chunks(std::vector<Vec2>& sums, const AddChunk& add_chunk) {
  sums.resize(vertex_count_);
  parallel_for(work_, static_cast<std::int64_t>(sums.size()), chunks_.grain(),
               [&](std::int64_t begin, std::int64_t end) {
                 std::fill(sums.begin() + begin, sums.begin() + end, Vec2::Zero());
               });
  const double total = parallel_sum(work_, size_of(faces_), chunks_.grain(),
                                    [&](std::int64_t begin, std::int64_t end) {
                                      const std::size_t chunk = chunks_.of(begin);
                                      aside_.clear(chunk);
                                      return add_chunk(begin, end, chunk);
                                    });
  aside_.add_up(work_, [&](const Aside& a) { sums[a.vertex] += Vec2(a.x, a.y); });
  return total;
}

template <class Give>
double VertexSums::add_up(const Give& give, std::vector<Vec2>& sums) {
  return sum_chunks(sums, [&](std::int64_t begin, std::int64_t end, std::size_t chunk) {
    double total = 0;
    Terms terms;
    for (std::int64_t f = begin; f < end; ++f) {
      total += give(static_cast<Index>(f), terms);
      for (int k = 0; k < 3; ++k) add(chunk, faces_[f][k], terms[k], sums);
    }
    return total;
  });
}

template <class Give>
double VertexSums::add_up_blocks(const Give& give, std::vector<Vec2>& sums) {
  return sum_chunks(sums, [&](std::int64_t begin, std::int64_t end, std::size_t chunk) {
    // Through bare pointers, which nothing that is written can change.
    double* const to = sums.data()->data();
    const Triangle* const faces = faces_.data();
    double total = 0;
    BlockTerms terms;
    for (std::int64_t first = begin; first < end; first += FaceBlock::kFaces) {
      give(first, end, terms);
      const auto count = std::min<std::int64_t>(FaceBlock::kFaces, end - first);
      for (std::int64_t i = 0; i < count; ++i) {
        total += terms.value[i];
        for (int k = 0; k < 3; ++k) {
          const Index v = faces[first + i][k];
          if (chunks_.shared(v)) {
            aside_.put(chunk, v, {v, terms.x[k][i], terms.y[k][i]});
          } else {
            to[2 * static_cast<std::size_t>(v)] += terms.x[k][i];
            to[2 * static_cast<std::size_t>(v) + 1] += terms.y[k][i];
          }
        }
      }
    }
    return total;
  });
}

template <class Give>
void VertexSums::add_up_lanes(const Give& give, std::vector<Vec2>& sums) {
  sum_chunks(sums, [&](std::int64_t begin, std::int64_t end, std::size_t chunk) {
    std::array<Index, kLanes> lanes;
    LaneTerms terms;
    for (std::int64_t first = begin; first < end; first += kLanes) {
      const auto count = static_cast<int>(std::min<std::int64_t>(kLanes, end - first));
      for (int i = 0; i < kLanes; ++i) {
        lanes[i] = static_cast<Index>(first) + std::min(i, count - 1);
      }
      give(lanes, terms);
      for (int i = 0; i < count; ++i) {
        for (int k = 0; k < 3; ++k) {
          add(chunk, faces_[lanes[i]][k], {terms[k].real[i], terms[k].imag[i]}, sums);
        }
      }
    }
    return 0.0;
  });
}

}  // namespace beltrami
