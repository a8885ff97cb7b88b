// Sums at the vertices of what every face gives to its corners.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "base/parallel.h"
#include "base/types.h"
#include "base/work.h"
#include "mesh/face_chunks.h"

namespace beltrami {

/// Adds up in parallel, chunk by chunk: the same bits at any number of threads. Keeps a reference
/// to `faces`.
class VertexSums {
 public:
  /// What a face gives to its three corners.
  using Terms = std::array<Vec2, 3>;

  VertexSums(Index vertex_count, const std::vector<Triangle>& faces, const Work& work)
      : faces_(faces),
        work_(work),
        vertex_count_(vertex_count),
        chunks_(vertex_count, faces, work),
        aside_(chunks_.count()) {}

  /// Sets sums[v] to the sum over the corners at v of what `give(face, terms)` writes into its
  /// terms. Returns the sum over the faces of what `give` returns.
  template <class Give>
  double add_up(const Give& give, std::vector<Vec2>& sums);

 private:
  static constexpr std::int64_t kGrain = FaceChunks::kGrain;
  struct Aside {
    Index vertex;
    Vec2 term;
  };

  const std::vector<Triangle>& faces_;
  const Work work_;
  Index vertex_count_;
  FaceChunks chunks_;
  std::vector<std::vector<Aside>> aside_;
};

template <class Give>
double VertexSums::add_up(const Give& give, std::vector<Vec2>& sums) {
  sums.resize(vertex_count_);
  parallel_for(work_, static_cast<std::int64_t>(sums.size()), kGrain,
               [&](std::int64_t begin, std::int64_t end) {
                 std::fill(sums.begin() + begin, sums.begin() + end, Vec2::Zero());
               });
  const auto chunk = [&](std::int64_t begin, std::int64_t end) {
    std::vector<Aside>& aside = aside_[FaceChunks::of(begin)];
    aside.clear();
    double total = 0;
    Terms terms;
    for (std::int64_t f = begin; f < end; ++f) {
      total += give(static_cast<Index>(f), terms);
      for (int k = 0; k < 3; ++k) {
        const Index v = faces_[f][k];
        if (chunks_.shared(v)) {
          aside.push_back({v, terms[k]});
        } else {
          sums[v] += terms[k];
        }
      }
    }
    return total;
  };
  const double total = parallel_sum(work_, size_of(faces_), kGrain, chunk);
  for (const std::vector<Aside>& aside : aside_) {
    for (const Aside& a : aside) sums[a.vertex] += a.term;
  }
  return total;
}

}  // namespace beltrami
